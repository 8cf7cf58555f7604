"""Disjunctions over a simple temporal network: forced pieces, the remaining scenarios, and proofs of inconsistency.

Each disjunction is a choice between convex pieces, and each piece a conjunction of difference constraints, so the
search is that of :mod:`deixis.reasoning.constraints.disjunctive` (the meta-search of temporal constraint satisfaction:
Dechter, Meiri and Pearl 1991). This module adds proofs: the last piece left holds by elimination, and disjunctions
exclude each other by cases.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from deixis.deadline import Deadline
from deixis.reasoning.constraints.difference import Difference
from deixis.reasoning.constraints.disjunctive import Clause, Clauses, Level, Search, SearchOutcome
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.temporal.claims import Claim, Disjunction, allen_constraints, disjunctions, network_of
from deixis.reasoning.temporal.endpoints import necessary_orders
from deixis.reasoning.temporal.errors import TemporalConflictError
from deixis.reasoning.temporal.fluent import allen_text
from deixis.reasoning.temporal.network import DifferenceConstraint, SimpleTemporalNetwork


class ScenarioSearch(Search):
    """A search through the scenarios: consistent choices of a piece for every disjunction.

    With ``explain``, every constraint that it adds to the network has its proof, and ``proof`` is the proof of
    inconsistency after a search without a scenario.
    """

    def __init__(
        self,
        network: SimpleTemporalNetwork,
        disjunctions: Sequence[Disjunction],
        deadline: Deadline,
        explain: bool = False,
    ) -> None:
        super().__init__(network.differences, Clauses(_clause(network, d) for d in disjunctions), deadline)
        self.proof: Proof[str] | None = None
        self._temporal, self._disjunctions, self._explain = network, disjunctions, explain
        self._against: dict[Level, list[Proof[str]]] = {}  # proofs that the pieces tried so far fail

    def still_open(self) -> list[Disjunction]:
        """Return the disjunctions that are neither decided nor implied.

        Returns
        -------
        list of Disjunction
            The disjunctions.
        """
        return [self._disjunctions[k] for k in self.open()]

    def visit(self, look: Callable[[], None], most: int) -> tuple[int, bool]:
        """Call a function while the network holds each scenario; the network is unchanged in the end.

        Parameters
        ----------
        look
            The function.
        most
            Maximum number of scenarios.

        Returns
        -------
        tuple
            Number of scenarios visited, and whether these are all.
        """
        found = 0
        while self.advance() is SearchOutcome.SOLVED and found < most:
            look()
            found += 1
        self._temporal.back(self.base)
        return found, self.outcome is SearchOutcome.REFUTED

    def _level(self, clause: int, left: int) -> Level:
        level = super()._level(clause, left)
        if self._explain:
            self._against[level] = []
            if level.forced:  # refuted pieces first: they are the reason for the one that is left
                admitted = self.clauses.admitted(self.network, clause)
                level.order = sorted(level.order, key=admitted.__getitem__)
        return level

    def _note_taken(self, level: Level, number: int) -> None:
        if self._explain:
            why = Proof(self._text(level, number), Rule.CASE)
            if level.forced:
                premises = (self._disjunctions[level.clause].why, *self._against[level])
                why = Proof(why.claim, Rule.ELIMINATION, premises)
            self._temporal.record(level.length, self._constraints(level, number, why))

    def _note_refused(self, level: Level, number: int, difference: Difference, cycle: Sequence[int]) -> None:
        if self._explain:
            assumed = self._constraints(level, number, Proof(self._text(level, number), Rule.CASE))
            added = len(self.network) - level.length
            self._temporal.record(level.length, assumed[:added])
            self._against[level].append(self._temporal.cycle(assumed[added]))

    def _note_failed(self, failed: Level, into: Level | None) -> None:
        if self._explain and not failed.solved:
            premises = (self._disjunctions[failed.clause].why, *self._against.pop(failed))
            proof = Proof("no alternative is left", Rule.CASES, premises)
            if into is None:
                self.proof = proof
            else:
                self._against[into].append(proof)

    def _text(self, level: Level, number: int) -> str:
        disjunction = self._disjunctions[level.clause]
        return allen_text(disjunction.a, disjunction.pieces[number], disjunction.b)

    def _constraints(self, level: Level, number: int, why: Proof[str]) -> tuple[DifferenceConstraint, ...]:
        disjunction = self._disjunctions[level.clause]
        return allen_constraints(disjunction.a, disjunction.pieces[number], disjunction.b, why)


def _clause(network: SimpleTemporalNetwork, disjunction: Disjunction) -> Clause:
    points = [network.index(point) for point in disjunction.points]
    return Clause(
        tuple(
            tuple(Difference(0, points[tail], points[head], code) for tail, head, code in necessary_orders(piece))
            for piece in disjunction.pieces
        )
    )


def refuted(claims: Sequence[Claim], deadline: Deadline) -> Proof[str] | None:
    """Search for a proof that claims cannot all hold.

    Parameters
    ----------
    claims
        The claims.
    deadline
        Time limit.

    Returns
    -------
    Proof[str] or None
        The proof, or None if they can hold or the deadline comes first.
    """
    network = network_of(dict.fromkeys(fluent for claim in claims for fluent in claim.fluents))
    for claim in claims:
        if not network.try_add(claim.constraints):
            return network.refutation(claim.constraints)
    search = ScenarioSearch(network, list(disjunctions(claims)), deadline, explain=True)
    return search.proof if search.advance() is SearchOutcome.REFUTED else None


def minimal_conflict(claims: Sequence[Claim], proof: Proof[str], deadline: Deadline) -> TemporalConflictError:
    """Return the error for claims that a proof refutes, with a minimal set of claims.

    Only claims that the proof rests on are considered. At the deadline, the error says that the set may not be minimal.

    Parameters
    ----------
    claims
        The claims.
    proof
        Proof that they cannot all hold.
    deadline
        Time limit for making the set minimal.

    Returns
    -------
    TemporalConflictError
        The error, which is not raised.
    """

    def resting(chosen: Sequence[Claim]) -> list[Claim]:
        stated = set(proof.leaves())
        return [claim for claim in chosen if stated & claim.leaves]

    def test(chosen: list[Claim]) -> list[Claim] | None:
        nonlocal proof
        again = refuted(chosen, deadline)
        if again is None:
            return None
        proof = again
        return resting(chosen)

    found = minimal_subset(resting(claims), test, deadline, keep_last=True)
    whole = {leaf: claim.why for claim in found.items for leaf in claim.leaves}
    return TemporalConflictError(proof, found.proved, tuple(dict.fromkeys(whole[leaf] for leaf in proof.leaves())))
