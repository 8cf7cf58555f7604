"""Verify a memory: read all of it and list what differs from what was written. ``deixis memory verify`` calls it.

The semantic store is opened for reading only, and read through each of its indexes; RocksDB checks the checksum of
every block that it reads. A memory without lessons, views or episodes lacks a store and is complete.
Finally, the stores are compared: the views that lessons taught exist, in the categories that the lessons name, and the
lessons of the views exist; the episodes have what was said when lessons and views were taught, and experiences name
lessons that exist. An interrupted write over several stores is completed or rolled back first.

>>> import tempfile
>>> from deixis.memory.semantic.store import SemanticMemory
>>> folder = Path(tempfile.mkdtemp())
>>> SemanticMemory.open(folder, create=True).close()
>>> verify(folder)
Verified(semantic=True, perceptual=False, findings=())
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import pyoxigraph as ox

from deixis.memory import folder as files
from deixis.memory.episodes.blackboard import Blackboard, has_episodes
from deixis.memory.episodes.experiences import CONSOLIDATED
from deixis.memory.episodes.fluents.episode import EVENT
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError, ReadOnlyMemoryError
from deixis.memory.folder import FolderState
from deixis.memory.owner import OwnerLock, ReaderLock
from deixis.memory.perceptual.in_folder import has_views, open_in
from deixis.memory.perceptual.protocol import Finding, Progress
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.links import all_links, events_of_lessons
from deixis.reasoning.temporal.fluent import Pattern

_INDEXES = {
    "subject": (0,),
    "predicate": (1,),
    "object": (2,),
    "graph and subject": (3, 0),
    "graph and predicate": (3, 1),
    "graph and object": (3, 2),
}
"""Indexes of the store, each as the places in a quad that it is looked up by."""


Stale = Callable[[ox.Store], Iterable[str]]
"""A function that yields a line for each part of a store that differs from what its lessons lead to."""


@dataclass(frozen=True)
class Verified:
    """Result of :func:`verify`: whether there are lessons and views, and the findings in all stores."""

    semantic: bool
    perceptual: bool
    findings: tuple[Finding, ...]


def verify(memory: Path, progress: Progress | None = None, stale: Stale | None = None) -> Verified:
    """Read all stores of a memory completely, without changing their content.

    Parameters
    ----------
    memory
        Folder of the memory.
    progress
        Called with the number of steps done and of all steps.
    stale
        Function that yields a line for each part of the semantic store that does not follow from its lessons. It is
        called if the store could be read.

    Returns
    -------
    Verified
        Which stores were read, and what is wrong with them.

    Raises
    ------
    MemoryFormatError
        The folder is not a memory.
    MemoryBusyError
        Another process has the memory open.
    """
    semantic = files.inspect(memory) not in (FolderState.ABSENT, FolderState.EMPTY)
    perceptual = has_views(memory)
    events, episodes = _verify_episodes(memory)
    views = _verify_views(memory, progress) if perceptual else _Views({}, {}, {}, ())
    findings: list[Finding] = []
    if semantic:
        lock = _lock(memory)
        try:
            files.check_store_opens(memory)
            store = ox.Store.read_only(str(files.store_in(memory)))
            findings += _findings(store, progress)
            if not findings:
                findings += (Finding(files.STORE, line) for line in (stale(store) if stale is not None else ()))
                findings += () if views.categories is None else _disagreements(store, views.categories, views.lessons)
                findings += () if events is None else _unrecorded(store, events)
        except MemoryFormatError as error:
            findings.append(Finding(files.STORE, files.one_line(error)))
        finally:
            lock.release(undo=True)
    else:
        findings += (_lessonless(view, lesson) for view, lesson in sorted(views.lessons.items()))
    if events is not None:
        findings += _unshown(views.events, events)
    return Verified(semantic, perceptual, (*findings, *views.findings, *episodes))


class _Events(NamedTuple):
    """The events that the log of the blackboard ever had, and the lessons that experiences name."""

    origin: str
    known: Set[str]
    consolidated: Mapping[str, str]


def _verify_episodes(memory: Path) -> tuple[_Events | None, tuple[Finding, ...]]:
    """Find where the log, the fluents and the index of times of the blackboard disagree, if there is one.

    The events are None where they could not all be read; without a blackboard there are none.
    """
    if not has_episodes(memory):
        return _Events("", frozenset(), {}), ()
    try:
        with Blackboard.open(memory) as board:
            found = tuple(Finding(files.EPISODES, line) for line in board.verify())
            marks = board.holding(Pattern(predicate=CONSOLIDATED))
            named = {
                fact.subject: fact.object for fact in (each.statement for each in marks) if fact.object is not None
            }
            return None if found else _Events(board.origin.isoformat(), board.events(), named), found
    except DamagedMemoryError as error:
        return None, (Finding(files.EPISODES, files.one_line(error)),)


def _unrecorded(store: ox.Store, events: _Events) -> Iterator[Finding]:
    """Find lessons that were taught by what the episodes never had, and experiences whose lesson is missing."""
    for lesson, taught in events_of_lessons(store).items():
        for event in taught:
            if event not in events.known:
                yield Finding(f"lesson '{lesson}'", f"it was taught by '{event}', which the episodes never had")
    for name, lesson in sorted(events.consolidated.items()):
        if not ledger.knows(store, lesson):
            yield Finding(f"experience '{name}'", f"it taught the lesson '{lesson}', which is missing")


def _unshown(views: Mapping[str, Set[str]], events: _Events) -> Iterator[Finding]:
    """Find views that were shown in events of this blackboard which the episodes never had."""
    for view, shown in sorted(views.items()):
        for origin, _, event in (each.partition(" ") for each in sorted(shown)):
            if origin == events.origin and event not in events.known:
                yield Finding(f"view '{view}'", f"it was shown in '{event}', which the episodes never had")


def _lock(memory: Path) -> OwnerLock | ReaderLock:
    try:
        return OwnerLock.acquire(memory)
    except ReadOnlyMemoryError:
        return ReaderLock.acquire(memory)


class _Views(NamedTuple):
    """Category, lesson and events of each view in the perceptual store, by the view's id, and the findings in it.

    ``categories`` is None where not all views could be read; then the stores are not compared.
    """

    categories: Mapping[str, str] | None
    lessons: Mapping[str, str]
    events: Mapping[str, Set[str]]
    findings: tuple[Finding, ...]


def _verify_views(memory: Path, progress: Progress | None) -> _Views:
    try:
        with open_in(memory) as views:
            found = views.verify(progress)
            if found:
                return _Views(None, {}, {}, found)
            events = {view.id: _events(view.metadata) for view in views.headers()}
            for view, turns in views.teachings().items():
                events[view] = events.get(view, set()).union(*(_events(turn["metadata"]) for turn in turns))
            return _Views({key.id: key.category for key in views.listing()}, views.lessons_of_views(), events, ())
    except DamagedMemoryError as error:
        return _Views(None, {}, {}, (Finding(files.PERCEPTUAL, files.one_line(error)),))


def _events(metadata: object) -> set[str]:
    """Return the event of the metadata of a view, which are given as JSON or parsed."""
    values = json.loads(metadata) if isinstance(metadata, str | bytes) else metadata
    event = values.get(EVENT) if isinstance(values, dict) else None
    return {event} if isinstance(event, str) else set()


def _disagreements(store: ox.Store, categories: Mapping[str, str], lessons: Mapping[str, str]) -> Iterator[Finding]:
    """Find where the two stores disagree about the views of lessons."""
    taught = all_links(store)
    for lesson, view, category in taught:
        where = f"lesson '{lesson}'"
        if not ledger.knows(store, lesson):
            yield Finding(where, f"it taught the view '{view}', but the lesson is missing")
        elif view not in categories:
            yield Finding(where, f"it taught the view '{view}' of '{category}', which is missing")
        elif categories[view] != category:
            yield Finding(where, f"it taught the view '{view}' of '{category}', which is now of '{categories[view]}'")
        elif view not in lessons:
            yield Finding(where, f"it taught the view '{view}', which refers to no lesson")
    linked = {(link.lesson, link.view) for link in taught}
    for view, lesson in sorted(lessons.items()):
        if view not in categories:
            yield Finding(f"view '{view}'", f"it belongs to the lesson '{lesson}', but is missing")
        elif not ledger.knows(store, lesson):
            yield _lessonless(view, lesson)
        elif (lesson, view) not in linked:
            yield Finding(f"view '{view}'", f"it belongs to the lesson '{lesson}', which does not list it")


def _lessonless(view: str, lesson: str) -> Finding:
    return Finding(f"view '{view}'", f"it belongs to the lesson '{lesson}', which is missing")


def _findings(store: ox.Store, progress: Progress | None) -> Iterator[Finding]:
    try:
        quads = list(store)
        graphs = set(store.named_graphs())
    except (OSError, RuntimeError) as error:
        yield Finding(files.STORE, f"the store cannot be read completely: {files.one_line(error)}")
        return
    if lost := {quad.graph_name for quad in quads} - graphs - {ox.DefaultGraph()}:
        yield Finding(files.STORE, f"non-empty graphs are not listed: {', '.join(sorted(map(str, lost)))}")
    for done, (name, places) in enumerate(_INDEXES.items(), start=1):
        try:
            found = _read_through(store, quads, places)
        except (OSError, RuntimeError) as error:
            yield Finding(files.STORE, f"the index by {name} cannot be read completely: {files.one_line(error)}")
        else:
            if found != len(quads):
                yield Finding(files.STORE, f"the store has {len(quads)} quads, but the index by {name} has {found}")
        if progress is not None:
            progress(done, len(_INDEXES))


def _read_through(store: ox.Store, quads: list[ox.Quad], places: tuple[int, ...]) -> int:
    """Look up every quad by some of its places, and count the results.

    Other results are not counted: Oxigraph 0.5 reads on after a term whose bytes are all ones, such as -1.
    """
    found = 0
    for wanted in {tuple(quad[place] for place in places) for quad in quads}:
        pattern = [None] * 4
        for place, term in zip(places, wanted, strict=True):
            pattern[place] = term
        came = store.quads_for_pattern(*pattern)
        found += sum(1 for quad in came if tuple(quad[place] for place in places) == wanted)
    return found
