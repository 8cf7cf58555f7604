"""Degrees of the words beside the ten."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.grammar.layout.parser import parse_script
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.evidence.words.meaning import CHANCE, shipped_models
from deixis.reasoning.grounding.fitting.fit import chance_degree, random_scenes
from deixis.workflows.grounding.ground import ground

R = default_ontology().relations
GRADED = R.of_reading(Reading.GRADED)


def box(x: float, y: float, width: float, depth: float, low: float = 0.0, high: float = 0.1) -> list[list[float]]:
    return [[x, y, low], [x + width, y + depth, high]]


TABLE = np.array(
    [
        box(0.0, 0.0, 0.2, 0.2, high=0.1),  # 0 bowl
        box(0.05, 0.05, 0.02, 0.1, low=0.03, high=0.08),  # 1 whisk, inside it
        box(0.21, 0.0, 0.02, 0.2, high=0.01),  # 2 knife beside it
        box(0.9, 0.8, 0.1, 0.1, high=0.3),  # 3 bottle, far away
        box(0.21, 0.4, 0.02, 0.2, high=0.01),  # 4 fork
    ]
)


@pytest.mark.parametrize(
    ("word", "subject", "thing", "holds"),
    [
        ("inside", 1, 0, True),
        ("inside", 2, 0, False),
        ("containing", 0, 1, True),
        ("next_to", 2, 0, True),
        ("next_to", 3, 0, False),
        ("far", 3, 0, True),
        ("far", 2, 0, False),
        ("taller", 3, 0, True),
        ("shorter", 3, 0, False),
        ("bigger", 0, 1, True),
        ("parallel", 2, 4, True),
        ("behind", 4, 2, True),
        ("in_front", 4, 2, False),
        ("aligned", 4, 2, True),
    ],
)
def test_words_hold_of_plain_cases(word: str, subject: int, thing: int, holds: bool) -> None:
    degree = WordDegrees(pair_geometry(TABLE), shipped_models()).of(R[word])[subject, thing]
    assert (degree >= 0.5) == holds


def test_an_inverse_has_the_degrees_of_the_reversed_pair() -> None:
    words = WordDegrees(pair_geometry(TABLE), shipped_models())
    for relation in GRADED:
        degrees = words.of(relation)
        np.testing.assert_allclose(degrees, words.of(R[relation.inverse]).T, atol=1e-12)
        assert (degrees > 0).all()
        assert (degrees <= 1).all()


def test_chances_are_those_of_random_boxes() -> None:
    scenes = [pair_geometry(boxes) for boxes in random_scenes()]
    models = shipped_models()
    assert {name: round(chance_degree(models[name], scenes), 3) for name in CHANCE} == CHANCE


def test_a_graded_word_tells_things_apart() -> None:
    places = {"o1": (0.0, 0.0), "o2": (0.15, 0.0), "o3": (0.9, 0.7)}
    things = [{"id": id, "min": [x, y], "max": [x + 0.1, y + 0.1]} for id, (x, y) in places.items()]
    found = ground(parse_script("a near b; a left of b; c far from a; c behind b"), {"objects": things})
    assert {name: match.perceived for name, match in found.matches.items()} == {"a": "o1", "b": "o2", "c": "o3"}
    assert not found.violated
