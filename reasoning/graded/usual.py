"""How usual the sizes of things are for kinds, 0 to 1: what similarity goes by, as grounding goes by size evidence.

A size is as usual as can be within two deviations of the kind's, and less so beyond, as a Gaussian of the logarithm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.size_model import SizeModel
from deixis.ontology.sizes import Sizes
from deixis.reasoning.graded.looks import Look
from deixis.reasoning.graded.unary import log_sizes, looks_in_image

Array = NDArray[np.float64]

SIZE_SPREAD = 0.35
"""How far (natural logarithm) a length lies outside the usual range where its similarity has fallen to exp(-1/2)."""


def usual_sizes(
    kinds: Sequence[str], boxes: NDArray[np.float64], sizes: Sizes, learned: Mapping[str, SizeModel], metric: bool
) -> dict[str, Array]:
    """How usual n boxes, shape (n, 2, d), are for each of some objects' kinds (class IRIs), each (n,).

    A learned model takes the place of the usual size. Where units are pixels (not ``metric``), sizes in metres say how
    large the objects are beside each other, from above or from aside, whichever fits the better. A kind of which no
    size is known may look as it will.
    """
    if metric:
        extents = np.sort(boxes[:, 1, :2] - boxes[:, 0, :2], axis=1)[:, ::-1]
        logs = np.log(np.maximum(extents, 1e-9))
        return {kind: _within(logs, *_range(kind, sizes, learned)) for kind in dict.fromkeys(kinds)}
    logs = log_sizes(boxes, relative=True)
    views = [
        {kind: _looking(logs, looks[kind]) if kind in looks else np.ones(len(boxes)) for kind in dict.fromkeys(kinds)}
        for looks in looks_in_image(kinds, sizes, learned)
    ]
    return max(views, key=lambda view: _fit(kinds, view))


def _within(logs: Array, least: Array, greatest: Array) -> Array:
    beyond = np.maximum(0.0, np.maximum(least - logs, logs - greatest))
    result: Array = np.exp(-(beyond**2).sum(axis=1) / (2 * SIZE_SPREAD**2))
    return result


def _range(kind: str, sizes: Sizes, learned: Mapping[str, SizeModel]) -> tuple[Array, Array]:
    """Least and greatest logarithms of length and width, each (2,): two deviations off where they were learned."""
    model = learned.get(kind)
    if model is None or model.relative:
        usual = sizes.of(kind)
        ranges = usual.length, usual.width
        handle = np.log1p([0.0 if usual.reach is None else usual.reach.greatest, 0.0])
        return np.log([one.least for one in ranges]), np.log([one.greatest for one in ranges]) + handle
    (length, spread), (aspect, other) = model.length, model.aspect
    typical, off = np.array([length, length + aspect]), 2 * np.array([spread, math.hypot(spread, other)])
    return typical - off, typical + off


def _looking(logs: Array, look: Look) -> Array:
    """The same for a look, by the one of its ways that a thing is nearest to."""
    ways = [_within(logs, centre - 2 * look.spread, centre + 2 * look.spread) for centre in look.centres]
    result: Array = np.max(ways, axis=0)
    return result


def _fit(kinds: Sequence[str], usual: Mapping[str, Array]) -> float:
    """How well a whole scene fits: the sum over the best assignment."""
    from scipy.optimize import linear_sum_assignment

    table = np.array([usual[kind] for kind in kinds])
    return float(table[linear_sum_assignment(table, maximize=True)].sum()) if table.size else 0.0
