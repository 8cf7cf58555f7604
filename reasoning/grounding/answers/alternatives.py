"""Alternatives of each object, and the reasons why objects and things have no match."""

from __future__ import annotations

import math

import numpy as np

from deixis.ontology.lessons.types import Alternative
from deixis.reasoning.grounding.answers.answer import LeftOut
from deixis.reasoning.grounding.engines.engine import Alignment
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import DECIDED

MIN_LISTED_PROBABILITY = 0.01
"""Minimum probability of a listed alternative; the most probable alternative of an undecided match is always listed."""

MAX_LISTED_GROUP = 100
"""Largest group of interchangeable objects that list each other's things: k objects list k * k things."""

FITS_OTHERS = "the description names fewer things than were perceived, and it fits the others at least as well"


def alternatives(
    evidence: Evidence, alignment: Alignment, i: int, groups: tuple[tuple[str, ...], ...]
) -> tuple[Alternative, ...]:
    """Return what else an object could be.

    Parameters
    ----------
    evidence
        The evidence.
    alignment
        The best alignment.
    i
        Position of the object.
    groups
        Groups of objects that the description cannot tell apart.

    Returns
    -------
    tuple of Alternative
        Other things, best first: by probability if the engine has one, else by similarity.
    """
    found = (
        _similar(evidence, alignment, i, groups) if alignment.posterior is None else _probable(evidence, alignment, i)
    )
    return tuple(sorted(found, key=lambda o: (-(o.probability or 0.0), o.cost, o.perceived is None, o.perceived)))


def _probable(evidence: Evidence, alignment: Alignment, i: int) -> list[Alternative]:
    assert alignment.posterior is not None
    row, chosen = alignment.posterior.marginals[i], int(alignment.assignment[i])
    own = max(float(row[chosen]), 1e-300)  # UNMATCHED is -1, the last column, which is that of being left out
    others = np.delete(np.arange(len(row)), chosen)
    likely = others[row[others] >= MIN_LISTED_PROBABILITY]
    if not len(likely) and own < DECIDED and row[others].max(initial=0.0) > 0:
        likely = others[[row[others].argmax()]]
    found = []
    for p in likely.tolist():
        perceived = evidence.scene.nodes[p] if p < len(evidence.scene.nodes) else None
        found.append(Alternative(perceived, max(0.0, round(math.log(own / row[p]), 9)), float(row[p])))
    return found


def _similar(
    evidence: Evidence, alignment: Alignment, i: int, groups: tuple[tuple[str, ...], ...]
) -> list[Alternative]:
    """Return the things of interchangeable objects, at no cost, and the engine's next best choice for the object."""
    name = evidence.description.nodes[i]
    found: dict[str, float] = {}
    for group in groups:
        if name in group and len(group) <= MAX_LISTED_GROUP:
            members = (evidence.description.index(other) for other in group if other != name)
            matched = (alignment.assignment[j] for j in members if alignment.assignment[j] != UNMATCHED)
            found |= {evidence.scene.nodes[p]: 0.0 for p in matched}
    if alignment.runners_up is not None and alignment.margins is not None and alignment.runners_up[i] != UNMATCHED:
        found.setdefault(evidence.scene.nodes[alignment.runners_up[i]], max(float(alignment.margins[i]), 0.0))
    return [Alternative(p, cost) for p, cost in found.items()]


def left_out_objects(evidence: Evidence, alignment: Alignment, names: tuple[str, ...]) -> tuple[LeftOut, ...]:
    """Return the objects without a match, each with the reason and what it could be.

    Parameters
    ----------
    evidence
        The evidence.
    alignment
        The best alignment.
    names
        Names of the objects.

    Returns
    -------
    tuple of LeftOut
        The objects, in the order of ``names``.
    """
    reasons = {}
    for i in np.flatnonzero(alignment.assignment == UNMATCHED):
        if not len(evidence.scene.nodes):
            reason = "nothing was perceived"
        elif evidence.identified.all() and not evidence.allowed[i].any():
            reason = "the labels of the scene rule out every thing that it could be"
        elif len(evidence.description.nodes) > len(evidence.things) and (alignment.assignment != UNMATCHED).any():
            reason = "the description names more objects than were perceived, and the others explain the scene best"
        else:
            reason = "its absence explains the scene better than a match with any perceived thing"
        reasons[evidence.description.nodes[i]] = LeftOut(
            evidence.description.nodes[i], reason, alternatives(evidence, alignment, int(i), ())
        )
    return tuple(reasons[name] for name in names if name in reasons)


def left_out_things(evidence: Evidence, alignment: Alignment, ids: tuple[str, ...]) -> tuple[LeftOut, ...]:
    """Return the things without a match, each with the reason.

    Parameters
    ----------
    evidence
        The evidence.
    alignment
        The best alignment.
    ids
        Ids of the things.

    Returns
    -------
    tuple of LeftOut
        The things, in the order of ``ids``.
    """
    taken = set(alignment.assignment.tolist()) - {UNMATCHED}
    reasons = {}
    for p, thing in enumerate(evidence.scene.nodes):
        if p in taken:
            continue
        if not len(evidence.description.nodes):
            reason = "the description names nothing"
        elif evidence.identified[p] and not evidence.allowed[:, p].any():
            reason = "the labels of the scene rule out every object that it could be"
        elif len(evidence.description.nodes) < len(evidence.things) and taken:
            reason = FITS_OTHERS
        else:
            reason = "no described object fits it better than the assumption that it is not described"
        reasons[thing] = reason
    if evidence.whole is not None:
        reasons |= dict.fromkeys(set(evidence.whole.nodes) - set(evidence.scene.nodes), FITS_OTHERS)
    return tuple(LeftOut(thing, reasons[thing]) for thing in ids if thing in reasons)
