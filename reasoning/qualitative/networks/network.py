"""Represent a qualitative constraint network: stated relations between things (Montanari 1974)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Source
from deixis.reasoning.errors import NetworkError
from deixis.reasoning.qualitative.calculi.calculus import Calculus

if TYPE_CHECKING:
    import networkx as nx


@dataclass(frozen=True, slots=True)
class Constraint:
    """A statement that one of the atoms of ``relation`` holds from thing ``first`` to thing ``second``."""

    first: int
    second: int
    relation: int
    source: Source | None = None


@dataclass(frozen=True)
class ConstraintArrays:
    """The constraints of a network as arrays, each distinct relation once."""

    firsts: NDArray[np.int64]  # (m,)
    seconds: NDArray[np.int64]  # (m,)
    ids: NDArray[np.int64]  # (m,): positions in ``relations``
    relations: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Network:
    """Constraints between ``size`` things, numbered from 0; pairs without a constraint may have any relation.

    Parameters
    ----------
    calculus
        The calculus of the relations.
    size
        The number of things.
    constraints
        Constraints on ordered pairs; several on one pair hold together.
    names
        The names of the things, for messages; None if they are known by number only.

    Raises
    ------
    NetworkError
        If a constraint is on a thing outside the network or has atoms that the calculus lacks, or if there are not
        as many names as things.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> rcc8 = calculus("rcc8")
    >>> constraints = (Constraint(0, 1, rcc8.relation(["NTPP"])), Constraint(1, 2, rcc8.relation(["NTPP"])))
    >>> network = Network(rcc8, 3, constraints, ("napkin", "plate", "table"))
    >>> network.name(0), len(network.only(constraints[:1]).constraints), network.compact()[0].size
    ('napkin', 1, 3)
    """

    calculus: Calculus
    size: int
    constraints: tuple[Constraint, ...]
    names: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if self.size < 0 or (self.names is not None and len(self.names) != self.size):
            raise NetworkError(f"a network of {self.size} things needs {self.size} names, got {len(self.names or ())}")
        stated, arrays = self.constraints, self.arrays
        if not stated:
            return
        lowest = np.minimum(arrays.firsts, arrays.seconds)
        outside = np.flatnonzero((lowest < 0) | (np.maximum(arrays.firsts, arrays.seconds) >= self.size))
        if len(outside):
            wrong = stated[outside[0]]
            place = "" if wrong.source is None else f"{wrong.source}: "
            raise NetworkError(
                f"{place}a constraint on {wrong.first} and {wrong.second}, but the things of this network "
                f"are 0 to {self.size - 1}"
            )
        universal = self.calculus.universal
        odd = [relation for relation in arrays.relations if relation & ~universal]
        if odd:
            raise NetworkError(f"{self.calculus.name} has {len(self.calculus.atoms)} atoms; {odd[0]:#x} has others")

    @cached_property
    def arrays(self) -> ConstraintArrays:
        """The constraints as arrays."""
        whole = [constraint.relation for constraint in self.constraints]
        place = {relation: position for position, relation in enumerate(dict.fromkeys(whole))}
        ids = [place[relation] for relation in whole]
        return ConstraintArrays(
            np.array([constraint.first for constraint in self.constraints], dtype=np.int64),
            np.array([constraint.second for constraint in self.constraints], dtype=np.int64),
            np.array(ids, dtype=np.int64),
            tuple(place),
        )

    def name(self, thing: int) -> str:
        """Return the name of a thing, or its number if it has none.

        Parameters
        ----------
        thing
            Number of the thing.

        Returns
        -------
        str
            Its name, or the number in digits.
        """
        return str(thing) if self.names is None else self.names[thing]

    def to_networkx(self) -> nx.MultiDiGraph[Any]:
        """Return the network as a ``networkx.MultiDiGraph`` with one edge per constraint.

        Returns
        -------
        networkx.MultiDiGraph
            Nodes are the numbers of the things, with their ``name`` (:meth:`name`). Edges lead from the first thing to
            the second, with ``relation`` (the names of the atoms of which one holds) and ``source`` (file:line:column
            or None). The graph's attribute ``calculus`` is the name of the calculus.

        Examples
        --------
        >>> import networkx as nx
        >>> from deixis.reasoning.qualitative.calculi.registry import calculus
        >>> allen = calculus("allen")
        >>> before, meets = (1 << allen.atoms.index(atom) for atom in ("<", "m"))
        >>> stated = (Constraint(0, 1, before | meets), Constraint(1, 2, before))
        >>> graph = Network(allen, 4, stated, ("soup", "fish", "cake", "tea")).to_networkx()
        >>> graph.edges[0, 1, 0]["relation"], graph.graph["calculus"]
        (('<', 'm'), 'allen')
        >>> [graph.nodes[thing]["name"] for thing in nx.isolates(graph)]
        ['tea']
        """
        import networkx as nx

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph(calculus=self.calculus.name)
        graph.add_nodes_from((thing, {"name": self.name(thing)}) for thing in range(self.size))
        atoms = self.calculus.atoms
        for constraint in self.constraints:
            graph.add_edge(
                constraint.first,
                constraint.second,
                relation=tuple(atom for code, atom in enumerate(atoms) if constraint.relation >> code & 1),
                source=str(constraint.source) if constraint.source else None,
            )
        return graph

    def only(self, constraints: Iterable[Constraint]) -> Network:
        """Return the same things with other constraints.

        Parameters
        ----------
        constraints
            Constraints on the same things.

        Returns
        -------
        Network
            The network with only these constraints.
        """
        return replace(self, constraints=tuple(constraints))

    def compact(self) -> tuple[Network, NDArray[np.int64]]:
        """Return the network of the things that constraints relate, and their numbers here, in order.

        Returns
        -------
        tuple
            The smaller network, and the number here of each of its things, shape (k,).
        """
        (small,), kept = compacted([self])
        return small, kept

    def stated(self, first: int, second: int) -> int:
        """Return the intersection of the constraints on one pair; the identity for a thing and itself.

        Parameters
        ----------
        first, second
            Numbers of two things.

        Returns
        -------
        int
            Relation of ``first`` to ``second`` as a bit mask; the universal one where nothing is stated, 0 for a
            contradiction.
        """
        relation = self.calculus.universal if first != second else 1 << self.calculus.identity
        for constraint in self.constraints:
            if (constraint.first, constraint.second) == (first, second):
                relation &= constraint.relation
            elif (constraint.second, constraint.first) == (first, second):
                relation &= self.calculus.converse(constraint.relation)
        return relation


def compacted(networks: Sequence[Network]) -> tuple[tuple[Network, ...], NDArray[np.int64]]:
    """Return networks over the things that a constraint of any network relates, and their numbers here, in order.

    Parameters
    ----------
    networks
        Networks over the same things.

    Returns
    -------
    tuple
        The smaller networks, and the number of each of their things in the given ones, shape (k,).
    """
    ends = [end for network in networks for end in (network.arrays.firsts, network.arrays.seconds)]
    kept = np.unique(np.concatenate(ends))
    place = {int(thing): position for position, thing in enumerate(kept)}
    compact = []
    for network in networks:
        stated = network.constraints
        constraints = tuple(Constraint(place[c.first], place[c.second], c.relation, c.source) for c in stated)
        names = None if network.names is None else tuple(network.names[thing] for thing in place)
        compact.append(Network(network.calculus, len(place), constraints, names))
    return tuple(compact), kept


def on_axes(network: Network) -> tuple[Network, ...] | None:
    """Return a network for each axis if every relation is a product; None otherwise.

    Composition and intersection of products are products, so that the axes are independent networks (Balbiani,
    Condotta and Fariñas del Cerro 1998, for rectangles). The empty relation is empty on every axis.

    Parameters
    ----------
    network
        A network in a product calculus, or in another one.

    Returns
    -------
    tuple of Network or None
        Networks in the calculi of the axes, or the network itself in a calculus that is not a product; None where a
        relation is not a product.
    """
    from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus

    calculus = network.calculus
    if not isinstance(calculus, ProductCalculus):
        return (network,)
    boxes = [calculus.boxes(relation) for relation in network.arrays.relations]
    if any(len(box) > 1 for box in boxes):
        return None
    parts = [box[0] if box else (0,) * len(calculus.axes) for box in boxes]
    stated = list(zip(network.constraints, network.arrays.ids.tolist(), strict=True))
    axes = []
    for k, axis in enumerate(calculus.axes):
        constraints = tuple(
            Constraint(c.first, c.second, parts[position][k], c.source)
            for c, position in stated
            if parts[position][k] != axis.universal
        )
        axes.append(Network(axis, network.size, constraints))
    return tuple(axes)
