"""Represent qualitative calculi as data: atoms, converse and composition (Ligozat and Renz 2004).

A *relation* is a set of atoms, written as an integer: bit *i* stands for atom *i*. The atoms are jointly exhaustive and
pairwise disjoint, so that the empty relation (0) is a contradiction and the universal relation says nothing.

There are two kinds: a :class:`TableCalculus` states its composition in a table; a :class:`ProductCalculus` relates
things on several independent axes at once, and composes axis by axis. The rectangle algebra is the product of two Allen
algebras. :func:`coarsening` builds a calculus whose atoms are unions of the atoms of another.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from itertools import product
from math import prod

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import UnknownAtomError
from deixis.reasoning.qualitative.calculi.words import atoms_within, relation_of
from deixis.spelling import nearest

MAX_TABLE_ATOMS = 320  # maximum atoms of a table calculus; OPRA of granularity 4 has 272


def bits(relation: int) -> Iterator[int]:
    """Yield the positions of the atoms in a relation in ascending order.

    Parameters
    ----------
    relation
        Relation as a bit mask.

    Yields
    ------
    int
        Position of an atom.

    Examples
    --------
    >>> list(bits(0b1010))
    [1, 3]
    """
    while relation:
        low = relation & -relation
        yield low.bit_length() - 1
        relation ^= low


class Calculus(ABC):
    """A qualitative calculus: the operations that reasoning needs."""

    name: str
    atoms: tuple[str, ...]
    identity: int  # the code of the atom between everything and itself
    aliases: Mapping[str, str]  # other signs, mapped to the signs of this calculus
    any_case: bool  # True if upper and lower case count as equal in signs
    decided_by_closure: bool
    """True if every closed network of tractable relations, atoms included, is consistent.

    Where it is False, even a closed network of atoms may be inconsistent: closure still refutes, and proves nothing
    (Renz and Ligozat 2005).
    """

    @property
    @abstractmethod
    def factors(self) -> tuple[TableCalculus, ...]:
        """The calculi of the single axes; a table calculus has itself only."""

    @abstractmethod
    def converse(self, relation: int) -> int:
        """Return the converse of a relation.

        Parameters
        ----------
        relation
            Relation of a to b, as a bit mask.

        Returns
        -------
        int
            Relation of b to a, as a bit mask.
        """

    @abstractmethod
    def compose(self, first: int, second: int) -> int:
        """Return the weak composition: the atoms possible from a to c where a ``first`` b and b ``second`` c.

        Parameters
        ----------
        first
            Relation of a to b, as a bit mask.
        second
            Relation of b to c, as a bit mask.

        Returns
        -------
        int
            Relation of a to c, as a bit mask.
        """

    @abstractmethod
    def pieces(self, relation: int) -> tuple[int, ...]:
        """Split the relation into tractable ones: one piece if it is tractable itself, none if it is empty.

        Parameters
        ----------
        relation
            Relation as a bit mask.

        Returns
        -------
        tuple of int
            Disjoint relations whose union is ``relation``.
        """

    @property
    def universal(self) -> int:
        """The relation of all atoms, which excludes nothing."""
        return (1 << len(self.atoms)) - 1

    @cached_property
    def _codes(self) -> dict[str, int]:
        codes = {atom: code for code, atom in enumerate(self.atoms)}
        codes |= {alias: codes[atom] for alias, atom in self.aliases.items()}
        return {sign.casefold(): code for sign, code in codes.items()} | codes if self.any_case else codes

    def code(self, atom: str) -> int:
        """Return the code of an atom by its sign or an alias; UnknownAtomError names the nearest sign.

        Parameters
        ----------
        atom
            Sign of the atom, or an alias.

        Returns
        -------
        int
            Position of the atom, from 0.

        Raises
        ------
        UnknownAtomError
            The calculus has no such atom; the message names the nearest sign.
        """
        found = self._codes.get(atom)
        if found is None and self.any_case:
            found = self._codes.get(atom.casefold())
        if found is None:
            hint = nearest(atom, self._codes)
            shown = ", ".join(self.atoms[:16])
            listed = shown if len(self.atoms) <= 16 else f"{shown}, … ({len(self.atoms)} in all)"
            raise UnknownAtomError(
                f"{self.name} has no relation '{atom}'"
                + (f"; did you mean '{hint}'?" if hint else f"; it has {listed}")
            )
        return found

    def relation(self, atoms: Iterable[str]) -> int:
        """Return the relation of these atoms.

        Parameters
        ----------
        atoms
            Signs or aliases of atoms.

        Returns
        -------
        int
            Relation as a bit mask.

        Raises
        ------
        UnknownAtomError
            The calculus has no such atom.
        """
        mask = 0
        for atom in atoms:
            mask |= 1 << self.code(atom)
        return mask

    def members(self, relation: int) -> tuple[str, ...]:
        """Return the signs of a relation's atoms, in the order of their codes.

        Parameters
        ----------
        relation
            Relation as a bit mask.

        Returns
        -------
        tuple of str
            Signs of its atoms.
        """
        return tuple(self.atoms[code] for code in bits(relation))


@dataclass(frozen=True, eq=False)
class Subclass:
    """A set of relations of one table calculus, given by a membership test; the empty relation is a member."""

    name: str
    atoms: int  # number of atoms of the calculus
    contains: Callable[[int], bool]
    source: str

    @cached_property
    def relations(self) -> frozenset[int]:
        """Every member, the empty relation included."""
        return frozenset(relation for relation in range(1 << self.atoms) if self.contains(relation))

    @cached_property
    def largest_first(self) -> tuple[int, ...]:
        """Every member except the empty relation, in descending order of the number of atoms."""
        return tuple(sorted(self.relations - {0}, key=lambda relation: (-relation.bit_count(), relation)))

    @cached_property
    def hulls(self) -> NDArray[np.uint64]:
        """The intersection of the members that contain each relation, shape (2^atoms,)."""
        everything = (1 << self.atoms) - 1
        hulls = np.full(1 << self.atoms, everything, dtype=np.uint64)
        members = np.array(sorted(self.relations), dtype=np.uint64)
        hulls[members] = members
        relations = np.arange(1 << self.atoms)
        for atom in range(self.atoms):
            without = relations[relations >> atom & 1 == 0]
            hulls[without] &= hulls[without | 1 << atom]
        return hulls

    def split(self, relation: int) -> tuple[int, ...]:
        """Split a relation into disjoint members: the largest that fits, then the largest that fits in the rest.

        Parameters
        ----------
        relation
            Relation as a bit mask.

        Returns
        -------
        tuple of int
            Members whose union is ``relation``.

        Examples
        --------
        >>> from deixis.reasoning.qualitative.calculi.registry import calculus
        >>> from deixis.reasoning.qualitative.calculi.tractable import ORD_HORN
        >>> allen = calculus("allen")
        >>> pieces = ORD_HORN.split(allen.relation(["<", "m", "mi", ">"]))
        >>> [allen.members(piece) for piece in pieces]
        [('<', 'm'), ('mi', '>')]
        """
        return _split(self, relation)


@cache
def _split(subclass: Subclass, relation: int) -> tuple[int, ...]:
    if not relation:
        return ()
    if subclass.contains(relation):
        return (relation,)
    largest = next(member for member in subclass.largest_first if member & ~relation == 0)
    return (largest, *_split(subclass, relation & ~largest))


@dataclass(frozen=True, eq=False)
class TableCalculus(Calculus):
    """A calculus of k atoms, at most 320, given by its tables."""

    name: str
    atoms: tuple[str, ...]
    converses: NDArray[np.int64]  # (k,): the code of each atom's converse
    composition: NDArray[np.uint64]
    """Bit masks of atoms, shape (k, k), or (k, k, words) for more than 64 atoms; row: a to b, column: b to c."""
    identity: int
    aliases: Mapping[str, str] = field(default_factory=dict)
    any_case: bool = False
    tractable: Subclass | None = None  # None if no subclass is known: relations are split into atoms
    decided_by_closure: bool = True
    source: str = ""  # citation of the tables and the tractable subclass

    @property
    def factors(self) -> tuple[TableCalculus, ...]:
        """The calculus itself, as a tuple of one."""
        return (self,)

    @cached_property
    def _table(self) -> list[list[int]]:
        if self.composition.ndim > 2:
            return [[relation_of(words) for words in row] for row in self.composition]
        table: list[list[int]] = self.composition.tolist()
        return table

    def possible(self) -> NDArray[np.bool_]:
        """Return the composition as truth values, shape (k, k, k): a to b, b to c, a to c.

        Returns
        -------
        ndarray
            Truth values, shape (k, k, k), for k atoms.
        """
        k = len(self.atoms)
        return atoms_within(self.composition.reshape(k, k, -1), k)

    def converse(self, relation: int) -> int:
        """Return the relation of b to a from the table of converses."""
        mask = 0
        for code in bits(relation):
            mask |= 1 << int(self.converses[code])
        return mask

    def compose(self, first: int, second: int) -> int:
        """Return the weak composition from the table."""
        mask = 0
        for i in bits(first):
            row = self._table[i]
            for j in bits(second):
                mask |= row[j]
        return mask

    def pieces(self, relation: int) -> tuple[int, ...]:
        """Split the relation into members of the tractable subclass, or into atoms if none is known."""
        return atoms_of(relation) if self.tractable is None else self.tractable.split(relation)


@dataclass(frozen=True, eq=False)
class ProductCalculus(Calculus):
    """A product of calculi, one per axis; the code of an atom counts the last axis fastest.

    An atom is a tuple of one atom per axis. ``signs`` are single names for the atoms, by code; an atom may also be
    written as the signs on its axes with a comma between them: ``<,m``.
    """

    name: str
    axes: tuple[TableCalculus, ...]
    signs: tuple[str, ...] = ()
    aliases: Mapping[str, str] = field(default_factory=dict)
    any_case: bool = False
    source: str = ""

    @property
    def factors(self) -> tuple[TableCalculus, ...]:
        """The calculi of the axes."""
        return self.axes

    @property
    def decided_by_closure(self) -> bool:  # type: ignore[override]
        """True if closure decides the calculus of every axis."""
        return all(axis.decided_by_closure for axis in self.axes)

    @cached_property
    def atoms(self) -> tuple[str, ...]:  # type: ignore[override]
        """The signs of the atoms, the last axis fastest."""
        return self.signs or tuple(",".join(signs) for signs in product(*(axis.atoms for axis in self.axes)))

    @cached_property
    def identity(self) -> int:  # type: ignore[override]
        """The code of the atom that is the identity on every axis."""
        return self.code_of([axis.identity for axis in self.axes])

    def code(self, atom: str) -> int:
        """Return the code of an atom by its sign, or by one sign for each axis."""
        signs = [sign.strip() for sign in atom.strip("()").split(",")]
        if self.signs and len(signs) == 1:
            return super().code(atom)
        if len(signs) != len(self.axes):
            example = ",".join(axis.atoms[0] for axis in self.axes)
            raise UnknownAtomError(
                f"{self.name} has no relation '{atom}': write one sign for each of its {len(self.axes)} axes, "
                f"like '{example}'"
            )
        return self.code_of([axis.code(sign) for axis, sign in zip(self.axes, signs, strict=True)])

    def code_of(self, codes: Sequence[int]) -> int:
        """Return the atom's code from the codes on the axes.

        Parameters
        ----------
        codes
            Code of an atom on each axis.

        Returns
        -------
        int
            Code of the atom of the product.
        """
        total = 0
        for axis, code in zip(self.axes, codes, strict=True):
            total = total * len(axis.atoms) + code
        return total

    def of_axes(self, relations: Sequence[int]) -> int:
        """Return the product of one relation per axis.

        Parameters
        ----------
        relations
            Relation on each axis, as a bit mask.

        Returns
        -------
        int
            Relation of the product, as a bit mask.

        Examples
        --------
        >>> from deixis.reasoning.qualitative.calculi.registry import calculus
        >>> ra = calculus("ra")
        >>> ra.members(ra.of_axes([ra.axes[0].relation(["<", "m"]), ra.axes[1].relation(["="])]))
        ('<,=', 'm,=')
        """
        total, width = 1, 1
        for axis, relation in zip(reversed(self.axes), reversed(relations), strict=True):
            total = sum(total << (code * width) for code in bits(relation))
            width *= len(axis.atoms)
        return total

    def boxes(self, relation: int) -> tuple[tuple[int, ...], ...]:
        """Write the relation as a disjoint union of few products (tuples of axis relations), not always fewest.

        Parameters
        ----------
        relation
            Relation as a bit mask.

        Returns
        -------
        tuple of tuple of int
            Products, each with one relation per axis.
        """
        return _boxes(relation, [len(axis.atoms) for axis in self.axes])

    def converse(self, relation: int) -> int:
        """Return the relation of b to a, axis by axis."""
        mask = 0
        for box in self.boxes(relation):
            mask |= self.of_axes([axis.converse(r) for axis, r in zip(self.axes, box, strict=True)])
        return mask

    def compose(self, first: int, second: int) -> int:
        """Return the weak composition, axis by axis."""
        mask = 0
        for a in self.boxes(first):
            for b in self.boxes(second):
                composed = [axis.compose(r, s) for axis, r, s in zip(self.axes, a, b, strict=True)]
                mask |= self.of_axes(composed)
        return mask

    def pieces(self, relation: int) -> tuple[int, ...]:
        """Split into products of tractable relations: closure decides each axis as a network of its own."""
        return tuple(
            self.of_axes(parts)
            for box in self.boxes(relation)
            for parts in product(*(axis.pieces(r) for axis, r in zip(self.axes, box, strict=True)))
        )


def _boxes(relation: int, sizes: Sequence[int]) -> tuple[tuple[int, ...], ...]:
    """Group the first axis's atoms by the relation that they leave on the other axes, and go on with each group."""
    if not relation:
        return ()
    if len(sizes) == 1:
        return ((relation,),)
    width = prod(sizes[1:])
    rows: dict[int, int] = {}
    for code in range(sizes[0]):
        row = relation >> (code * width) & ((1 << width) - 1)
        if row:
            rows[row] = rows.get(row, 0) | 1 << code
    return tuple((first, *rest) for row, first in rows.items() for rest in _boxes(row, sizes[1:]))


def coarsening(
    name: str, atoms: Sequence[str], parts: Sequence[int], fine: Calculus, source: str = ""
) -> TableCalculus:
    """Return the calculus whose atoms are relations of a finer one.

    The composition of two atoms contains every atom that shares a finer atom with the composition of the parts: it is
    exact where the composition of ``fine`` is. The identity of ``fine`` is part of one atom, which need not be neutral.
    Closure does not decide consistency, because the coarse calculus cannot distinguish two parts of one atom; translate
    into the finer calculus to decide.

    Parameters
    ----------
    name
        Name of the coarse calculus.
    atoms
        Signs of its atoms.
    parts
        Relation of ``fine`` for each atom, as bit masks; they are disjoint and cover every atom.
    fine
        The finer calculus.
    source
        Publication that defines the coarse calculus.

    Returns
    -------
    TableCalculus
        The coarse calculus, with its composition table and converses.
    """
    n = len(parts)
    converses = [parts.index(fine.converse(part)) for part in parts]
    table = np.zeros((n, n), dtype=np.uint64)
    for i, first in enumerate(parts):
        for j, second in enumerate(parts):
            composed = fine.compose(first, second)
            table[i, j] = sum(1 << k for k, part in enumerate(parts) if part & composed)
    return TableCalculus(
        name=name,
        atoms=tuple(atoms),
        converses=np.array(converses, dtype=np.int64),
        composition=table,
        identity=next(i for i, part in enumerate(parts) if part >> fine.identity & 1),
        decided_by_closure=False,
        source=source,
    )


def atoms_of(relation: int) -> tuple[int, ...]:
    """Return the atoms of a relation, each as a relation of its own.

    Parameters
    ----------
    relation
        Relation as a bit mask.

    Returns
    -------
    tuple of int
        Bit masks with one bit each, ascending.

    Examples
    --------
    >>> atoms_of(0b110)
    (2, 4)
    """
    return tuple(1 << code for code in bits(relation))
