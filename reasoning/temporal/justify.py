"""Explain why a bound or a relation between fluents is certain, with disjunctions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from deixis.deadline import Deadline
from deixis.ontology.relations.allen import ALL_ALLEN, Allen, members
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
    """A question to a network, with an integer as the answer, and the explanation of the answer."""

    def answer(self, network: SimpleTemporalNetwork) -> int:
        """Return the answer by a network.

        Parameters
        ----------
        network
            The network.

        Returns
        -------
        int
            The answer as a code or a mask.
        """
        ...

    def joined(self, answers: Sequence[int]) -> int:
        """Return the answer that holds if one of several answers does.

        Parameters
        ----------
        answers
            Answers of single cases.

        Returns
        -------
        int
            The answer that all of them imply.
        """
        ...

    def text(self, answer: int) -> str:
        """Return an answer in words.

        Parameters
        ----------
        answer
            An answer.

        Returns
        -------
        str
            A sentence without a full stop.
        """
        ...

    def explain(self, network: SimpleTemporalNetwork) -> Proof[str] | None:
        """Return the explanation of the network's answer, or None without any information.

        Parameters
        ----------
        network
            The network.

        Returns
        -------
        Proof[str] or None
            The proof, or None without any information.
        """
        ...

    def restricted(
        self, why: Proof[str] | None, network: SimpleTemporalNetwork, undecided: Sequence[Disjunction]
    ) -> Proof[str] | None:
        """Return the explanation by the network, and by each open disjunction on its own.

        Parameters
        ----------
        why
            Explanation by the network alone.
        network
            The network.
        undecided
            Open disjunctions.

        Returns
        -------
        Proof[str] or None
            The explanation, or None without any information.
        """
        ...


@dataclass(frozen=True, slots=True)
class BoundQuestion:
    """The question of the upper bound of ``head`` minus ``tail``."""

    tail: str
    head: str

    def answer(self, network: SimpleTemporalNetwork) -> int:
        """Return the answer by a network.

        Parameters
        ----------
        network
            The network.

        Returns
        -------
        int
            Code of the upper bound.
        """
        return network.code(self.tail, self.head)

    def joined(self, answers: Sequence[int]) -> int:
        """Return the answer that holds if one of several answers does.

        Parameters
        ----------
        answers
            Codes of single cases.

        Returns
        -------
        int
            The weakest bound.
        """
        return max(answers)

    def text(self, answer: int) -> str:
        """Return an answer in words.

        Parameters
        ----------
        answer
            Code of a bound.

        Returns
        -------
        str
            An inequality.
        """
        return bound_text(self.tail, self.head, answer, ORIGIN)

    def explain(self, network: SimpleTemporalNetwork) -> Proof[str] | None:
        """Return the explanation of the network's answer, or None without any information.

        Parameters
        ----------
        network
            The network.

        Returns
        -------
        Proof[str] or None
            The proof, or None without a bound.
        """
        return network.explain(self.tail, self.head)

    def restricted(
        self, why: Proof[str] | None, network: SimpleTemporalNetwork, undecided: Sequence[Disjunction]
    ) -> Proof[str] | None:
        """Return the explanation unchanged, since an open disjunction on its own bounds no time.

        Parameters
        ----------
        why
            Explanation by the network alone.
        network
            The network.
        undecided
            Open disjunctions.

        Returns
        -------
        Proof[str] or None
            ``why``.
        """
        return why


@dataclass(frozen=True, slots=True)
class RelationQuestion:
    """The question of the Allen relations that fluent ``a`` may have to fluent ``b``."""

    a: str
    b: str

    def answer(self, network: SimpleTemporalNetwork) -> int:
        """Return the answer by a network.

        Parameters
        ----------
        network
            The network.

        Returns
        -------
        int
            Mask of the possible relations.
        """
        pair = np.array([[network.index(point) for point in ends(self.a) + ends(self.b)]], dtype=np.int64)
        return int(masks_of_pairs(network.distances, pair)[0]) if self.a != self.b else 1 << Allen.EQUALS

    def joined(self, answers: Sequence[int]) -> int:
        """Return the answer that holds if one of several answers does.

        Parameters
        ----------
        answers
            Masks of single cases.

        Returns
        -------
        int
            Their union.
        """
        return int(np.bitwise_or.reduce(np.array(answers)))

    def text(self, answer: int) -> str:
        """Return an answer in words.

        Parameters
        ----------
        answer
            Mask of relations.

        Returns
        -------
        str
            A phrase.
        """
        return allen_text(self.a, answer, self.b)

    def explain(self, network: SimpleTemporalNetwork) -> Proof[str] | None:
        """Return the orders of end points that give the answer, with refutations of single excluded relations.

        Parameters
        ----------
        network
            The network.

        Returns
        -------
        Proof[str] or None
            The proof, or None if all relations are possible.
        """
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
        """Return the answer that takes statements about the two fluents into account.

        Parameters
        ----------
        why
            Explanation by the network alone.
        network
            The network.
        undecided
            Open disjunctions.

        Returns
        -------
        Proof[str] or None
            The explanation, or None if all relations are possible.
        """
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
    """Explain the answer to a question.

    Open disjunctions are split case by case. If the cases agree on more than the network alone implies, they are the
    explanation. The network is changed.

    Parameters
    ----------
    question
        The question.
    network
        The network, which is changed.
    disjunctions
        The disjunctions of the timeline.
    deadline
        Time limit for the cases.
    most
        Maximum number of cases.

    Returns
    -------
    Proof[str] or None
        The proof, or None without information or with conflicting disjunctions.
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
