"""What can be spared of two sides that are paired off."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def spare_rows(pairs: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which rows some largest matching leaves over, shape (n,), of the ``pairs`` that may be matched, shape (n, m).

    From one largest matching, all others are reached by alternating paths from what it leaves over (Dulmage and
    Mendelsohn 1958).

    >>> spare_rows(np.array([[1, 0], [1, 0], [0, 1], [0, 0]], bool)).tolist()
    [True, True, False, True]
    """
    if not pairs.any():
        return np.ones(len(pairs), dtype=bool)
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import maximum_bipartite_matching

    partner = maximum_bipartite_matching(csr_array(pairs), perm_type="column")
    spare: NDArray[np.bool_] = partner < 0
    while True:
        wanted: NDArray[np.bool_] = np.any(pairs[spare], axis=0)
        more = spare | (wanted[partner] & (partner >= 0))
        if (more == spare).all():
            return spare
        spare = more
