"""The blackboard: fluents with a log of all changes, what holds now, what held when, and subscriptions.

>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> seen = Source(Origin.SEEN, "tracker")
>>> with Blackboard.transient() as board:
...     board.add(episodic("f1", ("cup", "on", "table"), start=2.0, source=seen), by="tracker")
...     board.finish("f1", 5.0, by="tracker")
...     [str(found.fluent) for found in board.holding(Pattern("cup"), 3.0, 4.0)], board.now()
1
2
(['f1: on(cup, table) from [2, 2] to [5, 5]'], ())
"""

from __future__ import annotations

import json
import math
import os
import re
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from itertools import islice
from numbers import Real
from pathlib import Path
from typing import Self

from deixis.memory.episodes.fluents.changes import KINDS, Add, Change, Delete, Finish, Logged, Update
from deixis.memory.episodes.fluents.codec import (
    change_of_list,
    change_to_list,
    decode_fluent,
    decode_if_matching,
    decode_logged,
    encode_fluent,
    encode_logged,
)
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Source, check_text
from deixis.memory.episodes.rdf.guard import Guard, shipped_guard
from deixis.memory.episodes.store.disk import STORE, DiskKeys
from deixis.memory.episodes.store.intervals import endings_meeting, interval_keys
from deixis.memory.episodes.store.keys import Keys, TransientKeys
from deixis.memory.episodes.subscription import Callback, SubscriberState, Subscription
from deixis.memory.errors import EpisodeError, MemoryWriteError, UnknownFluentError
from deixis.memory.folder import EPISODES, inspect
from deixis.memory.journal import JournalEntry, Part, clear_journal, has_committed, read_journal, write_journal
from deixis.memory.owner import Closing, ThreadLock
from deixis.memory.perceptual.database.handle import wrap_level_errors
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern, Statement
from deixis.text_files import is_folder

FLUENT, LOG, SUBJECT, PREDICATE, COUNTER, HEAD = b"f", b"l", b"s", b"p", b"n", b"#"
"""First bytes of the keys: fluents by id, log by sequence number, ids by subject and by predicate, counters, head."""

MAX_LOOKED_UP = 500
"""Number of fluents of one subject or predicate above which a window is looked up by its times instead."""

_NUMBERED = re.compile(r"(.*\D)([1-9]\d{0,15})")

_PAGE = 256  # log entries read at once

_shared: dict[Path, Blackboard] = {}
_sharing = threading.Lock()


class Blackboard(Closing):
    """Fluents that one process owns, and its threads share.

    Writes are atomic and have sequence numbers; a reader sees a whole write or none of it. Times are seconds since
    ``origin``.

    Examples
    --------
    >>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
    >>> with Blackboard.transient() as board:
    ...     fluent = episodic("f1", ("cup", "on", "table"), start=2.0, source=Source(Origin.SEEN, "tracker"))
    ...     board.add(fluent, by="tracker")
    ...     str(board.fluent("f1").fluent)
    ...     board.update("f1", certainty=0.7, by="tracker")
    ...     len(board.now())
    ...     board.finish("f1", 5.0, by="tracker")
    ...     [str(each.fluent) for each in board.holding(Pattern("cup"), 3.0, 4.0)]
    ...     [(each.sequence, str(each.kind)) for each in board.changes()]
    1
    'f1: on(cup, table) from [2, 2] to (-∞, ∞)'
    2
    1
    3
    ['f1: on(cup, table) from [2, 2] to [5, 5]']
    [(1, 'add'), (2, 'update'), (3, 'finish')]

    Writes of several changes, changes by pattern, and subscriptions:

    >>> from datetime import UTC, datetime
    >>> from deixis.memory.episodes.fluents.changes import Add
    >>> board = Blackboard.transient(origin=datetime(2026, 5, 1, tzinfo=UTC))
    >>> seen = Source(Origin.SEEN, "tracker")
    >>> facts = (("cup", "on", "table"), ("jug", "on", "table"))
    >>> fluents = [episodic(board.new_id("f"), fact, start=0.0, source=seen) for fact in facts]
    >>> board.write(*map(Add, fluents), by="tracker")
    2
    >>> board.update_where(Pattern("cup"), certainty=0.9, by="tracker")
    3
    >>> board.finish_where(Pattern("cup"), at=4.0, by="tracker")
    4
    >>> board.delete_where(Pattern("jug"), by="tracker")
    5
    >>> [each.id for each in board.now()], board.sequence, list(board.verify())
    ([], 5, [])
    >>> board.moment(60.0), board.seconds(board.origin)
    (datetime.datetime(2026, 5, 1, 0, 1, tzinfo=datetime.timezone.utc), 0.0)
    >>> board.events(), board.event_here("2026-05-01T00:00:00+00:00 sentence 1")
    (set(), 'sentence 1')
    >>> change = Add(episodic("g1", ("mug", "on", "table"), start=5.0, source=seen))
    >>> board.prepare("write 1", [change], by="tracker")
    >>> board.complete("write 1", [change], by="tracker")
    >>> board.settle()
    >>> type(board.part(change, by="tracker")).__name__
    'EpisodesPart'
    >>> log = []
    >>> logged = board.subscribe("logger", Pattern("cup"), log.append)
    >>> attended = board.attend("watcher", lambda change: change.id == "f1", log.append)
    >>> [each.name for each in board.subscribers()], board.troubles
    (['logger', 'watcher'], ())
    >>> board.unsubscribe("logger")
    >>> board.reserve(["f7"])
    >>> board.delete(board.holding(Pattern("cup"))[0].id, by="tracker"), board.new_id("f")
    (7, 'f8')
    >>> board.close()

    A memory has one blackboard, whose writes may be checked by more shapes:

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder, Blackboard.open(folder, create=True) as board:
    ...     shapes = Path(folder) / "shapes.ttl"
    ...     size = shapes.write_text("@prefix sh: <http://www.w3.org/ns/shacl#> . <urn:shape> a sh:NodeShape .")
    ...     board.guard(shapes)
    """

    def __init__(self, keys: Keys, origin: datetime | None = None, report: Callable[[str], None] | None = None) -> None:
        self._keys = keys
        self._lock = ThreadLock()
        self._closed = False
        self._users = 1
        self._report = report
        self._troubles: list[str] = []
        self._subscriptions: dict[str, Subscription] = {}
        self._origin = self._begin(origin or datetime.now(UTC))
        self._sequence = self._last_sequence()
        self._open = self._unfinished()
        self._recent: deque[Logged] = deque(maxlen=_PAGE)  # the end of the log, for subscribers that keep up
        self._guards = [shipped_guard()]
        self._undelivered = False  # True if what the semantic store has committed could not be written here
        self._settle()

    @classmethod
    def transient(cls, origin: datetime | None = None, report: Callable[[str], None] | None = None) -> Self:
        """Return an empty blackboard in memory, which ends with the process.

        Parameters
        ----------
        origin
            Time from which seconds are counted; the present time by default.
        report
            Called with one line for each trouble of a subscriber, from its thread.

        Returns
        -------
        Self
            The blackboard; close it after use, which ends its subscriptions.
        """
        return cls(TransientKeys(), origin, report)

    @classmethod
    def open(
        cls,
        path: str | Path,
        create: bool = False,
        origin: datetime | None = None,
        report: Callable[[str], None] | None = None,
        sync: bool = False,
    ) -> Blackboard:
        """Open the blackboard of a memory, or make one; all who open one folder in this process share it.

        Parameters
        ----------
        path
            Folder of the memory.
        create
            True to make a blackboard where there is none.
        origin
            Time from which a new blackboard counts seconds; the present time by default.
        report
            Called with one line for each trouble of a subscriber, from its thread.
        sync
            True to make each write survive a power cut too, not only the end of the process.

        Returns
        -------
        Blackboard
            The blackboard, which this process owns until its last user closes it.

        Raises
        ------
        MemoryBusyError
            If another process has it open.
        MemoryFormatError
            If there is no blackboard, or the folder is not that of a memory.
        MemoryWriteError
            If the folder cannot be written and has no blackboard. One that cannot be written is opened for reading
            only: a write raises ReadOnlyMemoryError.
        """
        inspect(Path(path))
        real = Path(os.path.realpath(path)) / EPISODES
        with _sharing:
            if real in _shared and not _shared[real]._closed:
                board = _shared[real]
                board._users += 1
                return board
            keys = DiskKeys.open(real, create, sync)
            try:
                board = _shared[real] = cls(keys, origin, report)
            except BaseException:
                keys.close()
                raise
            keys.protect()
            if keys.lost:
                board._trouble(
                    f"{keys.lost} acknowledged writes to the episodes at {real} are missing: its log is damaged"
                )
            return board

    def close(self) -> None:
        """End the subscriptions and release the store, if there is no other user of it in this process."""
        with _sharing, self._lock:
            self._users -= 1
            if self._closed or self._users > 0:
                return
            self._closed = True
            subscriptions, self._subscriptions = list(self._subscriptions.values()), {}
        for subscription in subscriptions:
            subscription.cancel()
        with self._lock:
            self._keys.close()

    @property
    def origin(self) -> datetime:
        """Time from which seconds are counted, in UTC."""
        return self._origin

    def event_here(self, event: str) -> str | None:
        """Return the id of an event that another store names (:func:`deixis.memory.episodes.fluents.episode.event_of`).

        Parameters
        ----------
        event
            Name of the event with the origin of its blackboard.

        Returns
        -------
        str or None
            The id; None for an event of another blackboard.
        """
        origin, _, id = event.partition(" ")
        return id if origin == self._origin.isoformat() else None

    @property
    def sequence(self) -> int:
        """Sequence number of the last change; 0 if nothing was ever written."""
        return self._sequence

    def require_writable(self) -> None:
        """Check that the blackboard is not that of a memory that can only be read.

        Raises
        ------
        ReadOnlyMemoryError
            If it is.

        Examples
        --------
        >>> with Blackboard.transient() as board:
        ...     board.require_writable()
        """
        if isinstance(self._keys, DiskKeys):
            self._keys.require_writable()

    def seconds(self, moment: datetime | None = None) -> float:
        """Return a moment as seconds since the origin.

        Parameters
        ----------
        moment
            A moment with a time zone; the present by default.

        Returns
        -------
        float
            Seconds.
        """
        return ((moment or datetime.now(UTC)) - self._origin).total_seconds()

    def moment(self, seconds: float) -> datetime:
        """Return seconds since the origin as a moment in UTC.

        Parameters
        ----------
        seconds
            Seconds since the origin.

        Returns
        -------
        datetime
            The moment.
        """
        return self._origin + timedelta(seconds=seconds)

    def new_id(self, prefix: str) -> str:
        """Return an id that this memory has never given before: the prefix and a number from 1.

        Parameters
        ----------
        prefix
            Beginning of the id, such as ``t`` for tracked things.

        Returns
        -------
        str
            The id, such as ``t1``.

        Raises
        ------
        EpisodeError
            If the prefix is not printable text.
        """
        key = COUNTER + check_text(prefix, "the prefix of ids").encode()
        with self._lock:
            self._begin_write()
            number = int(self._keys.get(key) or b"0") + 1
            self._keys.write({key: b"%d" % number})
        return f"{prefix}{number}"

    def reserve(self, ids: Iterable[str]) -> None:
        """Ensure that ids from another source are never given by :meth:`new_id`.

        Parameters
        ----------
        ids
            Ids, of which those with a number at the end matter.
        """
        highest: dict[str, int] = {}
        for prefix, number in (found.groups() for found in map(_NUMBERED.fullmatch, ids) if found is not None):
            highest[prefix] = max(highest.get(prefix, 0), int(number))
        with self._lock:
            self._begin_write()
            keys = {COUNTER + prefix.encode(): number for prefix, number in highest.items()}
            more = {key: n for key, n in keys.items() if n > int(self._keys.get(key) or b"0")}
            if more:
                self._keys.write({key: b"%d" % number for key, number in more.items()})

    def guard(self, shapes: str | Path) -> None:
        """Check all later writes by more SHACL shapes, as long as the blackboard is open.

        Parameters
        ----------
        shapes
            Turtle file of the shapes. Their data is the description of each changed fluent and its statement as a
            plain triple.

        Raises
        ------
        ShapesError
            If the file cannot be read.
        """
        guard = Guard(Path(shapes))
        with self._lock:
            self._guards.append(guard)

    def write(self, *changes: Change, by: str) -> int:
        """Write changes as one: all of them or, if one is refused, nothing.

        Parameters
        ----------
        changes
            Additions, ends, updates and deletions, which apply in order.
        by
            Name of the writer: a module or a person.

        Returns
        -------
        int
            Sequence number of the last change. The changes are durable when the method returns.

        Raises
        ------
        EpisodeError
            If a change does not fit the blackboard.
        UnknownFluentError
            If a change concerns a fluent that is not there.
        RejectedWriteError
            If a shape is violated; the error names the shape and the reason.
        """
        check_text(by, "the writer")
        with self._lock:
            self._begin_write()
            if not changes:
                return self._sequence
            made = self._made(changes, by)
            for guard in self._guards:
                guard.check(each.after for each in made if each.after is not None)
            self._keep(made, {})
        self._tell()
        return made[-1].sequence

    def part(self, *changes: Change, by: str) -> Part:
        """Return changes as a part of a write over several stores (:func:`deixis.memory.journal.write_together`).

        Parameters
        ----------
        changes
            Changes, which apply in order.
        by
            Name of the writer.

        Returns
        -------
        Part
            The part. Others may write to the blackboard until it is completed; a change that no longer fits then is
            left out.
        """
        return EpisodesPart(self, changes, check_text(by, "the writer"))

    def prepare(self, id: str, changes: Sequence[Change], by: str) -> None:
        """Check changes, and write them to the journal; for :class:`EpisodesPart`.

        Parameters
        ----------
        id
            Id of the write over several stores.
        changes
            The changes.
        by
            Name of the writer.

        Raises
        ------
        EpisodeError, UnknownFluentError, RejectedWriteError
            If a change is refused, as by :meth:`write`.
        MemoryWriteError
            If the journal cannot be written.
        """
        with self._lock:
            self._begin_write()
            made = self._made(changes, by)
            for guard in self._guards:
                guard.check(each.after for each in made if each.after is not None)
            if isinstance(self._keys, DiskKeys):
                self._settle()  # of a writer that was killed
                pairs = tuple((by.encode(), json.dumps(change_to_list(each)).encode()) for each in changes)
                with wrap_level_errors(self._keys.folder):
                    write_journal(self._keys.folder, JournalEntry(id, pairs))

    def complete(self, id: str, changes: Sequence[Change], by: str) -> None:
        """Write changes that are decided, as far as they still fit, and remove the journal; for :class:`EpisodesPart`.

        If they cannot be written, :attr:`troubles` says so, and they are written with the next write or opening.

        Parameters
        ----------
        id
            Id of the write over several stores.
        changes
            The changes.
        by
            Name of the writer.
        """
        with self._lock:
            try:
                self._deliver(id, changes, by)
            except MemoryWriteError as error:
                self._undelivered = True
                self._trouble(f"{error}; the lessons are stored, and their episodes will be when the disk has room")
        self._tell()

    def settle(self) -> None:
        """Carry out or drop what the journal holds, as the semantic store decided; without a journal, do nothing.

        Raises
        ------
        MemoryFormatError
            If there is a journal, and the semantic store cannot be read.
        """
        with self._lock:
            self._settle()
        self._tell()

    def _settle(self) -> None:
        if not isinstance(self._keys, DiskKeys):
            return
        folder = self._keys.folder
        entry = read_journal(folder)
        if entry is None or not has_committed(folder.parent, EPISODES, entry.id):
            self._clear_journal()
            return
        changes = [change_of_list(json.loads(data or b"")) for _, data in entry.pairs]
        self._deliver(entry.id, changes, entry.pairs[0][0].decode() if entry.pairs else "")

    def _deliver(self, id: str, changes: Sequence[Change], by: str) -> None:
        """Write the changes of a journal that still fit, once, and remove the journal."""
        mark = HEAD + b"journal"
        if self._keys.get(mark) != id.encode():
            self._restore()
            self._keep(self._made(changes, by, fitting=True), {mark: id.encode()})
        self._clear_journal()

    def _clear_journal(self) -> None:
        if isinstance(self._keys, DiskKeys) and not self._keys.is_copy:
            clear_journal(self._keys.folder)
        self._undelivered = False

    def _keep(self, made: Sequence[Logged], more: Mapping[bytes, bytes]) -> None:
        """Write log entries with what they change, and further keys, as one."""
        self._keys.write({**self._pairs(made), **more})
        self._sequence = made[-1].sequence if made else self._sequence
        self._recent.extend(made)
        for each in made:
            if each.after is not None and each.after.is_open:
                self._open[each.id] = each.after
            else:
                self._open.pop(each.id, None)

    def _tell(self) -> None:
        """Wake the subscribers."""
        with self._lock:
            subscriptions = list(self._subscriptions.values())
        for subscription in subscriptions:
            subscription.notify()
            subscription.check()

    def add(self, fluent: EpisodicFluent, by: str) -> int:
        """Add one fluent.

        Parameters
        ----------
        fluent
            The fluent, whose id must be new.
        by
            Name of the writer.

        Returns
        -------
        int
            Sequence number of the change.
        """
        return self.write(Add(fluent), by=by)

    def finish(self, id: str, at: float | Bounds, by: str) -> int:
        """State when a fluent ceased to hold.

        Parameters
        ----------
        id
            Id of the fluent.
        at
            Seconds since the origin, or bounds.
        by
            Name of the writer.

        Returns
        -------
        int
            Sequence number of the change.
        """
        return self.write(Finish(id, at), by=by)

    def update(
        self,
        id: str,
        *,
        by: str,
        statement: Statement | None = None,
        start: float | Bounds | None = None,
        finish: float | Bounds | None = None,
        certainty: float | None = None,
        source: Source | None = None,
    ) -> int:
        """Give a fluent new values.

        Parameters
        ----------
        id
            Id of the fluent.
        by
            Name of the writer.
        statement, start, finish, certainty, source
            New values; None leaves a value as it is.

        Returns
        -------
        int
            Sequence number of the change.
        """
        return self.write(Update(id, statement, start, finish, certainty, source), by=by)

    def delete(self, id: str, by: str) -> int:
        """Remove a fluent, as if it had never been stated; the log keeps it.

        Parameters
        ----------
        id
            Id of the fluent.
        by
            Name of the writer.

        Returns
        -------
        int
            Sequence number of the change.
        """
        return self.write(Delete(id), by=by)

    def finish_where(
        self, pattern: Pattern, at: float | Bounds, by: str, start: float | None = None, end: float | None = None
    ) -> int:
        """State as one write when all fluents that match a pattern ceased to hold.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.
        at
            Seconds since the origin, or bounds.
        by
            Name of the writer.
        start, end
            Only fluents that may hold in this window; by default all that have not finished.

        Returns
        -------
        int
            Sequence number of the last change.
        """
        with self._lock:
            found = self.now(pattern) if start is None and end is None else self.holding(pattern, start, end)
            return self.write(*(Finish(each.id, at) for each in found if each.is_open), by=by)

    def update_where(
        self,
        pattern: Pattern,
        by: str,
        start: float | None = None,
        end: float | None = None,
        *,
        new_start: float | None = None,
        new_finish: float | None = None,
        certainty: float | None = None,
        source: Source | None = None,
    ) -> int:
        """Give all fluents that match a pattern new values, as one write.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.
        by
            Name of the writer.
        start, end
            Only fluents that may hold in this window; by default it has no end on that side.
        new_start, new_finish, certainty, source
            New values; None leaves a value as it is.

        Returns
        -------
        int
            Sequence number of the last change.
        """
        with self._lock:
            found = self.holding(pattern, start, end)
            changes = (Update(each.id, None, new_start, new_finish, certainty, source) for each in found)
            return self.write(*changes, by=by)

    def delete_where(self, pattern: Pattern, by: str, start: float | None = None, end: float | None = None) -> int:
        """Remove all fluents that match a pattern, as one write.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.
        by
            Name of the writer.
        start, end
            Only fluents that may hold in this window; by default it has no end on that side.

        Returns
        -------
        int
            Sequence number of the last change.
        """
        with self._lock:
            return self.write(*(Delete(each.id) for each in self.holding(pattern, start, end)), by=by)

    def fluent(self, id: str) -> EpisodicFluent | None:
        """Return one fluent.

        Parameters
        ----------
        id
            Its id.

        Returns
        -------
        EpisodicFluent or None
            The fluent; None if it is not on the blackboard.
        """
        with self._lock:
            self._check_open()
            return self._fluent(id.encode())

    def holding(
        self,
        pattern: Pattern = ANYTHING,
        start: float | None = None,
        end: float | None = None,
        *,
        certainly: bool = False,
    ) -> tuple[EpisodicFluent, ...]:
        """Return what held in a window of time, found by an index of times.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.
        start, end
            Ends of the window in seconds, which belong to it; by default it has no end on that side.
        certainly
            True for only those that held at some time of the window whatever their true ends are; by default, all that
            may have held.

        Returns
        -------
        tuple of EpisodicFluent
            The fluents in the order of their earliest starts and then ids.

        Raises
        ------
        EpisodeError
            If the window ends before it starts, or an end is not a number.
        """
        _check_pattern(pattern)
        first, last = -math.inf if start is None else start, math.inf if end is None else end
        if not (isinstance(first, Real) and isinstance(last, Real)):
            raise EpisodeError(f"the ends of a window must be numbers of seconds, got {start!r:.40} and {end!r:.40}")
        if not first <= last:
            raise EpisodeError(f"a window must not end before it starts, got {first:g} to {last:g} s")
        with self._lock:
            self._check_open()
            endings = self._endings(pattern, first, last)
            data = [self._keys.get(FLUENT + ending) for ending in endings]
        fluents = (decode_if_matching(each, pattern) for each in data if each is not None)
        return _in_order(
            found
            for found in fluents
            if found is not None and found.may_hold(first, last) and (not certainly or found.must_hold(first, last))
        )

    def now(self, pattern: Pattern = ANYTHING) -> tuple[EpisodicFluent, ...]:
        """Return the current situation: the fluents that have not finished.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.

        Returns
        -------
        tuple of EpisodicFluent
            The fluents in the order of their earliest starts and then ids.
        """
        _check_pattern(pattern)
        with self._lock:
            self._check_open()
            found = list(self._open.values())
        return _in_order(each for each in found if pattern.matches(each.statement))

    def changes(self, since: int = 0, pattern: Pattern = ANYTHING) -> Iterator[Logged]:
        """Iterate over the log.

        Parameters
        ----------
        since
            Sequence number after which to begin.
        pattern
            Only changes of fluents that match it before or after the change.

        Yields
        ------
        Logged
            The changes in the order of their sequence numbers, including those written meanwhile.
        """
        for change in self._read_log(since):
            if change.concerns(pattern):
                yield change

    def subscribe(
        self, name: str, what: Pattern | str | Path, callback: Callback, since: int | None = None
    ) -> Subscription:
        """Call a function with each change of what it asks for, in order, in a thread of its own.

        Parameters
        ----------
        name
            Name of the subscriber, which no other may have.
        what
            A pattern of statements, whose parts None match everything; the id of a fluent; or the path of a Turtle file
            of SHACL shapes, for the fluents that a shape targets and that conform to the shapes. A change counts if the
            fluent is one of these before it or after it.
        callback
            Function that is called with each change. If it raises, it is called again with the same change later.
        since
            Sequence number after which to begin; by default, after the last change so far.

        Returns
        -------
        Subscription
            The subscription; cancel it to end it.

        Raises
        ------
        EpisodeError
            If another subscriber has the name.
        ShapesError
            If the file of shapes cannot be read.
        """
        if isinstance(what, Pattern):
            pattern = what

            def concerns(change: Logged) -> bool:
                return change.concerns(pattern)
        elif isinstance(what, Path):
            guard = Guard(what)

            def concerns(change: Logged) -> bool:
                return any(each is not None and guard.selects(each) for each in (change.before, change.after))
        else:

            def concerns(change: Logged) -> bool:
                return change.id == what

        return self.attend(name, concerns, callback, since)

    def attend(
        self,
        name: str,
        concerns: Callable[[Logged], bool],
        callback: Callback,
        since: int | None = None,
        report: Callable[[str], None] | None = None,
    ) -> Subscription:
        """Subscribe to the changes that a function chooses, such as those of one fluent or of one class of things.

        Parameters
        ----------
        name
            Name of the subscriber, which no other may have.
        concerns
            Function that says whether a change concerns the subscriber.
        callback
            Function that is called with each such change. If it raises, it is called again with the same change later.
        since
            Sequence number after which to begin; by default, after the last change so far.
        report
            Called with one line for each trouble of this subscriber, besides that of the blackboard.

        Returns
        -------
        Subscription
            The subscription; cancel it to end it.

        Raises
        ------
        EpisodeError
            If another subscriber has the name.
        """
        check_text(name, "the name of a subscriber")
        if not callable(callback):
            raise EpisodeError(f"`callback` must be a function of a change, got {callback!r:.60}")

        def trouble(line: str) -> None:
            self._trouble(line)
            if report is not None and report is not self._report:
                report(line)

        with self._lock:
            self._check_open()
            if name in self._subscriptions:
                raise EpisodeError(f"a subscriber named '{name}' is there already; cancel it, or choose another name")
            position = self._sequence if since is None else max(0, since)
            subscription = Subscription(
                name, concerns, callback, position, self._read_log, lambda: self._sequence, trouble
            )
            self._subscriptions[name] = subscription
        subscription.begin()
        subscription.notify()
        return subscription

    def unsubscribe(self, name: str) -> None:
        """End a subscription after its present call.

        Parameters
        ----------
        name
            Name of the subscriber; an unknown name does nothing.
        """
        with self._lock:
            subscription = self._subscriptions.pop(name, None)
        if subscription is not None:
            subscription.cancel()

    def subscribers(self) -> tuple[SubscriberState, ...]:
        """Return the state of each subscriber.

        Returns
        -------
        tuple of SubscriberState
            Position, backlog and trouble, in the order of subscription.
        """
        with self._lock:
            subscriptions = list(self._subscriptions.values())
        for each in subscriptions:
            each.check()
        return tuple(each.state for each in subscriptions)

    @property
    def troubles(self) -> tuple[str, ...]:
        """One line for each time that a subscriber was slow or raised, oldest first."""
        return tuple(self._troubles)

    def _trouble(self, line: str) -> None:
        self._troubles.append(line)
        if self._report is not None:
            self._report(line)

    def events(self) -> set[str]:
        """Return the events of the sources of all fluents that were ever written.

        Returns
        -------
        set of str
            Ids of events; those of deleted fluents are in the log.
        """
        fluents = (each.after or each.before for each in self.changes())
        return {each.source.event for each in fluents if each is not None and each.source.event is not None}

    def verify(self) -> Iterator[str]:
        """Yield a line for each place where log, fluents and index of times disagree; damage raises an error.

        Yields
        ------
        str
            A problem.
        """
        if isinstance(self._keys, DiskKeys) and self._keys.lost:
            yield f"{self._keys.lost} acknowledged writes are missing"
        replayed: dict[str, EpisodicFluent] = {}
        expected = 1
        for change in self.changes():
            if change.sequence != expected:
                yield f"the changes {expected} to {change.sequence - 1} are missing in the log"
            expected = change.sequence + 1
            replayed.pop(change.id, None)
            if change.after is not None:
                replayed[change.id] = change.after
        held = {each.id: each for each in self.holding()}
        for id in sorted(held.keys() | replayed.keys()):
            if held.get(id) != replayed.get(id):
                yield f"the fluent '{id}' differs from the log"
        with self._lock:
            indexed = {ending.decode() for ending in endings_meeting(self._keys, -math.inf, math.inf)}
        for id in sorted(held.keys() ^ indexed):
            yield f"the index of times and the fluents disagree about '{id}'"

    def _begin(self, origin: datetime) -> datetime:
        if origin.tzinfo is None:
            raise EpisodeError(f"the origin of times must have a time zone, got {origin.isoformat()}")
        stored = self._keys.get(HEAD)
        if stored is not None:
            return datetime.fromisoformat(stored.decode())
        self._keys.write({HEAD: origin.astimezone(UTC).isoformat().encode()})
        return origin.astimezone(UTC)

    def _last_sequence(self) -> int:
        return int.from_bytes(self._keys.get(HEAD + b"sequence") or b"", "big")

    def _unfinished(self) -> dict[str, EpisodicFluent]:
        endings = endings_meeting(self._keys, math.inf, math.inf)
        return {found.id: found for found in map(self._fluent, endings) if found is not None and found.is_open}

    def _begin_write(self) -> None:
        """Check that the blackboard can be written, and write what was committed elsewhere and could not be written."""
        self._restore()
        if self._undelivered:
            self._settle()

    def _restore(self) -> None:
        """Check that the blackboard is open, and read its state again if an earlier write failed."""
        self._check_open()
        if self._keys.restored():
            self._sequence, self._open = self._last_sequence(), self._unfinished()
            self._recent.clear()

    def _check_open(self) -> None:
        if self._closed:
            raise EpisodeError("the blackboard is closed")

    def _fluent(self, ending: bytes) -> EpisodicFluent | None:
        data = self._keys.get(FLUENT + ending)
        return None if data is None else decode_fluent(data)

    def _endings(self, pattern: Pattern, first: float, last: float) -> Iterator[bytes]:
        """Return the ids of all fluents that may match, by the index that leaves the fewest.

        A word with few fluents is looked up by itself; otherwise a window with an end is looked up by its times.
        """
        windowed = not (math.isinf(first) and math.isinf(last))
        for kind, word in ((SUBJECT, pattern.subject), (PREDICATE, pattern.predicate)):
            if word is not None:
                prefix = _word_key(kind, word, b"")
                found = list(self._keys.between(prefix, _end(prefix), MAX_LOOKED_UP if windowed else None))
                if not windowed or len(found) < MAX_LOOKED_UP:
                    return (key[len(prefix) :] for key in found)
        if windowed:
            return endings_meeting(self._keys, first, last)
        return (key[1:] for key in self._keys.between(FLUENT, _end(FLUENT)))

    def _read_log(self, since: int) -> Iterator[Logged]:
        since = max(0, since)
        while True:
            with self._lock:
                if self._closed or since >= self._sequence:
                    return
                last = min(since + _PAGE, self._sequence)
                skipped = since + 1 - self._recent[0].sequence if self._recent else -1
                latest = list(islice(self._recent, skipped, skipped + _PAGE)) if skipped >= 0 else []
                page = [] if latest else list(self._keys.items(_log_key(since + 1), _log_key(last + 1)))
            yield from latest
            for key, data in page:
                yield decode_logged(int.from_bytes(key[1:], "big"), data)
            since = last

    def _made(self, changes: Sequence[Change], by: str, fitting: bool = False) -> list[Logged]:
        """Return the log entries of changes, which are not written yet; with ``fitting``, leave out what is refused."""
        staged: dict[str, EpisodicFluent | None] = {}
        made: list[tuple[Change, EpisodicFluent | None, EpisodicFluent | None]] = []
        for change in changes:
            if type(change) not in KINDS or (isinstance(change, Add) and not isinstance(change.fluent, EpisodicFluent)):
                raise EpisodeError(f"a change must be Add (of a fluent), Finish, Update or Delete, got {change!r:.60}")
            before = staged[change.id] if change.id in staged else self._fluent(change.id.encode())
            try:
                staged[change.id] = change.applied(before)
            except (EpisodeError, UnknownFluentError):
                if not fitting:
                    raise
            else:
                made.append((change, before, staged[change.id]))
        last, written = self._sequence + len(made), time.time()
        return [
            Logged(number, last, by, written, KINDS[type(change)], before, after)
            for number, (change, before, after) in enumerate(made, self._sequence + 1)
        ]

    def _pairs(self, made: Sequence[Logged]) -> dict[bytes, bytes | None]:
        """Return the keys and values that record changes in the log, the fluents and the indexes."""
        pairs: dict[bytes, bytes | None] = {}
        for each in made:
            pairs[HEAD + b"sequence"] = each.sequence.to_bytes(8, "big")
            ending = each.id.encode()
            before = None if each.before is None else encode_fluent(each.before)
            after = None if each.after is None else encode_fluent(each.after)
            if each.before is not None:
                pairs.update(dict.fromkeys(_index_keys(each.before, ending)))
            if each.after is not None:
                pairs.update(dict.fromkeys(_index_keys(each.after, ending), b""))
            pairs[FLUENT + ending] = after
            pairs[_log_key(each.sequence)] = encode_logged(each.last, each.by, each.written, each.kind, before, after)
        return pairs


class EpisodesPart(Part):
    """The part that changes of a blackboard take in a write over several stores.

    Parameters
    ----------
    board
        The blackboard.
    changes
        The changes.
    by
        Name of the writer.
    """

    store = EPISODES

    def __init__(self, board: Blackboard, changes: Sequence[Change], by: str) -> None:
        self._board, self._changes, self._by, self._id = board, changes, by, ""

    def prepare(self, id: str) -> None:
        """Check the changes, and write the journal."""
        self._id = id
        self._board.prepare(id, self._changes, self._by)

    def complete(self) -> None:
        """Write the changes, and remove the journal."""
        self._board.complete(self._id, self._changes, self._by)

    def settle(self) -> None:
        """Write the changes if the semantic store has committed, and else only remove the journal."""
        self._board.settle()


def has_episodes(memory: Path) -> bool:
    """Return whether a memory has a blackboard, without opening it.

    Parameters
    ----------
    memory
        Folder of the whole memory.

    Returns
    -------
    bool
        True if it has.
    """
    return is_folder(memory / EPISODES / STORE)


@contextmanager
def open_episodes(memory: Path) -> Iterator[Blackboard | None]:
    """Open the blackboard of a memory, if it has one, and close it at the end of the block.

    Parameters
    ----------
    memory
        Folder of the whole memory.

    Yields
    ------
    Blackboard or None
        The blackboard; None if the memory has none.
    """
    if not has_episodes(memory):
        yield None
        return
    with Blackboard.open(memory) as board:
        yield board


def _index_keys(fluent: EpisodicFluent, ending: bytes) -> tuple[bytes, ...]:
    ends = interval_keys(fluent.start.lower, fluent.finish.upper, ending)
    statement = fluent.statement
    return *ends, _word_key(SUBJECT, statement.subject, ending), _word_key(PREDICATE, statement.predicate, ending)


def _check_pattern(pattern: Pattern) -> None:
    if not isinstance(pattern, Pattern):
        raise EpisodeError(f"`pattern` must be a Pattern of subject, predicate and object, got {pattern!r:.60}")


def _word_key(kind: bytes, word: str, ending: bytes) -> bytes:
    return kind + word.encode() + b"\0" + ending


def _log_key(sequence: int) -> bytes:
    return LOG + sequence.to_bytes(8, "big")


def _end(prefix: bytes) -> bytes:
    """Return the smallest key above all that begin with a prefix, whose last byte is below 255."""
    return prefix[:-1] + bytes([prefix[-1] + 1])


def _in_order(fluents: Iterator[EpisodicFluent]) -> tuple[EpisodicFluent, ...]:
    return tuple(sorted(fluents, key=lambda each: (each.start.lower, each.id)))
