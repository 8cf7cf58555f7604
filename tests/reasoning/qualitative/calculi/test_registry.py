"""Test calculi by name, and atoms as users of other reasoners write them."""

from __future__ import annotations

import pytest

from deixis.ontology.relations.allen import SYMBOLS
from deixis.reasoning.errors import UnknownAtomError, UnknownCalculusError
from deixis.reasoning.qualitative.calculi.registry import CALCULI, calculus


def test_a_calculus_is_built_once_and_has_its_name() -> None:
    for name in CALCULI:
        assert calculus(name) is calculus(name)
        assert calculus(name).name == name
        assert calculus(name).code(calculus(name).atoms[-1]) == len(calculus(name).atoms) - 1


@pytest.mark.parametrize(("name", "hint"), [("alen", "'allen'"), ("RCC8", "rcc8"), ("", "point, allen"), ("zzz", "ra")])
def test_an_unknown_calculus_is_reported_with_the_nearest_or_all(name: str, hint: str) -> None:
    with pytest.raises(UnknownCalculusError, match=hint):
        calculus(name)


@pytest.mark.parametrize(
    "signs",
    [
        "< m o fi di s = si d f oi mi >",  # GQR, Allen
        "b m o fi di s eq si d f oi mi bi",  # SparQ
        "p m o fi di s e si d f oi mi pi",  # Krokhin, Jeavons and Jonsson, with i for the converse
        "before meets overlaps finished_by contains starts equals started_by during finishes overlapped_by met_by >",
    ],
)
def test_allens_signs_in_the_usual_notations(signs: str) -> None:
    assert [calculus("allen").code(sign) for sign in signs.split()] == list(range(len(SYMBOLS)))


def test_ambiguous_capitals_are_not_signs_of_allen_relations() -> None:
    for capital in "MOSDF":
        with pytest.raises(UnknownAtomError, match="allen has no relation"):
            calculus("allen").code(capital)


@pytest.mark.parametrize("signs", ["N NE E SE S SW W NW EQ", "n ne e se s sw w nw eq", "N NE E SE S SW W NW Eq"])
def test_tiles_in_any_case(signs: str) -> None:
    cd = calculus("cd")
    plain = ["N", "NE", "E", "SE", "S", "SW", "W", "NW", "EQ"]
    assert [cd.code(sign) for sign in signs.split()] == [cd.code(sign) for sign in plain]


def test_a_tile_is_the_order_on_x_and_on_y() -> None:
    cd = calculus("cd")
    assert cd.members(cd.relation(["<,>", "=,>", ">,="])) == ("NW", "N", "E")


@pytest.mark.parametrize(
    ("name", "atom", "message"),
    [
        ("allen", "befor", "did you mean 'before'"),
        ("rcc8", "XX", "it has DC, EC"),
        ("ra", "<", "write one sign for each of its 2 axes, like '<,<'"),
        ("ra", "<,m,=", "write one sign for each of its 2 axes"),
        ("ra", "<,q", "allen has no relation 'q'"),
        ("ba", "<,<", "like '<,<,<'"),
        ("cd", "NNE", "cd has no relation 'NNE'"),
        ("ten", "lefft", "did you mean 'left'"),
        ("direction-distance", "N,nearr", "did you mean 'N,near'"),
    ],
)
def test_an_unknown_atom_is_reported_with_a_suggestion(name: str, atom: str, message: str) -> None:
    with pytest.raises(UnknownAtomError, match=message):
        calculus(name).code(atom)


def test_closure_decides_only_where_atoms_do() -> None:
    assert [name for name in CALCULI if not calculus(name).decided_by_closure] == [
        "ten",
        "distance",
        "direction-distance",
    ]
