"""The robot: it sees tables, is shown things and told layouts, learns from it, and says what is wrong with the next.

One session is its memory. A text that it reads is grounded in the table that it sees; what is decided is taught at
once, and what is doubtful waits. Every table of a layout adds to the experience of that layout.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.errors import DeixisError
from deixis.grammar.errors import ScriptError
from deixis.grammar.script import Script
from deixis.learning.experience import Experience
from deixis.learning.teachings import GROUNDING
from deixis.ontology.kinds import plain_name
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.explanation import explain
from deixis.robot.layouts import LearnedLayout
from deixis.robot.lessons import QUESTION_COST, SETTLED, Question, Settled, SettledBy, TableLesson
from deixis.robot.looking import Fault, Look, TableKnowledge
from deixis.robot.unnamed import MIN_THINGS, NOTICED_FROM, LayoutQuestion, UnnamedKind, is_same_table
from deixis.session import Session
from deixis.view_store import category_name

if TYPE_CHECKING:
    from deixis.learning.views import Taught
    from deixis.workflows.knowledge.learn import Learned
    from deixis.workflows.knowledge.unlearn import Selection, Unlearned


class RobotError(DeixisError, ValueError):
    """Error for what a robot cannot do now, such as naming things before it sees any."""


@dataclass(frozen=True, eq=False)
class Told:
    """Result of a text: the lesson with its grounding, the roles that it taught, and those that wait."""

    lesson: TableLesson
    learned: Learned

    @property
    def taught(self) -> tuple[str, ...]:
        """Roles whose things are known now."""
        return tuple(self.lesson.settled)

    @property
    def waiting(self) -> tuple[str, ...]:
        """Roles whose things are doubtful, interchangeable or not found."""
        return tuple(self.lesson.waiting)


class Robot:
    """A robot with one memory over time.

    Parameters
    ----------
    memory
        The session, or the folder of its memory.

    Notes
    -----
    Things are named by their ids in the scene that is seen now. Methods are called by one thread at a time.
    """

    def __init__(self, memory: Session | str | Path) -> None:
        self.session = memory if isinstance(memory, Session) else Session(memory)
        self.layouts: dict[str, LearnedLayout] = {}
        self.lessons: list[TableLesson] = []
        self.unnamed: list[UnnamedKind] = []
        self._scene: Scene | None = None
        self._fullest: Scene | None = None  # of the present table, which may be laid or cleared
        self._look: Look | None = None
        self._knowledge: TableKnowledge | None = None
        self.remember()

    def close(self) -> None:
        """Close the memory."""
        self.session.close()

    def remember(self) -> None:
        """Read the layouts from the memory, with the counts of all their tables.

        A new robot does this itself. Call it after something else than the robot changed the memory.
        """
        from deixis.grammar.parser import parse_script

        self.layouts = {}
        tables = {table.lesson: table for table in self.session.tables()}
        for table in tables.values():
            script = parse_script(table.script_text, ontology=self.session.ontology)
            seen, name = table.experience(self.session.ontology.relations), table.layout.name
            known = self.layouts.get(name, LearnedLayout(name, script))
            self.layouts[name] = known.with_table(script, seen)
        for number, lesson in enumerate(self.lessons):
            if lesson.id not in tables:
                self.lessons[number] = replace(lesson, settled={}, waiting={})
        self._forget_look()

    def unlearn(self, selection: Selection) -> Unlearned:
        """Take back what was taught, with what it added to the counts of layouts.

        Parameters
        ----------
        selection
            What to take back.

        Returns
        -------
        Unlearned
            What was taken back.
        """
        found = self.session.unlearn(selection)
        self.remember()
        return found

    # ---- seeing

    @property
    def scene(self) -> Scene:
        """The scene that is seen now.

        Raises RobotError before the first one.
        """
        if self._scene is None:
            raise RobotError("the robot must see a table first; call sees() with a scene or a cloud")
        return self._scene

    def sees(self, scene: Scene | PointCloud) -> Scene:
        """Take a scene as the present situation.

        Parameters
        ----------
        scene
            A scene, or a cloud in which the things are then detected.

        Returns
        -------
        Scene
            The scene.

        Raises
        ------
        RobotError
            If the boxes of the scene have no heights.
        """
        if isinstance(scene, PointCloud):
            scene = perceived(scene)
        if scene.objects and len(scene.objects[0].minimum) < 3:
            raise RobotError("`scene` must have boxes with heights, in metres, as perceive() makes them")
        if self._fullest is not None and not is_same_table(self._fullest, scene):
            self._keep_unnamed(self._fullest)
            self._fullest = None
        self._scene, self._look = scene, None
        if self._fullest is None or len(scene.objects) >= len(self._fullest.objects):
            self._fullest = scene
        return scene

    def _keep_unnamed(self, scene: Scene) -> None:
        """Keep a table with those that are alike, if no layout explains it and no person described it."""
        found = self._kind(scene)
        if found is not None:
            place, kind = found
            self.unnamed[place : place + 1] = [kind]

    def _kind(self, scene: Scene) -> tuple[int, UnnamedKind] | None:
        """Return the kind of a table with it, and its place among the unnamed ones; None for a known one."""
        if len(scene.objects) < MIN_THINGS or any(lesson.scene is scene for lesson in self.lessons):
            return None
        knowledge = self.knowledge()
        look = self.look() if scene is self._scene else knowledge.look(scene)
        if look.layout is not None:
            return None
        for place, kind in enumerate(self.unnamed):
            more = kind.with_table(look.scene, knowledge.ontology, knowledge.meaning)
            if more is not None:
                return place, more
        return len(self.unnamed), UnnamedKind.of(look.scene, knowledge.ontology)

    def knowledge(self) -> TableKnowledge:
        """Return what was learned so far, as far as looking at a table needs it.

        Returns
        -------
        TableKnowledge
            The recogniser, the layouts, words and sizes.
        """
        if self._knowledge is None:
            frame = self._scene.frame if self._scene is not None else "table"
            known = self.session.view_store.known(frame)
            layouts = tuple(self.layouts[name] for name in sorted(self.layouts))
            self._knowledge = TableKnowledge(known, layouts, self.session.meaning(), self.session.ontology)
        return self._knowledge

    def look(self) -> Look:
        """Return how the present scene is understood.

        Returns
        -------
        Look
            Layouts, names and mistakes.
        """
        if self._look is None:
            self._look = self.knowledge().look(self.scene)
        return self._look

    def names(self) -> Mapping[str, Mapping[str, float]]:
        """Return the names that each thing may have, with their probabilities.

        Returns
        -------
        mapping
            Probability by name, by id of the thing.
        """
        return self.look().names

    def layout(self) -> str | None:
        """Return the layout that lies here.

        Returns
        -------
        str or None
            Its name; None if it is probably none that is known.
        """
        return self.look().layout

    def check(self, layout: str | None = None) -> tuple[Fault, ...]:
        """Return what is wrong with the present table.

        Parameters
        ----------
        layout
            Name of the layout to compare with; None for the one that lies here.

        Returns
        -------
        tuple of Fault
            The mistakes.

        Raises
        ------
        RobotError
            If there is no layout of that name.
        """
        if layout is not None and layout not in self.layouts:
            known = ", ".join(sorted(self.layouts)) or "none"
            raise RobotError(f"`layout` must be a layout that the robot knows, got '{layout}'; there are: {known}")
        return self.look().faults(layout)

    # ---- being taught

    def shown(self, label: str, thing: str, by: str = "user") -> Taught:
        """Learn what a thing looks like that a person points at and names.

        Parameters
        ----------
        label
            Name of the thing.
        thing
            Id of the thing in the present scene.
        by
            Name of the person.

        Returns
        -------
        Taught
            The stored view.
        """
        pointed = [
            (lesson, role)
            for lesson in self.lessons
            if lesson.scene is self.scene
            for role in lesson.waiting
            if plain_name(role) == plain_name(label)
        ][:1]
        settles = (pointed[0][0].id, pointed[0][1]) if pointed else None
        taught = self.session.teach(self.scene, thing, label, by, settles)
        for lesson, role in pointed:
            self._settle(lesson, role, Settled(thing, SettledBy.POINTING, 1.0))
        self._forget_look()
        return taught

    def told(self, text: str | Script) -> Told:
        """Learn the layout that a text describes from the table that is seen.

        Parameters
        ----------
        text
            A script in the layout language or in English, as text or parsed.

        Returns
        -------
        Told
            The layout, the grounding, and what was taught and what waits.
        """
        script = text if isinstance(text, Script) else understood(text, self.session)
        seen = self.knowledge().recognised(self.scene)
        learned = self.session.learn(script, seen)
        lesson = self._learned(script, self.scene, learned)
        return Told(lesson, learned)

    def _learned(self, script: Script, scene: Scene, learned: Learned) -> TableLesson:
        """Add a lesson of the memory to the robot's lessons, and its table to the layout."""
        layout = LearnedLayout.told(script)
        name = layout.name
        lesson = TableLesson.of(len(self.lessons), name, scene, learned.grounding, learned.lesson.id)
        self.lessons.append(lesson)
        self.layouts[name] = self.layouts.get(name, layout).with_table(script, self._experience(lesson))
        self._forget_look()
        return lesson

    # ---- what waits

    @property
    def questions(self) -> tuple[Question, ...]:
        """Questions about the present table that are worth their cost, the one that tells most first."""
        asked = [each for lesson in self.lessons if lesson.scene is self._scene for each in lesson.questions()]
        worth = [question for question in asked if question.gain > QUESTION_COST]
        return tuple(sorted(worth, key=lambda question: -question.gain))

    @property
    def layout_question(self) -> LayoutQuestion | None:
        """Question for the name of a layout that has none and lies here again; None if there is nothing to ask."""
        found = None if self._scene is None else self._kind(self._scene)
        if found is None or len(found[1].tables) < NOTICED_FROM or found[1].asked:
            return None
        return LayoutQuestion(found[1])

    def name_layout(self, question: LayoutQuestion, name: str | None, by: str = "user") -> tuple[TableLesson, ...]:
        """Take the name of a layout that came again, and learn the layout from all tables of its kind.

        Parameters
        ----------
        question
            The question.
        name
            Name of the layout; None if it has none, so that it is not asked again.
        by
            Name of the person who answers.

        Returns
        -------
        tuple of TableLesson
            A lesson for each table.

        Raises
        ------
        SettingError
            If the name is empty.
        ScriptError
            If the name cannot be that of a layout.
        """
        kind = question.kind
        place = next((n for n, known in enumerate(self.unnamed) if known.layout.script is kind.layout.script), None)
        if name is None:
            if place is not None:
                self.unnamed[place] = replace(self.unnamed[place], asked=True)
            return ()
        script = kind.script(category_name(name), self.session.ontology)
        examples = [(script, table.labelled) for table in kind.tables]
        learned = self.session.learn_all(examples, teacher=by)
        lessons = [self._learned(script, table.scene, one) for table, one in zip(kind.tables, learned, strict=True)]
        if place is not None:
            del self.unnamed[place]
        return tuple(lessons)

    def answers(self, question: Question, thing: str | None, by: str = "user") -> None:
        """Take the answer to a question, and teach what it settles.

        Parameters
        ----------
        question
            The question.
        thing
            Id of the thing in the scene of the lesson; None for none of them.
        by
            Name of the person who answers.

        Raises
        ------
        RobotError
            If the scene has no such thing, or the role does not wait any more.
        """
        lesson = self.lessons[question.lesson]
        if question.role not in lesson.waiting:
            raise RobotError(f"`question` must be about a role that waits, and '{question.role}' does not any more")
        if thing is None:
            self._settle(lesson, question.role, None)
            return
        if thing not in lesson.scene.ids:
            raise RobotError(f"`thing` must be a thing of the scene, got '{thing}'; {', '.join(lesson.scene.ids)}")
        self.session.teach(lesson.scene, thing, plain_name(question.role), by, (lesson.id, question.role))
        self._settle(lesson, question.role, Settled(thing, SettledBy.ANSWER, 1.0))

    def reconsider(self) -> tuple[tuple[int, str], ...]:
        """Look at all lessons again with what was learned since, and teach in hindsight what is clear now.

        A name that only words or hindsight gave, and that is now clearly that of another thing, is corrected.

        Returns
        -------
        tuple of tuple
            Number of the lesson and role of everything that was taught.
        """
        done = []
        for number in range(len(self.lessons)):
            lesson = self.lessons[number]
            layout = self.layouts.get(lesson.layout)
            if layout is None:  # it was taken back
                continue
            knowledge = self.knowledge()
            seen = knowledge.recognised(lesson.scene)
            found = explain(layout.evidence(seen, knowledge.ontology, knowledge.meaning))
            for place, role in enumerate(layout.roles):
                known = lesson.settled.get(role)
                if role not in lesson.waiting and known is None:
                    continue
                if known is not None and known.by in (SettledBy.ANSWER, SettledBy.POINTING):
                    continue
                best = int(found.roles_of[place].argmax())
                share, thing = float(found.roles_of[place, best]), lesson.scene.ids[best]
                if share < SETTLED or (known is not None and known.thing == thing):
                    continue
                if any(other != role and each.thing == thing for other, each in lesson.settled.items()):
                    continue
                self.session.teach(lesson.scene, thing, plain_name(role), GROUNDING, (lesson.id, role))
                lesson = self._settle(lesson, role, Settled(thing, SettledBy.HINDSIGHT, share))
                done.append((number, role))
        return tuple(done)

    def _settle(self, lesson: TableLesson, role: str, settled: Settled | None) -> TableLesson:
        """Replace a lesson by one in which a role is known, with the experience of its layout; return it."""
        new = lesson.with_settled(role, settled)
        self.lessons[lesson.number] = new
        layout = self.layouts[lesson.layout]
        seen = layout.experience + -self._experience(lesson) + self._experience(new)
        self.layouts[lesson.layout] = replace(layout, experience=seen)
        self._forget_look()
        return new

    def _experience(self, lesson: TableLesson) -> Experience:
        """Return what a lesson adds to the counts of its layout."""
        things = {role: lesson.scene[settled.thing] for role, settled in lesson.settled.items()}
        return Experience.of_table(lesson.roles, things, self.session.ontology.relations, lesson.present)

    def _forget_look(self) -> None:
        self._look = self._knowledge = None


def perceived(cloud: PointCloud) -> Scene:
    """Return the things in a cloud; parts of a thing that another thing hides in the middle are one thing.

    Parameters
    ----------
    cloud
        The cloud, in metres.

    Returns
    -------
    Scene
        The scene in the frame of the table.
    """
    from deixis.perception.clouds.smoothing import smoothed
    from deixis.perception.occlusion import joined_behind_others
    from deixis.workflows.scenes.perceive import perceive

    return joined_behind_others(perceive(smoothed(cloud)))


def understood(text: str, session: Session) -> Script:
    """Read a text as a layout script, or else as English.

    Parameters
    ----------
    text
        The text.
    session
        Session with the words.

    Returns
    -------
    Script
        The script.

    Raises
    ------
    ScriptError
        If it is neither.
    """
    from deixis.workflows.layouts.read import read_script

    try:
        return read_script(text=text, ontology=session.ontology)
    except ScriptError:
        return read_script(text=text, ontology=session.ontology, english=True)
