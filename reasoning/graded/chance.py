"""What a degree is worth by chance: its mean over the ordered pairs of scenes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relation_models import FAMILIES, SAYING, RelationModel
from deixis.reasoning.graded.degrees import degree_of_view
from deixis.reasoning.graded.geometry import PairGeometry
from deixis.reasoning.graded.views import view


def random_scenes(count: int = 200, size: int = 8, seed: int = 1) -> list[NDArray[np.float64]]:
    """Boxes (size, 2, 2) with centres anywhere in the unit square and extents between 0.02 and 0.3."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(0.0, 1.0, (count, size, 2))
    halves = rng.uniform(0.01, 0.15, (count, size, 2))
    return list(np.stack([centres - halves, centres + halves], axis=2))


def chance_degree(model: RelationModel, scenes: Iterable[PairGeometry]) -> float:
    """Mean degree of a model over all ordered pairs of scenes and the words that share it; 1 where there is none."""
    words = [word for word, family in FAMILIES.items() if family == model.name] or [SAYING]
    found = []
    for pairs in scenes:
        apart = ~np.eye(len(pairs), dtype=bool)
        found += [degree_of_view(model, view(pairs, word))[apart] for word in words]
    pooled = np.concatenate(found) if found else np.zeros(0)
    return float(pooled.mean()) if pooled.size else 1.0
