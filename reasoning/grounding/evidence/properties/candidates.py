"""Candidates: possible names of a perceived thing, each with a probability, as evidence for matches.

A recogniser returns the probability of each name that it was taught, and the probability that none of them fits. By
Bayes' rule, a probability over its prior is a likelihood ratio: P(seen | name) / P(seen) = P(name | seen) / P(name).
For an object with a taught name, the evidence is the probability of that name; for an object with another name, it is
the probability that none of the taught names fits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.things.kinds import Kinds
from deixis.reasoning.grounding.evidence.properties.labels import Label, naming

NONE_PRIOR = 0.5
"""Prior probability that a thing has no taught name, as recognisers assume; the taught names share the rest equally."""

CANDIDATE_OUTLIERS = 0.02
"""Share of things whose candidates are independent of their names, so that no name is ruled out."""

Candidates = Mapping[str, float]
"""Names with their probabilities; the probability that no name fits is 1 minus their sum."""


def candidate_ratios(
    description: RelationGraph,
    candidates: Sequence[Candidates | None],
    kinds: Kinds,
    outliers: float = CANDIDATE_OUTLIERS,
) -> NDArray[np.float64]:
    r"""Return log-likelihood ratios by candidates of n1 objects being each of n2 things, shape (n1, n2).

    Parameters
    ----------
    description
        The objects, by name and kind. A candidate names an object as a label does: by its name, its kind, or a
        narrower or broader kind.
    candidates
        Candidates of each thing; None, or an empty mapping, gives 0. A name that any thing has counts as taught.
    kinds
        The known kinds.
    outliers
        Share of things whose candidates are independent of their names, above 0.

    Returns
    -------
    ndarray
        Ratios in nats; 0 for things without candidates.

    Notes
    -----
    Let C be the number of taught names, u the prior of none of them, and w the share of outliers. The ratio of an
    object that the names in S name is log((1 - w) p(S) C / ((1 - u) \|S\|) + w); that of an object without a taught
    name is log((1 - w) p(none) / u + w).
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
            ratios[:, thing] = np.log((1 - outliers) * found / prior + outliers)
    return ratios
