"""Learning what words mean: nothing without data, what was said with it, trends kept, confidence counted."""

from __future__ import annotations

import numpy as np
import pytest
from graded_words import relation_evidence
from scipy.optimize import check_grad

from deixis.errors import GraphError
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.models.relations import SAYING, RelationModels, Trend
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.grounding.evidence.facts.facts import fact_tables
from deixis.reasoning.grounding.evidence.words.degrees import saying_degree, word_degree
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.reasoning.grounding.fitting.fit import (
    FEW_SCENES,
    FitSettings,
    RelationFit,
    extended,
    fit_relations,
    learn_relations,
    take_out,
)
from deixis.reasoning.grounding.fitting.likelihood import Likelihood, SaidPairs, said_pairs
from deixis.reasoning.grounding.fitting.parameters import Layout

R = default_ontology().relations
PRIOR = shipped_models()


def alike_left(count: int, seed: int = 3) -> list[SaidPairs]:
    """Return scenes of six boxes in which 'left' is said about the two of the most similar sizes, side by side."""
    rng, lessons = np.random.default_rng(seed), []
    for _ in range(count):
        low, sides = rng.uniform(0, 10, (6, 2)), rng.uniform(0.1, 2.0, (6, 1))
        boxes = np.stack([low, low + sides], axis=1)
        graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b")])
        unlike = np.abs(pair_geometry(boxes).smaller) + 9 * (boxes[:, None, 1, 0] > boxes[None, :, 0, 0])
        np.fill_diagonal(unlike, 99)
        lessons.append(said_pairs(graph, boxes, divmod(int(np.argmin(unlike)), 6)))
    return lessons


def share_of_said(models: RelationModels, lessons: list[SaidPairs]) -> float:
    """Return how often the stated pair is the best of its scene."""
    hits = []
    for lesson in lessons:
        score = relation_evidence(lesson.pairs, R["left"], models) + np.log(saying_degree(lesson.pairs, models))
        np.fill_diagonal(score, -np.inf)
        hits.append(divmod(int(np.argmax(score)), 6) == tuple(lesson.ends[0].tolist()))
    return float(np.mean(hits))


def test_no_data_return_the_prior() -> None:
    assert learn_relations([], PRIOR) is PRIOR
    none = said_pairs(RelationGraph.from_facts(R, ["a"], []), np.zeros((1, 2, 2)), [0])
    assert learn_relations([none], PRIOR) is PRIOR


def test_a_fact_that_counts_nothing_teaches_nothing() -> None:
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b")])
    boxes = np.array([[[0, 0], [1, 1]], [[2, 0], [3, 1]]], dtype=float)
    assert learn_relations([said_pairs(graph, boxes, [0, 1], [0.0, 1.0])], PRIOR) is PRIOR


@pytest.mark.parametrize(("word", "model"), [("near", "nearness"), ("behind", "vertical"), ("inside", "containment")])
def test_every_graded_word_can_be_learned(word: str, model: str) -> None:
    """Fit a word to scenes in which it is said about two boxes that fit it less than five others."""
    rng, lessons = np.random.default_rng(4), []
    for _ in range(8):
        low = rng.uniform(0, 10, (5, 3))
        boxes = np.stack([low, low + rng.uniform(0.5, 2.0, (5, 3))], axis=1)
        pairs = pair_geometry(boxes)
        degrees = word_degree(pairs, word, PRIOR) - 9 * np.eye(5)
        ends = divmod(int(np.argsort(degrees, axis=None)[-6]), 5)
        lessons.append(said_pairs(RelationGraph.from_facts(R, "ab", [Fact("a", (R[word],), "b")]), boxes, ends))
    learned = learn_relations(lessons, PRIOR, FitSettings(0.1))

    def log_probability(models: RelationModels) -> float:
        """Return the mean log probability of the stated pair among all pairs of its scene."""
        found = []
        for one in lessons:
            score = relation_evidence(one.pairs, R[word], models) + np.log(saying_degree(one.pairs, models))
            np.fill_diagonal(score, -np.inf)
            found.append(score[tuple(one.ends[0])] - np.logaddexp.reduce(score, axis=None))
        return float(np.mean(found))

    assert {name for name in learned.models if learned[name] != PRIOR[name]} == {model, SAYING}
    assert log_probability(learned) > log_probability(PRIOR) + 0.1


def test_words_that_boxes_say_nothing_about_teach_nothing() -> None:
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["facing"],), "b")])
    boxes = np.array([[[0, 0], [1, 1]], [[2, 0], [3, 1]]], dtype=float)
    assert learn_relations([said_pairs(graph, boxes, [0, 1])], PRIOR) is PRIOR


def test_an_overwhelming_prior_stays() -> None:
    lessons = alike_left(5)
    learned = learn_relations(lessons, PRIOR, FitSettings(strength=1e7))
    for lesson in lessons:
        assert word_degree(lesson.pairs, "left", learned) == pytest.approx(
            word_degree(lesson.pairs, "left", PRIOR), abs=1e-3
        )


def test_what_was_said_is_learned_and_holds_of_other_scenes() -> None:
    learned = learn_relations(alike_left(60), PRIOR)
    unseen = alike_left(60, seed=4)
    assert share_of_said(learned, unseen) > share_of_said(PRIOR, unseen) + 0.2


def test_a_lesson_about_left_teaches_right_its_mirror_and_not_on() -> None:
    learned = learn_relations(alike_left(20), PRIOR)
    pairs = alike_left(1, seed=9)[0].pairs
    left, right = (relation_evidence(pairs, R[name], learned) for name in ("left", "right"))
    assert left == pytest.approx(right.T, abs=1e-9)
    assert learned["support"] == PRIOR["support"]
    assert learned["horizontal"] != PRIOR["horizontal"]


def test_trends_and_bounds_hold_of_what_is_learned() -> None:
    learned = learn_relations(alike_left(30), PRIOR)
    for name in ("horizontal", SAYING):
        for term in learned[name].terms:
            assert max(term.values) == 0.0
            assert np.all(np.diff(term.values) * term.trend >= -1e-9) or term.trend is Trend.FREE
    assert 0 < learned["horizontal"].outliers <= 0.2
    assert learned["horizontal"].provenance.examples == 30


def test_more_knots_change_no_degree() -> None:
    pairs = pair_geometry(alike_left(1)[0].pairs.boxes)
    finer = RelationModels({name: extended(model) for name, model in PRIOR.models.items()})
    for word in ("left", "top_right", "on"):
        assert word_degree(pairs, word, finer) == pytest.approx(word_degree(pairs, word, PRIOR), abs=1e-12)


@pytest.mark.parametrize("word_contrast", [0.0, 0.7])
def test_the_gradient_is_that_of_the_likelihood(word_contrast: float) -> None:
    layout = Layout([extended(PRIOR[name]) for name in ("horizontal", "vertical", SAYING)])
    likelihood = Likelihood(alike_left(2), layout, word_contrast)
    start = layout.prior + np.random.default_rng(0).normal(0, 0.1, len(layout.prior))
    wrong = check_grad(lambda v: likelihood(v)[0], lambda v: likelihood(v)[1], start)
    assert wrong < 1e-4


def test_learned_models_make_finite_tables() -> None:
    learned = learn_relations(alike_left(10), PRIOR, FitSettings(word_contrast=0.5))
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b")])
    assert np.isfinite(fact_tables(graph, np.zeros((3, 2, 2)), learned).tables).all()


def test_examples_of_a_grounding_weigh_by_confidence() -> None:
    left = (R["left"],)
    facts = [
        Fact("a", left, "b", weight=0.8),
        Fact("a", left, "c"),
        Fact("b", left, "a", positive=False),
        Fact("b", left, "a", optional=True),
        Fact("b", (R["left"], R["on"]), "a"),
    ]
    graph = RelationGraph.from_facts(R, ["a", "b", "c"], facts)
    lesson = said_pairs(graph, np.zeros((4, 2, 2)), [3, 1, None], [0.5, 0.9, 1.0])
    assert lesson.words == ("left",)
    assert lesson.ends.tolist() == [[3, 1]]
    assert lesson.weights.tolist() == pytest.approx([0.8 * 0.5 * 0.9])


@pytest.mark.parametrize(
    ("things", "confidence", "error", "message"),
    [
        ([0], None, GraphError, "2 objects"),
        ([0, 7], None, GraphError, "no box 7"),
        ([0, 1], [1.0, 1.5], SettingError, "`confidence` must be from 0 to 1"),
    ],
)
def test_lessons_that_cannot_be_are_refused(
    things: list[int | None], confidence: list[float] | None, error: type[Exception], message: str
) -> None:
    graph = RelationGraph.from_facts(R, ["a", "b"], [])
    with pytest.raises(error, match=message):
        said_pairs(graph, np.zeros((2, 2, 2)), things, confidence)


@pytest.mark.parametrize("wrong", [{"strength": 0.0}, {"strength": np.inf}, {"word_contrast": -1.0}, {"iterations": 0}])
def test_settings_that_cannot_be_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(SettingError, match=r"strength|word_contrast"):
        FitSettings(**wrong)  # type: ignore[arg-type]


def largest_change(one: RelationFit, other: RelationFit) -> float:
    """Return the largest difference between fitted values, and between log chance degrees."""
    assert one.statistics is not None
    assert other.statistics is not None
    apart = [np.abs(one.statistics.values - other.statistics.values).max()]
    chances = [(one.models[name].chance, other.models[name].chance) for name in one.statistics.names]
    apart.extend(abs(np.log(mine / its)) for mine, its in chances)
    return float(max(apart))


@pytest.mark.parametrize("gone", [1, 12])
def test_scenes_taken_out_leave_what_others_teach(gone: int) -> None:
    lessons, settings = alike_left(FEW_SCENES + 30), FitSettings(3.0)
    before = now = fit_relations(lessons, PRIOR, settings)
    for lesson in lessons[:gone]:
        assert now.statistics is not None
        found = take_out(now.statistics, lesson, PRIOR, settings)
        assert found is not None
        now = found
    anew = fit_relations(lessons[gone:], PRIOR, settings)
    assert largest_change(now, anew) < 0.1 * largest_change(before, anew)
    assert now.models["horizontal"].provenance.examples == len(lessons) - gone
    assert now.statistics is not None
    assert (now.statistics.scenes, now.statistics.fitted) == (len(lessons) - gone, len(lessons))


def test_few_scenes_are_fitted_again() -> None:
    lessons, settings = alike_left(FEW_SCENES + 1), FitSettings()
    statistics = fit_relations(lessons, PRIOR, settings).statistics
    assert statistics is not None
    assert take_out(statistics, lessons[0], PRIOR, settings) is None


def test_a_word_without_its_last_example_is_fitted_again() -> None:
    above = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["top"],), "b")])
    boxes = np.array([[[0, 2], [1, 3]], [[0, 0], [1, 1]], [[3, 0], [4, 1]]], dtype=float)
    only, settings = said_pairs(above, boxes, [0, 1]), FitSettings()
    statistics = fit_relations([only, *alike_left(FEW_SCENES + 10)], PRIOR, settings).statistics
    assert statistics is not None
    assert take_out(statistics, only, PRIOR, settings) is None
    assert take_out(statistics, alike_left(1)[0], PRIOR, settings) is not None


def test_the_information_is_the_slope_of_the_gradient() -> None:
    layout = Layout([extended(PRIOR[name]) for name in ("horizontal", SAYING)])
    likelihood = Likelihood(alike_left(4), layout, 0.0)
    rng = np.random.default_rng(0)
    values = np.minimum(layout.prior + rng.normal(0, 0.2, layout.prior.shape), 0.0)
    step = 1e-5 * rng.normal(size=values.shape)
    bent = likelihood(values - step)[1] - likelihood(values + step)[1]
    np.testing.assert_allclose(2 * likelihood.information(values) @ step, bent, rtol=1e-3, atol=1e-8)
