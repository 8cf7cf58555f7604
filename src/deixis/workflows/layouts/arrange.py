"""Arrange an imagined table: move its things until claims and graded words hold, without breaking what already holds.

A table of orders (:mod:`deixis.reasoning.entailment.realisation`) satisfies the facts that order edges of boxes. Claims
and graded words are models of the boxes, so that a search satisfies them: it moves a thing, with what lies on it, to a
place that an unmet statement suggests or to a random one, and keeps each move after which no fewer of them hold.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.graph import RelationGraph
from deixis.reasoning.geometry.overlap import overlapping
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.answers.claims import ClaimOutcome, check_claims
from deixis.reasoning.grounding.evidence.claims.places import CENTRAL, TOWARDS, X
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models

Array = NDArray[np.float64]

MAX_MOVES = 2000
"""Maximum number of moves that are tried."""

MAX_STALE_MOVES = 500
"""Maximum number of moves in a row after which no further statement holds."""

SEARCH_SECONDS = 6.0
"""Maximum time of the search in seconds."""

MOVES_OF_OTHERS = 0.2
"""Share of the moves that move an arbitrary thing, instead of one that an unmet statement is about."""

COMFORT = 0.65
"""Degree above which a statement is not improved further: the border is one half."""

TOGETHER = frozenset({"on", "under", "exactly_on", "exactly_under", "inside", "containing", "stacked", "stacked_under"})
"""Relations of things that lie on or in each other: they may overlap, and move together."""


@dataclass(frozen=True)
class Arrangement:
    """Statements that a search satisfies by moving the things of a table.

    ``kept`` are the edges of the graph that hold and must keep holding, ``graded`` the edges of graded words.
    """

    graph: RelationGraph
    claims: tuple[Claim, ...]
    kept: tuple[int, ...]
    graded: tuple[int, ...]

    def outcomes(self, boxes: Array) -> tuple[ClaimOutcome, ...]:
        """Return the outcomes of the claims for boxes (n, 2, 2).

        Parameters
        ----------
        boxes
            Boxes of the things in plan, shape (n, 2, 2), in metres.

        Returns
        -------
        tuple of ClaimOutcome
            One outcome per claim, in the order of the claims.
        """
        nodes = self.graph.nodes
        filled = {name: name for name in nodes}
        return check_claims(self.claims, filled, nodes, boxes, self.graph.vocabulary, shipped_models())

    def degrees(self, boxes: Array) -> Array:
        """Return the degrees of the graded facts and then of the claims; 1 for what boxes do not decide.

        Parameters
        ----------
        boxes
            Boxes of the things in plan, shape (n, 2, 2), in metres.

        Returns
        -------
        ndarray
            Degrees in [0, 1], shape (g + c,) for g graded facts and c claims.
        """
        claims = [1.0 if entry.degree is None else entry.degree for entry in self.outcomes(boxes)]
        found: list[float] = []
        if self.graded:
            words, graph = WordDegrees(pair_geometry(boxes), shipped_models()), self.graph
            for edge in self.graded:
                pair = graph.subjects[edge], graph.objects[edge]
                members = graph.vocabulary.members(int(graph.relation_sets[edge]))
                best = max(float(words.of(relation)[pair]) for relation in members)
                found.append(best if graph.positive[edge] else 1 - best)
        return np.array([*found, *claims])

    def firm(self, boxes: Array) -> bool:
        """Return whether all kept facts hold of the boxes.

        Parameters
        ----------
        boxes
            Boxes of the things in plan, shape (n, 2, 2), in metres.

        Returns
        -------
        bool
            False if a kept fact does not hold.
        """
        graph = self.graph
        names = scene_relations(graph.nodes, boxes, graph.vocabulary).names
        for edge in self.kept:
            name = names[graph.subjects[edge], graph.objects[edge]]
            members = graph.vocabulary.members(int(graph.relation_sets[edge]))
            holds = any(graph.vocabulary.degrees[relation.index][name] > 0 for relation in members)
            if holds != bool(graph.positive[edge]):
                return False
        return True

    @cached_property
    def together(self) -> list[tuple[int, int]]:
        """Pairs of things that lie on or in each other."""
        graph = self.graph
        return [
            (int(graph.subjects[edge]), int(graph.objects[edge]))
            for edge in range(len(graph))
            if graph.positive[edge]
            and TOGETHER & {r.name for r in graph.vocabulary.members(int(graph.relation_sets[edge]))}
        ]

    @cached_property
    def carried(self) -> list[list[int]]:
        """Things that move with each thing: what lies on it or in it, and what lies on that."""
        under = {"under", "exactly_under", "containing", "stacked_under"}
        above: dict[int, set[int]] = {}
        graph = self.graph
        for edge in range(len(graph)):
            words = {r.name for r in graph.vocabulary.members(int(graph.relation_sets[edge]))} & TOGETHER
            if words and graph.positive[edge]:
                ends = int(graph.subjects[edge]), int(graph.objects[edge])
                upper, lower = ends[::-1] if words & under else ends
                above.setdefault(lower, set()).add(upper)
        found = []
        for thing in range(len(graph.nodes)):
            group, new = {thing}, {thing}
            while new:
                new = {upper for lower in new for upper in above.get(lower, ())} - group
                group |= new
            found.append(sorted(group))
        return found

    def things_of(self, statement: int) -> tuple[list[int], list[int]]:
        """Return the subjects and the other objects of a graded fact, or of a claim after these.

        Parameters
        ----------
        statement
            Index of a graded fact or, after all of them, of a claim.

        Returns
        -------
        tuple
            Indices of the subjects, and indices of the other objects.
        """
        if statement < len(self.graded):
            edge = self.graded[statement]
            return [int(self.graph.subjects[edge])], [int(self.graph.objects[edge])]
        claim = self.claims[statement - len(self.graded)]
        subjects, others = ([self.graph.index(n) for n in names] for names in (claim.subjects, claim.arguments))
        return subjects, others


def arrange(task: Arrangement, boxes: Array, rng: np.random.Generator, deadline: Deadline) -> Array:
    """Move the boxes of a table so that more of its statements hold, and return them.

    Parameters
    ----------
    task
        Statements to satisfy, and facts to keep.
    boxes
        Boxes to start from, of which all kept facts hold; shape (n, 2, 2), in metres.
    rng
        Source of the random moves.
    deadline
        Time limit; the search also ends after ``SEARCH_SECONDS``.

    Returns
    -------
    ndarray
        Boxes of shape (n, 2, 2), in metres, of which all kept facts hold; the given boxes if no move helps.
    """
    deadline = min(deadline, Deadline.after(SEARCH_SECONDS))
    best, degrees = boxes, task.degrees(boxes)
    allowed = _overlaps(boxes)
    for first, second in task.together:
        allowed[first, second] = allowed[second, first] = True
    since = 0  # moves since one more statement held
    for _ in range(MAX_MOVES):
        unmet = np.flatnonzero(degrees < COMFORT)
        since += 1
        if not len(unmet) or since > MAX_STALE_MOVES or deadline.passed:
            break
        statement = int(rng.choice(unmet))
        moved = _randomly_moved(task, statement, best, rng)
        if moved is None or (_overlaps(moved) & ~allowed).any() or not task.firm(moved):
            continue
        found = task.degrees(moved)
        if _score(found) >= _score(degrees):  # equal moves too, which lead away from dead ends
            since = 0 if (found > 0.5).sum() > (degrees > 0.5).sum() else since
            best, degrees = moved, found
    return best


def _score(degrees: Array) -> float:
    """Return how much of the statements holds: each counts from one half on, and a little by its degree."""
    return float((degrees > 0.5).sum() + 0.5 * np.minimum(degrees, COMFORT).sum())


def _overlaps(boxes: Array) -> NDArray[np.bool_]:
    found = overlapping(boxes[:, :, :2])
    np.fill_diagonal(found, False)
    return found


def _randomly_moved(task: Arrangement, statement: int, boxes: Array, rng: np.random.Generator) -> Array | None:
    """Return the boxes after a random move of a thing of a statement that does not hold."""
    subjects, others = task.things_of(statement)
    claim = task.claims[statement - len(task.graded)] if statement >= len(task.graded) else None
    thing = int(rng.choice(subjects if rng.random() < 0.75 or not others else others))
    if rng.random() < MOVES_OF_OTHERS:
        thing = int(rng.integers(len(boxes)))
    middle = boxes.mean(axis=1)
    targets = list(_targets(claim, thing, subjects, others, boxes, rng))
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    way = rng.random()
    if targets and way < 0.6:
        target = targets[int(rng.integers(len(targets)))]
    elif way < 0.8:
        target = rng.uniform(low - 0.1 * (high - low), high + 0.1 * (high - low))
    else:
        target = middle[thing] + rng.normal(0, rng.choice([0.01, 0.03, 0.1]), 2)
    moved = boxes.copy()
    shift = np.where(rng.random() < 0.2, rng.permutation([1.0, 0.0]), 1.0) * (target - middle[thing])
    moved[task.carried[thing]] += shift
    return moved


def _targets(
    claim: Claim | None, thing: int, subjects: Sequence[int], others: Sequence[int], boxes: Array,
    rng: np.random.Generator,
) -> Iterator[Array]:  # fmt: skip
    """Yield places for the middle of a thing that a statement suggests."""
    middle, half = boxes.mean(axis=1), (boxes[:, 1] - boxes[:, 0]) / 2
    rest = [other for other in (*subjects, *others) if other != thing]
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    if len(others) > 1 and thing in subjects:
        first, second = rng.choice(len(others), 2, replace=False)
        yield middle[others[first]] + rng.uniform(0.35, 0.65) * (middle[others[second]] - middle[others[first]])
    if claim is not None and claim.relation in ("row", "circle") and len(subjects) > 2:
        if claim.relation == "row":
            first, second = rng.choice(rest, 2, replace=False)
            yield middle[first] + rng.uniform(-1, 2) * (middle[second] - middle[first])
        else:
            turn = 2 * np.pi * subjects.index(thing) / len(subjects)
            radius = max(float(np.hypot(*half[list(subjects)].T).sum()) / 2, 0.05)
            yield middle[list(subjects)].mean(axis=0) + radius * np.array([np.cos(turn), np.sin(turn)])
    for other in rest:  # beside another one, at the distance said or close to it
        gap = rng.exponential(0.03) if claim is None or claim.metres is None else claim.metres
        angle = rng.uniform(0, 2 * np.pi)
        towards = np.array([np.cos(angle), np.sin(angle)])
        reach = half[thing] + half[other]
        side = rng.integers(4)
        beside = np.array([(1, 0), (-1, 0), (0, 1), (0, -1)][side], dtype=float)
        yield middle[other] + beside * (reach + gap) + (1 - np.abs(beside)) * rng.uniform(-0.5, 0.5) * reach
        yield middle[other] + towards * (np.abs(towards) @ reach + gap)
        yield middle[other]
    if claim is not None and not others:
        target = middle[thing].copy()
        words = (claim.value or "").replace("-", " ").split()
        sides = [TOWARDS[word] for word in words if word in TOWARDS]
        if claim.relation == "corner" and len({axis for axis, _ in sides}) < 2:
            known = {axis for axis, _ in sides}
            sides += [(axis, int(rng.choice([-1, 1]))) for axis in (0, 1) if axis not in known]
        if claim.relation in ("edge", "end", "side") and not sides:
            sides = [(X, int(rng.choice([-1, 1])))]
        if claim.relation == "middle" or CENTRAL & set(words):
            target = (low + high) / 2
        beyond = rng.uniform(0.0, 0.15, 2) * (high - low)
        for axis, sign in sides:
            if claim.relation != "middle":
                target[axis] = high[axis] + beyond[axis] if sign > 0 else low[axis] - beyond[axis]
        yield target
