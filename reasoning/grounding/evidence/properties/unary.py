"""Unary evidence: log-likelihood ratios of labels and sizes against chance, for each object and thing.

The sources of evidence are multiplied by :class:`UnaryWeights` and added up. Densities are mixed with a share
``OUTLIERS`` of chance, so that a size never rules a match out. Nor does a label, unless the error of labels is 0.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.things.kinds import Kinds, plain_name
from deixis.ontology.things.sizes import Sizes
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.rectangle import require_boxes
from deixis.reasoning.grounding.evidence.properties.labels import Label, naming
from deixis.reasoning.grounding.evidence.properties.sizes import (
    SizeMixture,
    beside_each_other,
    from_above,
    in_image_from_above,
    in_image_from_aside,
    usual_size,
)

Array = NDArray[np.float64]

OUTLIERS = 0.05
"""Share of things whose size is independent of their kind."""

LABEL_ERROR = 0.003
"""Probability that a label of confidence 1 is wrong."""

WORLD_COUNT = 20.0
"""Number of things that the prior frequency of a word counts as, beside the undescribed things of the scene."""

BROADER_WORD = 0.2
"""Probability that the right label of a thing is a broader word for it: *fork* of a dinner fork."""

OTHER_WORDS = 10_000
"""Number of equally likely words for things of no known kind: about the nouns that a speaker uses."""

MAX_HEIGHT_RATIO, HEIGHT_ERROR = 2.0, 0.02
"""Ratio to the greatest usual height of a kind, and metres beyond that, above which a thing is too high for it."""

MAX_COMPARED, PAIRS_AT_ONCE = 600, 1 << 20
"""Maximum number of things whose sizes are all compared with each other, and the number of pairs held at a time."""

GRID_STEP, MAX_GRID_SIDE = 0.125, 2000
"""Step, in kernel widths, of the grid on which the sizes of more things are counted, and its maximum side in points."""


@dataclass(frozen=True, slots=True)
class UnaryWeights:
    """Factors of the evidence of labels, sizes and colours: 1 leaves it unchanged, 0 ignores it."""

    labels: float = 1.0
    sizes: float = 1.0
    colours: float = 1.0

    def __post_init__(self) -> None:
        if not all(0 <= weight < np.inf for weight in (self.labels, self.sizes, self.colours)):
            raise SettingError(f"the weights of evidence must be finite and at least 0, got {self}")


def log_sizes(boxes: NDArray[np.float64], relative: bool) -> Array:
    """Return natural logarithms of length and aspect of boxes.

    The aspect is the shorter over the longer side. A side of length 0 is replaced by a millionth of the length.

    Parameters
    ----------
    boxes
        Boxes of n things, shape (n, 2, d).
    relative
        True for an image: lengths are in units of their median, and the aspect is height over width.

    Returns
    -------
    ndarray
        Log length and log aspect of each box, shape (n, 2).
    """
    boxes = np.asarray(boxes, dtype=np.float64)
    require_boxes(boxes)
    extents = boxes[:, 1, :2] - boxes[:, 0, :2]
    length = extents.max(axis=1)
    scale = float(np.median(length)) if relative and len(length) else 1.0
    sides = np.log(np.maximum(extents, 1e-6 * np.where(length > 0, length, 1.0)[:, None]))
    aspect = sides[:, 1] - sides[:, 0]
    lengths = np.log(np.maximum(length / (scale or 1.0), 1e-6))
    logs: Array = np.stack([lengths, aspect if relative else -np.abs(aspect)], axis=1)
    return logs


def size_evidence(
    kinds: Sequence[str],
    boxes: NDArray[np.float64],
    sizes: Sizes,
    learned: Mapping[str, SizeModel] | None = None,
    metric: bool = True,
) -> Array:
    """Return log-likelihood ratios by size of n1 objects being each of n2 boxes.

    Parameters
    ----------
    kinds
        Kind of each object, as class IRIs.
    boxes
        Boxes of the things, shape (n2, 2, d), in metres or pixels.
    sizes
        Usual sizes of kinds.
    learned
        Learned sizes by class IRI, used instead of the usual sizes.
    metric
        Whether the boxes are in metres. In pixels, sizes give the ratios between objects, seen from above or from the
        side, whichever fits the whole scene.

    Returns
    -------
    Array of shape (n1, n2), finite; 0 for a kind without a known size.

    Notes
    -----
    Chance is the scene itself: the ratio compares the fit of a thing with that of the things around it. It is at most
    log n2, and 0 where all things are alike. Heights are used only to find things that are :func:`too_high`.
    """
    known = _known(kinds, sizes, learned)
    if not known or not len(boxes):
        return np.zeros((len(kinds), len(boxes)))
    if metric:
        looks = {kind: from_above(model, _reach(kind, sizes, learned)) for kind, model in known.items()}
        return np.where(too_high(kinds, boxes, sizes, learned), np.log(OUTLIERS), _ratios(kinds, boxes, looks))
    # a mixture of the views, weighted by the best assignment of the whole scene under each
    views = [_ratios(kinds, boxes, looks) for looks in looks_in_image(kinds, sizes, learned)]
    from scipy.optimize import linear_sum_assignment

    fits = np.array([view[linear_sum_assignment(view, maximize=True)].sum() for view in views])
    shares = fits - np.logaddexp.reduce(fits)
    mixed: Array = np.logaddexp.reduce([share + view for share, view in zip(shares, views, strict=True)], axis=0)
    return mixed


def too_high(
    kinds: Sequence[str],
    boxes: NDArray[np.float64],
    sizes: Sizes,
    learned: Mapping[str, SizeModel] | None = None,
) -> NDArray[np.bool_]:
    """Return the mask of boxes that are much higher than usual for kinds.

    Things that are lower than usual are not excluded, because another thing may hide a part of them. The mask is false
    for boxes without a height, and for kinds with a learned size.

    Parameters
    ----------
    kinds
        Kind (class IRI) of each of n1 objects.
    boxes
        Boxes of n2 things in metres, shape (n2, 2, d).
    sizes
        Usual sizes of the ontology.
    learned
        Learned sizes by kind.

    Returns
    -------
    ndarray
        Mask of shape (n1, n2).
    """
    if boxes.shape[2] < 3:
        return np.zeros((len(kinds), len(boxes)), dtype=bool)
    usual = [None if kind in (learned or {}) else sizes.of(kind) for kind in kinds]
    most = [
        np.inf if size is None or size.stated_of == DX.THING else MAX_HEIGHT_RATIO * size.height.greatest + HEIGHT_ERROR
        for size in usual
    ]
    result: NDArray[np.bool_] = boxes[None, :, 1, 2] - boxes[None, :, 0, 2] > np.array(most)[:, None]
    return result


def looks_in_image(
    kinds: Sequence[str], sizes: Sizes, learned: Mapping[str, SizeModel] | None = None
) -> tuple[dict[str, SizeMixture], dict[str, SizeMixture]]:
    """Return the relative sizes of the known kinds of the objects in an image: seen from above, and from the side.

    Parameters
    ----------
    kinds
        Kind (class IRI) of each object.
    sizes
        Usual sizes of the ontology.
    learned
        Learned sizes by kind, which replace the usual ones.

    Returns
    -------
    tuple
        Distribution of sizes by kind from above, and from the side.
    """
    known = _known(kinds, sizes, learned)
    above = {kind: in_image_from_above(model) for kind, model in known.items()}
    aside = {kind: in_image_from_aside(kind, model, sizes) for kind, model in known.items()}
    return beside_each_other(above, kinds), beside_each_other(aside, kinds)


def _known(kinds: Sequence[str], sizes: Sizes, learned: Mapping[str, SizeModel] | None) -> dict[str, SizeModel]:
    different = dict.fromkeys(kinds)
    return {kind: model for kind in different if (model := (learned or {}).get(kind) or usual_size(kind, sizes))}


def _reach(kind: str, sizes: Sizes, learned: Mapping[str, SizeModel] | None) -> float:
    """Return how far a handle stands out beyond the kind's stated length; 0 for a learned length, which includes it."""
    reach = None if kind in (learned or {}) else sizes.of(kind).reach
    return 0.0 if reach is None else reach.typical


def _ratios(kinds: Sequence[str], boxes: NDArray[np.float64], looks: Mapping[str, SizeMixture]) -> Array:
    """Return log-likelihood ratios (n1, n2) of objects being boxes by the size mixtures; 0 for a kind without one."""
    measured = {relative: log_sizes(boxes, relative) for relative in {look.relative for look in looks.values()}}
    ratios = {kind: _density_ratio(measured[look.relative], look) for kind, look in looks.items()}
    silent = np.zeros(len(boxes))
    return np.array([ratios.get(kind, silent) for kind in kinds])


def _density_ratio(measured: Array, look: SizeMixture) -> Array:
    """Return log((1 - outliers) * p(size | kind) / p(size) + outliers) of n log sizes (n, 2), at most log n.

    p(size) is the mean of normal kernels at the things of the scene (Parzen 1962). Their width follows Scott's rule
    (1992) and is at least the kind's spread.
    """
    n = len(measured)
    fits = np.logaddexp.reduce(np.log(look.shares) + _log_kernel(measured, look.centres, look.spread), axis=1)
    width = np.maximum(look.spread, measured.std(axis=0) * n ** (-1 / 6))
    ratio = np.minimum(fits - _log_mean_kernel(measured, width), np.log(n))
    result: Array = np.logaddexp(np.log1p(-OUTLIERS) + ratio, np.log(OUTLIERS))
    return result


def _log_mean_kernel(measured: Array, width: Array) -> Array:
    """Return the log mean density at n points (n, 2) of normal kernels at these points, up to a constant, shape (n,).

    All kernels have the same ``width`` (2,). For many points, the density is computed on a grid of ``GRID_STEP`` widths
    by linear binning (Wand 1994), so that the work grows with the number of points and not with its square; the error
    is below 0.01.
    """
    n = len(measured)
    low, step = measured.min(axis=0), GRID_STEP * width
    sides = np.floor((measured.max(axis=0) - low) / step).astype(np.int64) + 2
    if n <= MAX_COMPARED or sides.max() > MAX_GRID_SIDE:
        rows = max(1, PAIRS_AT_ONCE // max(n, 1))
        parts = [_log_kernel(measured[start : start + rows], measured, width) for start in range(0, n, rows)]
        exact: Array = np.concatenate([np.logaddexp.reduce(part, axis=1) for part in parts]) - np.log(n)
        return exact
    cell, part = np.divmod((measured - low) / step, 1.0)
    cell = cell.astype(np.int64)
    corners = [(cell + corner, np.abs(1 - np.array(corner) - part).prod(axis=1)) for corner in np.ndindex(2, 2)]
    shares = sum(np.bincount(np.ravel_multi_index(at.T, sides), share, sides.prod()) for at, share in corners)
    kernels = [np.exp(-0.5 * (GRID_STEP * (np.arange(side)[:, None] - np.arange(side))) ** 2) for side in sides]
    density = kernels[0] @ np.reshape(shares, sides) @ kernels[1]
    found = sum(share * density[at[:, 0], at[:, 1]] for at, share in corners)
    result: Array = np.log(found / n) - np.log(width).sum()
    return result


def _log_kernel(at: Array, centres: Array, spread: Array) -> Array:
    """Return log densities of n points (n, 2) under k normal kernels (k, 2), up to a constant, shape (n, k)."""
    apart = (at[:, None] - centres[None]) / spread
    result: Array = -0.5 * (apart**2).sum(axis=2) - np.log(spread).sum()
    return result


@dataclass(frozen=True, eq=False)
class LabelRatios:
    """Evidence of labels for n1 objects being each of n2 things."""

    ratios: Array  # (n1, n2) log-likelihood ratios, finite
    allowed: NDArray[np.bool_]  # (n1, n2) matches of probability above 0; all of them unless labels have no error
    by_chance: float  # log-likelihood of all labels if the description mentions none of the things


def label_ratios(
    description: RelationGraph, labels: Sequence[Label | None], kinds: Kinds, error: float = LABEL_ERROR
) -> LabelRatios:
    """Return log-likelihood ratios by label of n1 objects being each of n2 things, and the allowed matches.

    Parameters
    ----------
    description
        The objects that the labels may name.
    labels
        One label for each of the n2 things; None where perception gives it no name.
    kinds
        Known kinds of things.
    error
        Probability that a label of confidence 1 is wrong. A label of confidence c is right with probability
        c (1 - error).

    Returns
    -------
    LabelRatios
        Likelihood of each label for a thing that is the object, against a thing that the description does not mention.

    Notes
    -----
    A right label of an object is a word that fits it, or with probability ``BROADER_WORD`` a broader word for it. A
    right label of any other thing is a word for one of the known kinds, all equally likely, or one of ``OTHER_WORDS``
    words for other kinds. A wrong label is a word of the description in half of the cases, and any word otherwise.
    Naming follows :func:`deixis.reasoning.grounding.evidence.properties.labels.naming`. Where a word labels more things
    than objects that it fits, such things are frequent in this scene: the probability of the word for a thing that is
    not mentioned is the mean of its prior, which counts as ``WORLD_COUNT`` things, and of the things counted in the
    scene.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> ontology = default_ontology()
    >>> two = RelationGraph.from_facts(ontology.relations, ["target", "landmark"], [])
    >>> label_ratios(two, [Label("landmark"), None], ontology.kinds).ratios.round(1).tolist()
    [[-0.1, 0.0], [7.1, 0.0]]
    """
    n1 = len(description.nodes)
    if all(label is None for label in labels):
        return LabelRatios(np.zeros((n1, len(labels))), np.ones((n1, len(labels)), dtype=bool), 0.0)
    known = naming(description, labels, kinds)
    right = np.where(known.fitted, 1.0, BROADER_WORD) * known.named
    confidence = np.array([label.confidence if label is not None else 0.0 for label in labels]) * (1 - error)
    elsewhere = _shares_elsewhere(labels, known.fitted.sum(axis=0), kinds)
    of_script = known.named.any(axis=0) / max(n1, 1)
    wrong = (of_script + elsewhere) / 2
    likely = confidence * right + (1 - confidence) * wrong
    by_chance = confidence * elsewhere + (1 - confidence) * wrong
    allowed = (likely > 0) | (by_chance == 0)
    ratios = np.divide(likely, by_chance, out=np.ones_like(likely), where=allowed & (by_chance > 0))
    background = np.log(by_chance[by_chance > 0]).sum()
    return LabelRatios(np.log(ratios), allowed, float(background))


def _shares_elsewhere(labels: Sequence[Label | None], fitted: NDArray[np.int64], kinds: Kinds) -> Array:
    """Return the probability (n2,) of each label's word for a thing that the description does not mention."""
    words = [None if label is None else label.text for label in labels]
    borne, objects = Counter(words), dict(zip(words, fitted.tolist(), strict=True))
    more = {word: max(0, count - objects[word]) for word, count in borne.items() if word is not None}
    total = WORLD_COUNT + sum(more.values())
    shares = {word: (WORLD_COUNT * _share_of_world(word, kinds) + count) / total for word, count in more.items()}
    return np.array([0.0 if word is None else shares[word] for word in words])


def _share_of_world(word: str, kinds: Kinds) -> float:
    """Return the probability of a word as the right label of an arbitrary thing."""
    kind = kinds.of_word(word) or kinds.of_word(plain_name(word))
    if kind is None:
        return 1 / OTHER_WORDS
    narrower = sum(kind.iri in other.broader for other in kinds if other.iri != kind.iri)
    return (1 + BROADER_WORD * narrower) / len(kinds)
