"""Learned sizes as data: the round trip through triples, and invalid triples."""

from __future__ import annotations

import math

import pyoxigraph as ox
import pytest

from deixis.errors import OntologyError
from deixis.ontology.models.sizes import SizeModel, size_triples, sizes_from_triples
from deixis.ontology.rdf.triples import iri, text, typed
from deixis.ontology.rdf.vocabulary import BASE, DX, PROV

PLATE, FORK = BASE + "DinnerPlate", BASE + "Fork"
MODEL = SizeModel((math.log(0.27), 0.1), (math.log(0.98), 0.05), False, 4.0)
RELATIVE = SizeModel((math.log(1.25), 0.2), (math.log(0.125), 0.3), True, 3.0)


def test_sizes_come_back_from_their_triples_to_six_digits() -> None:
    triples = [*size_triples(PLATE, MODEL, ["urn:a", "urn:b"]), *size_triples(FORK, RELATIVE, ["urn:a"])]
    found = sizes_from_triples(triples)
    assert list(found) == [PLATE, FORK]
    for kind, model in ((PLATE, MODEL), (FORK, RELATIVE)):
        assert found[kind].length == pytest.approx(model.length, abs=1e-5)
        assert found[kind].aspect == pytest.approx(model.aspect, abs=1e-5)
        assert (found[kind].relative, found[kind].views) == (model.relative, model.views)


def test_size_triples_are_in_metres_and_name_their_scenes() -> None:
    said = {(t.predicate.value, getattr(t.object, "value", "")) for t in size_triples(PLATE, MODEL, ["urn:a", "urn:b"])}
    assert {(str(DX.MEDIAN_LENGTH), "0.27"), (str(DX.MEDIAN_ASPECT), "0.98"), (str(DX.VIEW_COUNT), "4")} <= said
    assert {(str(PROV.WAS_DERIVED_FROM), "urn:a"), (str(PROV.WAS_DERIVED_FROM), "urn:b")} <= said


@pytest.mark.parametrize(
    ("predicate", "value", "message"),
    [
        (DX.MEDIAN_LENGTH, text("long"), "must be a number above 0, got 'long'"),
        (DX.LENGTH_DEVIATION, typed(0.0), "must be a number above 0, got '0.0'"),
        (DX.VIEW_COUNT, typed(math.inf), "must be a number above 0, got 'inf'"),
        (DX.MEDIAN_ASPECT, None, "must have exactly one"),
        (DX.OF_KIND, iri("urn:other"), "must have exactly one"),
    ],
)
def test_incomplete_sizes_are_refused(predicate: str, value: ox.Literal | None, message: str) -> None:
    triples = list(size_triples(PLATE, MODEL, []))
    if predicate != DX.OF_KIND:
        triples = [triple for triple in triples if triple.predicate.value != predicate]
    if value is not None:
        triples.append(ox.Triple(triples[0].subject, iri(predicate), value))
    with pytest.raises(OntologyError, match=message):
        sizes_from_triples(triples)
