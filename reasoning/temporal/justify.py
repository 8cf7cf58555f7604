"""Why a bound or a relation between fluents is certain, disjunctions included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from deixis.deadline import Deadline
from deixis.ontology.allen import ALL_ALLEN, Allen, members
from deixis.reasoning.constraints.disjunctive import SearchOutcome
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.geometry.allen import convex_hull
from deixis.reasoning.temporal.bounds import bound_text
from deixis.reasoning.temporal.claims import Disjunction, allen_constraints, ends
from deixis.reasoning.temporal.endpoints import converse_masks, masks_of_pairs, necessary_orders
from deixis.reasoning.temporal.fluent import ORIGIN, allen_text
from deixis.reasoning.temporal.network import SimpleTemporalNetwork
from deixis.reasoning.temporal.search import ScenarioSearch


class TimeQuestion(Protocol):
    """Something certain that a network can be asked for, as an integer, and the reasons for it."""

    def answer(self, network: SimpleTemporalNetwork) -> int:
        """Return what the network says."""

    def joined(self, answers: Sequence[int]) -> int:
        """Return what can still be said where it is one of several answers."""

    def text(self, answer: int) -> str:
        """Return an answer in words."""

    def explain(self, network: SimpleTemporalNetwork) -> Proof[str] | None:
        """Return why the network says so; None where it says nothing."""

    def restricted(
        self, why: Proof[str] | None, network: SimpleTemporalNetwork, undecided: Sequence[Disjunction]
    ) -> Proof[str] | None:
        """Return the explanation by the network, and by open disjunctions taken each by itself."""


@dataclass(frozen=True, slots=True)
class BoundQuestion:
    """By how much ``head`` is later than ``tail`` at the most."""

    tail: str
    head: str

    def answer(self, network: SimpleTemporalNetwork) -> int:
        return network.code(self.tail, self.head)

    def joined(self, answers: Sequence[int]) -> int:
        return max(answers)

    def text(self, answer: int) -> str:
        return bound_text(self.tail, self.head, answer, ORIGIN)

    def explain(self, network: SimpleTemporalNetwork) -> Proof[str] | None:
        return network.explain(self.tail, self.head)

    def restricted(
        self, why: Proof[str] | None, network: SimpleTemporalNetwork, undecided: Sequence[Disjunction]
    ) -> Proof[str] | None:
        """Leave the answer as it is: an open choice by itself bounds no time."""
        return why


@dataclass(frozen=True, slots=True)
class RelationQuestion:
    """Which Allen relations fluent ``a`` may bear to fluent ``b``."""

    a: str
    b: str

    def answer(self, network: SimpleTemporalNetwork) -> int:
        pair = np.array([[network.index(point) for point in ends(self.a) + ends(self.b)]], dtype=np.int64)
        return int(masks_of_pairs(network.distances, pair)[0]) if self.a != self.b else 1 << Allen.EQUALS

    def joined(self, answers: Sequence[int]) -> int:
        return int(np.bitwise_or.reduce(np.array(answers)))

    def text(self, answer: int) -> str:
        return allen_text(self.a, answer, self.b)

    def explain(self, network: SimpleTemporalNetwork) -> Proof[str] | None:
        """Return the orders of end points that say it; a relation that only several orders exclude together is
        refuted."""
        mask = self.answer(network)
        if self.a == self.b:
            return Proof(self.text(mask), Rule.DEFINITION)
        if mask == ALL_ALLEN:
            return None
        names = ends(self.a) + ends(self.b)
        premises = []
        for tail, head, _ in necessary_orders(mask):
            premise = network.explain(names[tail], names[head])
            assert premise is not None
            premises.append(premise)
        for relation in members(convex_hull(mask).mask & ~mask):
            assumed = Proof(allen_text(self.a, 1 << relation, self.b), Rule.CASE)
            premises.append(network.refutation(allen_constraints(self.a, 1 << relation, self.b, assumed)))
        return Proof(self.text(mask), Rule.DEFINITION, tuple(premises))

    def restricted(
        self, why: Proof[str] | None, network: SimpleTemporalNetwork, undecided: Sequence[Disjunction]
    ) -> Proof[str] | None:
        """Return the answer that counts what is stated of the two fluents too."""
        left = before = self.answer(network)
        premises = [] if why is None else [why]
        for disjunction in undecided:
            if {disjunction.a, disjunction.b} != {self.a, self.b}:
                continue
            stated = np.array([disjunction.relations], dtype=np.uint16)
            narrower = left & int((stated if disjunction.a == self.a else converse_masks(stated))[0])
            if narrower != left:
                left = narrower
                premises.append(disjunction.why)
        return why if left == before else Proof(self.text(left), Rule.INTERSECTION, tuple(premises))


def justify(
    question: TimeQuestion,
    network: SimpleTemporalNetwork,
    disjunctions: Sequence[Disjunction],
    deadline: Deadline,
    most: int,
) -> Proof[str] | None:
    """Return why the answer to a question is what it is; None where there is nothing to say, or the disjunctions
    conflict.

    Disjunctions that stay open are gone through case by case, up to ``most`` cases and until the deadline, and where
    the cases agree on more than the network alone says, they are the explanation. The network is changed.
    """
    forced = ScenarioSearch(network, disjunctions, deadline, explain=True)
    if forced.propagate() is SearchOutcome.REFUTED:
        return None
    undecided = forced.still_open()
    answers: list[int] = []
    cases: list[Proof[str]] = []

    def look() -> None:
        case = question.explain(network)
        answers.append(question.answer(network))
        if case is not None:
            cases.append(case)

    found, complete = (
        ScenarioSearch(network, undecided, deadline, explain=True).visit(look, most) if undecided else (0, False)
    )
    if complete and len(cases) == found > 0:
        joined = question.joined(answers)
        if joined != question.answer(network):
            premises = (*(disjunction.why for disjunction in undecided), *cases)
            return Proof(question.text(joined), Rule.CASES, premises)
    return question.restricted(question.explain(network), network, undecided)
