"""The command ``deixis ground``: who is who, by asking where that helps, and from an unknown side."""

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
    working,
)
from deixis.cli.output import StandardInput
from deixis.reasoning.grounding.options import EngineName, Select, ViewpointName

if TYPE_CHECKING:
    from deixis.reasoning.grounding.answer import Grounding
    from deixis.reasoning.grounding.evidence.meaning import Meaning
    from deixis.workflows.dialogue import Ask


def ground(
    script: Script,
    scene: SceneFile,
    engine: Annotated[EngineName, typer.Option(help=ENGINE_HELP)] = EngineName.EXACT,
    select: Annotated[
        Select, typer.Option(help="Under similarity: choose among sub-graphs by facts, or as in the paper.")
    ] = Select.FACTS,
    literal: Annotated[bool, typer.Option("--literal", help="Take words literally, not by degrees.")] = False,
    no_sizes: Annotated[bool, typer.Option("--no-sizes", help="Leave out how large things usually are.")] = False,
    ask: Annotated[bool, typer.Option("--ask", help="Ask what tells groundings apart.")] = False,
    oracle: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Ask this file: JSON, from names to ids; null for what is absent."),
    ] = None,
    max_questions: Annotated[int | None, typer.Option(metavar="N", min=1, help="Ask at most so many.")] = None,
    viewpoint: Annotated[
        ViewpointName, typer.Option(help="stated; or recover the side: quarter turns, or unknown: any angle.")
    ] = ViewpointName.STATED,
    memory: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Take words and sizes as this memory has learned them.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the scene with the names found.")] = None,
    time_limit: TimeLimit = 10.0,
    memory_limit: MemoryLimit = 2.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    as_json: AsJson = False,
) -> None:
    """Work out which perceived thing each object of a script is."""
    from deixis.report.ground import grounding_lines
    from deixis.report.json_answers import grounding_to_dict
    from deixis.workflows.ground import GroundingRequest, answer
    from deixis.workflows.read import load_scene, read_script

    tell_of_compiling()
    require_plot(plot)
    deadline = deadline_of(time_limit)
    out = sys.stderr if as_json else sys.stdout  # of the dialogue
    described, seen = read_script(script, deadline=deadline), load_scene(scene, hide_labels, image)
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
        meaning=_meaning(memory),
        deadline=deadline,
    )
    found = answer(request, working)
    if found.exchanges is not None:
        print(file=out)
    if plot is not None:
        from deixis.plots.grounding import plot_grounding

        plot_grounding(found, plot, title=described.title or described.name)
    if as_json:
        print_json(grounding_to_dict(found))
    else:
        print_lines(grounding_lines(found))
        print_written(plot)
    raise typer.Exit(_verdict(found))


def _meaning(memory: Path | None) -> Meaning:
    """What a memory has learned, where one is named, else what is shipped."""
    from deixis.reasoning.grounding.evidence.meaning import SHIPPED
    from deixis.session import Session

    if memory is None:
        return SHIPPED
    with Session(memory) as session:
        session.memory()  # refused where there is none
        return session.meaning()


def _dialogue(oracle: Path | None, out: TextIO) -> Ask:
    from deixis.workflows.dialogue import Dialogue, Terminal, read_oracle

    if oracle is None:
        return Dialogue(lambda _: Terminal(StandardInput(), out), out)
    return Dialogue(lambda situation: read_oracle(oracle, situation, out), out)


def _verdict(found: Grounding) -> int:
    """No match at all is a no; what the time limit cut short, so that it is not proved either, is undecided."""
    if not found.matches:
        return NO
    return 0 if found.finished else UNDECIDED
