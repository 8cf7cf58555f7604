"""The command ``deixis ask``: have the robot ask which object a word means."""

from __future__ import annotations

import sys
from contextlib import nullcontext, redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import NO, AsJson, MemoryDir, PerceivedScene, print_json, print_line, print_lines, print_note
from deixis.cli.completion import complete_categories
from deixis.cli.output import StandardInput, note_change
from deixis.cli.progress import progress_bar
from deixis.printable import visible_line

if TYPE_CHECKING:
    from deixis.perception.scene import Scene


def ask(
    word: Annotated[
        str, typer.Argument(metavar="WORD", help="A word, known or not.", autocompletion=complete_categories)
    ],
    scene: PerceivedScene,
    points_at: Annotated[str | None, typer.Option(metavar="OBJECT", help="Answer with this id.")] = None,
    teacher: Annotated[str, typer.Option(metavar="NAME", help="Name of the person who answers.")] = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Have the robot ask which object a word means; the answer teaches the word its first view.

    For a known word, print the objects that it is recognised in, and ask nothing; --points-at adds one more view.
    Exit 1 without an answer.
    """
    with redirect_stdout(sys.stderr) if as_json else nullcontext():  # the dialogue, so that JSON stands alone
        found = _asked(word, scene, points_at, teacher, memory)
    if as_json:
        print_json(found)
    if not found["objects"] and found["taught"] is None:
        raise typer.Exit(NO)


def _asked(word: str, scene: str, points_at: str | None, teacher: str, memory: Path | None) -> dict[str, Any]:
    """Ask, print the dialogue, and return the answer as plain data."""
    from deixis.report.scenes.seen import meant_lines, taught_line, taught_to_dict
    from deixis.session import Session
    from deixis.view_store import new_category_name
    from deixis.workflows.layouts.read import load_scene

    name_given, seen = new_category_name(word), load_scene(scene)
    answer: dict[str, Any] = {"word": name_given, "category": name_given, "objects": {}, "taught": None}
    if not seen.objects:
        print_line(f"There are no objects in {seen.file} that a word could refer to.")
        return answer
    _require_clouds(seen)
    with Session(memory) as session:
        name = answer["category"] = session.category_meant(name_given)
        print_lines(meant_lines(name_given, name))
        if name in session.categories() and points_at is None:
            with progress_bar("comparing with the taught views") as progress:
                recognised = session.recognise(seen.without_labels(), progress, print_note).answers
            ones = {id: each.probability for id, each in recognised.items() if each.label == name}
            listed = ", ".join(f"{id} ({probability:.2f})" for id, probability in ones.items())
            print_line(f"I know '{name}'. Here it is: {listed}." if ones else f"I know '{name}', and see none here.")
            return answer | {"objects": ones}
    pointed = points_at or _pointed_at(name, seen)  # the memory is closed while the user thinks
    if pointed is None:
        print_line(f"I still do not know what '{name}' is.")
        return answer
    with Session(memory) as session:
        taught = session.teach(seen, pointed, name, teacher)
        note_change(session.path)
    print_line(taught_line(taught, pointed))
    return answer | {"taught": {"object": pointed, **taught_to_dict(taught)}}


def _require_clouds(scene: Scene) -> None:
    """Check, before the question, that some object has a cloud; raise DeixisError otherwise."""
    from deixis.errors import DeixisError

    if all(thing.cloud is None for thing in scene.objects):
        raise DeixisError(
            f"{scene.file}: no object in it has a cloud, so none can be taught; 'deixis perceive -o' writes clouds"
        )


def _pointed_at(name: str, scene: Scene) -> str | None:
    """Ask until the answer is an id of the scene, and return it; None for an empty answer."""
    from deixis.report.scenes.seen import scene_lines

    print_lines(scene_lines(scene))
    while True:
        question = f"I do not know what '{name}' is. Which of these is one? (an id; an empty line for none) "
        print(visible_line(question), end="", flush=True)
        answer = StandardInput().readline().strip()
        if not answer:
            print()
            return None
        if answer not in scene.ids:
            print_line(f"There is no object '{answer}' in this scene.")
        elif scene[answer].cloud is None:
            print_line(f"'{answer}' has no cloud, so its shape is not known.")
        else:
            return answer
