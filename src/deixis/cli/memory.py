"""The command ``deixis memory``: export, import, stats, verify, forget."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    AsJson,
    MemoryDir,
    print_json,
    print_line,
    print_lines,
    print_note,
    print_written,
    progress_bar,
    require_ending,
    require_memory,
)
from deixis.cli.output import note_change

if TYPE_CHECKING:
    from deixis.memory.verify import Verified

memory_app = typer.Typer(help="Export, import, count, or forget what was learned.", no_args_is_help=True)


class DumpFormat(StrEnum):
    TRIG = "trig"
    TURTLE = "turtle"
    VIEWS = "views"


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
    from deixis.errors import DeixisError
    from deixis.memory.on_demand import default_memory

    where = memory or default_memory()
    if format is DumpFormat.VIEWS:
        from deixis.memory.perceptual.in_folder import export_all

        if out is None:
            raise DeixisError("views are no text: name a file with -o")
        require_ending(out, (".zip",), "an archive of views")
        with progress_bar("exporting") as progress:
            export_all(where, out, progress)
        print_written(out)
        return
    if out is not None:
        require_ending(out, _ENDINGS[format], f"an export as {format}")
    _export_concepts(where, out, format)


_ENDINGS = {DumpFormat.TRIG: (".trig",), DumpFormat.TURTLE: (".ttl",)}
"""What a file is called that import is to read as what it is."""

_VIEWS_TOO = "'--format views -o FILE' writes them"


def _export_concepts(memory: Path, out: Path | None, format: DumpFormat) -> None:
    """Writes or prints what was learned, and says on standard error that views are left behind."""
    from deixis.errors import DeixisError
    from deixis.memory.semantic.exchange import export_memory
    from deixis.session import Session

    with Session(memory) as session:
        views = session.has_views()
        if views and not session.remembers():
            raise DeixisError(f"the memory at {memory} has views, but no lessons yet; {_VIEWS_TOO}")
        text = export_memory(session.memory(), format.value)
    if out is None:
        sys.stdout.write(text)
    else:
        out.write_text(text, encoding="utf-8")
        print_written(out)
    if views:
        print_note(f"the memory has views as well, which are not in this export: {_VIEWS_TOO}")


@memory_app.command("import")
def import_(
    dump: Annotated[Path, typer.Argument(metavar="FILE", help="What export wrote, or triples in another format.")],
    memory: MemoryDir = None,
) -> None:
    """Take in what was exported; what is there stays."""
    from deixis.errors import DeixisError
    from deixis.memory.on_demand import default_memory
    from deixis.memory.perceptual.in_folder import import_all, is_archive
    from deixis.session import Session

    if not dump.exists():
        raise DeixisError(f"{dump}: there is no such file")
    if is_archive(dump):
        where = memory or default_memory()
        with progress_bar("importing") as progress:
            done = import_all(dump, where, progress)
        note_change(where)
        print_line(f"{dump} is in the memory {where}.")
        if done.relearn:
            print_line(f"Categories to be learned anew from their views: {', '.join(done.relearn)}.")
        return
    with Session(memory) as session:
        session.import_(dump)
        note_change(session.path)
        print_line(f"{dump} is in the memory {session.path}.")


@memory_app.command("stats")
def stats(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """Count what is remembered."""
    from dataclasses import asdict

    from deixis.memory.perceptual.in_folder import stats_of
    from deixis.report.script import stats_lines
    from deixis.session import Session

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
    """Read all that was learned and taught, and say what is not as it was written, or does not follow from the lessons;
    exit 1 where something is not."""
    from deixis.learning.update import stale
    from deixis.memory.on_demand import default_memory
    from deixis.memory.verify import verify as run
    from deixis.ontology.tbox import default_ontology

    where = memory or default_memory()
    require_memory(where)
    with progress_bar("verifying") as progress:
        found = run(where, progress, lambda store: stale(store, default_ontology()))
    if as_json:
        findings = [{"where": entry.where, "what": entry.what} for entry in found.findings]
        print_json({"verified": {"concepts": found.semantic, "views": found.perceptual}, "findings": findings})
    else:
        print_lines(_verified_lines(found))
    if found.findings:
        raise typer.Exit(NO)


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
    note_change(session.path)
    print_line(f"Forgotten: {lesson}.")
