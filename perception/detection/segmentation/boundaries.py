"""Compute the evidence for two objects along the boundaries of patches, and merge patches into regions.

Two surfaces of one object mostly meet convexly, those of two objects in a concave crease (Stein et al., Object
partitioning using local convexity, CVPR 2014). Two other cues are a step between parallel surfaces, and a jump in
depth. Colour is not a cue, because most changes of colour are prints on one object.

Regions of patches are then merged, those with the least evidence first, until the evidence along all remaining
boundaries is high.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.quantiles import median
from deixis.perception.detection.segmentation.supervoxels import Supervoxels, sums
from deixis.perception.detection.segmentation.surface import Surface
from deixis.perception.detection.settings import BoundarySettings, DetectionSettings
from deixis.reasoning.geometry.coordinates import norms


@dataclass(frozen=True, eq=False)
class Boundaries:
    """Boundaries of m pairs of adjacent patches.

    ``pairs``, of shape (m, 2), has the lower number first. ``lengths`` (m,) counts pairs of neighbouring points.
    ``evidence`` (m,) for two objects is 0 for none and 1 for enough. ``jumped`` (m,) is the fraction of each boundary
    where the depth jumps.
    """

    pairs: NDArray[np.int64]
    lengths: NDArray[np.float64]
    evidence: NDArray[np.float64]
    jumped: NDArray[np.float64]


def boundaries(surface: Surface, patches: Supervoxels, settings: DetectionSettings) -> Boundaries:
    """Return the boundaries between the patches of a surface, with their evidence for two objects.

    Parameters
    ----------
    surface
        Surface of n points.
    patches
        Its s patches.
    settings
        Concave angle in radians and step in metres that are evidence 1, and the evidence of a jump.

    Returns
    -------
    Boundaries
        The m pairs of patches that meet, with their lengths, their evidence, and the fraction of each boundary at which
        the depth jumps.
    """
    from deixis.perception.detection.kernels import meetings

    limits = settings.boundaries
    pairs, lengths, jumped = meetings(patches.of, surface.neighbours, surface.points, surface.jump, len(patches))
    i, j = pairs.T
    sigma = sums(patches.of, surface.sigma) / patches.sizes
    apart = median(norms(patches.middles.take(i, axis=0) - patches.middles.take(j, axis=0))) if len(pairs) else 0.0
    step = np.maximum(
        max(settings.step, limits.step_distance_ratio * apart), limits.step_noise_ratio * np.maximum(sigma[i], sigma[j])
    )
    shape = np.hypot(creases(patches, pairs) / settings.concavity, steps(patches, pairs, limits.off_edge_share) / step)
    smooth = (lengths - jumped) * np.minimum(shape, limits.max_evidence)
    evidence = (smooth + jumped * limits.jump_evidence) / lengths
    return Boundaries(pairs, lengths, evidence, jumped / lengths)


def creases(patches: Supervoxels, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the concave angle between the patches of each pair in radians, shape (m,); 0 where they meet convexly.

    Parameters
    ----------
    patches
        Patches of the surface.
    pairs
        Indices of two patches each, shape (m, 2).

    Returns
    -------
    ndarray
        Angles in [0, pi].
    """
    i, j = pairs.T
    p, q = (patches.normals.take(k, axis=0) for k in (i, j))
    between = patches.middles.take(i, axis=0) - patches.middles.take(j, axis=0)
    cosine, opening = (p * q).sum(axis=1), ((p - q) * between).sum(axis=1)
    return np.where(opening < 0, np.arccos(np.clip(cosine, -1.0, 1.0)), 0.0)


def steps(patches: Supervoxels, pairs: NDArray[np.int64], off_edge_share: float) -> NDArray[np.float64]:
    """Return the distance of the two patches of each pair along their mean normal in metres, shape (m,).

    It is 0 on a sphere. For two planes that meet at an angle, it is 0 only if both middles are equally far from the
    edge.

    Parameters
    ----------
    patches
        Patches of the surface.
    pairs
        Indices of two patches each, shape (m, 2).
    off_edge_share
        Tolerated difference of the distances of the middles from the edge, relative to their sum.

    Returns
    -------
    ndarray
        Distances that are at least 0.
    """
    i, j = pairs.T
    p, q = (patches.normals.take(k, axis=0) for k in (i, j))
    normal = p + q
    normal /= np.maximum(norms(normal), 1e-9)[:, None]
    between = patches.middles.take(i, axis=0) - patches.middles.take(j, axis=0)
    half_angle_sine = norms(p - q) / 2
    allowed = off_edge_share * norms(between) * half_angle_sine
    over: NDArray[np.float64] = np.maximum(np.abs((normal * between).sum(axis=1)) - allowed, 0.0)
    return over


def agglomerated(
    meeting: Boundaries, colours: NDArray[np.float64], weights: NDArray[np.float64], settings: BoundarySettings
) -> NDArray[np.int32]:
    """Return the region of each of s patches, shape (s,), numbered from 0 in the order of their first patches.

    The evidence between two regions is the mean over their common boundary (average linkage). The pair with the least
    evidence is merged as long as it is below ``merge_limit``; ties go to the pair with the lower numbers.

    Parameters
    ----------
    meeting
        Boundaries between the patches.
    colours
        Colour of each patch, shape (s, 3).
    weights
        Weight of each colour in a mean, shape (s,).
    settings
        Limit of the evidence of merges, and the evidence by which colours delay them.

    Returns
    -------
    ndarray
        Regions from 0 without gaps, shape (s,).

    Notes
    -----
    Colours delay merges. Where a knife ends on the rim of a plate, only the colour separates the two; once the rim is
    whole, other evidence along the knife separates them. The knife may divide the plate into halves that do not meet,
    and end smoothly on one of them; so the evidence along all neighbours of the plate's colour must allow the merge.
    Regions of several colours are still merged, such as the prints on a box.

    Examples
    --------
    >>> chain = Boundaries(np.array([[0, 1], [1, 2]]), np.ones(2), np.array([0.1, 0.9]), np.zeros(2))
    >>> agglomerated(chain, np.zeros((3, 3)), np.ones(3), BoundarySettings(merge_limit=0.5)).tolist()
    [0, 0, 1]
    """
    from deixis.perception.detection.segmentation.agglomeration import merge_regions

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
