"""Measure how much grounding recovers from the shipped scripts, over generated place settings."""

from __future__ import annotations

from dataclasses import replace

import pytest

import deixis
from deixis.examples_data import example
from deixis.experiments.generated_tables import neighbours
from deixis.experiments.place_settings import formal_setting
from deixis.learning.lessons.scene_evidence import evidence_of
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Reading
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.evidence.properties.unary import UnaryWeights
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.reasoning.grounding.matching.search.exact import exact

ABSENT = {"red_wine_glass", "white_wine_glass", "champagne_glass"}


@pytest.mark.parametrize("seed", [None, *range(8)])
def test_the_full_script_names_all_twelve(seed: int | None) -> None:
    scene = formal_setting(seed, displacement=0.01)
    found = deixis.ground(example("formal_dinner.layout"), scene.without_labels())
    assert {name: match.perceived for name, match in found.matches.items()} == {id: id for id in scene.ids}
    assert sum((match.probability or 0.0) >= 0.975 for match in found.matches.values()) >= 10
    assert not found.violated
    assert found.proved_best


@pytest.mark.parametrize("number", range(11))
def test_one_wrong_fact_does_not_change_the_twelve_names(number: int) -> None:
    scene, script = formal_setting(), deixis.read_script(example("formal_dinner.layout"))
    evidence = evidence_of(script, scene.without_labels())
    said, relations = evidence.description, evidence.description.vocabulary
    facts = list(said.facts())
    (relation,) = facts[number].relations
    literal = next(r for r in relations.of_reading(Reading.EXACT) if r.word == relation.word)
    wrong = relations.wide(list(relations.values())[neighbours(literal.index, relations)[0]])
    facts[number] = replace(facts[number], relations=(wrong,))
    description = RelationGraph.from_facts(relations, said.nodes, facts, said.kinds)
    found = exact(replace(evidence, description=description).problem)
    assert [scene.ids[thing] for thing in found.assignment] == list(said.nodes)
    held = evidence.degrees(found.assignment) > 0
    assert held.all()  # of the facts stated before


@pytest.mark.parametrize("scene", [deixis.read_scene(example("place_setting.scene.json")), formal_setting()])
def test_script2_drops_exactly_the_absent_glasses(scene: Scene) -> None:
    found = deixis.ground(example("script2.layout"), scene.without_labels())
    assert {left.name for left in found.unmatched_objects} == ABSENT
    assert found.proved_best


def test_sizes_settle_the_matches_that_script1_leaves_open() -> None:
    scene = formal_setting()
    found = deixis.ground(example("script1.layout"), scene.without_labels())
    assert {name: match.perceived for name, match in found.matches.items()} == {id: id for id in scene.ids}
    assert found.interchangeable == ()


def test_script1_leaves_exactly_three_groups() -> None:
    words_alone = Meaning(weights=UnaryWeights(sizes=0.0))
    found = deixis.ground(example("script1.layout"), formal_setting().without_labels(), meaning=words_alone)
    assert {frozenset(group) for group in found.interchangeable} == {
        frozenset({"salad_fork", "dinner_fork"}),
        frozenset({"dessert_fork", "dessert_spoon"}),
        frozenset({"dinner_knife", "water_glass"}),
    }
    for group in found.interchangeable:
        assert not any(found.matches[name].decided for name in group)
