"""Test the calculus of the ten names: they partition the rectangle algebra, and compose as boxes do."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np

from deixis.ontology.relations.relation import Reading, Relations
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.bridges import names_to_boxes, to_ra
from deixis.reasoning.qualitative.calculi.registry import calculus


def test_every_rectangle_atom_has_one_of_the_eleven_names() -> None:
    ten, ra = calculus("ten"), calculus("ra")
    parts = names_to_boxes().admits
    assert sum(parts) == ra.universal
    assert sum(part.bit_count() for part in parts) == 169
    words = {relation.word for relation in default_ontology().relations.of_reading(Reading.EXACT)}
    assert (set(ten.atoms[:10]), ten.atoms[10]) == (words, "overlap")


def test_names_match_the_ontology_and_share_only_equal_boxes() -> None:
    relations: Relations = default_ontology().relations
    ten, equal = calculus("ten"), calculus("ra").relation(["=,="])
    for relation in relations.of_reading(Reading.EXACT):
        stated = sum(1 << int(code) for code in np.flatnonzero(relation.admits()))
        assert to_ra(ten.relation([relation.word])) == stated & ~equal


def test_converses_are_the_inverses_of_the_ontology() -> None:
    relations, ten = default_ontology().relations, calculus("ten")
    for relation in relations.of_reading(Reading.EXACT):
        inverse = relations[relation.inverse].word
        assert ten.members(ten.converse(ten.relation([relation.word]))) == (inverse,)


def test_compositions_agree_with_boxes() -> None:
    """Combine all triples of intervals between six points on x and on y, which give every triple of boxes."""
    ten = calculus("ten")
    ends = np.array(list(combinations(range(6), 2)), dtype=float)
    low, high = ends.T
    codes = allen_relations(low[:, None], high[:, None], low[None, :], high[None, :]).astype(int)
    first, second, third = (codes[pair].ravel() for pair in _triples(len(ends)))
    triples = np.unique(np.stack([first, second, third], axis=1), axis=0)
    name = np.array([names_to_boxes().inverse.forward(1 << code).bit_length() - 1 for code in range(169)])
    x, y = triples[:, None, :], triples[None, :, :]
    named = np.unique(name[x * 13 + y].reshape(-1, 3), axis=0)
    seen = np.zeros((11, 11, 11), dtype=bool)
    seen[tuple(named.T)] = True
    expected = [[ten.compose(1 << i, 1 << j) >> np.arange(11) & 1 for j in range(11)] for i in range(11)]
    assert np.array_equal(seen, np.array(expected, dtype=bool))


def _triples(n: int) -> list[tuple[np.ndarray[tuple[int, ...], np.dtype[np.intp]], ...]]:
    a, b, c = np.indices((n, n, n))
    return [(a, b), (b, c), (a, c)]


def test_a_closed_network_of_names_may_be_inconsistent() -> None:
    """Let, on y, c end before b begins, b begin before d ends, and d end before a begins: c and a cannot overlap."""
    ten = calculus("ten")
    stated = {"ab": "left", "ac": "overlap", "ad": "top_left", "bc": "top", "bd": "right", "cd": "overlap"}
    between = {pair: ten.relation([word]) for pair, word in stated.items()}
    between |= {pair[::-1]: ten.converse(relation) for pair, relation in between.items()}
    for i, j, k in product("abcd", repeat=3):
        if len({i, j, k}) == 3:
            assert ten.compose(between[i + j], between[j + k]) & between[i + k]
    ra = calculus("ra")
    boxes = {pair: to_ra(relation) for pair, relation in between.items()}
    for i, j, k in list(product("abcd", repeat=3)) * 3:
        if len({i, j, k}) == 3:
            boxes[i + k] &= ra.compose(boxes[i + j], boxes[j + k])
    assert not all(boxes.values())
    assert not ten.decided_by_closure
