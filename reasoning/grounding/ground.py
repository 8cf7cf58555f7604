"""Ground a description in a scene: align the two, and report how certain the answer is and what it rests on."""

from __future__ import annotations

import time
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.lessons.types import Match
from deixis.reasoning.grounding.answers.alternatives import (
    MIN_LISTED_PROBABILITY,
    alternatives,
    left_out_objects,
    left_out_things,
)
from deixis.reasoning.grounding.answers.answer import FactOutcome, FrameOfFact, Grounding, Outcome, Pivotal, Standing
from deixis.reasoning.grounding.answers.members import with_members
from deixis.reasoning.grounding.answers.sensitivity import MAX_OBJECTS as MAX_SENSITIVITY_OBJECTS
from deixis.reasoning.grounding.answers.sensitivity import WithoutFact, leave_one_out
from deixis.reasoning.grounding.answers.symmetry import interchangeable
from deixis.reasoning.grounding.engines.engine import Alignment, Engine
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.evidence.words.pair_features import HEADINGS
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import is_decided
from deixis.reasoning.grounding.reference.answer import Frame

if TYPE_CHECKING:
    from deixis.reasoning.grounding.answers.claims import ClaimOutcome

SENSITIVITY_SHARE = 0.1
"""Share of the time limit for computing what would change without each fact."""

SECONDS_PER_NAME, MAX_MARGIN = 1.5e-4, 0.15
"""Time reserved for building the answer: seconds per object and thing on a quiet machine, and the maximum share of the
time left."""

SENSITIVITY_OUT_OF_TIME = "time limit reached before the sensitivity to each fact was computed"

SENSITIVITY_NOT_ASKED = "the sensitivity to each fact was not computed, because the description hardly fits the scene"


def ground(
    evidence: Evidence, engine: Engine, deadline: Deadline = Deadline.never(), notes: tuple[str, ...] = ()
) -> Grounding:
    """Align a description with a scene, and report how certain the matches are and which facts they rest on.

    Parameters
    ----------
    evidence
        Description, scene, and the evidence for each match.
    engine
        Engine that finds the matches (:func:`deixis.reasoning.grounding.engines.registry.engine_named`).
    deadline
        End of the time limit.
    notes
        Notes to put before those of the answer.

    Returns
    -------
    Grounding
        Matches, probabilities, alternatives and outcomes of facts.

    Notes
    -----
    The evidence is first sorted by names, so that the answer does not depend on the order in which objects and facts
    were stated or things perceived. Where the evidence leaves several answers, the order of names decides, and the
    result says so (``interchangeable``, ``decided``).
    """
    started = time.perf_counter()
    name_count = len(evidence.description.nodes) + len(evidence.things)
    building = SECONDS_PER_NAME * name_count * deadline.slowness
    deadline = deadline.earlier(min(building, MAX_MARGIN * deadline.left))
    sensitivity_seconds = SENSITIVITY_SHARE * deadline.left
    rows = np.array(sorted(range(len(evidence.description.nodes)), key=lambda i: evidence.description.nodes[i]), int)
    columns = np.array(sorted(range(len(evidence.scene.nodes)), key=lambda i: evidence.scene.nodes[i]), int)
    in_order, stated = _facts_in_order(evidence.reordered(rows, columns))
    alignment = engine.align(in_order, deadline.share(1 - SENSITIVITY_SHARE))
    in_order = in_order if alignment.seen is None else alignment.seen
    known = zip(in_order.unary, in_order.allowed, strict=True)
    alone = [(row.tobytes(), mask.tobytes()) for row, mask in known]
    groups = tuple(interchangeable(in_order.description, alone, in_order.claims))
    outcomes = _outcomes(in_order, alignment, stated)
    matches = _matches(in_order, alignment, outcomes, groups)
    names = evidence.description.nodes
    posterior, verdict = alignment.posterior, alignment.verdict
    pivotal = _pivotal(in_order, alignment, matches, deadline.within(sensitivity_seconds))
    found = Grounding(
        engine=alignment.engine,
        matches=MappingProxyType({name: matches[name] for name in names if name in matches}),
        unmatched_objects=left_out_objects(in_order, alignment, names),
        unmatched_perceived=left_out_things(in_order, alignment, evidence.things),
        interchangeable=groups,
        graph_similarity=alignment.graph_similarity,
        outcomes=outcomes,
        frames=_frames(in_order, outcomes),
        proved_best=alignment.proved_best,
        finished=alignment.finished,
        gap=alignment.gap,
        converged=alignment.converged,
        notes=notes + _notes(evidence, alignment) + (_why_not_pivotal(in_order, alignment) if pivotal is None else ()),
        pivotal=pivotal,
        probabilities=_standing(posterior),
        probability_error=0.0 if posterior is None else posterior.error,
        fits=None if verdict is None else verdict.fits,
        sides=() if verdict is None else tuple((one.side, one.probability) for one in verdict.sides),
        seconds=time.perf_counter() - started,
    )
    found = with_members(found, in_order) if evidence.uncounted else found
    return replace(found, claims=_claims(in_order, found)) if in_order.claims else found


def _claims(evidence: Evidence, found: Grounding) -> tuple[ClaimOutcome, ...]:
    """Return the outcomes of the claims of the description."""
    from deixis.reasoning.grounding.answers.claims import outcomes_of_claims

    filled = {name: match.perceived for name, match in found.matches.items()}
    members = {name: [one.perceived for one in group] for name, group in found.members.items()}
    return outcomes_of_claims(evidence, evidence.claims, filled, members)


def _standing(posterior: Posterior | None) -> Standing:
    """Return the quality of the probabilities of an answer."""
    if posterior is None:
        return Standing.NONE
    if posterior.is_propagated:
        return Standing.PROPAGATED
    return Standing.EXACT if posterior.exact else Standing.SAMPLED


def _facts_in_order(evidence: Evidence) -> tuple[Evidence, NDArray[np.int64]]:
    """Return the evidence with its facts sorted by content, and the stated position of each, shape (edges,).

    Without sorting, a sum in another order could break a tie by rounding.
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


def _outcomes(evidence: Evidence, alignment: Alignment, stated: NDArray[np.int64]) -> tuple[FactOutcome, ...]:
    """Return the outcomes of the facts that can be compared, in the order in which they were stated."""
    degrees = evidence.degrees(alignment.assignment)
    outcomes = []
    for edge, degree in zip(evidence.facts, degrees, strict=True):
        fact = evidence.description.fact(int(edge))
        p = int(alignment.assignment[evidence.description.subjects[edge]])
        q = int(alignment.assignment[evidence.description.objects[edge]])
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
                evidence.scene.relation(p, q),
            )
        )
    return tuple(outcomes[place] for place in np.argsort(stated[evidence.facts]).tolist())


DIRECTIONS = frozenset(HEADINGS) | {"in_front", "behind"}
"""Words whose frame is the viewer's, unless the object's own front gives them one."""

AIMS = frozenset({"facing", "faced_by", "pointing", "pointed_at_by"})
"""Words whose frame is the front or the long axis of a thing."""


def _frames(evidence: Evidence, outcomes: tuple[FactOutcome, ...]) -> tuple[FrameOfFact, ...]:
    """Return the frames of reference of the stated directions between matched things."""
    scene, found = evidence.scene, []
    if scene.boxes is None or not evidence.meaning.graded:
        return ()
    for outcome in outcomes:
        word = outcome.fact.relations[0].word
        if outcome.perceived is None or not (word in DIRECTIONS or word in AIMS or word == "opposite"):
            continue
        if word in AIMS:
            found.append(FrameOfFact(outcome.fact, Frame.OBJECT, 1.0))
            continue
        share = 0.0
        if word not in HEADINGS:
            share = float(evidence.frame_shares(word)[tuple(map(scene.index, outcome.perceived))])
        seen = Frame.TABLE if word == "opposite" else Frame.VIEWER
        found.append(FrameOfFact(outcome.fact, Frame.OBJECT if share > 0.5 else seen, max(share, 1 - share)))
    return tuple(found)


def _matches(
    evidence: Evidence,
    alignment: Alignment,
    outcomes: tuple[FactOutcome, ...],
    groups: tuple[tuple[str, ...], ...],
) -> dict[str, Match]:
    grouped = {name for group in groups for name in group}
    stated, held = dict.fromkeys(evidence.description.nodes, 0.0), dict.fromkeys(evidence.description.nodes, 0.0)
    for entry in outcomes:
        if entry.outcome in (Outcome.SATISFIED, Outcome.VIOLATED):
            for name in (entry.fact.subject, entry.fact.object):
                stated[name] += entry.fact.affirmed_weight
                held[name] += entry.fact.affirmed_weight * entry.degree
    matches = {}
    for i in np.flatnonzero(alignment.assignment != UNMATCHED):
        name, p = evidence.description.nodes[i], int(alignment.assignment[i])
        probability = None if alignment.posterior is None else float(alignment.posterior.marginals[i, p])
        matches[name] = Match(
            object=name,
            perceived=evidence.scene.nodes[p],
            score=held[name] / stated[name] if stated[name] else 1.0,
            similarity=float(alignment.matrix[i, p]),
            decided=_decided(evidence, alignment, int(i), name in grouped),
            alternatives=alternatives(evidence, alignment, int(i), groups),
            probability=probability,
        )
    return matches


def _decided(evidence: Evidence, alignment: Alignment, i: int, grouped: bool) -> bool:
    """Return whether a match is probable enough; without probabilities, whether no other thing is as similar."""
    if alignment.posterior is None:
        similar = alignment.margins is not None and bool(alignment.margins[i] > 1e-9)
        return bool(evidence.allowed[i].sum() == 1) or (similar and not grouped)
    probability = alignment.posterior.marginals[i, alignment.assignment[i]]
    return bool(is_decided(probability, float(alignment.posterior.errors[i])))


def _pivotal(
    evidence: Evidence, alignment: Alignment, matches: dict[str, Match], deadline: Deadline
) -> tuple[Pivotal, ...] | None:
    """Return the facts without which the answer would be different; None where not all facts could be examined.

    Also returns None where the description is probably of another scene: the likeliest maps without a fact do not show
    whether that would still be the case.
    """
    if alignment.posterior is None or not alignment.proved_best or alignment.of_another:
        return None
    found, seen, probable = [], 0, alignment.posterior.exact
    facts = len(evidence.facts)
    for dropped in leave_one_out(evidence.problem, alignment.assignment, probable, deadline, facts):
        seen += 1
        pivotal = _without(evidence, alignment, matches, dropped)
        if pivotal.changes or pivotal.unsettled or pivotal.settled:
            found.append(pivotal)
    if seen < facts:
        return None

    def place(pivotal: Pivotal) -> tuple[str, int, str]:
        fact, source = pivotal.fact, pivotal.fact.source
        return ("", 0, str(fact)) if source is None else (source.file, source.line, str(fact))

    return tuple(sorted(found, key=place))


def _why_not_pivotal(evidence: Evidence, alignment: Alignment) -> tuple[str, ...]:
    """Return the note that explains why a proved answer with probabilities has no pivotal facts."""
    if (
        len(evidence.description.nodes) > MAX_SENSITIVITY_OBJECTS
        or alignment.posterior is None
        or not alignment.proved_best
    ):
        return ()
    return (SENSITIVITY_NOT_ASKED if alignment.of_another else SENSITIVITY_OUT_OF_TIME,)


def _without(evidence: Evidence, alignment: Alignment, matches: dict[str, Match], dropped: WithoutFact) -> Pivotal:
    nodes, things = evidence.description.nodes, evidence.scene.nodes
    other = dropped.assignment != alignment.assignment
    if not dropped.better:
        other[:] = False
    share = 1.0 if alignment.verdict is None else alignment.verdict.best.probability
    sure = is_decided(share * dropped.probability, 0.0)
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


def _notes(evidence: Evidence, alignment: Alignment) -> tuple[str, ...]:
    notes = list(alignment.notes)
    nothing = alignment.matrix.size and not alignment.matrix.any()
    if not alignment.converged and not nothing:
        notes.append("the similarity did not converge; its values are those of the last iteration")
    if alignment.converged and nothing:
        notes.append("the paper's similarity is zero: the description and the scene share no exact relation")
    if alignment.posterior is not None:
        unlikely = alignment.posterior.marginals.max(axis=1, initial=0.0) < MIN_LISTED_PROBABILITY
        vague = _named(evidence.description.nodes, unlikely & (alignment.assignment != UNMATCHED))
        if vague:
            notes.append(f"many things are about equally likely, and none is likely, for: {', '.join(vague)}")
    hidden = [str(fact) for fact in evidence.description.facts() if not fact.plain]
    if hidden:
        notes.append("the similarity ignores facts that are not one affirmed relation: " + "; ".join(hidden))
    return tuple(notes)
