"""Candidates: the names that a perceived thing may bear, each with a probability, as evidence for who is who.

A recogniser says how probable each name is that it was taught, and how probable it is that none of them fits. Bayes'
rule turns a probability back into a likelihood ratio by dividing by the prior: P(seen | name) / P(seen) =
P(name | seen) / P(name). An object of a description that bears a taught name weighs by the probability of that name; an
object with another name weighs by the probability that none of the taught ones fits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.reasoning.grounding.evidence.labels import Label, naming

NONE_PRIOR = 0.5
"""Prior probability that a thing bears no taught name, as recognisers assume it; taught names share the rest evenly."""

CANDIDATE_OUTLIERS = 0.02
"""Share of things of which the candidates say nothing, so that no name is ruled out."""

Candidates = Mapping[str, float]
"""Names with the probability of each; what is missing to 1 is the probability of none of them."""


def candidate_ratios(
    description: RelationGraph, candidates: Sequence[Candidates | None], kinds: Kinds
) -> NDArray[np.float64]:
    """Return what candidates say of n1 objects being each of n2 things, shape (n1, n2), as log-likelihood ratios.

    Parameters
    ----------
    description
        The objects, by name and kind. A candidate names an object as a label does: by its name, its kind, or a
        narrower or broader kind.
    candidates
        Those of each thing; None, or no name, says nothing. A name that any of the things has counts as taught.
    kinds
        The known kinds.

    Notes
    -----
    With C taught names, u the prior of none of them and w the share of outliers, the ratio of an object that the names
    in S call is log((1 - w) p(S) C / ((1 - u) \\|S\\|) + w); of one that no name calls, log((1 - w) p(none) / u + w).
    """
    taught = list(dict.fromkeys(name for each in candidates for name in each or ()))
    ratios = np.zeros((len(description.nodes), len(candidates)))
    if not taught:
        return ratios
    calls = np.stack([naming(description, [Label(name)], kinds).named[:, 0] for name in taught], axis=1)  # (n1, C)
    prior = np.where(calls.any(axis=1), calls.sum(axis=1) * (1 - NONE_PRIOR) / len(taught), NONE_PRIOR)
    for thing, each in enumerate(candidates):
        if each:
            shares = np.array([each.get(name, 0.0) for name in taught])
            found = np.where(calls.any(axis=1), calls @ shares, max(0.0, 1.0 - float(shares.sum())))
            ratios[:, thing] = np.log((1 - CANDIDATE_OUTLIERS) * found / prior + CANDIDATE_OUTLIERS)
    return ratios
