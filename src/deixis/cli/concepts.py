"""The commands that use what is remembered as concepts: learn, show, check and query."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import (
    ENGINE_HELP,
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    Image,
    MemoryDir,
    NoMemory,
    SceneFile,
    TimeLimit,
    print_json,
    print_lines,
    print_written,
    ready_to_ground,
    require_plot,
    working,
)
from deixis.reasoning.grounding.options import EngineName


class TableFormat(StrEnum):
    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    TURTLE = "turtle"


def register(app: typer.Typer) -> None:
    """Adds these commands to the command line."""
    for command in (learn, show, check, query):
        app.command()(command)


def learn(
    inputs: Annotated[
        list[Path],
        typer.Argument(
            metavar="SCRIPT SCENE ...",
            help="Scripts (.layout), each with its scene after it; or folders, in which NAME.layout goes with "
            "NAME.scene.json.",
        ),
    ],
    engine: Annotated[EngineName, typer.Option(help=ENGINE_HELP)] = EngineName.EXACT,
    time_limit: TimeLimit = 10.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Ground scripts in their scenes, and keep the layouts and their objects as concepts: all of them, or none."""
    from deixis.reasoning.errors import NothingFoundError
    from deixis.report.json_answers import learned_to_dict
    from deixis.report.script import learned_lines
    from deixis.session import Session
    from deixis.workflows.read import example_pairs, load_scene

    pairs = [(script, load_scene(scene, hide_labels, image)) for script, scene in example_pairs(inputs)]
    ready_to_ground(engine)
    with Session(memory) as session:
        try:
            with working("grounding"):
                lessons = session.learn_all(pairs, engine, time_limit)
        except NothingFoundError as error:
            print(f"deixis: {error}", file=sys.stderr)
            raise typer.Exit(NO) from error
        where = session.path
    if as_json:
        told = [learned_to_dict(learned) for learned in lessons]
        print_json(told[0] if len(inputs) == 2 and len(told) == 1 else told)
    else:
        for learned in lessons:
            print_lines(learned_lines(learned, str(where)))


def show(
    layout: Annotated[str, typer.Argument(metavar="LAYOUT", help="A learned layout's name, or a lesson's id.")],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Print a learned layout as a script again."""
    from deixis.ontology.export import fact_to_dict
    from deixis.session import Session

    with Session(memory) as session:
        concept, text = session.layout(layout), session.show(layout)
    if as_json:
        facts = [fact_to_dict(fact) for fact in concept.facts]
        head = {"name": concept.name, "title": concept.title, "viewpoint": concept.viewpoint, "lesson": concept.lesson}
        print_json({**head, "facts": facts, "text": text})
    else:
        sys.stdout.write(text)


def check(
    layout: Annotated[str, typer.Argument(metavar="LAYOUT", help="A learned layout's name, or a script.")],
    scene: SceneFile,
    report: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the SHACL report (Turtle).")] = None,
    turtle: Annotated[bool, typer.Option("--turtle", help="Print the SHACL report (Turtle).")] = False,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the table with what is wrong.")] = None,
    time_limit: TimeLimit = 10.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    as_json: AsJson = False,
) -> None:
    """Say what is missing, misplaced, miscoloured and extra on a table; exit 0 where all is well, 1 where not."""
    from deixis.report.json_answers import check_to_dict
    from deixis.report.script import check_lines
    from deixis.session import Session
    from deixis.workflows.check import check as run
    from deixis.workflows.read import load_scene

    require_plot(plot)
    seen = load_scene(scene, hide_labels, image)
    ready_to_ground()
    with Session(memory) as session, working("grounding"):
        checked = run(layout, seen, time_limit, None if no_memory else session.knowledge_store)
    if report is not None:
        report.parent.mkdir(parents=True, exist_ok=True)
        report.write_text(checked.report, encoding="utf-8")
    if plot is not None:
        from deixis.plots.check import plot_check

        plot_check(checked, seen, plot)
    if turtle:
        sys.stdout.write(checked.report)
    elif as_json:
        print_json(check_to_dict(checked))
    else:
        print_lines(check_lines(checked))
        print_written(report, plot)
    if not checked.table.grounding.proved_best:
        raise typer.Exit(UNDECIDED)
    if not checked.table.well:
        raise typer.Exit(NO)


def query(
    sparql: Annotated[str | None, typer.Argument(metavar="SPARQL", help="SELECT, ASK, CONSTRUCT or DESCRIBE.")] = None,
    file: Annotated[
        Path | None, typer.Option("-f", "--file", metavar="FILE", help="Read the query from a file.")
    ] = None,
    format: Annotated[TableFormat, typer.Option("--format", help="How to print the answer.")] = TableFormat.TABLE,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Ask SPARQL of everything remembered."""
    from deixis.errors import DeixisError
    from deixis.session import Session

    if (sparql is None) == (file is None):
        raise DeixisError("give a query, or a file with -f, and one of them only")
    with Session(memory) as session:
        result = session.query(_text(file) if file is not None else sparql or "")
        if as_json or format is TableFormat.JSON:
            print(result.to_json())
        elif format is TableFormat.CSV:
            sys.stdout.write(result.to_csv())
        elif format is TableFormat.TURTLE:
            sys.stdout.write(result.to_turtle())
        else:
            print_lines(result.to_table())
        if result.boolean is False:
            raise typer.Exit(NO)


def _text(file: Path) -> str:
    from deixis.errors import DeixisError

    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise DeixisError(f"{file}: the file is not UTF-8 (byte {error.start})") from error
