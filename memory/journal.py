"""Writes over several stores: all of them have the write, or none, also after a kill.

The commit of the semantic store decides such a write. Before it, each other store that takes part writes what it will
write to its journal, which is synced. The transaction stores the id of the write in the semantic store, for each of
these stores. After it, they carry out what their journals hold, and remove them (:func:`write_together`). So a store
whose opening finds a journal carries it out if the semantic store has its id, and drops it if not.

An import of views that takes several batches has a journal too, which lists the new views. It is rolled back unless the
last batch, which has the id, was written.

A journal is in the folder of its store, the perceptual one or the episodes, and only the owner of that store reads,
writes or removes it.

>>> import tempfile
>>> folder = Path(tempfile.mkdtemp())
>>> write_journal(folder, JournalEntry("1f", pairs=((b"key", b"value"), (b"old", None)), views=1))
>>> read_journal(folder)
JournalEntry(id='1f', pairs=((b'key', b'value'), (b'old', None)), views=1, undo=())
>>> clear_journal(folder)
>>> read_journal(folder) is None
True
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import secrets
import struct
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Protocol

import pyoxigraph as ox

from deixis.memory import folder as files
from deixis.memory import owner as disk
from deixis.memory.errors import MemoryFormatError

JOURNAL = "journal"
NEW_JOURNAL = JOURNAL + ".new"

MARKS = ox.NamedNode("https://w3id.org/deixis/graph/journal")
"""Graph of the semantic store with the last writes over several stores; queries and exports leave it out."""

_COMMITTED = {
    files.PERCEPTUAL: ox.NamedNode("https://w3id.org/deixis/graph/journal/committed"),
    files.EPISODES: ox.NamedNode("https://w3id.org/deixis/graph/journal/committed/episodes"),
}
"""Predicates of the id of the last committed write that a store took part in, by the folder of the store."""

READ_ATTEMPTS, READ_PAUSE = 10, 0.1
"""Number of attempts to read a store that is open in this process, and seconds between them: while it is compacted, a
reader may miss a file that was just removed."""

_MAGIC = b"deixis journal 1\n"
_LENGTHS = struct.Struct("<Iq")  # of a key, and of a value or -1 for a key to delete
_SUM = hashlib.sha256().digest_size


@dataclass(frozen=True)
class JournalEntry:
    """One write in progress.

    ``pairs`` are keys of the perceptual store with their new values, None to delete; for the episodes, they are names
    of writers with encoded changes, in order. ``views`` is the change in the number of views. ``undo`` are the ids of
    the views to forget if the write was interrupted.
    """

    id: str
    pairs: tuple[tuple[bytes, bytes | None], ...] = ()
    views: int = 0
    undo: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class JointWrite:
    """A write over several stores: its id, and the folders of the stores that take part beside the semantic one."""

    id: str
    stores: tuple[str, ...]


Commit = Callable[[JointWrite | None], None]
"""A function that commits a prepared change of the semantic store; its argument is the write that this decides."""


class Part(Protocol):
    """The part that one store beside the semantic one takes in a write."""

    store: str

    def prepare(self, id: str) -> None:
        """Check that the store can write its part, and write its journal.

        Parameters
        ----------
        id
            Id of the write.
        """
        ...

    def complete(self) -> None:
        """Write the part, which the semantic store has committed, and remove the journal."""
        ...

    def settle(self) -> None:
        """Complete the part if the semantic store has committed the write, and else drop it with its journal."""
        ...


def write_together(commit: Commit, parts: Sequence[Part]) -> None:
    """Write to several stores: all of them have the write, or none, also after a kill.

    Parameters
    ----------
    commit
        Function that commits the change of the semantic store, which decides.
    parts
        Parts of the other stores. Without any, only the semantic store is written.

    Raises
    ------
    DeixisError
        If a store refuses the write; none has it then. If a store cannot write what was committed, it does so when it
        is next opened and can be written.
    """
    if not parts:
        commit(None)
        return
    write = JointWrite(secrets.token_hex(8), tuple(part.store for part in parts))
    prepared: list[Part] = []
    try:
        for part in parts:
            part.prepare(write.id)
            prepared.append(part)
        commit(write)
    except BaseException:
        _call_each(prepared, "settle")
        raise
    _call_each(prepared, "complete")


def _call_each(parts: Sequence[Part], method: Literal["settle", "complete"]) -> None:
    """Call a method of each part, also where it raises for some; then raise the first error."""
    with contextlib.ExitStack() as calls:
        for part in reversed(parts):
            calls.callback(getattr(part, method))


def new_id() -> str:
    """Return a new unique id for the journal of an import.

    Returns
    -------
    str
        The id.
    """
    return secrets.token_hex(8)


def marked(write: JointWrite) -> dict[ox.NamedNode, ox.Literal]:
    """Return what the semantic store keeps of a write over several stores.

    Parameters
    ----------
    write
        The write.

    Returns
    -------
    dict
        The id by the predicate of each store that takes part.
    """
    return {_COMMITTED[store]: ox.Literal(write.id) for store in write.stores}


def write_journal(folder: Path, entry: JournalEntry) -> None:
    """Write the journal in one step, and sync it to the disk.

    Parameters
    ----------
    folder
        The folder of the memory.
    entry
        The write in progress.
    """
    digest = hashlib.sha256()
    with (folder / NEW_JOURNAL).open("wb") as out:
        for part in _parts(entry):
            digest.update(part)
            out.write(part)
        out.write(digest.digest())
        out.flush()
        os.fsync(out.fileno())
    disk.rename(folder / NEW_JOURNAL, folder / JOURNAL)


def _parts(entry: JournalEntry) -> Iterator[bytes]:
    head = {"id": entry.id, "views": entry.views, "pairs": len(entry.pairs), "undo": entry.undo}
    yield _MAGIC
    yield json.dumps(head).encode() + b"\n"
    for key, value in entry.pairs:
        yield _LENGTHS.pack(len(key), -1 if value is None else len(value))
        yield key
        yield value or b""


def read_journal(folder: Path) -> JournalEntry | None:
    """Return the write in progress.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    JournalEntry or None
        The entry, or None; an incomplete journal counts as none, as its write had changed nothing.
    """
    try:
        data = (folder / JOURNAL).read_bytes()
    except FileNotFoundError:
        return None
    body = data[:-_SUM]
    if not body.startswith(_MAGIC) or hashlib.sha256(body).digest() != data[-_SUM:]:
        return None
    end = body.index(b"\n", len(_MAGIC)) + 1
    head = json.loads(body[len(_MAGIC) : end])
    pairs: list[tuple[bytes, bytes | None]] = []
    for _ in range(head["pairs"]):
        key_length, value_length = _LENGTHS.unpack_from(body, end)
        end += _LENGTHS.size
        key, end = body[end : end + key_length], end + key_length
        value = None if value_length < 0 else body[end : end + value_length]
        end += max(0, value_length)
        pairs.append((key, value))
    return JournalEntry(head["id"], tuple(pairs), head["views"], tuple(head["undo"]))


def clear_journal(folder: Path) -> None:
    """Remove the journal, if there is one.

    Parameters
    ----------
    folder
        The folder of the memory.
    """
    for file in (folder / JOURNAL, folder / NEW_JOURNAL):
        try:
            file.unlink(missing_ok=True)
        except OSError:  # a file system that is read-only refuses it also where there is no such file
            if file.exists():
                raise


def has_committed(memory: Path, store: str, id: str) -> bool:
    """Return whether the semantic store has committed a write, by reading it only.

    Parameters
    ----------
    memory
        The folder of the memory.
    store
        Folder of the store that takes part in the write.
    id
        Id of the write.

    Returns
    -------
    bool
        True if it has.

    Raises
    ------
    MemoryFormatError
        If the store cannot be read.
    """
    semantic = files.store_in(memory)
    if not semantic.is_dir():
        return False
    for attempt in range(READ_ATTEMPTS):
        try:
            reading = ox.Store.read_only(str(semantic))
            found = list(reading.quads_for_pattern(MARKS, _COMMITTED[store], None, MARKS))
            break
        except (OSError, RuntimeError) as error:
            if attempt + 1 < READ_ATTEMPTS:
                time.sleep(READ_PAUSE)
                continue
            raise MemoryFormatError(
                f"the memory at {memory} has an interrupted write, and its store cannot be read to finish it "
                f"({files.one_line(error)}); close it elsewhere and try again, or restore the folder from a copy"
            ) from error
    return any(getattr(quad.object, "value", None) == id for quad in found)
