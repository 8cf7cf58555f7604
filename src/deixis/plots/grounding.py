"""Pictures of grounded scenes from above."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.answers import count
from deixis.errors import DeixisError
from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots.arrows import Arrow, Ends, arrow_path, directions, draw_arrows, draw_directions, drawing_order
from deixis.plots.figure import BELONGS, INK, PALETTE, PAPER, QUIET, WRONG, canvas, dress_table, save
from deixis.plots.names import write_names
from deixis.reasoning.grounding.answers.answer import FactOutcome, Grounding
from deixis.reasoning.grounding.options import DECIDED
from deixis.report.grounding.ground import MAX_LISTED, probability_text, shortened_list

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    from deixis.ontology.lessons.types import Match
    from deixis.reasoning.grounding.reference.answer import Reference
    from deixis.robot.looking import Look
    from deixis.robot.robot import Told
    from deixis.workflows.knowledge.learn import Learned

GROUP_COLOURS = tuple(PALETTE[number] for number in (4, 1, 2, 3, 0, 6))
"""Colours of groups of interchangeable objects."""

PLAIN_FILL, UNNAMED_FILL = "#ffffff", "#eceae4"

HATCH = "////"
"""Hatching of things of a wrong colour."""

WIDTH, MIN_HEIGHT, MAX_HEIGHT = 9.0, 3.0, 12.0
"""Width of a picture and height of the table in it, in inches."""

LEGEND_LINE = 0.17
"""Height of a line of the legend, in inches."""

LINE, HALF_LINE, TITLE_LINE = 115, 50, 75
"""Characters that fit into a line of the legend, into half of one, and into one of the title."""

LEAST_ALPHA = 0.2
"""Opacity of the edge of a thing whose name is almost certainly wrong."""

MAX_WORDS = 30
"""Maximum number of arrows of violated facts that have a word."""

LEAST_SHOWN = 0.005
"""Minimum probability at which an alternative is named in a picture: 0.01 with two digits."""

WAY_BEND = 0.25
"""Bend of the way of a misplaced object to its place, as a share of its length."""

NO_BREAK = "\u00a0"


@dataclass(frozen=True, slots=True)
class Marks:
    """Ids of the things that a picture marks, and boxes (2, 2) where objects belong, by name.

    ``wrong`` things have an edge of their own colour, ``miscoloured`` ones are hatched, ``unsure`` ones have a dotted
    edge. ``belongs`` are drawn as ghosts, with an arrow from the thing of a misplaced object to its ghost.
    """

    wrong: Collection[str] = ()
    miscoloured: Collection[str] = ()
    unsure: Collection[str] = ()
    belongs: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)


NO_MARKS = Marks()


def plot_grounding(found: Grounding, path: str | Path, title: str | None = None) -> None:
    """Draw the scene from above with the names found, as PNG, SVG or PDF by the file's ending.

    Satisfied facts are grey arrows, violated ones orange; interchangeable objects share a colour; things without a name
    are grey.

    Parameters
    ----------
    found
        The grounding.
    path
        File of the picture.
    title
        Title of the picture.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    """
    save(answer_figure(found, title=title), path)


def answer_figure(found: Grounding, axes: Axes | None = None, title: str | None = None) -> Figure:
    """Draw a grounding in its own scene, from the side that was recovered if one was.

    Parameters
    ----------
    found
        The grounding.
    axes
        Axes to draw into, or None for a new figure.
    title
        Title of the picture.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    DeixisError
        If the engine was called without a scene.
    """
    from deixis.reasoning.grounding.hypotheses.hypotheses import side_text
    from deixis.workflows.grounding.viewpoint import scene_from

    if not isinstance(found.scene, Scene):
        raise DeixisError("this grounding has no scene to draw: an engine was called directly; use deixis.ground")
    side = found.viewpoints[0] if found.viewpoints else None
    if side is None:
        return grounding_figure(found, found.scene, title, axes=axes)
    if side.angle or side.mirrored:
        title = ", ".join(filter(None, (title, f"scene {side_text(side.angle, side.mirrored)}")))
    return grounding_figure(found, scene_from(found.scene, side), title, axes=axes)


def learned_figure(learned: Learned, axes: Axes | None = None) -> Figure:
    """Draw the grounding of a lesson in its scene.

    Parameters
    ----------
    learned
        Answer of ``deixis learn``.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    return answer_figure(learned.grounding, axes)


def told_figure(told: Told, axes: Axes | None = None) -> Figure:
    """Draw the grounding of a lesson of a robot in the table that it saw.

    Parameters
    ----------
    told
        Answer of :meth:`deixis.robot.robot.Robot.told`.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    return learned_figure(told.learned, axes)


def scene_figure(scene: Scene, axes: Axes | None = None, title: str | None = None) -> Figure:
    """Draw the boxes of a scene from above, each with its label or id.

    Parameters
    ----------
    scene
        The scene.
    axes
        Axes to draw into, or None for a new figure.
    title
        Title above the table, if any.

    Returns
    -------
    Figure
        The figure.
    """
    figure, axes = canvas(axes, WIDTH, _table_height(scene) + 0.9)
    named = {thing.id: thing.label for thing in scene.objects if thing.label}
    _draw_boxes(axes, scene, named, {}, NO_MARKS, {})
    _finish(figure, axes, scene, named, (), title)
    return figure


def reference_figure(found: Reference, axes: Axes | None = None) -> Figure:
    """Draw the scene of a description: the object that is meant, and its alternatives, with their probabilities.

    A decided object is coloured. The edges of improbable objects fade; objects that the description excludes are grey.

    Parameters
    ----------
    found
        Answer of ``deixis refer``.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    DeixisError
        If the description refers to no object.
    """
    if not isinstance(found.scene, Scene) or found.target is None:
        raise DeixisError(f"'{found.text}': there is no object to draw; to_text() says why")
    listed = [(id, probability) for id, probability in found.alternatives if probability >= LEAST_SHOWN]
    likely = {found.target: found.probability, **dict(listed)}
    labels = {}
    for thing in found.scene.objects:
        if thing.id in likely:
            name = f"{thing.label} ({thing.id})" if thing.label else thing.id
            labels[thing.id] = f"{name} {probability_text(likely[thing.id])}"
    figure, axes = canvas(axes, WIDTH, _table_height(found.scene) + 0.9)
    meant = {labels[found.target]: BELONGS} if found.decided else {}
    _draw_boxes(axes, found.scene, labels, meant, NO_MARKS, likely)
    _finish(figure, axes, found.scene, labels, (), f"“{found.text}”")
    return figure


def look_figure(look: Look, axes: Axes | None = None) -> Figure:
    """Draw what a robot concludes about a table: the name of each thing, and what is wrong.

    Names below 0.99 have their probabilities and faded edges. Things that are in a mistake have an edge of their own
    colour; the title says what is wrong. Ghosts show where missing, displaced and swapped things belong.

    Parameters
    ----------
    look
        Answer of :meth:`deixis.robot.robot.Robot.look`.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    from matplotlib.patches import Patch

    own_figure = axes is None
    figure, axes = canvas(axes, WIDTH, _table_height(look.scene) + 1.3)
    faults = look.faults()
    labels, sureness = {}, {}
    for thing, names in look.names.items():
        name = look.name(thing)
        if name is not None:
            sureness[thing] = names[name]
            labels[thing] = name if names[name] >= DECIDED else f"{name} {probability_text(names[name])}"
    marks = Marks(wrong={thing for fault in faults for thing in fault.things})
    _draw_boxes(axes, look.scene, labels, {}, marks, sureness)
    moved = {role: thing for fault in faults for role, thing in zip(fault.names, fault.things, strict=False)}
    places = look.places()
    ghosts, ways = _draw_ghosts(axes, look.scene, moved, places)
    keys = [Patch(facecolor=PAPER, edgecolor=WRONG, label="in a mistake")] if marks.wrong else []
    keys += _ghost_keys(places, moved)
    if keys and own_figure:
        figure.legend(loc="outside lower center", handles=keys, fontsize=8, frameon=False, ncols=2)
    title = "no known layout" if look.layout is None else "; ".join((f"'{look.layout}'", *map(str, faults)))
    _finish(figure, axes, look.scene, labels, [arrow_path(way, WAY_BEND) for way in ways], title, ghosts)
    return figure


def grounding_figure(
    found: Grounding, scene: Scene, title: str | None = None, marks: Marks = NO_MARKS, axes: Axes | None = None
) -> Figure:
    """Draw a grounding, with what is marked in it.

    Parameters
    ----------
    found
        The grounding.
    scene
        Its scene.
    title
        Title of the picture.
    marks
        Ids of the things to mark.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    groups = [group for group in found.interchangeable if any(name in found.matches for name in group)]
    colours = {name: GROUP_COLOURS[i % len(GROUP_COLOURS)] for i, group in enumerate(groups) for name in group}
    keys = _keys(found, groups, marks)
    legend_height = LEGEND_LINE * sum(1 + str(key.get_label()).count("\n") for key in keys)
    own_figure = axes is None
    figure, axes = canvas(axes, WIDTH, _table_height(scene) + 0.9 + legend_height)
    names = {match.perceived: match.object for match in found.matches.values()}
    sureness = {match.perceived: match.sureness for match in found.matches.values()}
    _draw_boxes(axes, scene, names, colours, marks, sureness)
    things = {match.object: match.perceived for match in found.matches.values()}
    ghosts, ways = _draw_ghosts(axes, scene, things, marks.belongs)
    ends = Ends(scene.objects)
    satisfied, violated = _arrows(found.satisfied, ends), _arrows(found.violated, ends)
    draw_arrows(axes, satisfied, QUIET, 0.8, 3)
    draw_arrows(axes, violated, WRONG, 1.8, 7)
    if keys:
        columns = 2 if all(len(key.get_label()) <= HALF_LINE for key in keys) else 1
        legend: dict[str, Any] = {"handles": keys, "fontsize": 8, "frameon": False, "ncols": columns}
        if own_figure:
            figure.legend(loc="outside lower center", **legend)
        else:
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), **legend)
    paths = [*map(arrow_path, satisfied + violated), *(arrow_path(way, WAY_BEND) for way in ways)]
    labels = {match.perceived: _doubtful_label(match, names, colours) for match in found.matches.values()}
    shown = _with_ids(scene, {id for match in found.matches.values() for id in _alternatives(match) if id not in names})
    _finish(figure, axes, shown, labels, paths, title, ghosts, _words(found.violated, ends))
    return figure


MAX_ALTERNATIVES = 2
"""Maximum number of alternatives in the label of an undecided match."""


def _alternatives(match: Match) -> list[str]:
    """Return the ids of the things in the label of an undecided match."""
    return [other.perceived for other in match.alternatives[:MAX_ALTERNATIVES] if other.perceived is not None]


def _with_ids(scene: Scene, ids: Collection[str]) -> Scene:
    """Return a scene in which the labels of some things are followed by the ids that other labels refer to."""
    return replace(
        scene,
        objects=tuple(
            replace(thing, label=f"{thing.label} ({thing.id})") if thing.label and thing.id in ids else thing
            for thing in scene.objects
        ),
    )


def _doubtful_label(match: Match, names: Mapping[str, str], colours: Mapping[str, str]) -> str:
    """Return a name, with its probability if that is below 0.99, and the alternatives of an undecided match.

    Interchangeable objects have one colour, and the legend lists them; in a large group the probability is left out.
    """
    if match.decided:
        return match.object
    if match.object in colours and len(match.alternatives) >= MAX_LISTED:
        return match.object
    label = match.object if match.probability is None else f"{match.object} {probability_text(match.probability)}"
    if match.object in colours or not match.alternatives:
        return label
    others = match.alternatives[:MAX_ALTERNATIVES]
    places = [names.get(id, id) for id in _alternatives(match)]
    where = [f"at {', '.join(places)}"] if places else []
    where += ["absent"] if len(places) < len(others) else []
    return f"{label}\nor {', or '.join(where)}{', …' if len(match.alternatives) > len(others) else ''}"


def _words(entries: Sequence[FactOutcome], ends: Ends) -> list[tuple[str, NDArray[np.float64]]]:
    """Return the words of the first violated facts, with the paths of their arrows."""
    drawn = [(entry.fact, entry.perceived) for entry in entries if entry.perceived is not None][:MAX_WORDS]
    return [(fact.relations[0].phrase, arrow_path(ends.arrow(*perceived))) for fact, perceived in drawn]


def _draw_ghosts(
    axes: Axes, scene: Scene, things: Mapping[str, str], belongs: Mapping[str, NDArray[np.float64]]
) -> tuple[list[PerceivedObject], list[Arrow]]:
    """Draw where objects belong, and the ways there from their ``things``; return the named ghosts and the ways."""
    from matplotlib.patches import FancyArrowPatch, Rectangle

    boxes = {thing.id: box for thing, box in zip(scene.objects, scene.boxes[:, :, :2], strict=True)}
    ghosts, ways = [], []
    for name, (low, high) in belongs.items():
        look: dict[str, Any] = {"edgecolor": BELONGS, "facecolor": BELONGS, "linestyle": (0, (2, 2)), "linewidth": 1.4}
        axes.add_patch(Rectangle(tuple(low), *(high - low), fill=False, zorder=6, **look))
        axes.add_patch(Rectangle(tuple(low), *(high - low), alpha=0.08, linewidth=0, color=BELONGS, zorder=1.5))
        thing = things.get(name)
        if thing is None:
            ghosts.append(PerceivedObject(f"ghost of {name}", tuple(low), tuple(high), label=f"{name} belongs here"))
            continue
        start, end = boxes[thing].mean(axis=0).tolist(), ((low + high) / 2).tolist()
        ways.append(((start[0], start[1]), (end[0], end[1])))
        way = FancyArrowPatch(
            *ways[-1],
            arrowstyle="-|>",
            mutation_scale=12,
            connectionstyle=f"arc3,rad={WAY_BEND}",
            color=BELONGS,
            linewidth=1.8,
            linestyle=(0, (4, 2)),
            zorder=8,
        )
        way.set_in_layout(False)
        axes.add_patch(way)
    return ghosts, ways


def _table_height(scene: Scene) -> float:
    if not scene.objects:
        return WIDTH
    low, high = scene.boxes[:, 0, :2].min(axis=0), scene.boxes[:, 1, :2].max(axis=0)
    width, height = map(float, high - low)
    return min(max(WIDTH * height / max(width, height / 4, 1e-9), MIN_HEIGHT), MAX_HEIGHT)


def _finish(
    figure: Figure,
    axes: Axes,
    scene: Scene,
    names: Mapping[str, str],
    arrows: Sequence[NDArray[np.float64]],
    title: str | None,
    ghosts: Sequence[PerceivedObject] = (),
    words: Sequence[tuple[str, NDArray[np.float64]]] = (),
) -> None:
    """Set the frame of a table from above, and write the names of the things where they cover least."""
    axes.set_aspect("equal", adjustable="datalim")  # a long row has room for its names above and below
    axes.margins(0.06)
    dress_table(axes, scene, title and textwrap.fill(title, TITLE_LINE))
    heads = directions(scene)
    draw_directions(axes, heads, INK)
    named = [replace(thing, label=names.get(thing.id) or thing.label or thing.id) for thing in scene.objects]
    quiet = {thing.id for thing in scene.objects if thing.id not in names}
    paths = [*arrows, *(arrow_path(head, bend=0.0) for head in heads)]
    write_names(figure, axes, [*named, *ghosts], quiet, paths, words)


def _arrows(entries: Sequence[FactOutcome], ends: Ends) -> list[Arrow]:
    return [ends.arrow(*entry.perceived) for entry in entries if entry.perceived is not None]


def _draw_boxes(
    axes: Axes,
    scene: Scene,
    names: Mapping[str, str],
    colours: Mapping[str, str],
    marks: Marks,
    sureness: Mapping[str, float],
) -> None:
    """Draw the fills, over them the hatching, and over both the edges, which fade with doubt."""
    from matplotlib.collections import PatchCollection

    things = drawing_order(scene.objects)
    fills = [_rectangle(thing, **_fill(names.get(thing.id), colours)) for thing in things]
    edges = [
        _rectangle(thing, **_edge(thing.id, names.get(thing.id), colours, marks, sureness.get(thing.id, 1.0)))
        for thing in things
    ]
    hatched = [_rectangle(thing) for thing in things if thing.id in marks.miscoloured]
    for boxes in (
        PatchCollection(fills, match_original=True, zorder=1),
        PatchCollection(hatched, facecolor="none", edgecolor=WRONG, linewidth=0, hatch=HATCH, alpha=0.6, zorder=2),
        PatchCollection(edges, match_original=True, zorder=2),
    ):
        axes.add_collection(boxes)


def _rectangle(thing: PerceivedObject, **look: Any) -> Rectangle:
    from matplotlib.patches import Rectangle

    (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
    return Rectangle((x, y), right - x, top - y, **look)


def _fill(name: str | None, colours: Mapping[str, str]) -> dict[str, Any]:
    colour = colours.get(name or "")
    fill = colour or (PLAIN_FILL if name else UNNAMED_FILL)
    return {"facecolor": fill, "alpha": 0.85 if colour is None else 0.35, "edgecolor": "none"}


def _edge(thing: str, name: str | None, colours: Mapping[str, str], marks: Marks, sureness: float) -> dict[str, Any]:
    edge = WRONG if thing in marks.wrong else colours.get(name or "") or (INK if name else QUIET)
    style = (0, (1, 2)) if thing in marks.unsure else "-" if name else (0, (4, 3))
    return {"fill": False, "edgecolor": edge, "linewidth": 1.2, "linestyle": style, "alpha": opacity(sureness)}


def opacity(sureness: float) -> float:
    """Return the opacity of the outline of a thing, which fades with the doubt about its name.

    Parameters
    ----------
    sureness
        Probability of the name.

    Returns
    -------
    float
        Opacity in [0, 1]; 1 for a decided name.
    """
    return 1.0 if sureness >= DECIDED else LEAST_ALPHA + (1.0 - LEAST_ALPHA) * sureness


def _ghost_keys(belongs: Collection[str], matched: Collection[str]) -> list[Any]:
    """Return the entries of the legend for the ghosts, and for the ways to them from the objects on the table."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    keys: list[Any] = []
    if belongs:
        keys.append(Patch(facecolor=PAPER, edgecolor=BELONGS, linestyle=(0, (2, 2)), label="where it belongs"))
    if any(name in matched for name in belongs):
        keys.append(Line2D([], [], color=BELONGS, linestyle=(0, (4, 2)), label="move it there"))
    return keys


def _keys(found: Grounding, groups: Sequence[Sequence[str]], marks: Marks) -> list[Any]:
    """Return the entries of the legend: facts, marks, and the first groups of interchangeable objects."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    keys: list[Any] = []
    if found.satisfied:
        keys.append(Line2D([], [], color=QUIET, label=f"{count(len(found.satisfied), 'fact')} satisfied"))
    if found.violated:
        keys.append(Line2D([], [], color=WRONG, label=f"{len(found.violated)} violated"))
    if marks.wrong:
        keys.append(Patch(facecolor=PAPER, edgecolor=WRONG, label="misplaced, or (dashed) extra"))
    keys += _ghost_keys(marks.belongs, found.matches)
    if marks.miscoloured:
        keys.append(Patch(facecolor=PAPER, edgecolor=WRONG, linewidth=0, hatch=HATCH, label="of another colour"))
    if marks.unsure:
        keys.append(Patch(facecolor=PAPER, edgecolor=INK, linestyle=":", label="named by its place alone"))
    for number, group in enumerate(groups[:MAX_LISTED]):
        colour = GROUP_COLOURS[number % len(GROUP_COLOURS)]
        members = shortened_list([name.replace("_", NO_BREAK) for name in group])
        label = textwrap.fill(f"cannot be told apart: {', '.join(members)}", LINE).replace(NO_BREAK, " ")
        keys.append(Patch(facecolor=colour, alpha=0.45, label=label))
    if len(groups) > MAX_LISTED:
        keys.append(Patch(alpha=0.0, label=f"and {len(groups) - MAX_LISTED} more groups that cannot be told apart"))
    return keys
