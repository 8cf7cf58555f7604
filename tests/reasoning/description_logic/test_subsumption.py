"""Subsumption of lessons without a reasoner's process: entailments, unsatisfiable classes and refusals."""

from __future__ import annotations

import random

import pyoxigraph as ox
import pytest

from deixis.learning.inference.inferred_graph import everything_by_hermit, everything_that_follows, origin
from deixis.memory.semantic.rdf.after import After
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.memory.semantic.rdf.package import packaged_quads
from deixis.ontology.rdf.triples import iri, skolem
from deixis.ontology.rdf.vocabulary import BASE, DX, W3C
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.description_logic.subsumption import (
    NOTHING,
    BeyondLessonsError,
    ClassAxioms,
    PropertyEnds,
    Subsumption,
)
from deixis.reasoning.errors import InconsistencyError

ONTOLOGY = default_ontology()
OWL = "http://www.w3.org/2002/07/owl#"


def told(**classes: str | tuple[str, str]) -> dict[str, ClassAxioms]:
    return {
        name: ClassAxioms(frozenset([said]) if isinstance(said, str) else frozenset(),
                        frozenset() if isinstance(said, str) else frozenset([said]))
        for name, said in classes.items()
    }  # fmt: skip


def subsumption(said: dict[str, ClassAxioms], **ends: PropertyEnds) -> Subsumption:
    disjoint = [frozenset({"fork", "knife"})]
    return Subsumption(lambda name: said.get(name, ClassAxioms()), lambda p: ends.get(p, PropertyEnds()), disjoint)


def test_super_classes_are_followed_through_cycles_and_domains() -> None:
    found = subsumption(told(a="b", b="a", table=("shows", "fork")), shows=PropertyEnds(frozenset({"scene"})))
    assert found.broader("a") == {"b"}
    assert found.broader("table") == {"scene"}


@pytest.mark.parametrize(
    ("said", "possible"),
    [
        ({"x": ClassAxioms(frozenset({"fork", "knife"}))}, False),
        ({"x": ClassAxioms(frozenset({"fork", "cutlery"}))}, True),
        ({"x": ClassAxioms(frozenset({NOTHING}))}, False),
        (
            {"x": ClassAxioms(shows=frozenset({("shows", "both")})), "both": ClassAxioms(frozenset({"fork", "knife"}))},
            False,
        ),
        ({"x": ClassAxioms(shows=frozenset({("holds", "knife")}))}, False),
        ({"x": ClassAxioms(shows=frozenset({("shows", "knife")}))}, True),
    ],
)
def test_disjoint_super_classes_or_shown_classes_are_impossible(said: dict[str, ClassAxioms], possible: bool) -> None:
    found = subsumption(said, holds=PropertyEnds(ranges=frozenset({"fork"})))
    assert found.satisfiable("x") is possible


def test_axioms_beyond_lessons_are_refused() -> None:
    nested = told(x=("shows", "y"), y=("shows", "fork"))
    with pytest.raises(BeyondLessonsError):
        subsumption(nested).satisfiable("x")
    with pytest.raises(BeyondLessonsError):
        subsumption(told(x=("shows", "fork")), shows=PropertyEnds(functional=True)).satisfiable("x")


def memory_of(rng: random.Random, most: int = 1) -> ox.Store:
    """Return a store of the ontology and learned classes: categories of at most ``most`` kinds, and layouts."""
    store, learned = ox.Store(), graph_iri(GraphName.LEARNED)
    store.bulk_extend(packaged_quads())
    kinds = [kind.iri for kind in ONTOLOGY.kinds]
    names = [f"https://w3id.org/deixis/learned/category/c{number}" for number in range(8)]

    def say(subject: str, predicate: str, object: str) -> None:
        store.add(ox.Quad(iri(subject), iri(predicate), iri(object), learned))

    for place, name in enumerate(names):
        say(name, W3C.RDF_TYPE, W3C.OWL_CLASS)
        for kind in rng.choices([*kinds, *names[:place]], k=rng.choice([1, 1, 1, most])):
            say(name, W3C.RDFS_SUB_CLASS_OF, kind)
    for number in range(3):
        layout, restriction = f"https://w3id.org/deixis/learned/layout/l{number}", skolem(f"r{number}").value
        say(layout, W3C.RDF_TYPE, W3C.OWL_CLASS)
        say(layout, W3C.RDFS_SUB_CLASS_OF, DX.LAYOUT)
        say(layout, W3C.RDFS_SUB_CLASS_OF, restriction)
        say(restriction, W3C.RDF_TYPE, W3C.OWL_RESTRICTION)
        say(restriction, W3C.OWL_ON_PROPERTY, DX.SHOWS)
        say(restriction, W3C.OWL_SOME_VALUES_FROM, rng.choice([*kinds, *names, BASE + "Scene"] if most > 1 else names))
    return store


@pytest.mark.slow
def test_hermit_agrees_on_generated_lessons() -> None:
    outcomes = set()
    for seed in range(8):
        after = After(memory_of(random.Random(seed), 1 + seed % 2))
        said: list[object] = []
        for work in (everything_that_follows, everything_by_hermit):
            try:
                found = work(after, ONTOLOGY.relations)
                said.append({t for t in found if t.predicate.value == W3C.RDFS_SUB_CLASS_OF} - set(origin()))
            except InconsistencyError as error:
                said.append(str(error))
        assert said[0] == said[1], seed
        outcomes.add(type(said[0]))
    assert outcomes == {set, str}  # some memories are possible, and some are not


def test_axioms_beyond_lessons_are_left_to_hermit() -> None:
    store = memory_of(random.Random(0))
    fork = iri(BASE + "Fork")
    store.add(ox.Quad(fork, iri(OWL + "equivalentClass"), iri("urn:gabel"), graph_iri(GraphName.ONTOLOGY)))
    with pytest.raises(BeyondLessonsError):
        everything_that_follows(After(store), ONTOLOGY.relations)
