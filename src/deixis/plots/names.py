"""Names in a picture from above, each at its thing and without overlaps.

Two libraries that place labels were tried on the pictures of `ground`, `check`, `imagine` and `perceive`. They give
worse pictures: they know anchor points, not areas, and write no name upright on a narrow thing. textalloc 1.2.4 puts
the dinner plate's name on the napkin that lies on it, and the names of cutlery on the plate, with lines that cross
other things; it takes 1.1 to 2.3 times as long (medians of 7: 0.29 and 0.41 s for 12 things, 0.43 and 1.00 s for 42 in
two views). adjustText 1.4.0 does not settle within 5 s, and its names cross the outlines of other things (5 or 6 of 12,
19 of 42; ours none of 12, and 1 of 42).
"""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.answers import count
from deixis.perception.scene import PerceivedObject
from deixis.plots.figure import FADED_INK, INK, PAPER, WRONG
from deixis.plots.placement import ArrowPixels, Box, NamePlace, name_places, word_places

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FONT = 8.0
LONGEST = 48
"""Maximum number of characters of a name, with its id and probability."""


def write_names(
    figure: Figure,
    axes: Axes,
    things: Sequence[PerceivedObject],
    quiet: Collection[str] = (),
    arrows: Sequence[NDArray[np.float64]] = (),
    words: Sequence[tuple[str, NDArray[np.float64]]] = (),
    colours: Mapping[str, str] | None = None,
) -> None:
    """Write every thing's label where it covers no other name and no arrow, and as little else as possible.

    A name that does not fit on its thing stands beside it. A line joins the two where they are apart; it crosses no
    other thing and no name. Where things are very many, or there is no room, names are left out, and the axis gives
    their number. This fixes the layout of the figure.

    Parameters
    ----------
    figure
        The figure, whose layout is fixed by this.
    axes
        Axes with the drawn things.
    things
        What to name: the label is written, or the id of a thing without one. A line break in it starts a new line.
    quiet
        Ids of the things whose names are grey.
    arrows
        Points along each arrow of the picture, in the units of the axes, each of shape (k, 2).
    words
        Words with the arrows that they belong to; each is written at the middle of its arrow where there is room.
    colours
        Colours of names by the ids of their things, instead of the usual one.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)  # a letter that the font lacks
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        pixels = axes.transData.transform
        corners = np.array([[thing.minimum[:2], thing.maximum[:2]] for thing in things]).reshape(-1, 2)
        ends = pixels(corners).reshape(-1, 2, 2)
        outlines = np.hstack([ends.min(axis=1), ends.max(axis=1)])  # an axis may run downwards
        frame = Box(*axes.bbox.extents)
        arrow_pixels = ArrowPixels([pixels(arrow) for arrow in arrows], frame)
        names = [_shown(thing.label or thing.id) for thing in things]
        places = name_places(outlines, [_measured(figure, name) for name in names], frame, arrow_pixels)
        for thing, name, place in zip(things, names, places, strict=True):
            if place is not None:
                look = {"color": (colours or {}).get(thing.id, INK)}
                _write(axes, name, place, QUIET_LOOK if thing.id in quiet else look)
        placed = [place for place in places if place is not None]
        paths = [pixels(arrow) for _, arrow in words]
        sizes = [_measured(figure, word) for word, _ in words]
        boxes = word_places(paths, sizes, outlines, placed, frame, arrow_pixels)
        for (word, _), box in zip(words, boxes, strict=True):
            if box is not None:
                _write_word(axes, word, box)
        if len(placed) < len(things):
            left_out = count(len(things) - len(placed), "name")
            axes.set_xlabel(f"{axes.get_xlabel()}; {left_out} left out for lack of room")


def _shown(name: str) -> str:
    """Return a name as it is read, each line shortened if it is very long; one made of underscores stays as it is.

    >>> _shown("wine_glass_2"), _shown("_")
    ('wine glass 2', '_')
    """
    shown = name.replace("_", " ") if name.strip("_ ") else name
    return "\n".join(line if len(line) <= LONGEST else f"{line[: LONGEST - 1]}…" for line in shown.split("\n"))


def _measured(figure: Figure, text: str) -> tuple[float, float]:
    """Return width and height of a text in pixels, with a little air."""
    drawn = figure.text(0, 0, text, fontsize=FONT, parse_math=False)
    extent = drawn.get_window_extent()
    drawn.remove()
    return extent.width + 5, extent.height + 4


def _write_word(axes: Axes, word: str, box: Box) -> None:
    from matplotlib import patheffects

    x, y = axes.transData.inverted().transform(box.middle).tolist()
    look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": FONT - 0.5, "color": WRONG}
    stroke = [patheffects.withStroke(linewidth=2.2, foreground=PAPER)]
    axes.text(x, y, word, zorder=950, path_effects=stroke, **look)


QUIET_LOOK = {"color": FADED_INK, "style": "italic"}


def _write(axes: Axes, name: str, place: NamePlace, look: Mapping[str, Any]) -> None:
    from matplotlib import patheffects

    inverse = axes.transData.inverted()
    if place.leader is not None:
        (x0, y0), (x1, y1) = inverse.transform(place.leader).tolist()
        axes.plot([x0, x1], [y0, y1], color=INK, linewidth=0.6, zorder=900, scalex=False, scaley=False)
    x, y = inverse.transform(place.box.middle).tolist()
    axes.text(
        x,
        y,
        name,
        ha="center",
        va="center",
        rotation=place.rotation,
        fontsize=FONT,
        zorder=1000,
        parse_math=False,
        path_effects=[patheffects.withStroke(linewidth=2.2, foreground=PAPER)],
        **look,
    )
