"""The index over triples, compared with a scan of all triples."""

from __future__ import annotations

import pyoxigraph as ox
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.errors import OntologyError
from deixis.ontology.rdf.triple_index import TermIndex, TripleIndex

numbers = st.integers(0, 3)
TURTLE = """
@prefix : <urn:> .
:fork :on :table ; :name "fork", "fork"@en, "salad fork" ; :part [ :on :table ] .
:table :in :room . :room :in :house . :house :in :room .
"""


@given(st.lists(st.tuples(numbers, numbers, numbers)))
def test_terms_are_found_from_both_ends(triples: list[tuple[int, int, int]]) -> None:
    index = TermIndex[int]()
    for triple in triples:
        index.add(*triple)
    for one in range(4):
        for other in range(4):
            assert set(index.objects(one, other)) == {o for s, p, o in triples if (s, p) == (one, other)}
            assert set(index.subjects(one, other)) == {s for s, p, o in triples if (p, o) == (one, other)}


@pytest.fixture
def index() -> TripleIndex:
    return TripleIndex(ox.parse(TURTLE, format=ox.RdfFormat.TURTLE))


def test_values_are_plain_sorted_and_unique(index: TripleIndex) -> None:
    assert index.values("urn:fork", "urn:name") == ["fork", "salad fork"]
    assert index.value("urn:fork", "urn:name") == "fork"
    assert index.value("urn:fork", "urn:colour") is None
    assert index.only("urn:fork", "urn:on") == "urn:table"
    part = index.only("urn:fork", "urn:part")
    assert index.subjects("urn:on", "urn:table") == sorted(["urn:fork", part])


@pytest.mark.parametrize(("predicate", "number"), [("urn:name", 2), ("urn:colour", 0)])
def test_only_refuses_none_or_several_values(index: TripleIndex, predicate: str, number: int) -> None:
    with pytest.raises(OntologyError, match=rf"<urn:fork> must have exactly one <{predicate}>, got {number}"):
        index.only("urn:fork", predicate)


def test_ancestors_leave_out_the_start_of_a_cycle(index: TripleIndex) -> None:
    assert index.ancestors("urn:table", "urn:in") == {"urn:room", "urn:house"}
    assert index.ancestors("urn:room", "urn:in") == {"urn:house"}
    assert index.ancestors("urn:fork", "urn:in") == frozenset()
