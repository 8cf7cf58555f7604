"""Learn meanings and sizes from described photographs by cross-validation (Stone 1974)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.photographs import Photograph
from deixis.ontology.models.sizes import SizeModel
from deixis.reasoning.grounding.evidence.properties.labels import classes
from deixis.reasoning.grounding.evidence.properties.unary import log_sizes
from deixis.reasoning.grounding.evidence.words.meaning import Meaning, shipped_models
from deixis.reasoning.grounding.fitting.fit import FitSettings, learn_relations
from deixis.reasoning.grounding.fitting.likelihood import said_pairs
from deixis.reasoning.grounding.fitting.sizes import learn_sizes

FIT = FitSettings(iterations=60)


def folds(count: int, number: int, seed: int) -> list[NDArray[np.int64]]:
    """Deal the numbers from 0 to ``count`` at random into ``number`` folds.

    Parameters
    ----------
    count
        Number of examples.
    number
        Number of folds.
    seed
        Seed of the random order.

    Returns
    -------
    list of array
        Indices of the examples of each fold; the sizes of the folds differ by at most 1.
    """
    order = np.random.default_rng(seed).permutation(count)
    return [order[start::number] for start in range(number)]


def learned_meanings(
    images: Sequence[Photograph], seed: int, number: int = 10, settings: FitSettings = FIT
) -> list[Meaning]:
    """Return, for each photograph, the words and the sizes relative to their scenes, learned from the other folds.

    Parameters
    ----------
    images
        Described photographs.
    seed
        Seed of the random folds.
    number
        Number of folds.
    settings
        Settings of the fit of the words.

    Returns
    -------
    list of Meaning
        What the words mean, one entry for each photograph, learned without the photographs of its fold.
    """
    lessons = [said_pairs(description, boxes, range(len(boxes))) for description, boxes in images]
    found: dict[int, Meaning] = {}
    for test in folds(len(images), number, seed):
        taught = np.setdiff1d(np.arange(len(images)), test).tolist()
        words = learn_relations([lessons[i] for i in taught], shipped_models(), settings)
        meaning = Meaning(words, relative_sizes([images[i] for i in taught]))
        found.update(dict.fromkeys(test.tolist(), meaning))
    return [found[i] for i in range(len(images))]


def relative_sizes(images: Sequence[Photograph]) -> Mapping[str, SizeModel]:
    """Return the sizes of the things of each name, relative to the others of their scene, by class IRI.

    Parameters
    ----------
    images
        Described photographs; their boxes are in pixels.

    Returns
    -------
    mapping of str to SizeModel
        Distribution of the length, in medians of the scene, and of the aspect, by class IRI.
    """
    views: dict[str, list[NDArray[np.float64]]] = defaultdict(list)
    for description, boxes in images:
        for kind, size in zip(classes(description), log_sizes(boxes, relative=True), strict=True):
            views[kind].append(size)
    return learn_sizes({kind: np.array(seen) for kind, seen in views.items()}, relative=True)
