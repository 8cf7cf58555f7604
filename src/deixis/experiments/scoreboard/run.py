"""Run the whole scoreboard from a plan; the same plan gives the same figures, except times."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, product
from pathlib import Path

import numpy as np

from deixis.answers import Answer, count
from deixis.experiments.photographs import FOLDER
from deixis.experiments.scoreboard.bayes_limit import Limit, bayes_limit
from deixis.experiments.scoreboard.board import Board, run_contestants
from deixis.experiments.scoreboard.calibration import Reliability, calibration
from deixis.experiments.scoreboard.cases import (
    LARGEST_PHOTOGRAPH,
    PHOTOGRAPHS,
    Case,
    Setting,
    generated_cases,
    photograph_cases,
    table,
)
from deixis.experiments.scoreboard.contestants import DEFAULT, Contestant, ablations, engines
from deixis.experiments.scoreboard.statistics import Interval, interval

SHARES = {100: 0.5, 300: 0.2, 1000: 0.1}
"""Share of a setting's cases for large numbers of objects, which take longer."""

MIN_CASES = 2
SMALL = 30
"""Maximum number of objects in the small pool for calibration; probabilities of larger tables are sampled."""


@dataclass(frozen=True)
class ScoreboardPlan:
    """The plan of a scoreboard: every combination of sizes, facts per object and wrong share, with and without changes.

    ``cases`` is the number of tables of a setting (fewer of large ones), ``most_photographs`` None for all of them.
    """

    cases: int = 10
    seed: int = 1
    time_limit: float = 5.0  # time limit of an engine for a case
    sizes: tuple[int, ...] = (8, 12, 15, 30, 100, 300, 1000)
    facts_each: tuple[float, ...] = (1.0, 1.5, 2.5)
    off: tuple[float, ...] = (0.0, 0.1, 0.2)
    ablated_sizes: tuple[int, ...] = (8, 12, 15)
    limited_sizes: tuple[int, ...] = (8, 12)
    photographs: Path | None = None
    most_photographs: int | None = None
    orders: int = 3  # node orders of a photograph

    def quick(self) -> ScoreboardPlan:
        """Return a smaller plan that takes a minute or two.

        Returns
        -------
        ScoreboardPlan
            Plan with few cases, sizes and photographs, and at most 0.5 s for each case.
        """
        return replace(
            self,
            cases=min(self.cases, 2),
            time_limit=min(self.time_limit, 0.5),
            sizes=(8, 12, 30),
            facts_each=(1.0, 2.5),
            ablated_sizes=(8,),
            most_photographs=15,
            orders=1,
        )

    def only(self, sizes: Sequence[int]) -> ScoreboardPlan:
        """Return the plan with tables of these sizes alone; the photographs stay.

        Parameters
        ----------
        sizes
            Numbers of objects, in any order.

        Returns
        -------
        ScoreboardPlan
            Plan with these sizes in ascending order.
        """
        chosen = tuple(sorted(set(sizes)))
        ablated = tuple(size for size in self.ablated_sizes if size in chosen)
        return replace(self, sizes=chosen, ablated_sizes=ablated)

    def count(self, objects: int) -> int:
        """Return the number of tables of each setting of a size.

        Parameters
        ----------
        objects
            Number of objects of a table.

        Returns
        -------
        int
            Number of tables; larger tables get fewer.
        """
        least = min(self.cases, MIN_CASES)
        share = next((share for size, share in SHARES.items() if objects <= size), min(SHARES.values()))
        return max(least, round(self.cases * (1.0 if objects <= SMALL else share)))

    def settings(self, objects: int) -> list[Setting]:
        """Return the settings of tables of that many objects.

        Parameters
        ----------
        objects
            Number of objects of a table.

        Returns
        -------
        list of Setting
            All combinations of the shares of wrong facts and the numbers of facts, with and without changed things.
        """
        return [
            Setting(objects, off, facts, changed)
            for off, facts, changed in product(self.off, self.facts_each, (False, True))
        ]

    def generated(self, sizes: Sequence[int], *, kinds: bool = False) -> Iterator[Case]:
        """Yield the generated cases of these sizes.

        Parameters
        ----------
        sizes
            Numbers of objects.
        kinds
            True if the descriptions state the kind of each object.

        Yields
        ------
        Case
            Cases of all settings of these sizes, size by size.
        """
        return chain.from_iterable(
            generated_cases(self.settings(size), self.count(size), self.seed, kinds=kinds) for size in sizes
        )

    def photographed(self, *, learn: bool = False) -> Iterator[Case]:
        """Yield the cases from photographs, if the plan has a folder of them.

        Parameters
        ----------
        learn
            True to add the meanings that were learned from the photographs of other folds.

        Yields
        ------
        Case
            One case for each photograph and order.

        Raises
        ------
        PhotographError
            If the files are not annotations of photographs.
        """
        if self.photographs is None:
            return iter(())
        return photograph_cases(self.photographs, self.orders, self.most_photographs, self.seed, learn=learn)


@dataclass(frozen=True, slots=True)
class Limited:
    """The default engine and the Bayes limits in a setting; ``short`` is its distance below the first limit."""

    setting: Setting
    right: Interval
    words: Interval
    words_and_pairs: Interval
    short: Interval
    maps: int  # greatest number of possible maps of one table
    incomplete: int  # tables whose maps could not all be listed


@dataclass(frozen=True, eq=False, repr=False)
class Scoreboard(Answer):
    """The main board, the ablations (with kinds), the limits, and a list of the parts left out."""

    plan: ScoreboardPlan
    main: Board
    ablations: Board
    limits: tuple[Limited, ...]
    skipped: tuple[str, ...]

    def summary(self) -> str:
        """Return the numbers of engines and of scores."""
        return f"{count(len(self.main.contestants), 'engine')}, {count(len(self.main.scores), 'score')}"

    def calibrations(self) -> dict[str, Reliability]:
        """Return the calibration of the default engine: by noise, small and large tables apart, and of photographs.

        Returns
        -------
        dict of str to Reliability
            Calibration by the name of the pool; pools without cases are left out.
        """
        pools = {f"up to {SMALL}, {100 * off:.0f} % off": (off, 1, SMALL) for off in self.plan.off}
        pools |= {f"larger, {100 * off:.0f} % off": (off, SMALL + 1, max(self.plan.sizes)) for off in self.plan.off}
        pools["photographs"] = (0.0, PHOTOGRAPHS, PHOTOGRAPHS)
        found = {}
        for name, (off, least, most) in pools.items():
            chosen = [
                one
                for one in self.main.forecasts
                if one.contestant == DEFAULT and one.group.off == off and least <= one.group.objects <= most
            ]
            if chosen:
                found[name] = calibration(chosen)
        return found


def run(
    plan: ScoreboardPlan,
    contestants: Sequence[Contestant] | None = None,
    tick: Callable[[str], None] = lambda _: None,
) -> Scoreboard:
    """Run the scoreboard of a plan.

    Parameters
    ----------
    plan
        The sizes, settings and seed of the run.
    contestants
        The contestants of the main board, the default engine first; the shipped engines if None.
    tick
        Called after each of ``steps(plan)`` steps with a description of it.

    Returns
    -------
    The scores of the main board and of the ablations, the Bayes limits, and a list of the skipped parts.
    """
    entered = engines() if contestants is None else list(contestants)
    main = run_contestants(entered, chain(plan.generated(plan.sizes), plan.photographed()), plan.time_limit, tick)
    ablated = run_contestants(
        ablations(),
        chain(plan.generated(plan.ablated_sizes, kinds=True), plan.photographed(learn=True)),
        plan.time_limit,
        tick,
    )
    limits = tuple(
        _limited(plan, setting, main, tick)
        for size in plan.limited_sizes
        if size in plan.sizes
        for setting in plan.settings(size)
        if not setting.changed
    )
    notes = [f"{one.name}: {one.lacking}" for one in entered if one.lacking]
    for one in entered:
        larger = [f"{size} objects" for size in plan.sizes if size > one.most]
        if plan.photographs is not None and one.most < LARGEST_PHOTOGRAPH:
            larger.append("photographs")
        if larger and not one.lacking:
            notes.append(f"{one.name} with {', '.join(larger)}: too large for it (at most {one.most})")
    if plan.photographs is None:
        notes.append(f"photographs: set DEIXIS_DATA to the folder that holds {FOLDER}/")
    skipped = tuple(notes)
    return Scoreboard(plan, main, ablated, limits, skipped)


def steps(plan: ScoreboardPlan) -> int:
    """Return the number of ticks of a run.

    Parameters
    ----------
    plan
        Plan of the run.

    Returns
    -------
    int
        Number of cases and limits to compute. Photographs count twice: for the board and for the ablations.
    """
    tables = sum(plan.count(size) * len(plan.settings(size)) for size in (*plan.sizes, *plan.ablated_sizes))
    limits = sum(len(plan.settings(size)) // 2 for size in plan.limited_sizes if size in plan.sizes)
    return tables + limits + 2 * sum(1 for _ in plan.photographed())


def _limited(plan: ScoreboardPlan, setting: Setting, main: Board, tick: Callable[[str], None]) -> Limited:
    limits: list[Limit] = [bayes_limit(table(setting, n, plan.seed)) for n in range(plan.count(setting.objects))]
    of_default = main.by_unit(DEFAULT, setting, "right")
    rights = [of_default[setting, number] for number in range(len(limits))]
    words = [limit.words for limit in limits]
    tick(f"Bayes limit, {setting.objects} objects")
    return Limited(
        setting,
        interval(rights),
        interval(words),
        interval([limit.words_and_pairs for limit in limits]),
        interval(np.subtract(words, rights)),
        max(limit.maps for limit in limits),
        sum(not limit.complete for limit in limits),
    )
