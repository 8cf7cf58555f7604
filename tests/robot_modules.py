"""Modules for tests of the runtime."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from typing import ClassVar

from deixis.memory.episodes.fluents.changes import Add, Logged
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.journal import write_together
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.modules import Board, Module


class Echo(Module):
    """Writes that it heard each thing that was said, in order."""

    name = "echo"
    reads: ClassVar = (Pattern(predicate="said"), Pattern(predicate="kill"))
    writes: ClassVar = (Pattern(predicate="heard"),)

    def __init__(self, fail_at: int = -1) -> None:
        self._fail_at = fail_at

    def changed(self, change: Logged, board: Board) -> None:
        """Write what was heard; fail once where the settings say so."""
        assert change.after is not None
        words = change.after.statement.object
        if change.after.statement.predicate == "kill":
            if not board.now(Pattern(predicate="heard", object="killed")):
                self._write(board, "killed")
                os.kill(os.getpid(), signal.SIGKILL)
            return
        if words == f"word {self._fail_at}":
            self._fail_at = -1
            raise RuntimeError("no battery")
        self._write(board, str(words))

    def _write(self, board: Board, words: str) -> None:
        source = Source(Origin.INFERRED, self.name)
        fluent = episodic(board.new_id("h"), (self.name, "heard", words), start=board.seconds(), source=source)
        write_together(lambda _: None, [board.part(Add(fluent))])


class Stuck(Module):
    """Hangs in its first call."""

    name = "stuck"
    reads: ClassVar = (Pattern(predicate="said"),)

    def changed(self, change: Logged, board: Board) -> None:
        """Wait for what never comes."""
        threading.Event().wait()


class Dying(Module):
    """Ends its own process as soon as it runs."""

    name = "dying"

    def run(self, board: Board, stopped: threading.Event) -> None:
        """End the process."""
        os._exit(3)


class Trespasser(Module):
    """Tries to write and read what it does not declare, and writes the messages of the errors."""

    name = "trespasser"
    writes: ClassVar = (Pattern(predicate="refused"),)

    def run(self, board: Board, stopped: threading.Event) -> None:
        """Try each once."""
        source = Source(Origin.INFERRED, self.name)
        hello = Add(episodic("x1", ("cup", "said", "hello"), start=0.0, source=source))
        tries: tuple[Callable[[], object], ...] = (
            lambda: board.write(hello),
            lambda: board.now(Pattern(predicate="said")),
        )
        for number, attempt in enumerate(tries):
            try:
                attempt()
            except PermissionError as error:
                board.write(Add(episodic(f"r{number}", (self.name, "refused", str(error)), start=0.0, source=source)))
        assert not [each for each in board.holding() if each.statement.predicate != "refused"]
        stopped.wait()
