"""Evidence for a shortlist of the things of a large scene, where the pairs of all things do not fit in memory."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Relations
from deixis.reasoning.errors import OutOfMemoryError
from deixis.reasoning.geometry.rectangle import require_boxes, scene_relations
from deixis.reasoning.grounding.evidence.evidence import (
    PRESENT_LOG_ODDS,
    Evidence,
    ThingEvidence,
    Whole,
    absence,
    without_facts,
)
from deixis.reasoning.grounding.evidence.shortlist import shortlist
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.reasoning.grounding.matching.posterior.posterior import FACTOR_CELLS
from deixis.reasoning.grounding.memory_budget import bytes_of_things, different_facts, required_gigabytes

BLOCKS_SHARE = 0.5
"""Share of the memory for the pairs of candidates, which are freed before the shortlist is compared."""

MAX_THINGS, MIN_THINGS = 400, 60
"""Maximum number of things on a shortlist, and the minimum to which exact sums may lower that maximum."""


def evidence_of_shortlist(
    description: RelationGraph,
    ids: tuple[str, ...],
    boxes: NDArray[np.float64],
    vocabulary: Relations,
    known: ThingEvidence,
    meaning: Meaning,
    gigabytes: float,
    deadline: Deadline,
) -> Evidence:
    """Return the evidence of the most likely things of a scene, with a summary of the whole scene.

    Parameters
    ----------
    description
        The n1 objects and the facts.
    ids, boxes
        All things of the scene: names (n2,) and boxes (n2, 2, d).
    vocabulary
        The relations.
    known
        Labels, sizes and colours of all things.
    meaning
        Models of words and weights of evidence.
    gigabytes
        Memory limit in units of 10^9 bytes.
    deadline
        Time by which the evidence must be computed.

    Returns
    -------
    Evidence
        Evidence of the shortlist, with ``whole`` set.

    Raises
    ------
    OutOfMemoryError, OutOfTimeError
        Labels, sizes and colours leave too many candidates.
    """
    require_boxes(boxes)
    n1, n2 = known.labels.shape
    identified = np.any(~known.allowed, axis=0)
    present = np.any((known.labels > 0) & identified[None, :], axis=1)
    absent = np.where(present, PRESENT_LOG_ODDS, absence(n1, n2))
    alone = without_facts(_unary(known, known.labels), absent, known.allowed)
    doubted = None
    if known.doubted_labels is not None:
        doubted = replace(alone, unary=_unary(known, known.doubted_labels.ratios))
    ranks = np.argsort(np.argsort(np.array(ids, dtype=np.str_)))
    room = gigabytes - bytes_of_things(n1, n2) / 1e9
    most = _most_things(description, room)
    chosen = shortlist(description, boxes, ranks, alone, meaning, most, BLOCKS_SHARE * room, deadline)
    things = chosen.things
    spoken = np.where(known.allowed & (known.labels > 0), np.exp(known.labels), 0.0)
    inside = (1 + spoken[:, things].sum(axis=1)) / (1 + spoken.sum(axis=1))
    doubt = known.doubted_labels
    return Evidence(
        description,
        scene_relations([ids[p] for p in things], boxes[things], vocabulary),
        known.labels[:, things],
        known.sizes[:, things],
        meaning,
        None if known.colours is None else known.colours[:, things],
        None if doubt is None else replace(doubt, ratios=doubt.ratios[:, things]),
        known.allowed[:, things],
        identified[things],
        deadline=deadline,
        whole=Whole(ids, boxes, alone, doubted, chosen.outside, inside),
    )


def _unary(known: ThingEvidence, labels: NDArray[np.float64]) -> NDArray[np.float64]:
    total = labels + known.sizes
    if known.colours is not None:
        total = total + known.colours
    return np.where(known.allowed, total, 0.0)


def _most_things(description: RelationGraph, gigabytes: float) -> int:
    """Return the maximum length of a shortlist: exact sums are still tried, and the evidence fits in memory.

    Raises OutOfMemoryError where a shortlist as long as the description does not fit in memory.
    """
    objects, facts, tables = len(description.nodes), len(description), different_facts(description)
    few = math.isqrt(int(FACTOR_CELLS / max(2 * facts, 1))) - 1
    most = max(min(MAX_THINGS, few), MIN_THINGS, 2 * objects)
    while most > objects and required_gigabytes(objects, most, facts, tables) > gigabytes:
        most = most * 9 // 10
    if required_gigabytes(objects, most, facts, tables) > gigabytes:
        raise OutOfMemoryError(
            f"a description of {objects} objects needs more memory than the limit leaves beside the things of the "
            "scene; raise the limit (--memory-limit), or ground in parts of the scene"
        )
    return most
