"""Find the members of groups of unknown number: all perceived things that fit what is said about a group.

The engines match a group (*the chairs*) to one thing, which stands for it. Its members are found afterwards, with
everything else at its match: a thing is a member if its label, size and colour fit the noun about as well as those of
the thing that fits best, and the facts about the group hold of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.lessons.types import Alternative
from deixis.reasoning.grounding.answers.alternatives import MIN_LISTED_PROBABILITY
from deixis.reasoning.grounding.answers.answer import FactOutcome, Grounding, Member, Outcome
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.words.meaning import OUTLIERS
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import is_decided

MEMBER_FROM = 0.5
"""Minimum probability at which a thing counts as a member of a group."""

Array = NDArray[np.float64]
Assignment = NDArray[np.int64]


def with_members(found: Grounding, evidence: Evidence) -> Grounding:
    """Return a grounding with the members of the groups of unknown number.

    The match of a group is its most probable member, whose probability is that of being a member. It is decided if the
    membership of every thing is decided.

    Parameters
    ----------
    found
        Grounding in which each group is matched to one thing, or is not matched.
    evidence
        Evidence of the grounding, with the names of the groups as ``uncounted``.

    Returns
    -------
    Grounding
        The grounding with ``members``; the members are no longer among its unmatched things.
    """
    assignment = assignment_of(found, evidence)
    members, matches = {}, dict(found.matches)
    for name in evidence.uncounted:
        if name not in matches or name not in evidence.description.nodes:
            continue
        chances = member_probabilities(evidence, assignment, evidence.description.index(name))
        order = np.argsort(-chances, kind="stable")
        listed = [(evidence.scene.nodes[i], float(chances[i])) for i in order if chances[i] >= MIN_LISTED_PROBABILITY]
        members[name] = tuple(Member(thing, chance) for thing, chance in listed if chance >= MEMBER_FROM)
        if not members[name]:
            continue
        stands = next((one for one in members[name] if one.perceived == matches[name].perceived), members[name][0])
        rest = tuple(Alternative(thing, 0.0, chance) for thing, chance in listed if chance < MEMBER_FROM)
        matches[name] = replace(
            matches[name],
            perceived=stands.perceived,
            probability=stands.probability,
            decided=bool(np.all(is_decided(np.maximum(chances, 1 - chances), 0.0))),
            alternatives=rest,
        )
    things = {one.perceived for group in members.values() for one in group}
    left = tuple(one for one in found.unmatched_perceived if one.name not in things)
    return replace(found, matches=matches, members=members, unmatched_perceived=left)


def assignment_of(found: Grounding, evidence: Evidence) -> Assignment:
    """Return the things of the matches of a grounding.

    Parameters
    ----------
    found
        Grounding with matches.
    evidence
        Evidence of the grounding, of a description of n1 objects.

    Returns
    -------
    ndarray
        Position of the thing of each object in the scene, with ``UNMATCHED`` for objects left out; shape (n1,).
    """
    place = {name: i for i, name in enumerate(evidence.scene.nodes)}
    return np.array(
        [place.get(found.matches[name].perceived, UNMATCHED) if name in found.matches else UNMATCHED
         for name in evidence.description.nodes],
        dtype=np.int64,
    )  # fmt: skip


def member_probabilities(evidence: Evidence, assignment: Assignment, group: int) -> Array:
    """Return the probability of each thing to be a member of a group.

    It is the likelihood of the thing as a share of that of the thing that fits best. A fact about two groups may hold
    of any thing that fits the noun of the other group.

    Parameters
    ----------
    evidence
        Evidence of a description of n1 objects, the group among them, in a scene of n2 things.
    assignment
        Thing of each object, with ``UNMATCHED`` for objects left out; shape (n1,).
    group
        Position of the group among the objects.

    Returns
    -------
    ndarray
        Probabilities, shape (n2,); 0 for the things of other objects.
    """
    score, free = evidence.unary[group].copy(), evidence.allowed[group].copy()
    free[[thing for i, thing in enumerate(assignment.tolist()) if i != group and thing != UNMATCHED]] = False
    if not free.any():
        return np.zeros(len(free))
    graph, things = evidence.description, np.arange(len(free))
    for fact, other, fillers in _facts_about(evidence, assignment, group):
        holds = np.zeros(len(free), dtype=np.bool_)
        for thing in fillers:
            tried = np.tile(assignment, (len(free), 1))
            tried[:, group], tried[:, other] = things, thing
            holds |= (evidence.degrees(tried)[:, fact] > 0) & (things != thing)
        score = score + np.where(holds, 0.0, np.log(OUTLIERS)) * graph.net_weights[evidence.facts[fact]]
    best = float(score[free].max())
    result: Array = np.where(free, np.exp(np.minimum(score - best, 0.0)), 0.0)
    return result


def broken_of_members(evidence: Evidence, assignment: Assignment, group: int) -> dict[int, tuple[FactOutcome, ...]]:
    """Return the things that fit the noun of a group, each with the certain facts about the group that it violates.

    Parameters
    ----------
    evidence
        Evidence of a description of n1 objects, the group among them, in a scene of n2 things.
    assignment
        Thing of each object, with ``UNMATCHED`` for objects left out; shape (n1,). The group has a thing.
    group
        Position of the group among the objects.

    Returns
    -------
    dict
        Violated facts by the position of the thing. A fact about two groups holds of a thing if it holds with any thing
        of the other group.
    """
    graph, nodes = evidence.description, evidence.scene.nodes
    single = [i for i, name in enumerate(graph.nodes) if name not in evidence.uncounted and assignment[i] != UNMATCHED]
    taken = {int(assignment[i]) for i in single}
    things = [thing for thing in _could_be(evidence, assignment, group) if thing not in taken]
    firm = evidence.firm()
    about = [one for one in _facts_about(evidence, assignment, group) if firm[one[0]]]
    broken: dict[int, tuple[FactOutcome, ...]] = {}
    for thing in things:
        outcomes = []
        for fact, other, fillers in about:
            rivals = [rival for rival in fillers if rival != thing]
            tried = np.tile(assignment, (len(rivals), 1))
            tried[:, group], tried[:, other] = thing, rivals
            if len(rivals) and not (evidence.degrees(tried)[:, fact] > 0).any():
                edge = int(evidence.facts[fact])
                first, second = (thing, rivals[0]) if graph.subjects[edge] == group else (rivals[0], thing)
                seen = evidence.scene.relation(first, second)
                pair = nodes[first], nodes[second]
                outcomes.append(FactOutcome(graph.fact(edge), Outcome.VIOLATED, 0.0, pair, seen))
        broken[thing] = tuple(outcomes)
    return broken


def _facts_about(evidence: Evidence, assignment: Assignment, group: int) -> Iterator[tuple[int, int, list[int]]]:
    """Yield the position of each comparable fact about a group, its other object, and the things that may fill it."""
    graph = evidence.description
    for fact, edge in enumerate(evidence.facts.tolist()):
        ends = (int(graph.subjects[edge]), int(graph.objects[edge]))
        if group not in ends:
            continue
        other = ends[1] if ends[0] == group else ends[0]
        if assignment[other] != UNMATCHED:
            yield fact, other, _could_be(evidence, assignment, other)


def _could_be(evidence: Evidence, assignment: Assignment, other: int) -> list[int]:
    """Return the thing of an object, or all things that fit the noun of another group as well as its own thing."""
    thing = int(assignment[other])
    if evidence.description.nodes[other] not in evidence.uncounted:
        return [thing]
    alone = evidence.unary[other]
    fits = evidence.allowed[other] & (alone >= alone[thing] + np.log(MEMBER_FROM))
    return np.flatnonzero(fits).tolist()
