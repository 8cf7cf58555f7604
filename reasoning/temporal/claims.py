"""Statements about time as difference constraints: fluents, differences, and Allen relations, also disjunctive ones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.reasoning.constraints.difference import STRICT
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.geometry.allen import convex_pieces
from deixis.reasoning.temporal.bounds import Bounds, bound_text
from deixis.reasoning.temporal.endpoints import necessary_orders
from deixis.reasoning.temporal.fluent import ORIGIN, AllenStatement, EndDifference, Fluent
from deixis.reasoning.temporal.network import DifferenceConstraint, SimpleTemporalNetwork, difference


@dataclass(frozen=True, slots=True)
class Disjunction:
    """A non-convex set of Allen relations between fluents a and b, as a union of convex pieces."""

    a: str
    relations: int
    b: str
    why: Proof[str]

    @property
    def points(self) -> tuple[str, str, str, str]:
        """Names of the ends of a, then of b."""
        return ends(self.a) + ends(self.b)

    @property
    def pieces(self) -> tuple[int, ...]:
        """Convex masks whose union is the set of relations."""
        return tuple(piece.mask for piece in convex_pieces(self.relations))


@dataclass(frozen=True, slots=True)
class Claim:
    """The content of one statement, as constraints or as a disjunction of constraints.

    A statement gives both bounds of a time, or a relation. ``why`` is the whole statement; explanations rest on those
    of its ``leaves`` that they need.
    """

    why: Proof[str]
    constraints: tuple[DifferenceConstraint, ...] = ()
    disjunction: Disjunction | None = None

    @property
    def leaves(self) -> frozenset[Proof[str]]:
        """Stated leaves of the explanations that rest on the claim."""
        return frozenset(leaf for constraint in self.constraints for leaf in constraint.why.leaves()) | {self.why}

    @property
    def fluents(self) -> tuple[str, ...]:
        """Ids of the fluents that the claim is about."""
        if self.disjunction is not None:
            return self.disjunction.a, self.disjunction.b
        named = (point for c in self.constraints for point in (c.tail, c.head) if point != ORIGIN)
        return tuple(dict.fromkeys(point.rpartition(".")[0] for point in named))


def ends(fluent: str) -> tuple[str, str]:
    """Return the names of the two ends of a fluent.

    Parameters
    ----------
    fluent
        Id of the fluent.

    Returns
    -------
    tuple
        Names of start and finish.
    """
    return f"{fluent}.start", f"{fluent}.finish"


def proper_interval(fluent: str) -> DifferenceConstraint:
    """Return the constraint that a fluent starts before it finishes.

    Parameters
    ----------
    fluent
        Id of the fluent.

    Returns
    -------
    DifferenceConstraint
        The constraint.
    """
    start, finish = ends(fluent)
    return DifferenceConstraint(finish, start, STRICT, Proof(f"{start} < {finish}", Rule.PROPER_INTERVAL))


def allen_constraints(a: str, relations: int, b: str, why: Proof[str]) -> tuple[DifferenceConstraint, ...]:
    """Return the difference constraints that define a convex set of Allen relations.

    Parameters
    ----------
    a, b
        Ids of the fluents.
    relations
        Mask of a convex set of Allen relations of a to b.
    why
        Proof that the constraints cite.

    Returns
    -------
    tuple of DifferenceConstraint
        The constraints; none for a set of all relations.
    """
    names = ends(a) + ends(b)
    found = []
    for tail, head, code in necessary_orders(relations):
        text = bound_text(names[tail], names[head], code, ORIGIN)
        found.append(DifferenceConstraint(names[tail], names[head], code, Proof(text, Rule.DEFINITION, (why,))))
    return tuple(found)


def claims_of(item: Fluent | AllenStatement | EndDifference) -> tuple[Claim, ...]:
    """Return the claims of a statement: of the bounds of a fluent, of a difference or of a relation.

    Parameters
    ----------
    item
        The statement.

    Returns
    -------
    tuple of Claim
        The claims.
    """
    if isinstance(item, AllenStatement):
        return (_allen_claim(item),) if item.relations != ALL_ALLEN else ()
    if isinstance(item, EndDifference):
        return _bounds_claim(item.tail, item.head, item.bounds, str(item), item.source)
    start, finish = item.points
    places = [f"{item.source}.{end}" if item.source else None for end in ("start", "finish")]
    return (
        *_bounds_claim(ORIGIN, start, item.start, f"{start} in {item.start}", places[0]),
        *_bounds_claim(ORIGIN, finish, item.finish, f"{finish} in {item.finish}", places[1]),
    )


def _bounds_claim(tail: str, head: str, bounds: Bounds, text: str, source: str | None) -> tuple[Claim, ...]:
    """Return the claim that a difference lies within bounds, or no claim if both bounds are infinite."""
    constraints = difference(tail, head, bounds, source)
    if len(constraints) < 2:
        return tuple(Claim(constraint.why, (constraint,)) for constraint in constraints)
    return (Claim(Proof(text, Rule.STATED, source=source), constraints),)


def _allen_claim(item: AllenStatement) -> Claim:
    why = Proof(str(item), Rule.STATED, source=item.source)
    if len(convex_pieces(item.relations)) == 1:
        return Claim(why, allen_constraints(item.a, item.relations, item.b, why))
    return Claim(why, disjunction=Disjunction(item.a, item.relations, item.b, why))


def network_of(fluents: Iterable[str]) -> SimpleTemporalNetwork:
    """Return a network with the ends of fluents, each of which starts before it finishes.

    Parameters
    ----------
    fluents
        Ids of the fluents.

    Returns
    -------
    SimpleTemporalNetwork
        The network.
    """
    network = SimpleTemporalNetwork()
    for fluent in fluents:
        add_fluent(network, fluent)
    return network


def add_fluent(network: SimpleTemporalNetwork, fluent: str) -> None:
    """Add the two ends of a fluent, with no other constraints.

    Parameters
    ----------
    network
        The network, which is changed.
    fluent
        Id of the fluent.
    """
    for point in ends(fluent):
        network.add_point(point)
    network.add([proper_interval(fluent)])


def disjunctions(claims: Iterable[Claim]) -> Iterator[Disjunction]:
    """Yield the disjunctions among claims.

    Parameters
    ----------
    claims
        The claims.

    Yields
    ------
    Disjunction
        A claim with several alternatives.
    """
    return (claim.disjunction for claim in claims if claim.disjunction is not None)
