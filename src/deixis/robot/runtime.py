"""Run modules on one blackboard, as threads of this process or as processes of their own.

The process that makes a :class:`Runtime` owns the blackboard. Each module has a position in the log, and gets each
change that it reads once and in order. A module that raises or dies is reported in one line, and continues from its
position. A change during which a process was killed is delivered again.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.subscription import Subscription
from deixis.memory.owner import Closing
from deixis.robot.modules import Clock, Module, ModuleBoard, ModuleSpec, Runner, distinct, run_until_stopped


class Runtime(Closing):
    """Running modules.

    Parameters
    ----------
    board
        The blackboard, which this process owns.
    modules
        The modules, by the names of their classes.
    processes
        True to run each module in a process of its own, False in a thread of this one.
    report
        Called with one line for each trouble, from any thread.

    Raises
    ------
    ModuleError
        If two modules have one name, or one cannot be loaded.
    """

    def __init__(
        self,
        board: Blackboard,
        modules: Sequence[ModuleSpec],
        processes: bool = False,
        report: Callable[[str], None] = lambda line: None,
    ) -> None:
        made = [spec.module() for spec in modules]
        distinct(made)
        self._board = board
        self._runners: dict[str, Runner] = {}
        clock = Clock(board.origin, report)
        self._close_hub: Callable[[], None] = lambda: None
        try:
            if processes:
                from deixis.robot.processes import Hub

                hub = Hub(board, clock, report)
                self._close_hub = hub.close
                for spec, module in zip(modules, made, strict=True):
                    self._runners[module.name] = hub.start(spec, module)
            else:
                for module in made:
                    self._runners[module.name] = ThreadRunner(board, module, clock, report)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """End all modules; the blackboard stays open."""
        runners, self._runners = list(self._runners.values()), {}
        for runner in runners:
            runner.stop()
        self._close_hub()

    def positions(self) -> dict[str, int]:
        """Return up to which change each module has handled the log.

        Returns
        -------
        dict
            Sequence number by the name of the module.
        """
        return {name: runner.position() for name, runner in self._runners.items()}

    def failure(self) -> str | None:
        """Return why a module has been given up.

        Returns
        -------
        str or None
            The reason in one line, of the first such module; None if all modules run.
        """
        return next(filter(None, (runner.failure() for runner in list(self._runners.values()))), None)

    def wait(self, sequence: int | None = None, timeout: float = 10.0) -> bool:
        """Wait until all modules have handled the log up to a sequence number.

        Parameters
        ----------
        sequence
            The sequence number; by default, that of the last change now.
        timeout
            Longest time to wait for each module in seconds.

        Returns
        -------
        bool
            True if all have.
        """
        until = self._board.sequence if sequence is None else sequence
        return all(runner.wait(until, timeout) for runner in list(self._runners.values()))


class ThreadRunner(Runner):
    """A module in two threads of this process: one runs it, the other calls it with changes."""

    def __init__(self, board: Blackboard, module: Module, clock: Clock, report: Callable[[str], None]) -> None:
        self._board, self._stopped = board, threading.Event()
        own = ModuleBoard(board, module, clock)
        self._subscription: Subscription = board.attend(
            module.name, own.concerns, lambda change: module.changed(change, own), report=report
        )
        arguments = (module, own, self._stopped, report)
        self._thread = threading.Thread(target=run_until_stopped, args=arguments, name=module.name, daemon=True)
        self._thread.start()

    def position(self) -> int:
        """Return the position in the log."""
        return self._subscription.position

    def wait(self, sequence: int, timeout: float) -> bool:
        """Wait until the module has handled the log up to a sequence number."""
        return self._subscription.wait(sequence, timeout)

    def stop(self) -> None:
        """End both threads; one that hangs is left behind."""
        self._stopped.set()
        self._board.unsubscribe(self._subscription.name)
        self._thread.join(1.0)
