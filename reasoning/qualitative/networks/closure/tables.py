"""Convert a calculus to the arrays that the compiled loops read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import LimitError
from deixis.reasoning.qualitative.calculi.calculus import MAX_TABLE_ATOMS, Calculus, TableCalculus
from deixis.reasoning.qualitative.calculi.words import words_with

MAX_AXES = 3
MAX_AXIS_ATOMS = 64  # maximum atoms of one axis of several
MAX_SMALL_ATOMS = 16  # maximum atoms of a table


@dataclass(frozen=True, eq=False)
class Tables:
    """The arrays of a calculus for the compiled loops; ``kernels`` and ``mask_kernels`` state the shapes."""

    sizes: NDArray[np.int64]
    needs: NDArray[np.uint64]
    converses: NDArray[np.int64]
    compositions: NDArray[np.uint16]  # these two only for a small calculus
    mask_converses: NDArray[np.uint16]

    @property
    def small(self) -> bool:
        """True if a relation fits in 16 bits, so that compositions are looked up in a table."""
        return len(self.mask_converses) > 0

    @property
    def atoms(self) -> int:
        """Number of atoms."""
        return len(self.converses)


@lru_cache(maxsize=64)
def tables(calculus: Calculus) -> Tables:
    """Return the arrays of a calculus.

    Parameters
    ----------
    calculus
        The calculus.

    Returns
    -------
    Tables
        Arrays for the loops.

    Raises
    ------
    LimitError
        The calculus has too many axes, or too many atoms on one.
    """
    axes = calculus.factors
    largest = max(len(axis.atoms) for axis in axes)
    if len(axes) > MAX_AXES or largest > (MAX_TABLE_ATOMS if len(axes) == 1 else MAX_AXIS_ATOMS):
        raise LimitError(
            f"{calculus.name}: closure works for one axis of up to {MAX_TABLE_ATOMS} atoms, or up to {MAX_AXES} axes "
            f"of up to {MAX_AXIS_ATOMS}, not {len(axes)} of up to {largest}"
        )
    if is_wide(calculus):
        nothing = np.zeros(0, dtype=np.uint16)
        return Tables(
            np.array([1, 1, largest], dtype=np.int64), _wide_needs(axes[0]), axes[0].converses, nothing, nothing
        )
    padding = MAX_AXES - len(axes)
    sizes = np.array([1] * padding + [len(axis.atoms) for axis in axes], dtype=np.int64)
    needs = np.zeros((MAX_AXES, (largest + 7) // 8, 256, largest), dtype=np.uint64)
    for position, axis in enumerate(axes, start=padding):
        filled = _needs(axis)
        needs[position, : filled.shape[0], :, : filled.shape[2]] = filled
    converses = np.zeros(1, dtype=np.int64)
    for axis in axes:
        converses = (converses[:, None] * len(axis.converses) + axis.converses[None, :]).ravel()
    if len(axes) == 1 and largest <= MAX_SMALL_ATOMS:
        compositions, mask_converses = in_parts(axes[0], 2, half_of(largest), np.dtype(np.uint16))
        return Tables(sizes, needs, converses, compositions, mask_converses)
    nothing = np.zeros(0, dtype=np.uint16)
    return Tables(sizes, needs, converses, nothing, nothing)


def is_wide(calculus: Calculus) -> bool:
    """Return True if a relation of the calculus takes several words, on its only axis.

    Parameters
    ----------
    calculus
        A calculus.

    Returns
    -------
    bool
        True if the calculus has one axis with more than ``MAX_AXIS_ATOMS`` atoms.
    """
    return len(calculus.factors) == 1 and len(calculus.atoms) > MAX_AXIS_ATOMS


def _needs(axis: TableCalculus) -> NDArray[np.uint64]:
    """Return the right atoms that give each atom, for every byte of a left relation, shape (bytes, 256, atoms)."""
    size = len(axis.atoms)
    single = words_with(axis.possible().swapaxes(1, 2))[:, :, 0]  # (left, result)
    table = np.zeros(((size + 7) // 8, 256, size), dtype=np.uint64)
    for left in range(size):
        table[left // 8, _holding(left % 8, 8)] |= single[left]
    return table


def _wide_needs(axis: TableCalculus) -> NDArray[np.uint64]:
    """Return the right atoms that give each atom, for every four left atoms, shape (words, fours, 16, atoms)."""
    size = len(axis.atoms)
    single = words_with(axis.possible().swapaxes(1, 2))  # (left, result, words)
    table = np.zeros((single.shape[2], (size + 3) // 4, 16, size), dtype=np.uint64)
    for left in range(size):
        table[:, left // 4, _holding(left % 4, 4)] |= single[left].T[:, None]
    return table


def in_parts(
    axis: TableCalculus, parts: int, width: int, dtype: np.dtype[Any]
) -> tuple[NDArray[np.unsignedinteger[Any]], NDArray[np.unsignedinteger[Any]]]:
    """Return compositions and converses of relations that are cut into parts, by look-up.

    Parameters
    ----------
    axis
        Calculus of the relations.
    parts
        Number of parts.
    width
        Number of atoms of a part.
    dtype
        Unsigned type with a bit for each atom.

    Returns
    -------
    compositions : ndarray, (parts, 2^width, parts, 2^width)
        Each part of a left relation composed with each part of a right one.
    converses : ndarray, (parts, 2^width)
        The converse of each part of a relation.
    """
    compositions = np.zeros((parts, 1 << width, parts, 1 << width), dtype=dtype)
    for left, right in np.ndindex(axis.composition.shape):
        lefts, rights = _holding(left % width, width), _holding(right % width, width)
        compositions[left // width, lefts[:, None], right // width, rights] |= axis.composition[left, right].astype(
            dtype
        )
    converses = np.zeros((parts, 1 << width), dtype=dtype)
    for atom, converse in enumerate(axis.converses.tolist()):
        converses[atom // width, _holding(atom % width, width)] |= dtype.type(1 << converse)
    return compositions, converses


def half_of(atoms: int) -> int:
    """Return the number of atoms in the lower part of a relation that is cut in two.

    Parameters
    ----------
    atoms
        Number of atoms of the calculus.

    Returns
    -------
    int
        Half of the atoms, rounded up.
    """
    return (atoms + 1) // 2


def _holding(bit: int, width: int) -> NDArray[np.int64]:
    """Return the numbers of ``width`` bits that have bit ``bit`` set."""
    return np.flatnonzero(np.arange(1 << width) >> bit & 1)
