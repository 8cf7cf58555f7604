"""Score contestants on cases, and derive means and differences from the scores."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.scoreboard.calibration import Forecasts
from deixis.experiments.scoreboard.cases import Case, Group, Setting
from deixis.experiments.scoreboard.contestants import Contestant, ContestantAnswer
from deixis.experiments.scoreboard.statistics import Interval, holm, interval, paired_p
from deixis.ontology.graph.graph import RelationGraph
from deixis.reasoning.grounding.answers.symmetry import interchangeable
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED
from deixis.reasoning.grounding.matching.problem import UNMATCHED

MEASURES = ("right", "grouped", "facts", "value")
ALPHA = 0.05

Map = NDArray[np.int64]


def right(assignment: Map, truth: Map) -> NDArray[np.bool_]:
    """Return True for each object (n1,) that is given its own thing, or left out if it is missing.

    Parameters
    ----------
    assignment
        Thing of each object, or ``UNMATCHED``, shape (n1,).
    truth
        Correct thing of each object, or ``UNMATCHED``, shape (n1,).

    Returns
    -------
    array
        True for the correct objects, shape (n1,).
    """
    same: NDArray[np.bool_] = assignment == truth
    return same


def groups(description: RelationGraph) -> list[NDArray[np.int64]]:
    """Return groups of objects that the description (with kinds) provably cannot distinguish, as node indices.

    Parameters
    ----------
    description
        Description, with the kinds of its objects if it states any.

    Returns
    -------
    list of array
        Indices of the nodes of each group.
    """
    kinds = description.kinds or (None,) * len(description.nodes)
    found = interchangeable(description, kinds)
    return [np.array([description.index(name) for name in group], dtype=np.int64) for group in found]


def right_up_to_interchangeability(assignment: Map, truth: Map, groups: Sequence[NDArray[np.int64]]) -> float:
    """Return the share of correct objects when the things of a group may be exchanged among its objects.

    Each thing counts once, and each missing object of a group counts as one that is left out.

    Parameters
    ----------
    assignment
        Thing of each object, or ``UNMATCHED``, shape (n1,).
    truth
        Correct thing of each object, or ``UNMATCHED``, shape (n1,).
    groups
        Indices of interchangeable objects, as :func:`groups` returns them.

    Returns
    -------
    float
        Share in [0, 1]; 1 without objects.

    Examples
    --------
    >>> truth, swapped = np.array([0, 1, 2]), np.array([1, 0, UNMATCHED])
    >>> round(right_up_to_interchangeability(swapped, truth, [np.array([0, 1])]), 2)
    0.67
    """
    if len(truth) == 0:
        return 1.0
    count = int(right(assignment, truth).sum())
    for group in groups:
        given, own = assignment[group], truth[group]
        shared = len(np.intersect1d(given[given != UNMATCHED], own[own != UNMATCHED]))
        absent = min(int((given == UNMATCHED).sum()), int((own == UNMATCHED).sum()))
        count += shared + absent - int(right(given, own).sum())
    return count / len(truth)


def satisfied(evidence: Evidence, assignment: Map) -> int:
    """Return the number of stated facts that hold for the assigned things, at least in the wide reading.

    Parameters
    ----------
    evidence
        Evidence with the stated facts.
    assignment
        Thing of each object, or ``UNMATCHED``, shape (n1,).

    Returns
    -------
    int
        Number of facts with a degree above 0.
    """
    return int((evidence.degrees(assignment) > 0).sum())


def relative(figures: Sequence[float]) -> list[float]:
    """Return each figure divided by the greatest; nan if that is not above 0.

    Parameters
    ----------
    figures
        One figure for each contestant.

    Returns
    -------
    list of float
        Ratios in the given order.
    """
    best = max(figures, default=0.0)
    return [figure / best if best > 0 else float("nan") for figure in figures]


@dataclass(frozen=True, slots=True)
class Score:
    """The scores of one contestant on one case.

    Shares of objects right (and up to interchangeability), facts and value relative to the best found by any contestant
    on the case (nan where that is not above 0), and seconds from evidence to answer.
    """

    setting: Setting
    unit: int
    contestant: str
    right: float
    grouped: float
    facts: float
    value: float
    seconds: float
    proved: bool


@dataclass(frozen=True, slots=True)
class EngineComparison:
    """The lead of the default over another contestant in a group, with p and p adjusted for all comparisons."""

    group: Group
    other: str
    measure: str
    difference: Interval
    p: float
    adjusted: float

    @property
    def verdict(self) -> str:
        """Verdict on the default: significantly ``better`` or ``worse``, or neither."""
        if not self.adjusted < ALPHA:
            return ""
        return "better" if self.difference.mean > 0 else "worse"


@dataclass(frozen=True, eq=False)
class Board:
    """All scores of a run of contestants, the default first, over cases."""

    contestants: tuple[Contestant, ...]
    scores: tuple[Score, ...]
    forecasts: tuple[Forecasts, ...]

    @property
    def groups(self) -> list[Group]:
        """The sizes and noises, photographs last."""
        return sorted({score.setting.group for score in self.scores}, key=lambda group: (group.objects == 0, group))

    @cached_property
    def _by_place(self) -> dict[tuple[str, Group | Setting], list[Score]]:
        found: dict[tuple[str, Group | Setting], list[Score]] = defaultdict(list)
        for score in self.scores:
            found[score.contestant, score.setting].append(score)
            found[score.contestant, score.setting.group].append(score)
        return found

    def of(self, contestant: str, group: Group | Setting) -> list[Score]:
        """Return the scores of one contestant in a group, or in one setting of it.

        Parameters
        ----------
        contestant
            Name of a contestant.
        group
            Group of cases, or one setting of it.

        Returns
        -------
        list of Score
            One score for each case; empty if the contestant took none.
        """
        return self._by_place.get((contestant, group), [])

    def by_unit(self, contestant: str, group: Group | Setting, measure: str) -> dict[tuple[Setting, int], float]:
        """Return the measure for every table or image, averaged over its node orders.

        Parameters
        ----------
        contestant
            Name of a contestant.
        group
            Group of cases, or one setting of it.
        measure
            Name of a field of :class:`Score`.

        Returns
        -------
        dict
            Mean by setting and number of the table or image.
        """
        found: dict[tuple[Setting, int], list[float]] = defaultdict(list)
        for score in self.of(contestant, group):
            found[score.setting, score.unit].append(getattr(score, measure))
        return {unit: float(np.mean(values)) for unit, values in found.items()}

    def mean(self, contestant: str, group: Group | Setting, measure: str) -> Interval:
        """Return the mean of a measure in a group or setting, with its interval.

        Parameters
        ----------
        contestant
            Name of a contestant.
        group
            Group of cases, or one setting of it.
        measure
            Name of a field of :class:`Score`.

        Returns
        -------
        Interval
            Mean over tables or images with its 95 % interval; nan without scores.
        """
        return interval(list(self.by_unit(contestant, group, measure).values()))

    def comparisons(self, measure: str, seed: int) -> list[EngineComparison]:
        """Compare the default with each other contestant in each group, on the same cases; adjust by Holm.

        Parameters
        ----------
        measure
            Name of a field of :class:`Score`.
        seed
            Seed of the permutation tests.

        Returns
        -------
        list of EngineComparison
            One comparison for each group and contestant with cases in common; positive differences favour the default.
        """
        default, *others = (contestant.name for contestant in self.contestants)
        found = []
        for group in self.groups:
            of_default = self.by_unit(default, group, measure)
            for other in others:
                of_other = self.by_unit(other, group, measure)
                differences = [of_default[unit] - of_other[unit] for unit in of_other]
                if differences:
                    found.append((group, other, interval(differences), paired_p(differences, seed)))
        adjusted = holm([p for *_, p in found])
        return [
            EngineComparison(group, other, measure, difference, p, q)
            for (group, other, difference, p), q in zip(found, adjusted, strict=True)
        ]


def median_seconds(scores: Sequence[Score]) -> float:
    """Return the median time of the scores, of which there must be at least one.

    Parameters
    ----------
    scores
        Scores, at least one.

    Returns
    -------
    float
        Time in seconds.
    """
    return float(np.median([score.seconds for score in scores]))


def run_contestants(
    contestants: Sequence[Contestant], cases: Iterable[Case], seconds: float, tick: Callable[[str], None]
) -> Board:
    """Run every contestant on every case that is not too large for it.

    Parameters
    ----------
    contestants
        The contestants, the default engine first; those that lack a package are left out.
    cases
        The cases, each with its truth.
    seconds
        The time limit of a contestant for a case.
    tick
        Called with the name of the group after each case.

    Returns
    -------
    The board of all scores.
    """
    able = [contestant for contestant in contestants if not contestant.lacking]
    scores: list[Score] = []
    forecasts: list[Forecasts] = []
    warm: set[str] = set()
    for case in cases:
        entered = [contestant for contestant in able if contestant.enters(case)]
        for contestant in entered:
            if contestant.name not in warm:  # compile or load compiled code once, outside the measured time
                warm.add(_ask(contestant, case, seconds)[0])
        answers = [_ask(contestant, case, seconds) for contestant in entered]
        judge, alike = case.evidence(SHIPPED), groups(case.description)
        maps: list[NDArray[np.int64]] = [answer.assignment for _, answer, _ in answers]
        facts = relative([float(satisfied(judge, found)) for found in maps])
        values = relative([judge.problem.value(found) for found in maps])
        scores += [
            Score(
                setting=case.setting,
                unit=case.unit,
                contestant=name,
                right=float(right(found, case.truth).mean()),
                grouped=right_up_to_interchangeability(found, case.truth, alike),
                facts=fact,
                value=value,
                seconds=seconds,
                proved=answer.proved,
            )
            for (name, answer, seconds), found, fact, value in zip(answers, maps, facts, values, strict=True)
        ]
        forecasts += [Forecasts.of(name, case, answer) for name, answer, _ in answers if answer.marginals is not None]
        tick(str(case.setting.group))
    return Board(tuple(able), tuple(scores), tuple(forecasts))


_TimedAnswer = tuple[str, ContestantAnswer, float]


def _ask(contestant: Contestant, case: Case, seconds: float) -> _TimedAnswer:
    """Return the answer, and the time from evidence to answer; each contestant gets fresh evidence."""
    case.scene  # noqa: B018 - what was perceived is there before anybody is asked
    evidence = case.evidence(contestant.meaning, contestant.learned)
    started = time.perf_counter()
    answer = contestant.solve(evidence, Deadline.after(seconds))
    return contestant.name, answer, time.perf_counter() - started
