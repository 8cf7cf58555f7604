"""Queue of changes that a module of the live robot has decided on: each is written to the blackboard once, in order."""

from __future__ import annotations

from deixis.errors import DeixisError
from deixis.memory.episodes.fluents.changes import Change
from deixis.memory.errors import MemoryWriteError
from deixis.printable import printed_line
from deixis.robot.modules import Board


class Outbox:
    """Queue of changes to be written.

    A full disk leaves them waiting, so that nothing is lost, and nothing is written twice when there is room again.

    Examples
    --------
    >>> from deixis.memory.episodes.blackboard import Blackboard
    >>> from deixis.memory.episodes.fluents.changes import Add, Finish
    >>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
    >>> from deixis.robot.modules import Module, ModuleBoard
    >>> from deixis.reasoning.temporal.fluent import Pattern
    >>> class Greeter(Module):
    ...     name, writes = "greeter", (Pattern(predicate="greeted"),)
    >>> with Blackboard.transient() as board:
    ...     outbox, seen = Outbox(), Source(Origin.SEEN, "greeter")
    ...     outbox.add(Add(episodic("g1", ("ada", "greeted"), start=1.0, source=seen)), Finish("g7", 2.0))
    ...     refused = outbox.flush(ModuleBoard(board, Greeter()))
    ...     [each.id for each in board.now()], refused
    (['g1'], ("no fluent 'g7' is on the blackboard",))
    """

    def __init__(self) -> None:
        self._waiting: list[Change] = []
        self._series: str | None = None
        self._number = 0

    def new_id(self, board: Board) -> str:
        """Return an id for a fluent that this memory has never given before; only the first call writes to the disk.

        Parameters
        ----------
        board
            The board of the module.

        Returns
        -------
        str
            The id.

        Raises
        ------
        MemoryWriteError
            If the first call finds a full disk.
        """
        if self._series is None:
            self._series = board.new_id("s")
        self._number += 1
        return f"{self._series}.{self._number}"

    def __len__(self) -> int:
        return len(self._waiting)

    def cut(self, length: int) -> None:
        """Drop the last queued changes, because the step that led to them will be repeated.

        Parameters
        ----------
        length
            Number of changes that go on waiting.
        """
        del self._waiting[length:]

    def add(self, *changes: Change) -> None:
        """Queue changes.

        Parameters
        ----------
        changes
            The changes, which are written after those that wait already.
        """
        self._waiting.extend(changes)

    def flush(self, board: Board) -> tuple[str, ...]:
        """Write all queued changes: together, or one by one if the blackboard refuses a part.

        Parameters
        ----------
        board
            The board of the module.

        Returns
        -------
        tuple of str
            Why changes were refused, in a line each; these are dropped.

        Raises
        ------
        MemoryWriteError
            If the disk is full; what is not yet written keeps waiting.
        """
        if not self._waiting:
            return ()
        try:
            board.write(*self._waiting)
            self._waiting.clear()
        except MemoryWriteError:
            raise
        except DeixisError:
            return tuple(self._one_by_one(board))
        return ()

    def _one_by_one(self, board: Board) -> list[str]:
        refused = []
        while self._waiting:
            try:
                board.write(self._waiting[0])
            except MemoryWriteError:
                raise
            except DeixisError as error:
                refused.append(printed_line(str(error)))
            del self._waiting[0]
        return refused
