"""The module that learns from the tables that the senses write and from people, and says what it found."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import ClassVar

from deixis.answers import count
from deixis.errors import DeixisError
from deixis.grammar.activities import announced_thing
from deixis.grammar.recall.acts import told_act
from deixis.grammar.recall.questions import RecallQuestionError, is_question, read_question
from deixis.memory.episodes.experiences import CONSOLIDATED, RECORDED
from deixis.memory.episodes.fluents.changes import Add, Logged
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.predicates import (
    ACTS,
    CALLED,
    CONTRADICTED,
    EXPECTED,
    FAULT,
    IS_A,
    LAYOUT,
    SAID,
    SAME_AS,
    SAYS,
)
from deixis.memory.errors import MemoryBusyError, MemoryWriteError
from deixis.ontology.things.kinds import with_article
from deixis.perception.formats.scene_json import read_scene
from deixis.printable import printed_line
from deixis.reasoning.errors import InconsistencyError, NothingFoundError
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern
from deixis.robot.diary import NAMELESS, UNNAMED
from deixis.robot.expected import Standing, described_predicates
from deixis.robot.ids import IdError
from deixis.robot.kept import KeptElsewhere
from deixis.robot.lessons import Question
from deixis.robot.live.outbox import Outbox
from deixis.robot.live.senses import ENDED, MIN_DURATION, TABLE, WATCHED, named
from deixis.robot.modules import Board, Module
from deixis.robot.robot import Robot, Told
from deixis.robot.unnamed import LayoutQuestion
from deixis.workflows.scenes.point import MIN_CONFIDENCE

DONE = "done"
"""Predicate: the robot has dealt with the whole story."""

_WRONG = re.compile(
    r"\b(wrong|missing|mistakes?|correct)\b|^\W*(?:is|are)\b.*\blaid\b|\b(?:this|it|everything|all|table) right\b",
    re.IGNORECASE,
)
"""Words of questions about the mistakes on the present table."""

_ASKED_NOW = re.compile(r"\W*(?:what|which|is|are)\b", re.IGNORECASE)
"""Beginning of such a question, which recognised speech has without a question mark."""

_FIRST_VERB = re.compile(r"\b(?:is|are|(?P<past>was|were|did|has|have))\b", re.IGNORECASE)
"""Auxiliary verb of a question."""

_TOLD = re.compile(r"\b(tell|told|say|said)\b", re.IGNORECASE)
"""Words of questions about what was said."""

_NAME = re.compile(
    r"(?:(?:none|no(?: name|thing| idea)?|never mind|i do not know|it has no name|i don['’]t know)"
    r"|(?:(?:it|this|that)(?:['’]s| is)(?: called)? |call it )?(?:an? |the )?"
    r"['\"‘“]?(?P<name>[\w-]+(?: [\w-]+){0,3})['\"’”]?)[.!]?",
    re.IGNORECASE,
)
"""Answer to the question for the name of a layout: a name of up to four words, or that it has none."""

NOT_FOUND = "I found none of these things on the table, so I learned nothing."
"""Answer to a description of which the robot sees no object."""

NOT_SEEN = "I have not seen a table yet."
"""Answer to what is said about a table before the first one lay still."""

NAMELESS_LAYOUT = "text"
"""Name of the layouts that are described in sentences without a name for them."""

_FORGET = re.compile(
    r"\W*(?:please )?(?:forget|unlearn|take back|ignore) (?:what|all(?: that)?|everything(?: that)?) (?P<person>.+?)"
    r"(?:'ve|'s| has| have)? (?:ever )?(?:said|told|taught|showed|shown|explained)"
    r"(?: (?:you|to you|me|us|so far|today))*\W*",
    re.IGNORECASE,
)
"""Sentence that takes back what a person taught: *forget what Ada said*."""

_COURTESIES = tuple(
    (re.compile(rf"\W*(?:{words})(?:,? (?:there|robot|so much|very much|a lot|again))*\W*", re.IGNORECASE), reply)
    for words, reply in (
        ("hello|hi|hey|good (?:morning|afternoon|evening|day)", "Hello."),
        ("thank you|thanks|many thanks|cheers", "You are welcome."),
        ("goodbye|bye|bye bye|see you|good night", "Goodbye."),
        ("ok|okay|all right|great|fine|good|well done|very good|perfect|i see", ""),
    )
)
"""Courtesies and words of agreement, each with the reply of the robot; it says nothing where the reply is empty."""

MAX_UNSEEN = 20
"""Maximum number of names that wait until their things have been looked at."""

MAX_SAID = 5000
"""Maximum number of characters of what the robot says."""


class Learner(Module):
    """Module that holds the robot's concepts and its memory of views.

    Parameters
    ----------
    memory
        Folder of the memory.
    """

    name: ClassVar[str] = "learner"
    reads: ClassVar[tuple[Pattern, ...]] = (ANYTHING,)  # it answers questions about all that happened

    def __init__(self, memory: str) -> None:
        self._memory = memory
        self._robot: Robot | None = None
        self._outbox = Outbox()
        self._handled: int | None = None
        self._rest: list[Callable[[], None]] = []  # what is still to be done about the last change
        self._asked: Question | None = None
        self._announced: dict[str, Standing] = {}  # what was said about each expected object
        self._named: LayoutQuestion | None = None  # the question for a name that was asked
        self._unseen: list[EpisodicFluent] = []  # names of things that no scene of the table has yet
        own = (
            *sorted(ACTS), IS_A, LAYOUT, UNNAMED, NAMELESS, CONSOLIDATED, FAULT,
            EXPECTED, SAME_AS, CONTRADICTED, SAYS, DONE,
        )  # fmt: skip
        self.writes = tuple(Pattern(predicate=each) for each in (*own, *sorted(described_predicates())))  # type: ignore[misc]

    def run(self, board: Board, stopped: threading.Event) -> None:
        """Wait, and close the memory at the end."""
        stopped.wait()
        if self._robot is not None:
            self._robot.close()
            self._robot = None

    @property
    def robot(self) -> Robot:
        """The robot, which is made with the first change."""
        assert self._robot is not None, "the robot reads no blackboard yet"
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
        if change.after is None:
            return
        self._outbox.new_id(board)
        fluent = change.after
        if change.sequence != self._handled:  # else what was learned is kept, and only the rest comes again
            self._rest = [lambda: self._react(change, fluent, board)]
            self._handled = change.sequence
        while self._rest:
            step, waiting = self._rest.pop(0), len(self._outbox)
            try:
                step()
            except MemoryWriteError:
                self._outbox.cut(waiting)
                self._rest.insert(0, step)
                raise  # the change comes again, until the disk has room
            except Exception as error:
                reason = str(error) if isinstance(error, DeixisError) else f"{type(error).__name__}: {error}"
                self._say(f"I could not use {fluent.statement}: {reason}", fluent.start.lower, board)
        self._outbox.flush(board)

    def _then(self, *steps: Callable[[], None]) -> None:
        """Take steps that follow a lesson; if the disk is full, repeat the steps later, but not the lesson."""
        self._rest.extend(steps)

    def _react(self, change: Logged, fluent: EpisodicFluent, board: Board) -> None:
        """Decide what follows from a change."""
        if fluent.statement.predicate == ENDED:  # the story ends also where the memory cannot be opened
            if change.kind == "add":
                self._add((self.name, DONE, "story"), fluent.start.lower, board)
            return
        if self._robot is None:  # the memory is opened when it is first needed
            self._robot = Robot(self._memory, board)
        statement, at = fluent.statement, fluent.start.lower
        if statement.predicate == WATCHED:
            self.robot.watches(fluent.finish.lower)
            self._announce(fluent.finish.lower, board)
        elif statement.predicate == RECORDED and not fluent.is_open:
            self._consolidate(fluent.finish.upper, board)
        if change.kind != "add":
            return
        if statement.predicate == TABLE and statement.object is not None:
            self._look(Path(statement.object), at, board)
        elif statement.predicate == CALLED and statement.object is not None:
            self._shown(fluent, board)
        elif statement.predicate == SAID and statement.object is not None:
            self._heard(statement.object, fluent, board)

    def _look(self, file: Path, at: float, board: Board) -> None:
        if not file.exists():
            return
        self.robot.sees(read_scene(file), at)
        self._understand(board, at)
        self._ask_name(at, board)
        waiting, self._unseen = self._unseen, []
        for fluent in waiting:
            self._then(partial(self._shown, fluent, board))

    def _understand(self, board: Board, at: float) -> None:
        """Explain the table, write the categories of its things, and announce changes of expected objects."""
        if self.robot.scene.objects:
            self.robot.look()
        else:
            self.robot.diary.concluded((), (IS_A, LAYOUT, FAULT), at, {})
        self._announce(at, board)

    def _consolidate(self, at: float, board: Board) -> None:
        """Learn from the experiences whose recording has finished."""
        done = self.robot.consolidate()
        for name, lesson in done.lessons.items():
            self._say(f"The experience '{name}' is lesson {lesson}.", at, board)

    def _ask_name(self, at: float, board: Board) -> None:
        """Ask for the name of a layout that came up several times."""
        if self._asked is None and self._named is None:
            self._named = self.robot.layout_question
            if self._named is not None:
                self._say(f"{self._named.text} {self._named.why}", at, board)

    def _learned_name(self, text: str, by: str, at: float, board: Board, event: str | None) -> bool:
        """Take a text as the name that was asked for; return False if it is not an answer."""
        assert self._named is not None
        given = _NAME.fullmatch(text.strip())
        if given is None:
            return False
        question, name = self._named, given["name"]
        try:
            lessons = self.robot.name_layout(question, name, by, event)
        except MemoryWriteError:
            raise
        except DeixisError as error:
            self._say(f"I could not learn '{name}': {str(error).splitlines()[0]}", at, board)
            self._named = None
            return True
        self._named = None
        reply = f"Thank you: I know '{name}' from {len(lessons)} tables." if name else "I will not ask for it again."
        self._say(reply, at, board)
        self._then(lambda: self._understand(board, at))
        return True

    def _announce(self, at: float, board: Board) -> None:
        """Say which expected objects were seen, or are no longer expected."""
        for one in self.robot.expected:
            if one.standing is self._announced.get(one.id, Standing.EXPECTED):
                continue
            self._announced[one.id] = one.standing
            spoken = f"the {one.name} that {one.by} spoke of"
            if one.standing is Standing.SEEN:
                self._say(f"I see {spoken}: it is {one.thing}, probability {one.probability:.2f}.", at, board)
            else:
                self._say(f"I do not see {spoken}: {one.reason}.", at, board)

    def _shown(self, fluent: EpisodicFluent, board: Board) -> None:
        """Learn a name that a thing was given; if the thing has not been looked at yet, when it is."""
        thing, label, at = fluent.statement.subject, str(fluent.statement.object), fluent.start.lower
        seen = self.robot.sees_a_table and thing in self.robot.scene.ids
        if not seen and len(self._unseen) < MAX_UNSEEN:
            self._unseen.append(fluent)
            return
        try:
            self.robot.shown(label, thing, fluent.source.by, at, fluent.source.event)
        except MemoryWriteError:
            raise
        except DeixisError as error:
            self._say(f"I could not learn '{label}': {error}", at, board)
            return
        self._then(
            lambda: self._understand(board, at),
            lambda: self._say(f"I see: {thing} is {with_article(label)}.", at, board),
        )

    def _heard(self, text: str, fluent: EpisodicFluent, board: Board) -> None:
        by, at = fluent.source.by, fluent.start.lower
        courtesy = next((reply for words, reply in _COURTESIES if words.fullmatch(text)), None)
        if courtesy is not None:
            if courtesy:
                self._say(courtesy, at, board)
            return
        names = named(text)[1] is not None or announced_thing(text) is not None
        answers = re.match(r"\s*(it|call)\b", text, re.IGNORECASE) is not None or not names
        if self._named is not None and answers and self._learned_name(text, by, at, board, fluent.source.event):
            return
        if names:
            return  # the senses say which thing it names
        if fluent.certainty < MIN_CONFIDENCE:
            self._say(f"I am not sure that I heard this right: {text} Please say it again.", at, board)
            return
        if (_ASKED_NOW.match(text) and _WRONG.search(text)) or is_question(text, self.robot.session.ontology):
            self._say(self._answer(text, by, at, board), at, board)
            return
        if self._asked is not None and self._settled(text, by, at, board):
            return
        if (forget := _FORGET.fullmatch(text)) is not None:
            self._forget(forget["person"], by, at, board)
            return
        noted = self._note_act(text, fluent, board)
        try:
            result = self.robot.told(text, by, at, fluent.source.event)
        except MemoryWriteError:
            raise
        except NothingFoundError:
            if not noted:
                self._say(NOT_FOUND, at, board)
            return
        except (InconsistencyError, IdError) as error:
            self._say(f"I learned nothing: {_without_place(error)}.", at, board)
            return
        except DeixisError as error:
            if noted:
                return
            seen = self.robot.sees_a_table
            self._say(f"I did not understand: {_without_place(error)}." if seen else NOT_SEEN, at, board)
            return
        if isinstance(result, Told):
            taught = _listed(result.taught) or "nothing new"
            waiting = f" I am not sure yet about: {_listed(result.waiting)}." if result.waiting else ""
            learned = f"I learned how {_layout_words(result.lesson.layout)} is laid. I know now: {taught}.{waiting}"
            if result.contradiction is not None:
                learned += f" This contradicts an earlier description: {result.contradiction}."
            self._then(
                lambda: self._understand(board, at),
                lambda: self._say(learned, at, board),
                lambda: self._ask(at, board),
            )
            return
        if isinstance(result, KeptElsewhere):
            self._say(f"I have noted where things are kept: {result}. That is not on this table.", at, board)
            return
        if left := [one.name for one in result if one.standing is Standing.EXPECTED]:
            self._say(f"I do not see it yet; I expect: {_listed(left)}.", at, board)
        self._announce(at, board)

    def _forget(self, person: str, by: str, at: float, board: Board) -> None:
        """Take back what a person taught, and say what was taken back."""
        from deixis.workflows.knowledge.unlearn import Selection

        wanted = by if person.lower() in ("i", "we") else re.sub(r"^the ", "", person, flags=re.IGNORECASE)
        known = {each.source.by for each in board.holding() if each.source.origin in (Origin.SAID, Origin.SHOWN)}
        teacher = next((each for each in sorted(known) if each.lower() == wanted.lower()), None)
        if teacher is None:
            self._say(f"I know nothing that {wanted} said or showed.", at, board)
            return
        try:
            found = self.robot.unlearn(Selection(teacher=teacher))
        except MemoryBusyError:
            reason = "my modules run as processes, and another one owns the memory; stop me and use `deixis unlearn`"
            self._say(f"I cannot forget what {teacher} said: {reason}.", at, board)
            return
        taken = f"{count(len(found.lessons), 'lesson')} and {count(len(found.views), 'view')} of things"
        self._asked = self._named = None
        self._then(
            lambda: self._understand(board, at) if self.robot.sees_a_table else None,
            lambda: self._say(f"I have forgotten what {teacher} said and showed: {taken}.", at, board),
        )

    def _note_act(self, text: str, fluent: EpisodicFluent, board: Board) -> bool:
        """Write who did what with a thing, if a sentence tells it; return False if it does not."""
        from deixis.workflows.knowledge.recall import told_change
        from deixis.workflows.knowledge.recall_wording import act_words

        told, by, at = told_act(text), fluent.source.by, fluent.start.lower
        change = None if told is None else told_change(told, board, at)
        if told is None or change is None:
            return False
        act, thing, when = change
        person = by if told.person is None else told.person
        source = Source(Origin.SAID, by, fluent.source.event)
        finish = replace(when, lower=when.upper + MIN_DURATION, upper=when.upper + MIN_DURATION)
        id = self._outbox.new_id(board)
        added = episodic(id, (person, act, thing), start=when, finish=finish, certainty=fluent.certainty, source=source)
        self._outbox.add(Add(added))
        self._say(f"I have noted that {person} {act_words(act, told.thing)}.", at, board)
        return True

    def _ask(self, at: float, board: Board) -> None:
        """Ask the most informative question, if it is worth its cost."""
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
        question = self._asked
        self.robot.answers(question, given, by)
        self._asked = None
        name = question.role.replace("_", " ")
        answer = f"Thank you: {given} is the {name}." if given else f"Then the {name} is not here."
        self._then(
            lambda: self._understand(board, at),
            lambda: self._say(answer, at, board),
            lambda: self._ask(at, board),
        )
        return True

    def _answer(self, question: str, by: str, at: float, board: Board) -> str:
        """Return the answer to a question: what is wrong with the table, or what was when."""
        from deixis.workflows.knowledge.recall import recall

        if not _WRONG.search(question) or _TOLD.search(question) or _is_of_another_time(question):
            try:
                found = recall(question, board, at, self.robot.session.ontology, by)
                return found.answer if found.known else f"I do not know: {found.reason}."
            except DeixisError as error:
                return f"I did not understand: {_without_place(error)}."
        if not self.robot.sees_a_table:
            return NOT_SEEN
        look = self.robot.look()
        if look.layout is None:
            return "I do not know how this table should be laid."
        faults = look.faults()
        if not faults:
            return f"Nothing is wrong: this is {_layout_words(look.layout)}."
        return f"This is {_layout_words(look.layout)}; " + "; ".join(map(str, faults)) + "."

    def _say(self, text: str, at: float, board: Board) -> None:
        self._add((self.name, SAYS, printed_line(text, MAX_SAID)), at, board, finish=at + MIN_DURATION)

    def _add(self, statement: tuple[str, str, str], at: float, board: Board, finish: float | None = None) -> None:
        source = Source(Origin.INFERRED, self.name)
        self._outbox.add(Add(episodic(self._outbox.new_id(board), statement, start=at, finish=finish, source=source)))


def _is_of_another_time(question: str) -> bool:
    """Return whether a question about mistakes, such as *what was wrong at noon?*, is about another time than now."""
    try:
        read = read_question(question)
    except RecallQuestionError:
        return False
    verb = _FIRST_VERB.search(question)
    is_past = verb is not None and verb["past"] is not None
    return read.kind in ("fault", "gone", "whether_did") and (is_past or read.when.kind not in ("unstated", "now"))


def _without_place(error: DeixisError) -> str:
    """Return the first line of an error about words that were said, without places in a file."""
    line = re.sub(r"^<text>(?::\d+)*: | \((?:<text>(?::\d+)*(?:, )?)+\)", "", str(error).splitlines()[0])
    return line.removeprefix("the script contradicts itself, nothing was learned: ").rstrip(".")


def _layout_words(name: str) -> str:
    """Return the name of a layout in quotation marks; *a table without a name* if no person named it."""
    return "a table without a name" if name == NAMELESS_LAYOUT else f"'{name}'"


def _listed(names: Iterable[str]) -> str:
    return ", ".join(name.replace("_", " ") for name in names)
