"""The robot's fluents on the blackboard: what it saw, what people told and showed it, and what it concluded.

Each fluent says how it became known: seen by the robot, shown or said by a person, or inferred. What was said about an
expected object holds until the object is seen (``sameAs`` then names the thing) or contradicted.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import ClassVar

import numpy as np

from deixis.errors import DeixisError
from deixis.memory.episodes.fluents.changes import Add, Change, Finish, Update
from deixis.memory.episodes.fluents.episode import MAX_TEXT, EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.predicates import AT, CALLED, CONTRADICTED, EXPECTED, IS_A, LAYOUT, SAID, SAME_AS
from deixis.ontology.strict_json import parse_json
from deixis.perception.formats.scene_json import read_scene, scene_to_dict
from deixis.perception.scene import Scene
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern
from deixis.robot.expected import ExpectedObject, Standing
from deixis.robot.modules import Board, Module

UNNAMED, NAMELESS = "unnamed", "nameless"
"""Predicates of tables whose layout has no name: the scene, and that a person gave no name for it."""

SAME_PLACE = 0.01
"""Distance in metres up to which a thing is where it was."""

MIN_DURATION = 1e-3
"""Minimum duration of a fluent in seconds."""

Found = tuple[str, str, str]
"""A statement: subject, predicate and object."""


class RobotModule(Module):
    """The robot as a writer on the blackboard, where it is not a module of a runtime."""

    name: ClassVar[str] = "robot"
    writes: ClassVar[tuple[Pattern, ...]] = (ANYTHING,)


class Diary:
    """Writer of one robot's fluents.

    Parameters
    ----------
    board
        The board on which the robot may write.
    tracked
        True if the ids of things are those of the blackboard, where a tracker writes their places, and what persons
        say and show is written by others too.
    """

    def __init__(self, board: Board, tracked: bool = False) -> None:
        self.board, self._tracked = board, tracked
        self._collected: list[Change] | None = None  # changes that will be written as one
        self._found: dict[Found, EpisodicFluent] = {}  # conclusions that hold, by statement
        self._ids: dict[str, str] = {}  # ids on the blackboard by those of the present scene
        self._places: dict[str, EpisodicFluent] = {}  # by id on the blackboard
        self._expected: dict[str, list[EpisodicFluent]] = {}  # by expected object, the words first
        earlier: list[Change] = []
        for each in board.now():
            statement, source = each.statement, each.source
            if source.by != RobotModule.name or statement.object is None or source.event is not None:
                continue
            if tracked and source.origin is Origin.INFERRED:  # about the things of an earlier run
                earlier.append(_end(each, board.seconds()))
            elif statement.predicate == AT:
                self._places[statement.subject] = each
            elif source.origin is Origin.INFERRED:
                self._found[statement.subject, statement.predicate, statement.object] = each
        if earlier:
            board.write(*earlier)

    @contextmanager
    def collected(self) -> Iterator[list[Change]]:
        """Collect the changes of a block instead of writing them.

        Yields
        ------
        list of Change
            The changes so far, which the caller writes after the block.
        """
        outer, self._collected = self._collected, []
        try:
            yield self._collected
        finally:
            self._collected = outer

    @contextmanager
    def as_one(self) -> Iterator[None]:
        """Write all that a block writes as one, at its end: all of it or, if it is refused, nothing.

        Yields
        ------
        None
            Nothing.
        """
        found, expected = dict(self._found), dict(self._expected)
        try:
            with self.collected() as changes:
                yield
            self._write(*changes)
        except BaseException:
            self._found, self._expected = found, expected
            raise

    def _write(self, *changes: Change) -> None:
        """Write changes as one, or collect them."""
        if self._collected is not None:
            self._collected.extend(changes)
        elif changes:
            self.board.write(*changes)

    def refresh(self) -> None:
        """Forget the fluents that were taken back from the blackboard."""
        held = {each.id for each in self.board.now()}
        self._found = {statement: each for statement, each in self._found.items() if each.id in held}
        self._places = {id: each for id, each in self._places.items() if each.id in held}
        left = {id: [each for each in fluents if each.id in held] for id, fluents in self._expected.items()}
        self._expected = {id: fluents for id, fluents in left.items() if fluents}

    def id_of(self, thing: str) -> str:
        """Return the id on the blackboard of a thing of the present scene.

        Parameters
        ----------
        thing
            Its id in the scene.

        Returns
        -------
        str
            Its id on the blackboard.
        """
        return self._ids.get(thing, thing)

    # ---- seeing

    def saw(self, scene: Scene, at: float) -> None:
        """Write which things came, went and stayed, unless a tracker writes it.

        A thing is one of the previous scene if it lies where that one lay.

        Parameters
        ----------
        scene
            The present scene.
        at
            Time in seconds.
        """
        if self._tracked:
            return
        from scipy.optimize import linear_sum_assignment

        known = list(self._places)
        stayed: dict[str, str] = {}
        if known and scene.objects:
            boxes = np.array([json.loads(each.statement.object or "") for each in self._places.values()])
            distances = np.abs(scene.boxes.reshape(-1, 1, 6) - boxes[None]).max(axis=2)
            for new, old in zip(*linear_sum_assignment(distances), strict=True):
                if distances[new, old] <= SAME_PLACE:
                    stayed[scene.ids[new]] = known[old]
        gone = set(known) - set(stayed.values())
        changes: list[Change] = [_end(self._places[id], at) for id in sorted(gone)]
        changes += [_end(each, at) for id in sorted(gone) for each in self.board.now(Pattern(id, IS_A))]
        places = {id: each for id, each in self._places.items() if id not in gone}
        for thing in scene.objects:
            if thing.id not in stayed:
                id = stayed[thing.id] = self.board.new_id("t")
                box = json.dumps([round(value, 4) for value in (*thing.minimum, *thing.maximum)])
                seen = Source(Origin.SEEN, RobotModule.name)
                place = places[id] = self._fluent((id, AT, box), at, seen)
                changes.append(Add(place))
                if thing.label is not None:
                    changes.append(Add(self._fluent((id, IS_A, thing.label), at, seen, thing.confidence)))
        self._write(*changes)
        self._ids, self._places = stayed, places
        self._found = {statement: each for statement, each in self._found.items() if statement[0] not in gone}

    # ---- being taught

    def event(self, event: str | None, kind: str) -> str | None:
        """Return the id of what a person says or shows now.

        Parameters
        ----------
        event
            Its id, if another module wrote it.
        kind
            Beginning of a new id, such as ``sentence``.

        Returns
        -------
        str or None
            The id; None if other modules write what persons say, and none did.
        """
        return event if event is not None or self._tracked else self.board.new_id(kind)

    def heard(self, text: str, by: str, at: float, event: str | None) -> None:
        """Write what a person said, unless another module did.

        Parameters
        ----------
        text
            The words.
        by
            Name of the person.
        at
            Time in seconds.
        event
            Id of the sentence.
        """
        if not self._tracked:
            source = Source(Origin.SAID, by, event)
            self._write(Add(self._fluent((by, SAID, " ".join(text.split())), at, source, finish=at + MIN_DURATION)))

    def shown(self, thing: str, label: str, by: str, at: float, event: str | None) -> None:
        """Write that a person showed what a thing is, unless another module did; an earlier showing of it ends.

        Parameters
        ----------
        thing
            Id of the thing in the present scene.
        label
            Its category.
        by
            Name of the person.
        at
            Time in seconds.
        event
            Id of the gesture.
        """
        if self._tracked:
            return
        id = self.id_of(thing)
        before = [each for each in self.board.now(Pattern(id, IS_A)) if each.source.origin is Origin.SHOWN]
        shown = self._fluent((id, IS_A, label), at, Source(Origin.SHOWN, by, event))
        self._write(*(_end(each, at) for each in before), Add(shown))

    def names_shown(self, things: Collection[str]) -> dict[str, tuple[str, float]]:
        """Return the names that persons gave to things of the present scene, each with its certainty.

        Parameters
        ----------
        things
            Ids of the things in the scene.

        Returns
        -------
        dict
            The last name that each thing was given, by its id in the scene.
        """
        given = self.board.now(Pattern(predicate=CALLED if self._tracked else IS_A))
        last = {
            each.statement.subject: (each.statement.object, each.certainty)
            for each in sorted(given, key=lambda each: each.start.lower)
            if each.source.origin is Origin.SHOWN and each.statement.object is not None
        }
        return {thing: last[id] for thing in things if (id := self.id_of(thing)) in last}

    # ---- conclusions

    def concluded(
        self, found: Collection[Found], predicates: Collection[str], at: float, certainties: Mapping[Found, float]
    ) -> None:
        """Write the present conclusions with some predicates, and end the earlier ones that no longer hold.

        Parameters
        ----------
        found
            The statements, with ids of the blackboard.
        predicates
            Predicates of which everything else ends.
        at
            Time in seconds.
        certainties
            Probability of a statement, if it is not certain.
        """
        ended = [key for key in self._found if key[1] in predicates and key not in found]
        source = Source(Origin.INFERRED, RobotModule.name)
        new = {
            statement: self._fluent(statement, at, source, certainties.get(statement, 1.0))
            for statement in sorted(set(found) - self._found.keys())
        }
        self._write(*(_end(self._found[key], at) for key in ended), *map(Add, new.values()))
        self._found = {key: each for key, each in self._found.items() if key not in ended} | new

    # ---- expected objects

    def expects(self, objects: Collection[ExpectedObject], landmarks: Mapping[str, str]) -> None:
        """Write what a sentence said about objects that are expected.

        Parameters
        ----------
        objects
            The objects of one sentence.
        landmarks
            Id on the blackboard of other objects that the sentence names, as far as they are known.
        """
        names = {one.role: one.id for one in objects} | dict(landmarks)
        added: dict[str, list[EpisodicFluent]] = {}
        for one in objects:
            source = Source(Origin.SAID, one.by, one.event)
            properties = [(name, value and names.get(value, value)) for name, value in one.properties]
            for predicate, value in ((EXPECTED, " ".join(one.text.split())), (IS_A, one.name), *properties):
                certainty = one.probability if predicate == EXPECTED else 1.0
                fluent = self._fluent((one.id, predicate, value), one.since, source, certainty)
                added.setdefault(one.id, []).append(fluent)
        self._write(*(Add(each) for fluents in added.values() for each in fluents))
        self._expected |= added

    def remembered(self, fluents: Collection[EpisodicFluent]) -> None:
        """Take over fluents of expected objects that an earlier run wrote.

        Parameters
        ----------
        fluents
            Fluents that hold, whose subjects are expected objects; the fluent of :data:`EXPECTED` first for each.
        """
        for each in fluents:
            self._expected.setdefault(each.statement.subject, []).append(each)

    def looked_for(self, one: ExpectedObject, at: float) -> None:
        """Write how the standing of an expected object changed.

        Parameters
        ----------
        one
            The object.
        at
            Time in seconds.
        """
        fluents = self._expected.get(one.id, [])
        if not fluents:
            return
        if one.standing is Standing.EXPECTED:
            self._write(Update(fluents[0].id, certainty=one.probability))
            return
        changes: list[Change] = [_end(each, at) for each in fluents]
        source = Source(Origin.INFERRED, RobotModule.name, one.event)
        if one.standing is Standing.SEEN and one.thing is not None:
            thing = self.id_of(one.thing)
            found = ((one.id, SAME_AS, thing), (thing, IS_A, one.name))
            changes += [Add(self._fluent(statement, at, source, one.probability)) for statement in found]
        else:
            changes.append(Add(self._fluent((one.id, CONTRADICTED, one.reason), at, source)))
        self._write(*changes)
        del self._expected[one.id]

    # ---- tables without a name

    def keeps(self, scene: Scene, at: float) -> str | None:
        """Write a table whose layout has no name, without clouds.

        Parameters
        ----------
        scene
            The table, with recognised names.
        at
            Time in seconds.

        Returns
        -------
        str or None
            Its id; None for one that is too large for the blackboard.
        """
        bare = replace(scene, objects=tuple(replace(thing, cloud=None) for thing in scene.objects))
        text = json.dumps(scene_to_dict(bare))
        if len(text) > MAX_TEXT:
            return None
        id = self.board.new_id("table")
        self._write(Add(self._fluent((id, UNNAMED, text), at, Source(Origin.SEEN, RobotModule.name))))
        return id

    def kept(self) -> dict[str, tuple[Scene, bool]]:
        """Return the tables whose layout has no name, in the order seen.

        Returns
        -------
        dict
            The table, and whether a person gave no name for it, by id.
        """
        nameless = {each.statement.subject for each in self.board.now(Pattern(predicate=NAMELESS))}
        found = self.board.now(Pattern(predicate=UNNAMED))
        scenes = {each.statement.subject: _scene_of(each.statement.object) for each in found}
        return {id: (scene, id in nameless) for id, scene in scenes.items() if scene is not None}

    def named(self, tables: Collection[str], name: str | None, by: str, at: float, event: str | None) -> None:
        """Write that a person named the layout of tables, or gave no name for it.

        Parameters
        ----------
        tables
            Ids of the tables.
        name
            Name of the layout; None if it has none.
        by
            Name of the person.
        at
            Time in seconds.
        event
            Id of the answer.
        """
        source = Source(Origin.SAID, by, event)
        predicate = NAMELESS if name is None else LAYOUT
        changes: list[Change] = [Add(self._fluent((id, predicate, name), at, source)) for id in tables]
        if name is not None:
            changes += [_end(each, at) for id in tables for each in self.board.now(Pattern(id, UNNAMED))]
        self._write(*changes)

    def _fluent(
        self,
        statement: tuple[str, str, str | None],
        start: float,
        source: Source,
        certainty: float = 1.0,
        finish: float | None = None,
    ) -> EpisodicFluent:
        id = self.board.new_id("f")
        certain = min(max(certainty, 1e-6), 1.0)
        return episodic(id, statement, start=start, finish=finish, certainty=certain, source=source)


def _end(fluent: EpisodicFluent, at: float) -> Change:
    """Return the end of a fluent at a time, or shortly after its start if that is later."""
    return Finish(fluent.id, max(at, fluent.started_by + MIN_DURATION))


def _scene_of(text: str | None) -> Scene | None:
    """Return the scene in a text; None for one that has no scene, as others may have written it."""
    try:
        return read_scene(parse_json(text or "", "<table>", DeixisError, no_number=None))
    except DeixisError:
        return None
