"""Content of the picture of a relation word's meaning."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from deixis.ontology.models.relations import Provenance
from deixis.ontology.tbox import default_ontology
from deixis.plots.relation import REFERENCE, SUBJECT, field, relation_figure
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models

RELATIONS = default_ontology().relations


def test_a_field_holds_the_degree_of_a_lone_object_at_each_place() -> None:
    places, degrees = field(RELATIONS["top_left"], shipped_models(), 7)
    half = np.full(2, SUBJECT / 2)
    for row, column in ((4, 2), (5, 1), (0, 6)):
        centre = places[[column, row]]
        pair = pair_geometry(np.array([[centre - half, centre + half], REFERENCE]))
        assert degrees[row, column] == WordDegrees(pair, shipped_models()).of(RELATIONS["top_left"])[0, 1]


@pytest.mark.parametrize(("word", "least"), [("on", 0.04), ("under", 0.04), ("left", 0.04)])
def test_a_good_part_of_the_field_shows_where_the_word_holds(word: str, least: float) -> None:
    _, degrees = field(RELATIONS[word], shipped_models(), 41)
    assert (degrees > 0.25).mean() > least


def test_a_learned_meaning_is_marked_and_the_shipped_one_too() -> None:
    models = shipped_models()
    learned = replace(models["horizontal"], provenance=Provenance(examples=2.0, made=datetime(2026, 1, 1, tzinfo=UTC)))
    pictures = [relation_figure(RELATIONS["left"], one, 9) for one in (models, models.replaced(learned))]
    titles = [picture.axes[0].get_title(loc="left") for picture in pictures]
    assert titles == [
        "Degree to which 'left of' holds (shipped model)",
        "Degree to which 'left of' holds (learned from 2 facts)",
    ]


def test_the_scale_is_as_high_as_the_field() -> None:
    figure = relation_figure(RELATIONS["left"], shipped_models(), 9)
    figure.draw_without_rendering()
    frame = figure.axes[0].get_window_extent()
    (scale,) = figure.axes[0].child_axes
    assert (scale.get_window_extent().y0, scale.get_window_extent().y1) == pytest.approx((frame.y0, frame.y1))
