"""Whose left? Grounding from the side from which a script most probably speaks."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.grammar.script import Script
from deixis.learning.scene_evidence import conflict_notes, evidence_of
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answer import DECIDED, Grounding
from deixis.reasoning.grounding.engines import Engine
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.ground import DEFAULT_TIME_LIMIT
from deixis.reasoning.grounding.ground import ground as ground_evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.viewpoint import FromSides, OtherSide, Viewpoint, Viewpoints, recover_viewpoint, turned

WORTH_A_LOOK, MOST_SIDES = 0.005, 8
"""How probable a side is from which matches are looked at, and how many such sides there are at most."""

CONCENTRATED = 0.5
"""Mean resultant length below which angles are no side: that of an even spread over 217 degrees."""

_UNTOLD = "the scene was taken as it stands: nothing tells from which side the description speaks"


@dataclass(frozen=True, slots=True)
class SeenFrom:
    """A scene as seen from the side from which a script speaks; ``viewpoints`` None where nothing tells a side."""

    scene: Scene
    viewpoints: Viewpoints | None = None
    notes: tuple[str, ...] = ()
    others: tuple[tuple[float, Scene], ...] = ()  # as seen from other sides, each with its probability
    share: float = 1.0  # how probable this side is
    evidence: Evidence | None = None  # as seen from this side, where it was worked out already

    @property
    def turn(self) -> str:
        """How the scene was turned or mirrored, in words; empty where it stays as it stands."""
        if self.viewpoints is None or not (self.viewpoints.best.angle or self.viewpoints.best.mirrored):
            return ""
        return _described(self.viewpoints.best)

    @property
    def doubt(self) -> tuple[str, ...]:
        """What is to be said of probabilities that hold from the likeliest side alone."""
        if self.share >= DECIDED:
            return ()
        return ("from other sides the matches may be others: their probabilities hold as seen from this one",)


def seen_from_anywhere(
    script: Script,
    scene: Scene,
    meaning: Meaning = SHIPPED,
    any_angle: bool = True,
    time_limit: float = DEFAULT_TIME_LIMIT,
) -> SeenFrom:
    """The scene as seen from the side from which the script most probably speaks, and notes that say which that is.

    Turned by quarters only, unless ``any_angle``; mirrored where that explains it better. Where no fact compares two
    things that were found, or most of the circle does as well, nothing tells a side, and the scene stays as it is.
    """
    deadline = time.perf_counter() + time_limit
    evidence = evidence_of(script, scene, meaning)
    indifferent = SeenFrom(scene, notes=(f"{_UNTOLD}, and it makes no difference",), evidence=evidence)
    if not len(evidence.facts) or len(scene.objects) < 2:
        return indifferent
    present = scene.boxes

    def problem(boxes: NDArray[np.float64]) -> Problem:
        seen = evidence if np.array_equal(boxes, present) else evidence_of(script, _with_boxes(scene, boxes), meaning)
        return seen.problem

    found = recover_viewpoint(present, problem, any_angle=any_angle, deadline=deadline)
    best = found.best
    placed = (best.assignment[evidence.problem.ends] != UNMATCHED).all(axis=1)
    if not placed.any():
        return indifferent
    if best.concentration < CONCENTRATED:
        quarters = _from_all_quarters(scene, recover_viewpoint(present, problem, deadline=deadline))
        return replace(quarters, evidence=evidence)
    known = evidence if not best.angle and not best.mirrored else None
    return SeenFrom(_seen_from(scene, best), found, _notes(found), _others(scene, found), best.probability, known)


def _from_all_quarters(scene: Scene, found: Viewpoints) -> SeenFrom:
    """As it stands, with the other quarter turns for the whole circle, of which no part is likelier than another."""
    upright = next(view for view in found.viewpoints if not view.angle and not view.mirrored)
    rest = replace(found, viewpoints=(upright, *(view for view in found.viewpoints if view is not upright)))
    return SeenFrom(scene, None, (_UNTOLD,), _others(scene, rest), upright.probability)


def _others(scene: Scene, found: Viewpoints) -> tuple[tuple[float, Scene], ...]:
    """What is seen from the sides after the first, with how probable they are, where that is worth a look."""
    worth = [view for view in found.viewpoints[1:MOST_SIDES] if view.probability >= WORTH_A_LOOK]
    return tuple((view.probability, _seen_from(scene, view)) for view in worth)


def ground_from_sides(
    script: Script, side: SeenFrom, engine: Engine, meaning: Meaning = SHIPPED, time_limit: float = DEFAULT_TIME_LIMIT
) -> Grounding:
    """Grounds as seen from the likeliest side, with the probabilities of matches over all sides that are worth a look.

    Where nothing tells a side, the map is that of the scene as it stands, with the probabilities from all around.
    """
    others = tuple(OtherSide(share, evidence_of(script, scene, meaning)) for share, scene in side.others)
    aligning = FromSides(engine, side.share, others) if others else engine
    evidence = side.evidence or evidence_of(script, side.scene, meaning)
    return ground_evidence(evidence, aligning, time_limit, conflict_notes(script.graph()))


def ground_from_anywhere(
    script: Script, scene: Scene, engine: Engine, meaning: Meaning, any_angle: bool, time_limit: float
) -> Grounding:
    """Recovers the side, for which half of the time is, and grounds as seen from there."""
    deadline = time.perf_counter() + time_limit
    side = seen_from_anywhere(script, scene, meaning, any_angle, time_limit / 2)
    left = max(0.0, deadline - time.perf_counter())
    return ground_from_sides(script, side, engine, meaning, left).noting(side.notes)


def _seen_from(scene: Scene, view: Viewpoint) -> Scene:
    return _with_boxes(scene, turned(scene.boxes, view.angle, view.mirrored))


def _with_boxes(scene: Scene, boxes: NDArray[np.float64]) -> Scene:
    things = [
        replace(thing, minimum=tuple(box[0].tolist()), maximum=tuple(box[1].tolist()), oriented=None)
        for thing, box in zip(scene.objects, boxes, strict=True)
    ]
    return replace(scene, objects=tuple(things))


def _notes(found: Viewpoints) -> tuple[str, ...]:
    best = found.best
    notes = [f"the scene was taken {_described(best)}, with probability {best.probability:.2f}"]
    if len(found.ties) > 1:
        others = ", or ".join(_described(view) for view in found.ties if view is not best)
        notes.append(f"the description fits as well {others}")
    if not found.everywhere:
        notes.append("there was no time to look from every side, so that the probability is approximate")
    elif not found.exact:
        notes.append("not all groundings were counted for every side, so that the probability is approximate")
    return tuple(notes)


def _described(view: Viewpoint) -> str:
    degrees = round(math.degrees(view.angle)) % 360
    turn = "as it stands" if degrees == 0 else f"turned by {degrees} degrees counter-clockwise"
    return f"mirrored and {turn}" if view.mirrored else turn
