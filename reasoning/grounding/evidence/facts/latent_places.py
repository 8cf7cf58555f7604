"""Evidence of facts about objects that are absent: they are at some place, where no thing is seen.

All facts about an absent object are about its place. Where they count as by chance, a description is explained best by
giving each absent object an undescribed thing that satisfies most of its facts. So absent objects need places too. The
places are a grid over the scene; a box of the usual size at each place is compared with the things.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.pairs import PairGeometry, Surroundings
from deixis.reasoning.geometry.poses import Poses
from deixis.reasoning.geometry.rectangle import cross_relations
from deixis.reasoning.grounding.evidence.facts.facts import SIDE, SaidFacts
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.matching.problem import MAX_PLACES, MIN_PLACES, PLACES_PER_THING


def place_boxes(boxes: NDArray[np.float64], most: int = MAX_PLACES) -> NDArray[np.float64]:
    """Return boxes on a grid over the centres of some boxes, half a step beyond them, all of the usual size.

    Parameters
    ----------
    boxes
        Boxes of the things of a scene, at least one, shape (n2, 2, d).
    most
        Approximate maximum number of places.

    Returns
    -------
    ndarray
        Boxes of g places, shape (g, 2, d): squares of the mean of the median extents, at the median height.

    Examples
    --------
    >>> row = np.array([[[x, 0.0], [x + 0.1, 0.1]] for x in range(4)])
    >>> places = place_boxes(row)
    >>> places.shape, places.mean(axis=1).min(axis=0).round(2).tolist()
    ((312, 2, 2), [0.03, 0.03])
    """
    centres, extents = boxes.mean(axis=1), np.median(boxes[:, 1] - boxes[:, 0], axis=0)
    low, high = centres[:, :2].min(axis=0), centres[:, :2].max(axis=0)
    count = min(max(PLACES_PER_THING * len(boxes), MIN_PLACES), most)
    side = extents[:2].mean()
    spans = np.maximum(high - low, side)
    longer = max(1.0, math.sqrt(count * spans[0] / spans[1])) if spans.all() else 1.0
    steps = np.maximum(np.round([longer, count / longer]).astype(np.int64), 1)
    pads = spans / steps / 2
    axes = [np.linspace(low[axis] - pads[axis], high[axis] + pads[axis], steps[axis] + 1) for axis in (0, 1)]
    middles = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    places = np.empty((len(middles), 2, boxes.shape[2]))
    places[:, 0, :2], places[:, 1, :2] = middles - side / 2, middles + side / 2
    if boxes.shape[2] == 3:
        places[:, :, 2] = np.median(boxes[:, :, 2], axis=0)
    return places


def place_ratios(
    facts: SaidFacts,
    boxes: NDArray[np.float64],
    literal: float,
    more_tables: int = 0,
    poses: Poses | None = None,
    most: int = MAX_PLACES,
) -> NDArray[np.float32]:
    """Return the likelihood ratios of facts between an object at each place and each thing.

    Parameters
    ----------
    facts
        The k different facts.
    boxes
        Boxes of the n2 things, shape (n2, 2, d).
    literal
        Share of facts that are meant literally, in [0, 1].
    more_tables
        Number c of tables after those of the facts, about which places say nothing.
    poses
        Poses of the things; None for axes along the sides of the boxes, and no fronts.
    most
        Approximate maximum number g of places.

    Returns
    -------
    ndarray
        Likelihood ratios, shape (2(k + c), g, n2): the subject at the place, then the object at the place.
    """
    places, kinds = place_boxes(boxes, most), len(facts.contents)
    tables = kinds + more_tables
    ratios = np.ones((2, tables, len(places), len(boxes)), np.float32)
    there, here = Surroundings.of(places, boxes), Surroundings.of(boxes, boxes, poses=poses)
    for start in range(0, len(places), SIDE):
        for first in range(0, len(boxes), SIDE):
            rows, columns = slice(start, start + SIDE), slice(first, first + SIDE)
            pairs = there.block_with(rows, here, columns)
            _fill(ratios[0, :kinds, rows, columns], facts, pairs, literal)
            _fill(ratios[1, :kinds, rows, columns].swapaxes(1, 2), facts, pairs.reverse, literal)
    return ratios.reshape(2 * tables, len(places), len(boxes))


def _fill(ratios: NDArray[np.float32], facts: SaidFacts, pairs: PairGeometry, literal: float) -> None:
    """Fill in the likelihood ratios (k, n, m) of k facts for a block of pairs of n subjects and m objects."""
    ranks = np.arange(len(pairs.boxes)), np.arange(len(pairs.objects))
    _, names = cross_relations(pairs.boxes, pairs.objects, ranks, facts.vocabulary)
    degrees, mentioned = WordDegrees(pairs, facts.models), facts.mention_weight(pairs)
    for kind, ratio in enumerate(ratios):
        ratio[:] = facts.mixed(kind, degrees, names.astype(np.uint8), mentioned, literal)
