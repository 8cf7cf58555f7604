"""Answers as plain data, in the form that the commands print as JSON."""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.export import claim_to_dict, fact_to_dict, graph_to_dict
from deixis.ontology.graph.facts import Fact

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.ontology.lessons.types import Alternative, Match
    from deixis.reasoning.entailment.derivations import Derivation
    from deixis.reasoning.entailment.why_not import WhyNot
    from deixis.reasoning.grounding.answers.answer import FactOutcome, Grounding
    from deixis.reasoning.grounding.answers.claims import ClaimOutcome
    from deixis.workflows.grounding.check import Check
    from deixis.workflows.knowledge.learn import Learned
    from deixis.workflows.layouts.infer import Inference


def script_to_dict(script: Script) -> dict[str, Any]:
    """Return a parsed script: its header, its objects with their kinds, and its facts with their places.

    Parameters
    ----------
    script
        Script of the layout language, or text in English that was read as one.

    Returns
    -------
    dict
        Data for JSON with the keys ``file``, ``name``, ``title``, ``viewpoint``, ``surface``, ``objects`` and
        ``facts``.
    """
    graph = graph_to_dict(script.graph())
    return {
        "file": script.file,
        "name": script.name,
        "title": script.title,
        "viewpoint": script.viewpoint,
        "surface": script.surface,
        "objects": graph["nodes"],
        "facts": [stated_to_dict(content, script.surface) | {"status": "stated"} for content in script.stated],
    }


def stated_to_dict(content: Fact | Claim, surface: str | None = None) -> dict[str, Any]:
    """Return a fact or a claim as plain data.

    Parameters
    ----------
    content
        Fact between two objects, or claim about any number of them.
    surface
        Noun of what everything stands on, for claims without an object (*in the corner*); None if unknown.

    Returns
    -------
    dict
        Data for JSON with the place of the statement in its file.
    """
    return fact_to_dict(content) if isinstance(content, Fact) else claim_to_dict(content, surface)


def inference_to_dict(inference: Inference) -> dict[str, Any]:
    """Return the stated and inferred facts, or only the minimal conflict.

    Parameters
    ----------
    inference
        Answer of ``deixis infer``.

    Returns
    -------
    dict
        Data for JSON. A contradictory script has ``consistent`` False and a ``conflict``; any other has ``facts``, each
        with its status, ``complete``, and ``consistent`` True, or None where the time limit was reached.
    """
    if inference.conflict is not None:
        facts = [fact_to_dict(fact) for fact in inference.conflict.facts]
        conflict = {"reason": inference.conflict.reason, "minimal": inference.conflict.minimal, "facts": facts}
        return {"consistent": False, "conflict": conflict}
    stated = [fact_to_dict(fact) | {"status": "stated"} for fact in inference.stated]
    inferred = [
        fact_to_dict(entry.fact)
        | {"status": "inferred", "rule": entry.rule.value, "steps": entry.steps, "lines": list(entry.lines)}
        for entry in inference.inferred()
    ]
    known = {"consistent": True if inference.decided else None, "complete": inference.complete}
    return {**known, "facts": stated + inferred}


def derivation_to_dict(derivation: Derivation) -> dict[str, Any]:
    """Return a derivation as a tree, down to the stated facts.

    Parameters
    ----------
    derivation
        Proof of a fact, or of an order of two sides of boxes.

    Returns
    -------
    dict
        Nested data for JSON: the proved ``fact``, the ``rule`` of the last step, and its ``premises``, which are
        dictionaries of the same form.
    """
    premises = [derivation_to_dict(premise) for premise in derivation.premises]
    claim = fact_to_dict(derivation.claim) if isinstance(derivation.claim, Fact) else {"claim": str(derivation.claim)}
    return {"fact": claim, "rule": derivation.rule.value, "premises": premises}


def why_not_to_dict(found: WhyNot) -> dict[str, Any]:
    """Return why a fact does not follow: what excludes it, or a table without it on which all facts hold.

    Parameters
    ----------
    found
        Answer of ``deixis infer --why-not``.

    Returns
    -------
    dict
        Data for JSON: ``fact`` and ``follows``, and of ``derivation``, ``excluded_by``, ``conflict`` and ``picture``
        those that apply. The boxes of a picture have no unit: only the order of their sides counts.
    """
    answer: dict[str, Any] = {"fact": fact_to_dict(found.fact), "follows": found.follows is not None}
    if found.follows is not None:
        answer["derivation"] = derivation_to_dict(found.follows)
    if found.against is not None:
        answer["excluded_by"] = derivation_to_dict(found.against)
    if found.conflict is not None:
        facts = [fact_to_dict(fact) for fact in found.conflict.facts]
        answer["conflict"] = {"reason": found.conflict.reason, "facts": facts}
    if found.picture is not None:
        boxes = zip(found.picture.objects, found.picture.boxes.tolist(), strict=True)
        answer["picture"] = [{"id": name, "min": box[0], "max": box[1]} for name, box in boxes]
        answer["missing_orders"] = [str(order) for order in found.missing]
        answer["known"] = [fact_to_dict(fact) for fact in found.known]
    return answer


def _rounded(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else round(value, 6)


def _alternative_to_dict(other: Alternative) -> dict[str, Any]:
    return {
        "perceived": other.perceived,
        "cost": _rounded(other.cost),
        "probability": _rounded(other.probability),
    }


def match_to_dict(match: Match) -> dict[str, Any]:
    """Return an object, its thing, and the alternatives.

    Parameters
    ----------
    match
        Match of one object of a description.

    Returns
    -------
    dict
        Data for JSON. Score, similarity and probability are rounded, or None where the engine gives none.
    """
    return {
        "object": match.object,
        "perceived": match.perceived,
        "score": _rounded(match.score),
        "similarity": _rounded(match.similarity),
        "decided": match.decided,
        "probability": _rounded(match.probability),
        "alternatives": [_alternative_to_dict(other) for other in match.alternatives],
    }


def grounding_to_dict(found: Grounding) -> dict[str, Any]:
    """Return the matches of a grounding and everything that qualifies them.

    Parameters
    ----------
    found
        Answer of ``deixis ground``.

    Returns
    -------
    dict
        Data for JSON: the matches, the objects and things left out with the reasons, the interchangeable names, the
        facts by outcome, the claims with what was measured, and the facts on which the answer depends.
    """
    from deixis.reasoning.grounding.answers.answer import Outcome, Standing

    pivotal = [
        {
            "fact": fact_to_dict(entry.fact),
            "changes": dict(entry.changes),
            "unsettled": list(entry.unsettled),
            "settled": list(entry.settled),
        }
        for entry in found.pivotal or ()
    ]
    return {
        "engine": found.engine,
        "matches": [match_to_dict(match) for match in found.matches.values()],
        **({} if found.surface is None else {"surface": found.surface}),
        **({"members": _members(found)} if found.members else {}),
        "unmatched_objects": [left.name for left in found.unmatched_objects],
        "unmatched_perceived": [left.name for left in found.unmatched_perceived],
        "might_be": {
            left.name: [_alternative_to_dict(other) for other in left.alternatives] for left in found.unmatched_objects
        },
        "left_out": {left.name: left.reason for left in (*found.unmatched_objects, *found.unmatched_perceived)},
        "interchangeable": [list(group) for group in found.interchangeable],
        "graph_similarity": round(found.graph_similarity, 9),
        "facts": {
            "stated": len(found.outcomes),
            "satisfied": len(found.satisfied),
            "violated": [outcome_to_dict(entry) for entry in found.violated],
            "waived": [outcome_to_dict(entry) for entry in found.of(Outcome.WAIVED)],
            "open": [outcome_to_dict(entry) for entry in found.of(Outcome.OPEN)],
        },
        "claims": [claim_outcome_to_dict(entry) for entry in found.claims],
        "frames": [
            {"fact": fact_to_dict(one.fact), "frame": one.frame.value, "probability": _rounded(one.probability)}
            for one in found.frames
        ],
        "pivotal": None if found.pivotal is None else pivotal,
        "probabilities": {
            "standing": found.probabilities.value,
            "error": None if found.probabilities is Standing.NONE else _rounded(found.probability_error),
        },
        "fits": _rounded(found.fits),
        "proved_best": found.proved_best,
        "gap": _rounded(found.gap),
        "finished": found.finished,
        "converged": found.converged,
        "notes": list(found.notes),
        "seconds": round(found.seconds, 6),
        **_dialogue_and_viewpoints(found),
    }


def _members(found: Grounding) -> dict[str, Any]:
    """Return the members of each group of unknown number, by its name."""
    return {
        name: [{"perceived": one.perceived, "probability": _rounded(one.probability)} for one in members]
        for name, members in found.members.items()
    }


def _dialogue_and_viewpoints(found: Grounding) -> dict[str, Any]:
    """Return the possible viewpoints of the script and the questions with their answers, where requested."""
    answer: dict[str, Any] = {}
    if found.viewpoints is not None:
        answer["viewpoints"] = [
            {
                "turned": round(math.degrees(view.angle), 1) % 360,
                "mirrored": view.mirrored,
                "probability": _rounded(view.probability),
            }
            for view in found.viewpoints
        ]
    if found.exchanges is not None:
        answer["questions"] = [
            {
                "text": one.question.text,
                "bits": round(one.question.bits, 6),
                "answer": one.answer,
                "outcome": one.outcome.value,
            }
            for one in found.exchanges
        ]
    return answer


def outcome_to_dict(entry: FactOutcome) -> dict[str, Any]:
    """Return a fact, its line, and the perceived relation of its pair.

    Parameters
    ----------
    entry
        Outcome of one fact under a grounding.

    Returns
    -------
    dict
        Data for JSON with the keys ``fact``, ``line`` (None for a fact that no file states), ``degree``, and
        ``perceived`` (None where the pair was not perceived).
    """
    perceived = None
    if entry.perceived is not None and entry.seen is not None:
        perceived = {
            "relation": entry.seen.word,
            "subject": entry.perceived[0],
            "object": entry.perceived[1],
            "reading": entry.seen.reading.value,
        }
    line = entry.fact.source.line if entry.fact.source else None
    return {"fact": fact_to_dict(entry.fact), "line": line, "degree": entry.degree, "perceived": perceived}


def learned_to_dict(learned: Learned) -> dict[str, Any]:
    """Return a lesson: what it taught, what it left open, and its grounding.

    Parameters
    ----------
    learned
        Answer of ``deixis learn``.

    Returns
    -------
    dict
        Data for JSON: the lesson, its roles and categories, the undecided objects, and the grounding.
    """
    layout = learned.lesson.layout
    return {
        "lesson": layout.lesson,
        "layout": layout.name,
        "roles": [role.name for role in layout.roles],
        "facts": len(layout.facts),
        "categories": list(learned.categories),
        "undecided": list(learned.doubtful),
        "kept_names": [
            {"perceived": one.thing, "taught": one.taught, "teacher": one.teacher, "grounded": one.grounded}
            for one in learned.kept_names
        ],
        "grounding": grounding_to_dict(learned.grounding),
    }


def claim_outcome_to_dict(entry: ClaimOutcome, surface: str | None = None) -> dict[str, Any]:
    """Return a claim with the verdict on it, and what was measured.

    Parameters
    ----------
    entry
        Outcome of one claim about a table.
    surface
        Noun of what everything stands on, for claims without an object; None if unknown.

    Returns
    -------
    dict
        Data for JSON with the keys ``claim``, ``verdict``, ``degree``, ``perceived`` (ids of things) and ``measured``.
    """
    return {
        "claim": claim_to_dict(entry.claim, surface),
        "verdict": entry.verdict.value,
        "degree": _rounded(entry.degree),
        "perceived": list(entry.perceived),
        "measured": entry.measured,
    }


def check_to_dict(checked: Check) -> dict[str, Any]:
    """Return the verdicts on a table; broken facts with their lines and what was seen instead.

    Parameters
    ----------
    checked
        Answer of ``deixis check``.

    Returns
    -------
    dict
        Data for JSON: the roles by verdict (``correct``, ``missing``, ``misplaced``, …), the extra things, and the
        outcomes of the claims.
    """
    from deixis.reasoning.comparison.checking import RoleVerdict

    table = checked.table
    lines: dict[str, set[int]] = defaultdict(set)
    for fact in checked.layout.facts:
        if fact.source is not None:
            lines[fact.subject].add(fact.source.line)
            lines[fact.object].add(fact.source.line)
    return {
        "layout": checked.layout.name,
        "lesson": checked.layout.lesson,
        "well": table.well,
        "conforms": checked.conforms,
        "correct": [{"object": c.role, "perceived": c.perceived} for c in table.of(RoleVerdict.CORRECT)],
        "missing": [{"object": c.role, "lines": sorted(lines[c.role])} for c in table.of(RoleVerdict.MISSING)],
        "misplaced": [
            {
                "object": c.role,
                "perceived": c.perceived,
                "in_place_of": c.in_place_of,
                "violated": [outcome_to_dict(entry) for entry in c.broken],
            }
            for c in table.of(RoleVerdict.MISPLACED)
        ],
        "turned": [
            {
                "object": c.role,
                "perceived": c.perceived,
                "statements": [
                    {
                        "statement": str(entry.statement),
                        "line": None if entry.statement.source is None else entry.statement.source.line,
                        "degrees": None if entry.turn is None else round(math.degrees(entry.turn), 1),
                        "remedy": entry.remedy,
                    }
                    for entry in c.turned
                ],
            }
            for c in table.turned
        ],
        "miscoloured": [
            {
                "object": c.role,
                "perceived": c.perceived,
                "described": other.described.label,
                "seen": other.seen.label,
            }
            for c, other in table.miscoloured
        ],
        "extra": [{"perceived": e.perceived, "label": e.label, "reason": e.reason} for e in table.extra],
        "undetermined": [{"object": c.role, "perceived": c.perceived} for c in table.of(RoleVerdict.UNDETERMINED)],
        "absent": [{"object": c.role} for c in table.of(RoleVerdict.ABSENT)],
        "violated": [outcome_to_dict(entry) for entry in table.broken],
        "unexpected": [outcome_to_dict(entry) for entry in table.unexpected],
        "claims": [claim_outcome_to_dict(entry, checked.layout.surface) for entry in table.claims],
        "proved_best": table.grounding.proved_best,
        "notes": list(table.grounding.notes),
        "report": checked.report,
    }
