"""The command ``deixis learn``: keep layouts and views of their objects in the memory."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import (
    ENGINE_HELP,
    NO,
    AsJson,
    HideLabels,
    Image,
    MemoryDir,
    TimeLimit,
    print_json,
    print_lines,
    print_note,
    tell_of_compiling,
)
from deixis.cli.output import note_change
from deixis.cli.progress import progress_bar
from deixis.reasoning.grounding.options import EngineName


def learn(
    inputs: Annotated[
        list[Path],
        typer.Argument(
            metavar="SCRIPT SCENE ...",
            help="Scripts (.layout), each followed by its scene; or folders with NAME.layout and NAME.scene.json.",
        ),
    ],
    engine: Annotated[EngineName, typer.Option(help=ENGINE_HELP)] = EngineName.EXACT,
    time_limit: TimeLimit = 10.0,
    teacher: Annotated[str, typer.Option(metavar="NAME", help="Name of the teacher.")] = "user",
    hide_labels: HideLabels = False,
    image: Image = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Ground scripts in their scenes and keep the layouts and their objects as concepts: either all of them or none."""
    from deixis.reasoning.errors import NothingFoundError
    from deixis.report.json_answers import learned_to_dict
    from deixis.report.layouts.script import learned_lines
    from deixis.session import Session
    from deixis.workflows.layouts.read import example_pairs, load_scene

    pairs = [(script, load_scene(scene, hide_labels, image)) for script, scene in example_pairs(inputs)]
    tell_of_compiling()
    with Session(memory) as session:
        try:
            with progress_bar("grounding") as progress:
                lessons = session.learn_all(pairs, engine, time_limit, progress, teacher)
        except NothingFoundError as error:
            print_note(error)
            raise typer.Exit(NO) from error
        where = session.path
        note_change(where)
    if as_json:
        answers = [learned_to_dict(learned) for learned in lessons]
        print_json(answers[0] if len(inputs) == 2 and len(answers) == 1 else answers)
    else:
        for learned in lessons:
            print_lines(learned_lines(learned, str(where)))
