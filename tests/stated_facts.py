"""Facts at random, and what they imply."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from hypothesis import strategies as st
from rdflib import OWL, RDF, RDFS, Graph, URIRef

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading, Relation
from deixis.ontology.tbox import default_ontology, tbox_turtle
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus
from deixis.reasoning.qualitative.calculi.registry import calculus

MakeGraph = Callable[..., RelationGraph]
Triple = tuple[str, str, str]
NODES = "abcde"
R = default_ontology().relations
ORDERED = [r for r in R.values() if r.reading is not Reading.GRADED]  # words that order edges
facts = st.lists(
    st.tuples(st.sampled_from([r.name for r in ORDERED]), st.sampled_from(NODES), st.sampled_from(NODES)).filter(
        lambda t: t[1] != t[2]
    ),
    max_size=7,
)


@cache
def axioms() -> tuple[dict[str, set[str]], dict[str, str], set[str]]:
    """Direct super-properties, inverses and transitive properties, by relation name, read with rdflib."""
    tbox = Graph().parse(data=tbox_turtle(), format="turtle")
    by_iri = {relation.iri: relation.name for relation in R.values()}

    def name(node: object) -> str:
        return by_iri[str(node)]

    relations = [URIRef(relation.iri) for relation in ORDERED]
    broader = {name(p): {name(q) for q in tbox.objects(p, RDFS.subPropertyOf) if str(q) in by_iri} for p in relations}
    inverse = {name(p): name(q) for p, q in tbox.subject_objects(OWL.inverseOf) if str(p) in by_iri}
    transitive = {name(p) for p in tbox.subjects(RDF.type, OWL.TransitiveProperty)}
    return broader, inverse, transitive


def implications(stated: list[Triple]) -> Implications:
    listed = [Fact(s, (R[r],), o) for r, s, o in stated]
    return Implications(RelationGraph.from_facts(R, list(NODES), listed))


FLAT = [r for r in ORDERED if not r.z_atoms]


def some_facts(names: str, words: list[Relation]) -> st.SearchStrategy[list[Fact]]:
    """Return facts of every kind: plain, with a choice, denied, hedged."""
    pairs = st.tuples(st.sampled_from(names), st.sampled_from(names)).filter(lambda p: p[0] != p[1])
    relations = st.lists(st.sampled_from(words), min_size=1, max_size=3, unique=True).map(tuple)
    fact = st.builds(
        lambda ends, relations, positive, weight: Fact(ends[0], relations, ends[1], positive=positive, weight=weight),
        pairs,
        relations,
        st.sampled_from([True, True, True, False]),
        st.sampled_from([1.0, 1.0, 1.0, 0.8]),
    )
    return st.lists(fact, max_size=6)


BA = calculus("ba")
assert isinstance(BA, ProductCalculus)


def atoms(relation: Relation) -> int:
    """Convert a relation to a set of atoms of the block algebra."""
    assert isinstance(BA, ProductCalculus)
    return BA.of_axes([relation.x_atoms, relation.y_atoms, relation.z_atoms or (1 << 13) - 1])
