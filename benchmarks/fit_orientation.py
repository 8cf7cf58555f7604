"""Fit how to tell the ends of long things and the handles of round ones to simulated views, and write the weights.

    python benchmarks/fit_orientation.py FILE

The seeds are apart from those of ``bench_orientation.py``. Without FILE it prints the weights.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from bench_orientation import HANDLED, HEADED, ROUND, views
from numpy.typing import NDArray

from deixis.perception.features.orientation import (
    END_FEATURES,
    HANDLE_FEATURES,
    handle_features,
    in_slices,
    thinned,
)

THINGS = 60
PENALTY = 1.0
Array = NDArray[np.float64]


def main() -> None:
    ends, signs, handles, has_handle = [], [], [], []
    for kind, seen, truth in views((*HEADED, *HANDLED, *ROUND), range(THINGS), noise=1.0):
        points = thinned(seen.points)
        if kind in HEADED:
            known = in_slices(points)
            if known is not None and known[1] is not None:
                ends.append(known[1])
                signs.append(np.sign(truth @ known[0]))
        elif (found := handle_features(points)) is not None:
            handles.append(np.append(found[0], 1.0))
            has_handle.append(1.0 if kind in HANDLED and truth @ found[1] > 0.8 else -1.0)
    weights = {
        "head": dict(zip(END_FEATURES, fitted(np.array(ends), np.array(signs)), strict=True)),
        "handle": dict(zip((*HANDLE_FEATURES, "always"), fitted(np.array(handles), np.array(has_handle)), strict=True)),
    }
    print(text := json.dumps(weights, indent=1))
    if len(sys.argv) > 1:
        Path(sys.argv[1]).write_text(text + "\n", encoding="utf-8")


def fitted(features: Array, signs: Array) -> list[float]:
    """Return the weights of a logistic regression without a constant, with a penalty on their squares."""
    from scipy.optimize import minimize

    found = minimize(
        lambda w: np.logaddexp(0, -signs * (features @ w)).sum() + PENALTY * (w @ w), np.zeros(features.shape[1])
    )
    result: list[float] = np.round(found.x, 3).tolist()
    return result


if __name__ == "__main__":
    main()
