"""Check the laws that every calculus obeys, and which calculi are relation algebras."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.reasoning.errors import CalculusError
from deixis.reasoning.qualitative.calculi.calculus import Calculus, TableCalculus, bits
from deixis.reasoning.qualitative.calculi.laws import lawful
from deixis.reasoning.qualitative.calculi.registry import CALCULI, calculus

ASSOCIATIVE = ("point", "allen", "ra", "ba", "rcc5", "rcc8", "cd", "distance")
SMALL = ("point", "allen", "rcc5", "rcc8", "cd", "ten", "distance", "direction-distance")


def relations(name: str, most: int = 4) -> st.SearchStrategy[int]:
    """Draw relations of few atoms, so that unions do not hide wrong entries; sometimes the empty or universal one."""
    count = len(calculus(name).atoms)
    few = st.sets(st.integers(0, count - 1), max_size=most).map(lambda codes: sum(1 << code for code in codes))
    return st.one_of(few, few, few, st.just(calculus(name).universal))


def atoms(found: Calculus) -> Iterator[int]:
    return (1 << code for code in range(len(found.atoms)))


@pytest.mark.parametrize("name", CALCULI)
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_the_converse_reverses_compositions(name: str, data: st.DataObject) -> None:
    found = calculus(name)
    r, s = data.draw(relations(name)), data.draw(relations(name))
    assert found.converse(found.converse(r)) == r
    assert found.converse(found.compose(r, s)) == found.compose(found.converse(s), found.converse(r))
    assert found.converse(r | s) == found.converse(r) | found.converse(s)


@pytest.mark.parametrize("name", CALCULI)
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_all_readings_of_a_triangle_agree(name: str, data: st.DataObject) -> None:
    """Check both forms of the cycle law."""
    found = calculus(name)
    r, s, t = (data.draw(relations(name)) for _ in range(3))
    possible = bool(found.compose(r, s) & t)
    assert possible == bool(found.compose(found.converse(r), t) & s)
    assert possible == bool(found.compose(t, found.converse(s)) & r)


@pytest.mark.parametrize("name", CALCULI)
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_composition_distributes_over_union(name: str, data: st.DataObject) -> None:
    found = calculus(name)
    r, s, t = (data.draw(relations(name)) for _ in range(3))
    assert found.compose(r, s | t) == found.compose(r, s) | found.compose(r, t)
    assert found.compose(r | s, t) == found.compose(r, t) | found.compose(s, t)
    assert found.compose(0, r) == found.compose(r, 0) == 0


@pytest.mark.parametrize("name", CALCULI)
def test_a_composition_with_the_converse_has_the_identity(name: str) -> None:
    found = calculus(name)
    itself = 1 << found.identity
    for atom in list(atoms(found))[:200]:
        assert itself & found.compose(atom, found.converse(atom))
        assert found.compose(atom, found.converse(atom)) == found.converse(found.compose(atom, found.converse(atom)))


@pytest.mark.parametrize("name", [name for name in CALCULI if name != "ten"])
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_the_identity_is_neutral(name: str, data: st.DataObject) -> None:
    found = calculus(name)
    r = data.draw(relations(name))
    assert found.compose(1 << found.identity, r) == r == found.compose(r, 1 << found.identity)


def test_the_identity_of_the_ten_names_is_not_neutral() -> None:
    """Check the atom of identity, which also holds of boxes that overlap in part."""
    ten = calculus("ten")
    assert ten.members(1 << ten.identity) == ("overlap",)
    assert ten.compose(1 << ten.identity, ten.relation(["left"])) != ten.relation(["left"])


@pytest.mark.parametrize("name", SMALL)
def test_composition_of_atoms_is_associative_where_stated(name: str) -> None:
    found = calculus(name)
    same = all(
        found.compose(found.compose(a, b), c) == found.compose(a, found.compose(b, c))
        for a, b, c in product(atoms(found), repeat=3)
    )
    assert same == (name in ASSOCIATIVE)


@pytest.mark.parametrize("name", SMALL)
def test_lawful_tables_are_left_unchanged(name: str) -> None:
    found = calculus(name)
    atoms_ = range(len(found.atoms))
    table = np.array([[found.compose(1 << i, 1 << j) for j in atoms_] for i in atoms_], dtype=np.uint64)
    converses = np.array([found.converse(1 << i).bit_length() - 1 for i in atoms_])
    lawful_part, violations = lawful(converses, table, found.identity)
    assert (lawful_part == table).all()
    assert {each.law for each in violations} == ({"identity"} if name == "ten" else set())


@settings(max_examples=50, deadline=None)
@given(st.sampled_from(["point", "allen", "rcc8"]), st.data())
def test_an_addition_to_a_single_entry_is_removed(name: str, data: st.DataObject) -> None:
    found = calculus(name)
    assert isinstance(found, TableCalculus)
    size = len(found.atoms)
    i, j, k = (data.draw(st.integers(0, size - 1)) for _ in range(3))
    table = found.composition.copy()
    table[i, j] |= np.uint64(1 << k)
    lawful_part, violations = lawful(found.converses, table, found.identity)
    readings = [(i, j, k), (found.converses[j], found.converses[i], found.converses[k]), (k, found.converses[j], i)]
    if len(set(readings)) == 3 or (table == found.composition).all():
        assert (lawful_part == found.composition).all()
        assert bool(violations) == bool((table != found.composition).any())


def test_converses_that_are_not_involutions_are_refused() -> None:
    with pytest.raises(CalculusError, match="atom itself"):
        lawful(np.array([1, 2, 0]), np.full((3, 3), 7, dtype=np.uint64), 0)


@pytest.mark.parametrize("name", ["ra", "ba"])
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_composition_of_products_is_associative(name: str, data: st.DataObject) -> None:
    found = calculus(name)
    r, s, t = (data.draw(relations(name, most=2)) for _ in range(3))
    assert found.compose(found.compose(r, s), t) == found.compose(r, found.compose(s, t))


@pytest.mark.parametrize("name", CALCULI)
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_the_pieces_of_a_relation_partition_it(name: str, data: st.DataObject) -> None:
    found = calculus(name)
    r = data.draw(relations(name, most=7))
    pieces = found.pieces(r)
    assert sum(pieces) == r
    assert all(piece & ~r == 0 and piece for piece in pieces)
    assert sum(piece.bit_count() for piece in pieces) == r.bit_count()
    assert all(found.pieces(piece) == (piece,) for piece in pieces)
    assert len(pieces) <= len(list(bits(r)))
