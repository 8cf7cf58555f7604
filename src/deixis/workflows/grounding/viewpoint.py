"""Ground a script from the side from which it most probably speaks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.ground import ground as ground_evidence
from deixis.reasoning.grounding.hypotheses.hypotheses import Side, side_text
from deixis.reasoning.grounding.hypotheses.viewpoint import Viewpoint, Viewpoints, recover_viewpoint
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.options import DECIDED, Select

MIN_VIEWPOINT_PROBABILITY, MAX_VIEWPOINTS = 0.005, 8
"""Minimum probability of a viewpoint that contributes to the probabilities of matches, and the most such viewpoints."""

MIN_CONCENTRATION = 0.5
"""Minimum mean resultant length of the angles of one viewpoint: that of an even spread over 217 degrees."""

_NO_VIEWPOINT_NOTE = "the scene was taken as it is: nothing indicates from which side it was described"


@dataclass(frozen=True, slots=True)
class ViewpointScene:
    """A scene as seen from the side from which a script speaks; ``viewpoints`` is None if nothing indicates a side."""

    scene: Scene
    viewpoints: Viewpoints | None = None
    notes: tuple[str, ...] = ()
    others: tuple[tuple[Viewpoint, Scene], ...] = ()  # as seen from other sides
    share: float = 1.0  # how probable this side is
    side: Viewpoint | None = None
    evidence: Evidence | None = None  # as seen from this side, where it was worked out already

    @property
    def viewpoint_notes(self) -> tuple[str, ...]:
        """Note on probabilities that hold only as seen from the most likely side; empty where the side is certain."""
        if self.share >= DECIDED:
            return ()
        return ("the probabilities of the matches hold as seen from this side; from another side they may differ",)


def recover_scene(
    evidence_of: Callable[[Scene], Evidence], scene: Scene, any_angle: bool, deadline: Deadline
) -> ViewpointScene:
    """Return the scene as seen from the side from which a script most probably speaks.

    A scene is mirrored where that explains the script better. Where no fact compares two things that were found, or
    most of the circle fits as well, the script indicates no side, and the scene stays as it is.

    Parameters
    ----------
    evidence_of
        Function from the scene as seen from one side to the evidence of the script.
    scene
        The scene.
    any_angle
        True to try all angles, False for quarter turns.
    deadline
        Time limit.

    Returns
    -------
    ViewpointScene
        The turned scene, the possible viewpoints, and notes that say which.
    """
    evidence = evidence_of(scene)
    indifferent = ViewpointScene(scene, notes=(f"{_NO_VIEWPOINT_NOTE}, and it makes no difference",), evidence=evidence)
    if not len(evidence.facts) or len(scene.objects) < 2:
        return indifferent
    present = scene.boxes

    def problem(boxes: NDArray[np.float64]) -> Problem:
        seen = evidence if np.array_equal(boxes, present) else evidence_of(_with_boxes(scene, boxes))
        return seen.problem

    found = recover_viewpoint(present, problem, any_angle=any_angle, deadline=deadline)
    best = found.best
    placed = (best.assignment[evidence.problem.ends] != UNMATCHED).all(axis=1)
    if not placed.any():
        return indifferent
    if best.concentration < MIN_CONCENTRATION:
        quarters = _from_all_quarters(scene, recover_viewpoint(present, problem, deadline=deadline))
        return replace(quarters, evidence=evidence)
    known = evidence if not best.angle and not best.mirrored else None
    others = _others(scene, found)
    return ViewpointScene(scene_from(scene, best), found, _notes(found), others, best.probability, best, known)


def _from_all_quarters(scene: Scene, found: Viewpoints) -> ViewpointScene:
    """Return the scene as it stands, with the other quarter turns for the whole circle, all equally likely."""
    upright = next(view for view in found.viewpoints if not view.angle and not view.mirrored)
    rest = replace(found, viewpoints=(upright, *(view for view in found.viewpoints if view is not upright)))
    return ViewpointScene(scene, None, (_NO_VIEWPOINT_NOTE,), _others(scene, rest), upright.probability, upright)


def _others(scene: Scene, found: Viewpoints) -> tuple[tuple[Viewpoint, Scene], ...]:
    """Return the scene as seen from each further side that is probable enough."""
    probable = [view for view in found.viewpoints[1:MAX_VIEWPOINTS] if view.probability >= MIN_VIEWPOINT_PROBABILITY]
    return tuple((view, scene_from(scene, view)) for view in probable)


def ground_from_sides(
    evidence_of: Callable[[Scene], Evidence],
    side: ViewpointScene,
    engine: str,
    select: Select,
    deadline: Deadline,
    notes: tuple[str, ...],
) -> Grounding:
    """Ground as seen from the likeliest side, with the probabilities of matches over all plausible sides.

    Where the script indicates no side, the map is that of the scene as it stands, with the probabilities from all
    around.

    Parameters
    ----------
    evidence_of
        Function from the scene as seen from one side to the evidence of the script.
    side
        The likeliest side and the other viewpoints.
    engine
        Name of the engine.
    select
        Choice among sub-graphs under the paper's engine.
    deadline
        Time limit.
    notes
        Notes to put before those of the answer.

    Returns
    -------
    Grounding
        The answer, with the viewpoints and the probabilities that its matches rest on.
    """
    here = side.side
    if here is None:
        evidence = side.evidence or evidence_of(side.scene)
        found = ground_evidence(evidence, engine_named(engine, select), deadline, notes)
        return replace(found.noting(side.notes), viewpoints=())
    views = (here, *(view for view, _ in side.others))
    sides = tuple(Side(view.angle, view.mirrored, view.prior) for view in views)
    seen = (None, *(evidence_of(scene) for _, scene in side.others))
    evidence = side.evidence or evidence_of(side.scene)
    found = ground_evidence(evidence, engine_named(engine, select, sides, seen), deadline, notes)
    if side.viewpoints is None:
        return replace(found.noting(side.notes), viewpoints=())
    weighed = as_weighed(side.viewpoints, found.sides)
    return replace(found.noting(_notes(weighed)), viewpoints=weighed.viewpoints)


def as_weighed(found: Viewpoints, sides: Sequence[tuple[Side, float]]) -> Viewpoints:
    """Weight viewpoints by the posterior of their matches, given that the scene is the one that the script describes.

    Parameters
    ----------
    found
        The viewpoints.
    sides
        Sides that were grounded from, with their probabilities; other viewpoints are unlikely and keep theirs.

    Returns
    -------
    Viewpoints
        The viewpoints with their new probabilities.
    """
    weighed = {(side.angle, side.mirrored): probability for side, probability in sides}
    total = sum(weighed.values())
    if total <= 0:
        return found
    share = sum(view.probability for view in found.viewpoints if (view.angle, view.mirrored) in weighed)
    views = []
    for view in found.viewpoints:
        known = weighed.get((view.angle, view.mirrored))
        views.append(view if known is None else replace(view, probability=share * known / total))
    views.sort(key=lambda view: (-round(view.probability, 9), view.mirrored, view.angle))
    return replace(found, viewpoints=tuple(views))


def scene_from(scene: Scene, view: Viewpoint) -> Scene:
    """Return the scene as seen from a viewpoint.

    Parameters
    ----------
    scene
        The scene.
    view
        Angle, and whether the scene is mirrored.

    Returns
    -------
    Scene
        The turned scene.
    """
    return scene.turned(view.angle, view.mirrored)


def _with_boxes(scene: Scene, boxes: NDArray[np.float64]) -> Scene:
    things = [
        replace(thing, minimum=tuple(box[0].tolist()), maximum=tuple(box[1].tolist()), oriented=None)
        for thing, box in zip(scene.objects, boxes, strict=True)
    ]
    return replace(scene, objects=tuple(things))


def _notes(found: Viewpoints) -> tuple[str, ...]:
    best = found.best
    notes = [f"the scene was taken {side_text(best.angle, best.mirrored)}, with probability {best.probability:.2f}"]
    if len(found.ties) > 1:
        others = ", or ".join(side_text(view.angle, view.mirrored) for view in found.ties if view is not best)
        notes.append(f"the description fits as well {others}")
    if not found.everywhere:
        notes.append("time limit reached before every side was tried; the probability is approximate")
    elif not found.exact:
        notes.append("not all groundings were counted for every side, so that the probability is approximate")
    return tuple(notes)
