"""Grounding that asks: the questions, their answers, and what the answers make of the evidence."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from deixis.grammar.script import Script
from deixis.learning.scene_evidence import conflict_notes, evidence_of
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.errors import require_time_limit
from deixis.reasoning.grounding.answer import DECIDED, Grounding
from deixis.reasoning.grounding.evidence.evidence import PRESENT, Evidence
from deixis.reasoning.grounding.evidence.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.ground import DEFAULT_TIME_LIMIT
from deixis.reasoning.grounding.ground import ground as ground_evidence
from deixis.reasoning.grounding.map_engines import ExactEngine
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.questions.candidates import Candidates, candidates_of
from deixis.reasoning.grounding.questions.inquiry import ContradictionError, Exchange, Inquiry, Outcome, begin, update
from deixis.reasoning.grounding.questions.selection import ABSENT, NO, YES, QuestionKind
from deixis.reasoning.grounding.questions.situation import Situation, situation_of
from deixis.workflows.dialogue import AnswerSource, closing_lines, run
from deixis.workflows.read import read_script

MARGINS = (6.0, 2.0)
"""How much less likely than the best (in nats) a grounding may be that is still asked about: 400 times.

Rarer ones hardly ever keep a match from being decided. Where so many cannot be listed: seven times.
"""

MOST_ANSWERED = 100
"""Ways in which those asked about may be what they are now, of which all are looked at."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What a dialogue came to, and what was said in it."""

    grounding: Grounding
    exchanges: tuple[Exchange, ...]


def ask(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    source: Callable[[Situation], AnswerSource],
    out: TextIO,
    meaning: Meaning = SHIPPED,
    time_limit: float = DEFAULT_TIME_LIMIT,
) -> Asked:
    """Grounds, asks what would tell the likeliest groundings apart, and grounds again.

    What the answers make likely is listed and asked about in turn, as long as that takes no more than one question
    above log2 of the number of groundings that were considered at first. The dialogue is written to ``out``;
    ``source`` makes who answers, given what there is to be seen. The time limit is not for the person: half of it is
    for what to ask, each time, and the whole for grounding after the last answer; together they keep to it where
    nothing was answered.
    """
    require_time_limit(time_limit)
    started = time.perf_counter()
    script = script if isinstance(script, Script) else read_script(script)
    scene = scene if isinstance(scene, Scene) else read_scene(scene)
    evidence = evidence_of(script, scene, meaning)
    situation = situation_of(evidence.description, evidence.scene)
    inquiry = begin(situation, _considered(evidence, time_limit / 2))
    left = max(0.0, time_limit - (time.perf_counter() - started))
    answers = source(situation)
    done, most = run(inquiry, answers, out), _enough(inquiry)
    replied = time.perf_counter()
    while len(done.exchanges) > len(inquiry.exchanges):
        evidence = _narrowed(evidence, done)
        if not _is_to_go_on(done):
            break
        inquiry = _listed_again(evidence, done, time_limit / 2)
        most = _enough(inquiry) if done.exchanges[-1].outcome is Outcome.SURPRISING else most
        done = run(inquiry, answers, out, most)
        replied = time.perf_counter()
    print(*closing_lines(done), sep="\n", file=out)
    if done.exchanges:
        left = max(0.0, time_limit - (time.perf_counter() - replied))
    notes = conflict_notes(script.graph())
    return Asked(ground_evidence(evidence, ExactEngine(), left, notes), done.exchanges)


def _enough(inquiry: Inquiry) -> int:
    """One question more than yes and no take to tell the groundings apart, with those asked before."""
    return len(inquiry.exchanges) + math.ceil(math.log2(inquiry.candidates.count)) + 1


def _is_to_go_on(done: Inquiry) -> bool:
    """Whether the person was not the one who ended the dialogue."""
    return done.exchanges[-1].outcome is Outcome.SURPRISING or done.next_question() is None


def _listed_again(evidence: Evidence, done: Inquiry, time_limit: float) -> Inquiry:
    """The dialogue over what the answers have made likely; over one grounding where that leaves nothing in doubt."""
    candidates = _considered(evidence, time_limit)
    for exchange in done.exchanges:
        if exchange.believed:
            with suppress(ContradictionError):  # what is likeliest now need not agree with every answer
                candidates = update(done.situation, candidates, exchange.question, exchange.answer)
    if (candidates.likeliest_shares >= DECIDED).all():
        candidates = candidates.kept((candidates.assignments == candidates.best).all(axis=1))
    return replace(done, start=candidates, candidates=candidates)


def _considered(evidence: Evidence, time_limit: float) -> Candidates:
    """The groundings within the widest margin of which all can be listed; half of the time is for each."""
    started = time.perf_counter()
    wide = candidates_of(evidence.problem, started + time_limit / 2, margin=MARGINS[0])
    return wide if wide.complete else candidates_of(evidence.problem, started + time_limit, margin=MARGINS[1])


def _narrowed(evidence: Evidence, done: Inquiry) -> Evidence:
    """The evidence and what was answered; what was never considered stays as likely as it was.

    Ruled out is what an object was in some candidate before the dialogue and is in none after it, nor in one of before
    in which those asked about are what they are now. A list that was cut off at any place says nothing about the maps
    that are not in it: there only what was said of a single object counts.
    """
    labels, out = evidence.labels.copy(), np.zeros(evidence.labels.shape, dtype=bool)
    if done.start.complete or done.start.groups:
        left = _possible(done.candidates, labels.shape) | _possible_beside(done, labels.shape)
        out = _possible(done.start, labels.shape) & ~left
    for exchange in done.exchanges:
        question, answer = exchange.question, exchange.answer
        if not exchange.believed or question.kind is QuestionKind.RELATION:
            continue
        if answer == NO:
            out[question.subject, question.thing] = True
            continue
        out[question.subject] = True
        if answer != ABSENT:  # as a certain label: the object is this thing, and no other is
            p = question.thing if answer == YES else done.situation.things.index(answer)
            labels[:, p] = -np.inf
            labels[question.subject, p] = -PRESENT
            out[question.subject, p] = False
    # not in the labels: -inf there says that the thing bears a certain label
    return replace(evidence, labels=labels, sizes=np.where(out, -np.inf, evidence.sizes))


def _possible(candidates: Candidates, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Which object is which thing in some candidate, shape (n1, n2); the members of a group share their things."""
    found = _matched(candidates.assignments, shape)
    for group in candidates.groups:
        found[list(group)] = found[list(group)].any(axis=0)
    return found


def _matched(assignments: NDArray[np.int64], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Which object is which thing in some of k maps (k, n1), shape (n1, n2)."""
    found = np.zeros(shape, dtype=bool)
    rows, objects = np.nonzero(assignments != UNMATCHED)
    found[objects, assignments[rows, objects]] = True
    return found


def _possible_beside(done: Inquiry, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """The same in the candidates of before, with those asked about being what they are in some candidate of now.

    Such a map agrees with the answers, though it may be too unlikely to have been listed: which fork is which says
    nothing of the knives.
    """
    resolved = [exchange.question.about for exchange in done.exchanges if exchange.outcome is Outcome.RESOLVED]
    asked = sorted({i for about in resolved for i in about})
    found = np.zeros(shape, dtype=bool)
    for now in np.unique(done.candidates.assignments[:, asked], axis=0)[:MOST_ANSWERED]:
        rows = done.start.assignments.copy()
        rows[:, asked] = now
        ordered = np.sort(rows, axis=1)
        twice = (ordered[:, 1:] == ordered[:, :-1]) & (ordered[:, 1:] != UNMATCHED)
        found |= _matched(rows[~twice.any(axis=1)], shape)
    return found
