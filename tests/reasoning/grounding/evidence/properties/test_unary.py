"""Evidence of labels and sizes for matches."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.evidence.properties.labels import Label
from deixis.reasoning.grounding.evidence.properties.unary import (
    OUTLIERS,
    UnaryWeights,
    label_ratios,
    log_sizes,
    size_evidence,
    too_high,
)
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.reasoning.grounding.fitting.sizes import learn_size, pooled_prior

ONTOLOGY = default_ontology()
R, KINDS, SIZES = ONTOLOGY.relations, ONTOLOGY.kinds, ONTOLOGY.sizes
SPOON, PLATE, FORK = (
    kind.iri for word in ("soup spoon", "dinner plate", "dinner fork") if (kind := KINDS.of_word(word))
)
TABLE = np.array([[[0.0, 0.0], [0.04, 0.18]], [[0.1, 0.0], [0.37, 0.27]], [[0.5, 0.0], [0.5, 0.0]]])
TWO = RelationGraph.from_facts(R, ["soup_spoon", "dinner_plate"], [], kinds=[SPOON, PLATE])


def learned_from(*views: tuple[np.ndarray, int], relative: bool = False) -> SizeModel:
    sizes = np.array([log_sizes(boxes, relative)[thing] for boxes, thing in views])
    return learn_size(sizes, pooled_prior([sizes]), relative)


def test_much_higher_thing_is_not_a_fork() -> None:
    def things(height: float) -> np.ndarray:
        return np.array([[[0.0, 0.0, 0.0], [0.03, 0.195, height]], [[0.1, 0.0, 0.0], [0.37, 0.27, 0.02]]])

    flat = size_evidence([FORK, PLATE], things(0.02)[..., :2], SIZES)
    assert np.array_equal(size_evidence([FORK, PLATE], things(0.02), SIZES), flat)
    high = size_evidence([FORK, PLATE], things(0.2), SIZES)
    assert high[0, 0] == pytest.approx(np.log(OUTLIERS)) and flat[0, 0] > 0
    assert np.array_equal(high[:, 1], flat[:, 1])
    assert not too_high(["https://example.org/unheard"], things(9.0), SIZES).any()
    assert not too_high([FORK], things(9.0), SIZES, {FORK: SizeModel((0.0, 1.0), (0.0, 1.0))}).any()


def test_a_soup_spoon_is_not_a_plate() -> None:
    found = size_evidence([SPOON, PLATE], TABLE, SIZES)
    assert found.argmax(axis=1).tolist() == [0, 1]
    assert found[0, 1] < 0 < found[0, 0] and found[1, 0] < 0 < found[1, 1]


def test_sizes_are_finite_of_points_and_never_rule_out() -> None:
    found = size_evidence([SPOON, PLATE], TABLE, SIZES)
    assert np.isfinite(found).all()
    assert found.min() >= np.log(0.05) - 1e-9


def test_size_evidence_is_at_most_log_of_the_things() -> None:
    found = size_evidence([SPOON, PLATE], TABLE, SIZES)
    assert found.max() <= np.log(len(TABLE)) + 1e-9


def test_where_all_things_are_alike_sizes_say_nothing() -> None:
    alike = np.stack([TABLE[0] + 0.3 * i for i in range(4)])
    (found,) = size_evidence([SPOON], alike, SIZES)
    assert found == pytest.approx(np.full(4, found[0]))
    assert abs(found[0]) < 0.5


def test_only_stated_or_learned_sizes_are_evidence() -> None:
    thing = DX.THING.value
    unheard = "https://example.org/unheard"
    assert (size_evidence([thing, unheard], TABLE, SIZES) == 0).all()
    learned = {unheard: learned_from((TABLE, 1))}
    assert size_evidence([unheard], TABLE, SIZES, learned).argmax() == 1


@pytest.mark.parametrize("degrees", [0, 10, 25, 45, 80])
def test_a_fork_at_any_angle_is_a_fork_before_it_is_a_plate(degrees: int) -> None:
    long, wide, angle = 0.19, 0.025, np.radians(degrees)
    box = [long * np.cos(angle) + wide * np.sin(angle), long * np.sin(angle) + wide * np.cos(angle)]
    fork = np.array([[[0.0, 0.0], box], TABLE[1] + 0.5, [[1.0, 1.0], [1.07, 1.07]]])
    (found,) = size_evidence([FORK], fork, SIZES)
    assert found[0] > found[1:].max() + 1


def test_heights_are_not_part_of_the_plan() -> None:
    upright = np.concatenate([TABLE, np.array([[[0.0], [0.03]]] * 3)], axis=2)
    assert size_evidence([SPOON, PLATE], upright, SIZES) == pytest.approx(size_evidence([SPOON, PLATE], TABLE, SIZES))


def test_a_spoon_lies_as_well_across() -> None:
    turned = TABLE[:, :, ::-1]
    assert size_evidence([SPOON], turned, SIZES) == pytest.approx(size_evidence([SPOON], TABLE, SIZES))


def test_sizes_in_metres_give_ratios_in_pixels() -> None:
    found = size_evidence([SPOON, PLATE], TABLE[:2] * 900, SIZES, metric=False)
    assert found.argmax(axis=1).tolist() == [0, 1] and found.min() < 0
    assert found == pytest.approx(size_evidence([SPOON, PLATE], TABLE[:2] * 7, SIZES, metric=False))
    sure = size_evidence([SPOON, PLATE], TABLE[:2], SIZES)
    assert found[0, 0] - found[0, 1] < sure[0, 0] - sure[0, 1]


def test_in_an_image_a_person_stands_and_is_not_a_car() -> None:
    person, car = (kind.iri for word in ("person", "car") if (kind := KINDS.of_word(word)))
    photograph = np.array([[[0.0, 0.0], [60.0, 170.0]], [[100.0, 0.0], [520.0, 150.0]]])
    found = size_evidence([car, person], photograph, SIZES, metric=False)
    assert found.argmax(axis=1).tolist() == [1, 0] and found.min() < 0


def test_image_from_above_where_that_fits_the_whole_table() -> None:
    plate, glass = (kind.iri for word in ("dinner plate", "wine glass") if (kind := KINDS.of_word(word)))
    round_things = np.array([[[0.0, 0.0], [81.0, 81.0]], [[100.0, 0.0], [124.0, 24.0]]] * 2)
    upright = np.array([[[0.0, 0.0], [81.0, 8.0]], [[100.0, 0.0], [124.0, 63.0]]] * 2)
    for scene in (round_things, upright):
        found = size_evidence([plate, glass], scene, SIZES, metric=False)
        assert (found[0, [0, 2]].min() > found[0, [1, 3]].max()) and (found[1, [1, 3]].min() > found[1, [0, 2]].max())


def test_relative_sizes_know_no_scale() -> None:
    relative = {SPOON: learned_from((TABLE[:2], 0), (TABLE[:2] * 3, 0), relative=True)}
    here, there = (size_evidence([SPOON], TABLE[:2] * f, SIZES, relative, metric=False) for f in (1, 900))
    assert here == pytest.approx(there)
    assert here[0, 0] > 0 > here[0, 1]


def test_a_learned_range_replaces_the_shipped_one() -> None:
    learned = learned_from(*((TABLE * f, 0) for f in (0.48, 0.5, 0.52, 0.5)))
    small = TABLE * 0.5
    assert size_evidence([SPOON], small, SIZES, {SPOON: learned})[0, 0] > size_evidence([SPOON], small, SIZES)[0, 0]


def test_label_ratios_compare_with_undescribed_things() -> None:
    labels = [Label("soup spoon", 0.8), None, Label("dinner plate", 1.0)]
    found = label_ratios(TWO, labels, KINDS, error=0.01)
    world = 1 / len(KINDS)
    right, wrong = 0.8 * 0.99, (1 - 0.8 * 0.99) * (1 / 2 + world) / 2
    by_chance = right * world + wrong
    assert np.exp(found.ratios[:, 0]) == pytest.approx([(right + wrong) / by_chance, wrong / by_chance])
    assert found.ratios[:, 1].tolist() == [0.0, 0.0]
    assert found.ratios[1, 2] > found.ratios[0, 0] > 1 and found.ratios[0, 2] < 0
    assert found.allowed.all()


def test_labels_free_of_error_rule_out_what_they_do_not_name() -> None:
    found = label_ratios(TWO, [Label("dinner plate"), Label("soup spoon", 0.8)], KINDS, error=0.0)
    assert found.allowed.tolist() == [[False, True], [True, True]]
    assert np.isfinite(found.ratios).all()


def test_a_broader_word_says_less_than_the_very_kind() -> None:
    words = ("dinner plate", "plate", "tableware")
    said = [label_ratios(TWO, [Label(word)], KINDS).ratios[1, 0] for word in words]
    assert said[0] > said[1] > said[2] > 0


def test_a_name_that_is_not_a_kind_says_more_than_a_kind() -> None:
    named = RelationGraph.from_facts(R, ["thingamajig", "dinner_plate"], [], kinds=[None, PLATE])
    found = label_ratios(named, [Label("thingamajig"), Label("dinner plate")], KINDS).ratios
    assert found[0, 0] > found[1, 1] > 4


def test_a_label_of_no_confidence_says_nothing() -> None:
    found = label_ratios(TWO, [Label("soup spoon", 0.0)], KINDS)
    assert found.ratios == pytest.approx(np.zeros((2, 1))) and found.allowed.all()


def test_all_evidence_adds_up_with_its_weights() -> None:
    labels = [Label("soup spoon", 0.8), None, None]
    seen = scene_relations(["a", "b", "c"], TABLE, R)
    both = evidence_from(TWO, seen, labels, KINDS, SIZES).unary
    sizes = size_evidence([SPOON, PLATE], TABLE, SIZES)
    assert both == pytest.approx(label_ratios(TWO, labels, KINDS).ratios + sizes)
    half = UnaryWeights(labels=0.0, sizes=0.5)
    certain = [Label("dinner plate", 1.0), None, None]
    assert evidence_from(TWO, seen, certain, KINDS, SIZES, meaning=Meaning(weights=half)).unary == pytest.approx(
        sizes / 2
    )


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(SettingError, match="at least 0"):
        UnaryWeights(labels=-1.0)
    with pytest.raises(SettingError, match="finite"):
        UnaryWeights(sizes=np.nan)
