"""The command ``deixis ask``: have the robot ask which object a word means."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import NO, MemoryDir, PerceivedScene, print_line, print_lines, print_note, progress_bar
from deixis.cli.output import StandardInput, note_change
from deixis.printable import visible_line

if TYPE_CHECKING:
    from deixis.perception.scene import Scene


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
    from deixis.report.seen import meant_lines, taught_line
    from deixis.session import Session
    from deixis.view_store import new_category_name
    from deixis.workflows.read import load_scene

    said, seen = new_category_name(word), load_scene(scene)
    _require_something_to_show(seen)
    with Session(memory) as session:
        name = session.category_meant(said)
        print_lines(meant_lines(said, name))
        if name in session.categories() and points_at is None:
            with progress_bar("reading what was taught") as progress:
                answers = session.recognise(seen.without_labels(), progress, print_note).answers
            ones = [f"{id} ({answer.probability:.2f})" for id, answer in answers.items() if answer.label == name]
            print_line(
                f"I know '{name}'. Here it is: {', '.join(ones)}." if ones else f"I know '{name}', and see none here."
            )
            raise typer.Exit(0 if ones else NO)
    pointed = points_at or _pointed_at(name, seen)  # with the memory closed: whoever is asked may take their time
    if pointed is None:
        print_line(f"I still do not know what '{name}' is.")
        raise typer.Exit(NO)
    with Session(memory) as session:
        taught = session.teach(seen, pointed, name, teacher)
        note_change(session.path)
    print_line(taught_line(taught, pointed))


def _require_something_to_show(scene: Scene) -> None:
    """Ends the command, before anybody is asked, where no thing is there, or none whose looks could be kept."""
    from deixis.errors import DeixisError

    if not scene.objects:
        print_line(f"There is nothing in {scene.file} that a word could mean.")
        raise typer.Exit(NO)
    if all(thing.cloud is None for thing in scene.objects):
        raise DeixisError(f"{scene.file}: nothing in it has a cloud, so none can be shown; 'perceive -o' writes clouds")


def _pointed_at(name: str, scene: Scene) -> str | None:
    """Asks until an id of the scene is given, or nothing."""
    from deixis.report.seen import scene_lines

    print_lines(scene_lines(scene))
    while True:
        question = f"I do not know what '{name}' is. Which one of these is one? (its id; nothing: none) "
        print(visible_line(question), end="", flush=True)
        answer = StandardInput().readline().strip()
        if not answer:
            print()
            return None
        if answer not in scene.ids:
            print_line(f"There is no '{answer}' here.")
        elif scene[answer].cloud is None:
            print_line(f"'{answer}' has no cloud, so nobody knows what it looks like.")
        else:
            return answer
