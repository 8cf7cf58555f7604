"""Is a table laid as it should be? What is missing, misplaced and extra, and what cannot be told.

Identity comes from labels. A thing whose label names a role, and which fits there best, is that role's; where nothing
but the layout says who is who, its place is *undetermined*, never correct. Which end of a broken fact is misplaced is
settled by how much else is broken about it: the ends with the largest share of broken facts explain the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.reasoning.grounding import FactOutcome, Grounding, Outcome
from deixis.reasoning.labels import Label, named_objects

SURE = 0.9
"""Confidence from which a label counts as an identity."""


class Verdict(StrEnum):
    """What became of a role."""

    CORRECT = "correct"  # its label says that it is there, and nothing said of it is broken
    MISPLACED = "misplaced"  # it is there, and not where it belongs
    MISSING = "missing"  # nothing fills it
    ABSENT = "absent"  # nothing fills it, and it is optional
    UNDETERMINED = "undetermined"  # something may fill it, but only the layout says so


@dataclass(frozen=True)
class RoleCheck:
    """A role, the thing that fills it, the verdict, and the broken facts that explain it."""

    role: str
    verdict: Verdict
    perceived: str | None
    label: str | None
    broken: tuple[FactOutcome, ...] = ()


@dataclass(frozen=True, slots=True)
class Extra:
    """A thing that has no place in the layout."""

    perceived: str
    label: str | None
    reason: str


@dataclass(frozen=True)
class TableCheck:
    """A whole table against a layout."""

    roles: tuple[RoleCheck, ...]
    extra: tuple[Extra, ...]
    broken: tuple[FactOutcome, ...]
    grounding: Grounding

    def of(self, verdict: Verdict) -> tuple[RoleCheck, ...]:
        return tuple(check for check in self.roles if check.verdict is verdict)

    @property
    def well(self) -> bool:
        """Nothing is missing, misplaced or extra, as far as can be told."""
        return not (self.of(Verdict.MISSING) or self.of(Verdict.MISPLACED) or self.extra or self.broken)


def check_table(
    layout: RelationGraph, labels: dict[str, Label | None], kinds: Kinds, grounding: Grounding
) -> TableCheck:
    """Reads a grounding of the layout in a scene as a verdict on every role and every thing.

    ``labels`` has one entry for each thing of the scene, in its order.
    """
    broken = tuple(entry for entry in grounding.violated if entry.fact.weight >= 1)
    blamed = _blamed(grounding, broken)
    optional = _optional_roles(layout)
    sure = {thing: _sure_roles(layout, label, kinds) for thing, label in labels.items()}
    roles = []
    for role in layout.nodes:
        match = grounding.matches.get(role)
        if match is None:
            roles.append(RoleCheck(role, Verdict.ABSENT if role in optional else Verdict.MISSING, None, None))
            continue
        label = labels[match.perceived]
        about = tuple(entry for entry in broken if role in (entry.fact.subject, entry.fact.object))
        if role in blamed:
            verdict = Verdict.MISPLACED
        elif role in sure[match.perceived]:
            verdict = Verdict.CORRECT
        else:
            verdict = Verdict.UNDETERMINED
        roles.append(RoleCheck(role, verdict, match.perceived, label.text if label else None, about))
    return TableCheck(tuple(roles), _extra(labels, grounding, sure), broken, grounding)


def _sure_roles(layout: RelationGraph, label: Label | None, kinds: Kinds) -> frozenset[str]:
    """The roles that a label says its thing fills: one, or several that the label cannot tell apart."""
    if label is None or label.confidence < SURE:
        return frozenset()
    named = np.flatnonzero(named_objects(layout, label.text, kinds))
    return frozenset(layout.nodes[i] for i in named) if len(named) == 1 else frozenset()


def _optional_roles(layout: RelationGraph) -> frozenset[str]:
    """Roles of which everything that is said is optional."""
    firm: set[str] = set()
    optional: set[str] = set()
    for fact in layout.facts():
        (optional if fact.optional else firm).update((fact.subject, fact.object))
    return frozenset(optional - firm)


def _blamed(grounding: Grounding, broken: Sequence[FactOutcome]) -> frozenset[str]:
    """The fewest ends that explain all broken facts, as far as greed finds them: the worst share first.

    A share is an end's broken facts over all that could be compared. Of two ends as bad it is the subject, which is
    what the script places with respect to the object.
    """
    compared: dict[str, int] = {}
    for entry in grounding.outcomes:
        if entry.outcome in (Outcome.SATISFIED, Outcome.VIOLATED):
            for name in (entry.fact.subject, entry.fact.object):
                compared[name] = compared.get(name, 0) + 1
    blamed: set[str] = set()
    left = list(broken)
    while left:
        count: dict[str, int] = {}
        for entry in left:
            for name in (entry.fact.subject, entry.fact.object):
                count[name] = count.get(name, 0) + 1
        subjects = {entry.fact.subject for entry in left}
        worst = max(count, key=lambda name: (count[name] / compared[name], count[name], name in subjects, name))
        blamed.add(worst)
        left = [entry for entry in left if worst not in (entry.fact.subject, entry.fact.object)]
    return frozenset(blamed)


def _extra(labels: dict[str, Label | None], grounding: Grounding, sure: dict[str, frozenset[str]]) -> tuple[Extra, ...]:
    taken = {match.perceived for match in grounding.matches.values()}
    found = []
    for thing, label in labels.items():
        if thing in taken:
            continue
        if label is None:
            reason = "there are more things than the layout has places"
        elif sure[thing]:
            reason = f"one {label.text} too many"
        else:
            reason = f"the layout has no place left for a {label.text}"
        found.append(Extra(thing, label.text if label else None, reason))
    return tuple(found)
