"""Is a table laid as it should be? What is missing, misplaced and extra, and what cannot be told.

Identity comes from labels. A thing whose label names a role, and which fits there best, is that role's; where nothing
but the layout says who is who, its place is *undetermined*, never correct. Two labelled things are *exchanged* where
all that is said of both would hold if each stood in the place of the other. Which end of another broken fact is
misplaced is settled by how much else is broken about it: the ends with the largest share explain the others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.reasoning.evidence import UNMATCHED, Evidence
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
    """A role, the thing that fills it, the verdict, and the broken facts that explain it.

    ``exchanged_with`` is the role whose thing stands in its place, where the two were swapped.
    """

    role: str
    verdict: Verdict
    perceived: str | None
    label: str | None
    broken: tuple[FactOutcome, ...] = ()
    exchanged_with: str | None = None


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
    evidence: Evidence, labels: Mapping[str, Label | None], kinds: Kinds, grounding: Grounding
) -> TableCheck:
    """Reads a grounding of a layout in a scene as a verdict on every role and every thing.

    ``evidence`` is what was grounded; ``labels`` has one entry for each thing of its scene.
    """
    layout = evidence.description
    sure = {thing: _sure_roles(layout, label, kinds) for thing, label in labels.items()}
    broken = tuple(entry for entry in grounding.violated if entry.fact.weight >= 1)
    exchanged = _exchanged(evidence, grounding, sure)
    explained = [entry for entry in broken if not exchanged.keys() & {entry.fact.subject, entry.fact.object}]
    misplaced = exchanged.keys() | _blamed(grounding, explained)
    optional = _optional_roles(layout)
    roles = []
    for role in layout.nodes:
        match = grounding.matches.get(role)
        if match is None:
            roles.append(RoleCheck(role, Verdict.ABSENT if role in optional else Verdict.MISSING, None, None))
            continue
        label = labels[match.perceived]
        verdict = Verdict.CORRECT if role in sure[match.perceived] else Verdict.UNDETERMINED
        about = tuple(entry for entry in broken if role in (entry.fact.subject, entry.fact.object))
        roles.append(
            RoleCheck(
                role=role,
                verdict=Verdict.MISPLACED if role in misplaced else verdict,
                perceived=match.perceived,
                label=label.text if label else None,
                broken=about,
                exchanged_with=exchanged.get(role),
            )
        )
    return TableCheck(tuple(roles), _extra(labels, grounding, sure), broken, grounding)


def _exchanged(evidence: Evidence, grounding: Grounding, sure: Mapping[str, frozenset[str]]) -> dict[str, str]:
    """Pairs of labelled roles, both ways, that all broken facts about them show to stand in each other's place.

    The exchange that mends most is taken first, then the next among the others.
    """
    layout, scene = evidence.description, evidence.scene
    assignment = np.full(len(layout.nodes), UNMATCHED, dtype=np.int64)
    for role, match in grounding.matches.items():
        assignment[layout.index(role)] = scene.index(match.perceived)
    known = [i for i, p in enumerate(assignment) if p != UNMATCHED and layout.nodes[i] in sure[scene.nodes[p]]]
    firm = evidence.firm()
    found: dict[str, str] = {}
    while True:
        now = evidence.degrees(assignment)
        broken = set(_ends(evidence, firm & (now <= 0), assignment).tolist())
        best: tuple[int, float, int, int] | None = None
        for i, j in combinations(known, 2):
            if not {i, j} & broken or {layout.nodes[i], layout.nodes[j]} & found.keys():
                continue
            other = assignment.copy()
            other[[i, j]] = other[[j, i]]
            then = evidence.degrees(other)
            mended = int((firm & (now <= 0)).sum() - (firm & (then <= 0)).sum())
            spoilt = {i, j} & set(_ends(evidence, firm & (then <= 0), other).tolist())
            gain = float(then.sum() - now.sum())
            if mended > 0 and not spoilt and (best is None or (mended, gain) > best[:2]):
                best = mended, gain, i, j
        if best is None:
            return found
        i, j = best[2:]
        assignment[[i, j]] = assignment[[j, i]]
        found |= {layout.nodes[i]: layout.nodes[j], layout.nodes[j]: layout.nodes[i]}


def _ends(evidence: Evidence, chosen: NDArray[np.bool_], assignment: NDArray[np.int64]) -> NDArray[np.int64]:
    """The objects of the chosen facts, of those both of whose ends are matched."""
    edges = evidence.facts[chosen]
    subjects, objects = evidence.description.subjects[edges], evidence.description.objects[edges]
    both = (assignment[subjects] != UNMATCHED) & (assignment[objects] != UNMATCHED)
    return np.concatenate([subjects[both], objects[both]]).astype(np.int64)


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
