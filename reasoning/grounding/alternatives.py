"""What else each object could be, and why objects and things were left out."""

from __future__ import annotations

import math

import numpy as np

from deixis.ontology.lessons.types import Alternative
from deixis.reasoning.grounding.answer import LeftOut
from deixis.reasoning.grounding.engine import Alignment
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED

MIN_LISTED_PROBABILITY = 0.01
"""Probability from which an alternative is named."""

MAX_LISTED_GROUP = 100
"""Interchangeable objects up to which each lists the others' things: of k that would be k * k."""

FITS_OTHERS = "the description names fewer things than were perceived, and fits the others at least as well"


def alternatives(
    evidence: Evidence, alignment: Alignment, i: int, groups: tuple[tuple[str, ...], ...]
) -> tuple[Alternative, ...]:
    """Return what else an object could be, the best first: by probability, else by similarity."""
    found = (
        _similar(evidence, alignment, i, groups) if alignment.posterior is None else _probable(evidence, alignment, i)
    )
    return tuple(sorted(found, key=lambda o: (-(o.probability or 0.0), o.cost, o.perceived is None, o.perceived)))


def _probable(evidence: Evidence, alignment: Alignment, i: int) -> list[Alternative]:
    assert alignment.posterior is not None
    row, chosen = alignment.posterior.marginals[i], int(alignment.assignment[i])
    own = max(float(row[chosen]), 1e-300)  # of what is left out the last column is its own, as UNMATCHED is
    found = []
    for p in np.flatnonzero(row >= MIN_LISTED_PROBABILITY).tolist():
        if p != chosen % len(row):
            perceived = evidence.scene.nodes[p] if p < len(evidence.scene.nodes) else None
            found.append(Alternative(perceived, max(0.0, round(math.log(own / row[p]), 9)), float(row[p])))
    return found


def _similar(
    evidence: Evidence, alignment: Alignment, i: int, groups: tuple[tuple[str, ...], ...]
) -> list[Alternative]:
    """Return interchangeable fellows' things, which cost nothing, if not too many; and the engine's next best
    choice."""
    name = evidence.description.nodes[i]
    found: dict[str, float] = {}
    for group in groups:
        if name in group and len(group) <= MAX_LISTED_GROUP:
            fellows = (evidence.description.index(other) for other in group if other != name)
            matched = (alignment.assignment[j] for j in fellows if alignment.assignment[j] != UNMATCHED)
            found |= {evidence.scene.nodes[p]: 0.0 for p in matched}
    if alignment.runners_up is not None and alignment.margins is not None and alignment.runners_up[i] != UNMATCHED:
        found.setdefault(evidence.scene.nodes[alignment.runners_up[i]], max(float(alignment.margins[i]), 0.0))
    return [Alternative(p, cost) for p, cost in found.items()]


def left_out_objects(evidence: Evidence, alignment: Alignment, names: tuple[str, ...]) -> tuple[LeftOut, ...]:
    """Return the objects that are no thing, by ``names`` in their order: why, and what they could be."""
    reasons = {}
    for i in np.flatnonzero(alignment.assignment == UNMATCHED):
        if not len(evidence.scene.nodes):
            reason = "nothing was perceived"
        elif evidence.identified.all() and not evidence.allowed[i].any():
            reason = "the labels of the scene leave it nothing that it could be"
        elif len(evidence.description.nodes) > len(evidence.things) and (alignment.assignment != UNMATCHED).any():
            reason = "the description names more than was perceived, and the rest explains the scene best without it"
        else:
            reason = "what is said of it fits nothing perceived as well as its not being there"
        reasons[evidence.description.nodes[i]] = LeftOut(
            evidence.description.nodes[i], reason, alternatives(evidence, alignment, int(i), ())
        )
    return tuple(reasons[name] for name in names if name in reasons)


def left_out_things(evidence: Evidence, alignment: Alignment, ids: tuple[str, ...]) -> tuple[LeftOut, ...]:
    """Return the things that nobody is, by ``ids`` in their order, and why."""
    taken = set(alignment.assignment.tolist()) - {UNMATCHED}
    reasons = {}
    for p, thing in enumerate(evidence.scene.nodes):
        if p in taken:
            continue
        if not len(evidence.description.nodes):
            reason = "the description names nothing"
        elif evidence.identified[p] and not evidence.allowed[:, p].any():
            reason = "the labels of the scene leave it nothing in the description that it could be"
        elif len(evidence.description.nodes) < len(evidence.things) and taken:
            reason = FITS_OTHERS
        else:
            reason = "nothing that is described fits it better than its not being described"
        reasons[thing] = reason
    if evidence.whole is not None:
        reasons |= dict.fromkeys(set(evidence.whole.nodes) - set(evidence.scene.nodes), FITS_OTHERS)
    return tuple(LeftOut(thing, reasons[thing]) for thing in ids if thing in reasons)
