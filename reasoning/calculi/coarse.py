"""A calculus whose atoms are unions of another's: its tables follow from the finer one's."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deixis.reasoning.calculi.calculus import Calculus, TableCalculus, bits


def coarsening(
    name: str, atoms: Sequence[str], parts: Sequence[int], fine: Calculus, source: str = ""
) -> TableCalculus:
    """The calculus of the atoms whose parts are ``parts``, relations of ``fine`` that share nothing and leave nothing.

    An atom's composition holds every atom that shares one with the composition of the parts: it is exact where the
    finer one's is. What everything bears to itself is a part of one atom, which need not be neutral. Closure does not
    decide (two parts of one atom cannot be told apart); translate into the finer calculus to decide.
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
        split=atoms_of,
        decided_by_closure=False,
        source=source,
    )


def atoms_of(relation: int) -> tuple[int, ...]:
    """A relation split into its atoms.

    >>> atoms_of(0b110)
    (2, 4)
    """
    return tuple(1 << code for code in bits(relation))
