"""Learned models in a memory: replaced as a whole, validated, exported, imported, and independent of single lessons."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pyoxigraph as ox
import pytest

from deixis.memory.errors import RejectedWriteError
from deixis.memory.semantic.exchange import export_memory, import_dump
from deixis.memory.semantic.rdf.graphs import GraphName, ModelSet
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.models.relation_triples import model_triples, models_from_triples
from deixis.ontology.models.relations import Provenance, RelationModel, Term
from deixis.ontology.models.sizes import SizeModel, size_triples, sizes_from_triples
from deixis.ontology.rdf.vocabulary import DX

MADE = Provenance((), 3.0, datetime(2026, 11, 21, tzinfo=UTC), "0.1.0", ("dinner-1",), 1.0)
MODEL = RelationModel("horizontal", (Term("gap", (0.0, 1.0), (0.0, -1.5e-7)),), 0.01, 0.07, MADE)
NEWER = replace(MODEL, outliers=0.02, provenance=replace(MADE, lessons=("dinner-2",)))
S1 = "https://w3id.org/deixis/learned/scene/s1"
SIZE = list(size_triples(DX.THING, SizeModel((math.log(0.2), 0.1), (-0.5, 0.1), False, 3.0), [S1]))


def words(memory: SemanticMemory) -> tuple[RelationModel, ...]:
    return models_from_triples(memory.triples(GraphName.LEARNED))


def keep(memory: SemanticMemory, model: RelationModel) -> None:
    memory.keep_models({ModelSet.WORDS: list(model_triples(model))})


def test_newer_models_replace_older_ones_completely(taught: SemanticMemory) -> None:
    before = export_memory(taught)
    keep(taught, MODEL)
    assert words(taught) == (MODEL,)
    keep(taught, NEWER)
    assert words(taught) == (NEWER,)
    assert models_from_triples(taught.models(ModelSet.WORDS)) == (NEWER,)
    taught.keep_models({ModelSet.WORDS: []})
    assert export_memory(taught) == before


def test_words_and_sizes_are_replaced_each_by_itself(taught: SemanticMemory) -> None:
    taught.keep_models({ModelSet.WORDS: list(model_triples(MODEL)), ModelSet.SIZES: SIZE})
    taught.keep_models({ModelSet.SIZES: []})
    assert words(taught) == (MODEL,)
    assert taught.stats().relation_models == 1
    assert taught.stats().size_models == 0


def test_forgetting_a_lesson_keeps_the_given_models(taught: SemanticMemory) -> None:
    taught.keep_models({ModelSet.WORDS: list(model_triples(MODEL)), ModelSet.SIZES: SIZE})
    taught.forget("dinner-2", [], {ModelSet.WORDS: list(model_triples(NEWER))})
    assert words(taught) == (NEWER,)
    assert list(sizes_from_triples(taught.triples(GraphName.LEARNED))) == [DX.THING]


def test_a_model_is_found_by_a_query_once(taught: SemanticMemory) -> None:
    keep(taught, MODEL)
    asked = taught.query("SELECT ?name ?rate { ?m a dx:RelationModel ; dx:modelName ?name ; dx:outlierRate ?rate }")
    assert len(asked.rows) == 1


@pytest.mark.parametrize(
    ("predicate", "value", "message"),
    [
        (DX.OUTLIER_RATE, "'2.0'^^xsd:double", "one dx:outlierRate"),
        (DX.MODEL_NAME, "'diagonally'", "one dx:modelName"),
        (DX.KNOTS, "'0.0 one'", "one dx:knots"),
        (DX.TREND, "7", "one dx:trend"),
        (DX.MEDIAN_LENGTH, "'-0.1'^^xsd:double", "one dx:medianLength"),
        (DX.VIEW_COUNT, "0", "one dx:viewCount"),
    ],
)
def test_the_shapes_guard_models(
    memory: SemanticMemory, read: Callable[[str], list[ox.Triple]], predicate: str, value: str, message: str
) -> None:
    scene = read("<L/scene/s1> a dx:Scene ; dx:frame 'table' ; dx:unit 'm' ; dx:seenFrom <L/viewpoint/v> .")
    viewpoint = read("<L/viewpoint/v> a dx:Viewpoint ; rdfs:label 'v' .")
    memory.learn("s", {GraphName.ASSERTED: [*scene, *viewpoint]}, [])
    good = [*model_triples(MODEL), *SIZE]
    memory.keep_models({ModelSet.WORDS: good})
    (literal,) = (triple.object for triple in read(f"<urn:x> <urn:y> {value} ."))
    bad = [ox.Triple(t.subject, t.predicate, literal) if t.predicate.value == predicate else t for t in good]
    assert bad != good
    with pytest.raises(RejectedWriteError) as error:
        memory.keep_models({ModelSet.WORDS: bad})
    assert message in str(error.value.results)
    assert set(memory.models(ModelSet.WORDS)) == set(memory.triples(GraphName.LEARNED))


def test_models_come_back_from_an_export_the_same(taught: SemanticMemory, tmp_path: Path) -> None:
    taught.keep_models({ModelSet.WORDS: list(model_triples(MODEL)), ModelSet.SIZES: SIZE})
    file = tmp_path / "all.trig"
    file.write_text(export_memory(taught), encoding="utf-8")
    import_dump(file, tmp_path / "new")
    with SemanticMemory.open(tmp_path / "new") as other:
        assert export_memory(other) == file.read_text(encoding="utf-8")
        assert words(other) == (MODEL,)


def test_an_import_keeps_models_and_adds_missing_ones(
    taught: SemanticMemory, tmp_path: Path, learn: Callable[..., None]
) -> None:
    taught.keep_models({ModelSet.WORDS: list(model_triples(MODEL)), ModelSet.SIZES: SIZE})
    file = tmp_path / "all.trig"
    file.write_text(export_memory(taught), encoding="utf-8")
    with SemanticMemory.open(tmp_path / "other", create=True) as other:
        learn(other, "dinner-1")
        keep(other, NEWER)
    import_dump(file, tmp_path / "other")
    with SemanticMemory.open(tmp_path / "other") as other:
        assert words(other) == (NEWER,)
        assert list(sizes_from_triples(other.models(ModelSet.SIZES))) == [DX.THING]
        assert other.lessons() == ("dinner-1", "dinner-2")
