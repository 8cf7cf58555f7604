"""Say which words of people fit each pair of things of a scene, with their probabilities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import FAMILIES, GRADED_FAMILIES
from deixis.reasoning.errors import LimitError
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.geometry.poses import Poses
from deixis.reasoning.grounding.evidence.claims.claims import between_degrees
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models

Array = NDArray[np.float64]

LIKELY = 0.5
"""Minimum probability at which a word is said about a pair."""

PASSIVE = frozenset(
    {"around", "ringed_by", "leaned_on_by", "crossed_by", "stacked_under", "faced_by", "pointed_at_by", "less_long"}
)
"""Words that are said by their inverse, or of groups."""

UPRIGHT = frozenset({"above", "below", "level_with", "taller", "shorter"})
"""Words about heights, which boxes with two axes do not have."""

MAX_THINGS = 150
"""Maximum number of things whose pairs and triples are compared."""


@dataclass(frozen=True, eq=False)
class SceneWords:
    """Probabilities that people accept each graded word of each ordered pair of n things.

    Attributes
    ----------
    degrees
        Probability by word, shape (n, n); NaN where the scene says nothing, such as which way a plate faces.
    between
        Probability that the first thing is between the two others, shape (n, n, n).
    """

    degrees: Mapping[str, Array]
    between: Array

    def of(self, subject: int, other: int) -> dict[str, float]:
        """Return the words that are likely of a pair, the most probable first.

        Parameters
        ----------
        subject
            Position of the subject.
        other
            Position of the object.

        Returns
        -------
        dict
            Probability by word, at least ``LIKELY``.
        """
        found = {word: float(table[subject, other]) for word, table in self.degrees.items()}
        return dict(sorted(((w, p) for w, p in found.items() if p >= LIKELY), key=lambda one: -one[1]))

    def triples(self) -> list[tuple[int, int, int, float]]:
        """Return subject, first, second and probability of all likely *between*, the most probable first.

        Returns
        -------
        list of tuple
            Positions of the three things, and the probability.
        """
        n = len(self.between)
        places = np.argwhere(self.between >= LIKELY).tolist()
        found = [(i, j, k, float(self.between[i, j, k])) for i, j, k in places if j < k and i not in (j, k)]
        return sorted(found, key=lambda one: -one[3]) if n > 2 else []


def scene_words(boxes: Array, poses: Poses | None = None) -> SceneWords:
    """Compute the probabilities of all graded words for a scene.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d).
    poses
        Orientation of the things; None for axes along the sides of the boxes, and no fronts.

    Returns
    -------
    SceneWords
        Degrees of the words for all pairs, and of *between* for all triples.

    Raises
    ------
    LimitError
        If there are more than ``MAX_THINGS`` things.

    Examples
    --------
    >>> words = scene_words(np.array([[[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]]))
    >>> sorted(words.of(0, 1))
    ['aligned', 'left', 'narrower', 'near', 'next_to', 'smaller']
    """
    if len(boxes) > MAX_THINGS:
        raise LimitError(f"words are compared for at most {MAX_THINGS} things, got {len(boxes)}; use a smaller scene")
    fitting = WordDegrees(pair_geometry(boxes, poses), shipped_models())
    left_out = PASSIVE if boxes.shape[2] == 3 else PASSIVE | UPRIGHT
    words = [word for word in (*FAMILIES, *GRADED_FAMILIES) if word not in left_out]
    degrees = {word: np.where(fitting.undecided(word), np.nan, fitting.of_word(word)) for word in words}
    return SceneWords(degrees, between_degrees(boxes[:, :, :2].mean(axis=1)))
