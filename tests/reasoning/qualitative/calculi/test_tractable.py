"""Check that the tractable subclasses have their published sizes, are closed, and match their definitions."""

from __future__ import annotations

from itertools import combinations, product

import pytest

from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.reasoning.qualitative.calculi.calculus import Subclass
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.calculi.tractable import (
    CONVEX,
    ORD_HORN,
    POINTIZABLE,
    RCC5_HORN,
    RCC8_C8,
    RCC8_HORN,
    RCC8_Q8,
    rcc8_of_rcc5,
)

RCC8_CLASSES = (RCC8_HORN, RCC8_C8, RCC8_Q8)


@pytest.mark.parametrize(
    ("subclass", "size"),
    [
        (ORD_HORN, 868),  # Nebel and Bürckert 1995
        (POINTIZABLE, 188),  # Ladkin and Maddux 1988
        (CONVEX, 83),  # the 82 of the literature, and the empty relation
        (RCC5_HORN, 28),  # Renz and Nebel 1999
        (RCC8_HORN, 148),  # Renz and Nebel 1999
        (RCC8_C8, 158),  # Renz 1999
        (RCC8_Q8, 160),  # Renz 1999
    ],
    ids=lambda value: getattr(value, "name", str(value)),
)
def test_subclasses_have_the_published_sizes(subclass: Subclass, size: int) -> None:
    assert len(subclass.relations) == size
    assert {0, (1 << subclass.atoms) - 1} <= subclass.relations
    assert all(1 << code in subclass.relations for code in range(subclass.atoms))


def test_76_rcc8_relations_are_in_no_maximal_tractable_subclass() -> None:
    assert 256 - len(frozenset[int]().union(*(subclass.relations for subclass in RCC8_CLASSES))) == 76  # Renz 1999


def test_convex_is_within_pointizable_within_ord_horn() -> None:
    assert CONVEX.relations < POINTIZABLE.relations < ORD_HORN.relations


@pytest.mark.parametrize("subclass", [*RCC8_CLASSES, RCC5_HORN, CONVEX, POINTIZABLE, ORD_HORN], ids=lambda s: s.name)
def test_a_subclass_is_closed_under_the_operations_of_closure(subclass: Subclass) -> None:
    found = calculus({5: "rcc5", 8: "rcc8", 13: "allen"}[subclass.atoms])
    members = subclass.relations
    assert all(found.converse(r) in members for r in members)
    assert all(r & s in members for r, s in combinations(members, 2))
    sample = sorted(members)[:: 1 if len(members) < 200 else 7]
    assert all(found.compose(r, s) in members for r, s in product(sample, repeat=2))


@pytest.mark.parametrize("subclass", [RCC5_HORN, RCC8_HORN, ORD_HORN], ids=lambda s: s.name)
def test_a_hull_is_the_least_member_above_a_relation(subclass: Subclass) -> None:
    for relation in range(1, 1 << subclass.atoms, 1 if subclass.atoms < 10 else 37):
        hull = int(subclass.hulls[relation])
        assert hull in subclass.relations and not relation & ~hull
        assert all(not hull & ~member for member in subclass.relations if not relation & ~member)


def test_rcc5_composes_like_its_relations_in_rcc8() -> None:
    rcc5, rcc8 = calculus("rcc5"), calculus("rcc8")
    for r, s in product(range(1, 32), repeat=2):
        assert rcc8_of_rcc5(rcc5.compose(r, s)) == rcc8.compose(rcc8_of_rcc5(r), rcc8_of_rcc5(s))


def test_pre_convex_relations_are_those_of_ord_horn_clauses() -> None:
    """Conjoin clauses over end points with at most one literal that is not an inequality (Nebel and Bürckert)."""
    holds = []  # for each pair of an end of a and an end of b: masks of <, =, >
    places = ((0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (1, 3), (1, 4), (2, 2), (2, 3), (2, 4), (3, 4), (4, 4))
    for end, other in product((0, 1), (1, 3)):
        less = sum(1 << code for code, place in enumerate(places) if place[end] < other)
        equal = sum(1 << code for code, place in enumerate(places) if place[end] == other)
        holds.append((less, equal, ALL_ALLEN & ~less & ~equal))
    negative = [ALL_ALLEN & ~equal for _, equal, _ in holds]
    positive = [0, *(mask for less, equal, more in holds for mask in (equal, less | equal, equal | more))]
    clauses = {
        head | sum_of(chosen) for head in positive for size in range(5) for chosen in combinations(negative, size)
    }
    stated = {ALL_ALLEN}
    for clause in clauses:
        stated |= {relation & clause for relation in stated}
    assert stated == ORD_HORN.relations


def sum_of(masks: tuple[int, ...]) -> int:
    union = 0
    for mask in masks:
        union |= mask
    return union


def test_a_split_takes_the_largest_piece_first_and_few_pieces() -> None:
    sizes = []
    for relation in range(1, 1 << 13, 5):
        pieces = ORD_HORN.split(relation)
        assert sum(pieces) == relation
        assert set(pieces) <= ORD_HORN.relations
        best = max(member.bit_count() for member in ORD_HORN.relations if member & ~relation == 0)
        assert pieces[0].bit_count() == best
        sizes.append(len(pieces))
    assert max(sizes) <= 5
    assert sum(sizes) / len(sizes) < 2.6
