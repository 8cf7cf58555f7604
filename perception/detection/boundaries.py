"""Where patches meet, and how much speaks for two things there.

Two surfaces of one thing mostly meet convexly, those of two things in a concave crease (Stein et al., Object
partitioning using local convexity, CVPR 2014). Beside the crease two things are looked at: a step between surfaces
that run alike, and a jump of depth. Colour says nothing here: most changes of colour are print on one thing.

Regions of patches are then merged, the most alike first, until every boundary that is left speaks for two things.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import BoundarySettings, DetectionSettings
from deixis.perception.detection.supervoxels import Supervoxels, sums
from deixis.perception.detection.surface import Surface


@dataclass(frozen=True, eq=False)
class Boundaries:
    """m pairs of patches that meet: ``pairs`` (m, 2), the first the lesser, ``lengths`` (m,) in pairs of neighbours,
    ``evidence`` (m,) for two things there, 0 nothing, 1 enough, and the share ``jumped`` (m,) where the depth jumps."""

    pairs: NDArray[np.int64]
    lengths: NDArray[np.float64]
    evidence: NDArray[np.float64]
    jumped: NDArray[np.float64]


def boundaries(surface: Surface, patches: Supervoxels, settings: DetectionSettings) -> Boundaries:
    """Return where patches of a surface meet, and what speaks for two things there."""
    from deixis.perception.detection.kernels import meetings

    limits = settings.boundaries
    pairs, lengths, jumped = meetings(patches.of, surface.neighbours, surface.points, surface.jump, len(patches))
    i, j = pairs.T
    sigma = sums(patches.of, surface.sigma) / patches.sizes
    apart = np.median(np.linalg.norm(patches.middles[i] - patches.middles[j], axis=1)) if len(pairs) else 0.0
    step = np.maximum(
        max(settings.step, limits.step_distance_ratio * apart), limits.step_noise_ratio * np.maximum(sigma[i], sigma[j])
    )
    shape = np.hypot(creases(patches, pairs) / settings.concavity, steps(patches, pairs, limits.off_edge_share) / step)
    smooth = (lengths - jumped) * np.minimum(shape, limits.max_evidence)
    evidence = (smooth + jumped * limits.jump_evidence) / lengths
    return Boundaries(pairs, lengths, evidence, jumped / lengths)


def creases(patches: Supervoxels, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the angle (m,) by which the surfaces of pairs (m, 2) are bent towards each other; 0 where they bend
    away."""
    i, j = pairs.T
    cosine = (patches.normals[i] * patches.normals[j]).sum(axis=1)
    opening = ((patches.normals[i] - patches.normals[j]) * (patches.middles[i] - patches.middles[j])).sum(axis=1)
    return np.where(opening < 0, np.arccos(np.clip(cosine, -1.0, 1.0)), 0.0)


def steps(patches: Supervoxels, pairs: NDArray[np.int64], off_edge_share: float) -> NDArray[np.float64]:
    """Return how far (m,) one surface of each pair lies above the other along their common normal; 0 on a sphere.

    Where two planes meet at an angle that is 0 only if both middles are as far from the edge; ``off_edge_share`` is
    the difference of the two distances by their sum that is allowed for.
    """
    i, j = pairs.T
    normal = patches.normals[i] + patches.normals[j]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    between = patches.middles[i] - patches.middles[j]
    half_angle_sine = np.linalg.norm(patches.normals[i] - patches.normals[j], axis=1) / 2
    allowed = off_edge_share * np.linalg.norm(between, axis=1) * half_angle_sine
    over: NDArray[np.float64] = np.maximum(np.abs((normal * between).sum(axis=1)) - allowed, 0.0)
    return over


def agglomerated(
    meeting: Boundaries, colours: NDArray[np.float64], weights: NDArray[np.float64], settings: BoundarySettings
) -> NDArray[np.int32]:
    """Return the region (s,) that each of s patches ends in, numbered from 0 in the order of their first patches.

    The evidence between two regions is the mean over their common boundary (average linkage). Those with the least are
    merged, as long as that is below ``merge_limit``; ties go to the pair with the smaller numbers. ``colours`` (s, 3),
    with what each counts for in a mean, ``weights`` (s,), only decide what is merged first: where a knife ends on the
    rim of a plate nothing but colour tells the two apart, and once the rim is whole, all else where the knife crosses
    it does. What is of several colours is merged all the same, as what is printed on a box is.

    >>> chain = Boundaries(np.array([[0, 1], [1, 2]]), np.ones(2), np.array([0.1, 0.9]), np.zeros(2))
    >>> agglomerated(chain, np.zeros((3, 3)), np.ones(3), BoundarySettings(merge_limit=0.5)).tolist()
    [0, 0, 1]
    """
    from deixis.perception.detection.agglomeration import merge_regions

    root = merge_regions(
        meeting.pairs,
        meeting.lengths,
        meeting.evidence,
        colours,
        weights,
        settings.merge_limit,
        settings.colour_delay,
        settings.full_colour_difference,
    )
    return np.unique(root, return_inverse=True)[1].astype(np.int32)  # a root is the first patch of its region
