"""Charts of answers that have no scene: ranked results, and statements over time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.errors import DeixisError
from deixis.plots.figure import BELONGS, INK, QUIET, canvas, dress_chart

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from deixis.reasoning.temporal.chronology import Chronology
    from deixis.workflows.grounding.retrieve import Retrieval

WIDTH, ROW = 9.0, 0.36
"""Width of a chart and height of one of its rows, in inches."""

MAX_ROWS = 60
"""Maximum number of rows of a chart."""

BAR = 0.62
"""Height of a bar, as a share of its row."""


def retrieval_figure(found: Retrieval, axes: Axes | None = None) -> Figure:
    """Draw a bar of the similarity for each result, the most similar first.

    Parameters
    ----------
    found
        Answer of ``deixis retrieve``.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    DeixisError
        If there is no result.
    """
    shown = found.found[:MAX_ROWS]
    if not shown:
        raise DeixisError(f"{found.query}: there is no similar result to draw; to_text() says why")
    figure, axes = canvas(axes, WIDTH, ROW * len(shown) + 1.2)
    rows = range(len(shown))
    axes.barh(rows, [one.similarity for one in shown], BAR, color=BELONGS, zorder=2)
    for row, one in zip(rows, shown, strict=True):
        bound = "" if one.proved else " or more"
        axes.text(one.similarity, row, f" {one.similarity:.2f}{bound}", va="center", color=INK, fontsize=8)
    axes.axvline(found.least, color=INK, linewidth=0.8, linestyle=":")
    axes.set_xlim(0.0, 1.15)
    _dress_rows(axes, [one.name for one in shown])
    dress_chart(axes, f"results similar to {Path(found.query).name}", "similarity; dotted: minimum of a result")
    return figure


def chronology_figure(found: Chronology, axes: Axes | None = None) -> Figure:
    """Draw when each statement held: dark where it certainly held, light where it may have held.

    Parameters
    ----------
    found
        Answer of ``deixis time``.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure. A bar without a known end reaches the edge of the chart.

    Raises
    ------
    DeixisError
        If there are no statements.
    """
    shown = found.fluents[:MAX_ROWS]
    if not shown:
        raise DeixisError(f"{found.file}: there are no statements to draw")
    times = [(found.start(fluent.id), found.finish(fluent.id)) for fluent in shown]
    known = [time for both in times for ends in both for time in (ends.lower, ends.upper) if math.isfinite(time)]
    first, last = min(known, default=0.0), max(known, default=1.0)
    margin = 0.05 * (last - first or 1.0)
    first, last = first - margin, last + margin
    figure, axes = canvas(axes, WIDTH, ROW * len(shown) + 1.2)
    for row, (start, finish) in enumerate(times):
        begin, end = max(start.lower, first), min(finish.upper, last)
        axes.barh(row, end - begin, BAR, left=begin, color=QUIET, alpha=0.45, zorder=2)
        certain = max(start.upper, first), min(finish.lower, last)
        if certain[0] < certain[1]:
            axes.barh(row, certain[1] - certain[0], BAR, left=certain[0], color=BELONGS, zorder=3)
    axes.set_xlim(first, last)
    _dress_rows(axes, [f"{fluent.id}: {fluent.statement}" for fluent in shown])
    since = f" since {found.origin}" if found.origin else ""
    dress_chart(axes, f"{found.file}: certain (dark) and possible times", f"seconds{since}")
    return figure


def _dress_rows(axes: Axes, names: list[str]) -> None:
    """Write the names of the rows, the first one at the top."""
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
