"""Pictures of imagined tables from above, each thing with the outline of its kind."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.errors import DeixisError
from deixis.ontology.things.kinds import Kind, Kinds
from deixis.ontology.things.sizes import Outline
from deixis.perception.scene import PerceivedObject
from deixis.plots.figure import INK, canvas, dress_table, save
from deixis.plots.names import write_names
from deixis.workflows.layouts.imagine import Imagination, ImaginedTable, Sized

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

FILLS = {
    "surface": "#efe9dc",
    "linen": "#f3dfd3",
    "crockery": "#ffffff",
    "cutlery": "#d5dbe1",
    "glassware": "#d8eaf3",
}
OTHER_FILL = "#ece6f2"

Shape = tuple[tuple[float, float], ...]


def plot_table(table: ImaginedTable, kinds: Kinds, path: str | Path, title: str | None = None) -> None:
    """Draw an imagined table from above, as PNG, SVG or PDF by the file's ending.

    Parameters
    ----------
    table
        The table.
    kinds
        The known kinds, which decide the shapes.
    path
        File of the picture.
    title
        Title of the picture.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    """
    save(table_figure(table, kinds, title), path)


def imagination_figure(found: Imagination, axes: Axes | None = None) -> Figure:
    """Draw the first example table.

    Parameters
    ----------
    found
        The tables.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    DeixisError
        If there is no table.
    """
    if not found.tables:
        raise DeixisError(f"{found.script.file}: there is no example table to draw; to_text() says why")
    title = found.script.title or found.script.name
    return table_figure(found.tables[0], found.script.ontology.kinds, title, axes)


def table_figure(table: ImaginedTable, kinds: Kinds, title: str | None = None, axes: Axes | None = None) -> Figure:
    """Draw an example table; the viewer sits at its lower edge.

    Parameters
    ----------
    table
        The table.
    kinds
        The known kinds, which decide the shapes.
    title
        Title of the picture.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    boxes = table.scene.boxes
    if not len(boxes):
        width, height = 0.6, 0.4
    else:
        width, height = (boxes[:, 1, :2].max(axis=0) - boxes[:, 0, :2].min(axis=0)).tolist()
        width, height = max(width, height / 4), max(height, width / 4)
    scale = min(max(9.0, 11.0 * width) / width, max(9.0, 11.0 * height) / height, 20.0 / max(width, height))
    figure, axes = canvas(axes, max(width * scale, 4.0) + 1.6, max(height * scale, 2.5) + 1.4)
    areas = (table.scene.boxes[:, 1, :2] - table.scene.boxes[:, 0, :2]).prod(axis=1)
    drawn = sorted(
        zip(table.scene.objects, table.objects, areas.tolist(), strict=True), key=lambda entry: entry[2], reverse=True
    )
    for order, (thing, sized, _) in enumerate(drawn):
        for patch in _shape(thing, sized, kinds):
            patch.set_zorder(1 + order)
            axes.add_patch(patch)
    axes.set_aspect("equal", adjustable="datalim")  # a long row has room for its names above and below
    axes.margins(0.08)
    dress_table(axes, table.scene, title)
    write_names(figure, axes, table.scene.objects)
    return figure


def _shape(thing: PerceivedObject, sized: Sized, kinds: Kinds) -> list[Patch]:
    """Return the outline of a thing: round, like a fork, a knife or a spoon, or its box with round corners."""
    from matplotlib.patches import Ellipse, FancyBboxPatch

    (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
    width, height = right - x, top - y
    colour = next((colour for word, colour in FILLS.items() if _is(sized.kind, word, kinds)), OTHER_FILL)
    style: dict[str, Any] = {"facecolor": colour, "edgecolor": INK, "linewidth": 1.0}
    if sized.size.outline is Outline.CIRCLE:
        middle = (x + right) / 2, (y + top) / 2
        rings = (1.0, 0.72) if _is(sized.kind, "plate", kinds) else (1.0,)  # a plate has a rim
        return [Ellipse(middle, width * share, height * share, **style) for share in rings]
    if _is(sized.kind, "cutlery", kinds) and max(width, height) > 2 * min(width, height):
        return _cutlery(thing, sized.kind, kinds, style)
    corner = 0.12 * min(width, height)
    inner = (x + corner, y + corner), width - 2 * corner, height - 2 * corner
    return [FancyBboxPatch(*inner, boxstyle=f"round,pad={corner}", mutation_aspect=1, **style)]


def _cutlery(thing: PerceivedObject, kind: Kind | None, kinds: Kinds, style: dict[str, Any]) -> list[Patch]:
    """Return a handle and a head, along the longer side; the head points away from the viewer, or to the left."""
    from matplotlib.patches import Polygon

    (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
    width, height = right - x, top - y
    upright = height >= width
    outline = next((shape for word, shape in _SHAPES.items() if _is(kind, word, kinds)), _BAR)
    corners = [
        (x + across * width, y + along * height) if upright else (right - along * width, y + across * height)
        for across, along in outline
    ]
    return [Polygon(corners, closed=True, joinstyle="round", **style)]


_HANDLE = ((0.35, 0.55), (0.3, 0.0), (0.7, 0.0), (0.65, 0.55))
_BAR: Shape = ((0.0, 1.0), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
_KNIFE = (
    *((0.2, 1.0), (0.0, 0.9), (0.0, 0.45), (0.15, 0.45), (0.15, 0.0)),
    *((0.85, 0.0), (0.85, 0.45), (1.0, 0.5), (1.0, 0.75)),
)
_FORK = (
    *((0.0, 1.0), (0.0, 0.72), (0.2, 0.64)),
    *_HANDLE,
    *((0.8, 0.64), (1.0, 0.72), (1.0, 1.0), (0.85, 1.0), (0.8, 0.78), (0.72, 0.78), (0.67, 1.0)),
    *((0.33, 1.0), (0.28, 0.78), (0.2, 0.78), (0.15, 1.0)),
)
_SPOON = (
    *((0.5, 1.0), (0.24, 0.97), (0.06, 0.89), (0.0, 0.81), (0.06, 0.72), (0.2, 0.65)),
    *_HANDLE,
    *((0.8, 0.65), (0.94, 0.72), (1.0, 0.81), (0.94, 0.89), (0.76, 0.97)),
)
_SHAPES: dict[str, Shape] = {"fork": _FORK, "knife": _KNIFE, "spoon": _SPOON}
"""Outlines within the unit square, across and along."""


def _is(kind: Kind | None, word: str, kinds: Kinds) -> bool:
    broader = kinds.of_word(word)
    return kind is not None and broader is not None and kinds.is_a(kind, broader)
