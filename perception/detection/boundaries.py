"""Where patches meet, and how much speaks for two things there.

Two surfaces of one thing mostly meet convexly, those of two things in a concave crease (Stein et al., Object
partitioning using local convexity, CVPR 2014). Beside the crease two things are looked at: a step between surfaces
that run alike, and a jump of depth. Colour says nothing here: most changes of colour are print on one thing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.supervoxels import Supervoxels, sums
from deixis.perception.detection.surface import Surface

JUMPED = 1.2
"""What speaks for two things where the depth jumps."""

MOST = 1.5
"""No more than that speaks for two things at one place, so that one place does not outweigh a long boundary."""

NOISE, COARSE = 2.5, 0.3
"""A step is larger than so many standard deviations of the noise, and than that share of the distance of patches."""

UNEVEN = 0.35
"""How unevenly far from their common edge the middles of two patches may be: the difference by the sum."""


@dataclass(frozen=True, eq=False)
class Boundaries:
    """m pairs of patches that meet: ``pairs`` (m, 2), the first the lesser, ``lengths`` (m,) in pairs of neighbours,
    ``evidence`` (m,) for two things there, 0 nothing, 1 enough, and the share ``jumped`` (m,) where the depth jumps."""

    pairs: NDArray[np.int64]
    lengths: NDArray[np.float64]
    evidence: NDArray[np.float64]
    jumped: NDArray[np.float64]


def boundaries(surface: Surface, patches: Supervoxels, settings: DetectionSettings) -> Boundaries:
    pairs, smooth, jumped = _meetings(surface, patches)
    i, j = pairs.T
    sigma = sums(patches.of, surface.sigma) / patches.sizes
    apart = np.median(np.linalg.norm(patches.middles[i] - patches.middles[j], axis=1)) if len(pairs) else 0.0
    step = np.maximum(max(settings.step, COARSE * apart), NOISE * np.maximum(sigma[i], sigma[j]))
    shape = np.hypot(creases(patches, pairs) / settings.concavity, steps(patches, pairs) / step)
    lengths = smooth + jumped
    evidence = (smooth * np.minimum(shape, MOST) + jumped * JUMPED) / lengths
    return Boundaries(pairs, lengths, evidence, jumped / lengths)


def creases(patches: Supervoxels, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """The angle (m,) by which the surfaces of pairs (m, 2) are bent towards each other; 0 where they bend away."""
    i, j = pairs.T
    cosine = (patches.normals[i] * patches.normals[j]).sum(axis=1)
    opening = ((patches.normals[i] - patches.normals[j]) * (patches.middles[i] - patches.middles[j])).sum(axis=1)
    return np.where(opening < 0, np.arccos(np.clip(cosine, -1.0, 1.0)), 0.0)


def steps(patches: Supervoxels, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """How far (m,) one surface of each pair lies above the other along their common normal; 0 on a sphere.

    Where two planes meet at an angle that is 0 only if both middles are as far from the edge; that one is twice
    as far as the other is allowed for.
    """
    i, j = pairs.T
    normal = patches.normals[i] + patches.normals[j]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    between = patches.middles[i] - patches.middles[j]
    half_angle_sine = np.linalg.norm(patches.normals[i] - patches.normals[j], axis=1) / 2
    allowed = UNEVEN * np.linalg.norm(between, axis=1) * half_angle_sine
    over: NDArray[np.float64] = np.maximum(np.abs((normal * between).sum(axis=1)) - allowed, 0.0)
    return over


def _meetings(
    surface: Surface, patches: Supervoxels
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Pairs of patches (m, 2), the first the lesser, and how many neighbours meet there, without and with a jump."""
    p = np.repeat(np.arange(len(surface)), surface.neighbours.shape[1])
    q = surface.neighbours.ravel()
    there = q >= 0
    p, q = p[there], q[there]
    there = patches.of[p] != patches.of[q]
    p, q = p[there], q[there]
    a, b = patches.of[p].astype(np.int64), patches.of[q].astype(np.int64)
    codes, place = np.unique(np.minimum(a, b) * len(patches) + np.maximum(a, b), return_inverse=True)
    jumps = np.linalg.norm(surface.points[p] - surface.points[q], axis=1) > surface.jump[p]
    total = sums(place)
    jumped = sums(place, jumps.astype(np.float64))
    return np.stack(np.divmod(codes, len(patches)), axis=1), total - jumped, jumped
