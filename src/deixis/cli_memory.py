"""The commands that use a memory: learn, show, check, query, and memory itself."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli_common import (
    ENGINE_HELP,
    AsJson,
    HideLabels,
    Image,
    MemoryDir,
    SceneFile,
    Script,
    TimeLimit,
    print_json,
    print_lines,
    progress_bar,
    ready_to_ground,
    require_ending,
    require_memory,
    working,
)
from deixis.reasoning.engine_name import EngineName

if TYPE_CHECKING:
    from deixis.memory.verifying import Verified

memory_app = typer.Typer(help="Export, import, count, or forget what was learned.", no_args_is_help=True)


class DumpFormat(StrEnum):
    TRIG = "trig"
    TURTLE = "turtle"
    VIEWS = "views"


class TableFormat(StrEnum):
    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    TURTLE = "turtle"


def register(app: typer.Typer) -> None:
    """Adds these commands to the command line."""
    for command in (learn, show, check, query):
        app.command()(command)
    app.add_typer(memory_app, name="memory")


def learn(
    script: Script,
    scene: SceneFile,
    engine: Annotated[EngineName, typer.Option(help=ENGINE_HELP)] = EngineName.EXACT,
    time_limit: TimeLimit = 10.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Ground a script in a scene, and keep the layout and its objects as concepts."""
    from deixis.reasoning.errors import NothingFoundError
    from deixis.report import learned_to_dict
    from deixis.session import Session, load_scene
    from deixis.show import learned_lines

    seen = load_scene(scene, hide_labels, image)
    ready_to_ground(engine)
    with Session(memory) as session:
        try:
            with working("grounding"):
                learned = session.learn(script, seen, engine, time_limit)
        except NothingFoundError as error:
            print(f"deixis: {error}", file=sys.stderr)
            raise typer.Exit(1) from error
        where = session.path
    if as_json:
        print_json(learned_to_dict(learned))
    else:
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
    as_json: AsJson = False,
) -> None:
    """Say what is missing, misplaced and extra on a table; exit 0 where all is well, 1 where not."""
    from deixis.report import check_to_dict
    from deixis.session import Session, load_scene
    from deixis.show import check_lines

    if plot is not None:
        from deixis.plot import require_picture

        require_picture(plot)
    seen = load_scene(scene, hide_labels, image)
    ready_to_ground()
    with Session(memory) as session, working("grounding"):
        checked = session.check(layout, seen, time_limit)
    if report is not None:
        report.parent.mkdir(parents=True, exist_ok=True)
        report.write_text(checked.report, encoding="utf-8")
    if plot is not None:
        from deixis.plot_check import plot_check

        plot_check(checked, seen, plot)
    if turtle:
        sys.stdout.write(checked.report)
    elif as_json:
        print_json(check_to_dict(checked))
    else:
        print_lines(check_lines(checked))
        if plot is not None:
            print(f"\nThe picture is in {plot}.")
    if not checked.table.grounding.proved_best:
        raise typer.Exit(3)
    if not checked.table.well:
        raise typer.Exit(1)


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
    from deixis.ontology.errors import DeixisError
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
            raise typer.Exit(1)


@memory_app.command("export")
def export(
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write a file, else print.")] = None,
    format: Annotated[
        DumpFormat,
        typer.Option("--format", help="trig: all concepts; turtle: one graph, for Protégé; views: what was taught."),
    ] = DumpFormat.TRIG,
    memory: MemoryDir = None,
) -> None:
    """Write everything remembered, sorted: the same bytes for the same content."""
    from deixis.memory_session import default_memory
    from deixis.ontology.errors import DeixisError

    where = memory or default_memory()
    if format is DumpFormat.VIEWS:
        from deixis.memory.perceptual.whole import export_all

        if out is None:
            raise DeixisError("views are no text: name a file with -o")
        require_ending(out, (".zip",), "an archive of views")
        export_all(where, out)
        return
    if out is not None:
        require_ending(out, _ENDINGS[format], f"an export as {format}")
    _export_concepts(where, out, format)


_ENDINGS = {DumpFormat.TRIG: (".trig",), DumpFormat.TURTLE: (".ttl",)}
"""What a file is called that import is to read as what it is."""

_VIEWS_TOO = "'--format views -o FILE' writes them"


def _export_concepts(memory: Path, out: Path | None, format: DumpFormat) -> None:
    """Writes or prints what was learned, and says on standard error that views are left behind."""
    from deixis.memory.exchange import export_memory
    from deixis.ontology.errors import DeixisError
    from deixis.session import Session

    with Session(memory) as session:
        views = session.has_views()
        if views and not session.remembers():
            raise DeixisError(f"the memory at {memory} has views only, nothing was learned into it; {_VIEWS_TOO}")
        text = export_memory(session.memory(), format.value)
    if out is None:
        sys.stdout.write(text)
    else:
        out.write_text(text, encoding="utf-8")
    if views:
        print(f"deixis: the memory has views as well, which are not in this export: {_VIEWS_TOO}", file=sys.stderr)


@memory_app.command("import")
def import_(
    dump: Annotated[Path, typer.Argument(metavar="FILE", help="What export wrote, or triples in another format.")],
    memory: MemoryDir = None,
) -> None:
    """Take in what was exported; what is there stays."""
    from deixis.memory.perceptual.whole import import_all, is_archive
    from deixis.memory_session import default_memory
    from deixis.ontology.errors import DeixisError
    from deixis.session import Session

    if not dump.exists():
        raise DeixisError(f"{dump}: there is no such file")
    if is_archive(dump):
        where = memory or default_memory()
        done = import_all(dump, where)
        print(f"{dump} is in the memory {where}.")
        if done.relearn:
            print(f"Categories to be learned anew from their views: {', '.join(done.relearn)}.")
        return
    with Session(memory) as session:
        session.import_(dump)
        print(f"{dump} is in the memory {session.path}.")


@memory_app.command("stats")
def stats(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """Count what is remembered."""
    from dataclasses import asdict

    from deixis.memory.perceptual.whole import stats_of
    from deixis.session import Session
    from deixis.show import stats_lines

    with Session(memory) as session:
        views = stats_of(session.path)
        concepts = session.remembers() or views is None
        counted = asdict(session.memory().stats()) if concepts else {}
        lessons = session.memory().lessons() if concepts else ()
    if views is not None:
        counted["perceptual"] = asdict(views)
    if as_json:
        print_json({**counted, "lesson_ids": list(lessons)})
    else:
        print_lines(stats_lines(counted, lessons))


@memory_app.command("verify")
def verify(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """Read all that was learned and taught, and say what is not as it was written; exit 1 where something is not."""
    from deixis.memory.verifying import verify as run
    from deixis.memory_session import default_memory

    where = memory or default_memory()
    require_memory(where)
    with progress_bar("verifying") as progress:
        found = run(where, progress)
    if as_json:
        findings = [{"where": entry.where, "what": entry.what} for entry in found.findings]
        print_json({"verified": {"concepts": found.semantic, "views": found.perceptual}, "findings": findings})
    else:
        print_lines(_verified_lines(found))
    if found.findings:
        raise typer.Exit(1)


def _verified_lines(found: Verified) -> Iterator[str]:
    there = {"concepts": found.semantic, "views": found.perceptual}
    yield from map(str, found.findings)
    if not found.findings:
        yield f"All {' and '.join(what for what, known in there.items() if known)} are as they were written."
    yield from (f"There are no {what} in this memory." for what, known in there.items() if not known)


@memory_app.command("forget")
def forget(
    lesson: Annotated[str, typer.Argument(metavar="LESSON", help="The id that learn printed; see memory stats.")],
    memory: MemoryDir = None,
) -> None:
    """Take back one lesson, with everything that follows from it alone; views of things stay (category forget)."""
    from deixis.session import Session

    with Session(memory) as session:
        session.forget(lesson)
    print(f"Forgotten: {lesson}.")


def _text(file: Path) -> str:
    from deixis.ontology.errors import DeixisError

    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise DeixisError(f"{file}: the file is not UTF-8 (byte {error.start})") from error
