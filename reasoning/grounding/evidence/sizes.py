"""How large the box around a thing of a kind looks: from above where scenes are measured, from any side in an image.

A box is compared by the natural logarithms of its length, the longer side, and of its aspect: shorter by longer side,
or in an image, where what is up stays up, height by width.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.sizes import SizeRange, Sizes
from deixis.ontology.vocabulary import DX

Array = NDArray[np.float64]

TURNED_PRIOR = 0.2
"""Share of things that lie at any angle to the axes; the others lie along one of them."""

ANGLES = np.radians(np.arange(5.0, 46.0, 5.0))
"""Angles between a thing and the nearest axis, as likely each, by which a box is larger than what is in it."""

HANDLE_SEEN_PRIOR = 0.8
"""Share of things with a handle whose handle is seen: of the others the thing itself hides it."""

MIN_SPREAD = 0.05
"""Standard deviation of a logarithm below which no range falls: 5 per cent of a length."""

IMAGE_SPREAD = 0.5
"""Standard deviation of the logarithm by which an image changes lengths and proportions: what is twice as far looks
half as large, what is seen from aslant is foreshortened, and what stands behind another is seen in part."""

KINDS_SPREAD = 0.7
"""Standard deviation of the logarithm of usual lengths between kinds of tableware, by the TBox."""


@dataclass(frozen=True, slots=True, eq=False)
class SizeMixture:
    """A box looks one of k ways, each so often, and is normal around each with the same deviations.

    ``relative``, as for an image: lengths are in units of the median of the scene, and the aspect is height by width.
    """

    centres: Array  # (k, 2): log length, log aspect
    shares: Array  # (k,), sum 1
    spread: Array  # (2,): standard deviations
    relative: bool = False

    @property
    def length(self) -> float:
        """The mean of the log length."""
        return float(self.shares @ self.centres[:, 0])


def size_model(usual: SizeRange) -> SizeModel:
    """Return the model of a usual size: the typical length is the median, least and greatest lie two deviations off.

    >>> from deixis.ontology.tbox import default_ontology
    >>> ontology = default_ontology()
    >>> plate = size_model(ontology.sizes.of(ontology.kinds.of_word("dinner plate").iri))
    >>> round(float(np.exp(plate.length[0])), 2), plate.aspect[0]
    (0.27, 0.0)
    """
    length, width = usual.length, usual.width
    spread = max(float(np.log(length.greatest / length.least)) / 4, MIN_SPREAD)
    across = max(float(np.log(width.greatest / width.least)) / 4, MIN_SPREAD)
    aspect = min(float(np.log(width.typical / length.typical)), 0.0)
    square = usual.outline == "circle"
    return SizeModel((float(np.log(length.typical)), spread), (aspect, MIN_SPREAD if square else across))


def usual_size(kind: str, sizes: Sizes) -> SizeModel | None:
    """Return the usual size of a kind (class IRI), None where only that of all things is stated."""
    usual = sizes.of(kind)
    return None if usual.stated_of == DX.THING else size_model(usual)


def from_above(model: SizeModel, reach: float = 0.0) -> SizeMixture:
    """Return the look of a thing that lies or stands on a table, in the plan; of what images taught, as they showed it.

    Of a thing l long and w wide that lies at an angle a, the box is l cos a + w sin a by l sin a + w cos a. A thing
    about as wide as long is taken to be round, and looks the same however it lies, but for a handle: ``reach`` is how
    far one stands out, as a share of the length.
    """
    straight = np.array([[model.length[0], model.aspect[0]]])
    spread = np.array([model.length[1], model.aspect[1]])
    if reach and not model.relative:
        # a round thing whose handle points anywhere, or is not seen
        angles = np.concatenate([[0.0], ANGLES])
        along, across = (np.maximum(0.5, (0.5 + reach) * side(angles)) + 0.5 for side in (np.cos, np.sin))
        centres = straight + np.log(np.stack([along, across / along], axis=1))
        shares = np.array([1 - HANDLE_SEEN_PRIOR, *[HANDLE_SEEN_PRIOR / len(angles)] * len(angles)])
        return SizeMixture(np.concatenate([straight, centres]), shares, spread)
    if model.relative or model.aspect[0] > -2 * MIN_SPREAD:
        return SizeMixture(straight, np.ones(1), spread, model.relative)
    length, width = np.exp(model.length[0]), np.exp(model.length[0] + model.aspect[0])
    long = length * np.cos(ANGLES) + width * np.sin(ANGLES)
    wide = length * np.sin(ANGLES) + width * np.cos(ANGLES)
    turned = np.log(np.stack([long, wide / long], axis=1))
    shares = np.array([1 - TURNED_PRIOR, *[TURNED_PRIOR / len(ANGLES)] * len(ANGLES)])
    return SizeMixture(np.concatenate([straight, turned]), shares, spread, model.relative)


def in_image_from_above(model: SizeModel) -> SizeMixture:
    """Return the same in an image, in which a thing lies as well across as along."""
    plan = from_above(model)
    if model.relative:
        return plan
    shares = np.concatenate([plan.shares, plan.shares]) / 2
    return SizeMixture(np.concatenate([plan.centres, plan.centres * [1.0, -1.0]]), shares, plan.spread)


def in_image_from_aside(kind: str, model: SizeModel, sizes: Sizes) -> SizeMixture:
    """Return the look in an image from aside: one of the faces that length, width and height make, as likely each.

    The height is upright. Of a kind whose height is not stated the look is that from above, and of one that was learned
    from images as they showed it.
    """
    plan, usual = in_image_from_above(model), sizes.of(kind)
    if model.relative or usual.stated_of == DX.THING:
        return plan
    height = np.log(usual.height.typical)
    sides = np.array([model.length[0], model.length[0] + model.aspect[0]])
    faces = np.stack([np.maximum(sides, height), height - sides], axis=1)
    shares = np.concatenate([plan.shares, np.ones(len(faces))]) / (1 + len(faces))
    return SizeMixture(np.concatenate([plan.centres, faces]), shares, plan.spread)


def beside_each_other(known: Mapping[str, SizeMixture], kinds: Sequence[str]) -> dict[str, SizeMixture]:
    """Return the looks of the kinds of some objects, those in metres made relative to the scene.

    The median of the objects whose size is known stands for that of the scene, the less surely the fewer they are and
    the more they differ.
    """
    lengths = np.array([known[kind].length for kind in kinds if kind in known and not known[kind].relative])
    if not len(lengths):
        return dict(known)
    middle, count = float(np.median(lengths)), len(lengths)
    apart = np.sqrt((KINDS_SPREAD**2 + float(((lengths - middle) ** 2).sum())) / count)
    doubt = np.array([np.hypot(IMAGE_SPREAD, apart / np.sqrt(count)), IMAGE_SPREAD])
    return {
        kind: look
        if look.relative
        else SizeMixture(look.centres - [middle, 0.0], look.shares, np.hypot(look.spread, doubt), True)
        for kind, look in known.items()
    }
