"""Pictures: a grounded scene from above."""

from __future__ import annotations

import math
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.ontology.errors import DeixisError
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.answer import FactOutcome, Grounding

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, QUIET, WRONG, PAPER = "#22313f", "#9aa5ae", "#c0392b", "#fbfaf7"
GROUP_COLOURS = ("#4c78a8", "#e0a02c", "#5a9a5a", "#8e6bbf", "#2a9d9d", "#b5703c")
PLAIN_FILL, UNNAMED_FILL = "#ffffff", "#eceae4"
MARGIN = 0.12
"""Inches between what is drawn and the edge of the picture."""


def plot_grounding(found: Grounding, scene: Scene, path: str | Path, title: str | None = None) -> None:
    """Draws the scene from above with the names found, as PNG, SVG or PDF by the file's ending.

    Satisfied facts are quiet arrows, violated ones red; objects that the description cannot tell apart share a
    colour; what has no name is grey. Raises DeixisError where the file cannot be written or its ending is no picture.
    """
    figure = grounding_figure(found, scene, title)
    save(figure, path)


def save(figure: Figure, path: str | Path) -> None:
    """Writes a figure, making the folder it goes to; raises DeixisError where that fails."""
    import warnings

    target = require_picture(path)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)
            figure.savefig(target, dpi=180, facecolor=PAPER)
    except OSError as error:
        raise DeixisError(f"{target}: the picture cannot be written: {error.strerror}") from error


def require_picture(path: str | Path) -> Path:
    """The path of a picture that can be written, its folder made; raises DeixisError where it cannot be."""
    target = Path(path)
    if target.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise DeixisError(f"{target}: a picture's name ends in .png, .svg or .pdf")
    if target.is_dir():
        raise DeixisError(f"{target}: this is a folder; name a file for the picture")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DeixisError(f"{target}: the folder of the picture cannot be made: {error.strerror}") from error
    return target


def new_figure(width: float, height: float, **subplots: Any) -> tuple[Figure, Any]:
    """An empty figure that needs no display, and its axes."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    room = ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=MARGIN)
    figure = Figure(figsize=(width, height), facecolor=PAPER, layout=room)
    FigureCanvasAgg(figure)
    return figure, figure.subplots(**subplots)


def grounding_figure(
    found: Grounding,
    scene: Scene,
    title: str | None = None,
    wrong: Collection[str] = (),
    unsure: Collection[str] = (),
) -> Figure:
    """The picture as a matplotlib figure; the things in ``wrong`` have a red edge, those in ``unsure`` a dotted one."""
    width, height = _extent(scene)
    figure, axes = new_figure(9.0, min(max(9.0 * height / width, 3.0), 12.0) + 0.9)
    colours = _group_colours(found)
    names = {match.perceived: match.object for match in found.matches.values()}
    for thing in sorted(scene.objects, key=_area, reverse=True):
        _draw_box(axes, thing, names.get(thing.id), colours, thing.id in wrong, thing.id in unsure)
    for entry in found.satisfied:
        _draw_fact(axes, entry, scene, QUIET, 0.8, 3)
    for entry in found.violated:
        _draw_fact(axes, entry, scene, WRONG, 1.8, 7)
    for thing in scene.objects:
        _write_name(axes, thing, names.get(thing.id), scene)
    _dress(axes, found, scene, title, colours, bool(wrong), bool(unsure))
    return figure


def _extent(scene: Scene) -> tuple[float, float]:
    if not scene.objects:
        return 1.0, 1.0
    low, high = scene.boxes[:, 0, :2].min(axis=0), scene.boxes[:, 1, :2].max(axis=0)
    width, height = (high - low).tolist()
    return max(width, height / 4, 1e-9), max(height, width / 4, 1e-9)


def _area(thing: PerceivedObject) -> float:
    return math.prod(high - low for low, high in zip(thing.minimum[:2], thing.maximum[:2], strict=True))


def _group_colours(found: Grounding) -> dict[str, str]:
    groups = (group for group in found.interchangeable if any(name in found.matches for name in group))
    return {name: GROUP_COLOURS[i % len(GROUP_COLOURS)] for i, group in enumerate(groups) for name in group}


def _draw_box(
    axes: Axes, thing: PerceivedObject, name: str | None, colours: dict[str, str], wrong: bool, unsure: bool
) -> None:
    from matplotlib.patches import Rectangle

    (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
    colour = colours.get(name or "")
    axes.add_patch(
        Rectangle(
            (x, y),
            right - x,
            top - y,
            facecolor=colour or (PLAIN_FILL if name else UNNAMED_FILL),
            alpha=0.85 if colour is None else 0.35,
            edgecolor="none",
            zorder=1,
        )
    )
    edge = WRONG if wrong else colour or (INK if name else QUIET)
    style = (0, (1, 2)) if unsure else "-" if name else (0, (4, 3))
    axes.add_patch(
        Rectangle((x, y), right - x, top - y, fill=False, edgecolor=edge, linewidth=1.2, linestyle=style, zorder=2)
    )


def _draw_fact(axes: Axes, entry: FactOutcome, scene: Scene, colour: str, width: float, order: int) -> None:
    from matplotlib.patches import FancyArrowPatch

    if entry.perceived is None:
        return
    start, end = _arrow(*(scene[id] for id in entry.perceived))
    axes.add_patch(
        FancyArrowPatch(
            start,
            end,
            arrowstyle="-|>",
            mutation_scale=9,
            connectionstyle="arc3,rad=0.12",
            shrinkA=0,
            shrinkB=0,
            color=colour,
            linewidth=width,
            alpha=0.75 if colour == QUIET else 1.0,
            zorder=order,
        )
    )


def _arrow(subject: PerceivedObject, object: PerceivedObject) -> tuple[tuple[float, float], tuple[float, float]]:
    """From just inside the subject to just inside the object, where the two boxes face each other or overlap."""
    ends = []
    over = _overlap_in_plan(subject, object)
    for axis in (0, 1):
        a, b = (subject.minimum[axis], subject.maximum[axis]), (object.minimum[axis], object.maximum[axis])
        low, high = max(a[0], b[0]), min(a[1], b[1])
        if a[1] <= b[0] or b[1] <= a[0]:
            near_a, near_b = (a[1], b[0]) if a[1] <= b[0] else (a[0], b[1])
            ends.append((near_a + 0.3 * (sum(a) / 2 - near_a), near_b + 0.06 * (sum(b) / 2 - near_b)))
        elif over and a[0] >= b[0] and a[1] <= b[1]:
            ends.append((a[0], b[0] + 0.3 * (a[0] - b[0])))
        elif over and b[0] >= a[0] and b[1] <= a[1]:
            ends.append((a[0] + 0.3 * (b[0] - a[0]), b[0]))
        else:
            middle, share = (low + high) / 2, 0.5 if over else 0.0
            ends.append((middle + share * (sum(a) / 2 - middle), middle + share * (sum(b) / 2 - middle)))
    (x0, x1), (y0, y1) = ends
    return (x0, y0), (x1, y1)


def _overlap_in_plan(a: PerceivedObject, b: PerceivedObject) -> bool:
    return all(a.minimum[k] < b.maximum[k] and b.minimum[k] < a.maximum[k] for k in (0, 1))


def _centre(thing: PerceivedObject) -> tuple[float, float]:
    x, y = ((low + high) / 2 for low, high in zip(thing.minimum[:2], thing.maximum[:2], strict=True))
    return x, y


def _write_name(axes: Axes, thing: PerceivedObject, name: str | None, scene: Scene) -> None:
    """The name in the box; upright where the box is narrow, at its top edge where another lies on it."""
    from matplotlib import patheffects

    x, y = _centre(thing)
    width, depth = (high - low for low, high in zip(thing.minimum[:2], thing.maximum[:2], strict=True))
    upright = depth > 2.0 * width
    text = (name or thing.label or thing.id).replace("_", " ")
    anchor = "center"
    if _bears_another(thing, scene):
        y, anchor = thing.maximum[1] - 0.04 * depth, "top"
    axes.text(
        x,
        y,
        text,
        ha="center",
        va=anchor,
        rotation=90 if upright else 0,
        fontsize=8.5,
        style="normal" if name else "italic",
        color=INK if name else "#77808a",
        zorder=6,
        parse_math=False,
        path_effects=[patheffects.withStroke(linewidth=2.2, foreground=PAPER)],
    )


def _bears_another(thing: PerceivedObject, scene: Scene) -> bool:
    x0, y0, x1, y1 = *thing.minimum[:2], *thing.maximum[:2]
    centres = (_centre(other) for other in scene.objects if other.id != thing.id and _area(other) < _area(thing))
    return any(x0 < x < x1 and y0 < y < y1 for x, y in centres)


def _dress(
    axes: Axes,
    found: Grounding,
    scene: Scene,
    title: str | None,
    colours: dict[str, str],
    wrong: bool,
    unsure: bool,
) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    axes.set_aspect("equal")
    axes.margins(0.06)
    dress_table(axes, scene, title)
    keys: list[Any] = []
    if found.satisfied:
        said = "1 fact satisfied" if len(found.satisfied) == 1 else f"{len(found.satisfied)} facts satisfied"
        keys.append(Line2D([], [], color=QUIET, label=said))
    if found.violated:
        keys.append(Line2D([], [], color=WRONG, label=f"{len(found.violated)} violated"))
    if wrong:
        keys.append(Patch(facecolor=PAPER, edgecolor=WRONG, label="misplaced, or (dashed) extra"))
    if unsure:
        keys.append(Patch(facecolor=PAPER, edgecolor=INK, linestyle=":", label="named by its place alone"))
    for colour in dict.fromkeys(colours.values()):
        members = [name.replace("_", " ") for name, other in colours.items() if other == colour]
        keys.append(Patch(facecolor=colour, alpha=0.45, label="cannot be told apart: " + ", ".join(members)))
    if keys:
        axes.legend(handles=keys, fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.09), ncols=2)


def dress_table(axes: Axes, scene: Scene, title: str | None) -> None:
    """Labels, colours and title of a table seen from above, once its aspect and margins are set."""
    axes.autoscale_view()
    across, along = f"to the right as seen from the {scene.viewpoint}", f"away from the {scene.viewpoint}"
    if scene.frame == "image" or (scene.unit == "px" and scene.viewpoint != Scene(()).viewpoint):
        across, along = "to the right", "up"  # nobody said that the image is a plan
    unit = "pixels" if scene.unit == "px" else "metres"
    axes.set_xlabel(f"{unit}, {across}", color=INK, fontsize=8.5)
    axes.set_ylabel(f"{unit}, {along}", color=INK, fontsize=8.5)
    axes.tick_params(colors=INK, labelsize=8)
    axes.set_facecolor(PAPER)
    for side in axes.spines.values():
        side.set_color(QUIET)
    if title:
        axes.set_title(title, color=INK, fontsize=12, loc="left", parse_math=False)
