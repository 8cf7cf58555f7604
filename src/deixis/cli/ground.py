"""The command ``deixis ground``: who is who, by asking where that helps, and from an unknown side."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import (
    ENGINE_HELP,
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    Image,
    SceneFile,
    Script,
    TimeLimit,
    print_json,
    print_lines,
    print_written,
    ready_to_ground,
    require_plot,
    working,
)
from deixis.reasoning.grounding.options import EngineName, ViewpointName

if TYPE_CHECKING:
    from deixis.grammar.script import Script as ParsedScript
    from deixis.perception.scene import Scene
    from deixis.reasoning.grounding.answer import Grounding
    from deixis.reasoning.grounding.evidence.meaning import Meaning
    from deixis.workflows.ask import Asked
    from deixis.workflows.viewpoint import SeenFrom


def ground(
    script: Script,
    scene: SceneFile,
    engine: Annotated[EngineName, typer.Option(help=ENGINE_HELP)] = EngineName.EXACT,
    literal: Annotated[bool, typer.Option("--literal", help="Take words literally, not by degrees.")] = False,
    no_sizes: Annotated[bool, typer.Option("--no-sizes", help="Leave out how large things usually are.")] = False,
    ask: Annotated[bool, typer.Option("--ask", help="Ask what tells groundings apart.")] = False,
    oracle: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Ask this file: JSON, from names to ids; null for what is absent."),
    ] = None,
    viewpoint: Annotated[
        ViewpointName, typer.Option(help="stated; or recover the side: quarter turns, or unknown: any angle.")
    ] = ViewpointName.STATED,
    memory: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Take words and sizes as this memory has learned them.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the scene with the names found.")] = None,
    time_limit: TimeLimit = 10.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    as_json: AsJson = False,
) -> None:
    """Work out which perceived thing each object of a script is."""
    from deixis.report.ground import grounding_lines
    from deixis.report.json_answers import exchanges_to_dict, grounding_to_dict, viewpoints_to_dict
    from deixis.session import ground as run
    from deixis.workflows.read import load_scene, read_script

    require_plot(plot)
    parsed, seen = read_script(script), load_scene(scene, hide_labels, image)
    meaning = _meaning(literal, no_sizes, memory)
    ready_to_ground(engine)
    started, left = time.perf_counter(), time_limit
    more: dict[str, Any] = {}
    side = None
    if viewpoint is not ViewpointName.STATED:
        side = _looked_around(parsed, seen, meaning, viewpoint, time_limit / 2)
        left = max(0.0, time_limit - (time.perf_counter() - started))
        seen, more = side.scene, viewpoints_to_dict(side.viewpoints)
    if ask or oracle is not None:
        _require_asking(engine)
        asked = _ask(parsed, seen, meaning, oracle, left, as_json)
        found, more = asked.grounding, more | exchanges_to_dict(asked.exchanges)
        found = found if side is None else found.noting(side.notes + side.doubt)
    elif side is not None:
        found = _from_sides(parsed, side, engine, meaning, left)
    else:
        with working("grounding"):
            found = run(parsed, seen, engine=engine, time_limit=left, meaning=meaning)
    if plot is not None:
        from deixis.plots.grounding import plot_grounding

        about = (parsed.title or parsed.name, f"scene {side.turn}" if side and side.turn else "")
        plot_grounding(found, seen, plot, title=", ".join(filter(None, about)))
    if as_json:
        print_json(grounding_to_dict(found) | more)
    else:
        print_lines(grounding_lines(found))
        print_written(plot)
    raise typer.Exit(_verdict(found))


def _meaning(literal: bool, no_sizes: bool, memory: Path | None) -> Meaning:
    """What a memory has learned, where one is named, else what is shipped; less what is not wanted."""
    from dataclasses import replace

    from deixis.reasoning.grounding.evidence.meaning import SHIPPED
    from deixis.session import Session

    meaning = SHIPPED
    if memory is not None:
        with Session(memory) as session:
            session.memory()  # refused where there is none
            meaning = session.meaning()
    weights = replace(meaning.weights, sizes=0.0) if no_sizes else meaning.weights
    return replace(meaning, graded=meaning.graded and not literal, weights=weights)


def _looked_around(
    script: ParsedScript, scene: Scene, meaning: Meaning, viewpoint: ViewpointName, time_limit: float
) -> SeenFrom:
    from deixis.workflows.viewpoint import seen_from_anywhere

    with working("looking from other sides"):
        return seen_from_anywhere(script, scene, meaning, viewpoint is ViewpointName.UNKNOWN, time_limit)


def _from_sides(
    script: ParsedScript, side: SeenFrom, engine: EngineName, meaning: Meaning, time_limit: float
) -> Grounding:
    from deixis.reasoning.grounding.engines import engine_named
    from deixis.workflows.viewpoint import ground_from_sides

    with working("grounding"):
        return ground_from_sides(script, side, engine_named(engine), meaning, time_limit).noting(side.notes)


def _require_asking(engine: EngineName) -> None:
    from deixis.reasoning.errors import SettingError

    if engine is not EngineName.EXACT:
        raise SettingError(f"only the engine 'exact' asks, not '{engine}': leave out --engine")


def _ask(
    script: ParsedScript, scene: Scene, meaning: Meaning, oracle: Path | None, time_limit: float, as_json: bool
) -> Asked:
    """The dialogue goes to standard error where standard output is JSON."""
    from deixis.workflows.ask import ask
    from deixis.workflows.dialogue import Terminal, read_oracle

    out = sys.stderr if as_json else sys.stdout
    if oracle is None:
        found = ask(script, scene, lambda _: Terminal(sys.stdin, out), out, meaning, time_limit)
    else:
        found = ask(script, scene, lambda situation: read_oracle(oracle, situation, out), out, meaning, time_limit)
    print(file=out)
    return found


def _verdict(found: Grounding) -> int:
    """No match at all is a no; what the time limit cut short, so that it is not proved either, is undecided."""
    if not found.matches:
        return NO
    return 0 if found.finished else UNDECIDED
