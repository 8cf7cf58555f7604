"""Descriptions that single out one object of a scene, by the incremental algorithm."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.relation import Reading
from deixis.reasoning.geometry.rectangle import SceneRelations

MIN_SIZE_RATIO = 1.3
"""Minimum ratio of sizes from which an object is called the largest or the smallest."""

MAX_RELATIONS = 3
"""Maximum number of relations in a description."""


MAX_LANDMARKS = 30
"""Maximum number of landmarks, the nearest, that relations of an object are searched for."""


@dataclass(frozen=True)
class Attributes:
    """Nouns, colours, sizes and relations of the n objects of a scene.

    ``nouns`` and ``colours`` are words, None where unknown; ``sizes`` are footprints in square metres, shape (n,);
    ``related`` are the exact relations of all pairs, ``gaps`` their distances in metres, shape (n, n).
    """

    nouns: tuple[str | None, ...]
    colours: tuple[str | None, ...]
    sizes: NDArray[np.float64]
    related: SceneRelations
    gaps: NDArray[np.float64]

    def word(self, subject: int, thing: int) -> str:
        """Return the wide relation that says most of a pair: ``top_left`` rather than ``top``.

        Parameters
        ----------
        subject
            Position of the object.
        thing
            Position of the landmark.

        Returns
        -------
        str
            Name of the relation, without ``exactly_``.
        """
        return self.related.relation(subject, thing).name.removeprefix("exactly_")

    def fitting(self, others: Sequence[int], word: str, thing: int) -> list[int]:
        """Return the objects, among some, that have a wide relation to an object, and this object itself.

        Parameters
        ----------
        others
            Positions of the objects.
        word
            Name of the relation, wide reading.
        thing
            Position of the landmark.

        Returns
        -------
        list of int
            Positions of the objects that fit, in the order of ``others``.
        """
        names = self.related.names[np.asarray(others, dtype=np.int64), thing]
        fits = self._implying[word][names] | (names < 0)
        return [other for other, is_one in zip(others, fits.tolist(), strict=True) if is_one]

    @cached_property
    def _implying(self) -> dict[str, NDArray[np.bool_]]:
        """For each wide relation, whether each relation, by its index, implies it."""
        relations = self.related.vocabulary
        wide = {relation.name.removeprefix("exactly_") for relation in relations.of_reading(Reading.EXACT)}
        return {word: np.array([word in relation.broader for relation in relations.values()]) for word in wide}

    def share(self, words: Sequence[str | None], subject: int, other: int) -> bool:
        """Return True unless both objects have a known word and the words differ.

        Parameters
        ----------
        words
            Nouns or colours of all objects; None where unknown.
        subject
            Position of an object.
        other
            Position of another object.

        Returns
        -------
        bool
            False if the two words are known and differ.
        """
        return words[subject] is None or words[other] is None or words[subject] == words[other]


@dataclass(frozen=True)
class Description:
    """Attributes that are said about an object: its noun always, the others where they rule something out.

    ``size`` is ``largest`` or ``smallest``. ``relations`` are pairs of a relation and an object. ``rivals`` are the
    objects that the description fits as well.
    """

    target: int
    noun: str | None
    colour: str | None = None
    size: str | None = None
    relations: tuple[tuple[str, int], ...] = ()
    rivals: tuple[int, ...] = field(default=())


def single_out(target: int, among: Collection[int], attributes: Attributes, landmarks: Collection[int]) -> Description:
    """Describe an object so that the description fits no other one.

    Attributes are tried in a fixed order (noun, colour, size, relations to the landmarks, the nearest first), and each
    is kept if it rules out an object that the earlier ones leave.

    Parameters
    ----------
    target
        The object, by its position in the scene.
    among
        Objects to tell it from.
    attributes
        What can be said about the objects.
    landmarks
        Objects that relations may mention.

    Returns
    -------
    Description
        Description; its ``rivals`` are the objects that no attribute rules out.

    Notes
    -----
    R. Dale, E. Reiter: Computational interpretations of the Gricean maxims in the generation of referring expressions.
    Cognitive Science 19 (1995).
    """
    rivals = [other for other in among if other != target and attributes.share(attributes.nouns, target, other)]
    colour = attributes.colours[target]
    left = [other for other in rivals if attributes.share(attributes.colours, target, other)]
    if colour is None or len(left) == len(rivals):
        colour, left = None, rivals
    size = None
    if left:
        others = attributes.sizes[left]
        if attributes.sizes[target] >= MIN_SIZE_RATIO * others.max():
            size, left = "largest", []
        elif attributes.sizes[target] * MIN_SIZE_RATIO <= others.min():
            size, left = "smallest", []
    return relate(Description(target, attributes.nouns[target], colour, size, (), tuple(left)), attributes, landmarks)


def relate(
    description: Description,
    attributes: Attributes,
    landmarks: Collection[int],
    least: int = 0,
    most: int = MAX_RELATIONS,
) -> Description:
    """Add relations to landmarks until nothing else fits the description; those that rule out most come first.

    The first relations are to the nearest landmarks.

    Parameters
    ----------
    description
        Description with its rivals.
    attributes
        What can be said about the objects.
    landmarks
        Positions of the objects that relations may mention.
    least
        Minimum number of relations.
    most
        Maximum number of relations.

    Returns
    -------
    Description
        Description with the relations and the remaining rivals.
    """
    target, left = description.target, list(description.rivals)
    relations = list(description.relations)
    near = sorted((mark for mark in landmarks if mark != target), key=lambda mark: attributes.gaps[target, mark])
    near = near[: max(MAX_LANDMARKS, least)]
    while near and len(relations) < max(most, least) and (left or len(relations) < least):
        if len(relations) < least:
            best = near[0]
        else:
            best = min(near, key=lambda mark: len(attributes.fitting(left, attributes.word(target, mark), mark)))
        word = attributes.word(target, best)
        kept = attributes.fitting(left, word, best)
        if len(kept) == len(left) and len(relations) >= least:
            break
        relations.append((word, best))
        near.remove(best)
        left = kept
    return Description(target, description.noun, description.colour, description.size, tuple(relations), tuple(left))


def reading_order(attributes: Attributes) -> Iterator[int]:
    """Yield the objects of a scene: a landmark first, then always the one nearest to those before it.

    The landmark is the largest of the objects whose noun, or noun and colour, no other object has; else the largest.

    Parameters
    ----------
    attributes
        What can be said about the objects.

    Yields
    ------
    int
        Position of the next object.
    """
    n = len(attributes.sizes)
    everything = range(n)
    unique = [i for i in everything if attributes.nouns[i] is not None and _is_unique(i, attributes)]
    first = max(unique or everything, key=lambda i: attributes.sizes[i])
    yield first
    nearest = attributes.gaps[first].copy()
    placed = np.zeros(n, dtype=bool)
    placed[first] = True
    for _ in range(n - 1):
        following = int(np.where(placed, np.inf, nearest).argmin())
        yield following
        placed[following] = True
        nearest = np.minimum(nearest, attributes.gaps[following])


def _is_unique(target: int, attributes: Attributes) -> bool:
    same = [o for o in range(len(attributes.sizes)) if o != target and attributes.share(attributes.nouns, target, o)]
    return not any(attributes.share(attributes.colours, target, other) for other in same)
