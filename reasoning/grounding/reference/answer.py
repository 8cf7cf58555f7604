"""The answer to a description of one object: which object is meant, how probably, and what to ask if in doubt."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

from deixis.answers import Answer

DECIDED = 0.95
"""Minimum probability of a decided reference."""


class Frame(StrEnum):
    """Frame of reference of the directions in a description."""

    VIEWER = "viewer"
    OBJECT = "object"
    TABLE = "table"


@dataclass(frozen=True, slots=True)
class Question:
    """A yes-or-no question that describes the object; ``yes`` holds the ids of the objects with the answer yes."""

    text: str
    yes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Turn:
    """A question and its answer."""

    question: Question
    yes: bool


@dataclass(frozen=True, repr=False)
class Reference(Answer):
    """The object of a scene that a description refers to.

    Parameters
    ----------
    text
        The description.
    target
        Id of the most probable object; None if the scene has no objects or nothing of the text was understood.
    probability
        Posterior probability of the target.
    alternatives
        Other objects with their probabilities, the most probable first; those below 0.001 are left out.
    understood
        Share of the words that were understood.
    paraphrase
        What was understood, in English.
    frame
        Frame of the directions in the description; None if it has none.
    question
        The question that tells most about the object; None if the reference is decided or nothing tells more.
    turns
        Questions that were asked, with their answers.
    notes
        Warnings about the text.
    scene
        The scene, for pictures.

    Examples
    --------
    >>> import deixis
    >>> scene = deixis.read_scene({"objects": [
    ...     {"id": "o1", "label": "fork", "min": [0, 0], "max": [0.03, 0.2]},
    ...     {"id": "o2", "label": "plate", "min": [0.1, 0], "max": [0.35, 0.25]}]})
    >>> found = deixis.refer("the thing left of the plate", scene)
    >>> found.target, found.paraphrase, found.decided
    ('o1', 'the one to the left of the plate', True)
    """

    text: str
    target: str | None
    probability: float
    alternatives: tuple[tuple[str, float], ...]
    understood: float
    paraphrase: str
    frame: Frame | None = None
    question: Question | None = None
    turns: tuple[Turn, ...] = ()
    notes: tuple[str, ...] = ()
    scene: object | None = field(default=None, compare=False)

    @property
    def decided(self) -> bool:
        """True if the probability of the target is at least 0.95."""
        return self.target is not None and self.probability >= DECIDED

    def summary(self) -> str:
        """Return one line with the target and its probability."""
        if self.target is None:
            return f"'{self.text}': no object"
        return f"'{self.text}': {self.target} ({self.probability:.2f}{'' if self.decided else ', undecided'})"
