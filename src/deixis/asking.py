"""Grounding that asks, and grounding from an unknown side: what the session does with questions and viewpoints."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from deixis.dialogue import AnswerSource, run
from deixis.grammar.script import Script
from deixis.perception.scene import Scene
from deixis.reasoning.answer import Grounding
from deixis.reasoning.asking.candidates import Candidates, candidates_of
from deixis.reasoning.asking.inquiry import begin
from deixis.reasoning.asking.situation import Situation, situation_of
from deixis.reasoning.evidence import Evidence
from deixis.reasoning.grounding import DEFAULT_TIME_LIMIT
from deixis.reasoning.grounding import ground as ground_evidence
from deixis.reasoning.likeliest import ExactEngine
from deixis.reasoning.matching.problem import UNMATCHED
from deixis.reasoning.meaning import SHIPPED, Meaning
from deixis.reasoning.viewpoints import Viewpoint, Viewpoints, recover_viewpoint, turned
from deixis.session import evidence_of

MARGIN = 2.0
"""How much less likely than the best (in nats) a grounding may be that is still asked about: seven times."""


def ask(
    script: Script,
    scene: Scene,
    source: Callable[[Situation], AnswerSource],
    out: TextIO,
    meaning: Meaning = SHIPPED,
    time_limit: float = DEFAULT_TIME_LIMIT,
) -> Grounding:
    """Grounds, asks what would tell the likeliest groundings apart, and grounds again.

    The dialogue is written to ``out``; ``source`` makes who answers, given what there is to be seen. The time limit is
    for each of the two searches, not for the person.
    """
    evidence = evidence_of(script, scene, meaning)
    situation = situation_of(evidence.description, evidence.scene)
    candidates = candidates_of(evidence.problem, time.perf_counter() + time_limit, margin=MARGIN)
    done = run(begin(situation, candidates), source(situation), out)
    return ground_evidence(_narrowed(evidence, done.candidates), ExactEngine(), time_limit)


def _narrowed(evidence: Evidence, left: Candidates) -> Evidence:
    """Only what the remaining candidates give an object may it be; what they hold as a group is left as it was."""
    labels = evidence.labels.copy()
    grouped = {i for group in left.groups for i in group}
    for i in range(len(labels)):
        things = np.unique(left.assignments[:, i])
        things = things[things != UNMATCHED]
        if i not in grouped and len(things):
            labels[i, ~np.isin(np.arange(labels.shape[1]), things)] = -np.inf
    return replace(evidence, labels=labels)


def seen_from_anywhere(
    script: Script,
    scene: Scene,
    meaning: Meaning = SHIPPED,
    any_angle: bool = True,
    time_limit: float = DEFAULT_TIME_LIMIT,
) -> tuple[Scene, tuple[str, ...]]:
    """The scene as seen from the side from which the script most probably speaks, and notes that say which that is.

    Turned by quarters only, unless ``any_angle``; mirrored where that explains it better. Where no fact compares two
    things, nothing tells a side, and the scene stays as it is.
    """
    if not len(evidence_of(script, scene, meaning).facts) or len(scene.objects) < 2:
        return scene, ("the scene was taken as it stands: nothing tells from which side the description speaks",)

    def problem(boxes: NDArray[np.float64]):  # type: ignore[no-untyped-def]
        return evidence_of(script, _with_boxes(scene, boxes), meaning).problem

    deadline = time.perf_counter() + time_limit
    found = recover_viewpoint(scene.boxes, problem, any_angle=any_angle, deadline=deadline)
    best = found.best
    return _with_boxes(scene, turned(scene.boxes, best.angle, best.mirrored)), _notes(found)


def _with_boxes(scene: Scene, boxes: NDArray[np.float64]) -> Scene:
    things = [
        replace(thing, minimum=tuple(box[0].tolist()), maximum=tuple(box[1].tolist()))
        for thing, box in zip(scene.objects, boxes, strict=True)
    ]
    return replace(scene, objects=tuple(things))


def _notes(found: Viewpoints) -> tuple[str, ...]:
    best = found.best
    notes = [f"the scene was taken {_described(best)}, with probability {best.probability:.2f}"]
    if len(found.ties) > 1:
        others = ", or ".join(_described(view) for view in found.ties if view is not best)
        notes.append(f"the description fits as well {others}")
    if not found.exact:
        notes.append("not all groundings were counted for every side, so that the probability is approximate")
    return tuple(notes)


def _described(view: Viewpoint) -> str:
    degrees = round(math.degrees(view.angle)) % 360
    turn = "as it stands" if degrees == 0 else f"turned by {degrees} degrees counter-clockwise"
    return f"mirrored and {turn}" if view.mirrored else turn
