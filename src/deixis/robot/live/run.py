"""Run the live robot on one memory, and tell what it sees, hears, says and learns as lines or as a table."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.changes import Add, Logged
from deixis.memory.episodes.episode import Origin, Source, episodic
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.diary import FAULT, LAYOUT
from deixis.robot.live.learner import DONE, SAYS
from deixis.robot.live.senses import AT, NOTICED, SAID
from deixis.robot.modules import ModuleSpec
from deixis.robot.runtime import Runtime
from deixis.scratch import scratch_folder
from deixis.workflows.knowledge.recall import IS_A

Report = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class LiveSettings:
    """Settings: what the robot looks at, and how its modules run; see :class:`deixis.robot.live.senses.Senses`."""

    source: str
    layout: str | None = None
    seed: int = 0
    rate: float = 4.0
    intrinsics: str | None = None
    grows: bool = False
    processes: bool = False


@dataclass(frozen=True, slots=True)
class SeenThing:
    """A thing on the table: its id, its category and the probability of it, and the time since when it is there."""

    id: str
    name: str | None
    probability: float
    since: float


class LiveRobot:
    """A running robot.

    Parameters
    ----------
    board
        Its blackboard.
    started
        Time on the blackboard's clock at which it started.
    """

    def __init__(self, board: Blackboard) -> None:
        self.board, self.started = board, board.seconds()

    def things(self) -> tuple[SeenThing, ...]:
        """Return the things on the table, in the order in which they came.

        Returns
        -------
        tuple of SeenThing
            The things.
        """
        names = {each.statement.subject: each for each in self._now(IS_A)}
        return tuple(
            SeenThing(
                each.statement.subject,
                None if (name := names.get(each.statement.subject)) is None else name.statement.object,
                0.0 if name is None else name.certainty,
                each.start.lower - self.started,
            )
            for each in self._now(AT)
        )

    def layout(self) -> str | None:
        """Return the layout of the table.

        Returns
        -------
        str or None
            Its name; None if it is not known.
        """
        found = (each.statement for each in self._now(LAYOUT))
        return next((said.object for said in found if said.subject == "table"), None)

    def faults(self) -> tuple[str, ...]:
        """Return what is wrong with the table.

        Returns
        -------
        tuple of str
            A sentence for each mistake.
        """
        return tuple(str(each.statement.object) for each in self._now(FAULT))

    def says(self, text: str, speaker: str = "user") -> None:
        """Tell the robot something, or ask it.

        Parameters
        ----------
        text
            The words.
        speaker
            Name of the person.
        """
        at = self.board.seconds()
        said = episodic(
            self.board.new_id("f"),
            (speaker, SAID, text),
            start=at,
            finish=at + 1e-3,
            source=Source(Origin.SAID, speaker),
        )
        self.board.write(Add(said), by=speaker)

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until the robot has dealt with the whole story.

        Parameters
        ----------
        seconds
            Longest time to wait; None for no limit.

        Returns
        -------
        bool
            True if it has.
        """
        until = None if seconds is None else time.monotonic() + seconds
        while not self._now(DONE):
            if until is not None and time.monotonic() > until:
                return False
            time.sleep(0.1)
        return True

    def _now(self, predicate: str):  # type: ignore[no-untyped-def]
        found = self.board.now(Pattern(predicate=predicate))
        return [each for each in found if each.start.lower >= self.started - 1.0]


@contextmanager
def live_robot(memory: str | Path, settings: LiveSettings, report: Report) -> Iterator[LiveRobot]:
    """Run the robot until the ``with`` block ends.

    Parameters
    ----------
    memory
        Folder of the memory.
    settings
        What it looks at.
    report
        Called with a line for everything that is said and noticed, from any thread.

    Yields
    ------
    LiveRobot
        The robot.
    """
    with scratch_folder() as folder, Blackboard.open(memory, create=True) as board:
        robot = LiveRobot(board)

        def told(change: Logged) -> None:
            if change.after is not None and change.before is None:
                said = change.after.statement
                clock = f"{change.after.start.lower - robot.started:6.1f} s"
                if said.predicate == SAID:
                    report(f"{clock}  {said.subject}: {said.object}")
                elif said.predicate == SAYS:
                    report(f"{clock}  robot: {said.object}")
                elif said.predicate == NOTICED:
                    report(f"{clock}  note: {said.object}")

        senses = {
            "source": settings.source,
            "folder": str(folder),
            "layout": settings.layout,
            "seed": settings.seed,
            "rate": settings.rate,
            "intrinsics": settings.intrinsics,
            "grows": settings.grows,
        }
        modules = [
            ModuleSpec("deixis.robot.live.learner:Learner", {"memory": str(memory)}),
            ModuleSpec("deixis.robot.live.senses:Senses", senses),
        ]
        subscription = board.subscribe("view", Pattern(), told, since=board.sequence)

        def trouble(line: str) -> None:
            if " is slow," not in line:  # learning from a table takes seconds, and nothing is lost
                report(line)

        with Runtime(board, modules, settings.processes, trouble):
            try:
                yield robot
            finally:
                board.unsubscribe(subscription.name)
