"""Who is who: a description aligned with a scene, and everything that qualifies the answer."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from types import MappingProxyType

import numpy as np

from deixis.ontology.graph import Fact
from deixis.ontology.relation import Relation
from deixis.reasoning.engines import Alignment, Engine
from deixis.reasoning.evidence import UNMATCHED, Evidence
from deixis.reasoning.symmetry import interchangeable

DEFAULT_TIME_LIMIT = 10.0


class Outcome(StrEnum):
    """What became of a stated fact."""

    SATISFIED = "satisfied"  # holds of the matched pair, at least widely
    VIOLATED = "violated"  # does not hold of the matched pair
    WAIVED = "waived"  # does not hold, and was optional
    OPEN = "open"  # an object of it is not matched


@dataclass(frozen=True, slots=True)
class Alternative:
    """Something else that an object could be, and what choosing it would lose (satisfied facts, or similarity)."""

    perceived: str
    cost: float


@dataclass(frozen=True, slots=True)
class Match:
    """An object of the description and the perceived thing that it is.

    ``score`` is the share of what is said of the object and can be compared that holds (by degree and weight; 1 where
    there is nothing), ``similarity`` the paper's. ``decided`` says that the evidence leaves nothing else as good.
    """

    object: str
    perceived: str
    score: float
    similarity: float
    decided: bool
    alternatives: tuple[Alternative, ...]


@dataclass(frozen=True, slots=True)
class FactOutcome:
    """A stated fact, what became of it, and the exact relation perceived instead or accordingly."""

    fact: Fact
    outcome: Outcome
    degree: float
    perceived: tuple[str, str] | None
    seen: Relation | None


@dataclass(frozen=True, slots=True)
class LeftOut:
    """An object or a perceived thing without a counterpart, and why."""

    name: str
    reason: str


@dataclass(frozen=True)
class Grounding:
    """The answer of an engine, with all that qualifies it."""

    engine: str
    matches: Mapping[str, Match]
    unmatched_objects: tuple[LeftOut, ...]
    unmatched_perceived: tuple[LeftOut, ...]
    interchangeable: tuple[tuple[str, ...], ...]
    graph_similarity: float
    outcomes: tuple[FactOutcome, ...]
    proved_best: bool
    converged: bool
    notes: tuple[str, ...]
    seconds: float

    def of(self, outcome: Outcome) -> tuple[FactOutcome, ...]:
        return tuple(entry for entry in self.outcomes if entry.outcome is outcome)

    @property
    def satisfied(self) -> tuple[FactOutcome, ...]:
        return self.of(Outcome.SATISFIED)

    def noting(self, notes: tuple[str, ...]) -> Grounding:
        """The same answer with notes before its own."""
        return replace(self, notes=notes + self.notes)

    @property
    def violated(self) -> tuple[FactOutcome, ...]:
        return self.of(Outcome.VIOLATED)


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
    ordered = evidence.reordered(rows, columns)
    alignment = engine.align(_facts_in_order(ordered), started + time_limit)
    groups = _groups(ordered)
    outcomes = _outcomes(ordered, alignment)
    matches = _matches(ordered, alignment, outcomes, groups)
    names = evidence.description.nodes
    return Grounding(
        engine=alignment.engine,
        matches=MappingProxyType({name: matches[name] for name in names if name in matches}),
        unmatched_objects=_left_out_objects(ordered, alignment, names),
        unmatched_perceived=_left_out_things(ordered, alignment, evidence.scene.nodes),
        interchangeable=groups,
        graph_similarity=alignment.graph_similarity,
        outcomes=outcomes,
        proved_best=alignment.proved_best,
        converged=alignment.converged,
        notes=notes + _notes(ordered, alignment),
        seconds=time.perf_counter() - started,
    )


def _facts_in_order(evidence: Evidence) -> Evidence:
    """The same evidence with its facts by what they say: sums in another order could break a tie by rounding."""
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
    return replace(evidence, description=description)


def _groups(evidence: Evidence) -> tuple[tuple[str, ...], ...]:
    known = zip(evidence.allowed, evidence.bonus, strict=True)
    colours = [(allowed.tobytes(), bonus.tobytes()) for allowed, bonus in known]
    return tuple(interchangeable(evidence.description, colours))


def _outcomes(evidence: Evidence, alignment: Alignment) -> tuple[FactOutcome, ...]:
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
    return tuple(outcomes)


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
                said[name] += entry.fact.weight
                held[name] += entry.fact.weight * entry.degree
    matches = {}
    for i in np.flatnonzero(alignment.assignment != UNMATCHED):
        name, p = evidence.description.nodes[i], int(alignment.assignment[i])
        margin = math.nan if alignment.margins is None else float(alignment.margins[i])
        only = evidence.allowed[i].sum() == 1
        matches[name] = Match(
            object=name,
            perceived=evidence.scene.nodes[p],
            score=held[name] / said[name] if said[name] else 1.0,
            similarity=float(alignment.matrix[i, p]),
            decided=bool(only or (margin > alignment.decisive and name not in grouped)),
            alternatives=_alternatives(evidence, alignment, int(i), margin, groups),
        )
    return matches


def _alternatives(
    evidence: Evidence, alignment: Alignment, i: int, margin: float, groups: tuple[tuple[str, ...], ...]
) -> tuple[Alternative, ...]:
    """What the object's interchangeable fellows are, which costs nothing, and the engine's next best choice."""
    name = evidence.description.nodes[i]
    found: dict[str, float] = {}
    for group in groups:
        if name in group:
            fellows = (evidence.description.index(other) for other in group if other != name)
            matched = (alignment.assignment[j] for j in fellows if alignment.assignment[j] != UNMATCHED)
            found |= {evidence.scene.nodes[p]: 0.0 for p in matched}
    if alignment.runners_up is not None and alignment.runners_up[i] != UNMATCHED:
        found.setdefault(evidence.scene.nodes[alignment.runners_up[i]], max(margin, 0.0))
    return tuple(Alternative(p, cost) for p, cost in sorted(found.items(), key=lambda item: (item[1], item[0])))


def _left_out_objects(evidence: Evidence, alignment: Alignment, names: tuple[str, ...]) -> tuple[LeftOut, ...]:
    reasons = {}
    for i in np.flatnonzero(alignment.assignment == UNMATCHED):
        if not len(evidence.scene.nodes):
            reason = "nothing was perceived"
        elif not evidence.allowed[i].any():
            reason = "the labels of the scene leave it nothing that it could be"
        else:
            reason = "the description names more than was perceived, and the rest explains the scene best without it"
        reasons[evidence.description.nodes[i]] = reason
    return tuple(LeftOut(name, reasons[name]) for name in names if name in reasons)


def _left_out_things(evidence: Evidence, alignment: Alignment, ids: tuple[str, ...]) -> tuple[LeftOut, ...]:
    taken = set(alignment.assignment.tolist())
    reasons = {}
    for p, thing in enumerate(evidence.scene.nodes):
        if p in taken:
            continue
        if not len(evidence.description.nodes):
            reason = "the description names nothing"
        elif not evidence.allowed[:, p].any():
            reason = "its label names nothing in the description"
        else:
            reason = "the description names fewer things than were perceived, and fits the others better"
        reasons[thing] = reason
    return tuple(LeftOut(thing, reasons[thing]) for thing in ids if thing in reasons)


def _notes(evidence: Evidence, alignment: Alignment) -> tuple[str, ...]:
    notes = list(alignment.notes)
    if not alignment.converged:
        notes.append("the similarity did not converge; its figures are those of the last iteration")
    if alignment.matrix.size and not alignment.matrix.any():
        notes.append("the similarity collapsed to zero: the description and the scene have no relation in common")
    hidden = [str(fact) for fact in evidence.description.facts() if not fact.plain]
    if hidden:
        notes.append("not seen by the similarity, being no single affirmed relation: " + "; ".join(hidden))
    return tuple(notes)
