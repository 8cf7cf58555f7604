"""The implications of a relation graph, and their derivations: everything that all its pictures share.

A picture gives every object a box, and satisfies every firm fact: those that are neither optional nor hedged. The facts
are orders between the edges of boxes (:mod:`deixis.reasoning.entailment`). Facts without choices are closed by bit
sets; the others are split into pieces of the rectangle algebra. The result is always sound. It is complete for facts
that are convex on every axis, as every single relation of the TBox is, and for choices too unless the time limit is
reached (see ``complete``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import GraphError
from deixis.ontology.graph.export import node_iris, pairs_to_ntriples
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading, Relation, Relations
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.entailment.bounds import meaning
from deixis.reasoning.entailment.closing import Closed, close
from deixis.reasoning.entailment.demands import Demands, EdgeFacts, demands_of
from deixis.reasoning.entailment.derivations import Derivation, OrderDerivations, derive_by_cases, needed_facts
from deixis.reasoning.entailment.graded_words import Known, facts_of_graded_words

TIME_LIMIT = 10.0
"""Default time limit in seconds for deciding the choices in the facts; facts without choices need no search."""


@dataclass(frozen=True, slots=True)
class Support:
    """The rule and the premises of the shortest derivation of a fact, without the derivation."""

    rule: Rule
    edges: tuple[int, ...]  # edges of the graph, in the order of use


class Implications:
    r"""All implications of a relation graph, closed at once and explained on demand.

    Parameters
    ----------
    graph
        The facts.
    time_limit
        Time limit in seconds for deciding choices in the facts.
    cases
        Whether to decide the choices. Without it, only what follows without cases is computed, which takes no search.

    Raises
    ------
    LimitError
        If the facts connect more than ``MAX_CONNECTED`` objects to one another.

    Notes
    -----
    Nothing is inferred from contradictory facts (``consistent`` is False).

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("fork", (r["left"],), "plate"), Fact("napkin", (r["on"],), "plate")]
    >>> implied = Implications(RelationGraph.from_facts(r, ["fork", "plate", "napkin"], facts))
    >>> print(*implied.derive(r["left"], "fork", "napkin").lines(), sep="\n")
    left(fork, napkin)   by composition
        left(fork, plate)   stated
        under(plate, napkin)   by inverse
            on(napkin, plate)   stated
    """

    def __init__(self, graph: RelationGraph, time_limit: float = TIME_LIMIT, cases: bool = True) -> None:
        self.graph = graph
        self.vocabulary: Relations = graph.vocabulary
        self.time_limit = time_limit
        self.demands: Demands = demands_of(graph)
        settled = self.demands if cases else replace(self.demands, choices=())
        self.closed: Closed = close(settled, Deadline.after(time_limit))

    @property
    def consistent(self) -> bool:
        """True if the facts have a picture, or if time ran out before that was known (see ``decided``)."""
        return self.closed.orders is not None

    @property
    def decided(self) -> bool:
        """True if it is known whether the facts have a picture."""
        return self.closed.decided

    @property
    def complete(self) -> bool:
        """True if all implications were found."""
        return self.closed.complete

    def holds(self, relation: Relation, subject: str, obj: str) -> bool:
        """Return whether a fact holds in every picture.

        Parameters
        ----------
        relation
            The relation.
        subject, obj
            Names of the objects.

        Returns
        -------
        bool
            True if it holds.
        """
        s, o = self.graph.index(subject), self.graph.index(obj)
        if relation.reading is Reading.GRADED:
            return (relation.name, subject, obj) in self._by_words
        alternatives = meaning(relation)
        if self.closed.orders is None or s == o or len(alternatives) != 1:
            return False
        orders = self.closed.orders
        return all(orders.implies(bound, s, o) for bound in alternatives[0])

    def derive(self, relation: Relation, subject: str, obj: str) -> Derivation | None:
        """Return the shortest derivation found of a fact.

        Parameters
        ----------
        relation
            The relation.
        subject, obj
            Names of the objects.

        Returns
        -------
        Derivation or None
            The derivation, or None if the fact does not follow.

        Raises
        ------
        OutOfTimeError
            If it depends on choices and the time limit is reached.
        """
        if not self.holds(relation, subject, obj):
            return None
        if relation.reading is Reading.GRADED:
            return self._by_words[relation.name, subject, obj][0]
        found = self._derivations.derive(relation, subject, obj)
        return found if found is not None else self._by_cases(Fact(subject, (relation,), obj))

    @cached_property
    def _by_words(self) -> Known:
        """Facts of graded words that follow; none if the facts are inconsistent."""
        edges = self.demands.firm.tolist() if self.consistent else []
        return facts_of_graded_words(self.vocabulary, ((edge, self.graph.fact(edge)) for edge in edges))

    @cached_property
    def _pairs_by_words(self) -> dict[str, list[tuple[int, int]]]:
        found: dict[str, list[tuple[int, int]]] = {}
        for name, subject, obj in self._by_words:
            found.setdefault(name, []).append((self.graph.index(subject), self.graph.index(obj)))
        return found

    def _by_cases(self, goal: Fact) -> Derivation | None:
        facts = [self.graph.fact(edge) for edge in self._edges_around(goal.subject)]
        return derive_by_cases(facts, goal, self.vocabulary, Deadline.after(self.time_limit))

    def _edges_around(self, name: str) -> list[int]:
        """Return the firm facts about all objects connected with an object."""
        label, firm = self.closed.groups.label, self.demands.firm
        edges: list[int] = firm[label[self.graph.subjects[firm]] == label[self.graph.index(name)]].tolist()
        return edges

    @cached_property
    def _derivations(self) -> OrderDerivations:
        facts = EdgeFacts(self.graph)
        return OrderDerivations(self.vocabulary, self.graph.nodes, facts, self.demands.bounds, len(facts))

    def prepare_explanations(self) -> None:
        """Build the graph for the search of derivations, which the first derivation would build otherwise."""
        self._derivations.prepare()

    def pairs(self, relation: Relation) -> NDArray[np.int64]:
        """Return the pairs of nodes that have a relation in every picture.

        Parameters
        ----------
        relation
            The relation.

        Returns
        -------
        ndarray
            Positions of nodes, shape (k, 2), by subject, then object.
        """
        orders = self.closed.orders
        if relation.reading is Reading.GRADED:
            return np.array(sorted(self._pairs_by_words.get(relation.name, ())), np.int64).reshape(-1, 2)
        return np.empty((0, 2), np.int64) if orders is None else orders.pairs(relation)

    def triples(self) -> Iterator[tuple[Relation, str, str]]:
        """Yield every fact that is stated or implied, by relation, subject and object in node order.

        Yields
        ------
        tuple
            Relation, name of the subject, and name of the object.
        """
        nodes = self.graph.nodes
        for relation in self.vocabulary.values():
            for subject, obj in self.pairs(relation).tolist():
                yield relation, nodes[subject], nodes[obj]

    def ntriples(self) -> str:
        """Return every firmly stated or implied fact as a line of N-Triples, with the IRIs of the Turtle export.

        Returns
        -------
        str
            The lines, with the IRIs of the Turtle export.
        """
        iris = node_iris(self.graph)
        return "".join(pairs_to_ntriples(r, self.pairs(r), iris) for r in self.vocabulary.values())

    def inferred(self) -> Iterator[Derivation]:
        """Yield every implied fact that is not stated, with its shortest derivation.

        Yields
        ------
        Derivation
            A derivation.
        """
        for fact in self.implied():
            derivation = self.derive(fact.relations[0], fact.subject, fact.object)
            assert derivation is not None
            yield derivation

    def implied(self) -> Iterator[Fact]:
        """Yield every implied fact that is not stated, without its derivation, which is always fast.

        Yields
        ------
        Fact
            A fact.
        """
        nodes = self.graph.nodes
        for relation in self.vocabulary.values():
            for subject, obj in self._unstated(relation).tolist():
                yield Fact(nodes[subject], (relation,), nodes[obj])

    def unstated(self) -> int:
        """Return the number of facts that are implied but not stated.

        Returns
        -------
        int
            The number.
        """
        return sum(len(self._unstated(relation)) for relation in self.vocabulary.values())

    def _unstated(self, relation: Relation) -> NDArray[np.int64]:
        pairs, n = self.pairs(relation), len(self.graph.nodes)
        firm = self.demands.firm
        same = firm[self.graph.positive[firm] & (self.graph.relation_sets[firm] == relation.bit)]
        stated = self.graph.subjects[same].astype(np.int64) * n + self.graph.objects[same]
        return pairs[~np.isin(pairs[:, 0] * n + pairs[:, 1], stated)]

    def implied_with_steps(self) -> Iterator[tuple[Fact, int]]:
        """Yield every implied fact that is not stated, with its number of steps.

        Yields
        ------
        tuple
            A fact, and the number of facts in the longest of its shortest paths; 0 for a fact that follows by cases.
        """
        nodes = self.graph.nodes
        for relation in self.vocabulary.values():
            pairs = self._unstated(relation)
            begins = np.flatnonzero(np.diff(pairs[:, 0], prepend=-1))
            for some in np.split(pairs, begins[1:]) if len(pairs) else ():
                subject, objects = int(some[0, 0]), some[:, 1]
                if relation.reading is Reading.GRADED:
                    for obj in objects.tolist():
                        found = self._by_words[relation.name, nodes[subject], nodes[obj]]
                        yield Fact(nodes[subject], (relation,), nodes[obj]), len(found[1])
                    continue
                costs = np.stack(
                    [self._derivations.costs(bound, subject, objects) for bound in meaning(relation)[0]]
                ).max(axis=0)
                steps = np.where(costs > len(self.graph), 0, costs)
                for obj, count in zip(objects.tolist(), steps.tolist(), strict=True):
                    yield Fact(nodes[subject], (relation,), nodes[obj]), count

    def support(self, fact: Fact, deadline: Deadline | None = None) -> Support:
        """Return the last rule of an implied fact's derivation, and the edges of the graph that it rests on.

        The rule and the edges are those of :meth:`derive`.

        Parameters
        ----------
        fact
            The fact.
        deadline
            Time limit of a search; default: after the time limit of these implications.

        Returns
        -------
        Support
            The rule and the edges.

        Raises
        ------
        GraphError
            If the fact does not follow.
        OutOfTimeError
            If the deadline passes first.
        """
        relation, subject, obj = fact.relations[0], fact.subject, fact.object
        if not self.holds(relation, subject, obj):
            raise GraphError(f"{fact} does not follow")
        if relation.reading is Reading.GRADED:
            proof, premises = self._by_words[relation.name, subject, obj]
            return Support(proof.rule, premises)
        chains = self._derivations.chains(relation, subject, obj)
        if chains is not None:
            used = dict.fromkeys(edge for path in chains.values() for edge in path)
            return Support(self._derivations.of_chains(chains, relation, subject, obj).rule, tuple(used))
        until = Deadline.after(self.time_limit) if deadline is None else deadline
        edges = self._edges_around(subject)
        facts = [self.graph.fact(edge) for edge in edges]
        needed = {id(chosen) for chosen in needed_facts(facts, fact, self.vocabulary, until)}
        return Support(Rule.CASES, tuple(e for e, f in zip(edges, facts, strict=True) if id(f) in needed))

    def counts(self) -> dict[Relation, int]:
        """Return the number of pairs stated or implied to have each relation.

        Returns
        -------
        dict
            Number of ordered pairs by relation.
        """
        return {
            relation: len(self.pairs(relation)) if relation.reading is Reading.GRADED else self._count(relation)
            for relation in self.vocabulary.values()
        }

    def _count(self, relation: Relation) -> int:
        orders = self.closed.orders
        return 0 if orders is None else orders.count(relation)

    def count(self) -> int:
        """Return the number of stated or implied facts.

        Returns
        -------
        int
            The number, with the stated facts.
        """
        return sum(self.counts().values())
