"""Run the live robot on one memory, and print what it sees, hears, says and learns as lines or as a table."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from deixis.grammar.utterances import MAX_CHARACTERS, Utterance
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import finish_recording, start_recording
from deixis.memory.episodes.fluents.changes import Add, Finish, Logged
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.predicates import AT, FAULT, IS_A, LAYOUT, SAID, SAYS
from deixis.printable import printed_line
from deixis.reasoning.temporal.bounds import MAX_SECONDS, Bounds
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.learner import DONE
from deixis.robot.live.senses import BEGAN, DROPPED, ENDED, MIN_DURATION, NOTICED, TABLE, TYPED
from deixis.robot.live.story import StorySettings
from deixis.robot.modules import ModuleSpec
from deixis.robot.runtime import Runtime
from deixis.scratch import scratch_folder

STATES = (AT, TABLE, TYPED, DROPPED, BEGAN, ENDED, DONE)
"""Predicates of the senses' fluents that hold at present; the robot ends its own conclusions."""

Report = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class SeenThing:
    """A thing on the table: its id, its category with its probability, and the time since which it has been there."""

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
    folder
        Folder of the scenes and images that it sees.
    """

    def __init__(self, board: Blackboard, folder: Path) -> None:
        self.board, self.folder = board, folder
        self.runtime: Runtime | None = None

    @property
    def began(self) -> float:
        """Time at which the story began, in seconds since the origin of the memory; the present before it has."""
        found = self._now(BEGAN)
        return found[-1].start.lower if found else self.board.seconds()

    @property
    def problem(self) -> str | None:
        """Reason why the story ended early; None if it did not."""
        failure = None if self.runtime is None else self.runtime.failure()
        return failure or next((each.statement.object for each in self._now(ENDED)), None)

    @property
    def dropped(self) -> int:
        """Number of frames that came too late to be seen."""
        return next((int(each.statement.object or 0) for each in self._now(DROPPED)), 0)

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
                each.start.lower - self.began,
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
        return next((fact.object for fact in found if fact.subject == "table"), None)

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
        utterance = Utterance(text, 0.0, speaker=speaker)  # checked here, so that the caller gets the error
        by, at = printed_line(speaker), self.board.seconds()
        typed = episodic(
            self.board.new_id("f"),
            (by, TYPED, printed_line(utterance.text, MAX_CHARACTERS)),
            start=at,
            source=Source(Origin.SAID, by),
        )
        self.board.write(Add(typed), by=by)

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until the robot has dealt with the whole story, or one of its modules has been given up.

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
            given_up = self.runtime is not None and self.runtime.failure() is not None
            if given_up or (until is not None and time.monotonic() > until):
                return False
            time.sleep(0.1)
        return True

    def record(self, experience: str) -> None:
        """Start to record the story as an experience.

        Parameters
        ----------
        experience
            Name of the experience, which no other may have.

        Raises
        ------
        EpisodeError
            If there is an experience of this name.
        """
        start_recording(self.board, experience, self.board.seconds(), by="robot")

    def finish_recording(self, experience: str) -> None:
        """Finish the experience where the story ended.

        Parameters
        ----------
        experience
            Name of the experience, which :meth:`record` began.

        Raises
        ------
        EpisodeError
            If there is no such experience, or it has finished.
        """
        ended = max((each.start.upper for each in self._now(ENDED)), default=self.board.seconds())
        finish_recording(self.board, experience, ended + MIN_DURATION, by="robot")

    def answered(self, seconds: float = 60.0) -> bool:
        """Wait until the robot has dealt with all typed words.

        Parameters
        ----------
        seconds
            Longest time to wait.

        Returns
        -------
        bool
            True if it has.
        """
        until = time.monotonic() + seconds
        while self._now(TYPED):
            if time.monotonic() > until:
                return False
            time.sleep(0.05)
        return self.runtime is None or self.runtime.wait(timeout=max(until - time.monotonic(), 0.0))

    def _now(self, predicate: str) -> tuple[EpisodicFluent, ...]:
        return self.board.now(Pattern(predicate=predicate))


@contextmanager
def live_robot(
    memory: str | Path, story: StorySettings, report: Report, processes: bool = False
) -> Iterator[LiveRobot]:
    """Run the robot until the ``with`` block ends.

    Parameters
    ----------
    memory
        Folder of the memory.
    story
        What it looks at.
    report
        Called with a line that names the memory, and then with a line for everything that is said and noticed, from any
        thread.
    processes
        True to run each module in a process of its own.

    Yields
    ------
    LiveRobot
        The robot.
    """
    with scratch_folder() as folder, Blackboard.open(memory, create=True) as board:
        board.require_writable()
        report(f"Memory: {printed_line(str(memory))}")
        _end_earlier(board)
        robot = LiveRobot(board, folder)

        latest = 0.0

        def on_change(change: Logged) -> None:
            nonlocal latest
            if change.after is None or change.before is not None:
                return
            line = _line(change.after)
            if line is not None:  # at the time at which it was understood: the end of the words, or of earlier lines
                fluent = change.after
                at = fluent.finish.lower if fluent.statement.predicate == SAID else fluent.start.lower
                latest = max(latest, at - robot.began)
                report(f"{latest:6.1f} s  {line}")

        def trouble(line: str) -> None:
            if " is slow," not in line:  # learning from a table takes seconds, and nothing is lost
                report(line)

        modules = [
            ModuleSpec("deixis.robot.live.learner:Learner", {"memory": str(memory)}),
            ModuleSpec("deixis.robot.live.senses:Senses", {"story": asdict(story), "folder": str(folder)}),
        ]
        subscription = board.subscribe("view", Pattern(), on_change, since=board.sequence)
        with Runtime(board, modules, processes, trouble) as runtime:
            robot.runtime = runtime
            try:
                yield robot
            finally:
                subscription.wait(board.sequence, 2.0)
                board.unsubscribe(subscription.name)


def _line(fluent: EpisodicFluent) -> str | None:
    """Return what a fluent says as a line of the conversation; None if it is not a part of it."""
    statement = fluent.statement
    speaker = {SAID: statement.subject, SAYS: "robot", NOTICED: "note"}.get(statement.predicate)
    if statement.predicate == DROPPED:
        return f"note: {statement.object} frames came too late and were left out"
    return None if speaker is None else f"{speaker}: {statement.object}"


def _end_earlier(board: Blackboard) -> None:
    """End what an earlier run left as the present: it ceased to hold at an unknown time before now."""
    now = board.seconds()
    left = [each for predicate in STATES for each in board.now(Pattern(predicate=predicate))]
    ends = [(each.id, min(each.started_by + MIN_DURATION, MAX_SECONDS)) for each in left]
    changes = [Finish(id, Bounds(first, max(now, first))) for id, first in ends]
    if changes:
        board.write(*changes, by="robot")
