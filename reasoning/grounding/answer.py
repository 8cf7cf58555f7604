"""The types of an answer: who is who, and everything that qualifies it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import Fact
from deixis.ontology.lessons.types import Alternative, Match
from deixis.ontology.relation import Relation

DECIDED = 0.99
"""Probability from which a match is called decided: where things are missing, somewhat less is right than was said, for
an extra thing may fit all that is said of what is absent (docs/scoreboard.md)."""


FIRMLY = 0.975
"""What is decided is as probable even if it is off by the error of its probability."""


def is_decided(probability: NDArray[np.float64], error: float) -> NDArray[np.bool_]:
    """Which of these probabilities (…,) are high enough, and known well enough, to call a match decided.

    >>> is_decided(np.array([0.98, 0.995]), 0.01).tolist(), is_decided(np.array([0.995]), 0.05).tolist()
    ([False, True], [False])
    """
    decided: NDArray[np.bool_] = (probability >= DECIDED) & (probability - error >= FIRMLY)
    return decided


class Standing(StrEnum):
    """What the probabilities of an answer are worth."""

    NONE = "none"  # the engine gives none
    EXACT = "exact"  # from all maps that count
    SAMPLED = "sampled"  # an approximation


class Outcome(StrEnum):
    """What became of a stated fact."""

    SATISFIED = "satisfied"  # holds of the matched pair, at least widely
    VIOLATED = "violated"  # does not hold of the matched pair
    WAIVED = "waived"  # does not hold, and was optional
    OPEN = "open"  # an object of it is not matched


@dataclass(frozen=True, slots=True)
class FactOutcome:
    """A stated fact, what became of it, and the exact relation perceived instead or accordingly."""

    fact: Fact
    outcome: Outcome
    degree: float
    perceived: tuple[str, str] | None
    seen: Relation | None


@dataclass(frozen=True, slots=True)
class LeftOut:
    """An object or a perceived thing without a counterpart, and why; what an object could be all the same."""

    name: str
    reason: str
    alternatives: tuple[Alternative, ...] = ()


@dataclass(frozen=True, slots=True)
class Pivotal:
    """A fact without which the answer would be another.

    ``changes`` are the objects that would be something else then (None: not there), ``unsettled`` those that would no
    longer be decided, ``settled`` those that only then would be.
    """

    fact: Fact
    changes: Mapping[str, str | None]
    unsettled: tuple[str, ...]
    settled: tuple[str, ...]


@dataclass(frozen=True)
class Grounding:
    """The answer of an engine, with all that qualifies it.

    ``probabilities`` says what those of the matches are worth, and ``probability_error`` by how much they may be off.
    ``pivotal`` is None where it was not looked for what would change without a fact, as where the description is taken
    to be of another scene. ``finished`` says whether the engine came to its end within the time limit. By ``gap``
    (nats) another answer may be likelier at most: 0 where this one is proved the best, infinite where the engine has no
    bound.
    """

    engine: str
    matches: Mapping[str, Match]
    unmatched_objects: tuple[LeftOut, ...]
    unmatched_perceived: tuple[LeftOut, ...]
    interchangeable: tuple[tuple[str, ...], ...]
    graph_similarity: float
    outcomes: tuple[FactOutcome, ...]
    proved_best: bool
    converged: bool
    notes: tuple[str, ...]
    seconds: float
    pivotal: tuple[Pivotal, ...] | None = None
    probabilities: Standing = Standing.NONE
    probability_error: float = 0.0
    finished: bool = True
    gap: float = math.inf

    def of(self, outcome: Outcome) -> tuple[FactOutcome, ...]:
        return tuple(entry for entry in self.outcomes if entry.outcome is outcome)

    @property
    def satisfied(self) -> tuple[FactOutcome, ...]:
        return self.of(Outcome.SATISFIED)

    def noting(self, notes: tuple[str, ...]) -> Grounding:
        """The same answer with notes before its own."""
        return replace(self, notes=notes + self.notes)

    @property
    def violated(self) -> tuple[FactOutcome, ...]:
        return self.of(Outcome.VIOLATED)
