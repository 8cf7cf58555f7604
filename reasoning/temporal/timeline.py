"""A timeline: statements about the times of fluents, kept consistent as it grows, and their implications.

Fluents and convex relations are added to the simple temporal network at once, which refuses contradictions. Disjunctive
relations (before or after) are decided when the timeline is queried.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from deixis.deadline import Deadline
from deixis.reasoning.constraints.disjunctive import SearchOutcome
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.temporal.chronology import Chronology, Status
from deixis.reasoning.temporal.claims import Claim, Disjunction, add_fluent, claims_of, disjunctions, ends, network_of
from deixis.reasoning.temporal.endpoints import allen_masks, converse_masks
from deixis.reasoning.temporal.errors import FluentError, TemporalConflictError, UnknownFluentError
from deixis.reasoning.temporal.fluent import Fluent, TemporalRelation
from deixis.reasoning.temporal.justify import BoundQuestion, RelationQuestion, TimeQuestion, justify
from deixis.reasoning.temporal.network import SimpleTemporalNetwork
from deixis.reasoning.temporal.search import ScenarioSearch, minimal_conflict, refuted

MAX_SCENARIOS = 64
"""Maximum number of scenarios of undecided disjunctions over which the implications are computed exactly."""


class Timeline:
    """Fluents, and statements about their times.

    >>> from deixis.reasoning.temporal.bounds import Bounds
    >>> from deixis.reasoning.temporal.fluent import AllenStatement, EndDifference, Statement
    >>> timeline = Timeline([Fluent("f1", Statement("cup", "on", "tray"), Bounds(0, 2), Bounds(5, 9))])
    >>> timeline.add(Fluent("f2", Statement("cup", "on", "table")))
    >>> timeline.add(AllenStatement("f1", 0b11, "f2"))  # before or meets
    >>> timeline.add(EndDifference("f1.finish", "f2.start", Bounds(1, 2)))
    >>> str(timeline.chronology().start("f2"))
    '[6, 11]'

    Raises TemporalConflictError for a statement that contradicts the others, which is then not added; FluentError if
    the id of a fluent is in use; UnknownFluentError for a relation to an unknown fluent.
    """

    def __init__(self, fluents: Iterable[Fluent] = (), relations: Iterable[TemporalRelation] = ()) -> None:
        self._fluents: dict[str, Fluent] = {}
        self._claims: dict[Fluent | TemporalRelation, tuple[Claim, ...]] = {}
        self._network = SimpleTemporalNetwork()
        for item in (*fluents, *relations):
            self.add(item)

    @property
    def fluents(self) -> tuple[Fluent, ...]:
        """Fluents in the order in which they were added."""
        return tuple(self._fluents.values())

    @property
    def network(self) -> SimpleTemporalNetwork:
        """Network of all statements without disjunctions; do not change it."""
        return self._network

    def add(self, item: Fluent | TemporalRelation, time_limit: float = 10.0) -> None:
        """Add a fluent or a relation; adding a statement again changes nothing.

        Parameters
        ----------
        item
            The statement.
        time_limit
            Seconds for making the explanation of a contradiction minimal.

        Raises
        ------
        TemporalConflictError
            If the statement contradicts the others.
        """
        if item in self._claims:
            return
        if isinstance(item, Fluent):
            if item.id in self._fluents:
                raise FluentError(f"the fluent '{item.id}' is stated twice; give every fluent its own id")
            add_fluent(self._network, item.id)
        else:
            for fluent in item.fluents:
                self.fluent(fluent)
        claims = claims_of(item)
        constraints = [constraint for claim in claims for constraint in claim.constraints]
        if not self._network.try_add(constraints):
            proof = self._network.refutation(constraints)
            raise minimal_conflict([*self._all_claims(), *claims], proof, Deadline.after(time_limit))
        self._network.keep()
        self._claims[item] = claims
        if isinstance(item, Fluent):
            self._fluents[item.id] = item

    def fluent(self, fluent_id: str) -> Fluent:
        """Return a fluent by its id.

        Parameters
        ----------
        fluent_id
            The id.

        Returns
        -------
        Fluent
            The fluent.

        Raises
        ------
        UnknownFluentError
            If there is no such fluent.
        """
        try:
            return self._fluents[fluent_id]
        except KeyError:
            raise UnknownFluentError("fluent", fluent_id, self._fluents) from None

    def retract(self, item: Fluent | TemporalRelation) -> None:
        """Remove a statement, and recompute the rest.

        Parameters
        ----------
        item
            The statement.

        Raises
        ------
        UnknownFluentError
            If it was not stated.
        FluentError
            If it is a fluent that relations refer to.
        """
        if item not in self._claims:
            raise UnknownFluentError("statement", str(item), map(str, self._claims))
        if isinstance(item, Fluent):
            related = [other for other in self._claims if not isinstance(other, Fluent) and item.id in other.fluents]
            if related:
                raise FluentError(f"retract '{related[0]}' first: it refers to the fluent '{item.id}'")
            del self._fluents[item.id], self._claims[item]
            self._network = network_of(self._fluents)
            self._network.add([c for claim in self._all_claims() for c in claim.constraints])
        else:
            self._network.retract(c for claim in self._claims.pop(item) for c in claim.constraints)

    def _all_claims(self) -> list[Claim]:
        return [claim for claims in self._claims.values() for claim in claims]

    def chronology(self, time_limit: float = 10.0) -> Chronology:
        """Return the implied bounds of all times, and the possible relations of every pair of fluents.

        If the time limit is reached before consistency is known, the status is UNDECIDED, and the chronology holds what
        is certain without the open disjunctions.

        Parameters
        ----------
        time_limit
            Seconds for the search over disjunctions.

        Returns
        -------
        Chronology
            The chronology.

        Raises
        ------
        TemporalConflictError
            If the disjunctions are inconsistent; making the proof minimal may take as long again.
        """
        deadline = Deadline.after(time_limit)
        claims = self._all_claims()
        network = self._network.copy()
        forced = ScenarioSearch(network, list(disjunctions(claims)), deadline)
        if forced.propagate() is SearchOutcome.REFUTED:
            raise self._conflict(claims, time_limit)
        undecided = forced.still_open()
        views = _Views(self.fluents, network)
        if not undecided:
            views.look()
            return views.chronology(Status.CONSISTENT, exact=True)
        found, complete = ScenarioSearch(network, undecided, deadline).visit(views.look, MAX_SCENARIOS)
        if complete and not found:
            raise self._conflict(claims, time_limit)
        if not complete:
            views.forget()
            views.look()
            views.restrict(undecided)
        return views.chronology(Status.CONSISTENT if found else Status.UNDECIDED, complete)

    def _conflict(self, claims: list[Claim], time_limit: float) -> TemporalConflictError:
        """Return the conflict between disjunctions, proved again with reasons and made minimal as time allows."""
        deadline = Deadline.after(time_limit)
        proof = refuted(claims, deadline)
        if proof is None:
            statements = tuple(claim.why for claim in claims)
            everything = Proof("no alternative is left", Rule.CASES, statements)
            return TemporalConflictError(everything, minimal=False, statements=statements)
        return minimal_conflict(claims, proof, deadline)

    def explain_relation(self, a: str, b: str, time_limit: float = 10.0) -> Proof[str] | None:
        """Explain why one fluent must have one of its possible relations to another.

        Parameters
        ----------
        a, b
            Ids of the fluents.
        time_limit
            Seconds for the search over disjunctions.

        Returns
        -------
        Proof[str] or None
            The proof, or None if all relations are possible.
        """
        return self._justify(RelationQuestion(self.fluent(a).id, self.fluent(b).id), time_limit)

    def explain_bound(self, tail: str, head: str, time_limit: float = 10.0) -> Proof[str] | None:
        """Explain the upper bound on the difference of two points.

        A point is ``ID.start`` or ``ID.finish``, or ``origin``: the upper bound of a fluent's start is
        ``explain_bound("origin", "f1.start")``, its lower bound ``explain_bound("f1.start", "origin")``.

        Parameters
        ----------
        tail, head
            Names of the points.
        time_limit
            Seconds for the search over disjunctions.

        Returns
        -------
        Proof[str] or None
            The proof, or None without a bound.
        """
        self._network.index(tail)
        self._network.index(head)
        return self._justify(BoundQuestion(tail, head), time_limit)

    def _justify(self, question: TimeQuestion, time_limit: float) -> Proof[str] | None:
        deadline = Deadline.after(time_limit)
        return justify(question, self._network.copy(), list(disjunctions(self._all_claims())), deadline, MAX_SCENARIOS)


class _Views:
    """The implications of the network for the fluents, collected from each scenario while the network is in it."""

    def __init__(self, fluents: tuple[Fluent, ...], network: SimpleTemporalNetwork) -> None:
        self._fluents = fluents
        self._network = network
        points = np.array([[network.index(p) for p in ends(f.id)] for f in fluents], dtype=np.int64).reshape(-1, 2)
        self._starts, self._finishes = points.T
        self.forget()

    def forget(self) -> None:
        self._spans: list[np.ndarray[tuple[int, ...], np.dtype[np.int64]]] = []
        self._masks = np.zeros((len(self._fluents), len(self._fluents)), dtype=np.uint16)

    def look(self) -> None:
        distances = self._network.distances
        points = np.stack([np.zeros_like(self._starts), self._starts, self._finishes], axis=1)
        self._spans.append(distances[points[:, :, None], points[:, None, :]])
        self._masks |= allen_masks(distances, self._starts, self._finishes)

    def restrict(self, disjunctions: Iterable[Disjunction]) -> None:
        """Restrict the pairs of disjunctions to the relations that these state."""
        places = {fluent.id: place for place, fluent in enumerate(self._fluents)}
        for disjunction in disjunctions:
            a, b = places[disjunction.a], places[disjunction.b]
            self._masks[a, b] &= disjunction.relations
            self._masks[b, a] = converse_masks(self._masks[a : a + 1, b])[0]

    def chronology(self, status: Status, exact: bool) -> Chronology:
        return Chronology(self._fluents, np.stack(self._spans), self._masks, status, exact)
