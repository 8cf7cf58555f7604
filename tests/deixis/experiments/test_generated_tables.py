"""Check that facts about generated tables are true except the stated share, and that every piece keeps its kind."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.experiments.generated_tables import PIECES, RING, SETTING, generate, nearest, neighbours
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.matching.problem import UNMATCHED

RELATIONS = default_ontology().relations
EXACT = {relation.word: relation.index for relation in RELATIONS.of_reading(Reading.EXACT)}


@given(st.integers(0, 1000), st.integers(6, 20), st.sampled_from([0.0, 0.1, 0.3]))
@settings(max_examples=15, deadline=None)
def test_the_stated_share_of_facts_is_wrong(seed: int, objects: int, off: float) -> None:
    table = generate(objects, 1.5, off, seed=seed)
    ends = table.truth[table.ends]
    names = box_relations(table.boxes, RELATIONS).names[ends[:, 0], ends[:, 1]]
    assert ((names == table.words) == ~table.off).all()
    assert all(
        word in neighbours(int(name), RELATIONS) for name, word in zip(names, table.words, strict=True) if name != word
    )
    assert table.off.sum() == round(off * len(table.ends))
    assert len({frozenset(pair) for pair in table.ends.tolist()}) == len(table.ends) == round(1.5 * objects)


def test_missing_and_extra_pieces() -> None:
    table = generate(20, missing=3, extra=2, seed=4)
    assert (table.truth == UNMATCHED).sum() == 3
    assert len(table.boxes) == 19
    assert len(set(table.truth.tolist())) == 18


@pytest.mark.parametrize("seed", range(3))
def test_a_piece_has_the_size_of_its_kind_within_a_tenth(seed: int) -> None:
    table = generate(25, missing=2, extra=2, seed=seed)
    there = table.truth != UNMATCHED
    boxes = table.boxes[table.truth[there]]
    shares = (boxes[:, 1] - boxes[:, 0]) / PIECES[table.pieces[there], 2:]
    assert ((shares > 0.899) & (shares < 1.101)).all()


def test_kinds_are_stated_only_on_request() -> None:
    table, kinds = generate(12, seed=0), default_ontology().kinds
    assert table.description().kinds == ()
    told = [kinds[iri].label for iri in table.description(kinds=True).kinds if iri]
    assert told == [list(SETTING)[piece] for piece in table.pieces]


def test_the_same_seed_gives_the_same_table() -> None:
    first, second = generate(10, seed=3), generate(10, seed=3)
    assert np.array_equal(first.boxes, second.boxes)
    assert np.array_equal(first.words, second.words)
    assert not np.array_equal(first.boxes, generate(10, seed=4).boxes)


def test_neighbours_are_adjacent_directions() -> None:
    assert neighbours(EXACT["left"], RELATIONS) == [EXACT["bottom_left"], EXACT["top_left"]]
    assert neighbours(EXACT["on"], RELATIONS) == [EXACT[word] for word in RING]


def test_the_nearest_boxes_exclude_the_box_itself() -> None:
    boxes = np.array([[[x, 0.0], [x + 1, 1.0]] for x in (0.0, 2.0, 10.0)])
    assert nearest(boxes).tolist() == [[1, 2], [0, 2], [1, 0]]
