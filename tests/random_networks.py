"""Build random constraint networks."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from deixis.reasoning.qualitative.calculi.calculus import Calculus
from deixis.reasoning.qualitative.networks.network import Constraint, Network


def random_network(chosen: Calculus, things: int, degree: float, atoms: float, seed: int) -> Network:
    """Return a network of random constraints: ``degree`` per thing on average, of ``atoms`` atoms on average."""
    rng, size = np.random.default_rng(seed), len(chosen.atoms)
    constraints = []
    for i, j in combinations(range(things), 2):
        if rng.random() < degree / (things - 1):
            codes = np.flatnonzero(rng.random(size) < atoms / size)
            constraints.append(Constraint(i, j, sum(1 << int(code) for code in codes) or 1))
    return Network(chosen, things, tuple(constraints))
