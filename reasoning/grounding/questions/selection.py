"""Selection of the question with the largest expected information.

The information is the entropy of the answer in bits, because every candidate answers every question in one way. Among
questions with the same information, the one with the least effort for the person (``Question.effort``) is chosen: best
is one about a relation of two things that clearly holds or clearly does not.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Hashable, Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.relation import Relation
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.questions.candidates import Candidates
from deixis.reasoning.grounding.questions.situation import Situation, spoken

YES, NO = "yes", "no"
ABSENT = "absent"
"""Answer that an object of the question is absent."""
DONT_KNOW = "don't know"

RELATION_EFFORT, IDENTITY_EFFORT, POINTING_EFFORT = 1.0, 1.5, 2.0
VAGUE_EFFORT = 1.0  # extra, where the relation holds only widely in every candidate
COMPOUND_EFFORT = 0.25  # extra, for a word with two directions: bottom left of
DISTANCE_EFFORT = 0.5  # extra, where the two things have the largest distance
ID_EFFORT = 1.0  # extra, where a thing is identified by its id alone

MAX_PAIRS = 2_000
"""Maximum number of pairs of objects for which questions are evaluated, the least certain first."""

Topic = tuple[Hashable, ...]


class QuestionKind(StrEnum):
    """Task of the person: look at two things, look at one thing, or point."""

    RELATION = "relation"  # Is the salad fork left of the dinner fork?
    IDENTITY = "identity"  # Is the thing at the far left the bread plate?
    POINTING = "pointing"  # Which one is the fish knife?


@dataclass(frozen=True, slots=True)
class Question:
    """A question with the probabilities of its answers and its expected information."""

    kind: QuestionKind
    text: str
    subject: int  # position of a described object
    relation: Relation | None
    object: int  # position of a described object; -1 for none
    thing: int  # position of a perceived thing; -1 for none
    answers: tuple[tuple[str, float], ...]  # possible answers with probabilities, most probable first
    bits: float  # expected information
    effort: float  # effort of the person, relative to a question about a clear relation

    @property
    def about(self) -> tuple[int, ...]:
        """Positions of the described objects in the question."""
        return (self.subject,) if self.object < 0 else (self.subject, self.object)

    @property
    def topic(self) -> Topic:
        """Key that is equal for equivalent questions, such as *left of* and, for the reversed pair, *right of*."""
        if self.relation is None:
            return (self.kind, self.subject, self.thing)
        if self.subject < self.object:
            return (self.kind, self.subject, self.relation.name, self.object)
        return (self.kind, self.object, self.relation.inverse, self.subject)

    @property
    def look(self) -> Topic:
        """Key that is equal for questions that need the same knowledge, so that none can be answered without it.

        A person who does not recognise an object can neither point to it nor tell whether a thing is this object.
        """
        if self.relation is None:
            return (QuestionKind.POINTING, self.subject)
        return (self.kind, min(self.subject, self.object), max(self.subject, self.object))


def answers_of(question: Question, situation: Situation, assignments: NDArray[np.int64]) -> list[str]:
    """Return the answer of each of k maps to a question.

    Parameters
    ----------
    question
        The question.
    situation
        The scene and what is known about it.
    assignments
        Thing of each object in each map, shape (k, n1); -1 for none.

    Returns
    -------
    list of str
        Answer of each map, as :func:`deixis.reasoning.grounding.questions.inquiry.update` compares them.
    """
    things = situation.things
    subjects = assignments[:, question.subject]
    if question.kind is QuestionKind.POINTING:
        return [ABSENT if p == UNMATCHED else things[p] for p in subjects.tolist()]
    if question.relation is None:
        return [YES if p == question.thing else NO for p in subjects.tolist()]
    objects = assignments[:, question.object]
    holds = situation.degrees[situation.relations.index(question.relation)][subjects, objects] > 0
    there = (subjects != UNMATCHED) & (objects != UNMATCHED)
    return [(YES if so else NO) if both else ABSENT for so, both in zip(holds.tolist(), there.tolist(), strict=True)]


def best_question(
    situation: Situation,
    candidates: Candidates,
    kinds: Collection[QuestionKind] = tuple(QuestionKind),
    barred: Collection[Topic] = (),
) -> Question | None:
    """Return the question with the largest expected information, then the least effort, or None.

    The question does not depend on the order of candidates, objects or things, except for the choice among equivalent
    objects.

    Parameters
    ----------
    situation
        The scene and what is known about it.
    candidates
        Groundings to tell apart.
    kinds
        Kinds of questions that may be asked.
    barred
        Topics and looks of questions to leave out.

    Returns
    -------
    Question or None
        The question, or None where no question has information.

    Notes
    -----
    The choice of the experiment with the largest expected information is that of D. V. Lindley, "On a measure of the
    information provided by an experiment", Annals of Mathematical Statistics 27, 1956.
    """
    every, never = questions(situation, candidates, kinds), frozenset(barred)
    found = [question for question in every if never.isdisjoint((question.topic, question.look))]
    return min(found, key=lambda q: (-round(q.bits, 9), round(q.effort, 9), q.text), default=None)


def questions(
    situation: Situation, candidates: Candidates, kinds: Collection[QuestionKind] = tuple(QuestionKind)
) -> Iterator[Question]:
    """Yield every question that has information and that the description does not answer.

    Parameters
    ----------
    situation
        The scene and what is known about it.
    candidates
        Groundings to tell apart.
    kinds
        Kinds of questions that may be asked.

    Yields
    ------
    Question
        Question with its expected information in bits and its effort.
    """
    marginals = _marginals(situation, candidates)
    asked = [i for i in candidates.stand_ins if marginals[i].max() < 1 - 1e-12]
    if QuestionKind.POINTING in kinds:
        yield from (_pointing(i, marginals[i], situation) for i in asked)
    if QuestionKind.IDENTITY in kinds:
        yield from (
            _identity(i, p, float(marginals[i, p]), situation)
            for i in asked
            for p in range(len(situation.things))
            if 0 < marginals[i, p] < 1
        )
    if QuestionKind.RELATION in kinds:
        for i, j in _pairs(asked, candidates, marginals, situation):
            pairs, joint, absent = _joint(i, j, candidates, len(situation.things))
            degrees = situation.degrees.reshape(len(situation.relations), -1)[:, pairs]
            yes, vague = (degrees > 0) @ joint, (degrees == 0.5) @ joint
            apart = float(situation.apart.ravel()[pairs] @ joint)
            subject, obj = (spoken(situation.objects[k]) for k in (i, j))
            for row, relation in enumerate(situation.relations):
                if situation.settled[row, i, j]:
                    continue
                chances = {YES: float(yes[row]), NO: max(0.0, 1 - absent - float(yes[row])), ABSENT: absent}
                text = f"Is the {subject} {relation.phrase} the {obj}?"
                effort = RELATION_EFFORT + VAGUE_EFFORT * float(vague[row]) + DISTANCE_EFFORT * apart
                effort += COMPOUND_EFFORT if relation.broader else 0.0
                question = _question(QuestionKind.RELATION, text, (i, relation, j, -1), chances, effort)
                if question.bits > 1e-9:
                    yield question


def _marginals(situation: Situation, candidates: Candidates) -> NDArray[np.float64]:
    """Return the probability of each thing and, last, of absence for each object, shape (n1, n2 + 1)."""
    n1, n2 = len(situation.objects), len(situation.things)
    found = np.zeros((n1, n2 + 1))
    for i in range(n1):
        column = candidates.assignments[:, i]
        np.add.at(found[i], np.where(column == UNMATCHED, n2, column), candidates.weights)
    for group in candidates.groups:
        found[list(group)] = found[list(group)].mean(axis=0)
    return found


def _pairs(
    asked: list[int], candidates: Candidates, marginals: NDArray[np.float64], situation: Situation
) -> list[tuple[int, int]]:
    """Return the least certain pairs with an uncertain first object; if both are uncertain, in the order of names."""
    uncertain = set(asked)
    names, certainty = situation.objects, marginals.max(axis=1)
    found = [
        (i, j) for i in asked for j in candidates.stand_ins if i != j and (j not in uncertain or names[i] < names[j])
    ]
    found.sort(key=lambda pair: (round(certainty[pair[0]] + certainty[pair[1]], 9), names[pair[0]], names[pair[1]]))
    return found[:MAX_PAIRS]


def _pointing(i: int, marginal: NDArray[np.float64], situation: Situation) -> Question:
    names = (*situation.things, ABSENT)
    chances = {names[p]: float(marginal[p]) for p in np.flatnonzero(marginal)}
    text = f"Which one is the {spoken(situation.objects[i])}?"
    return _question(QuestionKind.POINTING, text, (i, None, -1, -1), chances, POINTING_EFFORT)


def _identity(i: int, p: int, chance: float, situation: Situation) -> Question:
    text = f"Is {situation.place(p)} the {spoken(situation.objects[i])}?"
    effort = IDENTITY_EFFORT + (0.0 if situation.places[p] else ID_EFFORT)
    return _question(QuestionKind.IDENTITY, text, (i, None, -1, p), {YES: chance, NO: 1 - chance}, effort)


def _joint(i: int, j: int, candidates: Candidates, n2: int) -> tuple[NDArray[np.int64], NDArray[np.float64], float]:
    """Return pairs of things (flat indices) of two objects, their probabilities, and that of an absent object."""
    rows = candidates.pinned((i, j))
    p, q = rows.assignments[:, i], rows.assignments[:, j]
    there = (p != UNMATCHED) & (q != UNMATCHED)
    joint = np.bincount(p[there] * n2 + q[there], rows.weights[there], n2 * n2)
    pairs = np.flatnonzero(joint)
    return pairs.astype(np.int64), joint[pairs].astype(np.float64), float(rows.weights[~there].sum())


def _question(
    kind: QuestionKind,
    text: str,
    about: tuple[int, Relation | None, int, int],
    chances: dict[str, float],
    effort: float,
) -> Question:
    possible = {answer: chance for answer, chance in chances.items() if chance > 1e-12}
    bits = -sum(chance * math.log2(chance) for chance in possible.values())
    ordered = sorted(possible.items(), key=lambda item: (-round(item[1], 9), item[0]))
    subject, relation, obj, thing = about
    most = math.log2(len(ordered))
    return Question(kind, text, subject, relation, obj, thing, tuple(ordered), min(max(bits, 0.0), most), effort)
