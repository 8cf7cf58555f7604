"""Refine the evidence by a dialogue: choose the groundings to ask about, and rule out matches by the answers."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.grounding.evidence.evidence import PRESENT_LOG_ODDS, Evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import DECIDED
from deixis.reasoning.grounding.questions.candidates import Candidates, candidates_of
from deixis.reasoning.grounding.questions.inquiry import ContradictionError, ExchangeOutcome, Inquiry, begin, update
from deixis.reasoning.grounding.questions.selection import ABSENT, NO, YES, QuestionKind
from deixis.reasoning.grounding.questions.situation import Situation, situation_of

MARGINS = (6.0, 2.0)
"""Largest difference in nats between the best grounding and one that is still asked about.

A grounding beyond the first margin is 400 times less likely than the best, and seldom keeps a match from being decided.
The second margin, 7 times, is used where not all groundings within the first can be listed.
"""

MAX_JOINT_ANSWERS = 100
"""Maximum number of joint assignments of the questioned objects to enumerate."""

Hold = Callable[[Inquiry, float], Inquiry]
"""Function that continues the dialogue of an inquiry up to a total number of questions, and returns the inquiry."""


@dataclass(frozen=True, eq=False)
class Refinement:
    """Evidence with the answers, the finished dialogue, and the deadline for grounding."""

    evidence: Evidence
    inquiry: Inquiry
    deadline: Deadline


def refine(
    evidence: Evidence, implied: Implications, start: Callable[[Situation], Hold], time_limit: float
) -> Refinement:
    """Ask questions that distinguish the likeliest groundings, and return the evidence with the answers.

    After the answers, the groundings that have become likely are listed and asked about in turn, up to one question
    more than log2 of the initial number of groundings. The time limit does not include the person's time: half of it is
    for choosing questions, each time, and all of it for grounding after the last answer; both together keep to it where
    no question was answered.

    Parameters
    ----------
    evidence
        Evidence of the description and the scene.
    implied
        Facts that the description implies, which are not asked about.
    start
        Function that begins the dialogue about a situation; its result holds the dialogue of an inquiry, with seconds
        for choosing questions, and returns the inquiry with the answers.
    time_limit
        Time limit in seconds.

    Returns
    -------
    Refinement
        Evidence with the answers, the last inquiry, and the deadline for grounding.
    """
    deadline = Deadline.after(time_limit)
    situation = situation_of(evidence.description, evidence.scene, implied)
    inquiry = begin(situation, considered(evidence, Deadline.after(time_limit / 2)))
    left = deadline.left
    hold = start(situation)
    done, most = hold(inquiry, math.inf), question_limit(inquiry)
    deadline = Deadline.after(time_limit if done.exchanges else left)
    while len(done.exchanges) > len(inquiry.exchanges):
        evidence = narrowed(evidence, done)
        if done.exchanges[-1].outcome is not ExchangeOutcome.SURPRISING and done.next_question() is not None:
            break  # the person ended the dialogue
        candidates = considered(evidence, Deadline.after(time_limit / 2))
        for exchange in done.exchanges:
            if exchange.is_used:
                with suppress(ContradictionError):  # the likeliest groundings need not agree with every answer
                    candidates = update(done.situation, candidates, exchange.question, exchange.answer)
        if (candidates.likeliest_shares >= DECIDED).all():
            candidates = candidates.select((candidates.assignments == candidates.best).all(axis=1))
        inquiry = replace(done, start=candidates, candidates=candidates)
        most = question_limit(inquiry) if done.exchanges[-1].outcome is ExchangeOutcome.SURPRISING else most
        done = hold(inquiry, most)
        deadline = Deadline.after(time_limit)
    return Refinement(evidence, done, deadline)


def question_limit(inquiry: Inquiry) -> int:
    """Return the maximum number of questions: those asked, and one more than log2 of the number of groundings.

    Parameters
    ----------
    inquiry
        The dialogue so far.

    Returns
    -------
    int
        Maximum number of questions of the dialogue.
    """
    return len(inquiry.exchanges) + math.ceil(math.log2(inquiry.candidates.count)) + 1


def considered(evidence: Evidence, deadline: Deadline) -> Candidates:
    """Return the groundings within the widest margin for which all can be listed; the first gets half of the time.

    Parameters
    ----------
    evidence
        Evidence of the description and the scene.
    deadline
        End of the time limit.

    Returns
    -------
    Candidates
        The groundings with their weights; an incomplete list where both margins have too many.
    """
    wide = candidates_of(evidence.problem, deadline.share(0.5), margin=MARGINS[0])
    return wide if wide.complete else candidates_of(evidence.problem, deadline, margin=MARGINS[1])


def narrowed(evidence: Evidence, done: Inquiry) -> Evidence:
    """Return the evidence with the answers; matches that no candidate contained stay as likely as before.

    A match is ruled out where some candidate before the dialogue contained it, and none does after it, nor any earlier
    candidate with the questioned objects as they are now. An incomplete list does not rule out maps that it does not
    contain: then only answers about a single object are used.

    Parameters
    ----------
    evidence
        Evidence before the dialogue.
    done
        The dialogue.

    Returns
    -------
    Evidence
        Evidence in which ruled out matches are not allowed, and things that answers determine are identified.
    """
    labels, allowed = evidence.labels.copy(), evidence.allowed.copy()
    doubted = evidence.doubted_labels
    doubted = None if doubted is None else replace(doubted, ratios=doubted.ratios.copy())
    identified, out = evidence.identified.copy(), np.zeros(evidence.labels.shape, dtype=bool)
    if done.start.complete or done.start.groups:
        resolved = [swap.question.about for swap in done.exchanges if swap.outcome is ExchangeOutcome.RESOLVED]
        asked = sorted({i for about in resolved for i in about})
        found = np.zeros(labels.shape, dtype=bool)
        # a map with the questioned objects as in some present candidate agrees with the answers, though it may be too
        # unlikely to be listed: answers about the forks do not decide the knives
        for now in np.unique(done.candidates.assignments[:, asked], axis=0)[:MAX_JOINT_ANSWERS]:
            rows = done.start.assignments.copy()
            rows[:, asked] = now
            ordered = np.sort(rows, axis=1)
            twice = (ordered[:, 1:] == ordered[:, :-1]) & (ordered[:, 1:] != UNMATCHED)
            found |= _matched(rows[~twice.any(axis=1)], labels.shape)
        left = _possible(done.candidates, labels.shape) | found
        out = _possible(done.start, labels.shape) & ~left
    for exchange in done.exchanges:
        question, answer = exchange.question, exchange.answer
        if not exchange.is_used or question.kind is QuestionKind.RELATION:
            continue
        if answer == NO:
            out[question.subject, question.thing] = True
            continue
        out[question.subject] = True
        if answer != ABSENT:  # as a certain label: the object is this thing, and no other is
            p = question.thing if answer == YES else done.situation.things.index(answer)
            others = np.arange(len(labels)) != question.subject
            allowed[others, p], allowed[question.subject, p] = False, True
            for ratios in (labels,) if doubted is None else (labels, doubted.ratios):
                ratios[others, p], ratios[question.subject, p] = 0.0, -PRESENT_LOG_ODDS
            identified[p], out[question.subject, p] = True, False
    return replace(evidence, labels=labels, doubted_labels=doubted, allowed=allowed & ~out, identified=identified)


def _possible(candidates: Candidates, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Return the mask (n1, n2) of matches in some candidate, where the members of a group share their things."""
    found = _matched(candidates.assignments, shape)
    for group in candidates.groups:
        found[list(group)] = found[list(group)].any(axis=0)
    return found


def _matched(assignments: NDArray[np.int64], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Return the mask (n1, n2) of matches in some of k maps (k, n1)."""
    found = np.zeros(shape, dtype=bool)
    rows, objects = np.nonzero(assignments != UNMATCHED)
    found[objects, assignments[rows, objects]] = True
    return found
