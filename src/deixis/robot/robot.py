"""The robot: it sees tables, learns things that people show and layouts that they describe, and checks the next table.

A session is its memory. A text is grounded in the table that the robot sees; decided matches are learned at once, and
doubtful ones wait. Every table of a layout adds to the experience of that layout.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from deixis.answers import Answer, count, share
from deixis.arguments import checks_arguments
from deixis.errors import DeixisError
from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.format import format_script
from deixis.grammar.script import Script
from deixis.learning.layouts.experience import Experience
from deixis.learning.lessons.lesson import layout_name
from deixis.learning.views.teachings import GROUNDING
from deixis.memory.episodes.blackboard import Blackboard, has_episodes
from deixis.memory.episodes.fluents.changes import Change
from deixis.memory.episodes.fluents.episode import event_of
from deixis.memory.episodes.predicates import EXPECTED, FAULT, IS_A, LAYOUT
from deixis.memory.errors import MemoryWriteError
from deixis.memory.journal import Part
from deixis.memory.owner import Closing
from deixis.ontology.things.kinds import plain_name
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.explanation import explain
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.diary import Diary, RobotModule
from deixis.robot.expected import LOOK_INTERVAL, MIN_MATCH_PROBABILITY, ExpectedObject, Sighting, Standing, introduced
from deixis.robot.ids import with_names
from deixis.robot.kept import KeptElsewhere, kept_elsewhere
from deixis.robot.layouts import LearnedLayout
from deixis.robot.lessons import MIN_SETTLED_PROBABILITY, QUESTION_COST, Question, Settled, SettledBy, TableLesson
from deixis.robot.looking import Fault, Look, TableKnowledge
from deixis.robot.modules import Board, ModuleBoard
from deixis.robot.places import places_of
from deixis.robot.unnamed import MIN_TABLES, MIN_THINGS, LayoutQuestion, UnnamedKind, is_same_table, place_among
from deixis.session import Session
from deixis.view_store import category_name, new_category_name
from deixis.workflows.knowledge.episodes import Consolidation, consolidate, named_layout

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from deixis.learning.views.views import Taught
    from deixis.workflows.knowledge.learn import Learned, Recording
    from deixis.workflows.knowledge.unlearn import Selection, Unlearned


MIN_NAME_PROBABILITY = 0.8
"""Minimum probability at which a name is written to the blackboard as the category of a thing."""

GROUNDING_TIME_LIMIT = 5.0
"""Time limit in seconds for looking for one expected object."""

_THERE = re.compile(r"^(?:\w+[,:]\s*)?there(?:'s|’s|\s+(?:is|are|should be|must be))\s+\S", re.IGNORECASE)
"""Beginning of a sentence that says that something is there."""


class RobotError(DeixisError, ValueError):
    """Error for what a robot cannot do now, such as naming things before it sees any."""


@dataclass(frozen=True, eq=False, repr=False)
class Told(Answer):
    """Result of describing a layout: the lesson, what the session learned, the known roles, and those that wait.

    ``contradiction`` is the reason why the description and an earlier one of the layout cannot both hold; None if they
    can. Both count: ``show`` prints on how many tables each statement held.

    Examples
    --------
    >>> import tempfile
    >>> low, high = [[0, 0, 0], [0.1, 0, 0], [0.4, 0, 0]], [[0.03, 0.2, 0.02], [0.35, 0.25, 0.02], [0.43, 0.2, 0.02]]
    >>> with tempfile.TemporaryDirectory() as folder, Robot(folder + "/memory") as robot:
    ...     scene = robot.sees(Scene.from_boxes(low, high))
    ...     told = robot.told("layout supper; fork left of plate; knife right of plate")
    >>> told.taught, told.waiting
    (('fork', 'plate', 'knife'), ())
    """

    lesson: TableLesson
    learned: Learned
    contradiction: str | None = None

    def summary(self) -> str:
        """Return the layout, its lesson, and the numbers of roles that are known and that wait."""
        waiting = f", {len(self.waiting)} waiting" if self.waiting else ""
        known = share(len(self.taught), len(self.taught) + len(self.waiting), "role")
        doubt = "" if self.contradiction is None else f"; contradicts an earlier description: {self.contradiction}"
        return f"'{self.lesson.layout}' as lesson {self.lesson.id}: {known} known{waiting}{doubt}"

    @property
    def taught(self) -> tuple[str, ...]:
        """Roles whose things are known now."""
        return tuple(self.lesson.settled)

    @property
    def waiting(self) -> tuple[str, ...]:
        """Roles whose things are doubtful, interchangeable or not found."""
        return tuple(self.lesson.waiting)


class Robot(Closing):
    """A robot with one memory over time.

    Parameters
    ----------
    memory
        The session, or the folder of its memory.
    board
        Board to write to, for a robot whose things a tracker follows. The ids of things are then those of the board,
        and other modules write where things are, and what people say and show. By default, the robot writes all of this
        itself, to the blackboard of its memory.

    Notes
    -----
    A robot is closed when its ``with`` block ends; a later call raises MemoryFormatError. Things are identified by
    their ids in the present scene. Times are in seconds since the origin of the blackboard; None is the present. Only
    one thread at a time may call a method.

    Examples
    --------
    >>> import tempfile
    >>> from deixis.workflows.knowledge.unlearn import Selection
    >>> lower, upper = [[0, 0, 0], [0.1, 0, 0], [0.4, 0, 0]], [[0.03, 0.2, 0.02], [0.35, 0.25, 0.02], [0.43, 0.2, 0.02]]
    >>> table = Scene.from_boxes(lower, upper)
    >>> folder = tempfile.TemporaryDirectory()
    >>> robot = Robot(folder.name + "/memory")
    >>> robot.sees_a_table
    False
    >>> robot.sees(table, at=0.0) is robot.scene
    True
    >>> robot.told("layout supper; fork left of plate; knife right of plate", by="Ada", at=1.0).taught
    ('fork', 'plate', 'knife')
    >>> robot.layout(), {thing: max(names, key=names.get) for thing, names in robot.names().items()}
    ('supper', {'o1': 'fork', 'o2': 'plate', 'o3': 'knife'})
    >>> robot.look().layout, [layout.name for layout in robot.knowledge().layouts]
    ('supper', ['supper'])
    >>> robot.watches(at=2.0)
    >>> robot.sees(Scene.from_boxes(lower[:2], upper[:2]), at=3.0)
    <Scene 2 objects, 3-D boxes in m, seen from the chair>
    >>> [str(fault) for fault in robot.check()]
    ['the knife is missing']
    >>> robot.consolidate().lessons, robot.reconsider(), len(robot.diary.board.now()) > 0
    ({}, (), True)
    >>> robot.unlearn(Selection(lesson="supper-1")).lessons
    ('supper-1',)
    >>> robot.remember()
    >>> robot.layouts
    {}
    >>> robot.close()
    >>> with Robot(folder.name + "/memory") as again:
    ...     again.layouts
    {}
    >>> folder.cleanup()
    """

    @checks_arguments
    def __init__(self, memory: Session | str | Path, board: Board | None = None) -> None:
        self.session = memory if isinstance(memory, Session) else Session(memory)
        self._own: Blackboard | None = None
        self._diary = None if board is None else Diary(board, tracked=True)
        self.expected: list[ExpectedObject] = []
        self._sightings: dict[str, Sighting] = {}
        self._seen_at = 0.0
        self._known_at = 0.0  # when it last saw, or learned from a person
        self._resumed: Scene | None = None  # the last table that an earlier run kept
        self.layouts: dict[str, LearnedLayout] = {}
        self.lessons: list[TableLesson] = []
        self.unnamed: list[UnnamedKind] = []
        self._scene: Scene | None = None
        self._fullest: Scene | None = None  # of the present table, which may be laid or cleared
        self._look: Look | None = None
        self._knowledge: TableKnowledge | None = None
        if board is None and has_episodes(self.session.path):
            self._diary = self.diary
        if board is not None:
            self._remember_unnamed()
        self.remember()

    def __repr__(self) -> str:
        seen = f"{count(len(self._scene.objects), 'thing')} in view" if self._scene is not None else "no table in view"
        return f"<Robot: {seen}, {count(len(self.layouts), 'layout')} known>"

    def close(self) -> None:
        """Close the memory, and keep the present table if its layout has no name."""
        if self._fullest is not None:
            self._keep_unnamed(self._fullest)
            self._fullest = None
        if self._own is not None:
            self._own.close()
        self.session.close()

    @property
    def diary(self) -> Diary:
        """Writer of the robot's fluents, whose blackboard is opened when it is first needed."""
        if self._diary is None:
            try:
                self._own = Blackboard.open(self.session.path, create=True)
            except MemoryWriteError:  # a memory that can only be read
                self._own = Blackboard.transient()
            self._diary = Diary(ModuleBoard(self._own, RobotModule()))
            self._remember_expected()
            self._remember_unnamed()
        return self._diary

    def _require_open(self) -> None:
        """Raise MemoryFormatError if the robot is closed."""
        self.session.knowledge_store.require_usable()

    def _time(self, at: float | None) -> float:
        """Return a time in seconds, the present for None; raise an error if it is not finite or the robot is closed."""
        self._require_open()
        if at is not None and not math.isfinite(at):
            raise RobotError(f"`at` must be a finite number of seconds, got {at}")
        return self.diary.board.seconds() if at is None else at

    def remember(self) -> None:
        """Read the layouts from the memory, with the counts of all their tables.

        A new robot does this itself. Call it after another program or session has changed the memory.
        """
        from deixis.grammar.layout.parser import parse_script

        self.layouts = {}
        tables = {table.lesson: table for table in self.session.tables()}
        for table in tables.values():
            script = parse_script(table.script_text, ontology=self.session.ontology)
            seen, name = table.experience(self.session.ontology.relations), table.layout.name
            known = self.layouts.get(name, LearnedLayout(name, script))
            self.layouts[name] = known.with_table(script, seen)
        self.lessons = [lesson.revised(tables.get(lesson.id)) for lesson in self.lessons]
        if self._diary is not None:
            self._diary.refresh()
            self._remember_expected()
        self._forget_look()

    def _remember_expected(self) -> None:
        """Read the expected objects from the blackboard; those that were taken back are no longer expected."""
        assert self._diary is not None
        held = {each.statement.subject: each for each in self._diary.board.now(Pattern(predicate=EXPECTED))}
        self.expected = [one for one in self.expected if one.standing is not Standing.EXPECTED or one.id in held]
        known = {one.id for one in self.expected}
        for id, fluent in held.items():
            text, source = str(fluent.statement.object), fluent.source
            kinds = self._diary.board.now(Pattern(id, IS_A))
            script = self._as_presence(text)
            if id in known or script is None or not kinds or source.event is None:
                continue
            taken = {one.role for one in self.expected if one.event == source.event}
            roles = [role for role in introduced(script) if plain_name(role) == kinds[0].statement.object]
            for role in [each for each in roles if each not in taken][:1]:
                start = fluent.start.lower
                self.expected.append(
                    ExpectedObject(id, role, script, text, source.by, source.event, start, fluent.certainty)
                )
                others = [each for each in self._diary.board.now(Pattern(id)) if each.id != fluent.id]
                self._diary.remembered((fluent, *others))

    @checks_arguments
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
    def sees_a_table(self) -> bool:
        """True once the robot has seen a scene."""
        return self._scene is not None

    @property
    def scene(self) -> Scene:
        """The present scene.

        Raises RobotError before the first one.
        """
        if self._scene is None:
            raise RobotError("the robot must see a table first; call sees() with a scene or a cloud")
        return self._scene

    @checks_arguments
    def sees(self, scene: Scene | PointCloud | str | Path | Mapping[str, Any], at: float | None = None) -> Scene:
        """Take a scene as the present one, and look in it for expected objects.

        Parameters
        ----------
        scene
            A scene, as such, by its file or as parsed JSON; or a cloud in which the things are then detected.
        at
            Time in seconds.

        Returns
        -------
        Scene
            The scene.

        Raises
        ------
        SceneError
            If it is not a scene.
        RobotError
            If the boxes of the scene have no heights, or the time is before that of the last scene. Nothing changes
            then.
        """
        from deixis.workflows.layouts.read import as_scene

        scene = perceived(scene) if isinstance(scene, PointCloud) else as_scene(scene)
        if scene.objects and len(scene.objects[0].minimum) < 3:
            raise RobotError("`scene` must have boxes with heights, in metres, as perceive() makes them")
        seen_at = self._time(at)
        if self._scene is not None and seen_at < self._seen_at:
            if at is not None:
                raise RobotError(f"`at` must not be before the last scene at {self._seen_at:g} s, got {at:g} s")
            seen_at = self._seen_at
        if self._fullest is not None and not is_same_table(self._fullest, scene):
            self._keep_unnamed(self._fullest)
            self._fullest = None
        self._scene, self._look = scene, None
        if self._fullest is None or len(scene.objects) >= len(self._fullest.objects):
            self._fullest = scene
        self._seen_at = self._known_at = seen_at
        self.diary.saw(scene, self._seen_at)
        self._sightings = {}
        self._look_for_expected(self._seen_at)
        return scene

    @checks_arguments
    def watches(self, at: float | None = None) -> None:
        """Record that the table has been in view, without a change, since the robot last saw it.

        Parameters
        ----------
        at
            Time in seconds.
        """
        now = self._time(at)
        if self._scene is not None:
            self._look_for_expected(max(now, self._seen_at), watched=True)

    def _keep_unnamed(self, scene: Scene) -> None:
        """Keep a table with those that are alike, if no layout explains it and no person described it."""
        found = self._kind(scene)
        if found is not None:
            index, kind = found
            id = self.diary.keeps(kind.tables[-1].scene, self._seen_at)
            self.unnamed[index : index + 1] = [kind if id is None else kind.with_kept(id)]

    def _remember_unnamed(self) -> None:
        """Read the tables that an earlier run kept."""
        assert self._diary is not None
        for id, (scene, nameless) in self._diary.kept().items():
            if len(scene.objects) < MIN_THINGS or len(scene.objects[0].minimum) < 3:
                continue  # written by others
            index, kind = place_among(self.unnamed, scene, self.session.ontology, self.session.meaning())
            self.unnamed[index : index + 1] = [replace(kind.with_kept(id), asked=kind.asked or nameless)]
            self._resumed = scene

    def _kind(self, scene: Scene) -> tuple[int, UnnamedKind] | None:
        """Return the kind of a table with it, and its index in :attr:`unnamed`; None for a known one."""
        if len(scene.objects) < MIN_THINGS or any(lesson.scene is scene for lesson in self.lessons):
            return None
        if len(scene.objects[0].minimum) < 3 or (self._resumed is not None and is_same_table(self._resumed, scene)):
            return None  # without heights, or the table that an earlier run kept last
        knowledge = self.knowledge()
        look = self.look() if scene is self._scene else knowledge.look(scene)
        if look.layout is not None:
            return None
        return place_among(self.unnamed, look.scene, knowledge.ontology, knowledge.meaning)

    def knowledge(self) -> TableKnowledge:
        """Return the learned knowledge that the explanation of a table needs.

        Returns
        -------
        TableKnowledge
            The recogniser, the layouts, words and sizes.
        """
        self._require_open()
        if self._knowledge is None:
            frame = self._scene.frame if self._scene is not None else "table"
            known = self.session.view_store.known(frame)
            layouts = tuple(self.layouts[name] for name in sorted(self.layouts))
            self._knowledge = TableKnowledge(known, layouts, self.session.meaning(), self.session.ontology)
        return self._knowledge

    def look(self) -> Look:
        """Explain the present scene by what was learned.

        Returns
        -------
        Look
            The probable layouts, the names of the things, and the mistakes.
        """
        self._require_open()
        if self._look is None:
            self._look = self.knowledge().look(self.scene, self._names_shown())
            self._conclude(self._look)
        return self._look

    def _names_shown(self) -> dict[str, tuple[str, float]]:
        """Return the categories of the things of the scene that persons named, with their certainties."""
        shown = self.diary.names_shown(self.scene.ids)
        meant = self.session.category_meant
        return {thing: (meant(new_category_name(name)), certainty) for thing, (name, certainty) in shown.items()}

    def _conclude(self, look: Look) -> None:
        """Write the categories of the things, the layout and the faults to the blackboard."""
        certain = {
            (self.diary.id_of(thing), IS_A, best): min(shares[best], 1.0)
            for thing, shares in look.names.items()
            for best in list(shares)[:1]
            if shares[best] >= MIN_NAME_PROBABILITY
        }
        found = {*certain, *(("table", FAULT, str(fault)) for fault in look.faults())}
        if look.layout is not None:
            found.add(("table", LAYOUT, look.layout))
            certain["table", LAYOUT, look.layout] = min(look.layouts[look.layout], 1.0)
        self.diary.concluded(found, (IS_A, LAYOUT, FAULT), self._known_at, certain)

    def names(self) -> Mapping[str, Mapping[str, float]]:
        """Return the names that each thing may have, with their probabilities.

        Returns
        -------
        mapping
            Probability by name, by id of the thing.
        """
        return self.look().names

    def layout(self) -> str | None:
        """Return the name of the layout of the present table.

        Returns
        -------
        str or None
            Name of the most probable layout; None if probably no known layout explains the table.
        """
        return self.look().layout

    @checks_arguments
    def check(self, layout: str | None = None) -> tuple[Fault, ...]:
        """Return what is wrong with the present table.

        Parameters
        ----------
        layout
            Name of the layout to compare with; None for that of the present table.

        Returns
        -------
        tuple of Fault
            The mistakes.

        Raises
        ------
        RobotError
            If there is no layout of that name.
        """
        self._require_open()
        if layout is not None and layout not in self.layouts:
            known = ", ".join(sorted(self.layouts)) or "none"
            raise RobotError(f"`layout` must be a layout that the robot knows, got '{layout}'; there are: {known}")
        return self.look().faults(layout)

    # ---- being taught

    @checks_arguments
    def shown(
        self, label: str, thing: str, by: str = "user", at: float | None = None, event: str | None = None
    ) -> Taught:
        """Learn the look of a thing that a person points at and names.

        Parameters
        ----------
        label
            Name of the thing.
        thing
            Id of the thing in the present scene.
        by
            Name of the person.
        at
            Time in seconds.
        event
            Id on the blackboard of the gesture or of what was said; a new one if None.

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
        category = self.session.category_meant(new_category_name(label))
        now, event = max(self._known_at, self._time(at)), self.diary.event(event, "gesture")
        with self.diary.collected() as changes:
            self.diary.shown(thing, category, by, now, event)
        named = None if event is None else event_of(self.diary.board.origin, event)
        taught = self.session.teach(self.scene, thing, category, by, settles, named, self._part(changes))
        for lesson, role in pointed:
            self._settle(lesson, role, Settled(thing, SettledBy.POINTING, 1.0))
        self._known_at = now
        self._forget_look()
        return taught

    def _part(self, changes: Sequence[Change]) -> Part | None:
        """Return changes of the blackboard as a part of a write over all stores; None for no changes."""
        return self.diary.board.part(*changes) if changes else None

    @overload
    def told(self, text: Script, by: str = ..., at: float | None = ..., event: str | None = ...) -> Told: ...

    @overload
    def told(
        self, text: str, by: str = ..., at: float | None = ..., event: str | None = ...
    ) -> Told | KeptElsewhere | tuple[ExpectedObject, ...]: ...

    @checks_arguments
    def told(
        self, text: str | Script, by: str = "user", at: float | None = None, event: str | None = None
    ) -> Told | KeptElsewhere | tuple[ExpectedObject, ...]:
        """Learn the layout that a text describes from the present table, or expect the objects that it introduces.

        *There is a red ball on the left* states what is present. The robot expects each object that such a text
        introduces until it sees a thing that fits, or has seen the place empty for long enough (:attr:`expected`).
        *The cups belong in the kitchen* tells where things are kept away from the table: it is noted as something that
        was said, and no layout is learned from it. The id of a thing in view (*t2 is right of the plate*) stands for
        its name, and the role of that name is this thing.

        Parameters
        ----------
        text
            A script in the layout language or in English, as text or parsed. A parsed script is always a layout.
        by
            Name of the person.
        at
            Time in seconds.
        event
            Id on the blackboard of what was said; a new one if None.

        Returns
        -------
        Told, KeptElsewhere or tuple of ExpectedObject
            The lesson, with the roles that are known and those that wait; where things are kept; or the expected
            objects, some of which may be seen already.

        Raises
        ------
        ScriptError
            If the text is not understood.
        IdError
            If it has the id of a thing that is not in view or has no name.
        RobotError
            If it describes a layout before the robot has seen a table.
        """
        if isinstance(text, str) and not text.strip():
            raise RobotError("`text` must describe a layout, got a blank text; describe how the table is laid")
        if isinstance(text, str) and text.rstrip().endswith("?"):
            raise RobotError("`text` must describe a layout or objects, got a question; ask `session.recall`")
        spoken, meant = text, {}
        if isinstance(text, str) and self._scene is not None:
            named = with_names(text, self._scene.ids, self.session.ontology, self._name_of)
            text, meant = named.text, named.things
        if isinstance(text, str) and (presence := self._as_presence(text)) is not None:
            return self._expect_objects(presence, text, str(spoken), by, self._time(at), event)
        script = text if isinstance(text, Script) else self._layout(text)
        if isinstance(text, str) and script.name is None:
            kept = kept_elsewhere(script, self.session.ontology)
            if kept is not None:
                self.diary.heard(str(spoken), by, self._time(at), self.diary.event(event, "sentence"))
                return kept
        seen = self.knowledge().recognised(self.scene)
        names = {thing: category for category, thing in meant.items()}
        things = tuple(replace(each, label=names.get(each.id, each.label)) for each in seen.objects)
        seen = replace(seen, objects=things) if names else seen
        words = spoken if isinstance(spoken, str) else script.reading.text if script.reading else format_script(script)
        now, event = self._time(at), self.diary.event(event, "sentence")
        earlier = self.layouts.get(layout_name(script))
        with self.diary.collected() as changes:
            self.diary.heard(words, by, now, event)
        learned = self.session.learn(
            script, seen, teacher=by, events=() if event is None else (event,), episodes=lambda _: self._part(changes)
        )
        self._known_at = max(self._known_at, now)
        contradiction = None if earlier is None else earlier.contradiction(script)
        lesson = self._learned(script, self.scene, learned)
        return Told(self._settle_named(lesson, meant, by), learned, contradiction)

    def _name_of(self, thing: str) -> str | None:
        """Return the category of a thing of the present scene, or None if it is not known well enough."""
        shares = self.names().get(thing, {})
        best = max(shares, key=lambda name: shares[name], default=None)
        if best is not None and shares[best] >= MIN_NAME_PROBABILITY:
            return best
        seen = self.scene[thing]  # a thing that the known layouts do not explain may have a label
        labelled = seen.label is not None and seen.confidence >= MIN_NAME_PROBABILITY
        return new_category_name(seen.label) if labelled and seen.label is not None else None

    def _settle_named(self, lesson: TableLesson, meant: Mapping[str, str], by: str) -> TableLesson:
        """Settle the roles of a lesson whose things a person named by their ids."""
        for category, thing in meant.items():
            roles = [role for role in lesson.roles if plain_name(role) == category]
            known = [role for role in roles if (each := lesson.settled.get(role)) is not None and each.thing == thing]
            if not roles or known:
                continue
            if lesson.scene[thing].cloud is not None:
                self.session.teach(lesson.scene, thing, category, by, (lesson.id, roles[0]))
            lesson = self._settle(lesson, roles[0], Settled(thing, SettledBy.POINTING, 1.0))
        return lesson

    def _layout(self, text: str) -> Script:
        """Return the layout that a text describes, with the name that the text gives it."""
        from deixis.workflows.layouts.read import read_layout_or_english

        name, rest = named_layout(text)
        script = read_layout_or_english(rest, self.session.ontology)
        return script if name is None else replace(script, name=name)

    def _as_presence(self, text: str) -> Script | None:
        """Return a text as a script, if it is English about objects that are there."""
        from deixis.grammar.layout.parser import parse_script
        from deixis.workflows.layouts.read import read_script

        if named_layout(text)[0] is not None:
            return None
        try:
            parse_script(text, ontology=self.session.ontology)
            return None
        except ScriptError:
            pass
        plain = text.strip().rstrip(".!")
        # a sentence that says no place means anywhere on the table
        for words in (text, f"{plain} on the table.") if _THERE.match(plain) else (text,):
            try:
                script = read_script(text=words, ontology=self.session.ontology, english=True)
            except ScriptError:
                continue
            absent = () if script.reading is None else script.reading.absent
            return script if introduced(script) or (absent and not script.objects) else None
        return None

    def _expect_objects(
        self, script: Script, text: str, spoken: str, by: str, at: float, event: str | None
    ) -> tuple[ExpectedObject, ...]:
        """Expect the objects that a sentence introduces, and do not expect those that it says are absent.

        ``text`` has the names of things, where ``spoken`` may have their ids.
        """
        event = event or self.diary.board.new_id("sentence")
        absent = script.reading.absent if script.reading is not None else ()
        known = [
            one.contradicted(f"{by} said that it is not there")
            if one.standing is Standing.EXPECTED and one.name in map(plain_name, absent)
            else one
            for one in self.expected
        ]
        new = [
            ExpectedObject(self.diary.board.new_id("e"), role, script, text, by, event, at)
            for role in introduced(script)
        ]
        with self.diary.as_one():
            self.diary.heard(spoken, by, at, event)
            for before, one in zip(self.expected, known, strict=True):
                if one is not before:
                    self.diary.looked_for(one, at)
            self.diary.expects(new, self._landmarks(script))
        self.expected = [*known, *new]
        if self._scene is not None:
            self._look_for_expected(at, new)
        return tuple(self.expected[len(known) :])

    def _landmarks(self, script: Script) -> dict[str, str]:
        """Return the ids on the blackboard of the objects of a sentence that have certainly been seen."""
        if self._scene is None or not script.objects:
            return {}
        found = self.session.ground(script, self.knowledge().recognised(self.scene), time_limit=GROUNDING_TIME_LIMIT)
        new = introduced(script)
        return {
            role: self.diary.id_of(match.perceived)
            for role, match in found.object_matches.items()
            if role not in new and (match.probability or 0.0) >= MIN_MATCH_PROBABILITY
        }

    def _look_for_expected(self, at: float, among: Sequence[ExpectedObject] = (), watched: bool = False) -> None:
        """Look at the present scene for expected objects; ``watched`` if it was in view since the last look."""
        for one in among or tuple(self.expected):
            if one.standing is not Standing.EXPECTED:
                continue
            since = math.inf if one.looked is None else at - one.looked
            looks = (
                0 if since < LOOK_INTERVAL else int(since / LOOK_INTERVAL) if watched and one.looked is not None else 1
            )
            if one.id not in self._sightings:
                self._sightings[one.id] = self._sighting(one)
            new = one.after(self._sightings[one.id], at, looks)
            if new is not one:
                self.expected[self.expected.index(one)] = new
                self.diary.looked_for(new, at)

    def _sighting(self, one: ExpectedObject) -> Sighting:
        """Return how an expected object looks in the present scene.

        Things that may be any of several objects of one sentence (*two forks*) are listed for each of these objects.
        """
        knowledge = self.knowledge()
        scene = knowledge.recognised(self.scene)
        found = self.session.ground(one.script, scene, time_limit=GROUNDING_TIME_LIMIT)
        same_name = [role for role in introduced(one.script) if plain_name(role) == one.name]
        shares: dict[str, float] = {}
        matched = [match for match in found.object_matches.values() if match.object in same_name]
        for match in matched:
            shares[match.perceived] = shares.get(match.perceived, 0.0) + (match.probability or 0.0)
        others = [each for match in matched for each in match.alternatives]
        others += [each for left in found.unmatched_objects if left.name in same_name for each in left.alternatives]
        for other in others:
            if other.perceived is not None:
                shares[other.perceived] = shares.get(other.perceived, 0.0) + (other.probability or 0.0)
        taken = {each.thing for each in self.expected if each.standing is Standing.SEEN}
        free = [thing for thing in shares if self.diary.id_of(thing) not in taken]
        best = max(free, key=lambda thing: shares[thing], default=None)
        places = places_of(one.script, one.role, scene, knowledge.meaning)
        in_view = places.share_in_view if places is not None else 0.0 if scene.objects else 1.0
        if best is None or (found.fits is not None and found.fits < 0.5):
            return Sighting(None, 0.0, False, in_view)
        fits_place = places is None or places.may_be_at(scene[best])
        return Sighting(self.diary.id_of(best), shares[best], fits_place, in_view)

    def _learned(self, script: Script, scene: Scene, learned: Learned) -> TableLesson:
        """Add a lesson of the memory to the robot's lessons, and its table to the layout."""
        layout = LearnedLayout.told(script)
        name = layout.name
        lesson = TableLesson.of(len(self.lessons), name, scene, learned.grounding, learned.lesson.id)
        self.lessons.append(lesson)
        self.layouts[name] = self.layouts.get(name, layout).with_table(script, self._experience(lesson))
        self._forget_look()
        return lesson

    def consolidate(self) -> Consolidation:
        """Learn from the finished experiences on the blackboard, each once.

        An experience with a description is a lesson, which adds to the counts of its layout. If nothing was said in an
        experience and no layout explains its table, the table is kept with those that are like it.

        Returns
        -------
        Consolidation
            The lessons, and the reasons why other experiences taught nothing.
        """
        self._require_open()
        return consolidate(self.diary.board, _RobotLearner(self), RobotModule.name, self._keep_unnamed)

    # ---- what waits

    @property
    def questions(self) -> tuple[Question, ...]:
        """Questions about the present table whose information is worth their cost, the most informative first."""
        self._require_open()
        questions = [each for lesson in self.lessons if lesson.scene is self._scene for each in lesson.questions()]
        informative = [question for question in questions if question.gain > QUESTION_COST]
        return tuple(sorted(informative, key=lambda question: -question.gain))

    @property
    def layout_question(self) -> LayoutQuestion | None:
        """Question for the name of a layout that came up several times without a name; None if there is no question."""
        self._require_open()
        found = None if self._scene is None else self._kind(self._scene)
        if found is None or len(found[1].tables) < MIN_TABLES or found[1].asked:
            return None
        return LayoutQuestion(found[1])

    @checks_arguments
    def name_layout(
        self, question: LayoutQuestion, name: str | None, by: str = "user", event: str | None = None
    ) -> tuple[TableLesson, ...]:
        """Name a layout that came up several times, and learn it from all of its tables.

        Parameters
        ----------
        question
            The question.
        name
            Name of the layout; None if it has no name, so that the robot does not ask again.
        by
            Name of the person who answers.
        event
            Id on the blackboard of the answer; a new one if None.

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

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> lower = [[0, 0, 0], [0.1, 0, 0], [0.4, 0, 0], [0.1, 0.3, 0]]
        >>> upper = [[0.03, 0.2, 0.02], [0.35, 0.25, 0.02], [0.43, 0.2, 0.02], [0.2, 0.4, 0.1]]
        >>> folder = tempfile.TemporaryDirectory()
        >>> robot = Robot(folder.name + "/memory")
        >>> for shift in (0.0, 0.02, 0.04):
        ...     table = robot.sees(Scene.from_boxes(np.add(lower, shift), np.add(upper, shift)))
        >>> robot.layout_question.text
        'I have seen 3 tables like this; what is it called?'
        >>> [lesson.layout for lesson in robot.name_layout(robot.layout_question, "supper")]
        ['supper', 'supper', 'supper']
        >>> robot.close()
        >>> folder.cleanup()
        """
        self._require_open()
        kind = question.kind
        kept = [table.kept for table in kind.tables if table.kept is not None]
        index = next((n for n, known in enumerate(self.unnamed) if known.layout.script is kind.layout.script), None)
        event = event or self.diary.board.new_id("sentence")
        if name is None:
            self.diary.named(kept, None, by, self._time(None), event)
            if index is not None:
                self.unnamed[index] = replace(self.unnamed[index], asked=True)
            return ()
        script = kind.script(category_name(name), self.session.ontology)
        examples = [(script, table.labelled) for table in kind.tables]
        with self.diary.collected() as changes:
            self.diary.named(kept, script.name, by, self._time(None), event)
        learned = self.session.learn_all(
            examples, teacher=by, events=(event,) if changes else (), episodes=lambda _: self._part(changes)
        )
        lessons = [self._learned(script, table.scene, one) for table, one in zip(kind.tables, learned, strict=True)]
        if index is not None:
            del self.unnamed[index]
        return tuple(lessons)

    @checks_arguments
    def answers(self, question: Question, thing: str | None, by: str = "user") -> None:
        """Take the answer to a question, and learn from it which thing the role is, and how the thing looks.

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
            If the scene has no such thing, or the role no longer waits.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from deixis.perception.scene import PerceivedObject
        >>> points = np.random.default_rng(1).random((300, 3)) * (0.03, 0.2, 0.02)
        >>> things = []
        >>> for id, x, width in (("o1", 0, 1), ("o2", 0.05, 1), ("o3", 0.1, 8)):
        ...     cloud = PointCloud((points * (width, 1, 1) + (x, 0, 0)).astype(np.float32))
        ...     things.append(PerceivedObject(id, (x, 0, 0), (x + width * 0.03, 0.2, 0.02), cloud=cloud))
        >>> folder = tempfile.TemporaryDirectory()
        >>> robot = Robot(folder.name + "/memory")
        >>> table = robot.sees(Scene(tuple(things)))
        >>> robot.shown("plate", "o3").category
        'plate'
        >>> robot.told("layout supper; fork left of plate; spoon left of plate").waiting
        ('fork', 'spoon')
        >>> question = robot.questions[0]
        >>> robot.answers(question, "o2")
        >>> robot.lessons[0].settled[question.role].thing, [each.role for each in robot.questions]
        ('o2', ['fork'])
        >>> robot.close()
        >>> folder.cleanup()
        """
        self._require_open()
        lesson = self.lessons[question.lesson]
        if question.role not in lesson.waiting:
            raise RobotError(f"`question` must be about a role that still waits, and '{question.role}' does not")
        if thing is None:
            self._settle(lesson, question.role, None)
            return
        if thing not in lesson.scene.ids:
            raise RobotError(
                f"`thing` must be a thing of the scene, got '{thing}'; there are: {', '.join(lesson.scene.ids)}"
            )
        self.session.teach(lesson.scene, thing, plain_name(question.role), by, (lesson.id, question.role))
        self._settle(lesson, question.role, Settled(thing, SettledBy.ANSWER, 1.0))

    def reconsider(self) -> tuple[tuple[int, str], ...]:
        """Explain the tables of all lessons again with what was learned since, and learn what has become clear.

        A name that came from words or hindsight only is corrected if it now clearly belongs to another thing.

        Returns
        -------
        tuple of tuple
            Number of the lesson and name of the role, for each view that was learned.
        """
        self._require_open()
        done = []
        for number in range(len(self.lessons)):
            lesson = self.lessons[number]
            layout = self.layouts.get(lesson.layout)
            if layout is None:  # it was taken back
                continue
            knowledge = self.knowledge()
            seen = knowledge.recognised(lesson.scene)
            found = explain(layout.evidence(seen, knowledge.ontology, knowledge.meaning))
            for index, role in enumerate(layout.roles):
                known = lesson.settled.get(role)
                if role not in lesson.waiting and known is None:
                    continue
                if known is not None and known.by in (SettledBy.ANSWER, SettledBy.POINTING):
                    continue
                best = int(found.roles_of[index].argmax())
                share, thing = float(found.roles_of[index, best]), lesson.scene.ids[best]
                if share < MIN_SETTLED_PROBABILITY or (known is not None and known.thing == thing):
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


class _RobotLearner:
    """Adapter that lets a consolidation learn with a robot instead of a session."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self.ontology = robot.session.ontology
        self.remembers, self.layouts = robot.session.remembers, robot.session.layouts
        self.has_views, self.categories = robot.session.has_views, robot.session.categories
        self.lessons_of_events = robot.session.lessons_of_events

    def learn(
        self, script: Script, scene: Scene, *, events: Sequence[str] = (), episodes: Recording | None = None
    ) -> Learned:
        """Learn a layout from a table, with the counts of its layout."""
        learned = self._robot.session.learn(script, scene, events=events, episodes=episodes)
        self._robot._learned(script, scene, learned)
        return learned


def perceived(cloud: PointCloud, frame: NDArray[np.float64] | None = None) -> Scene:
    """Detect the things in a cloud, and join the parts of a thing whose middle another thing hides.

    Parameters
    ----------
    cloud
        The cloud, in metres.
    frame
        Known transform (4, 4) from the frame of the cloud to that of the table, or None.

    Returns
    -------
    Scene
        The scene in the frame of the table.
    """
    from deixis.perception.clouds.smoothing import smoothed
    from deixis.perception.detection.settings import DetectionSettings
    from deixis.perception.occlusion import joined_behind_others
    from deixis.workflows.scenes.perceive import perceive

    known = None if frame is None else tuple(map(tuple, frame.tolist()))
    return joined_behind_others(perceive(smoothed(cloud), settings=DetectionSettings(frame=known)))
