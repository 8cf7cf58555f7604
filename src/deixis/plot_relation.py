"""A picture of what a relation word means: how well it holds of a thing that stands here or there."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relation import Relation
from deixis.ontology.relation_models import RelationModels
from deixis.plot import INK, PAPER, QUIET, new_figure, save
from deixis.reasoning.graded.degrees import relation_degree
from deixis.reasoning.graded.geometry import pair_geometry

if TYPE_CHECKING:
    from matplotlib.figure import Figure

REFERENCE = ((-0.5, -0.5), (0.5, 0.5))
SUBJECT = 0.4
"""The width and depth of the thing that is moved about, in widths of the reference object."""

REACH = 3.0


def plot_relation(relation: Relation, models: RelationModels, path: str | Path) -> None:
    """Writes the field around a reference object as PNG, SVG or PDF by the file's ending.

    Raises DeixisError where the file cannot be written or its ending is no picture.
    """
    save(relation_figure(relation, models), path)


def field(relation: Relation, models: RelationModels, steps: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places on each axis (steps,), and degrees of a thing centred there, shape (steps, steps), rows by y."""
    places = np.linspace(-REACH, REACH, steps)
    half = np.array([SUBJECT, SUBJECT]) / 2
    degrees = np.empty((steps, steps))
    for row, y in enumerate(places):
        for column, x in enumerate(places):
            centre = np.array([x, y])
            pairs = pair_geometry(np.array([[centre - half, centre + half], REFERENCE]))
            degrees[row, column] = relation_degree(pairs, relation, models)[0, 1]
    return places, degrees


def relation_figure(relation: Relation, models: RelationModels, steps: int = 61) -> Figure:
    """Degrees as a heat map with contours; the reference object drawn, and the thing that is moved, in the corner."""
    from matplotlib.patches import Rectangle

    figure, axes = new_figure(6.4, 5.6)
    places, degrees = field(relation, models, steps)
    shown = axes.contourf(places, places, degrees, levels=np.linspace(0, 1, 21), cmap="Blues")
    lines = axes.contour(places, places, degrees, levels=[0.1, 0.25, 0.5, 0.75], colors=INK, linewidths=0.7)
    axes.clabel(lines, fmt="%g", fontsize=7.5)
    axes.add_patch(Rectangle(REFERENCE[0], 1, 1, fill=False, edgecolor=INK, linewidth=1.6))
    axes.text(0.56, -0.5, "reference", ha="left", va="bottom", fontsize=8.5, color=INK)
    corner = REACH - SUBJECT - 0.15
    axes.add_patch(Rectangle((corner, -REACH + 0.15), SUBJECT, SUBJECT, facecolor=PAPER, edgecolor=QUIET))
    axes.text(
        corner - 0.08, -REACH + 0.15 + SUBJECT / 2, "subject", ha="right", va="center", fontsize=7.5, color="#4c565f"
    )
    axes.set_aspect("equal")
    axes.set_xlabel("subject's centre, in widths of the reference; right as seen from the chair", fontsize=8.5)
    axes.set_ylabel("away from the chair", fontsize=8.5)
    axes.set_title(f"How well '{relation.phrase}' holds", color=INK, fontsize=12, loc="left", parse_math=False)
    axes.tick_params(colors=INK, labelsize=8)
    bar = figure.colorbar(shown, ax=axes, ticks=[0, 0.25, 0.5, 0.75, 1])
    bar.set_label("degree", color=INK, fontsize=8.5)
    return figure
