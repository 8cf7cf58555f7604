"""The commands ``deixis episodes …``: write and read the blackboard of a memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.answers import count
from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    MemoryDir,
    print_json,
    print_line,
    print_lines,
    print_note,
    print_or_write,
    require_ending,
)
from deixis.cli.progress import progress_bar, time_bar

if TYPE_CHECKING:
    from deixis.memory.episodes.blackboard import Blackboard
    from deixis.reasoning.temporal.fluent import Pattern

episodes_app = typer.Typer(
    help="Write and read the blackboard: what held when, what holds now, and experiences.", no_args_is_help=True
)

ANY = "*"

By = Annotated[str, typer.Option(metavar="NAME", help="The person or module that states it.")]
Triple = Annotated[
    tuple[str, str, str], typer.Option("--pattern", metavar="S P O", help="Only statements like this; * is anything.")
]
Window = Annotated[
    tuple[float, float] | None, typer.Option(metavar="FROM TO", help="Only what may hold in this time, in seconds.")
]


CONSISTENCY = {True: "consistent", False: "contradictory", None: "undecided"}
"""Wording of the result of a check."""


class OriginName(StrEnum):
    """Ways in which a fluent can become known."""

    SEEN = "seen"
    SHOWN = "shown"
    SAID = "said"
    INFERRED = "inferred"


class MemoryName(StrEnum):
    """The five memories."""

    WORKING = "working"
    EPISODIC = "episodic"
    SEMANTIC = "semantic"
    PERCEPTUAL = "perceptual"
    PROCEDURAL = "procedural"


@episodes_app.command("add")
def add(
    words: Annotated[list[str], typer.Argument(metavar="SUBJECT PREDICATE [OBJECT]", help="The statement.")],
    start: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time at which it starts; unknown by default.")
    ] = None,
    finish: Annotated[float | None, typer.Option(metavar="SECONDS", help="Time at which it finishes.")] = None,
    certainty: Annotated[float, typer.Option(metavar="P", help="Probability that it is true.")] = 1.0,
    origin: Annotated[OriginName, typer.Option(help="Way in which it became known.")] = OriginName.SAID,
    by: By = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Add a statement with its times; without times it is a plain triple."""
    from deixis.errors import DeixisError
    from deixis.memory.episodes.fluents.changes import Add
    from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
    from deixis.reasoning.temporal.fluent import Statement
    from deixis.workflows.knowledge.episodes import fluent_to_dict

    if len(words) not in (2, 3):
        raise DeixisError(
            f"a statement must have a subject, a predicate and at most one object, got {count(len(words), 'word')}"
        )
    with _board(memory, create=True) as board:
        source = Source(Origin(origin.value), by)
        statement = Statement(*words)
        fluent = episodic(board.new_id("f"), statement, start=start, finish=finish, certainty=certainty, source=source)
        board.write(Add(fluent), by=by)
    if as_json:
        print_json(fluent_to_dict(fluent))
    else:
        print_line(str(fluent))


@episodes_app.command("import")
def import_(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A file of fluents (.fluents.json).")],
    origin: Annotated[OriginName, typer.Option(help="Way in which they became known.")] = OriginName.SAID,
    name: Annotated[str | None, typer.Option(metavar="NAME", help="Keep them as an experience of this name.")] = None,
    by: By = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Add all fluents of a file, or nothing."""
    from deixis.grammar.files import read_text
    from deixis.memory.episodes.experiences import put_episode
    from deixis.memory.episodes.fluents.changes import Add
    from deixis.memory.episodes.fluents.episode import Origin, Source
    from deixis.workflows.knowledge.episodes import fluents_of_text, span_of

    fluents = fluents_of_text(read_text(file, str(file)), str(file), Source(Origin(origin.value), by))
    with _board(memory, create=True) as board:
        if name is None:
            board.write(*map(Add, fluents), by=by)
        else:
            put_episode(board, name, fluents, *span_of(fluents), by=by)
        last = board.sequence
    _print_changed("Added", len(fluents), last, as_json)


@episodes_app.command("finish")
def finish_(
    ids: Annotated[list[str] | None, typer.Argument(metavar="[ID]...", help="Fluents.")] = None,
    at: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time at which they finish; default: now.")
    ] = None,
    pattern: Triple = (ANY, ANY, ANY),
    by: By = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """State when fluents ceased to hold, by their ids or by a pattern."""
    from deixis.memory.episodes.fluents.changes import Finish

    with _board(memory) as board:
        before, time = board.sequence, board.seconds() if at is None else at
        if _by_ids(ids, pattern):
            last = board.write(*(Finish(id, time) for id in ids or ()), by=by)
        else:
            last = board.finish_where(_pattern(*pattern), time, by)
    _print_changed("Finished", last - before, last, as_json)


@episodes_app.command("update")
def update(
    ids: Annotated[list[str] | None, typer.Argument(metavar="[ID]...", help="Fluents.")] = None,
    certainty: Annotated[float | None, typer.Option(metavar="P", help="Probability that they are true.")] = None,
    start: Annotated[float | None, typer.Option(metavar="SECONDS", help="Time at which they start.")] = None,
    finish: Annotated[float | None, typer.Option(metavar="SECONDS", help="Time at which they finish.")] = None,
    pattern: Triple = (ANY, ANY, ANY),
    window: Window = None,
    by: By = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Give fluents new values, by their ids or by a pattern and a window."""
    from deixis.errors import DeixisError
    from deixis.memory.episodes.fluents.changes import Update

    if certainty is None and start is None and finish is None:
        raise DeixisError("there is no new value; give --certainty, --start or --finish")
    with _board(memory) as board:
        before = board.sequence
        if _by_ids(ids, pattern, window):
            changes = (Update(id, start=start, finish=finish, certainty=certainty) for id in ids or ())
            last = board.write(*changes, by=by)
        else:
            last = board.update_where(
                _pattern(*pattern),
                by,
                *(window or (None, None)),
                new_start=start,
                new_finish=finish,
                certainty=certainty,
            )
    _print_changed("Updated", last - before, last, as_json)


@episodes_app.command("delete")
def delete(
    ids: Annotated[list[str] | None, typer.Argument(metavar="[ID]...", help="Fluents.")] = None,
    pattern: Triple = (ANY, ANY, ANY),
    window: Window = None,
    by: By = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Remove fluents as if they had never been stated, by their ids or by a pattern and a window."""
    from deixis.memory.episodes.fluents.changes import Delete

    with _board(memory) as board:
        before = board.sequence
        if _by_ids(ids, pattern, window):
            last = board.write(*map(Delete, ids or ()), by=by)
        else:
            last = board.delete_where(_pattern(*pattern), by, *(window or (None, None)))
    _print_changed("Deleted", last - before, last, as_json)


@episodes_app.command("list")
def list_(
    pattern: Triple = (ANY, ANY, ANY),
    window: Window = None,
    now: Annotated[bool, typer.Option("--now", help="Only what has not finished.")] = False,
    experience: Annotated[str | None, typer.Option(metavar="NAME", help="Only what held in an experience.")] = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """List fluents with their times, certainty and source."""
    from deixis.memory.episodes.experiences import episode
    from deixis.workflows.knowledge.episodes import fluent_to_dict

    with _board(memory) as board:
        wanted = _pattern(*pattern)
        if experience is not None:
            found = tuple(each for each in episode(board, experience) if wanted.matches(each.statement))
        else:
            found = board.now(wanted) if now else board.holding(wanted, *(window or (None, None)))
        origin, sequence = board.origin.isoformat(), board.sequence
    if as_json:
        print_json({"origin": origin, "sequence": sequence, "fluents": [fluent_to_dict(each) for each in found]})
    else:
        print_lines([str(each) for each in found] or ["Nothing is known to hold."])


@episodes_app.command("changes")
def changes(
    since: Annotated[int, typer.Option(metavar="N", help="Only changes after this number.")] = 0,
    pattern: Triple = (ANY, ANY, ANY),
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Print the log of changes."""
    from deixis.workflows.knowledge.episodes import change_to_dict

    with _board(memory) as board:
        found = board.changes(since, _pattern(*pattern))
        if as_json:
            print_json({"origin": board.origin.isoformat(), "changes": [change_to_dict(each) for each in found]})
        else:
            print_lines(map(str, found))


@episodes_app.command("export")
def export(
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write a file instead of printing.")
    ] = None,
    pattern: Triple = (ANY, ANY, ANY),
    window: Window = None,
    memory: MemoryDir = None,
) -> None:
    """Write fluents as a file that 'deixis time' reads."""
    from deixis.workflows.knowledge.episodes import text_of_fluents

    if out is not None:
        require_ending(out, (".json",), "a file of fluents")
    with _board(memory) as board:
        text = text_of_fluents(board, _pattern(*pattern), *(window or (None, None)))
    print_or_write(text, out)


@episodes_app.command("record")
def record(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the experience.")],
    stop: Annotated[bool, typer.Option("--stop", help="Finish the recording instead of starting it.")] = False,
    at: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time at which it starts or stops; default: now.")
    ] = None,
    by: By = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Start or finish the recording of an experience."""
    from deixis.memory.episodes.experiences import experiences, finish_recording, start_recording
    from deixis.workflows.knowledge.episodes import experience_to_dict

    with _board(memory, create=not stop) as board:
        time = board.seconds() if at is None else at
        if stop:
            finish_recording(board, name, time, by)
        else:
            start_recording(board, name, time, by)
        recorded = next(each for each in experiences(board) if each.name == name)
    if as_json:
        print_json(experience_to_dict(recorded))
    else:
        print_line(f"The recording of '{name}' {'finished' if stop else 'started'} at {time:g} s.")


@episodes_app.command("check")
def check(
    pattern: Triple = (ANY, ANY, ANY),
    window: Window = None,
    ontology: Annotated[
        bool, typer.Option("--ontology/--no-ontology", help="Check kinds and relations by the ontology, which is slow.")
    ] = True,
    time_limit: Annotated[float, typer.Option(min=0.0, metavar="SECONDS", help="Answer within this time.")] = 30.0,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Check whether fluents can all be true, in time, in space and by the ontology; exit 1 if not, 3 if undecided."""
    from deixis.ontology.tbox import default_ontology
    from deixis.workflows.knowledge.episodes import check_consistency

    with _board(memory) as board:
        fluents = board.holding(_pattern(*pattern), *(window or (None, None)))
    with time_bar("checking", time_limit):
        found = check_consistency(fluents, default_ontology(), time_limit, logical=ontology)
    conflicts = {"time": found.temporal, "space": found.spatial, "ontology": found.logical}
    undecided = found.consistent and bool(found.undecided)
    consistent = None if undecided else found.consistent
    if as_json:
        lists = {**conflicts, "undecided": found.undecided}
        print_json({"consistent": consistent, "fluents": len(fluents), **{k: list(v) for k, v in lists.items()}})
    else:
        print_lines(f"{kind}: {line}" for kind, lines in conflicts.items() for line in lines)
        for note in found.undecided:
            print_note(note)
        print_line(f"{count(len(fluents), 'fluent')}: {CONSISTENCY[consistent]}")
    if consistent is not True:
        raise typer.Exit(UNDECIDED if undecided else NO)


@episodes_app.command("classes")
def classes(
    under: Annotated[str | None, typer.Argument(metavar="[CLASS]", help="Only this class and its subclasses.")] = None,
    used: Annotated[bool, typer.Option("--used", help="Only classes with individuals.")] = False,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """List classes with their broader classes and the individuals that are of them now."""
    from deixis.ontology.tbox import default_ontology
    from deixis.workflows.knowledge.episodes import known_classes

    with _board(memory) as board:
        found = [each for each in known_classes(board, default_ontology(), under) if each.individuals or not used]
    if as_json:
        print_json({"classes": [each._asdict() for each in found]})
        return
    for each in found:
        above = f" < {', '.join(each.broader)}" if each.broader else ""
        print_line(f"{each.name}{above}{': ' if each.individuals else ''}{', '.join(each.individuals)}")


@episodes_app.command("memory")
def memory_(
    name: Annotated[MemoryName, typer.Argument(metavar="NAME", help=f"The memory: {', '.join(MemoryName)}.")],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Print the content of one of the five memories."""
    from deixis.memory.episodes.blackboard import Blackboard, has_episodes
    from deixis.memory.on_demand import default_memory
    from deixis.session import Session
    from deixis.text_files import is_folder
    from deixis.workflows.knowledge.episodes import Memory, memory_lines, memory_to_dict

    folder = memory or default_memory()
    without_episodes = is_folder(folder) and not has_episodes(folder)
    with Blackboard.transient() if without_episodes else _board(folder) as board, Session(folder) as session:
        if as_json:
            print_json(memory_to_dict(Memory(name.value), board, session))
            return
        print_lines(list(memory_lines(Memory(name.value), board, session)) or [f"The {name.value} memory is empty."])


@episodes_app.command("consolidate")
def consolidate(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """Learn a layout from each finished experience that a person described."""
    from deixis.memory.on_demand import default_memory
    from deixis.session import Session
    from deixis.workflows.knowledge.episodes import consolidate as run

    with (
        _board(memory) as board,
        Session(memory or default_memory()) as session,
        progress_bar("learning from the experiences") as progress,
    ):
        done = run(board, session, progress=progress)
    if as_json:
        print_json(done.to_dict())
        return
    print_lines(done.to_text().split("\n"))


@contextmanager
def _board(memory: Path | None, create: bool = False) -> Iterator[Blackboard]:
    from deixis.memory.episodes.blackboard import Blackboard
    from deixis.memory.on_demand import default_memory

    with Blackboard.open(memory or default_memory(), create=create, report=print_note) as board:
        yield board


def _print_changed(verb: str, fluents: int, sequence: int, as_json: bool) -> None:
    """Print how many fluents a command changed."""
    if as_json:
        print_json({"fluents": fluents, "sequence": sequence})
    else:
        print_line(f"{verb} {count(fluents, 'fluent')}.")


def _by_ids(ids: list[str] | None, pattern: tuple[str, str, str], window: tuple[float, float] | None = None) -> bool:
    from deixis.errors import DeixisError

    by_query = pattern != (ANY, ANY, ANY) or window is not None
    if bool(ids) == by_query:
        raise DeixisError("name fluents by their ids, or else by --pattern or --window")
    return bool(ids)


def _pattern(subject: str, predicate: str, object: str) -> Pattern:
    from deixis.reasoning.temporal.fluent import Pattern

    return Pattern(*(None if word == ANY else word for word in (subject, predicate, object)))
