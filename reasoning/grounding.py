"""Who is who: a description aligned with a scene, and everything that qualifies the answer."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import Fact
from deixis.reasoning.answer import (
    DECIDED,
    Alternative,
    FactOutcome,
    Grounding,
    LeftOut,
    Match,
    Outcome,
    Pivotal,
    Standing,
)
from deixis.reasoning.dropping import Dropped, without_each
from deixis.reasoning.engines import Alignment, Engine
from deixis.reasoning.evidence import Evidence
from deixis.reasoning.matching.problem import UNMATCHED
from deixis.reasoning.symmetry import interchangeable

DEFAULT_TIME_LIMIT = 10.0

DROPPING = 0.1
"""Share of the time limit for finding out what would change without each fact."""

NO_TIME = "there was no time to find out what rests on which fact"

WORTH_NAMING = 0.01
"""Probability from which an alternative is named."""

MANY_FELLOWS = 100
"""Interchangeable objects up to which each lists the others' things: of k that would be k * k."""


def ground(
    evidence: Evidence, engine: Engine, time_limit: float = DEFAULT_TIME_LIMIT, notes: tuple[str, ...] = ()
) -> Grounding:
    """Aligns, and says what the alignment rests on.

    The evidence is first put in the order of its names, so that the answer does not depend on the order in which
    objects and facts were stated or things perceived: where the evidence leaves several answers, names decide, and
    the result says so (``interchangeable``, ``decided``).
    """
    started = time.perf_counter()
    rows = np.array(sorted(range(len(evidence.description.nodes)), key=lambda i: evidence.description.nodes[i]), int)
    columns = np.array(sorted(range(len(evidence.scene.nodes)), key=lambda i: evidence.scene.nodes[i]), int)
    in_order, stated = _facts_in_order(evidence.reordered(rows, columns))
    alignment = engine.align(in_order, started + (1 - DROPPING) * time_limit)
    groups = _groups(in_order)
    outcomes = _outcomes(in_order, alignment, stated)
    matches = _matches(in_order, alignment, outcomes, groups)
    names = evidence.description.nodes
    posterior = alignment.posterior
    pivotal = _pivotal(in_order, alignment, matches, time.perf_counter() + DROPPING * time_limit)
    hurried = pivotal is None and posterior is not None and alignment.proved_best
    return Grounding(
        engine=alignment.engine,
        matches=MappingProxyType({name: matches[name] for name in names if name in matches}),
        unmatched_objects=_left_out_objects(in_order, alignment, names),
        unmatched_perceived=_left_out_things(in_order, alignment, evidence.scene.nodes),
        interchangeable=groups,
        graph_similarity=alignment.graph_similarity,
        outcomes=outcomes,
        proved_best=alignment.proved_best,
        finished=alignment.finished,
        gap=alignment.gap,
        converged=alignment.converged,
        notes=notes + _notes(evidence, alignment) + ((NO_TIME,) if hurried else ()),
        pivotal=pivotal,
        probabilities=Standing.NONE if posterior is None else (Standing.EXACT if posterior.exact else Standing.SAMPLED),
        probability_error=0.0 if posterior is None else posterior.error,
        seconds=time.perf_counter() - started,
    )


def _facts_in_order(evidence: Evidence) -> tuple[Evidence, NDArray[np.int64]]:
    """The same evidence with its facts by what they say, and where each was stated (edges,).

    Sums in another order could break a tie by rounding.
    """
    graph = evidence.description
    keys = (graph.weights, graph.optional, graph.positive, graph.relation_sets, graph.objects, graph.subjects)
    order = np.lexsort(keys)
    description = replace(
        graph,
        subjects=graph.subjects[order],
        objects=graph.objects[order],
        relation_sets=graph.relation_sets[order],
        positive=graph.positive[order],
        optional=graph.optional[order],
        weights=graph.weights[order],
        sources=tuple(graph.sources[edge] for edge in order) if graph.sources else (),
    )
    return replace(evidence, description=description), order.astype(np.int64)


def _groups(evidence: Evidence) -> tuple[tuple[str, ...], ...]:
    return tuple(interchangeable(evidence.description, [row.tobytes() for row in evidence.unary]))


def _outcomes(evidence: Evidence, alignment: Alignment, stated: NDArray[np.int64]) -> tuple[FactOutcome, ...]:
    """What became of the facts that can be compared, in the order in which they were stated."""
    degrees = evidence.degrees(alignment.assignment)
    vocabulary = evidence.description.vocabulary
    outcomes = []
    for edge, degree in zip(evidence.facts, degrees, strict=True):
        fact = evidence.description.fact(int(edge))
        p = alignment.assignment[evidence.description.subjects[edge]]
        q = alignment.assignment[evidence.description.objects[edge]]
        if UNMATCHED in (p, q):
            outcomes.append(FactOutcome(fact, Outcome.OPEN, 0.0, None, None))
            continue
        missed = Outcome.WAIVED if fact.optional else Outcome.VIOLATED
        outcomes.append(
            FactOutcome(
                fact,
                Outcome.SATISFIED if degree > 0 else missed,
                float(degree),
                (evidence.scene.nodes[p], evidence.scene.nodes[q]),
                vocabulary.members(1 << int(evidence.names[p, q]))[0],
            )
        )
    return tuple(outcomes[place] for place in np.argsort(stated[evidence.facts]).tolist())


def _matches(
    evidence: Evidence,
    alignment: Alignment,
    outcomes: tuple[FactOutcome, ...],
    groups: tuple[tuple[str, ...], ...],
) -> dict[str, Match]:
    grouped = {name for group in groups for name in group}
    said, held = dict.fromkeys(evidence.description.nodes, 0.0), dict.fromkeys(evidence.description.nodes, 0.0)
    for entry in outcomes:
        if entry.outcome in (Outcome.SATISFIED, Outcome.VIOLATED):
            for name in (entry.fact.subject, entry.fact.object):
                said[name] += entry.fact.affirmed_weight
                held[name] += entry.fact.affirmed_weight * entry.degree
    matches = {}
    for i in np.flatnonzero(alignment.assignment != UNMATCHED):
        name, p = evidence.description.nodes[i], int(alignment.assignment[i])
        alternatives = _alternatives(evidence, alignment, int(i), groups)
        probability = None if alignment.posterior is None else float(alignment.posterior.marginals[i, p])
        matches[name] = Match(
            object=name,
            perceived=evidence.scene.nodes[p],
            score=held[name] / said[name] if said[name] else 1.0,
            similarity=float(alignment.matrix[i, p]),
            decided=_decided(evidence, alignment, int(i), name in grouped),
            alternatives=alternatives,
            probability=probability,
        )
    return matches


def _decided(evidence: Evidence, alignment: Alignment, i: int, grouped: bool) -> bool:
    """Whether a match is probable enough; without probabilities, whether nothing else is as similar."""
    if alignment.posterior is None:
        similar = alignment.margins is not None and bool(alignment.margins[i] > 1e-9)
        return bool(evidence.allowed[i].sum() == 1) or (similar and not grouped)
    return bool(alignment.posterior.marginals[i, alignment.assignment[i]] >= DECIDED)


def _alternatives(
    evidence: Evidence, alignment: Alignment, i: int, groups: tuple[tuple[str, ...], ...]
) -> tuple[Alternative, ...]:
    """What else an object could be, the best first: by probability, else by similarity."""
    found = (
        _similar(evidence, alignment, i, groups) if alignment.posterior is None else _probable(evidence, alignment, i)
    )
    return tuple(sorted(found, key=lambda other: (other.cost, other.perceived is None, other.perceived)))


def _probable(evidence: Evidence, alignment: Alignment, i: int) -> list[Alternative]:
    assert alignment.posterior is not None
    row, chosen = alignment.posterior.marginals[i], int(alignment.assignment[i])
    own = max(float(row[chosen]), 1e-300)  # of what is left out the last column is its own, as UNMATCHED is
    found = []
    for p in np.flatnonzero(row >= WORTH_NAMING).tolist():
        if p != chosen % len(row):
            perceived = evidence.scene.nodes[p] if p < len(evidence.scene.nodes) else None
            found.append(Alternative(perceived, max(0.0, round(math.log(own / row[p]), 9)), float(row[p])))
    return found


def _similar(
    evidence: Evidence, alignment: Alignment, i: int, groups: tuple[tuple[str, ...], ...]
) -> list[Alternative]:
    """Interchangeable fellows' things, which cost nothing, if not too many; and the engine's next best choice."""
    name = evidence.description.nodes[i]
    found: dict[str, float] = {}
    for group in groups:
        if name in group and len(group) <= MANY_FELLOWS:
            fellows = (evidence.description.index(other) for other in group if other != name)
            matched = (alignment.assignment[j] for j in fellows if alignment.assignment[j] != UNMATCHED)
            found |= {evidence.scene.nodes[p]: 0.0 for p in matched}
    if alignment.runners_up is not None and alignment.margins is not None and alignment.runners_up[i] != UNMATCHED:
        found.setdefault(evidence.scene.nodes[alignment.runners_up[i]], max(float(alignment.margins[i]), 0.0))
    return [Alternative(p, cost) for p, cost in found.items()]


def _pivotal(
    evidence: Evidence, alignment: Alignment, matches: dict[str, Match], deadline: float
) -> tuple[Pivotal, ...] | None:
    """The facts without which something would be otherwise; None where there was no time to look at all."""
    if alignment.posterior is None or not alignment.proved_best:
        return None
    found, seen, probable = [], 0, alignment.posterior.exact and alignment.sides == 1
    for dropped in without_each(evidence.problem, alignment.assignment, probable, deadline):
        seen += 1
        pivotal = _without(evidence, alignment, matches, dropped)
        if pivotal.changes or pivotal.unsettled or pivotal.settled:
            found.append(pivotal)
    if seen < len(evidence.facts):
        return None
    return tuple(sorted(found, key=lambda pivotal: _place(pivotal.fact)))


def _place(fact: Fact) -> tuple[str, int, str]:
    """Where a fact stands, for listing."""
    return ("", 0, str(fact)) if fact.source is None else (fact.source.file, fact.source.line, str(fact))


def _without(evidence: Evidence, alignment: Alignment, matches: dict[str, Match], dropped: Dropped) -> Pivotal:
    nodes, things = evidence.description.nodes, evidence.scene.nodes
    other = dropped.assignment != alignment.assignment
    if not dropped.better:
        other[:] = False
    sure = dropped.probability >= DECIDED
    decided = np.array([name in matches and matches[name].decided for name in nodes], dtype=bool)
    known = ~np.isnan(dropped.probability) & ~other & (alignment.assignment != UNMATCHED)
    targets = zip(nodes, dropped.assignment.tolist(), strict=True)
    return Pivotal(
        fact=evidence.description.fact(int(evidence.facts[dropped.fact])),
        changes={
            name: None if p == UNMATCHED else things[p] for (name, p), new in zip(targets, other, strict=True) if new
        },
        unsettled=_named(nodes, known & decided & ~sure),
        settled=_named(nodes, known & ~decided & sure),
    )


def _named(nodes: tuple[str, ...], chosen: NDArray[np.bool_]) -> tuple[str, ...]:
    return tuple(nodes[i] for i in np.flatnonzero(chosen))


def _any_of_many(evidence: Evidence, alignment: Alignment) -> tuple[str, ...]:
    """The objects that are matched to something, though no thing is probable enough to be worth naming."""
    if alignment.posterior is None:
        return ()
    least = alignment.posterior.marginals.max(axis=1, initial=0.0) < WORTH_NAMING
    return _named(evidence.description.nodes, least & (alignment.assignment != UNMATCHED))


def _left_out_objects(evidence: Evidence, alignment: Alignment, names: tuple[str, ...]) -> tuple[LeftOut, ...]:
    reasons = {}
    for i in np.flatnonzero(alignment.assignment == UNMATCHED):
        if not len(evidence.scene.nodes):
            reason = "nothing was perceived"
        elif not evidence.allowed[i].any():
            reason = "the labels of the scene leave it nothing that it could be"
        elif len(evidence.description.nodes) > len(evidence.scene.nodes) and (alignment.assignment != UNMATCHED).any():
            reason = "the description names more than was perceived, and the rest explains the scene best without it"
        else:
            reason = "what is said of it fits nothing perceived as well as its not being there"
        reasons[evidence.description.nodes[i]] = LeftOut(
            evidence.description.nodes[i], reason, _alternatives(evidence, alignment, int(i), ())
        )
    return tuple(reasons[name] for name in names if name in reasons)


def _left_out_things(evidence: Evidence, alignment: Alignment, ids: tuple[str, ...]) -> tuple[LeftOut, ...]:
    taken = set(alignment.assignment.tolist()) - {UNMATCHED}
    reasons = {}
    for p, thing in enumerate(evidence.scene.nodes):
        if p in taken:
            continue
        if not len(evidence.description.nodes):
            reason = "the description names nothing"
        elif not evidence.allowed[:, p].any():
            reason = "its label names nothing in the description"
        elif len(evidence.description.nodes) < len(evidence.scene.nodes) and taken:
            reason = "the description names fewer things than were perceived, and fits the others at least as well"
        else:
            reason = "nothing that is described fits it better than its not being described"
        reasons[thing] = reason
    return tuple(LeftOut(thing, reasons[thing]) for thing in ids if thing in reasons)


def _notes(evidence: Evidence, alignment: Alignment) -> tuple[str, ...]:
    notes = list(alignment.notes)
    nothing = alignment.matrix.size and not alignment.matrix.any()
    if not alignment.converged and not nothing:
        notes.append("the similarity did not converge; its figures are those of the last iteration")
    if alignment.converged and nothing:
        notes.append("the paper's similarity is zero: no exact name of the description is one of the scene's")
    vague = _any_of_many(evidence, alignment)
    if vague:
        notes.append(f"any of many things is about as likely, and none of them likely, to be: {', '.join(vague)}")
    hidden = [str(fact) for fact in evidence.description.facts() if not fact.plain]
    if hidden:
        notes.append("not seen by the similarity, being no single affirmed relation: " + "; ".join(hidden))
    return tuple(notes)
