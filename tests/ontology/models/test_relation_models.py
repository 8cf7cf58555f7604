"""Graded models as data: their constraints, and the round trip through triples."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

import pytest

from deixis.errors import OntologyError, UnknownTermError
from deixis.ontology.models.relation_triples import models_from_turtle, models_to_turtle
from deixis.ontology.models.relations import (
    FAMILIES,
    GRADED_FAMILIES,
    Provenance,
    RelationModel,
    RelationModels,
    Term,
    Trend,
)
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import default_ontology

TERM = Term("gap", (0.0, 0.5, 1.0), (0.0, -0.1, -2.0), Trend.FALLING)
MODEL = RelationModel("horizontal", (TERM, Term("alike", (0.0, 1.0), (-0.3, 0.0))), 0.01, 0.07)
LEARNED = replace(
    MODEL,
    provenance=Provenance(
        ("a.layout b.json", "c"), 12.5, datetime(2026, 11, 21, 12, 30, 1, 250000, tzinfo=UTC), "0.1.0"
    ),
)


TAUGHT = replace(LEARNED, provenance=replace(LEARNED.provenance, sources=(), lessons=("a b-1", "c-2"), strength=0.5))


@pytest.mark.parametrize("model", [MODEL, LEARNED, TAUGHT])
def test_a_model_comes_back_from_its_triples(model: RelationModel) -> None:
    (back,) = models_from_turtle(models_to_turtle([model]))
    assert replace(back, terms=()) == replace(model, terms=())
    assert sorted(back.terms, key=str) == sorted(model.terms, key=str)


def test_the_whole_vocabulary_of_a_model_is_in_the_tbox() -> None:
    turtle = models_to_turtle([LEARNED])
    for term in (DX.MODEL_NAME, DX.OUTLIER_RATE, DX.CHANCE_DEGREE, DX.KNOTS, DX.LOG_DEGREES, DX.TREND, DX.TERM_OF):
        assert "dx:" + term.rsplit("#")[-1] in turtle


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("0.0 0.5 1.0", "0.0 half 1.0", "must be numbers"),
        ("0.0 0.5 1.0", "0.5 0.0 1.0", "knots must increase"),
        ("0.0 -0.1 -2.0", "0.0 -0.1", "one value per knot"),
        ("0.0 -0.1 -2.0", "-2.0 -0.1 0.0", "must be falling"),
        ("0.0 -0.1 -2.0", "0.1 -0.1 -2.0", "at most 0"),
        ("0.0 -0.1 -2.0", "nan -0.1 -2.0", "must be finite"),
        ("dx:outlierRate", "dx:somethingElse", "must have exactly one"),
        ("dx:trend", "dx:somethingElse", "must have exactly one"),
        ("@prefix", "prefix prefix", "not valid Turtle"),
    ],
)
def test_incomplete_models_are_refused(old: str, new: str, message: str) -> None:
    turtle = models_to_turtle([MODEL])
    assert old in turtle
    with pytest.raises(OntologyError, match=message):
        models_from_turtle(turtle.replace(old, new))


def test_an_unknown_trend_is_refused() -> None:
    import re

    turtle = re.sub(r"dx:trend -?\d+", "dx:trend 5", models_to_turtle([MODEL]))
    with pytest.raises(OntologyError, match="a trend must be 1, 0 or -1, got 5"):
        models_from_turtle(turtle)


@pytest.mark.parametrize(("outliers", "chance"), [(0.0, 0.5), (1.0, 0.5), (0.1, 0.0), (0.1, 1.5)])
def test_shares_outside_of_their_range_are_refused(outliers: float, chance: float) -> None:
    with pytest.raises(OntologyError, match="between 0 and 1"):
        RelationModel("horizontal", (), outliers, chance)


def test_two_terms_for_one_feature_are_refused() -> None:
    with pytest.raises(OntologyError, match="two terms for one feature"):
        RelationModel("horizontal", (TERM, TERM), 0.01, 0.1)


def test_missing_models_are_refused() -> None:
    with pytest.raises(OntologyError, match="no graded model 'diagonal'"):
        RelationModels({"horizontal": MODEL})


def test_every_word_of_the_tbox_has_a_family() -> None:
    relations = default_ontology().relations
    assert {relation.word for relation in relations.values()} == {*FAMILIES, *GRADED_FAMILIES}


def test_an_inverse_shares_its_model() -> None:
    relations = default_ontology().relations
    family = RelationModels.family
    assert all(family(r.word) == family(relations[r.inverse].word) for r in relations.values())


def test_an_unknown_model_is_an_error() -> None:
    names = (*dict.fromkeys(FAMILIES.values()), "saying")
    models = RelationModels({name: replace(MODEL, name=name) for name in names})
    relation = replace(default_ontology().relations["left"], word="near")
    with pytest.raises(UnknownTermError, match="'near' has no graded model"):
        models.of(relation)
    with pytest.raises(UnknownTermError, match="no graded model 'nearness'"):
        models["nearness"]
