"""Plot the scoreboard in nine panels."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from deixis.experiments.scoreboard.board import Board, median_seconds
from deixis.experiments.scoreboard.cases import PHOTOGRAPHS, Group
from deixis.experiments.scoreboard.contestants import DEFAULT
from deixis.experiments.scoreboard.run import Scoreboard
from deixis.plots.figure import INK, LINE_COLOURS, PALETTE, QUIET, dress_chart, line_look, new_figure, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARKERS = "osD^vPX<>*hd"
MIN_VALUE_SHOWN = -0.25
"""Minimum relative log-likelihood shown."""

DODGE = 1.008
"""Factor by which lines are set apart, so that their intervals do not overlap."""


def plot_scoreboard(found: Scoreboard, path: str | Path) -> None:
    """Draw the scoreboard: accuracy by size and noise, times, limits, calibration and ablations.

    Parameters
    ----------
    found
        Results of the experiment.
    path
        File of the picture: ``.png``, ``.svg`` or ``.pdf``.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    MissingExtraError
        If matplotlib is not installed.
    """
    save(scoreboard_figure(found), path)


def scoreboard_figure(found: Scoreboard, into: Axes | None = None) -> Figure:
    """Draw the scoreboard: accuracy by size and noise, times, limits, calibration and ablations.

    Parameters
    ----------
    found
        Results of the experiment.
    into
        Axes for the accuracy at the middle noise alone; None for a new figure of nine panels.

    Returns
    -------
    Figure
        The figure.
    """
    if into is not None:
        off = found.plan.off[len(found.plan.off) // 2]
        _by_size(into, found.main, off, "right", f"share right, {100 * off:.0f} % off")
        into.legend(frameon=False, fontsize=8, labelcolor=INK)
        return into.figure.figure
    figure, axes = new_figure(12.0, 10.2, nrows=3, ncols=3)
    panels = iter(axes.ravel())
    offs = found.plan.off[:3]
    for off in offs:
        _by_size(next(panels), found.main, off, "right", f"share right, {100 * off:.0f} % off")
    for _ in range(3 - len(offs)):
        next(panels).set_visible(False)
    middle = offs[len(offs) // 2]
    title = f"share right up to interchangeability, {100 * middle:.0f} % off"
    _by_size(next(panels), found.main, middle, "grouped", title)
    _by_size(next(panels), found.main, middle, "value", f"log-likelihood over the best, {100 * middle:.0f} % off")
    _times(next(panels), found.main)
    _limits(next(panels), found)
    _reliability(next(panels), found)
    _bars(next(panels), found)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    legend = figure.legend(handles, labels, loc="outside lower center", ncols=7, frameon=False, fontsize=9)
    for text in legend.get_texts():
        text.set_color(INK)
    return figure


def _sizes(axes: Axes, sizes: Sequence[int]) -> None:
    axes.set_xscale("log")
    axes.set_xticks(sizes, [str(size) for size in sizes])
    axes.minorticks_off()


def _style(number: int) -> dict[str, Any]:
    style = line_look(number) | {"marker": MARKERS[number % len(MARKERS)], "markersize": 4.5}
    return style | {"linewidth": 2.2 if number == 0 else 1.2, "zorder": 3 if number == 0 else 2}


def _by_size(axes: Axes, board: Board, off: float, measure: str, title: str) -> None:
    """Draw a line for every contestant, with its intervals."""
    sizes = sorted({group.objects for group in board.groups if group.objects != PHOTOGRAPHS})
    for number, one in enumerate(board.contestants):
        there = [size for size in sizes if board.of(one.name, Group(size, off))]
        means = [board.mean(one.name, Group(size, off), measure) for size in there]
        axes.errorbar(
            [size * DODGE ** (number - len(board.contestants) // 2) for size in there],
            [mean.mean for mean in means],
            np.nan_to_num([mean.half for mean in means]),
            label=one.name,
            elinewidth=0.8,
            capsize=2,
            **_style(number),
        )
    _sizes(axes, sizes)
    least = min((mean for line in axes.containers for mean in line[0].get_ydata()), default=0.0)
    axes.set_ylim(max(MIN_VALUE_SHOWN, min(0.0, least)), 1.02)
    dress_chart(axes, title, "objects")


def _times(axes: Axes, board: Board) -> None:
    """Draw the median times over all noises."""
    sizes = sorted({group.objects for group in board.groups if group.objects != PHOTOGRAPHS})
    for number, one in enumerate(board.contestants):
        scores = [score for group in board.groups for score in board.of(one.name, group)]
        taken = {size: [score for score in scores if score.setting.objects == size] for size in sizes}
        there = [size for size in sizes if taken[size]]
        axes.plot(there, [median_seconds(taken[size]) for size in there], **_style(number))
    _sizes(axes, sizes)
    axes.set_yscale("log")
    axes.tick_params(axis="y", which="minor", labelleft=False)
    dress_chart(axes, "time to the full answer, seconds", "objects")


def _limits(axes: Axes, found: Scoreboard) -> None:
    """Draw the default engine (solid) and the exact limit (dashed) on the largest tables that have one."""
    largest = max((one.setting.objects for one in found.limits), default=0)
    for number, off in enumerate(found.plan.off):
        colour = LINE_COLOURS[number % len(LINE_COLOURS)]
        some = [one for one in found.limits if one.setting.objects == largest and one.setting.off == off]
        across = [one.setting.facts_each for one in some]
        axes.errorbar(
            across,
            [one.right.mean for one in some],
            np.nan_to_num([one.right.half for one in some]),
            color=colour,
            marker="o",
            markersize=4.5,
            linewidth=2,
            capsize=2,
            elinewidth=0.8,
            label=f"{DEFAULT}, {100 * off:.0f} % off",
        )
        axes.plot(across, [one.words.mean for one in some], color=colour, linestyle="--", linewidth=1.2)
    axes.plot([], [], color=INK, linestyle="--", linewidth=1.2, label="exact Bayes limit")
    axes.legend(fontsize=8, frameon=False, labelcolor=INK, loc="lower right")
    axes.set_ylim(0, 1.02)
    axes.set_xticks(found.plan.facts_each)
    dress_chart(axes, f"share right and its limit, {largest} objects", "facts an object")


def _reliability(axes: Axes, found: Scoreboard) -> None:
    """Draw the share of right matches against their stated probability; the area of a point is its share."""
    axes.plot([0, 1], [0, 1], color=QUIET, linewidth=1, linestyle=":")
    for number, (name, one) in enumerate(found.calibrations().items()):
        look = line_look(number)
        bins = [each for each in one.bins if each.count]
        probabilities, right = [each.probability for each in bins], [each.right for each in bins]
        axes.plot(probabilities, right, linewidth=1.2, label=f"{name} ({one.error:.3f})", **look)
        areas = [4 + 60 * each.count / one.count for each in bins]
        axes.scatter(probabilities, right, s=areas, color=look["color"], linewidths=0, alpha=0.8)
    title = "expected calibration error"
    legend = {"frameon": False, "labelcolor": INK, "ncols": 2, "columnspacing": 0.8}
    axes.legend(fontsize=6.5, loc="upper left", title=title, title_fontsize=7, **legend)
    axes.set_ylabel("share right", color=INK, fontsize=9)
    dress_chart(axes, f"calibration of {DEFAULT}", "probability that the answer gives")
    rows = 1 + (len(found.calibrations()) + 1) // 2  # room for the legend, above the curves
    axes.set_ylim(-0.05, 1.05 + 0.11 * rows)
    axes.set_yticks(np.linspace(0.0, 1.0, 6))


def _bars(axes: Axes, found: Scoreboard) -> None:
    """Draw the cost of each ablation: all noises of the largest ablated size, and photographs."""
    board = found.ablations
    largest = max((group.objects for group in board.groups), default=0)
    shown = [group for group in board.groups if group.objects in (largest, PHOTOGRAPHS)]
    width = 0.8 / len(board.contestants)
    for number, one in enumerate(board.contestants):
        means = [board.mean(one.name, group, "right") for group in shown]
        axes.bar(
            [at + (number + 0.5) * width - 0.4 for at in range(len(shown))],
            [mean.mean for mean in means],
            width,
            yerr=np.nan_to_num([mean.half for mean in means]),
            color=PALETTE[number % len(PALETTE)],
            label=one.name,
            error_kw={"elinewidth": 0.8, "capsize": 2, "ecolor": INK},
        )
    names = ["photographs" if group.objects == PHOTOGRAPHS else f"{100 * group.off:.0f} % off" for group in shown]
    dress_chart(axes, f"ablations, share right, {largest} objects of known kinds", "")
    axes.set_xticks(range(len(shown)), names)
    axes.set_ylim(0, 1.3)
    axes.legend(fontsize=8, frameon=False, labelcolor=INK, ncols=2, loc="upper right")
