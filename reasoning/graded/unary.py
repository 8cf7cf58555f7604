"""What is known of the things themselves, as log-likelihood ratios against chance: labels, sizes and proportions.

Each source of evidence weighs as stated in :class:`UnaryWeights`; all are added up. Densities are mixed with
``OUTLIERS`` of chance, so that a size never rules a thing out; only a certain label does (-inf).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.ontology.size_model import SizeModel
from deixis.ontology.sizes import SizeRange, Sizes
from deixis.ontology.vocabulary import DX
from deixis.reasoning.errors import SettingError
from deixis.reasoning.graded.geometry import pair_geometry
from deixis.reasoning.labels import Label, named_objects

Array = NDArray[np.float64]

OUTLIERS = 0.05
"""Share of things whose size says nothing of their kind."""

TURNED = 0.2
"""Share of things that lie at any angle to the axes; the others lie along one of them."""

ANGLES = np.radians(np.arange(5.0, 46.0, 5.0))
"""Angles between a thing and the nearest axis, as likely each, by which a box is larger than what is in it."""

LEAST_SPREAD = 0.05
"""Standard deviation of a logarithm below which no learned range falls: 5 per cent of a length."""


IN_IMAGE = 0.3
"""Standard deviation of the logarithm by which perspective changes lengths and proportions in an image: a plate at the
far edge of a table, or seen from aslant, is about so much smaller."""

KINDS_APART = 0.7
"""Standard deviation of the logarithm of usual lengths of tableware between kinds, by the TBox."""


@dataclass(frozen=True, slots=True)
class UnaryWeights:
    """By how much labels, sizes and colours are multiplied; 1 takes them at their word, 0 leaves them out."""

    labels: float = 1.0
    sizes: float = 1.0
    colours: float = 1.0

    def __post_init__(self) -> None:
        if not all(0 <= weight < np.inf for weight in (self.labels, self.sizes, self.colours)):
            raise SettingError("a weight of evidence is finite and at least 0")


def size_model(usual: SizeRange) -> SizeModel:
    """The model of a usual size: the typical length is the median, least and greatest lie two deviations off.

    >>> from deixis.ontology.tbox import default_ontology
    >>> ontology = default_ontology()
    >>> plate = size_model(ontology.sizes.of(ontology.kinds.of_word("dinner plate").iri))
    >>> round(float(np.exp(plate.length[0])), 2), plate.aspect[0]
    (0.27, 0.0)
    """
    length, width = usual.length, usual.width
    spread = max(float(np.log(length.greatest / length.least)) / 4, LEAST_SPREAD)
    across = max(float(np.log(width.greatest / width.least)) / 4, LEAST_SPREAD)
    aspect = min(float(np.log(width.typical / length.typical)), 0.0)
    square = usual.outline == "circle"
    return SizeModel((float(np.log(length.typical)), spread), (aspect, LEAST_SPREAD if square else across))


def log_sizes(boxes: NDArray[np.float64], relative: bool) -> Array:
    """Natural logarithms of length and aspect of n boxes, shape (n, 2); of nothing's length, a millionth is taken."""
    extents = np.sort(pair_geometry(boxes).boxes[:, 1, :2] - boxes[:, 0, :2], axis=1)
    scale = float(np.median(extents[:, 1])) if relative and len(extents) else 1.0
    length = np.maximum(extents[:, 1] / (scale or 1.0), 1e-6)
    aspect = np.maximum(extents[:, 0], 1e-6 * extents[:, 1]) / np.where(extents[:, 1] > 0, extents[:, 1], 1.0)
    logs: Array = np.log(np.stack([length, np.where(extents[:, 1] > 0, aspect, 1.0)], axis=1))
    return logs


def size_evidence(
    kinds: Sequence[str],
    boxes: NDArray[np.float64],
    sizes: Sizes,
    learned: Mapping[str, SizeModel] | None = None,
    metric: bool = True,
) -> Array:
    """What sizes say of n1 objects of some kinds (class IRIs) being each of n2 boxes, shape (n1, n2), finite.

    A learned model takes the place of the usual size; a kind of which no size is known says nothing. Where units are
    pixels (not ``metric``), sizes in metres say how large the objects are beside each other. Chance is the scene
    itself: a thing weighs as much as it fits the kind better than the things around do, log n2 at the most, and nothing
    where all are alike.
    """
    evidence = np.zeros((len(kinds), len(boxes)))
    different = dict.fromkeys(kinds)
    known = {kind: model for kind in different if (model := (learned or {}).get(kind) or usual_size(kind, sizes))}
    if not known or not len(boxes):
        return evidence
    if not metric:
        known = beside_each_other(known, kinds)
    measured = {relative: log_sizes(boxes, relative) for relative in {model.relative for model in known.values()}}
    ratios = {kind: _density_ratio(measured[model.relative], model) for kind, model in known.items()}
    for row, kind in enumerate(kinds):
        if kind in ratios:
            evidence[row] = ratios[kind]
    return evidence


def beside_each_other(known: Mapping[str, SizeModel], kinds: Sequence[str]) -> dict[str, SizeModel]:
    """The models of the kinds of some objects, those in metres made relative to the scene.

    The median of the objects whose size is known stands for that of the scene, the less surely the fewer they are.
    """
    lengths = [known[kind].length[0] for kind in kinds if kind in known and not known[kind].relative]
    if not lengths:
        return dict(known)
    middle, doubt = float(np.median(lengths)), float(np.hypot(IN_IMAGE, KINDS_APART / np.sqrt(len(lengths))))
    return {kind: model if model.relative else _relative(model, middle, doubt) for kind, model in known.items()}


def _relative(model: SizeModel, middle: float, doubt: float) -> SizeModel:
    (length, spread), (aspect, other) = model.length, model.aspect
    wide = float(np.hypot(spread, doubt)), float(np.hypot(other, IN_IMAGE))
    return SizeModel((length - middle, wide[0]), (aspect, wide[1]), True, model.views)


def usual_size(kind: str, sizes: Sizes) -> SizeModel | None:
    """The usual size of a kind (class IRI), None where only that of all things is stated."""
    usual = sizes.of(kind)
    return None if usual.stated_of == DX.THING else size_model(usual)


def _density_ratio(measured: Array, model: SizeModel) -> Array:
    """log of (1 - outliers) * p(size | kind) / p(size) + outliers, for n boxes (n, 2), log n at the most.

    p(size) is the mean of normal kernels at the things of the scene (Parzen 1962), their width by Scott's rule (1992),
    but never narrower than the kind's spread.
    """
    n, spread = len(measured), np.array([model.length[1], model.aspect[1]])
    wanted, shares = _as_seen(model)
    fits = np.logaddexp.reduce(np.log(shares) + _log_kernel(measured, wanted, spread), axis=1)
    width = np.maximum(spread, measured.std(axis=0) * n ** (-1 / 6))
    chance = np.logaddexp.reduce(_log_kernel(measured, measured, width), axis=1) - np.log(n)
    ratio = np.minimum(fits - chance, np.log(n))
    result: Array = np.logaddexp(np.log1p(-OUTLIERS) + ratio, np.log(OUTLIERS))
    return result


def _log_kernel(at: Array, centres: Array, spread: Array) -> Array:
    """Log density of n places (n, 2) under k normal kernels (k, 2), up to a constant, shape (n, k)."""
    apart = (at[:, None] - centres[None]) / spread
    result: Array = -0.5 * (apart**2).sum(axis=2) - np.log(spread).sum()
    return result


def _as_seen(model: SizeModel) -> tuple[Array, Array]:
    """Log length and log aspect of the box around a thing of typical size, (k, 2), and how often each is seen, (k,).

    Of a thing l long and w wide that lies at an angle a, the box is l cos a + w sin a by l sin a + w cos a. A thing
    about as wide as long is taken to be round, and looks the same however it lies.
    """
    straight = np.array([[model.length[0], model.aspect[0]]])
    if model.aspect[0] > -2 * LEAST_SPREAD:
        return straight, np.ones(1)
    length, width = np.exp(model.length[0]), np.exp(model.length[0] + model.aspect[0])
    long = length * np.cos(ANGLES) + width * np.sin(ANGLES)
    wide = length * np.sin(ANGLES) + width * np.cos(ANGLES)
    seen = np.concatenate([straight, np.log(np.stack([long, wide / long], axis=1))])
    return seen, np.array([1 - TURNED, *[TURNED / len(ANGLES)] * len(ANGLES)])


def label_ratios(description: RelationGraph, labels: Sequence[Label | None], kinds: Kinds) -> Array:
    """What labels say of n1 objects being each of n2 things, shape (n1, n2); -inf where a certain one rules it out.

    A label of confidence c names k of n1 objects: it is right with probability c, else drawn from all objects, so that
    its ratio is c n1 / k + 1 - c for those, and 1 - c for the others.
    """
    n1 = len(description.nodes)
    ratios = np.ones((n1, len(labels)))
    for column, label in enumerate(labels):
        if label is not None and label.confidence > 0:
            named = named_objects(description, label.text, kinds)
            ratios[:, column] = 1 - label.confidence
            ratios[named, column] += label.confidence * n1 / max(int(named.sum()), 1)
    with np.errstate(divide="ignore"):
        logs: Array = np.log(ratios)
    return logs
