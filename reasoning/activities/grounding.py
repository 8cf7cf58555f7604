"""Ground activities in sequences of fluents, and recognise which activity a sequence is.

Steps are matched with fluents by the engine that grounds descriptions in scenes: a fluent that fits a step is evidence
for the match, and the Allen relations of two fluents are evidence for the pair of matches, both as log-likelihood
ratios against chance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.reasoning.activities.activity import RELATIONS, STARTS_FIRST, Activity, Step, StepSequence
from deixis.reasoning.grounding.matching.posterior.posterior import posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem, empty_tables
from deixis.reasoning.grounding.matching.search.exact import exact

NONE_ODDS = 0.0
"""Log-odds of no known activity against one of them."""


@dataclass(frozen=True, slots=True)
class StepMatch:
    """A step, the id of the fluent that it is matched with or None, and the probability of that."""

    step: Step
    fluent: str | None
    probability: float


@dataclass(frozen=True, repr=False)
class ActivityGrounding(Answer):
    """An activity in a sequence of fluents.

    ``swapped`` are pairs of matched steps whose fluents started in another order than the activity has, ``other`` the
    ids of the fluents that match no step, ``evidence`` the log-likelihood ratio of the activity against chance in nats.

    Examples
    --------
    >>> from deixis.grammar.activities import told_activity
    >>> from deixis.reasoning.activities.activity import StepSequence
    >>> from deixis.reasoning.temporal.bounds import Bounds
    >>> from deixis.reasoning.temporal.fluent import Fluent, Statement
    >>> laid = {"plate": 10.0, "fork_1": 20.0, "fork_2": 5.0}
    >>> fluents = [Fluent(name, Statement(name, "laid"), Bounds(start, start)) for name, start in laid.items()]
    >>> seen = StepSequence.of(fluents)
    >>> found = ground_activity(told_activity("first the plate, then the forks", seen), seen)
    >>> found
    <ActivityGrounding told: 3 of 3 steps, 1 pair in another order>
    >>> [(str(first), str(second)) for first, second in found.swapped]
    [('plate', 'fork')]
    >>> found.missing
    ()
    """

    activity: str
    matches: tuple[StepMatch, ...]
    swapped: tuple[tuple[Step, Step], ...]
    other: tuple[str, ...]
    evidence: float

    @property
    def missing(self) -> tuple[Step, ...]:
        """Steps without a matching fluent."""
        return tuple(match.step for match in self.matches if match.fluent is None)

    def summary(self) -> str:
        """Return the numbers of steps found, missing and in another order."""
        found = len(self.matches) - len(self.missing)
        return (
            f"{self.activity}: {found} of {count(len(self.matches), 'step')}, "
            f"{count(len(self.swapped), 'pair')} in another order"
        )


@dataclass(frozen=True, repr=False)
class RecognisedActivity(Answer):
    """Probabilities of the known activities for a sequence, most probable first; None stands for none of them.

    Examples
    --------
    >>> found = RecognisedActivity((("breakfast", 0.9), (None, 0.1)), None)
    >>> found, found.name
    (<RecognisedActivity breakfast, probability 0.90>, 'breakfast')
    """

    probabilities: tuple[tuple[str | None, float], ...]
    grounding: ActivityGrounding | None

    @property
    def name(self) -> str | None:
        """Most probable activity; None for none of those known."""
        return self.probabilities[0][0]

    def summary(self) -> str:
        """Return the most probable activity with its probability."""
        name, probability = self.probabilities[0]
        return f"{name or 'no known activity'}, probability {probability:.2f}"


def ground_activity(
    activity: Activity, seen: StepSequence, deadline: Deadline = Deadline.never(), vocabulary: int | None = None
) -> ActivityGrounding:
    """Match the steps of an activity with the fluents of a sequence.

    Parameters
    ----------
    activity
        The activity.
    seen
        The sequence.
    deadline
        Time limit.
    vocabulary
        Number of kinds of steps that may occur; by default, of those that the activity or the sequence has.

    Returns
    -------
    ActivityGrounding
        The best match with probabilities, what is missing, in another order, or no step.
    """
    problem = _problem(activity, seen, vocabulary)
    best = exact(problem, deadline)
    assignment = best.assignment
    marginals = posterior(problem, deadline, start=assignment).marginals
    ids = [each.id for each in seen.fluents]
    matches = tuple(
        StepMatch(step, None if at == UNMATCHED else ids[at], float(marginals[number, at]))
        for number, (step, at) in enumerate(zip(activity.steps, assignment.tolist(), strict=True))
    )
    where = dict(zip(activity.steps, assignment.tolist(), strict=True))
    swapped = tuple(
        (first, second)
        for first, second in activity.usual_order()
        if UNMATCHED not in (where[first], where[second])
        and not int(seen.masks[where[first], where[second]]) & STARTS_FIRST
    )
    used = {match.fluent for match in matches}
    return ActivityGrounding(activity.name, matches, swapped, tuple(id for id in ids if id not in used), best.value)


def recognise_activity(
    activities: Sequence[Activity], seen: StepSequence, deadline: Deadline = Deadline.never()
) -> RecognisedActivity:
    """Recognise which of the known activities a sequence is.

    Parameters
    ----------
    activities
        The known activities.
    seen
        The sequence.
    deadline
        Time limit.

    Returns
    -------
    RecognisedActivity
        Probabilities of all activities and of none, and the grounding of the most probable activity.
    """
    kinds = {_kind(step) for activity in activities for step in activity.steps} | {_kind(each) for each in seen.steps}
    found = [ground_activity(activity, seen, deadline, len(kinds)) for activity in activities]
    values = np.array([NONE_ODDS, *(each.evidence for each in found)])
    shares = np.exp(values - values.max())
    shares /= shares.sum()
    names: list[str | None] = [None, *(each.activity for each in found)]
    ranked = sorted(zip(names, shares.tolist(), strict=True), key=lambda pair: -pair[1])
    best = int(np.argmax(values))
    return RecognisedActivity(tuple(ranked), found[best - 1] if best else None)


def _kind(step: Step) -> tuple[str, str | None, str | None]:
    return step.thing, step.predicate, step.object


def _problem(activity: Activity, seen: StepSequence, vocabulary: int | None) -> Problem:
    n1, n2 = len(activity.steps), len(seen.steps)
    chance = _chance(seen)
    allowed = np.array([[step.fits(each) for each in seen.steps] for step in activity.steps], bool).reshape(n1, n2)
    kinds = vocabulary or len({_kind(step) for step in (*activity.steps, *seen.steps)})
    presence = activity.presence
    unary = np.where(allowed, np.log(presence * max(kinds, 2))[:, None], 0.0)
    pairs = list(combinations(range(n1), 2))
    tables = empty_tables(len(pairs), n2)
    expected = activity.relations(chance)
    weight = _weight(n1)
    by_chance = seen.members @ chance
    for number, (a, b) in enumerate(pairs):
        tables[number] = weight * np.log((seen.members @ expected[a, b]) / by_chance)
    ends = np.array(pairs, dtype=np.int64).reshape(len(pairs), 2)
    return Problem(ends, np.arange(len(pairs)), tables, unary, np.log1p(-presence), allowed)


def _chance(seen: StepSequence) -> NDArray[np.float64]:
    """Return the smoothed frequency of each relation among the pairs of fluents of the sequence."""
    n = len(seen.steps)
    members = seen.members[~np.eye(n, dtype=bool)]
    shares = (members / members.sum(axis=1, keepdims=True)).sum(axis=0) if n > 1 else np.zeros(RELATIONS)
    found: NDArray[np.float64] = (shares + 1.0) / (shares + 1.0).sum()
    return found


def _weight(steps: int) -> float:
    """Return the factor of the evidence of pairs, which depend on each other.

    The order of n steps has log(n!) nats; its n (n - 1) / 2 pairs have log(2) each.
    """
    return 1.0 if steps < 3 else 2 * math.lgamma(steps + 1) / (steps * (steps - 1) * math.log(2))
