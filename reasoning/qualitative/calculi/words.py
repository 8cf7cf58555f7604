"""Represent relations as arrays: 64-bit words (bit b of word w for atom 64 w + b), or one truth value per atom."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def words_of(relations: Sequence[int], atoms: int) -> NDArray[np.uint64]:
    """Return relations as words of 64 atoms each.

    Parameters
    ----------
    relations
        Relations as bit masks.
    atoms
        Number of atoms of the calculus.

    Returns
    -------
    ndarray
        Words, shape (relations, words), the lowest atoms first.

    Examples
    --------
    >>> words_of([1 << 64 | 3], 65).tolist()
    [[3, 1]]
    """
    if atoms <= 64:
        return np.array(relations, dtype=np.uint64).reshape(-1, 1)
    width = (atoms + 63) // 64
    data = b"".join(relation.to_bytes(width * 8, "little") for relation in relations)
    return np.frombuffer(data, dtype="<u8").astype(np.uint64).reshape(len(relations), width)


def relation_of(words: NDArray[np.uint64]) -> int:
    """Return the relation in words of 64 atoms each.

    Parameters
    ----------
    words
        Words of one relation, shape (words,), the lowest atoms first.

    Returns
    -------
    int
        Relation as a bit mask.
    """
    return int.from_bytes(words.astype("<u8").tobytes(), "little")


def atoms_within(words: NDArray[np.uint64], atoms: int) -> NDArray[np.bool_]:
    """Return the truth value of each atom of relations in words.

    Parameters
    ----------
    words
        Words of relations, shape (…, words).
    atoms
        Number of atoms of the calculus.

    Returns
    -------
    ndarray
        Truth values, shape (…, atoms).

    Examples
    --------
    >>> atoms_within(words_of([1 << 64 | 3], 65), 65).nonzero()[1].tolist()
    [0, 1, 64]
    """
    codes = np.arange(atoms)
    found: NDArray[np.bool_] = (words[..., codes >> 6] >> (codes & 63).astype(np.uint64) & np.uint64(1)).astype(
        np.bool_
    )
    return found


def words_with(held: NDArray[np.bool_]) -> NDArray[np.uint64]:
    """Return relations as words of 64 atoms each, from the truth values of their atoms.

    Parameters
    ----------
    held
        Truth value of each atom, shape (…, atoms).

    Returns
    -------
    ndarray
        Words, shape (…, words).

    Examples
    --------
    >>> words_with(np.arange(65) > 62).tolist()
    [9223372036854775808, 1]
    """
    atoms = held.shape[-1]
    out = np.zeros((*held.shape[:-1], (atoms + 63) // 64), dtype=np.uint64)
    for atom in range(atoms):
        out[..., atom >> 6] |= held[..., atom].astype(np.uint64) << np.uint64(atom & 63)
    return out
