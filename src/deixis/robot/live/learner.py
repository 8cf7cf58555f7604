"""The module that learns: it looks at the tables that the senses write, is shown and told, and says what it found."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from deixis.errors import DeixisError
from deixis.memory.episodes.changes import Add, Change, Finish, Logged
from deixis.memory.episodes.episode import Origin, Source, episodic
from deixis.perception.formats.scene_json import read_scene
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.lessons import Question
from deixis.robot.live.senses import AT, CALLED, ENDED, NOT_CALLED, SAID, TABLE
from deixis.robot.modules import Board, Module
from deixis.robot.robot import Robot, understood
from deixis.workflows.scenes.point import spoken_name

IS_A, LAYOUT, FAULT, SAYS, DONE = "isA", "layout", "fault", "says", "done"
"""Predicates: the category of a thing, the layout of the table, a mistake on it, what the robot says, and that it has
dealt with the whole story."""

_WRONG = re.compile(r"\b(wrong|missing|mistakes?|right|correct|laid)\b", re.IGNORECASE)
"""Words of questions about the mistakes on the present table."""

_NAMED = re.compile(
    r"\s*this is how (?:an? )?['\"‘“]?(?P<name>[^'\"’”.:]{1,60}?)['\"’”]? is laid[.:]\s*", re.IGNORECASE
)
"""Sentence before a description that names the layout."""

SURE = 0.8
"""Probability from which a name is written as the category of a thing."""

if TYPE_CHECKING:
    from deixis.grammar.script import Script


class Learner(Module):
    """Module that holds the robot's concepts and its memory of views.

    Parameters
    ----------
    memory
        Folder of the memory.
    """

    name: ClassVar[str] = "learner"
    reads: ClassVar[tuple[Pattern, ...]] = tuple(
        Pattern(predicate=each) for each in (TABLE, CALLED, NOT_CALLED, SAID, ENDED, AT)
    )
    writes: ClassVar[tuple[Pattern, ...]] = tuple(Pattern(predicate=each) for each in (IS_A, LAYOUT, FAULT, SAYS, DONE))

    def __init__(self, memory: str) -> None:
        self._memory = memory
        self._robot: Robot | None = None
        self._found: dict[tuple[str, str, str], str] = {}  # fluents that hold, by statement
        self._asked: Question | None = None

    def run(self, board: Board, stopped: threading.Event) -> None:
        """Wait, and close the memory at the end."""
        stopped.wait()
        if self._robot is not None:
            self._robot.close()
            self._robot = None

    @property
    def robot(self) -> Robot:
        """The robot, whose memory is opened when it is first needed."""
        if self._robot is None:
            self._robot = Robot(self._memory)
        return self._robot

    def changed(self, change: Logged, board: Board) -> None:
        """React to what was seen, shown and said.

        Parameters
        ----------
        change
            A change of a fluent that the module reads.
        board
            The board of the module.
        """
        if change.kind != "add" or change.after is None:
            return
        said, at = change.after.statement, change.after.start.lower
        if said.predicate == TABLE and said.object is not None:
            self._look(Path(said.object), at, board)
        elif said.predicate == CALLED and said.object is not None:
            self._shown(said.object, said.subject, change.after.source.by, at, board)
        elif said.predicate == SAID and said.object is not None:
            self._heard(said.object, change.after.source.by, at, board)
        elif said.predicate == ENDED:
            self._state(board, {(self.name, DONE, "story")}, (DONE,), at)

    def _look(self, file: Path, at: float, board: Board) -> None:
        if not file.exists():
            return
        self.robot.sees(read_scene(file))
        self._understand(board, at)

    def _understand(self, board: Board, at: float) -> None:
        """Write what the things of the table are, and how it is laid."""
        if not self.robot.scene.objects:
            self._state(board, set(), (IS_A, LAYOUT, FAULT), at)
            return
        names = {
            (thing, IS_A, best): min(shares[best], 1.0)
            for thing, shares in self.robot.names().items()
            for best in list(shares)[:1]
            if shares[best] >= SURE
        }
        layout = self.robot.layout()
        faults = self.robot.check() if layout is not None else ()
        found = {*names, *(("table", FAULT, str(fault)) for fault in faults)}
        if layout is not None:
            found.add(("table", LAYOUT, layout))
        self._state(board, found, (IS_A, LAYOUT, FAULT), at, names)

    def _shown(self, label: str, thing: str, by: str, at: float, board: Board) -> None:
        try:
            self.robot.shown(label, thing, by)
        except DeixisError as error:
            self._say(f"I could not learn '{label}': {error}", at, board)
            return
        self._say(f"I see: {thing} is a {label}.", at, board)
        self._understand(board, at)

    def _heard(self, text: str, by: str, at: float, board: Board) -> None:
        if spoken_name(text) is not None:
            return  # the senses say which thing it names
        if text.strip().endswith("?"):
            self._say(self._answer(text), at, board)
            return
        if self._asked is not None and self._settled(text, by, at, board):
            return
        try:
            told = self.robot.told(self._script(text))
        except DeixisError as error:
            self._say(f"I did not understand: {str(error).splitlines()[0]}", at, board)
            return
        taught = _listed(told.taught) or "nothing new"
        waiting = f" I am not sure yet about: {_listed(told.waiting)}." if told.waiting else ""
        self._say(f"I learned how '{told.lesson.layout}' is laid. I know now: {taught}.{waiting}", at, board)
        self._understand(board, at)
        self._ask(at, board)

    def _script(self, text: str) -> Script:
        """Return the layout that a text describes, with the name that the text gives it."""
        named = _NAMED.match(text)
        script = understood(text if named is None else text[named.end() :], self.robot.session)
        return script if named is None else replace(script, name=named["name"].strip().replace(" ", "_"))

    def _ask(self, at: float, board: Board) -> None:
        """Ask the question that tells most, if one is worth asking."""
        self._asked = next(iter(self.robot.questions), None)
        if self._asked is not None:
            self._say(f"{self._asked.text} {self._asked.why}", at, board)

    def _settled(self, text: str, by: str, at: float, board: Board) -> bool:
        """Take a text as the answer to the question that was asked; return False if it is not an answer."""
        assert self._asked is not None
        things = [thing for thing, _ in self._asked.among if thing is not None]
        given = next((thing for thing in things if re.search(rf"\b{re.escape(thing)}\b", text)), None)
        if given is None and not re.match(r"\s*(none|no)\b", text, re.IGNORECASE):
            return False
        question, self._asked = self._asked, None
        self.robot.answers(question, given, by)
        name = question.role.replace("_", " ")
        self._say(f"Thank you: {given} is the {name}." if given else f"Then the {name} is not here.", at, board)
        self._understand(board, at)
        self._ask(at, board)
        return True

    def _answer(self, question: str) -> str:
        """Return the answer to a question: what is wrong with the table, or what was when."""
        if not _WRONG.search(question):
            try:
                found = self.robot.session.recall(question)
                return found.answer if found.known else f"I do not know: {found.reason}."
            except DeixisError as error:
                return f"I did not understand: {str(error).splitlines()[0]}"
        look = self.robot.look()
        if look.layout is None:
            return "I do not know how this table should be laid."
        faults = look.faults()
        if not faults:
            return f"Nothing is wrong: this is '{look.layout}'."
        return f"This is '{look.layout}'; " + "; ".join(map(str, faults)) + "."

    def _say(self, text: str, at: float, board: Board) -> None:
        source = Source(Origin.INFERRED, self.name)
        added = episodic(board.new_id("f"), (self.name, SAYS, text), start=at, finish=at + 1e-3, source=source)
        board.write(Add(added))

    def _state(
        self,
        board: Board,
        found: set[tuple[str, str, str]],
        predicates: tuple[str, ...],
        at: float,
        certainties: dict[tuple[str, str, str], float] | None = None,
    ) -> None:
        """Make these the statements with these predicates that hold."""
        over = [each for each in self._found if each[1] in predicates and each not in found]
        changes: list[Change] = [Finish(self._found.pop(statement), at) for statement in over]
        for statement in sorted(found - self._found.keys()):
            certainty = (certainties or {}).get(statement, 1.0)
            added = episodic(
                board.new_id("f"), statement, start=at, certainty=certainty, source=Source(Origin.INFERRED, self.name)
            )
            self._found[statement] = added.id
            changes.append(Add(added))
        if changes:
            board.write(*changes)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(name.replace("_", " ") for name in names)
