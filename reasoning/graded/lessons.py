"""What teaches a model: pairs of boxes of which a word was said, among the other pairs that were there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.errors import GraphError
from deixis.ontology.graph import RelationGraph
from deixis.reasoning.errors import SettingError
from deixis.reasoning.graded.geometry import PairGeometry, pair_geometry


@dataclass(frozen=True, eq=False)
class SaidPairs:
    """One scene whose words and boxes are both known: the word ``words[i]`` was said of the pair ``ends[i]``.

    ``weights`` count: 1 for what somebody annotated, less for what a grounding takes to be so.
    """

    pairs: PairGeometry
    words: tuple[str, ...]  # (m,) of the ten words
    ends: NDArray[np.int64]  # (m, 2): subject, object
    weights: NDArray[np.float64]  # (m,), at least 0


def said_pairs(
    description: RelationGraph,
    boxes: NDArray[np.float64],
    things: Sequence[int | None],
    confidence: Sequence[float] | Mapping[int, float] | None = None,
) -> SaidPairs:
    """The pairs that a grounded description teaches.

    ``boxes`` (n2, 2, d); ``things[i]`` is the box of the description's i-th object, or None where it has none, and
    ``confidence`` how sure that is (0 to 1; 1 where none is given), so that a posterior of grounding can teach: a fact
    counts with its own weight times the confidences of both ends. Choices, denials and optional facts teach nothing.
    Raises GraphError for a box that is not there, SettingError for a confidence beyond 0 to 1.
    """
    pairs = pair_geometry(boxes)
    if len(things) != len(description.nodes):
        raise GraphError(f"there are {len(description.nodes)} objects, and boxes are named for {len(things)}")
    outside = [thing for thing in things if thing is not None and not 0 <= thing < len(pairs)]
    if outside:
        raise GraphError(f"there is no box {outside[0]}; the scene has {len(pairs)}")
    sure = [1.0 if confidence is None else float(confidence[i]) for i in range(len(things))]
    if not all(0 <= value <= 1 for value in sure):
        raise SettingError("a confidence lies between 0 and 1")
    words, ends, weights = [], [], []
    index = {name: i for i, name in enumerate(description.nodes)}
    for fact in description.facts():
        subject, object = index[fact.subject], index[fact.object]
        first, second = things[subject], things[object]
        said = fact.plain and not fact.optional  # what is rarely so, not plain either, shows what is not meant
        if said and first is not None and second is not None and first != second:
            words.append(fact.relations[0].word)
            ends.append((first, second))
            weights.append(fact.weight * sure[subject] * sure[object])
    return SaidPairs(pairs, tuple(words), np.array(ends, dtype=np.int64).reshape(-1, 2), np.array(weights))
