"""Check that no photograph is grounded by its own data."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.experiments.cross_validation import folds, learned_meanings
from deixis.experiments.photographs import Photograph
from deixis.experiments.scoreboard.cases import PHOTOGRAPHS, Case, Setting
from deixis.experiments.scoreboard.contestants import ablations
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.evidence.properties.labels import category_of
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED
from deixis.reasoning.grounding.fitting.fit import FitSettings

RELATIONS = default_ontology().relations
QUICK = FitSettings(iterations=2)
NAMES = ("dog_0", "chair_1", "lamp_2", "dog_3")


def photograph(seed: int, chair: float) -> Photograph:
    """Return a chair of some size right of a dog, and two other things."""
    facts = [Fact("dog_0", (RELATIONS["left"],), "chair_1"), Fact("lamp_2", (RELATIONS["top"],), "dog_3")]
    low = np.random.default_rng(seed).uniform(0, 100, (4, 2))
    sizes = np.array([[10.0, 10.0], [chair, chair], [10.0, 20.0], [10.0, 10.0]])
    return Photograph(RelationGraph.from_facts(RELATIONS, NAMES, facts), np.stack([low, low + sizes], axis=1))


def test_every_number_is_in_one_fold() -> None:
    found = folds(10, 3, seed=1)
    assert sorted(np.concatenate(found).tolist()) == list(range(10))
    assert sorted(map(len, found)) == [3, 3, 4]


def test_a_photograph_is_not_in_its_own_training_fold() -> None:
    images = [photograph(seed, 40.0) for seed in range(3)]
    before = learned_meanings(images, 1, 3, QUICK)
    after = learned_meanings([photograph(9, 400.0), *images[1:]], 1, 3, QUICK)
    chair = category_of("chair")
    terms = [one.models and one.models["horizontal"].terms for one in (before[0], after[0], before[1], after[1])]
    assert terms[0] == terms[1] and terms[2] != terms[3]
    assert before[0].sizes == after[0].sizes
    assert before[1].sizes[chair] != after[1].sizes[chair]
    assert before[0].sizes[category_of("dog")].views == 4
    assert before[0].sizes[chair].length[0] > before[0].sizes[category_of("dog")].length[0] + 0.5


def test_learned_meanings_are_used_only_by_learning_contestants() -> None:
    image = photograph(0, 40.0)
    (learned, *_) = learned_meanings([photograph(seed, 40.0) for seed in range(3)], 1, 3, QUICK)
    case, other = (
        Case(Setting(PHOTOGRAPHS, 0, 0, False), 0, *image, tuple("abcd"), np.arange(4), metric=False, learned=one)
        for one in (learned, None)
    )
    sizes = case.evidence(SHIPPED, learned=True).sizes
    assert sizes[1].argmax() == 1 and not case.evidence(SHIPPED).sizes.any()
    entered = {one.name: (one.enters(case), one.enters(other)) for one in ablations()}
    assert entered["learned, all"] == entered["learned words"] == (True, False)
    assert entered["exact"] == (True, True)
    (words,) = (one for one in ablations() if one.name == "learned words")
    assert case.evidence(words.meaning, words.learned).meaning.models is learned.models
    assert case.evidence(words.meaning, words.learned).sizes == pytest.approx(np.zeros((4, 4)))
