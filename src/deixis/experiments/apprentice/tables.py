"""Tables with known mistakes: a layout is laid by the simulator, and then some of its things are tampered with.

Only things that support no other thing are missing, displaced, swapped or turned, so that each counts as one mistake. A
displaced thing clearly violates a fact of its layout by its new place; a turned one violates none by its box's place;
two swapped things are of different kinds, fit in each other's place, and clearly violate a fact there; an extra
thing stands free. The violated fact relates the thing to one that is in its place on the finished table: if both things
of a fact were moved, it would not tell which one is wrong. Nothing lies across other things by mistake.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.grammar.script import Script
from deixis.ontology.things.kinds import plain_name
from deixis.perception.simulator.laying import LaidTable, LaidThing, Placement, lay, top_under
from deixis.perception.simulator.meshes.tableware import make
from deixis.reasoning.comparison.explanation import MistakeKind
from deixis.reasoning.entailment.realisation.verification import facts_that_hold
from deixis.workflows.layouts.lay_table import LaidScript, lay_script

Array = NDArray[np.float64]

GAP = 0.012
"""Minimum distance in metres between a tampered thing and others."""

MIN_DISPLACEMENT = 0.10
"""Minimum distance in metres by which a thing is displaced."""

CLEAR = 0.03
"""Distance in metres by which a displaced thing could be moved on without a violated fact holding again."""

BEYOND = 0.12
"""Distance in metres beyond the laid things within which displaced and extra things are put."""

QUARTER = (np.deg2rad(60.0), np.deg2rad(120.0))
"""Angles between which a thing is turned."""

MAX_SHIFT = 0.08
"""Maximum distance in metres by which a turned thing is moved, so that it fits."""

LONG = 2.0
"""Minimum ratio of length to width at which a thing can be turned by mistake."""

TRIES = 60
"""Number of places tried for a mistake before another one is drawn."""

MAX_MISTAKES = 3

EXTRAS = ("mug", "bottle", "bowl", "fork", "dessert spoon", "butter knife", "wine glass", "saucer", "napkin", "cup")
"""Kinds of the extra things."""


@dataclass(frozen=True, slots=True)
class TrueMistake:
    """A mistake that was made: its kind, and the names of the things that it is about."""

    kind: MistakeKind
    names: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Tampered:
    """A laid table, the mistakes on it, and which of its things are extra."""

    laid: LaidScript
    mistakes: tuple[TrueMistake, ...]

    @property
    def extra(self) -> frozenset[str]:
        """Names of the extra things."""
        return frozenset(name for one in self.mistakes if one.kind is MistakeKind.EXTRA for name in one.names)


def lay_tampered(script: Script, seed: int, mistakes: int | None = None) -> Tampered:
    """Lay a table as a layout says, and make mistakes.

    Parameters
    ----------
    script
        The layout.
    seed
        Seed of the table and the mistakes.
    mistakes
        Number of mistakes; None to draw it from 0 to ``MAX_MISTAKES``.

    Returns
    -------
    Tampered
        The table with the truth about it; fewer mistakes where no room was found for one.
    """
    laid = lay_script(script, seed)
    rng = np.random.default_rng([seed, 23])
    count = int(rng.integers(MAX_MISTAKES + 1)) if mistakes is None else mistakes
    table = _Table.of(laid.table, script)
    made: list[TrueMistake] = []
    for _ in range(20 * count):
        if len(made) == count:
            break
        kind = list(MistakeKind)[int(rng.integers(len(MistakeKind)))]
        done = table.tamper(kind, rng)
        if done is not None:
            tampered, mistake = done[0], TrueMistake(kind, done[1])
            if all(tampered.shows(one) for one in (*made, mistake)):
                table = tampered
                made.append(mistake)
    things = table.things_set_down() if made else laid.table.things
    top = top_under(things, colour=laid.table.top.colour) if made else laid.table.top
    return Tampered(replace(laid, table=LaidTable(top, things)), tuple(made))


@dataclass(frozen=True, eq=False)
class _Table:
    """Things on a table in the order in which they are laid, and those that were tampered with."""

    script: Script
    things: tuple[LaidThing, ...]
    touched: frozenset[str] = frozenset()
    region: Array | None = None

    @classmethod
    def of(cls, table: LaidTable, script: Script) -> _Table:
        corners = np.array([thing.box[:, :2] for thing in table.things])
        region = np.array([corners[:, 0].min(axis=0) - BEYOND, corners[:, 1].max(axis=0) + BEYOND])
        return cls(script, table.things, region=region)

    def tamper(self, kind: MistakeKind, rng: np.random.Generator) -> tuple[_Table, tuple[str, ...]] | None:
        """Return the table with one more mistake, and the names of its things; None if there is no room for it."""
        if kind is MistakeKind.EXTRA:
            return self._with_extra(rng)
        able = [thing for thing in self.things if thing.name not in self.touched and not self._bears(thing)]
        able = [able[i] for i in rng.permutation(len(able))]
        if kind is MistakeKind.SWAPPED:
            return self._swapped(able)
        for thing in able:
            if kind is MistakeKind.MISSING:
                things = tuple(other for other in self.things if other is not thing)
                return replace(self, things=things, touched=self.touched | {thing.name}), (thing.name,)
            moved = self._displaced(thing, rng) if kind is MistakeKind.DISPLACED else self._turned(thing, rng)
            if moved is not None:
                return self._with({thing.name: moved}), (thing.name,)
        return None

    def shows(self, mistake: TrueMistake) -> bool:
        """Return whether a displaced or swapped thing clearly violates a fact about a thing that is in its place."""
        if mistake.kind not in (MistakeKind.DISPLACED, MistakeKind.SWAPPED):
            return True
        things = [thing for thing in self.things if thing.name in mistake.names]
        others = self.touched - set(mistake.names)
        return any(self._violates(thing.name, thing, others) for thing in things)

    def _with(self, new: dict[str, LaidThing]) -> _Table:
        things = tuple(new.get(thing.name, thing) for thing in self.things)
        return replace(self, things=things, touched=self.touched | set(new))

    def _bears(self, thing: LaidThing) -> bool:
        """Return whether another thing lies on this one."""
        top = thing.box[1, 2]
        return any(
            other is not thing and _overlap(other.box, thing.box, 0.0) and other.box[1, 2] > top + 1e-4
            for other in self.things
        )

    def _free(self, box: Array, but: Sequence[str]) -> bool:
        return not any(thing.name not in but and _overlap(box, thing.box, GAP) for thing in self.things)

    def _displaced(self, thing: LaidThing, rng: np.random.Generator) -> LaidThing | None:
        assert self.region is not None
        half = (thing.box[1, :2] - thing.box[0, :2]) / 2
        centre = thing.box[:, :2].mean(axis=0)
        for _ in range(TRIES):
            place = rng.uniform(self.region[0] + half, self.region[1] - half)
            moved = _shifted(thing, place - centre)
            far = np.linalg.norm(place - centre) >= MIN_DISPLACEMENT
            if far and self._free(moved.box, (thing.name,)) and self._violates(thing.name, moved, self.touched):
                return moved
        return None

    def _holding(self, name: str, box: Array, without: Collection[str] = ()) -> frozenset[int] | None:
        """Return which firm facts about a thing hold if its box is elsewhere; None if none can be compared.

        Facts about the things ``without`` are left out.
        """
        graph = self.script.graph().affirming()
        boxes = {thing.name: thing.box[:, :2] for thing in self.things if thing.name not in without} | {name: box}
        there = [
            number
            for number, fact in enumerate(graph.facts())
            if fact.weight >= 1 and name in (fact.subject, fact.object) and {fact.subject, fact.object} <= boxes.keys()
        ]
        if not there:
            return None
        nowhere = np.array([[0.0, 0.0], [1e-6, 1e-6]])
        held = facts_that_hold(graph, np.array([boxes.get(node, nowhere) for node in graph.nodes]))
        return frozenset(number for number in there if held[number]) | frozenset(-1 - n for n in there if not held[n])

    def _holds(self, name: str, moved: LaidThing) -> bool:
        """Return whether every firm fact about a thing that can be compared holds in its new place."""
        found = self._holding(name, moved.box[:, :2])
        return found is None or min(found) >= 0

    def _violates(self, name: str, moved: LaidThing, without: Collection[str]) -> bool:
        """Return whether a fact about a thing, except those about other ones, is violated also a little farther on."""
        box = moved.box[:, :2]
        shifts = ((0.0, 0.0), (CLEAR, 0.0), (-CLEAR, 0.0), (0.0, CLEAR), (0.0, -CLEAR))
        found = [self._holding(name, box + np.array(shift), without) for shift in shifts]
        return any(
            all(each is not None and number in each for each in found) for number in found[0] or () if number < 0
        )

    def _turned(self, thing: LaidThing, rng: np.random.Generator) -> LaidThing | None:
        size = np.sort(thing.box[1, :2] - thing.box[0, :2])
        if size[1] < LONG * size[0]:
            return None
        below = [other.name for other in self.things if other is not thing and _overlap(other.box, thing.box, 0.0)]
        for _ in range(TRIES):
            angle = float(rng.uniform(*QUARTER)) * (1 if rng.random() < 0.5 else -1)
            shift = np.zeros(2) if below else rng.uniform(-MAX_SHIFT, MAX_SHIFT, 2)
            moved = _shifted(thing, shift, angle)
            if self._free(moved.box, (thing.name, *below)) and self._holds(thing.name, moved):
                return moved
        return None

    def _swapped(self, able: Sequence[LaidThing]) -> tuple[_Table, tuple[str, ...]] | None:
        for i, first in enumerate(able):
            for second in able[i + 1 :]:
                if plain_name(first.name) == plain_name(second.name) or first.kind == second.kind:
                    continue
                apart = second.box[:, :2].mean(axis=0) - first.box[:, :2].mean(axis=0)
                moved = _shifted(first, apart), _shifted(second, -apart)
                names = (first.name, second.name)
                borne = any(
                    other not in (first, second) and _overlap(other.box, one.box, 0.0)
                    for one in (first, second)
                    for other in self.things
                )
                fits = all(self._free(one.box, names) for one in moved) and not _overlap(
                    moved[0].box, moved[1].box, GAP
                )
                swapped = self._with(dict(zip(names, moved, strict=True)))
                if fits and not borne and swapped.shows(TrueMistake(MistakeKind.SWAPPED, names)):
                    return swapped, names
        return None

    def _with_extra(self, rng: np.random.Generator) -> tuple[_Table, tuple[str, ...]] | None:
        assert self.region is not None
        kind = EXTRAS[int(rng.integers(len(EXTRAS)))]
        name = f"extra_{kind.replace(' ', '_')}_{len(self.things)}"
        made = make(kind, int(rng.integers(2**31)))
        thing = LaidThing(name, kind, made.mesh, made.colour, made.form.name, made.form.generic)
        half = (thing.box[1, :2] - thing.box[0, :2]) / 2
        for _ in range(TRIES):
            moved = _shifted(thing, rng.uniform(self.region[0] + half, self.region[1] - half))
            if self._free(moved.box, ()):
                return replace(self, things=(*self.things, moved), touched=self.touched | {name}), (name,)
        return None

    def things_set_down(self) -> tuple[LaidThing, ...]:
        """Return all things, those that were moved set down on what lies below them."""
        order = sorted(self.things, key=lambda thing: -float(np.prod(thing.box[1, :2] - thing.box[0, :2])))
        placements = []
        for thing in order:
            x, y = thing.box[:, :2].mean(axis=0).tolist()
            placements.append(Placement(thing.name, thing.kind, x, y, mesh=thing.mesh))
        meshes = {thing.name: thing.mesh for thing in lay(placements).things}
        return tuple(replace(thing, mesh=meshes[thing.name]) for thing in self.things)


def _shifted(thing: LaidThing, by: Array, turn: float = 0.0) -> LaidThing:
    """Return a thing that is turned about the middle of its box, and then moved in plan."""
    from deixis.perception.simulator.meshes.solids import moved

    middle = thing.box[:, :2].mean(axis=0)
    centred = moved(thing.mesh, by=(-float(middle[0]), -float(middle[1]), 0.0))
    place = middle + by
    return replace(thing, mesh=moved(centred, turn, by=(float(place[0]), float(place[1]), 0.0)))


def _overlap(box: Array, other: Array, gap: float) -> bool:
    """Return whether two boxes are nearer to each other in plan than a gap."""
    return bool((box[0, :2] < other[1, :2] + gap).all() and (other[0, :2] < box[1, :2] + gap).all())
