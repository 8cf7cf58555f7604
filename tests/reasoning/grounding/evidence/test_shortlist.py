"""Shortlists of large scenes: facts of candidate pairs, what is left out, and memory that grows with candidates."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.errors import OutOfMemoryError, OutOfTimeError
from deixis.reasoning.geometry.pairs import Surroundings, pair_geometry
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence, without_facts
from deixis.reasoning.grounding.evidence.facts import literalness
from deixis.reasoning.grounding.evidence.facts.facts import fact_tables
from deixis.reasoning.grounding.evidence.shortlist import Shortlist, _Messages, _Weighing, shortlist
from deixis.reasoning.grounding.evidence.words.meaning import LITERAL, SHIPPED, Meaning
from deixis.reasoning.grounding.matching.posterior.posterior import posterior

RELATIONS = default_ontology().relations


def grid(count: int, seed: int = 0) -> np.ndarray:
    """Draw boxes of about one size at random places."""
    rng = np.random.default_rng(seed)
    low = rng.uniform(0, np.sqrt(count), (count, 2))
    return np.stack([low, low + rng.uniform(0.1, 0.5, (count, 2))], axis=1)


def chain(words: list[str]) -> RelationGraph:
    """Return objects d0, d1, ..., each related to the next by a word."""
    facts = [Fact(f"d{i}", (RELATIONS[word],), f"d{i + 1}") for i, word in enumerate(words)]
    return RelationGraph.from_facts(RELATIONS, [f"d{i}" for i in range(len(words) + 1)], facts)


def found(
    said: RelationGraph,
    boxes: np.ndarray,
    unary: np.ndarray,
    most: int = 50,
    gigabytes: float = 1.0,
    deadline: Deadline = Deadline.never(),
) -> Shortlist:
    shape = unary.shape
    alone = without_facts(unary, np.full(shape[0], -4.0), np.ones(shape, dtype=bool))
    return shortlist(said, boxes, np.arange(len(boxes)), alone, SHIPPED, most, gigabytes, deadline)


@pytest.mark.parametrize("meaning", [SHIPPED, LITERAL])
def test_a_block_of_pairs_has_the_ratios_of_the_tables(meaning: Meaning) -> None:
    said, boxes = chain(["left", "on", "exactly_top"]), grid(40)
    weighing = _Weighing(said, boxes, np.arange(40), meaning, Deadline.never())
    rows, columns = np.array([3, 17, 5]), np.array([8, 3, 30, 12])
    if meaning.graded:
        known = fact_tables(said, boxes, literal=literalness.LITERAL * literalness.LITERAL_PRIOR)
        tables, kinds = known.tables, known.kinds
    else:
        scene = scene_relations([f"o{p:02}" for p in range(40)], boxes, RELATIONS)
        problem = no_unary_evidence(said, scene, meaning).problem
        tables, kinds = problem.tables, problem.kinds
    for fact in range(3):
        ratios = weighing.ratios(fact, rows, columns)
        expected = np.exp(tables[kinds[fact]][np.ix_(rows, columns)])
        expected[rows[:, None] == columns] = 0.0
        assert np.allclose(ratios, expected, rtol=0.05)  # crowding is estimated


def test_surroundings_of_a_small_scene_are_all_its_things() -> None:
    boxes = grid(60)
    pairs = Surroundings.of(boxes, boxes).block(slice(0, 20), slice(20, 60))
    assert np.abs(pairs.crowd - pair_geometry(boxes).crowd[:20, 20:]).max() < 0.05


def test_on_a_chain_beliefs_are_the_exact_marginals() -> None:
    said, boxes = chain(["left", "top"]), grid(30, seed=1)
    unary = np.random.default_rng(2).normal(0, 1, (3, 30))
    alone = without_facts(unary, np.full(3, -4.0), np.ones(unary.shape, dtype=bool))
    weighing = _Weighing(said, boxes, np.arange(30), SHIPPED, Deadline.never())
    messages = _Messages([np.arange(30)] * 3, alone)
    for fact, (subject, object) in enumerate(weighing.ends.tolist()):
        messages.add(subject, object, weighing.ratios(fact, np.arange(30), np.arange(30)), fact)
    messages.settle(Deadline.never())
    tables = np.stack([weighing.ratios(fact, np.arange(30), np.arange(30)) for fact in range(2)])
    problem = type(alone)(
        weighing.ends, np.arange(2), np.log(np.maximum(tables, 1e-6)).astype(np.float32), unary, alone.absent
    )
    exact = posterior(problem)
    assert exact.exact
    assert np.abs(np.stack(messages.beliefs()) - exact.marginals).max() < 0.02


def test_what_labels_and_facts_point_out_is_on_the_list() -> None:
    boxes = grid(3000)
    unary = np.full((3, 3000), -5.0)
    unary[0, 77] = 12.0
    left = np.flatnonzero(boxes[:, 1, 0] < boxes[77, 0, 0])
    near = left[np.argsort(np.abs(boxes[left].mean(axis=1) - boxes[77].mean(axis=0)).sum(axis=1))[:40]]
    unary[1, near[:20]], unary[2, near[20:]] = 3.0, 3.0
    chosen = found(chain(["right", "top"]), boxes, unary)
    assert 77 in chosen.things and len(chosen.things) <= 50
    assert chosen.outside[0] < 1e-3
    assert set(near[:20]) & set(chosen.things.tolist())


def test_what_does_not_fit_on_the_list_is_said_to_be_outside() -> None:
    boxes = grid(2000)
    unary = np.full((2, 2000), -5.0)
    unary[:, :1000] = 3.0
    chosen = found(chain(["left"]), boxes, unary, most=40)
    assert len(chosen.things) <= 40
    assert (chosen.outside > 0.5).all()


def test_memory_grows_with_candidates_and_not_with_pairs() -> None:
    boxes, unary = grid(6000), np.full((3, 6000), -9.0)
    unary[np.arange(3)[:, None], np.arange(300).reshape(3, 100)] = 3.0
    tracemalloc.start()
    found(chain(["left", "top"]), boxes, unary)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 60e6  # all pairs of one table alone take 144 MB


def test_where_no_fact_can_be_used_it_is_refused() -> None:
    boxes = grid(3000)
    with pytest.raises(OutOfMemoryError, match="9,000,000 pairs of 3000 things"):
        found(chain(["left"]), boxes, np.zeros((2, 3000)), gigabytes=0.01)
    with pytest.raises(OutOfTimeError, match="raise the time limit"):
        found(chain(["left"]), boxes, np.zeros((2, 3000)), deadline=Deadline.after(0.5))


def test_a_scene_of_a_shortlist_names_all_that_is_left_out() -> None:
    from deixis.grammar.layout.parser import parse_script
    from deixis.workflows.grounding.ground import GroundingRequest, answer

    boxes = grid(400)
    labels = {0: "fork", 1: "knife", 2: "plate"}
    things = tuple(
        PerceivedObject(f"o{p:03}", tuple(low.tolist()), tuple(high.tolist()), label=labels.get(p, "candle"))
        for p, (low, high) in enumerate(boxes)
    )
    places = boxes.mean(axis=1)
    word = "left of" if places[0, 0] < places[1, 0] else "right of"
    other = "left of" if places[2, 0] < places[1, 0] else "right of"
    script = parse_script(f"fork {word} knife\nplate {other} knife\n")
    assert GroundingRequest(script, Scene(things), memory_limit=0.02).shortlisted
    request = GroundingRequest(script, Scene(things), time_limit=60.0)
    request.__dict__["shortlisted"] = True
    answered = answer(request)
    whole = answer(GroundingRequest(script, Scene(things), time_limit=60.0))
    assert {name: match.perceived for name, match in answered.matches.items()} == {
        name: match.perceived for name, match in whole.matches.items()
    }
    assert len(answered.unmatched_perceived) == 400 - len(answered.matches)
    assert any("of 400 things were compared in detail" in note for note in answered.notes)
    for name, match in answered.matches.items():
        assert match.probability == pytest.approx(whole.matches[name].probability, abs=0.02)
