"""The commands ``deixis memory export``, ``import``, ``stats``, ``verify`` and ``forget``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
    print_or_write,
    print_written,
    require_ending,
    require_memory,
)
from deixis.cli.completion import complete_lessons
from deixis.cli.output import note_change
from deixis.cli.progress import progress_bar
from deixis.report.marks import violation

if TYPE_CHECKING:
    from deixis.memory.verify import Verified

memory_app = typer.Typer(
    help="Export, import, count, verify or forget the content of the memory.", no_args_is_help=True
)


class DumpFormat(StrEnum):
    """Formats of ``deixis memory export``."""

    TRIG = "trig"
    TURTLE = "turtle"
    VIEWS = "views"
    EPISODES = "episodes"


@memory_app.command("export")
def export(
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write a file instead of printing.")
    ] = None,
    format: Annotated[
        DumpFormat,
        typer.Option(
            "--format",
            help="trig: all concepts; turtle: one graph, for Protégé; views: taught views; episodes: the blackboard.",
        ),
    ] = DumpFormat.TRIG,
    memory: MemoryDir = None,
) -> None:
    """Write the content of the memory, sorted, so that equal content gives equal bytes."""
    from deixis.errors import DeixisError
    from deixis.memory.on_demand import default_memory

    where = memory or default_memory()
    if format is DumpFormat.VIEWS:
        from deixis.memory.perceptual.in_folder import export_all

        if out is None:
            raise DeixisError("views are not text; name a file with -o")
        require_ending(out, (".zip",), "an archive of views")
        with progress_bar("exporting") as progress:
            export_all(where, out, progress)
        print_written(out)
        return
    if out is not None:
        require_ending(out, _ENDINGS[format], f"an export as {format}")
    if format is DumpFormat.EPISODES:
        from deixis.memory.episodes.blackboard import Blackboard
        from deixis.memory.episodes.exchange import export_episodes

        with Blackboard.open(where) as board:
            print_or_write(export_episodes(board), out)
        return
    _export_concepts(where, out, format)


_ENDINGS = {DumpFormat.TRIG: (".trig",), DumpFormat.TURTLE: (".ttl",), DumpFormat.EPISODES: (".episodes.json",)}
"""Endings of the exported files, by which ``import`` knows the format."""

_VIEWS_TOO = "'--format views -o FILE' writes them"


def _export_concepts(memory: Path, out: Path | None, format: DumpFormat) -> None:
    """Write or print the concepts; print a note on standard error that views and episodes are not included."""
    from deixis.errors import DeixisError
    from deixis.memory.episodes.blackboard import has_episodes
    from deixis.memory.semantic.exchange import export_memory
    from deixis.session import Session

    with Session(memory) as session:
        views = session.has_views()
        if views and not session.remembers():
            raise DeixisError(f"the memory at {memory} has views, but no lessons yet; {_VIEWS_TOO}")
        text = export_memory(session.memory(), format.value)
    print_or_write(text, out)
    if views:
        print_note(f"the memory also has views, which are not in this export; {_VIEWS_TOO}")
    if has_episodes(memory):
        print_note("the memory also has episodes, which are not in this export; '--format episodes' writes them")


@memory_app.command("import")
def import_(
    dump: Annotated[Path, typer.Argument(metavar="FILE", help="An exported file, or triples in another format.")],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Add exported content to the memory; what the memory has stays."""
    from deixis.errors import DeixisError
    from deixis.memory.episodes.exchange import ENDING, has_ending, import_file
    from deixis.memory.on_demand import default_memory
    from deixis.memory.perceptual.in_folder import import_all, is_archive
    from deixis.memory.semantic.rdf.files import FORMATS
    from deixis.session import Session

    if not dump.exists():
        raise DeixisError(f"{dump}: there is no such file")
    if dump.is_dir():
        raise DeixisError(f"{dump}: this is a folder; name a file that 'deixis memory export' wrote")
    if is_archive(dump):
        where = memory or default_memory()
        with progress_bar("importing") as progress:
            done = import_all(dump, where, progress)
        _print_imported(dump, where, "views", as_json, learn_again=done.relearn)
    elif has_ending(dump):
        where = memory or default_memory()
        with progress_bar("importing"):
            fluents = import_file(where, dump)
        _print_imported(dump, where, "episodes", as_json, fluents=fluents)
    elif dump.suffix.lower() in FORMATS:
        with Session(memory) as session:
            with progress_bar("importing"):
                session.import_(dump)
            _print_imported(dump, session.path, "concepts", as_json)
    elif dump.suffix.lower() == ".zip":
        raise DeixisError(f"{dump}: this is not an archive of views; 'deixis memory export --format views' writes one")
    else:
        endings = ", ".join((*FORMATS, ".zip (views)"))
        raise DeixisError(f"{dump}: unknown format; its name must end in {endings} or {ENDING}")


def _print_imported(
    dump: Path, memory: Path, content: str, as_json: bool, fluents: int | None = None, learn_again: Sequence[str] = ()
) -> None:
    """Print what was imported, with the categories to be learned again."""
    note_change(memory)
    if as_json:
        print_json({"content": content, "memory": str(memory), "fluents": fluents, "learn_again": list(learn_again)})
        return
    print_line(f"Imported {'' if fluents is None else f'{fluents} fluents of '}{dump} into the memory {memory}.")
    if learn_again:
        print_line(f"These categories must be learned again from their views: {', '.join(learn_again)}.")


@memory_app.command("stats")
def stats(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """Print how much the memory holds, and the ids of its lessons."""
    from dataclasses import asdict

    from deixis.memory.episodes.exchange import stats_of as episode_stats_of
    from deixis.memory.perceptual.in_folder import stats_of
    from deixis.report.layouts.script import stats_lines
    from deixis.session import Session

    with Session(memory) as session:
        views = stats_of(session.path)
        episodes = episode_stats_of(session.path)
        concepts = session.remembers() or (views is None and episodes is None)
        counted = asdict(session.memory().stats()) if concepts else {}
        lessons = session.memory().lessons() if concepts else ()
    if views is not None:
        counted["perceptual"] = asdict(views)
    if episodes is not None:
        counted["episodes"] = asdict(episodes)
    if as_json:
        print_json({**counted, "lesson_ids": list(lessons)})
    else:
        print_lines(stats_lines(counted, lessons))


@memory_app.command("verify")
def verify(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """Check the memory for damage, and for concepts that do not follow from its lessons; exit 1 on any finding."""
    from deixis.learning.update import stale
    from deixis.memory.episodes.blackboard import has_episodes
    from deixis.memory.on_demand import default_memory
    from deixis.memory.verify import verify as run
    from deixis.ontology.tbox import default_ontology

    where = memory or default_memory()
    episodes = has_episodes(where)
    if not episodes:
        require_memory(where)
    with progress_bar("verifying") as progress:
        found = run(where, progress, lambda store: stale(store, default_ontology()))
    if as_json:
        findings = [{"where": entry.where, "what": entry.what} for entry in found.findings]
        verified = {"concepts": found.semantic, "views": found.perceptual, "episodes": episodes}
        print_json({"verified": verified, "findings": findings})
    else:
        print_lines(_verified_lines(found, episodes))
    if found.findings:
        raise typer.Exit(NO)


def _verified_lines(found: Verified, episodes: bool) -> Iterator[str]:
    there = {"concepts": found.semantic, "views": found.perceptual} | ({"episodes": True} if episodes else {})
    yield from (violation(str(finding)) for finding in found.findings)
    if not found.findings:
        yield f"All {' and '.join(what for what, known in there.items() if known)} are undamaged."
    yield from (f"There are no {what} in this memory." for what, known in there.items() if not known)


@memory_app.command("forget")
def forget(
    lesson: Annotated[
        str,
        typer.Argument(
            metavar="LESSON",
            help="The lesson's id, as printed by 'learn' and 'memory stats'.",
            autocompletion=complete_lessons,
        ),
    ],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Forget a lesson and everything that follows from it alone; 'category forget' forgets views."""
    from deixis.session import Session

    with Session(memory) as session:
        session.forget(lesson)
        note_change(session.path)
        if as_json:
            print_json({"forgotten": lesson, "lessons": list(session.memory().lessons())})
        else:
            print_line(f"Forgotten: {lesson}.")
