"""Check that the paper's facts hold of generated place settings, and that seeds reproduce them."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.experiments.place_settings import formal_setting
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene

R = default_ontology().relations

FIGURE_7 = [
    ("right", "water_glass", "dinner_plate"),
    ("on", "napkin", "dinner_plate"),
    ("top_left", "bread_plate", "dinner_plate"),
    ("on", "butter_knife", "bread_plate"),
    ("left", "salad_fork", "dinner_plate"),
    ("left", "dinner_fork", "dinner_plate"),
    ("top", "dessert_fork", "dinner_plate"),
    ("top", "dessert_spoon", "dinner_plate"),
    ("right", "dinner_knife", "dinner_plate"),
    ("right", "fish_knife", "dinner_plate"),
    ("right", "soup_spoon", "fish_knife"),
]

NEIGHBOURS = [
    ("left", "salad_fork", "dinner_fork"),
    ("left", "dinner_fork", "dinner_plate"),
    ("left", "dinner_plate", "dinner_knife"),
    ("left", "dinner_knife", "fish_knife"),
    ("left", "fish_knife", "soup_spoon"),
    ("top", "dessert_spoon", "dessert_fork"),
    ("top", "water_glass", "dinner_knife"),
]


def held(scene: Scene) -> set[tuple[str, str, str]]:
    """Return every word that holds of a pair, at least in the wide reading."""
    found = set()
    for fact in scene.graph(R).facts():
        (exact,) = fact.relations
        found |= {(word, fact.subject, fact.object) for word in exact.broader}
    return found


def test_the_standard_setting_has_twelve_labelled_things() -> None:
    scene = formal_setting()
    assert len(scene.objects) == 12
    assert all(thing.label == thing.id and thing.confidence == 1 for thing in scene.objects)
    assert set(scene.ids) == {name for _, s, o in FIGURE_7 for name in (s, o)}


@pytest.mark.parametrize("fact", FIGURE_7 + NEIGHBOURS)
def test_facts_of_a_formal_setting_hold_of_the_standard_one(fact: tuple[str, str, str]) -> None:
    assert fact in held(formal_setting())


@pytest.mark.parametrize("seed", range(10))
def test_facts_about_neighbours_hold_of_every_setting(seed: int) -> None:
    assert set(NEIGHBOURS) - held(formal_setting(seed)) == set()


def test_a_setting_depends_on_its_seed_alone() -> None:
    assert formal_setting(4, 0.02) == formal_setting(4, 0.02)
    assert formal_setting(4, 0.02) != formal_setting(5, 0.02)
    assert formal_setting(4) != formal_setting()


def test_the_standard_setting_does_not_move() -> None:
    assert formal_setting() == formal_setting(None, displacement=0.5)


@pytest.mark.parametrize("seed", range(5))
def test_displacement_is_limited_and_moves_supported_things_too(seed: int) -> None:
    before, after = formal_setting(seed), formal_setting(seed, displacement=0.03)
    shift = {name: np.array(after[name].minimum) - np.array(before[name].minimum) for name in before.ids}
    assert all(np.abs(by).max() <= 0.03 + 2e-4 for by in shift.values())
    assert any(np.abs(by).max() > 0.005 for by in shift.values())
    for borne, bearer in (("napkin", "dinner_plate"), ("butter_knife", "bread_plate")):
        np.testing.assert_allclose(shift[borne], shift[bearer], atol=2e-4)
        assert ("on", borne, bearer) in held(after)


@pytest.mark.parametrize("seed", range(5))
def test_sizes_vary_by_no_more_than_a_tenth(seed: int) -> None:
    standard, varied = formal_setting(), formal_setting(seed)
    for name in standard.ids:
        sizes = [np.array(s[name].maximum) - np.array(s[name].minimum) for s in (standard, varied)]
        np.testing.assert_allclose(sizes[1], sizes[0], rtol=0.11, atol=4e-4)
