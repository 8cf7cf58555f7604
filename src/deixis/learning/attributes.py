"""Measures of the things of a scene that attributes are learned from: colour, size, shape and surface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.attributes.attribute import MEASURES, Attribute

Array = NDArray[np.float64]

HIGHLIGHT = 20.0
"""Minimum CIELAB lightness of a highlight above the median lightness of its thing."""

MIN_POINTS = 20
"""Minimum number of coloured points of a thing whose surface is measured."""

LEAST_SIDE = 0.003
"""Minimum length of a side in metres, below which sides are not compared."""


def measured(scene: Scene) -> Array:
    """Return the measures of the things of a scene.

    Parameters
    ----------
    scene
        Scene of n things.

    Returns
    -------
    ndarray
        Measures in the order of ``MEASURES``, shape (n, m), scaled to about -2 to 2; NaN where one is unknown: heights
        in a scene without them, colours, and surfaces of things without a coloured cloud.

    Notes
    -----
    Sizes are logarithms of lengths in metres, colours are in CIELAB. Gloss is the share of highlights, pattern the
    spread of the colours that are not highlights.
    """
    from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb

    n = len(scene.objects)
    found = np.full((n, len(MEASURES)), np.nan)
    if not n:
        return found
    colours = lab_of_srgb(scene.colours)
    columns = {"lightness": (colours[:, 0] - 55) / 25, "redness": colours[:, 1] / 30, "yellowness": colours[:, 2] / 30}
    sides = np.array([_sides(thing) for thing in scene.objects])
    if scene.unit == "m":
        long, short, height = np.log(np.maximum(sides, LEAST_SIDE)).T
        columns |= {
            "volume": ((long + short + height) / 3 - np.log(0.07)) / 0.5,
            "length": (np.maximum(long, height) - np.log(0.15)) / 0.5,
            "height": (height - np.log(0.04)) / 0.8,
            "elongation": (long - short - 0.7) / 0.7,
            "flatness": ((long + short) / 2 - height - 0.7) / 0.9,
            "roundness": 3 * np.exp(short - long) - 1.5,
        }
    surfaces = np.array([_surface(scene, thing) for thing in scene.objects])
    columns |= {"gloss": 10 * surfaces[:, 0] - 1, "pattern": (surfaces[:, 1] - 10) / 8}
    for name, values in columns.items():
        found[:, MEASURES.index(name)] = values
    return found


def _sides(thing: PerceivedObject) -> tuple[float, float, float]:
    """Return the longer and the shorter side in plan, and the height, NaN if it is unknown."""
    sides = np.array(thing.maximum) - np.array(thing.minimum)
    if thing.oriented is not None:
        sides = np.array(thing.oriented.extents)
    short, long = np.sort(sides[:2])
    return float(long), float(short), float(sides[2]) if len(sides) == 3 else float("nan")


def _surface(scene: Scene, thing: PerceivedObject) -> tuple[float, float]:
    """Return the share of highlights and the spread of the other colours; NaN without a coloured cloud."""
    from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb

    cloud = thing.cloud
    if cloud is None:
        return float("nan"), float("nan")
    points = cloud if isinstance(cloud, PointCloud) else scene.cloud_of(thing.id)
    if points.colours is None or len(points.colours) < MIN_POINTS:
        return float("nan"), float("nan")
    lab = lab_of_srgb(np.asarray(points.colours, dtype=np.float64))
    bright = lab[:, 0] > np.median(lab[:, 0]) + HIGHLIGHT
    rest = lab[~bright]
    return float(bright.mean()), float(np.sqrt(rest.var(axis=0).sum()))


def attribute_ratios(names: Sequence[str], scene: Scene, attributes: Mapping[str, Attribute]) -> NDArray[np.float64]:
    """Return the evidence of learned adjectives that are part of names.

    Parameters
    ----------
    names
        Names of n1 objects, such as ``blick_cup``.
    scene
        Scene of n2 things.
    attributes
        Learned attributes by word.

    Returns
    -------
    ndarray
        Log-likelihood ratios of each object being each thing, against a random thing of the scene, shape (n1, n2).
    """
    ratios = np.zeros((len(names), len(scene.objects)))
    if not scene.objects:
        return ratios
    labels = [thing.label for thing in scene.objects]
    for place, name in enumerate(names):
        for word in set(name.lower().split("_")) & attributes.keys():
            p = attributes[word].probabilities(measured(scene), labels)
            ratios[place] += np.log(p) - np.log(p.mean())
    return ratios
