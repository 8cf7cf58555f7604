"""Evidence of labels: how well a noun fits the class of each object, by the lexicon and by spelling."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import SequenceMatcher
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.lexicon.lexicon import Lexicon, Relatedness
from deixis.reasoning.grounding.reference.features.room import Room

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
"""Minimum ratio of matching letters at which two words count as spellings of one."""


NAMED = 0.06
"""Prior probability that an object of an unknown class is of the class that a noun names.

It is about the share of pairs of objects in a scene that have the same class, which is greater in rooms with many
chairs and smaller on tables.
"""

NAMED_WEIGHT = 20.0
"""Number of objects with known classes that count as much as this prior."""

CALLED = 0.85
"""Minimum fit of a noun to a label at which the noun names the class."""

ALIKE_SIZES = 0.25
"""Standard deviation of the logarithms of the sides of objects of one class in one scene."""

STRAY = 1e-6
"""Minimum density of the sizes of objects, so that a size that no other object has carries little information."""

SIZE_RATIOS = (-8.0, 6.0)
"""Range of the feature ``size`` of an object whose class is unknown."""


def class_shares(room: Room, named: float = NAMED) -> Array:
    """Return the probabilities of the possible classes of each object before a noun is heard, shape (k, n), sum 1.

    The classes of an object with a label are its label alone. Those of an object without one are its candidates; what
    these leave over is divided between the last two: the class that the noun names, and any other one.

    Parameters
    ----------
    room
        The scene of n objects.
    named
        Probability that an object of an unknown class is of the class that the noun names.

    Returns
    -------
    ndarray
        Probabilities, shape (k, n).
    """
    most = max((len(names) for names in room.names), default=0)
    unknown = bool(room.unlabelled.any())
    found = np.zeros((max(most, 0 if unknown else 1) + 2 * unknown, len(room)))
    for index, names in enumerate(room.names):
        found[: len(names), index] = list(names.values())
    if unknown:
        rest = np.maximum(1.0 - room.named, 1e-6) * room.unlabelled
        found[-2:] = named * rest, (1 - named) * rest
    return found


class Nouns:
    """The fit of nouns to the objects of rooms; kept, because people repeat few nouns.

    ``features`` returns an array of shape (k, n, f) for k possible classes of each object, with features in the order
    of ``NOUN_FEATURES``; ``similarity`` one number in [0, 1] for each object, shape (n,).
    """

    def __init__(self, lexicon: Lexicon) -> None:
        self._lexicon = lexicon
        self._pair = lru_cache(maxsize=100_000)(self._compare)
        self._is_plural = lru_cache(maxsize=10_000)(self._label_is_plural)

    def __reduce__(self) -> tuple[type[Nouns], tuple[Lexicon]]:
        return type(self), (self._lexicon,)  # without what is kept

    def features(self, noun: str, room: Room) -> Array:
        """Return the features of the fit of a noun to each object, under each of its possible classes.

        Parameters
        ----------
        noun
            The noun; empty if the description has none.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Features in the order of ``NOUN_FEATURES``, shape (k, n, f), for the classes of :func:`class_shares`.
        """
        found = np.zeros((len(class_shares(room)), len(room), len(NOUN_FEATURES)))
        if not noun:
            found[..., -2] = 1.0
            return found
        for index, names in enumerate(room.names):
            for place, name in enumerate(names):
                found[place, index, :-3] = self._pair(noun, name)[:-1]
        if room.unlabelled.any():
            named, other = found[-2:, room.unlabelled]
            named[:, :-3] = self._class_called(noun, room)
            named[:, -1] = self._sizes(noun, room)[room.unlabelled]
            other[:, FITS.index(Relatedness.UNRELATED)] = 1.0
            found[-2:, room.unlabelled] = named, other
            found[-2:, room.unlabelled, -3] = 1.0
        return found

    def _class_called(self, noun: str, room: Room) -> tuple[float, ...]:
        """Return the features of a noun and the class that it names, in the words of the room's source.

        They are those of the name in the room that means the noun, so that a label *sofa* counts as much for *couch* as
        an object that may turn out to be a sofa; without such a name, those of the noun itself.
        """
        names = dict.fromkeys(name for names in room.names for name in names)
        features = [self._pair(noun, name) for name in names]
        meant = [one for one in features if one[FITS.index(Relatedness.SAME)] or one[FITS.index(Relatedness.SYNONYM)]]
        if meant:
            return max(meant, key=lambda one: one[-1])[:-1]
        return (*(float(fit == Relatedness.SAME) for fit in FITS), 1.0, 1.0, 1.0)

    def similarity(self, noun: str, room: Room) -> Array:
        """Return the fit of the noun to each object as one number; 0 without a noun, a label and candidates.

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
        return np.array(
            [sum(share * self._pair(noun, name)[-1] for name, share in names.items()) for names in room.names]
        )

    def called(self, nouns: Iterable[str], room: Room) -> Array:
        """Return the probability that any of some nouns names the class of each object, by its label or its candidates.

        Parameters
        ----------
        nouns
            The nouns; empty ones name nothing.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Probabilities, shape (n,).
        """
        named = [noun for noun in nouns if noun]
        return np.array(
            [
                sum(
                    share
                    for name, share in names.items()
                    if any(self._pair(noun, name)[-1] >= CALLED for noun in named)
                )
                for names in room.names
            ],
            dtype=np.float64,
        )

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
        """Return how well the size of each object fits a noun, shape (n,): 0 if it carries no information.

        It is twice the logarithm of a ratio of densities: that of the sizes of the noun's class over that of all sizes
        in the room, each estimated from the objects whose classes are known. What the noun usually measures
        counts as one more object of its class. If no class is known, it is that alone, at most 0.
        """
        usual = self._usual_sizes(noun, room)
        if not room.named.any():
            return usual
        logs = np.log(_sides(room))
        apart = ((logs[:, None] - logs[None]) ** 2).sum(axis=2)
        alike = np.exp(-apart / (2 * ALIKE_SIZES**2)) + STRAY
        np.fill_diagonal(alike, 0.0)
        called = self.called([noun], room)
        among_all = np.maximum(alike @ room.named, STRAY) / room.named.sum()
        ratio = (alike @ called / among_all + np.exp(usual / 2)) / (called.sum() + 1)
        result: Array = np.clip(2 * np.log(ratio), *SIZE_RATIOS)
        return result

    def _usual_sizes(self, noun: str, room: Room) -> Array:
        """Return by how much the sides of each object are outside what the noun usually measures, shape (n,), negative.

        It is the sum of the logarithms of the ratios, each at least -3.
        """
        usual = self._lexicon.size_of(noun)
        extents = (usual.length, usual.width, usual.height)
        least, greatest = (np.log([max(getattr(one, end), 0.005) for one in extents]) for end in ("least", "greatest"))
        logs = np.log(_sides(room))
        off = np.maximum(least - logs, 0.0) + np.maximum(logs - greatest, 0.0)
        result: Array = -np.minimum(off, 3.0).sum(axis=1)
        return result


def _sides(room: Room) -> Array:
    """Return length, width and height of each object in metres, shape (n, 3), at least 5 mm."""
    plane = np.sort(room.extents[:, :2], axis=1)
    return np.maximum(np.stack([plane[:, 1], plane[:, 0], room.extents[:, 2]], axis=1), 0.005)
