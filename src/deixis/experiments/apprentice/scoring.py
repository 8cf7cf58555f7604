"""Score what the robot said about tables against the truth, by stated rules.

A detected thing is a true thing if most of its points are of that thing and the two share at least half of their points
(intersection over union). A true thing is named right if it was detected and has its name without a number; extra
things are not scored. A mistake is found if its kind and the true things that it is about are the same; one that is
reported otherwise counts as missed, and the report as false. All reported mistakes count. Where the robot names no
layout, it has found no mistake.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from deixis.experiments.apprentice.tables import Tampered, TrueMistake
from deixis.ontology.things.kinds import plain_name
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.explanation import MistakeKind
from deixis.robot.looking import Fault, Look
from deixis.workflows.scenes.simulate import Simulation

MIN_SHARED = 0.5
"""Minimum intersection over union of points at which a detected thing is a true thing."""


_Said = tuple[MistakeKind, frozenset[str]]
"""A mistake, and the names of the true things that it is about."""


@dataclass(frozen=True)
class Count:
    """Number of successes among a number of trials, with Wilson's interval of 95 %.

    Notes
    -----
    The interval is that of E. B. Wilson, "Probable inference, the law of succession, and statistical inference",
    Journal of the American Statistical Association 22, 1927.
    """

    right: int = 0
    of: int = 0

    def __add__(self, other: Count) -> Count:
        return Count(self.right + other.right, self.of + other.of)

    @property
    def share(self) -> float | None:
        """Share of successes; None without trials."""
        return self.right / self.of if self.of else None

    @property
    def interval(self) -> tuple[float, float] | None:
        """Wilson's interval of 95 % for the share; None without trials."""
        if not self.of:
            return None
        z, n, p = 1.96, self.of, self.right / self.of
        centre = (p + z * z / (2 * n)) / (1 + z * z / n)
        half = z / (1 + z * z / n) * float(np.sqrt(p * (1 - p) / n + z * z / (4 * n * n)))
        return max(0.0, centre - half), min(1.0, centre + half)


@dataclass(frozen=True)
class TableScore:
    """Counts of what was right on one table."""

    layout: Count
    names: Count
    recognised: Count  # by looks alone
    detected: Count
    found: Mapping[MistakeKind, Count]  # true mistakes that were found
    true_reports: Mapping[MistakeKind, Count]  # reports that are true
    questions: int = 0
    missed: tuple[TrueMistake, ...] = ()
    false: tuple[str, ...] = field(default=())


def true_things(look: Simulation, scene: Scene) -> dict[str, str]:
    """Return the true thing of each detected thing that is one.

    Parameters
    ----------
    look
        The simulated table with the truth.
    scene
        What was detected in its cloud; its detection has the labels of the points.

    Returns
    -------
    dict
        Name of the true thing by id of the detected one.
    """
    truth = look.cloud.labels
    assert truth is not None and scene.detection is not None
    found = scene.detection.labels
    names = [thing.name for thing in look.laid.table.things]
    matched: dict[str, str] = {}
    for thing in scene.objects:
        own = found == int(thing.id[1:]) - 1
        numbers = truth[own & (truth > 0)]
        if not len(numbers):
            continue
        best = int(np.bincount(numbers).argmax())
        shared = int((own & (truth == best)).sum())
        if shared >= MIN_SHARED * int((own | (truth == best)).sum()):
            matched[thing.id] = names[best - 1]
    return matched


def score(look: Look, table: Tampered, layout: str, things: Mapping[str, str], taught: Iterable[str]) -> TableScore:
    """Score what the robot says about a table.

    Parameters
    ----------
    look
        The table as the robot understood it.
    table
        The truth.
    layout
        Name of the true layout.
    things
        Name of the true thing by id of the detected one.
    taught
        Names of the categories that the robot was taught; other things are not scored by name.

    Returns
    -------
    TableScore
        Counts of what was right.
    """
    known, place = set(taught), {name: id for id, name in things.items()}
    wanted = [thing.name for thing in table.laid.table.things if thing.name not in table.extra]
    wanted = [name for name in wanted if plain_name(name) in known]
    named = recognised = 0
    for name in wanted:
        id = place.get(name)
        if id is not None:
            named += look.name(id) == plain_name(name)
            best = next(iter(look.scene[id].candidates), None)
            recognised += best is not None and best[0] == plain_name(name)
    truth = Counter((one.kind, frozenset(map(_bare(one), one.names))) for one in table.mistakes)
    reported = Counter(_as_truth(fault, things) for fault in look.faults())
    hits = truth & reported
    return TableScore(
        Count(int(look.layout == layout), 1),
        Count(named, len(wanted)),
        Count(recognised, len(wanted)),
        Count(len(set(wanted) & place.keys()), len(wanted)),
        _by_kind(hits, truth),
        _by_kind(hits, reported),
        missed=tuple(TrueMistake(kind, tuple(sorted(names))) for kind, names in (truth - reported).elements()),
        false=tuple(str(fault) for fault in look.faults() if _as_truth(fault, things) not in truth),
    )


def _bare(mistake: TrueMistake) -> Callable[[str], str]:
    """Return the function that names things in the truth: which of several equal things is missing does not matter."""
    return plain_name if mistake.kind is MistakeKind.MISSING else str


def _as_truth(fault: Fault, things: Mapping[str, str]) -> _Said:
    if fault.kind is MistakeKind.MISSING:
        return fault.kind, frozenset(map(plain_name, fault.names))
    return fault.kind, frozenset(things.get(id, f"not a thing: {id}") for id in fault.things)


def _by_kind(hits: Counter[_Said], among: Counter[_Said]) -> dict[MistakeKind, Count]:
    found: dict[MistakeKind, Count] = {}
    for kind in MistakeKind:
        right = sum(number for (one, _), number in hits.items() if one is kind)
        found[kind] = Count(right, sum(number for (one, _), number in among.items() if one is kind))
    return found


def total(counts: Iterable[Count]) -> Count:
    """Return the sum of counts.

    Parameters
    ----------
    counts
        The counts.

    Returns
    -------
    Count
        Sum of successes and of trials.
    """
    return sum(counts, Count())
