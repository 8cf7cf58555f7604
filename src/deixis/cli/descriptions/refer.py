"""The command ``deixis refer``: find which object of a scene a description refers to."""

from __future__ import annotations

import json
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    Image,
    Picture,
    draw_answer,
    note_unit,
    print_json,
    print_line,
    print_lines,
    require_plot,
)
from deixis.cli.output import StandardInput
from deixis.cli.progress import progress_bar
from deixis.printable import visible_line

MAX_LINE = 100_000
"""Maximum number of characters of a line of a batch on standard input."""

if TYPE_CHECKING:
    from deixis.perception.scene import Scene
    from deixis.reasoning.attributes.attribute import Attribute
    from deixis.reasoning.grounding.reference.answer import Question
    from deixis.reasoning.grounding.reference.model.model import Model
    from deixis.workflows.descriptions.refer import Answerer


def refer(
    text: Annotated[
        str | None, typer.Argument(metavar="[TEXT]", help="English sentences that describe one object.")
    ] = None,
    scene: Annotated[str | None, typer.Argument(metavar="[SCENE]", help="A scene (.scene.json).")] = None,
    batch: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help='Answer each line {"text", "scene"} of a file (-: standard input) with a line.'
        ),
    ] = None,
    ask: Annotated[bool, typer.Option("--ask", help="Ask yes-or-no questions until the object is decided.")] = False,
    oracle: Annotated[
        str | None, typer.Option(metavar="ID", help="Answer the questions as if this object were meant.")
    ] = None,
    until: Annotated[
        float, typer.Option(metavar="P", help="--ask and --oracle stop at this probability, at most 0.95.")
    ] = 0.95,
    models: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Weights (.json) that learn-relation --descriptions wrote, instead of the shipped ones.",
        ),
    ] = None,
    attributes: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help='Sentences that teach adjectives, lines {"text", "scene", "target"} of JSON.'
        ),
    ] = None,
    picked: Annotated[
        str | None,
        typer.Option(metavar="ID", help="Teach the memory the new adjectives of TEXT: this object was meant."),
    ] = None,
    memory: Annotated[
        Path | None, typer.Option("--memory", metavar="DIR", help="Use the adjectives that this memory learned.")
    ] = None,
    plot: Picture = None,
    hide_labels: HideLabels = False,
    image: Image = None,
    as_json: AsJson = False,
) -> None:
    """Find which object of a scene a description in English refers to.

    Exit 0 if the object is decided (probability at least 0.95), 3 if not, 1 if the scene has no object.
    """
    if batch is not None:
        if (
            text is not None
            or ask
            or oracle is not None
            or hide_labels
            or image is not None
            or attributes
            or picked
            or plot
            or memory
        ):
            raise typer.BadParameter("--batch takes --until and --models only; a line may have its 'oracle'")
        _answer_lines(batch, until, _model(models))
        return
    if text is None or scene is None:
        raise typer.BadParameter("give a TEXT and a SCENE, or --batch FILE")
    if text.endswith(".json") and not Path(scene).exists():
        raise typer.BadParameter(f"give the TEXT before the SCENE: deixis refer '{visible_line(scene)}' {text}")
    from deixis.report.descriptions.refer import reference_lines, reference_to_dict
    from deixis.workflows.descriptions.refer import refer as find
    from deixis.workflows.layouts.read import load_scene

    require_plot(plot)
    out = sys.stderr if as_json else sys.stdout
    seen = load_scene(scene, hide_labels, image)
    note_unit(seen)
    if picked is not None:
        if memory is None:
            raise typer.BadParameter("--picked needs --memory DIR, which is to learn the adjectives")
        if plot is not None:
            raise typer.BadParameter("--picked excludes --plot: it teaches, and finds no object")
        _remember(text, seen, picked, memory)
        return
    known = _attributes(attributes, memory)
    answer = _terminal(out) if ask else None
    with nullcontext() if ask else progress_bar("finding the object"):
        found = find(text, seen, ask=answer, oracle=oracle, until=until, model=_model(models), attributes=known)
    if as_json:
        print_json(reference_to_dict(found))
    else:
        if oracle is not None:
            print_lines([f"{turn.question.text} {'yes' if turn.yes else 'no'}" for turn in found.turns])
        print_lines(reference_lines(found))
    if found.target is not None:
        draw_answer(found, plot, as_json)
    raise typer.Exit(NO if found.target is None else 0 if found.decided else UNDECIDED)


def _model(file: Path | None) -> Model | None:
    if file is None:
        return None
    from deixis.workflows.descriptions.learn_reference import read_reference

    return read_reference(file)


def _attributes(file: Path | None, memory: Path | None) -> dict[str, Attribute]:
    """Return the adjectives that a memory and a file of sentences teach; those of the file count where both do."""
    known: dict[str, Attribute] = {}
    if memory is not None:
        from deixis.memory.episodes.blackboard import Blackboard
        from deixis.workflows.descriptions.remembered_attributes import remembered_attributes

        with Blackboard.open(memory) as board:
            known = remembered_attributes(board)
    if file is not None:
        from deixis.workflows.descriptions.learn_attributes import learn_attributes

        known |= learn_attributes(file)
    return known


def _remember(text: str, scene: Scene, picked: str, memory: Path) -> None:
    from deixis.memory.episodes.blackboard import Blackboard
    from deixis.workflows.descriptions.remembered_attributes import remember_sentence

    with Blackboard.open(memory, create=True) as board:
        print_line(f"Learned from {remember_sentence(board, text, scene, picked)}.")


def _answer_lines(file: str, until: float, model: Model | None) -> None:
    from deixis.text_files import read_lines
    from deixis.workflows.descriptions.refer import refer_batch

    if file == "-":
        lines, folder, total = StandardInput(undecoded="surrogateescape").lines(MAX_LINE), Path(), None
    else:
        read = list(read_lines(file, undecoded="surrogateescape"))
        lines, folder, total = iter(read), Path(file).parent, len(read)
    is_printed = sys.stdout is None or sys.stdout.isatty()  # then the answers show the progress
    with nullcontext() if is_printed else progress_bar("answering") as progress:
        for done, answer in enumerate(refer_batch(lines, folder, until, model), start=1):
            print_line(json.dumps(answer, ensure_ascii=False))
            if progress is not None:
                progress(done, total)


def _terminal(out: object) -> Answerer:
    """Return a function that asks the user until the answer is yes, no or an empty line."""

    def answer(question: Question) -> bool | None:
        while True:
            print(visible_line(f"{question.text} (yes, no, or an empty line to stop) "), end="", flush=True, file=out)  # type: ignore[call-overload]
            reply = StandardInput().readline().strip().casefold()
            if not reply:
                return None
            if reply in {"y", "yes", "n", "no"}:
                return reply[0] == "y"
            print("Answer yes or no.", file=out)  # type: ignore[call-overload]

    return answer
