"""Share a fixture among the tests of networks: every arrangement of four intervals, found by trying them all."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.reasoning.geometry.allen import allen_relations

PAIRS = list(combinations(range(4), 2))


@pytest.fixture(scope="session")
def four_intervals() -> NDArray[np.uint64]:
    """Atoms of four intervals, shape (ways, 6): a bit for the Allen atom of each of PAIRS; eight places suffice."""
    ends = np.array(list(combinations(range(8), 2)), dtype=np.float64)
    way = np.indices((len(ends),) * 4).reshape(4, -1)
    code = allen_relations(ends[:, None, 0], ends[:, None, 1], ends[None, :, 0], ends[None, :, 1]).astype(np.int64)
    packed = sum(code[way[i], way[j]] << (4 * k) for k, (i, j) in enumerate(PAIRS))
    distinct = np.unique(packed)
    codes = np.stack([distinct >> (4 * k) & 15 for k in range(6)], axis=1)
    return np.uint64(1) << codes.astype(np.uint64)
