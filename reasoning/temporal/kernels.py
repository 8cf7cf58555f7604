"""Compiled loop of :mod:`deixis.reasoning.temporal.endpoints`: the Allen relations that distances admit."""

from __future__ import annotations

import numpy as np

from deixis.reasoning.constraints.kernels import added
from deixis.reasoning.kernel import kernel

_UNBOUNDED = 1 << 62


@kernel()
def _realisable(four, constraints):  # type: ignore[no-untyped-def]
    """Return whether constraints (k, 3: tail, head, code) can be added to a closed network of four points, in place."""
    for k in range(len(constraints)):
        tail, head, code = constraints[k]
        if code >= _UNBOUNDED or code >= four[tail, head]:
            continue
        if added(four[head, tail], code, _UNBOUNDED) < 1:
            return False
        for i in range(4):
            first = added(four[i, tail], code, _UNBOUNDED)
            for j in range(4):
                through = added(first, four[head, j], _UNBOUNDED)
                if through < four[i, j]:
                    four[i, j] = through
    return True


@kernel(lambda distances, pairs, definitions: 800 * len(pairs))
def admitted(distances, pairs, definitions):  # type: ignore[no-untyped-def]
    """Return the Allen relations that each pair of fluents may have: masks, shape (p,) uint16.

    ``distances`` (m, m) are the tightest bounds on *column point minus row point*, as codes. ``pairs`` (p, 4) holds the
    start and finish of the first fluent and of the second; ``definitions`` (13, k, 3) holds the constraints that define
    each relation on these four points, padded with unbounded ones.
    """
    masks = np.zeros(len(pairs), np.uint16)
    four, trial = np.empty((4, 4), np.int64), np.empty((4, 4), np.int64)
    for p in range(len(pairs)):
        for i in range(4):
            for j in range(4):
                four[i, j] = distances[pairs[p, i], pairs[p, j]]
        for relation in range(13):
            trial[:] = four
            if _realisable(trial, definitions[relation]):
                masks[p] |= np.uint16(1 << relation)
    return masks
