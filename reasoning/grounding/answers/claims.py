"""Check claims: whether each holds of the things in its roles, and what was measured.

The degree of a claim is that of grounding (:mod:`deixis.reasoning.grounding.evidence.claims.claims`): 1 at the
prototype, one half at the border. A claim holds above one half, so that the second tallest of several is not the
tallest, and a denied claim holds otherwise. What boxes do not show (contents, materials, what is not among the objects)
is undecidable. Directions are decided for things whose front, head or handle is known, and for long things that lie
across them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.claims import EACH_OTHER, PLACES, ROW_ORDERS, SUPERLATIVES, Claim
from deixis.ontology.models.relations import RelationModels
from deixis.ontology.relations.relation import Relations
from deixis.reasoning.geometry.poses import MIN_STRETCH, Poses, bearings
from deixis.reasoning.grounding.evidence.claims.aims import (
    AIMING,
    degree_of_angle,
    is_of_handle,
    stated_direction,
)
from deixis.reasoning.grounding.evidence.claims.claims import (
    MAX_THINGS,
    MEASURES,
    ClaimDegrees,
    distance_degree,
)
from deixis.reasoning.grounding.evidence.claims.places import (
    TOWARDS,
    lean_in_things,
    lean_on_surface,
    place_degree,
)
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.words.meaning import BORDER, EXTREME, shipped_models

HOLDS_ABOVE = 0.5 + 1e-9
"""Degree above which a claim holds."""

OFF_LINE = ((0.06, 0.15, 0.5), (0.0, BORDER, EXTREME))
"""Log degree of a row by the largest distance from its line, as a share of its length."""

UNEVEN = ((0.15, 0.3, 0.6), (0.0, BORDER, EXTREME))
"""Log degree of a circle by the spread of the distances from its middle, as a share of their mean."""


class ClaimVerdict(StrEnum):
    """Verdict on a claim."""

    SATISFIED = "satisfied"
    VIOLATED = "violated"
    WAIVED = "waived"  # it does not hold, but it was optional
    OPEN = "open"  # one of its objects is not matched
    UNDECIDABLE = "undecidable"  # the boxes do not show whether it holds


@dataclass(frozen=True, slots=True)
class ClaimOutcome:
    """A claim, the verdict on it, and what was measured, or the reason why it cannot be decided.

    ``degree`` in [0, 1] is the degree to which it holds; None where it was not measured. ``perceived`` are the things
    in the roles of its subjects and arguments.
    """

    claim: Claim
    verdict: ClaimVerdict
    degree: float | None
    perceived: tuple[str, ...]
    measured: str

    def __str__(self) -> str:
        return f"{self.claim}: {self.measured}" if self.measured else str(self.claim)


def check_claims(
    claims: Sequence[Claim],
    filled: Mapping[str, str],
    things: Sequence[str],
    boxes: NDArray[np.float64] | None,
    vocabulary: Relations,
    models: RelationModels,
    metric: bool = True,
    surface: str | None = None,
    poses: Poses | None = None,
) -> tuple[ClaimOutcome, ...]:
    """Return the outcome of each claim.

    Parameters
    ----------
    claims
        The claims of a layout.
    filled
        Names of the things in the roles.
    things
        Names of the n things of the scene.
    boxes
        Their boxes, shape (n, 2, d), d is 2 or 3; None where the scene has none.
    vocabulary, models
        Relation words and their models, for claims that are made of relations.
    metric
        Whether the boxes are in metres.
    surface
        Name of the thing that is the surface of the layout; None if it is not among the things.
    poses
        Fronts, heads and long axes of the n things; None where they are unknown.

    Returns
    -------
    Outcomes in the order of the claims.
    """
    place = {name: i for i, name in enumerate(things)}
    measures = None
    if boxes is not None and 1 <= len(boxes) <= MAX_THINGS:
        role = {thing: name for name, thing in filled.items()}
        called = [role.get(thing, thing) for thing in things]
        on = None if surface is None else place[surface]
        measures = _Measures(np.asarray(boxes, dtype=np.float64), called, vocabulary, models, metric, on, poses)
    outcomes = []
    for claim in claims:
        names = (*claim.subjects, *claim.arguments)
        perceived = tuple(filled[name] for name in names if name in filled)
        if len(perceived) < len(names):
            lacking = ", ".join(name for name in names if name not in filled)
            outcomes.append(ClaimOutcome(claim, ClaimVerdict.OPEN, None, perceived, f"not found: {lacking}"))
            continue
        if measures is None:
            why = "the scene has no boxes" if boxes is None else f"the scene has more than {MAX_THINGS} things"
            outcomes.append(ClaimOutcome(claim, ClaimVerdict.UNDECIDABLE, None, perceived, why))
            continue
        at = [place[thing] for thing in perceived]
        degree, measured = measures.of(claim, at[: len(claim.subjects)], at[len(claim.subjects) :])
        verdict = ClaimVerdict.UNDECIDABLE
        if degree is not None:
            holds = (degree > HOLDS_ABOVE) == claim.positive
            missed = ClaimVerdict.WAIVED if claim.optional else ClaimVerdict.VIOLATED
            verdict = ClaimVerdict.SATISFIED if holds else missed
            degree = degree if claim.positive else 1 - degree
        outcomes.append(ClaimOutcome(claim, verdict, degree, perceived, measured))
    return tuple(outcomes)


Measured = tuple[float | None, str]
"""Degree of a claim and what was measured; None and the reason where it cannot be decided."""


class _Measures:
    """Measures of claims in one scene."""

    def __init__(
        self,
        boxes: NDArray[np.float64],
        things: Sequence[str],
        vocabulary: Relations,
        models: RelationModels,
        metric: bool,
        surface: int | None,
        poses: Poses | None,
    ) -> None:
        self.boxes, self.things, self.vocabulary, self.metric = boxes, things, vocabulary, metric
        self.poses = poses
        self.degrees = ClaimDegrees(boxes, vocabulary, models, metric, surface, poses)
        self.on_surface = [i for i in range(len(boxes)) if i != surface]

    def of(self, claim: Claim, subjects: list[int], arguments: list[int]) -> Measured:
        """Return the degree of a claim about these things, the least of its subjects, and what was measured."""
        term = claim.relation
        if term == "count":
            return 1.0, f"{len(subjects)} found"
        if term == "row":
            return self._row(claim.value, subjects)
        if term == "circle":
            return self._circle(subjects)
        if term in EACH_OTHER:
            return self._each_other(EACH_OTHER[term], subjects)
        if term in ("nested", "stacked") and not arguments:
            return self._piled(term, subjects)
        if term.startswith("none_"):
            return self._none(term.removeprefix("none_"), subjects)
        measured = [self._one(claim, subject, arguments) for subject in subjects]
        return min(measured, key=lambda one: 2.0 if one[0] is None else one[0])

    def _one(self, claim: Claim, subject: int, others: list[int]) -> Measured:
        term, value = claim.relation, claim.value
        if term in PLACES:
            return self._place(claim, subject, others)
        if term in ("between", "among") and others:
            return self._between(term, subject, others)
        if term in ("nearest", "farthest") and others:
            return self._nearest(term, subject, others)
        if term in ("closer", "farther") and value is None and len(others) > 1:
            return self._closer(term, subject, others)
        if term.startswith("distance") and claim.metres is not None and others:
            return self._distance(claim, subject, others)
        if term in SUPERLATIVES:
            return self._superlative(term, value, subject, others)
        if term == "ordinal" and value is not None:
            return self._ordinal(value, subject, others)
        if term in ("closer", "farther") and value is not None and others:
            table = self.degrees.pair_degrees(claim)
            if table is None:
                return None, f"'{value}' is not a place"
            return float(min(table[subject, other] for other in others)), self._where(subject)
        if term in ("on", "in_front", "parallel") and not others:
            degree = self.degrees.degrees_alone(claim)
            if degree is not None:
                extents = (self.boxes[subject, 1] - self.boxes[subject, 0])[:2]
                shown = {
                    "on": self._stands(subject),
                    "parallel": f"it extends {' by '.join(map(self._length, extents))}",
                }
                return float(degree[subject]), shown.get(term, self._where(subject))
        if term == "empty":
            return self._none("inside", [subject])
        if term in AIMING and (others or value is not None):
            return self._aimed(claim, subject, others)
        return None, _undecidable(claim)

    def _aimed(self, claim: Claim, subject: int, others: list[int]) -> Measured:
        """Measure the angle between a thing's direction and a stated one, by its long axis if its end is unknown."""
        if self.poses is None:
            return None, "boxes have no direction"
        aims: list[tuple[NDArray[np.float64] | None, str | None]] = [(stated_direction(claim.value), claim.value)]
        if others:
            ways = bearings(self.boxes[[subject]], self.boxes[others])[0]
            aims = [(way, self.things[other]) for way, other in zip(ways, others, strict=True)]
        measured: list[Measured] = []
        for wanted, goal in aims:
            if wanted is None or np.isnan(wanted).any():
                return None, "boxes have no direction"
            measured.append(self._aimed_at(claim, subject, wanted, goal))
        return min(measured, key=lambda one: 2.0 if one[0] is None else one[0])

    def _aimed_at(self, claim: Claim, subject: int, wanted: NDArray[np.float64], goal: str | None) -> Measured:
        assert self.poses is not None
        facing, handle = claim.relation == "facing", is_of_handle(claim.value)
        where = f"'{goal}'"
        angle = float(self.poses.aim_angles(wanted, facing, handle)[subject])
        if not np.isnan(angle):
            what = "its handle" if handle else "it"
            return float(degree_of_angle(np.array(angle))), f"{what} points {np.degrees(angle):.0f}° away from {where}"
        known = not np.isnan(self.poses.pointing[subject]).any()
        if known:
            return None, "which of its sides is its front is not known"
        if facing or self.poses.stretch[subject] < MIN_STRETCH:
            return None, "its direction is not known"
        across = float(np.arccos(min(abs(float(self.poses.axes[subject] @ wanted)), 1.0)))
        if across < np.pi / 4:
            return None, "which of its ends points there is not known"
        return float(degree_of_angle(np.array(across))), f"it lies {np.degrees(across):.0f}° across {where}"

    def _stands(self, subject: int) -> str:
        low, surface = self.boxes[:, 0, -1], self.degrees.surface
        if surface is None:
            return f"its underside is {self._length(low[subject] - low.min())} above the lowest"
        if not self.degrees.over_surface[subject]:
            return f"it is not above {self.things[surface]}"
        above = max(float(low[subject] - self.boxes[surface, 1, -1]), 0.0)
        return f"its underside is {self._length(above)} above the top of {self.things[surface]}"

    def _length(self, length: float) -> str:
        return f"{round(100 * length, 2):g} cm" if self.metric else f"{round(length, 4):g}"

    def _where(self, subject: int) -> str:
        x, y = lean_on_surface(self.boxes, self.degrees.surface)[subject]
        return f"{x:.0%} of the free width is left of it, and {y:.0%} of the free depth is nearer than it"

    def _place(self, claim: Claim, subject: int, others: list[int]) -> Measured:
        if not others:
            degree = self.degrees.degrees_alone(claim)
            known = None if degree is None else float(degree[subject])
            return known, self._where(subject) if known is not None else f"{claim.value!r} is not a side"
        table = self.degrees.pair_degrees(claim)
        if table is None:
            return None, f"{claim.value!r} is not a side"
        worst = min(others, key=lambda other: float(table[subject, other]))
        x, y = lean_in_things(self.boxes)[subject, worst]
        shown = f"on {self.things[worst]}, it is {x:.0%} of the way from left to right and {y:.0%} from near to far"
        gap = float(self.degrees.gaps[subject, worst])
        if gap > 0:
            shown = f"it is {self._length(gap)} away from {self.things[worst]}"
        return float(table[subject, worst]), shown

    def _between(self, term: str, subject: int, others: list[int]) -> Measured:
        if term == "among":
            low, high = self.boxes[others, 0, :2].min(axis=0), self.boxes[others, 1, :2].max(axis=0)
            off = np.maximum(np.maximum(low - self.degrees.centres[subject], self.degrees.centres[subject] - high), 0)
            unit = max(float((high - low).mean()), 1e-9)
            far = float(np.hypot(*off))
            degree = float(np.exp(np.interp(far / unit, (0.0, 0.2, 0.6), (0.0, BORDER, EXTREME))))
            return degree, "it is in their midst" if far == 0 else f"it is {self._length(far)} outside of them"
        table = self.degrees.triple_degrees("between")
        a, b = max(combinations(others, 2), key=lambda ends: float(table[subject, ends[0], ends[1]]))
        centres = self.degrees.centres
        way, off = centres[b] - centres[a], centres[subject] - centres[a]
        length = max(float(np.hypot(*way)), 1e-9)
        along = float(off @ way) / length**2
        across = abs(float(off[0] * way[1] - off[1] * way[0])) / length
        first, second = self.things[a], self.things[b]
        shown = (
            f"it is {along:.0%} of the way from {first} to {second}, {self._length(across)} off the line between them"
        )
        return float(table[subject, a, b]), shown

    def _nearest(self, term: str, subject: int, others: list[int]) -> Measured:
        distances = self.degrees.distances
        worst: Measured = (1.0, "")
        for other in others:
            rest = [i for i in self.on_surface if i not in (subject, other)]
            own = float(distances[subject, other])
            shown = f"it is {self._length(own)} from {self.things[other]}"
            sign = 1 if term == "nearest" else -1
            rival = min(rest, key=lambda i: sign * distances[i, other], default=None)
            rival_is_nearer = rival is not None and sign * (own - distances[rival, other]) > 1e-9
            if rival_is_nearer:
                assert rival is not None
                shown += f", {self.things[rival]} is {self._length(float(distances[rival, other]))} from it"
            if rival_is_nearer or not worst[1]:
                worst = (0.0 if rival_is_nearer else worst[0], shown)
        return worst

    def _closer(self, term: str, subject: int, others: list[int]) -> Measured:
        to, *rest = others
        own = float(self.degrees.distances[subject, to])
        sign = 1 if term == "closer" else -1
        rivals = {other: float(self.degrees.distances[other, to]) for other in rest}
        name, best = min(rivals.items(), key=lambda one: sign * one[1])
        shown = f"it is {self._length(own)} from {self.things[to]}, {self.things[name]} is {self._length(best)} from it"
        return float(sign * (best - own) > 1e-9), shown

    def _distance(self, claim: Claim, subject: int, others: list[int]) -> Measured:
        if not self.metric:
            return None, "the scene is not in metres"
        assert claim.metres is not None
        # from edge to edge or from centre to centre, whichever fits
        known = (self.degrees.gaps, self.degrees.distances)
        table = np.maximum(*(distance_degree(claim.relation, lengths, claim.metres) for lengths in known))
        worst = min(others, key=lambda other: float(table[subject, other]))
        gap, centres = (float(lengths[subject, worst]) for lengths in known)
        bound = {"distance": "about", "distance_less": "at most", "distance_more": "at least"}[claim.relation]
        shown = f"it is {self._length(gap)} from {self.things[worst]} ({self._length(centres)} between the centres)"
        return float(table[subject, worst]), f"{shown}, {bound} {self._length(claim.metres)} was stated"

    def _superlative(self, term: str, value: str | None, subject: int, others: list[int]) -> Measured:
        if term not in MEASURES:
            return None, f"boxes do not show which is the {term}"
        measure, sign = MEASURES[term]
        if term in ("tallest", "shortest") and self.boxes.shape[2] < 3:
            return None, "the scene has no heights"
        measures = sign * measure(self.boxes)
        rivals = others or [i for i in self.on_surface if i != subject]
        if value is not None:
            there = place_degree("part", value, lean_on_surface(self.boxes, self.degrees.surface))
            if there is None:
                return None, f"{value!r} is not a side"
            if there[subject] <= HOLDS_ABOVE:
                return float(there[subject]), self._where(subject)
            rivals = [i for i in rivals if there[i] > HOLDS_ABOVE]
        best = max(rivals, key=lambda i: float(measures[i]), default=None)
        if best is None:
            return 1.0, "nothing else is there"
        ahead = float(measures[subject] - measures[best])
        lengths = [self._length(abs(float(measure(self.boxes)[i]))) for i in (subject, best)]
        if term in ("leftmost", "rightmost"):
            side = term.removesuffix("most")
            shown = f"{self.things[best]} is {self._length(abs(ahead))} farther {'right' if side == 'left' else 'left'}"
            return float(ahead > 1e-9), shown if ahead > 0 else f"{self.things[best]} is farther {side}"
        return float(ahead > 1e-9), f"it measures {lengths[0]}, {self.things[best]} {lengths[1]}"

    def _ordinal(self, value: str, subject: int, others: list[int]) -> Measured:
        number, _, side = value.partition(" from ")
        sides = [TOWARDS[word] for word in side.split() if word in TOWARDS]
        if len(sides) != 1 or not number.lstrip("-").isdigit():
            return None, f"{value!r} is not a rank from one side"
        axis, sign = sides[0]
        group = [subject, *others] if others else self.on_surface
        places = -sign * self.degrees.centres[group, axis]
        rank = 1 + int((places < places[group.index(subject)] - 1e-9).sum())
        wanted = int(number) if int(number) > 0 else len(group) + 1 + int(number)
        return float(rank == wanted), f"it is number {rank} of {len(group)} from the {side}"

    def _row(self, order: str | None, members: list[int]) -> Measured:
        centres = self.degrees.centres[members]
        if order in ROW_ORDERS:
            table = self.degrees.relation(ROW_ORDERS[order])
            pairs = list(pairwise(members)) or [(members[0], members[0])]
            worst = min(pairs, key=lambda pair: float(table[pair]))
            ordered = float(table[worst]) if len(members) > 1 else 1.0
            if ordered <= HOLDS_ABOVE:
                return ordered, f"{self.things[worst[0]]} and {self.things[worst[1]]} are not in the order {order}"
        if len(members) < 3:
            return 1.0, "two are always in a row"
        middle = centres - centres.mean(axis=0)
        _, _, axes = np.linalg.svd(middle)
        length = max(float(np.ptp(middle @ axes[0])), 1e-9)
        off = float(np.abs(middle @ axes[1]).max())
        degree = float(np.exp(np.interp(off / length, *OFF_LINE)))
        return degree, f"they are up to {self._length(off)} off a line of {self._length(length)}"

    def _circle(self, members: list[int]) -> Measured:
        if len(members) < 3:
            return None, "a circle has at least three members"
        off = self.degrees.centres[members] - self.degrees.centres[members].mean(axis=0)
        radii = np.hypot(off[:, 0], off[:, 1])
        spread = float(radii.std() / max(float(radii.mean()), 1e-9))
        degree = float(np.exp(np.interp(spread, *UNEVEN)))
        low, high = self._length(float(radii.min())), self._length(float(radii.max()))
        return degree, f"they are {low} to {high} from their middle"

    def _each_other(self, relation: str, members: list[int]) -> Measured:
        if len(members) < 2:
            return None, "one object stands for all of them"
        table = self.degrees.relation(relation)
        worst = min(combinations(members, 2), key=lambda pair: float(table[pair]))
        first, second = (self.things[i] for i in worst)
        gap = self._length(float(self.degrees.gaps[worst]))
        return float(table[worst]), f"{first} and {second} are {gap} apart"

    def _piled(self, term: str, members: list[int]) -> Measured:
        if len(members) < 2:
            return None, "one object stands for all of them"
        size = (self.boxes[:, 1] - self.boxes[:, 0])[:, :2].prod(axis=1)
        height = self.boxes[:, 0, 2] if self.boxes.shape[2] == 3 else -size
        order = sorted(members, key=(lambda i: -size[i]) if term == "nested" else (lambda i: height[i]))
        table = self.degrees.relation("inside" if term == "nested" else "on")
        lower, upper = min(pairwise(order), key=lambda pair: float(table[pair[1], pair[0]]))
        word = "in" if term == "nested" else "on"
        return float(table[upper, lower]), f"{self.things[upper]} comes next to {word} {self.things[lower]}"

    def _none(self, relation: str, subjects: list[int]) -> Measured:
        if relation == "between" and len(subjects) > 1:
            table = self.degrees.triple_degrees("between")[:, subjects[0], subjects[1]]
        elif relation in self.vocabulary and len(subjects):
            table = np.max([self.degrees.relation(relation)[:, subject] for subject in subjects], axis=0)
        else:
            return None, f"boxes do not show what is {relation} it"
        others = [i for i in self.on_surface if i not in subjects]
        found = max(others, key=lambda i: float(table[i]), default=None)
        if found is None or table[found] <= HOLDS_ABOVE:
            return 1.0 - (float(table[found]) if found is not None else 0.0), "nothing is there"
        return 1.0 - float(table[found]), f"{self.things[found]} is there"


def _undecidable(claim: Claim) -> str:
    term, value = claim.relation.replace("_", " "), claim.value
    if claim.relation in AIMING:
        return "boxes have no direction"
    if claim.relation == "on" and not claim.arguments and value is None:
        return "the scene has no heights"
    if claim.relation == "size":
        return f"{value!r} is relative to the usual size of the kind"
    if value is not None and not claim.arguments and claim.relation not in _OF_ONE:
        return f"{value!r} is not among the objects"
    return f"boxes do not show the {term}" if claim.relation in _OF_ONE else f"boxes do not show what is {term}"


_OF_ONE = frozenset(
    {"contents", "material", "state", "shape", "kind", "colour", "height", "length", "width", "thickness"}
)


def outcomes_of_claims(
    evidence: Evidence, claims: Sequence[Claim], filled: Mapping[str, str], members: Mapping[str, Iterable[str]]
) -> tuple[ClaimOutcome, ...]:
    """Return the outcomes of claims in the scene of a grounding.

    Parameters
    ----------
    evidence
        Evidence of the grounding.
    claims
        Claims to check.
    filled
        Names of the things that the objects are matched to.
    members
        Names of the things of each group of unknown number.

    Returns
    -------
    tuple of ClaimOutcome
        An outcome for each claim, in order; of a claim about a group, those of all members that violate it if any does.
    """
    scene, models = evidence.scene, evidence.meaning.models or shipped_models()
    words = evidence.description.vocabulary

    def checked(some: Sequence[Claim], filled: Mapping[str, str]) -> tuple[ClaimOutcome, ...]:
        return check_claims(
            some, filled, scene.nodes, scene.boxes, words, models, evidence.metric, evidence.surface, scene.poses
        )

    found: list[ClaimOutcome] = []
    for claim, outcome in zip(claims, checked(claims, filled), strict=True):
        group = claim.subjects[0] if len(claim.subjects) == 1 else None
        outcomes = [checked([claim], {**filled, group: thing})[0] for thing in members.get(group or "", ()) if group]
        wrong = [entry for entry in outcomes if entry.verdict in (ClaimVerdict.VIOLATED, ClaimVerdict.WAIVED)]
        found += wrong or [outcome]
    return tuple(found)


def violated(outcomes: Sequence[ClaimOutcome]) -> Iterator[ClaimOutcome]:
    """Yield the violated claims that are not hedged, which are faults of a table.

    Parameters
    ----------
    outcomes
        Outcomes of the claims about a table.

    Yields
    ------
    ClaimOutcome
        Violated claims with a weight of at least 1, in the order of ``outcomes``.
    """
    return (entry for entry in outcomes if entry.verdict is ClaimVerdict.VIOLATED and entry.claim.weight >= 1)
