"""Reading all of a memory, and saying what is not as it was written: what ``deixis memory verify`` calls.

The semantic store is opened for reading only, and read through each of its indexes: RocksDB sums up every block that it
reads. A memory in which nothing was learned, or nothing taught, has but one of the two stores, and is whole with it.

>>> import tempfile
>>> from deixis.memory.semantic.store import SemanticMemory
>>> folder = Path(tempfile.mkdtemp())
>>> SemanticMemory.open(folder, create=True).close()
>>> verify(folder)
Verified(semantic=True, perceptual=False, findings=())
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pyoxigraph as ox

from deixis.memory import folder as files
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError
from deixis.memory.folder import FolderState
from deixis.memory.owner import OwnerLock
from deixis.memory.perceptual.in_folder import has_views, verify_views
from deixis.memory.perceptual.protocol import Finding, Progress

_INDEXES = {
    "subject": (0,),
    "predicate": (1,),
    "object": (2,),
    "graph and subject": (3, 0),
    "graph and predicate": (3, 1),
    "graph and object": (3, 2),
}
"""What the store looks quads up by, one index each, as places in a quad."""


Stale = Callable[[ox.Store], Iterable[str]]
"""What says of a store what in it is not as it would be worked out anew."""


@dataclass(frozen=True)
class Verified:
    """Which of the two stores are there and were read, and what in them is not as it was written."""

    semantic: bool
    perceptual: bool
    findings: tuple[Finding, ...]


def verify(memory: Path, progress: Progress | None = None, stale: Stale | None = None) -> Verified:
    """Read both stores of a memory to their end; change neither's content.

    ``stale`` says of a semantic store that could be read, a line each, what in it does not follow from its lessons.
    Raises MemoryFormatError for a folder that is no memory, MemoryBusyError where another process has it.
    """
    semantic = files.inspect(memory) not in (FolderState.ABSENT, FolderState.EMPTY)
    perceptual = has_views(memory)
    findings = verify_semantic(memory, progress, stale) if semantic else ()
    return Verified(semantic, perceptual, (*findings, *_verify_perceptual(memory, progress)))


def verify_semantic(memory: Path, progress: Progress | None = None, stale: Stale | None = None) -> tuple[Finding, ...]:
    """Return what in the semantic store is not as it was written; ``progress`` is told of indexes done, and of their
    number.

    Raises MemoryBusyError where another process has it.
    """
    lock = OwnerLock.acquire(memory)
    try:
        files.check_store_opens(memory)
        store = ox.Store.read_only(str(files.store_in(memory)))
        findings = tuple(_findings(store, progress))
        if stale is not None and not findings:
            findings = tuple(Finding(files.STORE, line) for line in stale(store))
        return findings
    except MemoryFormatError as error:
        return (Finding(files.STORE, files.one_line(error)),)
    finally:
        lock.release(undo=True)


def _verify_perceptual(memory: Path, progress: Progress | None) -> tuple[Finding, ...]:
    try:
        return verify_views(memory, progress)
    except DamagedMemoryError as error:
        return (Finding(files.PERCEPTUAL, files.one_line(error)),)


def _findings(store: ox.Store, progress: Progress | None) -> Iterator[Finding]:
    try:
        quads = list(store)
        graphs = set(store.named_graphs())
    except (OSError, RuntimeError) as error:
        yield Finding(files.STORE, f"what is known cannot be read to its end: {files.one_line(error)}")
        return
    if lost := {quad.graph_name for quad in quads} - graphs - {ox.DefaultGraph()}:
        yield Finding(files.STORE, f"graphs that hold something are not listed: {', '.join(sorted(map(str, lost)))}")
    for done, (name, places) in enumerate(_INDEXES.items(), start=1):
        try:
            found = _read_through(store, quads, places)
        except (OSError, RuntimeError) as error:
            yield Finding(files.STORE, f"the index by {name} cannot be read to its end: {files.one_line(error)}")
        else:
            if found != len(quads):
                yield Finding(files.STORE, f"{len(quads)} quads are kept, and the index by {name} has {found}")
        if progress is not None:
            progress(done, len(_INDEXES))


def _read_through(store: ox.Store, quads: list[ox.Quad], places: tuple[int, ...]) -> int:
    """Look up everything that there is at those places, and count what comes of it.

    What comes beside it is not counted: Oxigraph 0.5 reads on behind a term of which all bytes are ones, such as -1.
    """
    found = 0
    for wanted in {tuple(quad[place] for place in places) for quad in quads}:
        pattern = [None] * 4
        for place, term in zip(places, wanted, strict=True):
            pattern[place] = term
        came = store.quads_for_pattern(*pattern)
        found += sum(1 for quad in came if tuple(quad[place] for place in places) == wanted)
    return found
