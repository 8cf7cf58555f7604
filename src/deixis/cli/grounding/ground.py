"""The command ``deixis ground``: find which perceived thing each object of a script is."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TextIO

import typer

from deixis.cli.common import (
    ENGINE_HELP,
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    Image,
    MemoryLimit,
    SceneFile,
    Script,
    TimeLimit,
    deadline_of,
    print_json,
    print_lines,
    print_written,
    require_plot,
    tell_of_compiling,
)
from deixis.cli.output import StandardInput
from deixis.cli.progress import progress_bar, time_bar
from deixis.reasoning.grounding.options import EngineName, Select, ViewpointName

if TYPE_CHECKING:
    from deixis.reasoning.attributes.attribute import Attribute
    from deixis.reasoning.grounding.answers.answer import Grounding
    from deixis.reasoning.grounding.evidence.words.meaning import Meaning
    from deixis.workflows.grounding.dialogue import Ask


def ground(
    script: Script,
    scene: SceneFile,
    engine: Annotated[EngineName, typer.Option(help=ENGINE_HELP)] = EngineName.EXACT,
    select: Annotated[
        Select,
        typer.Option(help="With --engine similarity: choose the sub-graph by its satisfied facts, or by similarity."),
    ] = Select.FACTS,
    literal: Annotated[bool, typer.Option("--literal", help="Take words literally, not by degrees.")] = False,
    no_sizes: Annotated[bool, typer.Option("--no-sizes", help="Ignore the usual sizes of things.")] = False,
    ask: Annotated[bool, typer.Option("--ask", help="Ask questions to decide the undecided names.")] = False,
    oracle: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Take the answers from a JSON file of names and ids; null: absent."),
    ] = None,
    max_questions: Annotated[int | None, typer.Option(metavar="N", min=1, help="Ask at most N questions.")] = None,
    viewpoint: Annotated[
        ViewpointName, typer.Option(help="As stated, or recovered: by quarter turns, or (unknown) by any angle.")
    ] = ViewpointName.STATED,
    memory: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Use the words and sizes that this memory has learned.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the scene with the names found.")] = None,
    time_limit: TimeLimit = 10.0,
    memory_limit: MemoryLimit = 2.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    as_json: AsJson = False,
) -> None:
    """Work out which perceived thing each object of a script is."""
    from deixis.report.grounding.ground import grounding_lines, kinds_lines
    from deixis.report.json_answers import grounding_to_dict
    from deixis.workflows.grounding.ground import GroundingRequest, answer
    from deixis.workflows.layouts.read import load_scene, read_script

    tell_of_compiling()
    require_plot(plot)
    deadline = deadline_of(time_limit)
    out = sys.stderr if as_json else sys.stdout  # for the questions
    described, seen = read_script(script, deadline=deadline), load_scene(scene, hide_labels, image)
    meaning, attributes = _learned(memory)
    request = GroundingRequest(
        script=described,
        scene=seen,
        engine=engine,
        select=select,
        literal=literal,
        sizes=not no_sizes,
        viewpoint=viewpoint,
        ask=_dialogue(oracle, out) if ask or oracle is not None else None,
        max_questions=max_questions,
        time_limit=time_limit,
        memory_limit=memory_limit,
        meaning=meaning,
        attributes=attributes,
        deadline=deadline,
    )
    found = answer(request, lambda stage: time_bar(stage, time_limit))
    if found.exchanges is not None:
        print(file=out)
    if plot is not None:
        from deixis.plots.grounding import plot_grounding

        with progress_bar("drawing"):
            plot_grounding(found, plot, title=described.title or described.name)
    if as_json:
        written = grounding_to_dict(found)
        if described.reading is not None:
            written["mentions"] = {name: list(words) for name, words in described.reading.mentions.items()}
        print_json(written)
    else:
        print_lines(grounding_lines(found))
        print_lines(kinds_lines(described))
        print_written(plot)
    raise typer.Exit(_verdict(found))


def _learned(memory: Path | None) -> tuple[Meaning, dict[str, Attribute]]:
    """Return the words and sizes that a memory has learned, or the shipped ones without a memory, and adjectives."""
    if memory is None:
        from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED

        return SHIPPED, {}
    from deixis.memory.episodes.blackboard import has_episodes
    from deixis.session import Session

    with Session(memory) as session:
        if not has_episodes(memory):
            session.memory()  # raises MemoryFormatError without a memory
        return session.meaning(), session.attributes()


def _dialogue(oracle: Path | None, out: TextIO) -> Ask:
    from deixis.workflows.grounding.dialogue import Dialogue, Terminal, read_oracle

    if oracle is None:
        return Dialogue(lambda _: Terminal(StandardInput(), out), out)
    return Dialogue(lambda situation: read_oracle(oracle, situation, out), out)


def _verdict(found: Grounding) -> int:
    """Return the exit code: NO without any match, UNDECIDED where the time limit cut the search short."""
    if not found.object_matches:
        return NO
    return 0 if found.finished else UNDECIDED
