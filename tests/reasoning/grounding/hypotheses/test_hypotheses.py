"""One posterior over maps, over the sides from which a description may speak, and over other scenes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import maps
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence, Whole, evidence_from, no_unary_evidence
from deixis.reasoning.grounding.evidence.properties.labels import Label
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.hypotheses import hypotheses
from deixis.reasoning.grounding.hypotheses.hypotheses import (
    ANOTHER_PRIOR,
    AS_IT_STANDS,
    CHANCE_EXCESS,
    CHANCE_SHARE,
    FACTS_POWER,
    KINDS_POWER,
    KINDS_SLACK,
    STATED_SIDES,
    Side,
    Verdict,
    weigh,
)
from deixis.reasoning.grounding.matching.posterior.coincidences import discounted
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

MakeGraph = Callable[..., RelationGraph]
ONTOLOGY = default_ontology()
R = ONTOLOGY.relations
WORDS = ("left", "right", "top", "bottom", "top_left", "on")
UNLIKELY_SIDES = 7e-3
"""Mass of sides that are each so unlikely that their maps are not listed."""


def seen(boxes: NDArray[np.float64], said: RelationGraph, labels: list[Label | None] | None = None) -> Evidence:
    scene = scene_relations([f"o{p:02}" for p in range(len(boxes))], boxes, R)
    return evidence_from(said, scene, labels or [None] * len(boxes), ONTOLOGY.kinds, ONTOLOGY.sizes)


def weighed(evidence: Evidence) -> Verdict:
    found = engine_named("exact").align(evidence, Deadline.never()).verdict
    assert isinstance(found, Verdict)
    return found


def summed(problem: Problem) -> tuple[float, NDArray[np.float64]]:
    """Return the log sum over all maps, and the marginals, by listing every map."""
    options = list(maps(problem.allowed))
    values = np.array([problem.value(option) for option in options])
    total = float(np.logaddexp.reduce(values))
    marginals = np.zeros((len(problem.absent), problem.unary.shape[1] + 1))
    for value, option in zip(values, options, strict=True):
        marginals[np.arange(len(option)), option] += math.exp(value - total)
    return total, marginals


def bare(problem: Problem, unary: bool = True) -> Problem:
    return Problem(
        problem.ends[:0],
        problem.kinds[:0],
        problem.tables[:0],
        problem.unary if unary else np.zeros_like(problem.unary),
        problem.absent,
        problem.allowed if unary else np.ones_like(problem.allowed),
    )


def by_enumeration(evidence: Evidence) -> tuple[float, NDArray[np.float64]]:
    """``fits`` and the marginals, as the module says what they are."""
    alone, nothing = (
        float(np.logaddexp.reduce([weight + summed(bare(one.problem))[0] for weight, one in evidence.label_readings])),
        summed(bare(evidence.problem, unary=False))[0],
    )
    problem = evidence.problem
    most = sum(float(problem.tables[kind].max(initial=0.0)) for kind in problem.kinds)
    shares = np.array([bare(problem).value(option) for option in maps(problem.allowed)])
    shares -= np.logaddexp.reduce(shares)
    most = max(0.0, most + float((np.exp(shares) * shares).sum()))
    chance = most + CHANCE_EXCESS * math.sqrt(most)

    def mean_of_kinds(known: Evidence, marginals: NDArray[np.float64]) -> float:
        return float((marginals * np.column_stack([known.of_kinds * known.allowed, known.absent])).sum())

    usual = mean_of_kinds(evidence, summed(bare(problem))[1])
    weights, marginals = [], []
    for side in STATED_SIDES:
        there = evidence.seen_from(side.angle, side.mirrored)
        read = [(weight, known, *summed(known.problem)) for weight, known in there.label_readings]
        total = float(np.logaddexp.reduce([weight + one for weight, _, one, _ in read]))
        parts = [(math.exp(weight + one - total), known, shares) for weight, known, one, shares in read]
        marginals.append(
            sum(
                share * discounted(known.problem, Posterior(shares, True, 0.0)).marginals
                for share, known, shares in parts
            )
        )
        loss = usual - sum(share * mean_of_kinds(known, shares) for share, known, shares in parts)
        loss = max(0.0, loss) if evidence.of_kinds.any() else 0.0
        weights.append(math.log(side.prior) + FACTS_POWER * (total - alone + loss) - KINDS_POWER * loss)
    odds = math.log(ANOTHER_PRIOR / (1 - ANOTHER_PRIOR))
    weights.append(
        odds + CHANCE_SHARE * chance - KINDS_POWER * min(0.0, alone - nothing + KINDS_SLACK * len(evidence.labels))
    )
    shares = np.exp(np.array(weights) - np.logaddexp.reduce(weights))
    spoken = evidence.allowed & (evidence.labels > 0)
    labelled = Problem(
        problem.ends[:0],
        problem.kinds[:0],
        problem.tables[:0],
        np.where(spoken, evidence.labels, 0.0),
        np.zeros(len(spoken)),
        spoken,
    )
    marginals.append(summed(labelled)[1])
    together = sum(share * one for share, one in zip(shares, marginals, strict=True))
    return float(1 - shares[-1]), np.asarray(together)


@st.composite
def labelled_evidences(draw: st.DrawFn) -> Evidence:
    names = ["a", "b", "c"][: draw(st.integers(1, 3))]
    pairs = st.tuples(st.sampled_from(names), st.sampled_from(WORDS), st.sampled_from(names))
    facts = [Fact(s, (R[word],), o) for s, word, o in draw(st.lists(pairs, max_size=5)) if s != o]
    low = st.tuples(st.integers(0, 9), st.integers(0, 9))
    corners = np.array(draw(st.lists(low, min_size=1, max_size=4, unique=True)), dtype=np.float64)
    extent = st.sampled_from([(1.0, 0.7), (0.27, 0.27), (0.025, 0.2)])
    boxes = np.stack([corners, corners + draw(st.lists(extent, min_size=len(corners), max_size=len(corners)))], axis=1)
    label = st.one_of(st.none(), st.builds(Label, st.sampled_from([*names, "jug"]), st.sampled_from([0.6, 1.0])))
    labels = draw(st.lists(label, min_size=len(boxes), max_size=len(boxes)))
    kind = st.sampled_from([*names, "dinner plate", "dinner fork"])
    kinds = [
        ONTOLOGY.kinds.words[word].iri if word in ONTOLOGY.kinds.words else None
        for word in draw(st.lists(kind, min_size=len(names), max_size=len(names)))
    ]
    return seen(boxes, RelationGraph.from_facts(R, names, facts, kinds), labels)


@settings(max_examples=50, deadline=None)
@given(labelled_evidences())
def test_the_posterior_is_that_of_all_maps_sides_and_scenes(evidence: Evidence) -> None:
    fits, marginals = by_enumeration(evidence)
    found = weighed(evidence)
    assert found.fits == pytest.approx(fits, abs=2e-3)
    np.testing.assert_allclose(found.posterior.marginals, marginals, atol=UNLIKELY_SIDES)


def unpruned(evidence: Evidence) -> Verdict:
    """Return the verdict for which every side and every reading of the labels is searched."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hypotheses, "log_sum_bound", lambda *_: math.inf)
        return weighed(evidence)


def same_answers(evidence: Evidence) -> bool:
    """Return whether both verdicts agree to 1e-4, and whether a side was pruned."""
    found, whole = weighed(evidence), unpruned(evidence)
    assert found.fits == pytest.approx(whole.fits, abs=1e-4)
    np.testing.assert_allclose(
        [one.probability for one in found.sides], [one.probability for one in whole.sides], atol=1e-4
    )
    np.testing.assert_allclose(found.posterior.marginals, whole.posterior.marginals, atol=1e-4)
    return any(one.probability == 0 for one in found.sides)


@settings(max_examples=40, deadline=None)
@given(labelled_evidences())
def test_left_out_hypotheses_change_no_answer(evidence: Evidence) -> None:
    same_answers(evidence)


def test_shortlist_bound_counts_maps_to_other_things() -> None:
    table = generate(5, 1.6, 0.2, seed=4)
    known = seen(table.boxes, table.description())
    outside = np.array([0.0, 0.1, 0.9, 0.0, 0.3])
    whole = Whole(known.scene.nodes, table.boxes, known.without_facts, None, outside, 1 - outside)
    listed = replace(known, whole=whole)
    total = summed(listed.problem)[0] - math.log1p(-0.9)
    assert hypotheses._bound(listed, total + 5.0) >= total
    assert hypotheses._bound(listed, total + 5.0) <= total + 5.0


def test_no_bound_is_sought_where_that_takes_long(monkeypatch: pytest.MonkeyPatch) -> None:
    table = generate(5, 1.6, 0.2, seed=4)
    known = seen(table.boxes, table.description())
    monkeypatch.setattr(hypotheses, "BOUND_CELLS", 2 * len(known.facts) * 36 - 1)
    assert hypotheses._bound(known, 0.0) == math.inf
    assert "upper_problem" not in known.__dict__


@pytest.mark.parametrize("place", ["as it is", "turned", "mirrored", "shuffled"])
@pytest.mark.parametrize("labelled", [0, 4, 8])
def test_left_out_sides_of_tables_change_no_answer(place: str, labelled: int) -> None:
    table = generate(8, 1.8, 0.1, seed=17 + labelled)
    boxes = table.boxes
    if place == "shuffled":
        centres, halves = np.roll(boxes.mean(axis=1), 3, axis=0), (boxes[:, 1] - boxes[:, 0]) / 2
        boxes = np.stack([centres - halves, centres + halves], axis=1)
    elif place != "as it is":
        boxes = turned(boxes, math.pi if place == "turned" else 0.0, place == "mirrored")
    labels: list[Label | None] = [None] * len(boxes)
    for i in range(labelled):
        labels[int(table.truth[i])] = Label(f"d{i:04}")
    assert same_answers(seen(boxes, table.description(kinds=True), labels))


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 4), st.integers(1, 4))
def test_where_nothing_is_said_the_prior_remains(objects: int, things: int) -> None:
    boxes = np.array([[[2.0 * i, 0.0], [2.0 * i + 1, 1.0]] for i in range(things)])
    scene = scene_relations([f"o{p}" for p in range(things)], boxes, R)
    said = RelationGraph.from_facts(R, [f"d{i}" for i in range(objects)], [])
    assert weighed(no_unary_evidence(said, scene)).fits == pytest.approx(1 - ANOTHER_PRIOR, abs=1e-6)


def grounded(table: GeneratedTable, boxes: NDArray[np.float64], labels: list[Label | None] | None = None) -> Grounding:
    return ground(seen(boxes, table.description(kinds=True), labels), engine_named("exact"))


def right_of_decided(found: Grounding, table: GeneratedTable) -> list[bool]:
    decided = [match for match in found.matches.values() if match.decided]
    return [int(match.perceived[1:]) == table.truth[int(match.object[1:])] for match in decided]


@pytest.mark.parametrize(("angle", "mirror"), [(math.pi, False), (0.0, True), (math.pi / 2, False)])
@pytest.mark.parametrize("seed", [3, 4])
def test_a_wrong_viewpoint_is_noticed_and_matches_are_right(angle: float, mirror: bool, seed: int) -> None:
    table = generate(11, 2.0, 0.0, seed=seed)
    found = grounded(table, turned(table.boxes, angle, mirror))
    side, probability = max(found.sides, key=lambda one: one[1])
    back = (side.angle + angle) % (2 * math.pi) if not mirror else side.angle
    assert side.mirrored is mirror and min(back, 2 * math.pi - back) < 1e-9
    assert probability > 0.9
    decided = right_of_decided(found, table)
    assert len(decided) > 5 and all(decided)
    assert not found.violated
    assert any("than from the stated viewpoint" in note for note in found.notes)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_three_labels_that_are_wrong_give_way_to_many_facts(seed: int) -> None:
    table = generate(11, 2.0, 0.0, seed=seed)
    labels: list[Label | None] = [None] * 11
    for row, other in ((0, 1), (1, 2), (2, 0)):
        labels[int(table.truth[row])] = Label(f"d{other:04}")
    decided = right_of_decided(grounded(table, table.boxes, labels), table)
    assert len(decided) > 5 and all(decided)


def test_things_at_shuffled_places_are_another_scene() -> None:
    noticed, accused = [], []
    for seed in range(6):
        table = generate(12, 22 / 12, 0.2, seed=seed)
        centres, halves = table.boxes.mean(axis=1), (table.boxes[:, 1] - table.boxes[:, 0]) / 2
        centres = np.roll(centres, 5, axis=0)
        moved = grounded(table, np.stack([centres - halves, centres + halves], axis=1))
        assert moved.fits is not None
        noticed.append(moved.fits < 0.5)
        own = grounded(table, table.boxes).fits
        assert own is not None
        accused.append(own < 0.5)
    assert sum(noticed) >= 5 and not any(accused)


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
@pytest.mark.parametrize("exchanged", [2, 4])
def test_facts_that_hold_of_other_kinds_are_of_another_scene(seed: int, exchanged: int) -> None:
    table = generate(11, 2.0, 0.0, seed=seed)
    centres, halves = table.boxes.mean(axis=1), (table.boxes[:, 1] - table.boxes[:, 0]) / 2
    halves[:exchanged] = np.roll(halves[:exchanged], 1, axis=0)
    found = grounded(table, np.stack([centres - halves, centres + halves], axis=1))
    assert found.fits is not None
    assert found.fits > 0.9 if exchanged == 2 else found.fits < 0.5 and not right_of_decided(found, table)


def test_of_another_scene_only_what_is_labelled_is_found() -> None:
    table = generate(12, 2.5, 0.0, seed=1)
    centres, halves = table.boxes.mean(axis=1), (table.boxes[:, 1] - table.boxes[:, 0]) / 2
    centres = np.roll(centres, 5, axis=0)
    labels: list[Label | None] = [None] * 12
    labels[int(table.truth[3])] = Label("d0003")
    found = grounded(table, np.stack([centres - halves, centres + halves], axis=1), labels)
    assert found.fits is not None and found.fits < 0.5
    assert {name: int(match.perceived[1:]) for name, match in found.matches.items()} == {"d0003": table.truth[3]}
    assert found.matches["d0003"].decided
    assert found.pivotal is None


def test_a_certain_label_fixes_its_thing_where_facts_are_few(graph_of: MakeGraph) -> None:
    boxes = np.array([[[0.2 * i, 0.0], [0.2 * i + 0.1, 0.1]] for i in range(5)])
    found = ground(
        seen(boxes, graph_of("left(target, landmark)"), [None] * 4 + [Label("landmark")]), engine_named("exact")
    )
    assert found.matches["landmark"].perceived == "o04"
    assert (found.matches["landmark"].probability or 0) > 0.99
    assert found.matches["target"].perceived != "o04"


def test_the_order_of_things_as_seen_from_a_side_does_not_matter() -> None:
    table = generate(6, 1.5, 0.0, seed=2)
    here = seen(table.boxes, table.description())
    there = here.seen_from(math.pi / 2, False)
    sides = (Side(0.0, False, 0.6), Side(math.pi / 2, False, 0.4))
    rows, columns = np.array([2, 0, 1, 5, 4, 3]), np.array([5, 3, 1, 0, 2, 4])
    found = [
        engine_named("exact", sides=sides, seen=(None, other)).align(here, Deadline.never()).posterior
        for other in (None, there, there.reordered(rows, columns))
    ]
    for other in found[1:]:
        np.testing.assert_allclose(found[0].marginals, other.marginals, atol=2e-3)  # type: ignore[union-attr]


def test_past_the_deadline_no_other_side_is_looked_from(monkeypatch: pytest.MonkeyPatch) -> None:
    def unwanted(*_: object) -> Evidence:
        raise AssertionError("looked from another side")

    monkeypatch.setattr(Evidence, "seen_from", unwanted)
    table = generate(4, 1.5, 0.0, seed=2)
    evidence = seen(table.boxes, table.description())
    found = weigh(evidence, np.full(4, UNMATCHED), Deadline.after(0.0))
    assert found is None or all(one.evidence is found.sides[0].evidence for one in found.sides)


def test_engines_without_probabilities_give_no_fit() -> None:
    table = generate(4, 1.5, 0.0, seed=2)
    found = ground(seen(table.boxes, table.description()), engine_named("blondel"))
    assert found.fits is None and not found.sides


def test_priors_of_the_sides_add_up_to_one() -> None:
    for sides in (STATED_SIDES, AS_IT_STANDS):
        assert sum(side.prior for side in sides) == pytest.approx(1.0)
        assert (sides[0].angle, sides[0].mirrored) == (0.0, False)
