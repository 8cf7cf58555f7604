"""The commands that begin with a point cloud: perceive, teach, recognise, ask."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import (
    NO,
    AsJson,
    MemoryDir,
    print_json,
    print_lines,
    print_written,
    progress_bar,
    require_memory,
    require_plot,
    require_scene_name,
    require_writable,
    working,
)

if TYPE_CHECKING:
    from deixis.learning.views import Recognised, Taught
    from deixis.perception.recognition.recogniser import Recognition
    from deixis.perception.scene import Scene

PerceivedScene = Annotated[str, typer.Argument(metavar="SCENE", help="A scene that perceive wrote, with clouds.")]
Picture = Annotated[Path | None, typer.Option("--plot", metavar="FILE", help="Draw it (.png, .svg, .pdf).")]


def register(app: typer.Typer) -> None:
    """Adds these commands to the command line."""
    for command in (perceive, teach, recognise, ask):
        app.command()(command)


def perceive(
    cloud: Annotated[str, typer.Argument(metavar="CLOUD", help="PCD, PLY, XYZ, NPZ, or a depth image.")],
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the scene, and clouds beside it.")
    ] = None,
    labels: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the thing of every point (.npy, int32, -1: none).")
    ] = None,
    intrinsics: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The camera's intrinsics (.json) of a depth image.")
    ] = None,
    viewpoint: Annotated[str, typer.Option(help="What the camera's side is called.")] = "chair",
    table: Annotated[int, typer.Option(metavar="N", min=1, help="Which table, should there be several.")] = 1,
    up: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="Roughly upwards (within 45 degrees) in the cloud's frame."),
    ] = None,
    plot: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Find the table in a point cloud, and the things on it. Without a table no scene is written."""
    from deixis.errors import DeixisError
    from deixis.perception.detection.settings import DetectionSettings
    from deixis.perception.formats.scene_json import scene_to_dict
    from deixis.workflows.perceive import perceive as run
    from deixis.workflows.perceive import write_scene

    require_plot(plot)
    if labels is not None and labels.suffix != ".npy":
        raise DeixisError(f"{labels}: the labels are a numpy array; name a file that ends in .npy")
    require_scene_name(out)
    require_writable([out, labels, plot], [cloud, intrinsics])
    with working("looking for the table"):
        scene = run(cloud, intrinsics, viewpoint, DetectionSettings(table=table, up=up))
    found = scene.detection
    assert found is not None
    seen = bool(found.table is not None or scene.objects)
    written = write_scene(scene, out) if out is not None and seen else scene
    if labels is not None:
        _write_labels(labels, found.labels)
    if plot is not None:
        from deixis.plots.seen import plot_perceived

        plot_perceived(scene, plot)
    if as_json or out is None:
        print_json(scene_to_dict(written))
        for note in found.notes:
            _print_note(note)
    else:
        print_lines(_scene_lines(scene))
        print_lines(f"Note: {note}." for note in found.notes)
        print_written(out if seen else None)
    if not as_json:
        print_written(labels, plot, aside=out is None)
    if not scene.objects:
        raise typer.Exit(NO)


def _print_note(note: str) -> None:
    """What is no part of the answer goes to standard error."""
    print(f"deixis: {note}", file=sys.stderr)


def _write_labels(file: Path, labels: Any) -> None:
    import numpy as np

    from deixis.errors import DeixisError

    try:
        np.save(file, labels)
    except OSError as error:
        raise DeixisError(f"{file}: the labels cannot be written: {error.strerror}") from error


def _scene_lines(scene: Scene) -> list[str]:
    unit, scale, digits = ("px", 1, 0) if scene.unit == "px" else ("cm", 100, 1)
    lines = []
    for thing in scene.objects:
        low, high = ([scale * value for value in corner] for corner in (thing.minimum, thing.maximum))
        sides = " x ".join(f"{b - a:.{digits}f}" for a, b in zip(low, high, strict=True))
        x, y = ((low[k] + high[k]) / 2 for k in (0, 1))
        lines.append(f"{thing.id:<5} {sides:>20} {unit} at {x:6.{digits}f}, {y:6.{digits}f}")
    return lines or ["Nothing was found."]


def teach(
    scene: PerceivedScene,
    object: Annotated[str, typer.Argument(metavar="OBJECT", help="The id of a thing in the scene.")],
    label: Annotated[str, typer.Argument(metavar="LABEL", help="What it is.")],
    teacher: Annotated[str, typer.Option(metavar="NAME", help="Who says so.")] = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Show what a word looks like: one view more of a category; said again of the same view, a correction."""
    from deixis.session import Session
    from deixis.view_store import category_name

    with Session(memory) as session:
        taught = session.teach(scene, object, label, teacher)
    if as_json:
        print_json({"view": taught.view, "category": taught.category, "views": taught.views, "before": taught.before})
    else:
        print_lines([*_meant_lines(category_name(label), taught.category), _taught_line(taught, object)])


def _taught_line(taught: Taught, object: str) -> str:
    corrected = f", and no longer of '{taught.before}'" if taught.before else ""
    return f"{object} is a view of '{taught.category}'{corrected}; {taught.views} in all."


def _meant_lines(said: str, known: str) -> list[str]:
    """Says so where a word is taken for a category that is spelled otherwise."""
    return [] if said == known else [f"'{said}' is taken for '{known}', from which only its case differs."]


def recognise(
    scene: PerceivedScene,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the scene with names.")] = None,
    plot: Picture = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Name the things of a scene that look like what was taught; exit 1 where none is known."""
    from deixis.session import Session
    from deixis.workflows.read import load_scene

    require_plot(plot)
    require_scene_name(out)
    require_memory(memory)
    seen = load_scene(scene)
    require_writable([out, plot], _cloud_files(seen))
    with Session(memory) as session, progress_bar("reading what was taught") as progress:
        found = session.recognise(seen, progress, _print_note)
    if out is not None:
        from deixis.workflows.perceive import write_scene

        write_scene(found.scene, out)
    if plot is not None:
        from deixis.plots.seen import plot_recognised

        plot_recognised(found, plot)
    if as_json:
        print_json(recognised_to_dict(found))
    else:
        print_lines(_answer_line(id, answer) for id, answer in found.answers.items())
        if not found.answers:
            print("Nothing in this scene has a cloud: only what perceive -o wrote can be recognised.")
        print_written(out, plot)
    if not any(answer.label for answer in found.answers.values()):
        raise typer.Exit(NO)


def _cloud_files(scene: Scene) -> list[Path]:
    return [Path(scene.file).parent / thing.cloud for thing in scene.objects if isinstance(thing.cloud, str)]


def _answer_line(id: str, answer: Recognition) -> str:
    name = answer.label or "unknown"
    return f"{id:<5} {name:<20} {answer.probability:.2f}   {'; '.join(answer.reasons)}"


def recognised_to_dict(found: Recognised) -> dict[str, Any]:
    """Each thing's name, its probability, and the distances behind it."""
    return {
        "objects": [
            {
                "object": id,
                "label": answer.label,
                "probability": round(answer.probability, 6),
                "unknown": round(answer.unknown, 6),
                "threshold": round(answer.calibration.threshold, 6),
                "reasons": list(answer.reasons),
                "candidates": [_candidate(candidate) for candidate in answer.candidates],
            }
            for id, answer in found.answers.items()
        ]
    }


def _candidate(candidate: Any) -> dict[str, Any]:
    import math

    finite = math.isfinite(candidate.distance)
    return {
        "category": candidate.category,
        "D_C": round(candidate.distance, 6) if finite else None,
        "ICD": None if candidate.spread.width.icd is None else round(candidate.spread.width.icd, 6),
        "divisor": round(candidate.spread.value, 6),
        "divisor_from": candidate.spread.source,
        "ND": round(candidate.normalised, 6) if finite else None,
        "nearest": candidate.nearest,
        "views": candidate.views,
        "probability": round(candidate.probability, 6),
    }


def ask(
    word: Annotated[str, typer.Argument(metavar="WORD", help="A word that may never have been shown.")],
    scene: PerceivedScene,
    points_at: Annotated[str | None, typer.Option(metavar="OBJECT", help="Answer with this id.")] = None,
    teacher: Annotated[str, typer.Option(metavar="NAME", help="Who answers.")] = "user",
    memory: MemoryDir = None,
) -> None:
    """Have the robot ask which thing a word means; what is pointed at becomes its first view.

    Where the word is known, it says which things it takes for one, and asks nothing, unless --points-at shows it one
    more. Exit 1 without an answer.
    """
    from deixis.session import Session
    from deixis.view_store import new_category_name
    from deixis.workflows.read import load_scene

    said, seen = new_category_name(word), load_scene(scene)
    _require_something_to_show(seen)
    with Session(memory) as session:
        name = session.category_meant(said)
        print_lines(_meant_lines(said, name))
        if name in session.categories() and points_at is None:
            with progress_bar("reading what was taught") as progress:
                answers = session.recognise(seen.without_labels(), progress, _print_note).answers
            ones = [f"{id} ({answer.probability:.2f})" for id, answer in answers.items() if answer.label == name]
            print(
                f"I know '{name}'. Here it is: {', '.join(ones)}." if ones else f"I know '{name}', and see none here."
            )
            raise typer.Exit(0 if ones else NO)
    pointed = points_at or _pointed_at(name, seen)  # with the memory closed: whoever is asked may take their time
    if pointed is None:
        print(f"I still do not know what '{name}' is.")
        raise typer.Exit(NO)
    with Session(memory) as session:
        print(_taught_line(session.teach(seen, pointed, name, teacher), pointed))


def _require_something_to_show(scene: Scene) -> None:
    """Ends the command, before anybody is asked, where no thing is there, or none whose looks could be kept."""
    from deixis.errors import DeixisError

    if not scene.objects:
        print(f"There is nothing in {scene.file} that a word could mean.")
        raise typer.Exit(NO)
    if all(thing.cloud is None for thing in scene.objects):
        raise DeixisError(f"{scene.file}: nothing in it has a cloud, so none can be shown; 'perceive -o' writes clouds")


def _pointed_at(name: str, scene: Scene) -> str | None:
    """Asks until an id of the scene is given, or nothing."""
    print_lines(_scene_lines(scene))
    while True:
        print(
            f"I do not know what '{name}' is. Which one of these is one? (its id; nothing: none) ", end="", flush=True
        )
        answer = sys.stdin.readline().strip()
        if not answer:
            print()
            return None
        if answer not in scene.ids:
            print(f"There is no '{answer}' here.")
        elif scene[answer].cloud is None:
            print(f"'{answer}' has no cloud, so nobody knows what it looks like.")
        else:
            return answer
