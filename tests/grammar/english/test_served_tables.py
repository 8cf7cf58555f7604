"""Facts of instructions for tables, trays, shelves and drawers: sides, steps, choices, purposes and judgements."""

from __future__ import annotations

import pytest

from deixis.grammar.english.reader import read_english
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.grammar.errors import ScriptError
from deixis.ontology.tbox import default_ontology


def asserted(text: str) -> list[str]:
    """Return the facts that a text asserts, without counts and sizes; none if nothing was understood."""
    try:
        reading = read_english(text).reading
    except ScriptError:
        return []
    assert reading is not None
    shown = [str(fact.content) for fact in reading.stated if fact.asserted]
    return [fact for fact in shown if not fact.startswith(("count(", "size("))]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The brush lies to the left of the basin, and the comb and razor lie to the right.",
         ["left(brush, basin)", "right(comb, basin)", "right(razor, basin)"]),
        ("The bowl stands on the left side of the lamp, while the bell stands on the right side.",
         ["left(bowl, lamp)", "right(bell, lamp)"]),
        ("The bell stands to the right of the lamp, and the bowl on the left.",
         ["right(bell, lamp)", "left(bowl, lamp)"]),
        ("The bell is to the right of the lamp. The bowl is on the left.", ["right(bell, lamp)", "part(bowl, 'left')"]),
        ("The brush goes on the left side of the basin and the comb and razor on the right side, with the comb closest"
         " to the basin.",
         ["left(brush, basin)", "right(comb, basin)", "right(razor, basin)", "nearest(comb, basin)"]),
    ],
)  # fmt: skip
def test_sides_are_of_the_thing_named_for_the_other_side(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The jug is in the box. Put the lime at the lower right position.",
         ["inside(jug, box)", "part(lime, 'bottom right')"]),
        ("Top left, we put the lime. Bottom right, we put the salt.",
         ["part(lime, 'top left')", "part(salt, 'bottom right')"]),
        ("The ribbons hang above and in the middle of the gate.", ["above(ribbons, gate)", "middle(ribbons, gate)"]),
        ("The box must be covered with a felt, at least on top.", ["on(felt, box)"]),
        ("A bust is stood in the middle of the plinth.", ["middle(bust, plinth)"]),
        ('The bell stands 3" from the edge of the mat.', ["distance(bell, mat, 'edge', 0.0762 m)"]),
        ("Put the jug behind the bowl, with the lid next to the jug facing up.",
         ["behind(jug, bowl)", "next_to(lid, jug)", "facing(lid, 'up')"]),
    ],
)  # fmt: skip
def test_places_of_corners_measures_and_covers(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The jug is on the mat. Next, set the cups on the box.", ["on(jug, mat)", "on(cups, box)"]),
        ("The jug is in the box. Next is the lid and spout. It goes to the left of the box.",
         ["inside(jug, box)", "left(lid, box)", "left(spout, box)"]),
        ("Next comes the ladle on the left of the pot.", ["left(ladle, pot)"]),
        ("The jug is in the box. Next will be the ladle. It goes behind the box.",
         ["inside(jug, box)", "behind(ladle, box)"]),
        ("That means the ladles go to the left of the pot.", ["left(ladles, pot)"]),
    ],
)  # fmt: skip
def test_steps_name_what_comes_next(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the main plate behind the side plate. The side plate is next to the jug.",
         ["behind(main_plate, side_plate)", "next_to(side_plate, jug)"]),
        ("Put fruits that spoil quickly in the upper drawer.", ["inside(fruits, drawer)"]),
        ("Keep the pans you use most often behind the jars.", ["behind(pans, jars)"]),
        ("The ladles that you need every day hang next to the pans.", ["next_to(ladles, pans)"]),
        ("The upper drawer is for spoons; the lower drawer is reserved for corks and lids.",
         ["inside(spoons, top_drawer)", "inside(corks, bottom_drawer)", "inside(lids, bottom_drawer)"]),
        ("Use the upper rack for corks and the lower rack for lids.",
         ["inside(corks, top_rack)", "inside(lids, bottom_rack)"]),
        ("The ladles go to the left of the pot. The long ladle is behind the jug.",
         ["left(ladles, pot)", "behind(ladle, jug)"]),
        ("Incense burns in a bowl.", ["state(incense, 'burning')", "inside(incense, bowl)"]),
        ("Candlesticks are placed behind the bowl.", ["behind(candlesticks, bowl)"]),
    ],
)  # fmt: skip
def test_things_are_distinguished_by_use_and_rank(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


def test_one_of_several_subjects_is_a_choice() -> None:
    reading = read_english("Put a jug or a carafe next to the bowl. Plates or trays go behind the bowl.").reading
    assert reading is not None
    alternatives = {str(fact.content): fact.alternative for fact in reading.stated}
    choice = alternatives["next_to(jug, bowl)"]
    assert choice is not None and alternatives["next_to(carafe, bowl)"] == choice
    assert alternatives["behind(plates, bowl)"] is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("It is no longer good form to put salt or a bell in the bowl.",
         ["not inside(salt, bowl)", "not inside(bell, bowl)"]),
        ("It is not necessary to put the bell on the box. The jug is behind the box.", ["behind(jug, box)"]),
        ("It is not required to put the bell on the box. The jug is behind the box.", ["behind(jug, box)"]),
        ("The bell is not required to stand on the box. The jug is behind the box.", ["behind(jug, box)"]),
        ("The upper drawer is not for spoons. The jug is behind the box.", ["behind(jug, box)"]),
        ("Do not use the upper drawer for spoons. The jug is behind the box.", ["behind(jug, box)"]),
        ("Do not dip the lid in the oil. The jug is behind the box.", ["behind(jug, box)"]),
        ("The ladle may be used to cut figs or to spread jam or honey on figs. The jug is behind the box.",
         ["behind(jug, box)"]),
        ("DON'T: Put salt on the lid. The jug is behind the box.", ["not on(salt, lid)", "behind(jug, box)"]),
        ("Use the rack for transport. The jug is behind the box.", ["behind(jug, box)"]),
        ("The upper drawer was for spoons. The jug is behind the box.", ["behind(jug, box)"]),
        ("The rim of the bowl is reflecting the lamp. The jug is behind the box.", ["behind(jug, box)"]),
        ("The box is often referred to as the chest. The jug is behind the box.", ["behind(jug, box)"]),
        ("The word left has four letters. The jug is behind the box.", ["behind(jug, box)"]),
    ],
)  # fmt: skip
def test_judgements_and_names_assert_no_place(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize("noun", ["expensive", "scarcest", "shorter", "creates", "create", "useful"])
def test_single_qualities_and_verbs_have_no_place(noun: str) -> None:
    assert not can_have_a_place(noun, known_nouns(default_ontology().kinds))


@pytest.mark.parametrize("noun", ["olive", "votive", "negative", "backrest", "turntable", "spoonful", "poker"])
def test_nouns_like_qualities_have_places(noun: str) -> None:
    assert can_have_a_place(noun, known_nouns(default_ontology().kinds))
