"""The command ``deixis point``: what people point at, and which thing each spoken name is taught to."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, SceneFile, print_json, print_lines
from deixis.cli.progress import progress_bar


def point(
    skeleton: Annotated[str, typer.Argument(metavar="SKELETON", help="Joints over time (.skeleton.jsonl).")],
    scene: SceneFile,
    said: Annotated[
        Path | None, typer.Option("--said", metavar="FILE", help="Utterances, one line of JSON each (.said.jsonl).")
    ] = None,
    sure: Annotated[float, typer.Option(metavar="P", help="Minimum probability of a decided thing.")] = 0.95,
    memory: Annotated[
        Path | None,
        typer.Option("--memory", metavar="DIR", help="Keep what was said and shown in this memory."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find what people point at, and to which thing each spoken name belongs.

    Exit 0 if each gesture and name is decided, 3 if not, 1 if there is no gesture.
    """
    from deixis.report.scenes.point import shown_lines, shown_to_dict
    from deixis.workflows.scenes.point import point as run

    with progress_bar("finding the gestures"):
        found = run(skeleton, scene, said or (), sure=sure)
    if memory is not None:
        from deixis.memory.episodes.blackboard import Blackboard
        from deixis.workflows.scenes.remembered_showing import remember_showing

        with Blackboard.open(memory, create=True) as board:
            remember_showing(board, found)
    if as_json:
        print_json(shown_to_dict(found))
    else:
        print_lines(shown_lines(found))
    if not found.pointings:
        raise typer.Exit(NO)
    undecided = any(one.decided is None for one in found.pointings) or len(found.taught) < len(found.labels)
    raise typer.Exit(UNDECIDED if undecided else 0)
