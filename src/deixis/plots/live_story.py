"""Draw the story of a live run: a picture of each key moment, one picture of three of them, and a page."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from deixis.answers import count
from deixis.errors import DeixisError
from deixis.perception.scene import PerceivedObject
from deixis.plots.figure import BELONGS, INK, PAPER, QUIET, WRONG, new_figure, require_picture
from deixis.plots.names import write_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from deixis.memory.perceptual.protocol import Progress
    from deixis.robot.live.moments import Moment
    from deixis.robot.live.run import LiveRobot

OVERVIEW, PAGE = "story.png", "index.html"
"""Names of the picture of the key moments, and of the page."""

SHADES = 96
"""Number of colours of a picture, which keeps its file small."""

LINE = 62
"""Number of characters of a line below a picture."""

MAX_LINES, MAX_SAID = 7, 3
"""Number of lines below a picture, and of each that speaks; the page has all words."""


def write_story(robot: LiveRobot, folder: str | Path, progress: Progress | None = None) -> Path:
    """Write the story of a run: pictures of its key moments, one picture of three of them, and a page.

    Parameters
    ----------
    robot
        The robot at the end of its story.
    folder
        The folder, which is made if it does not exist.
    progress
        Called with the number of pictures that are drawn, and of all.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    DeixisError
        If the folder cannot be written.
    """
    from deixis.robot.live.moments import key_moments

    place = Path(folder)
    require_picture(place / OVERVIEW)
    moments = key_moments(robot.board, robot.began)
    for number, moment in enumerate(moments, 1):
        if progress is not None:
            progress(number - 1, len(moments) + 1)
        write_moments([moment], place / _file(number))
    if moments:
        write_moments(telling(moments), place / OVERVIEW)
    page = place / PAGE
    try:
        page.write_text(_page(moments), encoding="utf-8")
    except OSError as error:
        raise DeixisError(f"{page}: cannot write the page: {error.strerror}") from error
    return page


def telling(moments: Sequence[Moment]) -> tuple[Moment, ...]:
    """Choose three moments that tell a story: a person points at a thing, names become known, and the end.

    Parameters
    ----------
    moments
        All moments in order.

    Returns
    -------
    tuple of Moment
        At most three, in order: the first at which a thing is pointed at, the one after which most things have names
        that had none, and the last one.
    """
    known = [sum(name is not None for name in moment.things.values()) for moment in moments]
    more = [now - before for before, now in zip([0, *known], known, strict=False)]
    pointed = next((place for place, moment in enumerate(moments) if moment.pointed), 0)
    chosen = {pointed, int(np.argmax(more)), len(moments) - 1}
    return tuple(moments[place] for place in sorted(chosen))


def _file(number: int) -> str:
    return f"moment{number:02}.png"


def write_moments(moments: Sequence[Moment], path: Path) -> None:
    """Draw moments side by side, each with what is seen, known and said.

    Parameters
    ----------
    moments
        The moments, from left to right.
    path
        File of the picture, ``.png``.

    Raises
    ------
    DeixisError
        If the file cannot be written.
    """
    figure, panels = new_figure(4.6 * len(moments), 4.8, ncols=len(moments), squeeze=False)
    named = [(axes, _draw(axes, moment)) for axes, moment in zip(panels[0], moments, strict=True)]
    for axes, things in named:
        write_names(figure, axes, things)
    _save(figure, path)


def _draw(axes: Axes, moment: Moment) -> list[PerceivedObject]:
    """Draw the camera's image with outlines, and what is said below it; return the things with their names."""
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_facecolor(PAPER)
    for side in axes.spines.values():
        side.set_color(QUIET)
    layout = f", laid as '{moment.layout.replace('_', ' ')}'" if moment.layout else ""
    pointed = "; orange: pointed at" if moment.pointed else ""
    title = f"{moment.at:.1f} s: {count(len(moment.things), 'thing')}{layout}{pointed}"
    axes.set_title(title, fontsize=9, loc="left", color=INK)
    things: list[PerceivedObject] = []
    if moment.view is not None and moment.view.exists():
        with np.load(moment.view) as view:
            things = _draw_view(axes, moment, view["image"], view["owner"], view["ids"].tolist())
    spoken = [*moment.said, *(("wrong", fault) for fault in moment.faults if not moment.said)]
    lines: list[str] = []
    for speaker, words in spoken:
        whole = textwrap.wrap(f"{speaker}: {words}", LINE, subsequent_indent="   ")
        lines += whole if len(whole) <= MAX_SAID else [*whole[: MAX_SAID - 1], f"{whole[MAX_SAID - 1]} …"]
    lines = [*lines[:MAX_LINES], *[""] * (MAX_LINES - len(lines))]
    axes.set_xlabel("\n".join(lines), fontsize=8, loc="left", color=INK, family="DejaVu Sans")
    return things


def _draw_view(axes: Axes, moment: Moment, image: Any, owner: Any, ids: Sequence[str]) -> list[PerceivedObject]:
    """Draw the image and the outlines of the things; return these as boxes in its pixels, with their names."""
    rows, columns = image.shape[:2]
    axes.imshow(_smooth(image), extent=(0, columns, rows, 0))
    stride = max(1, round(rows / max(len(owner), 1)))
    things = []
    for number, id in enumerate(ids):
        own = np.pad(owner == number, 1)
        if id not in moment.things or not own.any():
            continue
        name = moment.things[id]
        colour = WRONG if id in moment.pointed else BELONGS if name else "#ffffff"
        ys, xs = ((np.arange(length) - 0.5) * stride for length in own.shape)
        axes.contour(xs, ys, own, [0.5], colors=colour, linewidths=2.2 if id in moment.pointed else 1.1)
        y, x = (stride * np.flatnonzero(own.any(axis=axis)) for axis in (1, 0))
        low, high = (float(x[0] - stride), float(y[0] - stride)), (float(x[-1]), float(y[-1]))
        things.append(PerceivedObject(id, low, high, label=name or f"{id}?"))
    axes.set_xlim(0, columns)
    axes.set_ylim(rows, 0)
    return things


def _smooth(image: Any) -> Any:
    """Return an image of half the size without its noise, with values from 0 to 1."""
    rows, columns = (length // 2 * 2 for length in image.shape[:2])
    blocks = image[:rows, :columns].astype(float).reshape(rows // 2, 2, columns // 2, 2, 3)
    return blocks.mean(axis=(1, 3)) / 255


def _save(figure: Figure, path: Path) -> None:
    """Write a picture with few colours."""
    from PIL import Image

    canvas: Any = figure.canvas
    figure.set_dpi(110)
    canvas.draw()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])
    try:
        picture.quantize(SHADES, dither=Image.Dither.NONE).save(path, optimize=True)
    except OSError as error:
        raise DeixisError(f"{path}: cannot write the picture: {error.strerror}") from error


def _page(moments: Sequence[Moment]) -> str:
    shown = []
    for number, moment in enumerate(moments, 1):
        spoken = "".join(f"<li><b>{escape(speaker)}</b>: {escape(words)}</li>" for speaker, words in moment.said)
        wrong = "".join(f'<li class="wrong">{escape(fault)}</li>' for fault in moment.faults)
        known = ", ".join(f"{id} ({(name or 'unknown').replace('_', ' ')})" for id, name in moment.things.items())
        new = f" New: {escape(', '.join(sorted(moment.new)))}." if moment.new else ""
        shown.append(
            f'<section><h2>{number}. {moment.at:.1f} s</h2><img src="{_file(number)}" alt="The table after '
            f'{moment.at:.1f} s"><p>Tracked: {escape(known) or "nothing"}.{new}</p><ul>{spoken}{wrong}</ul></section>'
        )
    style = "body{font:16px sans-serif;max-width:60em;margin:2em auto;padding:0 1em}img{max-width:100%}"
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>The robot runs</title>'
        f"<style>{style}.wrong{{color:{WRONG}}}</style></head>\n"
        f"<body><h1>The robot runs</h1>\n{chr(10).join(shown)}\n</body></html>\n"
    )
