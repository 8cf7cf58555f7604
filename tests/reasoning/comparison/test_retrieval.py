"""Similarity of scenes and layouts, and ranking many of them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.experiments.place_settings import formal_setting
from deixis.grammar.layout.parser import parse_script
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.comparison.likeness import (
    Closeness,
    ComparedScene,
    Comparison,
    Described,
    Likeness,
    compared_scene,
)
from deixis.reasoning.comparison.retrieval import assignment_bound, quick_bound, rank_layouts, rank_scenes
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.grounding.evidence.properties.labels import category_of
from deixis.reasoning.grounding.matching.problem import UNMATCHED

ONTOLOGY = default_ontology()
RELATIONS = ONTOLOGY.relations
WORDS = ("dinner plate", "dinner fork", "dinner knife", "water glass", "napkin")
COMPARISON = Comparison(ONTOLOGY)


def layout(text: str, name: str = "layout") -> Described:
    return Described(name, parse_script(text).graph())


def table(seed: int, n: int, name: str = "scene", labelled: bool = True) -> SceneRelations:
    """Return a scene of n boxes in the unit square, of random kinds."""
    rng = np.random.default_rng(seed)
    low = rng.uniform(0, 1, (n, 2))
    boxes = np.stack([low, low + rng.uniform(0.02, 0.3, (n, 2))], axis=1)
    kinds = [kind.iri for word in rng.choice(WORDS, n) if (kind := ONTOLOGY.kinds.of_word(str(word)))]
    return scene_relations([f"{name}{i}" for i in range(n)], boxes, RELATIONS, kinds if labelled else ())


def script(seed: int, n: int, facts: int) -> Described:
    """Return a few random facts of a table, in the wide reading."""
    rng, graph = np.random.default_rng(seed), table(seed, n).graph()
    chosen = rng.permutation(len(graph))[:facts]
    wide = [
        type(fact)(fact.subject, (RELATIONS.wide(fact.relations[0]),), fact.object)
        for fact in (graph.fact(int(edge)) for edge in chosen)
    ]
    return Described(f"script{seed:03}", RelationGraph.from_facts(RELATIONS, graph.nodes, wide, kinds=graph.kinds))


def likeness(description: Described, scene: SceneRelations) -> Likeness:
    return COMPARISON.likeness(description, compared_scene("scene", scene))


@given(st.integers(0, 10**6), st.integers(1, 6))
@settings(max_examples=25, deadline=None)
def test_a_scene_has_similarity_one_to_its_own_layout(seed: int, n: int) -> None:
    graph = table(seed, n)
    assert likeness(Described("itself", graph.graph()), graph).similarity == pytest.approx(1.0, abs=1e-5)
    few = script(seed, n, n)
    assert likeness(few, graph).similarity == pytest.approx(1.0, abs=1e-5)


@given(st.integers(0, 10**6), st.integers(2, 5), st.integers(2, 5))
@settings(max_examples=40, deadline=None)
def test_the_similarity_of_two_scenes_is_symmetric(seed: int, n: int, m: int) -> None:
    one, other = table(seed, n, "a"), table(seed + 1, m, "b")
    there, back = likeness(Described("one", one.graph()), other), likeness(Described("other", other.graph()), one)
    assert there.similarity == pytest.approx(back.similarity, abs=1e-5)


@given(st.integers(0, 10**6), st.integers(1, 4), st.integers(0, 4), st.integers(0, 8))
@settings(max_examples=40, deadline=None)
def test_the_similarity_is_the_maximum_and_below_its_bounds(seed: int, n1: int, n2: int, facts: int) -> None:
    description, scene = script(seed, n1, facts), table(seed + 7, n2, labelled=seed % 2 == 0)
    ready = compared_scene("scene", scene)
    problem = COMPARISON.problem(description, ready)
    values = [0.0]
    for choice in product(range(UNMATCHED, n2), repeat=n1):
        things = [p for p in choice if p != UNMATCHED]
        if len(set(things)) == len(things):
            values.append(problem.value(np.array(choice)))
    found = COMPARISON.likeness(description, ready)
    assert found.similarity == pytest.approx(max(values), abs=1e-5)
    assert 0 <= found.similarity <= 1
    assert quick_bound(COMPARISON, description, ready) >= found.similarity - 1e-5
    assert assignment_bound(COMPARISON, description, ready) >= found.similarity - 1e-5


def test_missing_and_extra_objects_lower_the_similarity() -> None:
    graph, full = table(3, 5), Described("five", table(3, 5).graph())
    fewer = graph.reordered(np.arange(4))
    whole, missing = likeness(full, graph).similarity, likeness(full, fewer).similarity
    extra = likeness(Described("four", fewer.graph()), graph).similarity
    assert missing < whole
    assert extra < whole
    assert missing == pytest.approx(extra, abs=1e-5)


def test_the_similarity_with_a_missing_object_by_hand() -> None:
    """Compare three objects and two facts with a scene of two of the objects, where one of the facts can hold."""
    description = layout("dinner_fork left of dinner_plate; dinner_knife right of dinner_plate")
    boxes = np.array([[[0.0, 0.0], [0.02, 0.2]], [[0.1, 0.0], [0.37, 0.27]]])
    kinds = [kind.iri for word in ("dinner fork", "dinner plate") if (kind := ONTOLOGY.kinds.of_word(word))]
    found = likeness(description, scene_relations(["o1", "o2"], boxes, RELATIONS, kinds))
    assert found.objects == pytest.approx(2 * 2 / (3 + 2))
    assert found.relations == pytest.approx(2 * 1 / (2 + 2))
    assert found.similarity == pytest.approx((2 * 0.8 + 0.5) / 3, abs=1e-6)


@pytest.mark.parametrize(
    ("said", "name", "expected"),
    [
        ("exactly_left", "exactly_left", 1.0),
        ("exactly_left", "exactly_top_left", 0.5),
        ("exactly_left", "exactly_top", 0.25),
        ("exactly_left", "exactly_right", 0.25),
        ("exactly_top_left", "exactly_bottom_right", 0.0625),
        ("exactly_left", "exactly_on", 0.25),
        ("left", "exactly_top_left", 1.0),
        ("left", "exactly_top", 0.5),
        ("left", "exactly_right", 0.25),
    ],
)
def test_the_closeness_of_relations_is_that_of_their_tiles(said: str, name: str, expected: float) -> None:
    assert Closeness(RELATIONS)(RELATIONS[said].bit, True)[RELATIONS[name].index] == expected


def test_a_denied_relation_corresponds_to_all_others() -> None:
    close = Closeness(RELATIONS)(RELATIONS["left"].bit, False)
    assert close[RELATIONS["exactly_right"].index] == 1.0
    assert close[RELATIONS["exactly_top_left"].index] == 0.5
    assert close[RELATIONS["exactly_left"].index] == 0.25


def test_rare_facts_favour_the_opposite_arrangement() -> None:
    right, left = ([[x, 0.1], [x + 0.08, 0.18]] for x in (0.5, -0.3))
    scenes = [
        scene_relations(["o1", "o2"], np.array([[[0.0, 0.0], [0.27, 0.27]], glass]), RELATIONS)
        for glass in (right, left)
    ]
    opposite, said = (likeness(layout("rarely water_glass left of dinner_plate"), scene).similarity for scene in scenes)
    assert opposite > said


def test_neighbouring_arrangements_beat_opposite_ones() -> None:
    description = layout("water_glass left of dinner_plate")
    plate = [[0.0, 0.0], [0.27, 0.27]]

    def with_glass(x: float, y: float) -> float:
        boxes = np.array([plate, [[x, y], [x + 0.08, y + 0.08]]])
        return likeness(description, scene_relations(["o1", "o2"], boxes, RELATIONS)).similarity

    assert with_glass(-0.2, 0.1) == with_glass(-0.2, 0.5) > with_glass(0.1, 0.5) > with_glass(0.5, 0.1) - 1e-9


def test_sizes_count_for_unlabelled_objects() -> None:
    scene = formal_setting().without_labels().relations(RELATIONS)
    plates = likeness(layout("3 dinner_plate left of bread_plate"), scene)
    setting = likeness(
        layout("dinner_fork left of dinner_plate; dinner_plate left of dinner_knife; napkin on dinner_plate"), scene
    )
    assert plates.objects < setting.objects


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("glimp florb_1", 1.0),
        ("Florb glimp_7", 1.0),
        ("glimp quux", 0.5),
        ("gasket flange", 0.0),
    ],
)
def test_unknown_words_correspond_only_to_themselves(words: str, expected: float) -> None:
    boxes = np.array([[[0, 0], [0.1, 0.1]], [[0.2, 0], [0.3, 0.1]]])
    scene = scene_relations(["p", "q"], boxes, RELATIONS, [category_of(word) for word in words.split()])
    assert likeness(layout("glimp left of florb_2"), scene).objects == expected


def test_a_known_kind_is_not_similar_to_an_unknown_word() -> None:
    fork = ONTOLOGY.kinds.words["fork"].iri
    boxes = np.array([[[0, 0], [0.02, 0.2]], [[0.2, 0], [0.22, 0.2]]])
    scene = scene_relations(["p", "q"], boxes, RELATIONS, [category_of("gasket"), fork])
    assert likeness(layout("fork left of fork_2"), scene).objects == 0.5
    assert likeness(layout("gasket is a fork; fork left of gasket"), scene).objects == 1


def in_pixels(scale: float, metric: bool = False) -> ComparedScene:
    """Return the formal setting without labels, in pixels of an image from above."""
    scene = formal_setting().without_labels().relations(RELATIONS)
    assert scene.boxes is not None
    return compared_scene("image", replace(scene, boxes=scene.boxes[:, :, :2] * scale), metric=metric)


def test_sizes_in_pixels_are_compared_at_any_scale() -> None:
    plates = layout("9 dinner_plate left of dinner_fork; dinner_fork left of dinner_knife")
    setting = layout("dinner_fork left of dinner_plate; dinner_plate left of dinner_knife; napkin on dinner_plate")
    told = {scale: [COMPARISON.likeness(one, in_pixels(scale)) for one in (plates, setting)] for scale in (10.0, 900.0)}
    for one, other in zip(*told.values(), strict=True):
        assert one.similarity == pytest.approx(other.similarity, abs=1e-5)
    without = COMPARISON.likeness(plates, replace(in_pixels(900.0), boxes=None))
    assert told[900.0][0].objects < without.objects
    assert told[900.0][1].objects == COMPARISON.likeness(setting, replace(in_pixels(900.0), boxes=None)).objects


def test_sizes_learned_from_images_count_in_pixels() -> None:
    plate = layout("layout x; dinner_plate is a dinner plate")
    kind = str(plate.graph.kinds[0])
    scene = scene_relations(
        ["a", "b", "c"], np.array([[[0, 0], [9, 9]], [[20, 0], [21, 1]], [[30, 0], [31, 1]]]), RELATIONS
    )
    likely = {
        length: Comparison(ONTOLOGY, {kind: SizeModel((np.log(length), 0.1), (0.0, 0.1), True)})
        for length in (9.0, 100.0)
    }
    unary = {
        length: one.objects(plate, compared_scene("image", scene, metric=False))[0] for length, one in likely.items()
    }
    assert unary[9.0][0] == 1 > unary[9.0][1:].max()
    assert unary[100.0].max() < 0.01


def test_an_empty_scene_has_similarity_zero() -> None:
    found = likeness(layout("fork left of plate"), table(1, 0))
    assert (found.similarity, found.assignment.tolist()) == (0.0, [-1, -1])


@pytest.mark.parametrize("top", [1, 3, 30])
def test_ranks_equal_those_of_comparing_all_pairs(top: int) -> None:
    layouts = [script(seed, 4 + seed % 3, 6) for seed in range(12)]
    scenes = [compared_scene(f"scene{seed:03}", table(seed, 3 + seed % 4)) for seed in range(12)]
    rng = np.random.default_rng(2)
    for scene in scenes[:4]:
        every = sorted(
            (COMPARISON.likeness(one, scene) for one in layouts), key=lambda one: (-one.similarity, one.layout)
        )
        for order in (range(12), rng.permutation(12)):
            found = rank_layouts(scene, [layouts[k] for k in order], COMPARISON, top)
            assert [(one.layout, one.similarity) for one in found] == [
                (one.layout, one.similarity) for one in every[:top]
            ]
    every = sorted(
        (COMPARISON.likeness(layouts[0], one) for one in scenes), key=lambda one: (-one.similarity, one.scene)
    )
    found = rank_scenes(layouts[0], scenes[::-1], COMPARISON, top)
    assert [one.scene for one in found] == [one.scene for one in every[:top]]


def test_most_pairs_are_excluded_by_their_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    compared = []
    plain = Comparison.likeness

    def counted(self: Comparison, *args: Any) -> Likeness:
        compared.append(args)
        return plain(self, *args)

    monkeypatch.setattr(Comparison, "likeness", counted)
    layouts = [script(seed, 6, 9) for seed in range(30)]
    found = rank_layouts(compared_scene("scene", table(5, 6)), layouts, COMPARISON, top=1)
    assert found[0].layout == "script005"
    assert len(compared) < 15


def test_a_top_of_zero_is_refused() -> None:
    with pytest.raises(SettingError, match="`top` must be at least 1, got 0"):
        rank_layouts(compared_scene("scene", table(1, 2)), [], COMPARISON, top=0)


def test_a_learned_size_replaces_the_usual_one_unless_relative() -> None:
    scene = scene_relations(["a"], np.array([[[0.0, 0.0], [0.9, 0.45]]]), RELATIONS)
    plate = layout("layout x; dinner_plate is a dinner plate")
    kind = plate.graph.kinds[0]
    large = SizeModel((np.log(0.9), 0.1), (np.log(0.5), 0.1))
    found = {
        name: Comparison(ONTOLOGY, {str(kind): model}).likeness(plate, compared_scene("scene", scene)).objects
        for name, model in (("metres", large), ("relative", replace(large, relative=True)))
    }
    assert found["metres"] == 1
    assert found["relative"] == COMPARISON.likeness(plate, compared_scene("scene", scene)).objects < 0.5
