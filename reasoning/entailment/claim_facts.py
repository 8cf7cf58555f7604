"""Facts that claims imply: the pairs of a row, of a superlative, of an arrangement, and of what is between two others.

A claim has no place in the closure of relations between pairs. The facts that it implies do have one: they are added to
the stated facts, with the claim's place in the script, so that derivations and conflicts name it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

from deixis.ontology.graph.claims import EACH_OTHER, ROW_ORDERS, Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Relation, Relations
from deixis.reasoning.entailment.implications import TIME_LIMIT, Implications

COMPARATIVES = {
    "largest": "bigger",
    "smallest": "smaller",
    "tallest": "taller",
    "shortest": "shorter",
    "longest": "longer",
    "widest": "wider",
    "narrowest": "narrower",
    "leftmost": "left",
    "rightmost": "right",
}
"""Relation of what has a superlative to each of the others."""

RANKS = {"1 from left": "left", "-1 from right": "left", "1 from right": "right", "-1 from left": "right"}
"""Relation of what has an extreme rank to each of the others."""

AXES = ("left", "right", "top", "bottom")
"""Relations that, if they hold between two things, also hold for a thing between the two."""


@dataclass(frozen=True, slots=True)
class ClaimFact:
    """A fact that a claim implies; of *between*, together with the fact ``given`` about the two others."""

    fact: Fact
    claim: Claim
    given: Fact | None = None


def facts_of_claims(
    claims: Sequence[Claim],
    nodes: Sequence[str],
    vocabulary: Relations,
    holds: Callable[[Relation, str, str], bool] | None = None,
) -> tuple[ClaimFact, ...]:
    """Return the facts that firm claims imply, each once, with the place of its claim.

    Parameters
    ----------
    claims
        The claims of a script; those that are denied, optional or hedged imply nothing.
    nodes
        Names of all objects, which a superlative without objects compares with.
    vocabulary
        The relations.
    holds
        Whether a relation between two objects follows from the facts; *between* implies nothing without it.

    Returns
    -------
    tuple of ClaimFact
        Facts in the order of the claims. If two claims imply the same fact, only the first of them is named.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> row = Claim("row", ("plate", "bowl", "mug"), value="left to right")
    >>> [str(entry.fact) for entry in facts_of_claims([row], [], default_ontology().relations)]
    ['left(plate, bowl)', 'left(bowl, mug)']
    """
    found: dict[tuple[str, str, str], ClaimFact] = {}
    for claim in claims:
        if not claim.positive or claim.optional or claim.weight < 1:
            continue
        for subject, word, thing, given in _pairs(claim, nodes, vocabulary, holds):
            if subject == thing or word not in vocabulary:
                continue
            fact = Fact(subject, (vocabulary[word],), thing, source=claim.source)
            found.setdefault((subject, word, thing), ClaimFact(fact, claim, given))
    return tuple(found.values())


def _pairs(
    claim: Claim,
    nodes: Sequence[str],
    vocabulary: Relations,
    holds: Callable[[Relation, str, str], bool] | None,
) -> Iterator[tuple[str, str, str, Fact | None]]:
    term, subjects, others = claim.relation, claim.subjects, claim.arguments
    if term == "row" and claim.value in ROW_ORDERS:
        yield from ((first, ROW_ORDERS[claim.value], second, None) for first, second in pairwise(subjects))
    elif term in EACH_OTHER:
        yield from ((first, EACH_OTHER[term], second, None) for first, second in combinations(subjects, 2))
    elif term in COMPARATIVES and claim.value is None:
        rest = others or [name for name in nodes if name not in subjects]
        yield from ((subject, COMPARATIVES[term], other, None) for subject in subjects for other in rest)
    elif term == "ordinal" and claim.value in RANKS:
        rest = others or [name for name in nodes if name not in subjects]
        yield from ((subject, RANKS[claim.value], other, None) for subject in subjects for other in rest)
    elif term == "between" and len(others) == 2 and holds is not None:
        first, second = others
        for word in AXES:
            if holds(vocabulary[word], first, second):
                given = Fact(first, (vocabulary[word],), second)
                for subject in subjects:
                    yield first, word, subject, given
                    yield subject, word, second, given


def with_facts_of_claims(graph: RelationGraph, found: Sequence[ClaimFact]) -> RelationGraph:
    """Return the graph with further edges for the facts of claims, after its own.

    Parameters
    ----------
    graph
        Graph of the stated facts.
    found
        Facts that claims imply, between nodes of the graph.

    Returns
    -------
    RelationGraph
        Graph with the same nodes, kinds and colours. Its edges are those of ``graph``, then one for each fact in
        ``found``.
    """
    facts = [*graph.facts(), *(entry.fact for entry in found)]
    return RelationGraph.from_facts(graph.vocabulary, graph.nodes, facts, kinds=graph.kinds, colours=graph.colours)


def implications_with_claims(
    graph: RelationGraph, claims: Sequence[Claim], time_limit: float = TIME_LIMIT
) -> tuple[tuple[ClaimFact, ...], tuple[Implications, ...]]:
    """Return what follows from facts and claims together.

    What *between* implies depends on what follows from the other facts, so it is added to them until nothing is new.

    Parameters
    ----------
    graph
        Graph of the stated facts.
    claims
        The claims.
    time_limit
        Time limit in seconds for deciding choices in the facts.

    Returns
    -------
    tuple
        Facts that the claims imply without being stated, and implications: the last ones have all of these facts, the
        ones before only some of those that *between* adds.
    """
    stated = {str(fact) for fact in graph.facts() if not fact.optional and fact.weight >= 1}
    found = facts_of_claims(claims, graph.nodes, graph.vocabulary)
    found = tuple(entry for entry in found if str(entry.fact) not in stated)
    implied = [Implications(with_facts_of_claims(graph, found) if found else graph, time_limit)]
    while implied[-1].consistent and any(claim.relation == "between" for claim in claims):
        more = facts_of_claims(claims, graph.nodes, graph.vocabulary, implied[-1].holds)
        known = stated | {str(entry.fact) for entry in found}
        more = tuple(
            entry
            for entry in more
            if str(entry.fact) not in known
            and not implied[-1].holds(entry.fact.relations[0], entry.fact.subject, entry.fact.object)
        )
        if not more:
            break
        found += more
        implied.append(Implications(with_facts_of_claims(graph, found), time_limit))
    return found, tuple(implied)
