"""Modules of the robot, which access only the blackboard, and there only the statements that they declare.

A module declares which statements it reads and which it writes, as patterns. Its board shows it the former, and refuses
other writes. The same module runs in a thread or in a process of its own; see :mod:`deixis.robot.runtime`.

>>> from deixis.memory.episodes.blackboard import Blackboard
>>> from deixis.memory.episodes.fluents.changes import Add
>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> class Greeter(Module):
...     name, reads, writes = "greeter", (Pattern(predicate="entered"),), (Pattern(predicate="greeted"),)
>>> with Blackboard.transient() as whole:
...     board = ModuleBoard(whole, Greeter())
...     source = Source(Origin.SEEN, "door")
...     board.write(Add(episodic("f1", ("anna", "entered"), start=0.0, source=source)))
Traceback (most recent call last):
    ...
deixis.robot.modules.AccessError: the module 'greeter' must not write entered(anna); it declares greeted
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from datetime import datetime
from importlib import import_module
from typing import Any, ClassVar, NamedTuple, Protocol, TypeVar

from deixis.errors import DeixisError
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Change, Logged, Update
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.folder import one_line
from deixis.memory.journal import Part
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern, Statement

RESTART_PAUSE = 0.2
"""Pause in seconds before a module whose run method raised is run again; it doubles each time, up to 10 s."""


Made = TypeVar("Made")
"""Class of an object that is made from the name of its class."""


class AccessError(DeixisError, PermissionError):
    """A statement that a module reads or writes without declaring it."""


class ModuleError(DeixisError, ValueError):
    """A module that cannot be run: of an unknown class, with wrong settings, or with the name of another."""


class Board(Protocol):
    """The methods of the blackboard that a module may call, limited to what it declares."""

    def write(self, *changes: Change) -> int:
        """Write changes as one: all of them or, if one is refused, nothing.

        Parameters
        ----------
        changes
            Changes of statements that the module declares to write.

        Returns
        -------
        int
            Sequence number of the last change.

        Raises
        ------
        AccessError
            If a statement is not declared.
        """
        ...

    def part(self, *changes: Change) -> Part:
        """Return changes as a part of a write over several stores (:func:`deixis.memory.journal.write_together`).

        Parameters
        ----------
        changes
            Changes of statements that the module declares to write.

        Returns
        -------
        Part
            The part.

        Raises
        ------
        AccessError
            If a statement is not declared.
        """
        ...

    def holding(
        self, pattern: Pattern = ANYTHING, start: float | None = None, end: float | None = None
    ) -> tuple[EpisodicFluent, ...]:
        """Return what may have held in a window of time, as far as the module declares to read it.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.
        start, end
            Ends of the window in seconds; by default it has no end on that side.

        Returns
        -------
        tuple of EpisodicFluent
            The fluents in the order of their earliest starts.

        Raises
        ------
        AccessError
            If the pattern matches nothing that the module declares.
        """
        ...

    def now(self, pattern: Pattern = ANYTHING) -> tuple[EpisodicFluent, ...]:
        """Return the fluents that have not finished, as far as the module declares to read them.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.

        Returns
        -------
        tuple of EpisodicFluent
            The fluents in the order of their earliest starts.

        Raises
        ------
        AccessError
            If the pattern matches nothing that the module declares.
        """
        ...

    @property
    def origin(self) -> datetime:
        """Time from which the memory counts seconds."""
        ...

    def new_id(self, prefix: str) -> str:
        """Return an id that this memory has never given before.

        Parameters
        ----------
        prefix
            Beginning of the id.

        Returns
        -------
        str
            The id.
        """
        ...

    def seconds(self) -> float:
        """Return the present time, which never goes back.

        Returns
        -------
        float
            Seconds since the origin of the memory.
        """
        ...


class Module:
    """Base class of modules.

    ``reads`` and ``writes`` are the patterns of the statements that it may read and write; it may read what it may
    write, too.
    """

    name: ClassVar[str]
    reads: ClassVar[tuple[Pattern, ...]] = ()
    writes: ClassVar[tuple[Pattern, ...]] = ()

    def changed(self, change: Logged, board: Board) -> None:
        """React to a change of a fluent that the module reads; called with each, in order.

        Parameters
        ----------
        change
            The change. If this method raises, it is called again with the same change later.
        board
            The module's board.
        """

    def run(self, board: Board, stopped: threading.Event) -> None:
        """Work until the module is stopped, such as reading a camera; by default, only wait.

        Parameters
        ----------
        board
            The module's board.
        stopped
            Set when the module must end.
        """
        stopped.wait()


class Runner(Protocol):
    """One running module."""

    def position(self) -> int:
        """Return the position in the log.

        Returns
        -------
        int
            Sequence number up to which the module has handled it.
        """
        ...

    def wait(self, sequence: int, timeout: float) -> bool:
        """Wait until the module has handled the log up to a sequence number.

        Parameters
        ----------
        sequence
            The sequence number.
        timeout
            Longest time to wait in seconds.

        Returns
        -------
        bool
            True if it has.
        """
        ...

    def failure(self) -> str | None:
        """Return why the module has been given up.

        Returns
        -------
        str or None
            The reason in one line; None if the module runs.
        """
        return None

    def stop(self) -> None:
        """End both threads; one that hangs is left behind."""
        ...


class ModuleSpec(NamedTuple):
    """A module by the name of its class, ``package.module:Class``, and its settings, which JSON can hold."""

    factory: str
    settings: dict[str, Any] = {}  # noqa: RUF012  # a named tuple, whose default is never changed

    def module(self) -> Module:
        """Return a new module.

        Returns
        -------
        Module
            The module.

        Raises
        ------
        ModuleError
            If there is no such class, it is not a module, or it refuses the settings.
        """
        return made(self.factory, Module, **self.settings)


def made(factory: str, base: type[Made], **settings: Any) -> Made:
    """Return a new object of a class that is given by its name, such as a module or a camera driver.

    Parameters
    ----------
    factory
        Name of the class, ``package.module:Class``.
    base
        Class or protocol that it must have.
    settings
        Arguments of the class.

    Returns
    -------
    object
        The object.

    Raises
    ------
    ModuleError
        If there is no such class, it has another base, or it refuses the settings.
    """
    place, _, name = factory.partition(":")
    try:
        found = getattr(import_module(place), name)(**settings)
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        raise ModuleError(f"the module '{factory}' cannot be loaded: {error}") from error
    if not isinstance(found, base):
        raise ModuleError(f"'{factory}' must be a {base.__name__}, got {type(found).__name__}")
    return found


class ModuleBoard(Board):
    """The blackboard as one module may use it."""

    def __init__(self, board: Blackboard, module: Module, clock: Clock | None = None) -> None:
        self._board, self._name = board, module.name
        self._reads, self._writes = (*module.reads, *module.writes), module.writes
        self._clock = clock or Clock(board.origin)

    def write(self, *changes: Change) -> int:
        """Write changes as one: all of them or, if one is refused, nothing."""
        self._check_writable(changes)
        return self._board.write(*changes, by=self._name)

    def part(self, *changes: Change) -> Part:
        """Return changes as a part of a write over several stores."""
        self._check_writable(changes)
        return self._board.part(*changes, by=self._name)

    def _check_writable(self, changes: Sequence[Change]) -> None:
        for change in changes:
            known = None if isinstance(change, Add) else self._board.fluent(change.id)
            statements = [None if known is None else known.statement]
            statements += [change.fluent.statement] if isinstance(change, Add) else []
            statements += [change.statement] if isinstance(change, Update) else []
            for statement in statements:
                if statement is not None and not _declared(self._writes, statement):
                    raise AccessError(
                        f"the module '{self._name}' must not write {statement}; it declares {_texts(self._writes)}"
                    )

    def holding(
        self, pattern: Pattern = ANYTHING, start: float | None = None, end: float | None = None
    ) -> tuple[EpisodicFluent, ...]:
        """Return what may have held in a window of time, as far as the module declares to read it."""
        self._check_readable(pattern)
        return tuple(filter(self._readable, self._board.holding(pattern, start, end)))

    def now(self, pattern: Pattern = ANYTHING) -> tuple[EpisodicFluent, ...]:
        """Return the fluents that have not finished, as far as the module declares to read them."""
        self._check_readable(pattern)
        return tuple(filter(self._readable, self._board.now(pattern)))

    @property
    def origin(self) -> datetime:
        """Time from which the memory counts seconds."""
        return self._board.origin

    def new_id(self, prefix: str) -> str:
        """Return an id that this memory has never given before."""
        return self._board.new_id(prefix)

    def seconds(self) -> float:
        """Return the present time, which never goes back."""
        return self._clock.seconds()

    def concerns(self, change: Logged) -> bool:
        """Return whether the module declares to read a changed fluent; its own writes do not concern it.

        Parameters
        ----------
        change
            The change.

        Returns
        -------
        bool
            True if the module gets the change.
        """
        return change.by != self._name and any(change.concerns(pattern) for pattern in self._reads)

    def _readable(self, fluent: EpisodicFluent) -> bool:
        return _declared(self._reads, fluent.statement)

    def _check_readable(self, pattern: Pattern) -> None:
        if not any(_meet(pattern, declared) for declared in self._reads):
            raise AccessError(
                f"the module '{self._name}' must not read {_text(pattern)}; it declares {_texts(self._reads)}"
            )


class Clock:
    """A clock in seconds since an origin that never goes back, and reports when the system's clock does."""

    def __init__(
        self,
        origin: datetime,
        report: Callable[[str], None] | None = None,
        present: Callable[[], datetime] | None = None,
    ) -> None:
        self._origin, self._report = origin, report
        self._present = present or (lambda: datetime.now(origin.tzinfo))
        self._last = float("-inf")
        self._behind = False
        self._lock = threading.Lock()

    def seconds(self) -> float:
        """Return the present time, or the last one that was returned if the system's clock is behind it.

        Returns
        -------
        float
            Seconds since the origin.
        """
        with self._lock:
            now = (self._present() - self._origin).total_seconds()
            if now < self._last:
                if not self._behind and self._report is not None:
                    self._report(f"the clock went back by {self._last - now:.3g} s; times stay at {self._last:.6f} s")
                self._behind = True
                return self._last
            self._behind, self._last = False, now
            return now


def distinct(modules: Sequence[Module]) -> None:
    """Raise ModuleError if two modules have one name.

    Parameters
    ----------
    modules
        The modules.
    """
    names = [module.name for module in modules]
    for name in names:
        if names.count(name) > 1:
            raise ModuleError(f"two modules have the name '{name}'; give each its own")


def run_until_stopped(module: Module, board: Board, stopped: threading.Event, report: Callable[[str], None]) -> None:
    """Call the run method of a module until it returns or the module is stopped; after an error, call it again.

    Parameters
    ----------
    module
        The module.
    board
        Its board.
    stopped
        Set when the module must end.
    report
        Called with one line for each error.
    """
    pause, last_line = RESTART_PAUSE, ""
    while not stopped.is_set():
        try:
            return module.run(board, stopped)
        except BaseException as error:  # whatever a module raises, SystemExit too, the robot goes on
            line = f"the module '{module.name}' failed and is run again: {type(error).__name__}: {one_line(error)}"
            if line != last_line:
                report(line)
            last_line = line
            stopped.wait(pause)
            pause = min(2 * pause, 10.0)


def _declared(patterns: Sequence[Pattern], statement: Statement) -> bool:
    return any(pattern.matches(statement) for pattern in patterns)


def _meet(first: Pattern, second: Pattern) -> bool:
    pairs = ((first.subject, second.subject), (first.predicate, second.predicate), (first.object, second.object))
    return all(one is None or other is None or one == other for one, other in pairs)


def _texts(patterns: Sequence[Pattern]) -> str:
    return ", ".join(map(_text, patterns)) or "nothing"


def _text(pattern: Pattern) -> str:
    if pattern.subject is None and pattern.object is None:
        return pattern.predicate or "everything"
    return f"{pattern.predicate or '*'}({pattern.subject or '*'}, {pattern.object or '*'})"
