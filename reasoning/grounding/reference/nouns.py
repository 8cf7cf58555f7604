"""Evidence of labels: how well a noun fits the class of each object, by the lexicon and by spelling."""

from __future__ import annotations

from difflib import SequenceMatcher
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.lexicon.lexicon import Lexicon, Relatedness
from deixis.reasoning.grounding.reference.room import Room

Array = NDArray[np.float64]

FITS = (
    Relatedness.SAME,
    Relatedness.SYNONYM,
    Relatedness.BROADER,
    Relatedness.NARROWER,
    Relatedness.SIBLING,
    Relatedness.UNRELATED,
)
NOUN_FEATURES = (*(str(fit) for fit in FITS), "similarity", "spelling", "head", "unlabelled", "no_noun", "size")
"""Names of the features of a noun and an object."""

NUMBER_FEATURES = ("plural_of_plural", "plural_of_singular", "singular_of_plural")
"""Names of the features of the number of a noun and that of a label."""

ALIKE = 0.75
"""Ratio of matching letters from which on two words count as spellings of one."""


class Nouns:
    """The fit of nouns to the objects of rooms; kept, because people repeat few nouns.

    ``features`` returns an array of shape (n, f) in the order of ``NOUN_FEATURES``; ``similarity`` one number in [0, 1]
    for each object, shape (n,).
    """

    def __init__(self, lexicon: Lexicon) -> None:
        self._lexicon = lexicon
        self._pair = lru_cache(maxsize=100_000)(self._compare)
        self._is_plural = lru_cache(maxsize=10_000)(self._label_is_plural)

    def features(self, noun: str, room: Room) -> Array:
        """Return the features of the fit of a noun to each object.

        Parameters
        ----------
        noun
            The noun; empty if the description has none.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Features in the order of ``NOUN_FEATURES``, shape (n, f).
        """
        found = np.zeros((len(room), len(NOUN_FEATURES)))
        if not noun:
            found[:, -2] = 1.0
            return found
        for index, label in enumerate(room.labels):
            if label is None:
                found[index, -3] = 1.0
            else:
                found[index, :-3] = self._pair(noun, label)[:-1]
        if any(label is None for label in room.labels):
            unlabelled = np.array([label is None for label in room.labels])
            found[unlabelled, -1] = self._sizes(noun, room)[unlabelled]
        return found

    def similarity(self, noun: str, room: Room) -> Array:
        """Return the fit of the noun to each object as one number; 0 without a noun or a label.

        Parameters
        ----------
        noun
            The noun; empty if the description has none.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Fits in [0, 1], shape (n,).
        """
        if not noun:
            return np.zeros(len(room))
        return np.array([0.0 if label is None else self._pair(noun, label)[-1] for label in room.labels])

    def number(self, plural: bool, room: Room) -> Array:
        """Return how the number of a noun agrees with that of each label.

        Parameters
        ----------
        plural
            Whether the noun is in the plural.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Features in the order of ``NUMBER_FEATURES``, 0 or 1, shape (n, 3).
        """
        many = np.array([label is not None and self._is_plural(label) for label in room.labels], dtype=np.bool_)
        return np.stack([many & plural, ~many & plural, many & (not plural)], axis=1).astype(np.float64)

    def _label_is_plural(self, label: str) -> bool:
        last = label.casefold().replace("_", " ").split()[-1:]
        return bool(last) and self._lexicon.singular(last[0]) != last[0]

    def _compare(self, noun: str, label: str) -> tuple[float, ...]:
        related = self._lexicon.relation(noun, label)
        similarity = self._lexicon.similarity(noun, label)
        ours, theirs = noun.split(), label.casefold().replace("_", " ").split()
        head = float(self._lexicon.singular(ours[-1]) == self._lexicon.singular(theirs[-1]))
        spelling = SequenceMatcher(None, noun.replace(" ", ""), "".join(theirs)).ratio()
        shared = len(set(ours) & set(theirs)) / max(len(ours), len(theirs))
        spelling = max(spelling if spelling >= ALIKE else 0.0, shared)
        one_hot = [float(related == fit) for fit in FITS]
        return (*one_hot, similarity, spelling, head, max(similarity, 0.9 * head, 0.6 * spelling))

    def _sizes(self, noun: str, room: Room) -> Array:
        """Return log densities of the sizes of objects for what the noun usually measures, shape (n,), at most 0."""
        usual = self._lexicon.size_of(noun)
        plane = np.sort(room.extents[:, :2], axis=1)
        measured = np.maximum(np.stack([plane[:, 1], plane[:, 0], room.extents[:, 2]], axis=1), 0.005)
        extents = (usual.length, usual.width, usual.height)
        least, greatest = (np.log([max(getattr(one, end), 0.005) for one in extents]) for end in ("least", "greatest"))
        off = np.log(measured)
        off = np.maximum(least - off, 0.0) + np.maximum(off - greatest, 0.0)
        result: Array = -np.minimum(off, 3.0).sum(axis=1)
        return result
