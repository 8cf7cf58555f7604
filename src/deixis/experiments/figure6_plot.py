"""The scatter plots of Figure 6."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from deixis.plot import INK, PAPER, QUIET, new_figure, save

if TYPE_CHECKING:
    from deixis.experiments.figure6 import Points


def plot_points(points: Points, path: Path, title: str, rho: float) -> None:
    """Graph similarity against the share named right, a point a sub-graph, coloured by the facts it satisfies."""
    figure, axes = new_figure(6.4, 4.4)
    drawn = axes.scatter(
        points.similarity, points.right, c=points.facts, cmap="viridis", s=18, alpha=0.75, linewidths=0
    )
    bar = figure.colorbar(drawn, ax=axes, pad=0.02)
    bar.set_label("satisfied facts (sum of degrees)", color=INK, fontsize=9)
    bar.outline.set_edgecolor(QUIET)
    axes.set_xlabel("overall graph similarity", color=INK, fontsize=9)
    axes.set_ylabel("share of objects named right\n(mean over node orders)", color=INK, fontsize=9)
    axes.set_title(f"{title}, Spearman's ρ = {rho:.2f}", color=INK, fontsize=11, loc="left")
    axes.set_ylim(-0.03, 1.03)
    axes.set_facecolor(PAPER)
    axes.grid(color=QUIET, alpha=0.25, linewidth=0.6)
    for side in axes.spines.values():
        side.set_color(QUIET)
    save(figure, path)
