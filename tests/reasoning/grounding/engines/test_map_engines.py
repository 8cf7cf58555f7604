"""The engines for the likeliest map: right on the shipped settings, the best of all maps, and honest where in doubt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import maps
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate
from deixis.experiments.place_settings import formal_setting
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading, Relations
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.grounding.answers.answer import Standing
from deixis.reasoning.grounding.engines import map_engines
from deixis.reasoning.grounding.engines.engine import Alignment
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence, no_unary_evidence
from deixis.reasoning.grounding.evidence.words.meaning import LITERAL, SHIPPED
from deixis.reasoning.grounding.ground import SENSITIVITY_NOT_ASKED, ground
from deixis.reasoning.grounding.hypotheses.hypotheses import AS_IT_STANDS
from deixis.reasoning.grounding.matching.posterior.coincidences import discounted
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.matching.search.exact import exact

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]
R = default_ontology().relations
ORDERED = [r for r in R.values() if r.reading is not Reading.GRADED]  # words that order edges
EXACT = engine_named("exact")


def setting(relations: Relations, seed: int | None = None) -> SceneRelations:
    seen = formal_setting(seed)
    boxes = np.array([[thing.minimum, thing.maximum] for thing in seen.objects])
    return scene_relations([thing.id for thing in seen.objects], boxes, relations)


def scene(boxes: NDArray[np.float64]) -> SceneRelations:
    return scene_relations([f"o{i}" for i in range(len(boxes))], boxes, R)


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("engine", ["exact", "scalable"])
def test_full_description_matches_everything_correctly(
    engine: str, seed: int | None, relations: Relations, graph_of: MakeGraph, full_script: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*full_script), setting(relations, seed)), engine_named(engine))
    assert found.proved_best == (engine == "exact")
    assert {name: match.perceived for name, match in found.matches.items()} == {name: name for name in found.matches}
    assert len(found.matches) == 12


def test_what_is_absent_is_left_out(
    relations: Relations, graph_of: MakeGraph, full_script: list[str], absent_glasses: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*full_script, *absent_glasses), setting(relations)), EXACT)
    left_out = {left.name for left in found.unmatched_objects}
    assert left_out == {"white_wine_glass", "red_wine_glass", "champagne_glass"}


def test_interchangeable_things_are_as_probable_and_not_decided(
    relations: Relations, graph_of: MakeGraph, figure_7: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*figure_7), setting(relations)), EXACT)
    assert found.interchangeable
    for name, fellow in (pair for group in found.interchangeable for pair in permutations(group, 2)):
        match, other = found.matches[name], found.matches[fellow]
        assert not match.decided
        assert {a.perceived: a.probability for a in match.alternatives}[other.perceived] == pytest.approx(
            other.probability
        )
    assert found.matches["dinner_plate"].decided


def test_a_scene_without_boxes_is_taken_literally(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    seen = scene(boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]))
    found = ground(no_unary_evidence(graph_of("left(a, b)"), replace(seen, boxes=None)), EXACT)
    assert {name: match.perceived for name, match in found.matches.items()} == {"a": "o0", "b": "o1"}


@pytest.mark.parametrize("seconds", [0.0, 0.2])
def test_past_the_deadline_the_answer_is_not_proved(seconds: float) -> None:
    evidence = knotty(60)
    with processor_time_below(seconds + 5):
        found = ground(evidence, EXACT, deadline=Deadline.after(seconds))
    assert not found.proved_best
    assert found.pivotal is None
    assert any("time limit" in note for note in found.notes)


def test_where_no_time_is_left_nothing_is_called_decided(
    relations: Relations, graph_of: MakeGraph, figure_7: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*figure_7), setting(relations)), EXACT, deadline=Deadline.after(0.0))
    assert not any(match.decided for match in found.matches.values())


@pytest.mark.parametrize(("n1", "n2"), [(0, 0), (0, 3), (3, 0), (1, 1), (1, 3)])
@pytest.mark.parametrize("engine", ["exact", "scalable", "blondel", "heymans-singh"])
def test_few_or_no_objects_on_either_side(engine: str, n1: int, n2: int, boxes_of: MakeBoxes) -> None:
    description = RelationGraph.from_facts(R, list("abc")[:n1], [])
    boxes = boxes_of(*[[(2 * i, 2 * i + 1), (0, 1)] for i in range(n2)]) if n2 else np.zeros((0, 2, 2))
    found = align(no_unary_evidence(description, scene(boxes)), engine)
    assert found.matrix.shape == (n1, n2)
    assert int((found.assignment != UNMATCHED).sum()) == min(n1, n2)


def knotty(n: int) -> Evidence:
    """Random facts that a random scene cannot satisfy together: no bound is near."""
    rng = np.random.default_rng(3)
    low = rng.uniform(0, 10, (n, 2))
    names = [f"n{i:02}" for i in range(n)]
    words = ["left", "right", "top", "bottom", "top_left", "bottom_right"]
    facts = []
    for _ in range(5 * n):
        s, o = rng.choice(n, 2, replace=False)
        facts.append(Fact(names[s], (R[str(rng.choice(words))],), names[o]))
    return no_unary_evidence(
        RelationGraph.from_facts(R, names, facts), scene(np.stack([low, low + rng.uniform(0.1, 2, (n, 2))], axis=1))
    )


def align(evidence: Evidence, engine: str = "exact") -> Alignment:
    return engine_named(engine).align(evidence, Deadline.after(10.0))


@st.composite
def descriptions(draw: st.DrawFn) -> RelationGraph:
    nodes = list("abcd")[: draw(st.integers(0, 4))]
    if len(nodes) < 2:
        return RelationGraph.from_facts(R, nodes, [])
    node = st.sampled_from(nodes)
    relations = st.sets(st.sampled_from(ORDERED), min_size=1, max_size=2)
    fact = st.builds(
        Fact,
        node,
        relations.map(lambda s: tuple(sorted(s, key=lambda r: r.index))),
        node,
        st.sampled_from([True, True, False]),
        st.booleans(),
        st.sampled_from([1.0, 1.0, 0.8, 0.2]),
    )
    return RelationGraph.from_facts(R, nodes, draw(st.lists(fact, max_size=6)))


@st.composite
def evidences(draw: st.DrawFn) -> Evidence:
    description = draw(descriptions())
    n1, n2 = len(description.nodes), draw(st.integers(0, 4))
    extent = st.tuples(st.integers(0, 6), st.integers(1, 4)).map(lambda e: (e[0], e[0] + e[1]))
    corners = draw(st.lists(st.tuples(extent, extent), min_size=n2, max_size=n2))
    amounts = st.sampled_from([0.0, 0.0, 0.7, 1.6, -2.0, None])  # None: ruled out, as by a certain label
    labels = np.array(draw(st.lists(amounts, min_size=n1 * n2, max_size=n1 * n2)), dtype=np.float64).reshape(n1, n2)
    allowed = ~np.isnan(labels)
    boxes = np.array(corners, dtype=np.float64).reshape(-1, 2, 2).transpose(0, 2, 1)
    meaning = draw(st.sampled_from([SHIPPED, LITERAL]))
    return Evidence(
        description,
        scene(boxes),
        np.nan_to_num(labels),
        np.zeros((n1, n2)),
        meaning,
        allowed=allowed,
        identified=np.any(~allowed, axis=0),
    )


@settings(max_examples=60, deadline=None)
@given(evidences())
def test_exact_answer_equals_the_sum_over_all_maps(evidence: Evidence) -> None:
    """Check the scene from the stated side; ``test_hypotheses.py`` tests sides and other scenes."""
    found = engine_named("exact", sides=AS_IT_STANDS).align(evidence, Deadline.never())
    options = list(maps(evidence.allowed))
    values = np.array([evidence.problem.value(option) for option in options])
    assert found.proved_best
    assert found.verdict is not None and found.posterior is not None
    best = exact(evidence.problem).assignment if found.of_another else found.assignment
    assert evidence.problem.value(best) == pytest.approx(values.max(), abs=1e-5)
    weights = np.exp(values - values.max()) / np.exp(values - values.max()).sum()
    shares = np.zeros((len(best), len(evidence.scene.nodes) + 1))
    for weight, option in zip(weights, options, strict=True):
        shares[np.arange(len(best)), option] += weight
    shares = discounted(evidence.problem, Posterior(shares, True, 0.0)).marginals
    fits, elsewhere = found.verdict.fits, found.verdict.labelled.marginals
    np.testing.assert_allclose(found.posterior.marginals, fits * shares + (1 - fits) * elsewhere, atol=2e-3)


@settings(max_examples=40, deadline=None)
@given(evidences())
def test_without_a_pivotal_fact_the_answer_is_as_predicted(evidence: Evidence) -> None:
    found = ground(evidence, EXACT)
    if found.pivotal is None:  # not looked for where the description is probably of another scene
        assert found.fits is not None and found.fits < 0.5
        return
    facts = [evidence.description.fact(int(edge)) for edge in evidence.facts]
    names, whole = evidence.description.nodes, evidence.problem
    for pivotal in found.pivotal:
        kept = np.arange(len(facts)) != facts.index(pivotal.fact)
        then = replace(whole, ends=whole.ends[kept], kinds=whole.kinds[kept])  # words as literal as in the whole
        foretold = {name: found.matches[name].perceived if name in found.matches else None for name in names}
        foretold |= pivotal.changes
        assignment = np.array(
            [UNMATCHED if p is None else evidence.scene.index(p) for p in foretold.values()], dtype=np.int64
        )
        best = max(then.value(option) for option in maps(evidence.allowed))
        assert then.value(assignment) == pytest.approx(best, abs=1e-5)


def elsewhere(graph_of: MakeGraph, boxes_of: MakeBoxes) -> Evidence:
    """Describe five things in a row, in a scene where their kinds have another order."""
    names = "abcde"
    told = graph_of(*(f"left({one}, {other})" for one, other in combinations(names, 2)))
    seen = scene(boxes_of(*[[(3 * i, 3 * i + 1), (0, 1)] for i in (2, 4, 1, 0, 3)]))
    known = no_unary_evidence(told, seen, LITERAL)
    return replace(known, sizes=np.where(np.eye(5, dtype=bool), 1.5, -3.0))


def test_facts_of_another_scene_have_no_pivotal_claims(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    found = ground(elsewhere(graph_of, boxes_of), EXACT)
    assert not found.matches
    assert found.pivotal is None
    assert SENSITIVITY_NOT_ASKED in found.notes


def test_note_on_another_scene_names_the_other_evidence(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    known = elsewhere(graph_of, boxes_of)
    nothing = np.zeros_like(known.sizes)
    others = {
        "the description, with the usual sizes, fits this scene so poorly": known,
        "the description, with the colours, fits this scene so poorly": replace(
            known, sizes=nothing, colours=known.sizes
        ),
    }
    for begins, evidence in others.items():
        (note,) = [note for note in ground(evidence, EXACT).notes if "another scene" in note]
        assert note.startswith(begins)


@settings(max_examples=40, deadline=None)
@given(evidences())
def test_literal_weights_follow_crisp_degrees(evidence: Evidence) -> None:
    """Check that exact facts weigh most, then wide ones, then violated ones."""
    literal = replace(evidence, meaning=LITERAL).problem
    for row, fact in enumerate(evidence.facts.tolist()):
        degrees = evidence.degree_table[row][evidence.scene.names]
        table = literal.tables[literal.kinds[row]]
        apart = ~np.eye(len(table), dtype=bool)
        order = np.argsort(table[apart], kind="stable")
        assert (np.diff(degrees[apart][order]) >= 0).all(), evidence.description.fact(fact)


def test_meaning_says_whether_probabilities_are_exact(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    seen = scene(boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]))
    assert ground(no_unary_evidence(graph_of("left(a, b)"), seen), EXACT).probabilities is Standing.EXACT
    similarity = ground(no_unary_evidence(graph_of("left(a, b)"), seen), engine_named("similarity"))
    assert similarity.probabilities is Standing.NONE
    assert similarity.matches["a"].probability is None


def test_no_time_for_probabilities_decides_nothing() -> None:
    boxes = np.random.default_rng(3).uniform(size=(60, 1, 2)) + np.array([[0.0, 0.0], [0.05, 0.05]])
    seen, words = scene(boxes), ("left", "right", "top")
    facts = [Fact(f"a{i}", (R[words[i % 3]],), f"a{(7 * i + 1) % 60}") for i in range(60) if i != (7 * i + 1) % 60]
    described = RelationGraph.from_facts(R, [f"a{i}" for i in range(60)], facts)
    found = ground(no_unary_evidence(described, seen), engine_named("scalable"), deadline=Deadline.after(0.0))
    assert found.probabilities is Standing.NONE
    assert all(match.probability is None and not match.decided for match in found.matches.values())
    assert any("before the probabilities" in note for note in found.notes)
    assert not found.finished


@pytest.mark.parametrize("engine", ["exact", "scalable", "similarity", "blondel"])
def test_with_time_enough_an_engine_comes_to_its_end(
    engine: str, relations: Relations, graph_of: MakeGraph, full_script: list[str]
) -> None:
    assert ground(no_unary_evidence(graph_of(*full_script), setting(relations)), engine_named(engine)).finished


def test_many_objects_are_answered_soon_after_a_short_time_limit() -> None:
    table = generate(400, seed=5)
    evidence = no_unary_evidence(table.description(), table.scene())
    with processor_time_below(2.0):
        found = ground(evidence, engine_named("scalable"), deadline=Deadline.after(0.1))
    assert len(found.matches) > 300
    assert found.graph_similarity == 0.0
    assert any("before the paper's similarity was computed" in note for note in found.notes)
    assert not any("in common" in note for note in found.notes)


def test_a_thousand_alike_do_not_list_each_other() -> None:
    from deixis.reasoning.grounding.answers.alternatives import MAX_LISTED_GROUP

    boxes = np.tile(np.array([[0.0, 0.0], [0.1, 0.1]]), (MAX_LISTED_GROUP + 2, 1, 1))
    names = [f"a{i}" for i in range(MAX_LISTED_GROUP + 2)]
    evidence = no_unary_evidence(RelationGraph.from_facts(R, names, []), scene(boxes))
    found = ground(evidence, engine_named("similarity"))
    assert len(found.interchangeable[0]) == MAX_LISTED_GROUP + 2
    assert all(len(match.alternatives) <= 1 for match in found.matches.values())


def test_a_search_that_was_cut_short_is_not_against_the_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ground with a bad map where the sum over all maps is estimated from the map, as seen from one side."""
    table = generate(60, seed=0)
    evidence = replace(no_unary_evidence(table.description(), table.scene()), memory_limited=True)
    bad = np.random.default_rng(0).permutation(table.truth)
    monkeypatch.setattr(map_engines, "exact", lambda *given: replace(exact(*given), assignment=bad, bound=np.inf))
    found = ground(evidence, engine_named("exact", sides=AS_IT_STANDS), Deadline.after(2.0))
    assert found.fits is None and found.probabilities is Standing.NONE
    assert {match.perceived for match in found.matches.values()} == {f"o{thing:04}" for thing in bad}
    assert any("before the probabilities" in note for note in found.notes)
