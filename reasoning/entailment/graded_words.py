"""Infer facts of graded words (*near*, *inside*, *bigger*) by the properties of their relations in the ontology.

A graded word has no complete meaning in orders of edges. From stated facts follow their inverses (*near* is its own),
the broader graded words (*leaning* is *against*, which is *touching*), and what a transitive word chains (*inside*).
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterable

from deixis.ontology.graph.facts import Fact
from deixis.ontology.relations.relation import Reading, Relation, Relations
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.entailment.derivations import Derivation

Known = dict[tuple[str, str, str], tuple[Derivation, tuple[int, ...]]]
"""Derivation of each fact and the edges that it rests on, by relation, subject and object."""

MAX_INFERRED = 1_000_000
"""Maximum number of facts of graded words; inference stops there, with the shortest derivations found."""


def facts_of_graded_words(vocabulary: Relations, stated: Iterable[tuple[int, Fact]]) -> Known:
    r"""Return all facts of graded words that follow from stated ones, breadth first.

    Parameters
    ----------
    vocabulary
        Relations of the ontology.
    stated
        Stated facts, each with its edge in the graph.

    Returns
    -------
    Known
        The facts with their derivations.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> said = [Fact("key", (r["inside"],), "box"), Fact("box", (r["inside"],), "bag")]
    >>> found = facts_of_graded_words(r, enumerate(said))
    >>> print(*found["inside", "key", "bag"][0].lines(), sep="\n")
    inside(key, bag)   by transitivity
        inside(key, box)   stated
        inside(box, bag)   stated
    """
    known: Known = {}
    waiting: deque[tuple[Relation, str, str]] = deque()
    after: dict[tuple[str, str], list[str]] = defaultdict(list)  # objects by relation and subject
    before: dict[tuple[str, str], list[str]] = defaultdict(list)

    def learn(relation: Relation, subject: str, thing: str, proof: Derivation, edges: tuple[int, ...]) -> None:
        key = (relation.name, subject, thing)
        if subject != thing and key not in known and len(known) < MAX_INFERRED:
            known[key] = proof, tuple(dict.fromkeys(edges))
            waiting.append((relation, subject, thing))

    for edge, fact in stated:
        if fact.plain and fact.relations[0].reading is Reading.GRADED:
            learn(fact.relations[0], fact.subject, fact.object, Proof(fact, Rule.STATED, source=fact.source), (edge,))
    while waiting:
        relation, subject, thing = waiting.popleft()
        proof, edges = known[relation.name, subject, thing]
        inverse = vocabulary[relation.inverse]
        learn(inverse, thing, subject, Proof(Fact(thing, (inverse,), subject), Rule.INVERSE, (proof,)), edges)
        for name in sorted(relation.broader):
            broader = vocabulary[name]
            if broader.reading is Reading.GRADED:
                widened = Fact(subject, (broader,), thing)
                learn(broader, subject, thing, Proof(widened, Rule.SUB_PROPERTY, (proof,)), edges)
        if relation.transitive:
            for last in tuple(after[relation.name, thing]):
                more, rest = known[relation.name, thing, last]
                chained = Proof(Fact(subject, (relation,), last), Rule.TRANSITIVITY, (proof, more))
                learn(relation, subject, last, chained, edges + rest)
            for first in tuple(before[relation.name, subject]):
                less, rest = known[relation.name, first, subject]
                chained = Proof(Fact(first, (relation,), thing), Rule.TRANSITIVITY, (less, proof))
                learn(relation, first, thing, chained, rest + edges)
            after[relation.name, subject].append(thing)
            before[relation.name, thing].append(subject)
    return known
