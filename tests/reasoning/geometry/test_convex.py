"""Convex sets of Allen relations: their number, closure under intersection, and covers of other sets."""

from __future__ import annotations

from functools import reduce
from operator import or_

from hypothesis import given
from hypothesis import strategies as st

from deixis.ontology.relations.allen import ALL_ALLEN, Allen
from deixis.reasoning.geometry.allen import EndOrder, admitted, convex_hull, convex_pieces, convex_sets

MASKS = st.integers(1, ALL_ALLEN)


def test_there_are_82_convex_relations() -> None:
    """Compare the published number (van Beek and Cohen 1990) with all orders of the pairs of ends, and with hulls."""
    convex = [mask for mask in range(1, ALL_ALLEN + 1) if convex_hull(mask).mask == mask]
    assert len(convex) == len(convex_sets()) == 82
    assert all([piece.mask for piece in convex_pieces(mask)] == [mask] for mask in convex)


def test_the_orders_of_a_convex_set_define_it() -> None:
    for found in convex_sets():
        assert admitted(found.orders) == found.mask


def test_intersections_of_convex_sets_are_convex() -> None:
    masks = {found.mask for found in convex_sets()} | {0}
    assert all(a & b in masks for a in masks for b in masks)


def test_single_relations_and_the_full_set_are_convex() -> None:
    masks = {found.mask for found in convex_sets()}
    assert {1 << relation for relation in Allen} <= masks
    assert (1 << 13) - 1 in masks


def test_converses_of_convex_sets_are_convex() -> None:
    for found in convex_sets():
        swapped = tuple(EndOrder(order.lesser ^ 2, order.greater ^ 2, order.strict) for order in found.orders)
        assert admitted(swapped) == sum(1 << relation.converse for relation in Allen if found.mask >> relation & 1)


@given(MASKS)
def test_pieces_are_convex_and_their_union_is_the_set(mask: int) -> None:
    pieces = [piece.mask for piece in convex_pieces(mask)]
    assert all(convex_hull(piece).mask == piece for piece in pieces)
    assert reduce(or_, pieces) == mask
    assert (len(pieces) == 1) == (convex_hull(mask).mask == mask)
