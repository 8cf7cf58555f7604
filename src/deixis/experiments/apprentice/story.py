"""Tell one run as a story: key frames as pictures, as in the paper's Figure 5, and a page that shows them in order.

A robot is shown four things on a first table, learns a layout from words, and looks at further tables with mistakes. It
is a small run of its own, with the seed of the plan.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from deixis.experiments.apprentice.run import ApprenticePlan, looked_at, teach
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import Scene
from deixis.plots.figure import BELONGS, INK, QUIET, WRONG, new_figure, require_picture, save
from deixis.plots.names import write_names
from deixis.robot.looking import Fault
from deixis.robot.robot import Robot

STORY_TABLES = 4
"""Number of further tables in the story."""

MAX_POINTS = 20_000
"""Number of points of a cloud that a frame shows."""

WOOD = "#e3d9cb"
"""Colour of the table."""

LEGEND = (
    "Each picture shows the points that the camera saw, from above, with the boxes of the things that were detected. "
    "Blue names are known, orange ones are of things that are wrong, and ? marks things that are not known yet."
)
"""Explanation of the pictures on the page."""

FIRST = "frame01.png"
"""Name of the first key frame."""


@dataclass(frozen=True)
class Frame:
    """A key frame: its file and what happened."""

    file: str
    caption: str


def write_story(plan: ApprenticePlan, folder: Path) -> tuple[Frame, ...]:
    """Write key frames of a small run, and the page ``index.html``, to a folder.

    Parameters
    ----------
    plan
        The plan, of which the seed, the noise and the layouts are used.
    folder
        The folder, which is made if it does not exist.

    Returns
    -------
    tuple of Frame
        The frames in order.

    Raises
    ------
    DeixisError
        If the folder cannot be written.
    """
    require_picture(folder / FIRST)
    small = replace(plan, tables=STORY_TABLES, first_tables=1)
    frames: list[Frame] = []

    def keep(scene: Scene, names: Mapping[str, tuple[str, str]], caption: str) -> None:
        file = f"frame{len(frames) + 1:02}.png"
        _draw(scene, names, caption, folder / file)
        frames.append(Frame(file, caption))

    with tempfile.TemporaryDirectory() as memory, closing(Robot(memory)) as robot:
        _teaching(robot, small, keep)
        knowledge = robot.knowledge()
        for number in range(small.tables):
            seen = looked_at(knowledge, small, number)
            understood = seen[4]
            faults = understood.faults()
            wrong = {thing: fault for fault in faults for thing in fault.things}
            names = {
                id: ((understood.name(id) or "unknown").replace("_", " "), WRONG if id in wrong else BELONGS)
                for id in understood.scene.ids
            }
            layout = (understood.layout or "no known layout").replace("_", " ")
            keep(understood.scene, names, f"Table {number + 1} is laid as: {layout}. {_spoken_faults(faults)}")
    (folder / "index.html").write_text(_page(frames), encoding="utf-8")
    return tuple(frames)


def _teaching(
    robot: Robot, plan: ApprenticePlan, keep: Callable[[Scene, Mapping[str, tuple[str, str]], str], None]
) -> None:
    """Teach the robot, and keep a frame of what each first table taught."""
    for lesson in teach(robot, plan):
        known = robot.lessons[lesson.number]
        taught = {settled.thing: role for role, settled in known.settled.items()}
        names = {id: (taught[id].replace("_", " "), BELONGS) if id in taught else ("?", INK) for id in known.scene.ids}
        asked = f", and asks {lesson.questions} time{'s' * (lesson.questions > 1)}" if lesson.questions else ""
        title = lesson.layout.replace("_", " ")
        keep(known.scene, names, f"The teacher describes: {title}. The robot learns {len(taught)} things{asked}.")


def _spoken_faults(faults: tuple[Fault, ...]) -> str:
    if not faults:
        return "Nothing is wrong."
    listed = "; ".join(str(fault) for fault in faults)
    return f"{listed[0].upper()}{listed[1:]}."


def _draw(scene: Scene, names: Mapping[str, tuple[str, str]], caption: str, path: Path) -> None:
    """Draw the points of all things from above in their colours, with boxes and names."""
    figure, axes = new_figure(7.0, 5.2)
    axes.set_facecolor(WOOD)
    for thing in scene.objects:
        if isinstance(thing.cloud, PointCloud):
            step = max(1, len(thing.cloud) * len(scene.objects) // MAX_POINTS)
            points = thing.cloud.points[::step]
            shades = np.full(len(points), 0.5) if thing.cloud.colours is None else thing.cloud.colours[::step] / 255
            axes.scatter(points[:, 0], points[:, 1], c=shades, s=2.5, linewidths=0, rasterized=True)
    for thing in scene.objects:
        _, colour = names.get(thing.id, ("", QUIET))
        low, high = np.array(thing.minimum[:2]), np.array(thing.maximum[:2])
        corners = np.array([low, (high[0], low[1]), high, (low[0], high[1]), low])
        axes.plot(corners[:, 0], corners[:, 1], color=colour, linewidth=1.6)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_title(caption, fontsize=8, loc="left", color=INK, wrap=True)
    for side in axes.spines.values():
        side.set_color(QUIET)
    named = [replace(thing, label=names[thing.id][0]) for thing in scene.objects if thing.id in names]
    write_names(figure, axes, named, colours={id: colour for id, (_, colour) in names.items()})
    save(figure, path)


def _page(frames: list[Frame]) -> str:
    from html import escape

    shown = "\n".join(
        f'<figure><img src="{frame.file}" alt="{escape(frame.caption)}"><figcaption>{number}. {escape(frame.caption)}'
        "</figcaption></figure>"
        for number, frame in enumerate(frames, 1)
    )
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><title>The apprentice</title>'
        "<style>body{font:16px sans-serif;max-width:60em;margin:2em auto}img{max-width:100%}</style>"
        f"<h1>The apprentice</h1>\n<p>{LEGEND}</p>\n{shown}</html>\n"
    )
