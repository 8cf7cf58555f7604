"""Distributions of the size of a box around a thing of a kind: from above in measured scenes, from any side in images.

A box is described by the natural logarithms of its length (the longer side) and its aspect: the shorter over the longer
side, or in an image, where the vertical is known, height over width.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.things.sizes import SizeRange, Sizes

Array = NDArray[np.float64]

TURNED_PRIOR = 0.2
"""Share of things that lie at any angle to the axes; the others lie along one of them."""

ANGLES = np.radians(np.arange(5.0, 46.0, 5.0))
"""Equally likely angles between a turned thing and the nearest axis, in radians."""

HANDLE_SEEN_PRIOR = 0.8
"""Share of things with a handle whose handle is visible and not hidden by the thing itself."""

MIN_SPREAD = 0.05
"""Minimum standard deviation of a logarithm: 5 per cent of a length."""

IMAGE_SPREAD = 0.5
"""Standard deviation of the logarithm by which an image changes lengths and proportions: distant things look smaller,
oblique views are foreshortened, and things may hide parts of other things."""

KINDS_SPREAD = 0.7
"""Standard deviation of the logarithm of usual lengths between kinds of tableware, by the TBox."""


@dataclass(frozen=True, slots=True, eq=False)
class SizeMixture:
    """Mixture of k normal distributions of log length and log aspect, with common standard deviations."""

    centres: Array  # (k, 2): log length, log aspect
    shares: Array  # (k,), sum 1
    spread: Array  # (2,): standard deviations
    relative: bool = False  # as for an image: length in units of the scene's median, aspect is height over width

    @property
    def length(self) -> float:
        """Mean of the log length."""
        return float(self.shares @ self.centres[:, 0])


def size_model(usual: SizeRange) -> SizeModel:
    """Return the model of a usual size: its median is the typical length, and its range is two deviations either way.

    Parameters
    ----------
    usual
        Typical, least and greatest length and width of a kind, in metres.

    Returns
    -------
    SizeModel
        Mean and standard deviation of log length and log aspect.

    Examples
    --------
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
    """Return the usual size of a kind (class IRI); None where the ontology states only that of all things.

    Parameters
    ----------
    kind
        Class IRI of the kind.
    sizes
        Usual sizes of the ontology.

    Returns
    -------
    SizeModel or None
        The model, or None.
    """
    usual = sizes.of(kind)
    return None if usual.stated_of == DX.THING else size_model(usual)


def from_above(model: SizeModel, reach: float = 0.0) -> SizeMixture:
    """Return the distribution of sizes in the plan for a thing on a table; a model learned from images is unchanged.

    The box of a thing of length l and width w at an angle a is l cos a + w sin a by l sin a + w cos a. A thing about as
    wide as long is assumed to be round; its box is the same at every angle, except for a handle that stands out.

    Parameters
    ----------
    model
        Distribution of sizes of a kind.
    reach
        Length of the handle as a share of the thing's length.

    Returns
    -------
    SizeMixture
        Mixture over the angles at which the thing may lie.
    """
    straight = np.array([[model.length[0], model.aspect[0]]])
    spread = np.array([model.length[1], model.aspect[1]])
    if reach and not model.relative:
        # a round thing whose handle points in any direction, or is hidden
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
    """Return the distribution of sizes in an image from above, where things lie across and along equally often.

    Parameters
    ----------
    model
        Distribution of sizes of a kind.

    Returns
    -------
    SizeMixture
        Mixture over the angles, with height over width as the aspect.
    """
    plan = from_above(model)
    if model.relative:
        return plan
    shares = np.concatenate([plan.shares, plan.shares]) / 2
    return SizeMixture(np.concatenate([plan.centres, plan.centres * [1.0, -1.0]]), shares, plan.spread)


def in_image_from_aside(kind: str, model: SizeModel, sizes: Sizes) -> SizeMixture:
    """Return the distribution of sizes in an image from the side.

    The faces that length, width and height make are equally likely, and the height is upright. A kind without a
    stated height, or with a size learned from images, has the distribution of :func:`in_image_from_above`.

    Parameters
    ----------
    kind
        Class IRI of the kind.
    model
        Distribution of its sizes.
    sizes
        Usual sizes of the ontology, for the height.

    Returns
    -------
    SizeMixture
        Mixture over the angles and over the faces.
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
    """Return the size distributions of the objects' kinds, with those in metres made relative to the scene.

    The median length of the objects with a known size estimates that of the scene. The error of the estimate grows with
    the spread of the lengths and falls with their number.

    Parameters
    ----------
    known
        Distribution of sizes by kind; other kinds have none.
    kinds
        Kind (class IRI) of each object.

    Returns
    -------
    dict
        Distributions relative to the median length of the scene, by kind.
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
