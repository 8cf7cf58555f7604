"""Picture of the meaning of a relation word: its degree by the subject's place around a reference object."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import FAMILIES, RelationModel, RelationModels
from deixis.ontology.relations.relation import Relation
from deixis.plots.figure import INK, PAPER, new_figure, save
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

REFERENCE = ((-0.5, -0.5), (0.5, 0.5))
SUBJECT = 0.4
"""Width and depth of the subject, in widths of the reference object."""

REACH, NEAR_REACH = 3.0, 1.25
"""Extent of the field from the reference object's centre, in its widths; and of the field of ``on`` and ``under``."""

LINES = (0.1, 0.25, 0.5, 0.75)
"""Degrees of the contours."""


def plot_relation(relation: Relation, models: RelationModels, path: str | Path) -> None:
    """Write the field around a reference object as PNG, SVG or PDF by the file's ending.

    Parameters
    ----------
    relation
        The relation.
    models
        Models of relation words.
    path
        File of the picture.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    """
    save(relation_figure(relation, models), path)


def field(relation: Relation, models: RelationModels, steps: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Compute the degree of a relation for a subject at each place around a reference object.

    Parameters
    ----------
    relation
        The relation.
    models
        Models of relation words.
    steps
        Number of places on each axis.

    Returns
    -------
    tuple
        Coordinates, shape (steps,), and degrees in [0, 1], shape (steps, steps).
    """
    reach = _reach(relation)
    places = np.linspace(-reach, reach, steps)
    half = np.array([SUBJECT, SUBJECT]) / 2
    degrees = np.empty((steps, steps))
    for row, y in enumerate(places):
        centres = np.stack([places, np.full(steps, y)], axis=1)
        subjects = np.stack([centres - half, centres + half], axis=1)
        pairs = pair_geometry(np.concatenate([subjects, [REFERENCE]]))
        degrees[row] = WordDegrees(pairs, models).of(relation)[:-1, -1]
    return places, degrees


def relation_figure(relation: Relation, models: RelationModels, steps: int = 181) -> Figure:
    """Draw the degrees as a heat map with contours, with the reference object, and the subject in the corner.

    Parameters
    ----------
    relation
        The relation.
    models
        Models of relation words.
    steps
        Number of places on each axis.

    Returns
    -------
    Figure
        The figure.
    """
    figure, axes = new_figure(7.4, 6.3)
    places, degrees = field(relation, models, steps)
    shown = axes.contourf(places, places, degrees, levels=np.linspace(0, 1, 41), cmap="Blues")
    lines = axes.contour(places, places, degrees, levels=LINES, colors=INK, linewidths=0.7)
    _boxes(axes, _reach(relation))
    axes.set_aspect("equal")
    axes.set_xlabel("subject's centre, in widths of the reference; right as seen from the chair", fontsize=8.5)
    axes.set_ylabel("away from the chair", fontsize=8.5)
    title = f"Degree to which '{relation.phrase}' holds ({_origin(models.of(relation))})"
    axes.set_title(title, color=INK, fontsize=12, loc="left", parse_math=False)
    axes.tick_params(colors=INK, labelsize=8)
    bar = figure.colorbar(shown, cax=axes.inset_axes((1.03, 0.0, 0.045, 1.0)), ticks=[0, *LINES, 1], format="%g")
    bar.add_lines(lines)
    bar.ax.tick_params(colors=INK, labelsize=8)
    bar.set_label("degree; the lines are contours of the field", color=INK, fontsize=8.5)
    return figure


def _reach(relation: Relation) -> float:
    return NEAR_REACH if FAMILIES.get(relation.word) == "support" else REACH


def _origin(model: RelationModel) -> str:
    """Return whether a meaning is shipped, or from how many facts it was learned."""
    origin = model.provenance
    if origin.made is None:
        return "shipped model"
    number = round(origin.examples, 1)
    return f"learned from {number:g} {'fact' if number == 1 else 'facts'}"


def _boxes(axes: Axes, reach: float) -> None:
    """Draw the reference object, and the subject in the corner, in the scale of the field."""
    from matplotlib import patheffects
    from matplotlib.patches import Rectangle

    halo = [patheffects.withStroke(linewidth=2.2, foreground=PAPER)]
    axes.add_patch(Rectangle(REFERENCE[0], 1, 1, fill=False, edgecolor=INK, linewidth=1.6))
    axes.text(0.5 + 0.02 * reach, -0.5, "reference", ha="left", va="bottom", fontsize=8.5, color=INK, path_effects=halo)
    edge = 0.05 * reach
    left, low = reach - SUBJECT - edge, edge - reach
    axes.add_patch(Rectangle((left, low), SUBJECT, SUBJECT, facecolor=PAPER, edgecolor=INK))
    axes.text(
        *(left - edge / 2, low + SUBJECT / 2, "subject"),
        ha="right",
        va="center",
        fontsize=8.5,
        color=INK,
        path_effects=halo,
    )
