"""From a contradiction to the fewest statements that it needs."""

from __future__ import annotations

import time
from collections.abc import Sequence

from deixis.reasoning.temporal.claims import Claim, disjunctions, network_of
from deixis.reasoning.temporal.errors import TemporalConflictError
from deixis.reasoning.temporal.explanation import Explanation
from deixis.reasoning.temporal.search import search


def minimal_conflict(claims: Sequence[Claim], proof: Explanation, deadline: float) -> TemporalConflictError:
    """The error for claims that a proof refutes, with every claim dropped that the contradiction does without.

    Only what the proof rests on is looked at. At the deadline (of ``time.monotonic``) dropping stops, and the error
    says that it may not be minimal.
    """
    stated = set(proof.stated())
    kept = [claim for claim in claims if stated & claim.leaves]
    minimal = True
    for claim in tuple(kept):
        rest = [other for other in kept if other is not claim]
        again = refuted(rest, deadline) if time.monotonic() < deadline else None
        if again is not None:
            kept, proof = rest, again
        elif time.monotonic() > deadline:  # it is not known whether the rest could hold
            minimal = False
            break
    whole = {leaf: claim.why for claim in kept for leaf in claim.leaves}
    return TemporalConflictError(proof, minimal, tuple(dict.fromkeys(whole[leaf] for leaf in proof.stated())))


def refuted(claims: Sequence[Claim], deadline: float) -> Explanation | None:
    """The proof that claims cannot all hold; None where they can, or where the deadline comes first."""
    network = network_of(dict.fromkeys(fluent for claim in claims for fluent in claim.fluents))
    for claim in claims:
        if network.try_add(claim.constraints) is None:
            return network.refutation(claim.constraints)
    return search(network, list(disjunctions(claims)), _nothing, deadline, explain=True).refutation


def _nothing() -> None:
    pass
