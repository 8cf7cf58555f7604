"""The meaning of the relation words: inverses, admitted atoms, degrees and phrases."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from deixis.errors import DeixisError, OntologyError, UnknownTermError
from deixis.ontology.relations.allen import ALL_ALLEN, SYMBOLS, Allen, allen_mask, members
from deixis.ontology.relations.relation import Reading, Relation, Relations, plain_phrase
from deixis.ontology.tbox import default_ontology

R = default_ontology().relations
WIDE = R.of_reading(Reading.WIDE)
EXACT = R.of_reading(Reading.EXACT)
GRADED = R.of_reading(Reading.GRADED)
WORDS = ["left", "right", "top", "bottom", "top_left", "top_right", "bottom_left", "bottom_right", "on", "under"]
DIRECTIONS = WORDS[:8]


def by_name(relation: Relation) -> str:
    return relation.name


def test_there_are_ten_words_in_two_readings() -> None:
    assert sorted(r.name for r in WIDE) == sorted(WORDS)
    assert sorted(r.name for r in EXACT) == sorted("exactly_" + word for word in WORDS)
    assert [r.index for r in R.values()] == list(range(56))


@pytest.mark.parametrize("relation", R.values(), ids=by_name)
def test_the_inverse_of_an_inverse_is_the_relation_itself(relation: Relation) -> None:
    inverse = R[relation.inverse]
    assert inverse.inverse == relation.name
    assert inverse.reading is relation.reading
    assert (inverse == relation) == relation.symmetric
    assert relation.reading is Reading.GRADED or not relation.symmetric


def test_the_inverses_are_golden() -> None:
    pairs = [("left", "right"), ("top", "bottom"), ("top_left", "bottom_right"), ("top_right", "bottom_left")]
    assert all(R[a].inverse == b for a, b in [*pairs, ("on", "under")])


@pytest.mark.parametrize("relation", R.values(), ids=by_name)
def test_the_inverse_admits_the_converse_of_every_atom(relation: Relation) -> None:
    np.testing.assert_array_equal(R[relation.inverse].admits()[::-1, ::-1], relation.admits())
    converse = allen_mask(a.converse for a in members(R[relation.inverse].z_atoms))
    assert converse == relation.z_atoms


@pytest.mark.parametrize("word", DIRECTIONS)
def test_a_wide_direction_admits_the_atoms_of_its_sub_properties(word: str) -> None:
    parts = [r.admits() for r in EXACT if word in r.broader]
    assert len(parts) == (3 if word in ("left", "right", "top", "bottom") else 1)
    np.testing.assert_array_equal(np.logical_or.reduce(parts), R[word].admits())


def test_exact_relations_share_only_the_atom_of_equal_boxes() -> None:
    for a, b in combinations(EXACT, 2):
        shared = set(zip(*(axis.tolist() for axis in np.nonzero(a.admits() & b.admits())), strict=True))
        expected = {(6, 6)} if {a.word, b.word} == {"on", "under"} else set()
        assert shared == expected, (a, b)


def test_atoms_of_no_exact_relation_are_partial_overlaps() -> None:
    """Count the 9 x 9 overlapping atoms: 4 x 4 belong to on, 4 x 4 to under, and one to both."""
    admitted = np.logical_or.reduce([r.admits() for r in EXACT])
    assert admitted.sum() == 169 - (81 - 16 - 16 + 1)
    x, y = np.nonzero(~admitted)
    assert x.min() > Allen.MEETS
    assert x.max() < Allen.MET_BY
    assert y.min() > Allen.MEETS
    assert y.max() < Allen.MET_BY


def test_the_atoms_of_left_are_golden() -> None:
    assert R["left"].x_atoms == 0b11
    assert R["left"].y_atoms == ALL_ALLEN
    assert [SYMBOLS[a] for a in members(R["exactly_left"].y_atoms)] == ["o", "fi", "di", "s", "=", "si", "d", "f", "oi"]
    assert [SYMBOLS[a] for a in members(R["on"].x_atoms)] == ["s", "=", "d", "f"]
    assert [SYMBOLS[a] for a in members(R["on"].z_atoms)] == ["oi", "mi", ">"]
    assert R["left"].z_atoms == 0


def test_only_the_wide_relations_are_transitive() -> None:
    assert all(r.transitive for r in WIDE)
    assert not any(r.transitive for r in EXACT)


def test_graded_words_without_a_wide_one_are_decided_by_model() -> None:
    assert {r.name for r in GRADED if not r.by_model} == {"behind", "in_front"}
    assert not any(r.by_model for r in (*WIDE, *EXACT))
    assert R.paper_word(R["behind"]) == "top"
    assert R.paper_word(R["near"]) is None


def test_the_broader_relations_are_golden() -> None:
    assert R["left"].broader == frozenset()
    assert R["top_left"].broader == {"top", "left"}
    assert R["exactly_left"].broader == {"left"}
    assert R["exactly_top_left"].broader == {"top_left", "top", "left"}
    assert R["exactly_on"].broader == {"on"}


def test_the_two_readings_of_a_word_lead_to_each_other() -> None:
    for exact in EXACT:
        assert R.wide(exact).word == exact.word
        assert R.exact(R.wide(exact)) == exact


@pytest.mark.parametrize(
    ("stated", "name", "degree"),
    [
        ("left", "exactly_left", 1.0),
        ("left", "exactly_top_left", 0.5),
        ("left", "exactly_bottom_left", 0.5),
        ("top", "exactly_top_left", 0.5),
        ("top_left", "exactly_top_left", 1.0),
        ("top_left", "exactly_left", 0.0),
        ("top_left", "exactly_top", 0.0),
        ("left", "exactly_right", 0.0),
        ("left", "exactly_on", 0.0),
        ("on", "exactly_on", 1.0),
        ("on", "exactly_under", 0.0),
        ("exactly_left", "exactly_left", 1.0),
        ("exactly_left", "exactly_top_left", 0.0),
        ("left", "left", 0.0),
        ("left", "top_left", 0.0),
    ],
)
def test_degrees_are_golden(stated: str, name: str, degree: float) -> None:
    assert R.degrees[R[stated].index, R[name].index] == degree


def test_the_degrees_table_has_only_the_golden_entries() -> None:
    """1 for ten words in two readings, 0.5 for both sides of four corners; behind is as top, in_front as bottom."""
    values, counts = np.unique(R.degrees, return_counts=True)
    assert dict(zip(values.tolist(), counts.tolist(), strict=True)) == {0.0: 56**2 - 34, 0.5: 12, 1.0: 22}


@pytest.mark.parametrize(
    ("wrong", "right"), [("rihgt", "right"), ("topleft", "top_left"), ("exactly_lft", "exactly_left")]
)
def test_a_misspelt_name_is_an_error_with_a_suggestion(wrong: str, right: str) -> None:
    with pytest.raises(UnknownTermError) as caught:
        R[wrong]
    assert str(caught.value) == f"there is no relation '{wrong}'; did you mean '{right}'?"
    assert isinstance(caught.value, KeyError)
    assert isinstance(caught.value, DeixisError)


def test_a_very_different_name_is_an_error_without_a_suggestion() -> None:
    with pytest.raises(UnknownTermError) as caught:
        R["zzzzzz"]
    assert str(caught.value) == "there is no relation 'zzzzzz'"


def test_membership_of_an_unknown_name_is_false() -> None:
    assert "nothing" not in R
    assert R.get("nothing") is None
    assert len(R) == 56 < 63  # relation sets are bit masks of 64-bit integers


def test_members_are_in_the_order_of_their_bits() -> None:
    assert R.members(R["right"].bit | R["left"].bit) == tuple(sorted((R["left"], R["right"]), key=lambda r: r.index))
    assert R.members(0) == ()


@pytest.mark.parametrize(
    ("phrase", "name"),
    [
        ("left of", "left"),
        ("above", "top"),
        ("in front of", "in_front"),
        ("on top of", "on"),
        ("beneath", "under"),
        ("above and to left of", "top_left"),
        ("directly left of", "exactly_left"),
    ],
)
def test_phrases_of_scripts_name_relations(phrase: str, name: str) -> None:
    assert R.by_word[phrase].name == name


def test_every_relation_is_found_by_its_label_and_by_its_phrase() -> None:
    for relation in R.values():
        if relation.reading is not Reading.GRADED:  # "above" alone is top
            assert R.by_word[plain_phrase(relation.name)] == relation
        assert R.by_word[plain_phrase(relation.phrase)] == relation


def test_a_relation_that_refers_to_an_unknown_one_is_refused() -> None:
    with pytest.raises(OntologyError, match="refers to 'right'"):
        Relations((R["left"],))


def test_phrases_ignore_case_articles_and_underscores() -> None:
    assert plain_phrase("  To THE left_of  a ") == "to left of"
    assert plain_phrase("the") == ""


@pytest.mark.parametrize("relation", Allen)
def test_the_converse_of_a_converse_is_the_relation_itself(relation: Allen) -> None:
    assert relation.converse.converse is relation
    assert (relation.converse is relation) == (relation is Allen.EQUALS)


def test_the_symbols_of_converses_are_those_of_the_literature() -> None:
    pairs = {"<": ">", "m": "mi", "o": "oi", "fi": "f", "di": "d", "s": "si", "=": "="}
    assert {r.symbol: r.converse.symbol for r in Allen if r <= 6} == pairs


def test_mask_and_members_are_inverse_functions() -> None:
    for mask in (0, 1, 0b1010101010101, ALL_ALLEN):
        assert allen_mask(members(mask)) == mask
