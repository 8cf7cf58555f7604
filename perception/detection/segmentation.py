"""From a surface to things: supervoxels, joined where they meet convexly, then by what things are like."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.agglomeration import agglomerated
from deixis.perception.detection.boundaries import boundaries
from deixis.perception.detection.joining import whole_things
from deixis.perception.detection.parts import Parts
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.supervoxels import supervoxels
from deixis.perception.detection.surface import Surface

LIMIT = 0.6
"""Regions are merged as long as less than that speaks against it; see :mod:`boundaries`."""


def segments(surface: Surface, settings: DetectionSettings) -> NDArray[np.int32]:
    """The number of its thing for each point of the surface (n,), from 0."""
    patches = supervoxels(surface)
    meeting = boundaries(surface, patches, settings)
    parts = Parts(agglomerated(meeting, LIMIT, patches.tints, patches.weights), patches, meeting)
    return whole_things(parts).of[patches.of]
