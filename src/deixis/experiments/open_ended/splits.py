"""Which views are taught and which are kept to be asked for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.open_ended.shown import Shown


class Split(NamedTuple):
    """Places of views; both in random order."""

    taught: NDArray[np.int64]
    asked: NDArray[np.int64]


def by_things(shown: Shown, seed: int) -> Split:
    """Half of the things of each category to teach (rounded up), the other half to ask for."""
    rng = np.random.default_rng(seed)
    taught = np.zeros(len(shown.views), bool)
    for category in shown.kinds:
        things = rng.permutation(shown.instances_of(category))
        taught[shown.of(category, things[: -(-len(things) // 2)])] = True
    return _shuffled(taught, rng)


def by_views(shown: Shown, seed: int) -> Split:
    """Half of the views of each thing to teach (rounded up), the other half to ask for."""
    rng = np.random.default_rng(seed)
    taught = np.zeros(len(shown.views), bool)
    for thing in np.unique(shown.instances):
        views = rng.permutation(np.flatnonzero(shown.instances == thing))
        taught[views[: -(-len(views) // 2)]] = True
    return _shuffled(taught, rng)


def _shuffled(taught: NDArray[np.bool_], rng: np.random.Generator) -> Split:
    return Split(rng.permutation(np.flatnonzero(taught)), rng.permutation(np.flatnonzero(~taught)))
