"""Check a table against a layout: find what is missing, misplaced or extra, and what cannot be determined.

Labels identify objects. An object whose label names a role, and which fits that role best, fills it. If only the layout
suggests which object fills a role, the role is *undetermined*, never correct. Two or three labelled objects have
changed places if all facts about them would hold with the objects exchanged, and more facts would hold of each. Of
another violated fact, the misplaced end is the one with the larger share of violated facts.

A claim (a place, a distance, an arrangement) is violated if what is measured is nearer to its opposite; see
:mod:`deixis.reasoning.grounding.answers.claims`.

A violated statement of direction (*the fork points away*) does not misplace its object: it is *turned*, and the check
says by how much it must be turned back.

All things that fit the noun of a group of unknown number (*the glasses*) are its members, and each is checked by itself
against what is said about the group. A group without any is missing.

An object in a role with a stated colour is *miscoloured* if its colour is clearly another one, misplaced or not.

The most probable grounding may give a role the only object that is left, whatever it is, since sizes exclude nothing.
An object that has no label for its role and is misplaced there does not fill the role if it is clearly higher, larger
or smaller than the role's kind: then the role is missing, and the object is extra.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.graph import RelationGraph, dispensable
from deixis.ontology.things.colours import Colour, Colours
from deixis.ontology.things.kinds import Kinds, with_article
from deixis.reasoning.comparison.turning import Turned, is_aim, turned_roles
from deixis.reasoning.grounding.answers.answer import FactOutcome, Grounding, Outcome
from deixis.reasoning.grounding.answers.claims import ClaimOutcome, outcomes_of_claims, violated
from deixis.reasoning.grounding.answers.members import assignment_of, broken_of_members
from deixis.reasoning.grounding.engines.engine import Engine
from deixis.reasoning.grounding.evidence.evidence import PRESENT_LOG_ODDS, Evidence
from deixis.reasoning.grounding.evidence.properties.colours import other_colours
from deixis.reasoning.grounding.evidence.properties.labels import Label, naming
from deixis.reasoning.grounding.evidence.properties.unary import OUTLIERS
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT
from deixis.spelling import nearest

SURE_CONFIDENCE = 0.9
"""Minimum confidence at which a label identifies its object."""

MAX_ROLES_ROTATED = 30
"""Number of labelled roles up to which rotations of three are searched for; with more roles, only swaps."""


class RoleVerdict(StrEnum):
    """The verdict on a role."""

    CORRECT = "correct"  # its label says that it is there, and others explain its violated facts
    MISPLACED = "misplaced"  # its object is there, but in the wrong place
    TURNED = "turned"  # its object is in the right place, but points in another direction than stated
    MISCOLOURED = "miscoloured"  # its object is in the right place, but has the wrong colour
    MISSING = "missing"  # no object fills it
    ABSENT = "absent"  # no object fills it, and no certain fact requires it
    UNDETERMINED = "undetermined"  # an object may fill it, but only the layout suggests it


@dataclass(frozen=True, slots=True)
class Miscoloured:
    """The described colour of a role, and the clearly different colour of its object."""

    described: Colour
    seen: Colour


@dataclass(frozen=True)
class RoleCheck:
    """A role, the object that fills it, the verdict, and the violated facts that explain it.

    ``in_place_of`` is the role in whose place the object stands, if two or three objects have changed places. A
    misplaced role may have a ``miscoloured`` and ``turned`` too.
    """

    role: str
    verdict: RoleVerdict
    perceived: str | None
    label: str | None
    confidence: float | None = None  # of the label
    broken: tuple[FactOutcome, ...] = ()
    in_place_of: str | None = None
    miscoloured: Miscoloured | None = None
    turned: tuple[Turned, ...] = ()


@dataclass(frozen=True, slots=True)
class Extra:
    """An object that fills no role of the layout, and the reason."""

    perceived: str
    label: str | None
    reason: str


@dataclass(frozen=True)
class TableCheck:
    """The check of a whole table against a layout."""

    roles: tuple[RoleCheck, ...]
    extra: tuple[Extra, ...]
    broken: tuple[FactOutcome, ...]  # unhedged facts that do not hold
    unexpected: tuple[FactOutcome, ...]  # hedged facts that do not hold, which are not faults
    grounding: Grounding
    claims: tuple[ClaimOutcome, ...] = ()
    surface: str | None = None  # the object that is the surface of the layout, which is not extra

    def __repr__(self) -> str:
        """Return the number of roles with each verdict, and of what is extra."""
        counts = {verdict.value: len(self.of(verdict)) for verdict in RoleVerdict} | {"extra": len(self.extra)}
        return f"<TableCheck {', '.join(f'{number} {name}' for name, number in counts.items() if number) or 'empty'}>"

    def of(self, verdict: RoleVerdict) -> tuple[RoleCheck, ...]:
        """Return the roles with a verdict.

        Parameters
        ----------
        verdict
            The verdict.

        Returns
        -------
        tuple of RoleCheck
            The roles, in the order of the layout.
        """
        return tuple(check for check in self.roles if check.verdict is verdict)

    @property
    def miscoloured(self) -> Iterator[tuple[RoleCheck, Miscoloured]]:
        """Roles whose objects have another colour than described, misplaced ones included."""
        return ((check, check.miscoloured) for check in self.roles if check.miscoloured)

    @property
    def turned(self) -> Iterator[RoleCheck]:
        """Roles whose objects point in another direction than stated, misplaced ones included."""
        return (check for check in self.roles if check.turned)

    @property
    def well(self) -> bool:
        """True if, as far as can be determined, nothing is missing, misplaced, turned, miscoloured or extra."""
        faults = (RoleVerdict.MISSING, RoleVerdict.MISPLACED, RoleVerdict.TURNED, RoleVerdict.MISCOLOURED)
        wrong = (self.of(verdict) for verdict in faults)
        return not (any(wrong) or self.extra or self.broken or any(violated(self.claims)))


def check_table(
    evidence: Evidence,
    labels: Mapping[str, Label | None],
    kinds: Kinds,
    grounding: Grounding,
    seen: NDArray[np.float64] | None = None,
    colours: Colours | None = None,
) -> TableCheck:
    """Turn a grounding of a layout in a scene into a verdict on every role and every object.

    Parameters
    ----------
    evidence
        The evidence of the grounding.
    labels
        The label of each object of the scene, or None.
    kinds
        The known kinds, which labels are compared by.
    grounding
        The grounding of the layout in the scene.
    seen
        Colours of the n2 objects in sRGB, shape (n2, 3), NaN where not known.
    colours
        The known colour terms.

    Returns
    -------
    TableCheck
        The verdicts, with the extra objects and the violated facts.
    """
    layout = evidence.description
    sure = sure_roles(layout, labels, kinds)
    members = _members(evidence, grounding)
    certain = [entry for entry in grounding.violated if entry.fact.weight >= 1]
    single = [entry for entry in certain if members.keys().isdisjoint({entry.fact.subject, entry.fact.object})]
    of_groups = dict.fromkeys(entry for things in members.values() for each in things.values() for entry in each)
    broken = (*single, *of_groups)
    exchanged = _exchanged_roles(evidence, grounding, sure)
    explained = [
        entry
        for entry in single
        if not exchanged.keys() & {entry.fact.subject, entry.fact.object} and not is_aim(entry.fact)
    ]
    misplaced = exchanged.keys() | _misplaced_ends(grounding, explained)
    spare = dispensable(layout.facts())
    otherwise = _miscoloured(evidence, grounding, seen, colours)
    checked = [claim for claim in evidence.claims if not _is_colour_of_role(claim, colours)]
    filled = {name: match.perceived for name, match in grounding.matches.items()}
    claims = outcomes_of_claims(evidence, checked, filled, members)
    scene = evidence.scene
    turned = turned_roles(broken, list(violated(claims)), scene.nodes, scene.boxes, scene.poses)
    roles = []
    for role in layout.nodes:
        match = grounding.matches.get(role)
        if match is None:
            roles.append(RoleCheck(role, RoleVerdict.ABSENT if role in spare else RoleVerdict.MISSING, None, None))
            continue
        if role in members:
            roles += _member_roles(role, members[role], labels, sure, turned)
            continue
        label = labels[match.perceived]
        verdict = RoleVerdict.CORRECT if role in sure[match.perceived] else RoleVerdict.UNDETERMINED
        verdict = RoleVerdict.MISCOLOURED if role in otherwise else verdict
        verdict = RoleVerdict.TURNED if (role, match.perceived) in turned else verdict
        about = tuple(entry for entry in broken if role in (entry.fact.subject, entry.fact.object))
        roles.append(
            RoleCheck(
                role=role,
                verdict=RoleVerdict.MISPLACED if role in misplaced else verdict,
                perceived=match.perceived,
                label=label.text if label else None,
                confidence=label.confidence if label else None,
                broken=about,
                in_place_of=exchanged.get(role),
                miscoloured=otherwise.get(role),
                turned=turned.get((role, match.perceived), ()),
            )
        )
    unexpected = tuple(entry for entry in grounding.violated if entry.fact.weight < 1)
    others = {thing: label for thing, label in labels.items() if thing != evidence.surface}
    extra = _extra(others, grounding, sure, frozenset().union(*members.values()))
    return TableCheck(tuple(roles), extra, broken, unexpected, grounding, claims, evidence.surface)


Members = Mapping[str, tuple[FactOutcome, ...]]
"""Facts that are violated by each member of a group, by the name of its thing."""


def _members(evidence: Evidence, grounding: Grounding) -> dict[str, Members]:
    """Return the members of each group of unknown number, with the facts that they violate."""
    layout, scene, assignment = evidence.description, evidence.scene, assignment_of(grounding, evidence)
    return {
        role: {
            scene.nodes[thing]: broken
            for thing, broken in broken_of_members(evidence, assignment, layout.index(role)).items()
        }
        for role in evidence.uncounted
        if role in grounding.matches
    }


def _member_roles(
    role: str,
    members: Members,
    labels: Mapping[str, Label | None],
    sure: Mapping[str, frozenset[str]],
    turned: Mapping[tuple[str, str], tuple[Turned, ...]],
) -> Iterator[RoleCheck]:
    """Yield the verdict on each member of a group."""
    for thing, broken in members.items():
        label = labels[thing]
        verdict = RoleVerdict.CORRECT if role in sure[thing] else RoleVerdict.UNDETERMINED
        verdict = RoleVerdict.TURNED if (role, thing) in turned else verdict
        verdict = RoleVerdict.MISPLACED if any(not is_aim(entry.fact) for entry in broken) else verdict
        text, confidence = (label.text, label.confidence) if label else (None, None)
        yield RoleCheck(role, verdict, thing, text, confidence, broken, turned=turned.get((role, thing), ()))


def _is_colour_of_role(claim: Claim, colours: Colours | None) -> bool:
    """Return True for a claim of a known colour, which is checked as the colour of its role."""
    if claim.relation != "colour" or colours is None or not claim.positive:
        return False
    return colours.of_word(claim.value or "") is not None


def _miscoloured(
    evidence: Evidence, grounding: Grounding, seen: NDArray[np.float64] | None, colours: Colours | None
) -> dict[str, Miscoloured]:
    """Return the roles whose objects clearly have another colour than described."""
    layout = evidence.description
    if seen is None or colours is None or not layout.colours:
        return {}
    described = [layout.colours[layout.index(role)] for role in grounding.matches]
    things = [evidence.scene.index(match.perceived) for match in grounding.matches.values()]
    others = other_colours(described, seen[things], colours)
    return {
        role: Miscoloured(colours[iri], other)
        for role, iri, other in zip(grounding.matches, described, others, strict=True)
        if iri is not None and other is not None
    }


def _exchanged_roles(evidence: Evidence, grounding: Grounding, sure: Mapping[str, frozenset[str]]) -> dict[str, str]:
    """Return labelled roles that have changed places, each with the role in whose place its object stands.

    Among all changes of two or three roles that repair the most violated facts, leave no fact about them violated and
    make more hold of each, the smallest comes first; then the next one among the other roles.
    """
    layout, scene = evidence.description, evidence.scene
    assignment = assignment_of(grounding, evidence)
    known = [i for i, p in enumerate(assignment) if p != UNMATCHED and layout.nodes[i] in sure[scene.nodes[p]]]
    found: dict[str, str] = {}
    while True:
        left = [i for i in known if layout.nodes[i] not in found]
        change = _best_change(evidence, assignment, left)
        if change is None:
            return found
        roles, places = change
        found |= {layout.nodes[i]: layout.nodes[j] for i, j in zip(roles, places, strict=True)}
        assignment[list(places)] = assignment[list(roles)]


def _best_change(
    evidence: Evidence, assignment: NDArray[np.int64], known: list[int]
) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
    """Return roles, and the roles in whose places their objects stand; None if no change explains the violations."""
    firm = evidence.firm()
    now = evidence.degrees(assignment)
    broken = set(_ends(evidence, firm & (now <= 0), assignment).tolist())
    best: tuple[int, int, float] | None = None
    change = None
    for roles, places in _changes(known, broken):
        other = assignment.copy()
        other[list(places)] = assignment[list(roles)]
        then = evidence.degrees(other)
        mended = int((firm & (now <= 0)).sum() - (firm & (then <= 0)).sum())
        key = (mended, -len(roles), float(then.sum() - now.sum()))
        if mended > 0 and (best is None or key > best) and _explains_faults(evidence, roles, firm, now, then, other):
            best, change = key, (roles, places)
    return change


def _changes(known: list[int], broken: set[int]) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Yield swaps and rotations of three among known roles, at least one of them in a violated fact."""
    sizes = (2, 3) if len(known) <= MAX_ROLES_ROTATED else (2,)
    for roles in (roles for size in sizes for roles in combinations(known, size)):
        if broken & set(roles):
            yield roles, (*roles[1:], roles[0])
            if len(roles) == 3:
                yield roles, (roles[2], *roles[:2])


def _explains_faults(
    evidence: Evidence,
    roles: tuple[int, ...],
    firm: NDArray[np.bool_],
    now: NDArray[np.float64],
    then: NDArray[np.float64],
    other: NDArray[np.int64],
) -> bool:
    """Return whether, after the change, no unhedged fact about these roles is violated and more hold of each role."""
    if set(roles) & set(_ends(evidence, firm & (then <= 0), other).tolist()):
        return False
    edges = evidence.facts
    subjects, objects = evidence.description.subjects[edges], evidence.description.objects[edges]
    gained = np.where(firm, then - now, 0.0)
    return all(gained[(subjects == i) | (objects == i)].sum() > 0 for i in roles)


def _ends(evidence: Evidence, chosen: NDArray[np.bool_], assignment: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the objects of the chosen facts, for facts whose two ends are both matched."""
    edges = evidence.facts[chosen]
    subjects, objects = evidence.description.subjects[edges], evidence.description.objects[edges]
    both = (assignment[subjects] != UNMATCHED) & (assignment[objects] != UNMATCHED)
    return np.concatenate([subjects[both], objects[both]]).astype(np.int64)


def sure_roles(layout: RelationGraph, labels: Mapping[str, Label | None], kinds: Kinds) -> dict[str, frozenset[str]]:
    """Return the roles that each object fills by a confident label: those that fit, or the one that it names.

    Parameters
    ----------
    layout
        The relation graph of the layout.
    labels
        Label of each object of the scene, or None.
    kinds
        The known kinds, which labels are compared by.

    Returns
    -------
    dict
        Roles by the id of the object; objects without a confident label are left out.
    """
    known = naming(layout, list(labels.values()), kinds)
    roles = {}
    for column, (thing, label) in enumerate(labels.items()):
        named, fitted = (np.flatnonzero(which[:, column]) for which in (known.named, known.fitted))
        chosen = fitted if len(fitted) else named[: len(named) == 1]
        sure = label is not None and label.confidence >= SURE_CONFIDENCE
        roles[thing] = frozenset(layout.nodes[i] for i in chosen if sure)
    return roles


def _misplaced_ends(grounding: Grounding, broken: Sequence[FactOutcome]) -> frozenset[str]:
    """Return few ends that explain all violated facts, found greedily: the end with the worst share first.

    The share of an end is the number of its violated facts divided by the number of its comparable facts. On a tie it
    is the subject, which the script places relative to the object.
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


def _extra(
    labels: Mapping[str, Label | None],
    grounding: Grounding,
    sure: Mapping[str, frozenset[str]],
    members: frozenset[str],
) -> tuple[Extra, ...]:
    taken = {match.perceived for match in grounding.matches.values()} | members
    found = []
    for thing, label in labels.items():
        if thing in taken:
            continue
        if label is None and grounding.unmatched_objects:
            reason = "it fits none of the unfilled roles of the layout"
        elif label is None:
            reason = "the scene has more objects than the layout has roles"
        elif sure[thing]:
            reason = f"one {label.text} too many"
        else:
            reason = f"the layout has no unfilled role for {with_article(label.text)}"
            near = nearest(label.text, [left.name.replace("_", " ") for left in grounding.unmatched_objects])
            if near is not None and near != label.text:
                reason += f"; did you mean '{near}'?"
        found.append(Extra(thing, label.text if label else None, reason))
    return tuple(found)


MIN_SIZE_LOG_RATIO = float(np.log(OUTLIERS / SURE_CONFIDENCE))
"""Log-likelihood ratio of a size below which the object is not of the role's kind, with ``SURE_CONFIDENCE``."""

RULED_OUT_LOG_RATIO = 2 * PRESENT_LOG_ODDS
"""Log-likelihood ratio given to an excluded match, so low that no facts outweigh it."""


def checked_table(
    evidence: Evidence,
    labels: Mapping[str, Label | None],
    kinds: Kinds,
    engine: Engine,
    time_limit: float = DEFAULT_TIME_LIMIT,
    seen: NDArray[np.float64] | None = None,
    colours: Colours | None = None,
) -> TableCheck:
    """Ground a layout and check the table, repeatedly as long as an object is found that cannot fill its role.

    Parameters
    ----------
    evidence
        The evidence for grounding the layout in the scene.
    labels
        The label of each object of the scene, or None.
    kinds
        The known kinds, which labels are compared by.
    engine
        The grounding engine.
    time_limit
        Time limit in seconds.
    seen
        Colours of the n2 objects in sRGB, shape (n2, 3), NaN where not known.
    colours
        The known colour terms.

    Returns
    -------
    TableCheck
        The verdicts of the last grounding.
    """
    deadline = Deadline.after(time_limit)
    sure = sure_roles(evidence.description, labels, kinds)
    while True:
        found = ground(evidence, engine, deadline)
        table = check_table(evidence, labels, kinds, found, seen, colours)
        sizes = evidence.sizes.copy()
        for check in table.of(RoleVerdict.MISPLACED):
            if check.perceived is None or check.role in sure[check.perceived]:
                continue
            place = evidence.description.index(check.role), evidence.scene.index(check.perceived)
            if evidence.labels[place] <= 0 and evidence.sizes[place] < MIN_SIZE_LOG_RATIO:
                sizes[place] = RULED_OUT_LOG_RATIO
        rest = None if np.array_equal(sizes, evidence.sizes) else replace(evidence, sizes=sizes)
        if rest is None or deadline.passed:
            return table
        evidence = rest
