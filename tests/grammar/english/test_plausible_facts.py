"""Facts of instructions that a careful reader takes from them, and facts that no reader would take."""

from __future__ import annotations

import pytest
from asserted_facts import asserted

from deixis.grammar.english.reader import read_english
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.grammar.errors import ScriptError
from deixis.grammar.reading import Reading
from deixis.ontology.tbox import default_ontology


def read(text: str) -> Reading:
    reading = read_english(text).reading
    assert reading is not None
    return reading


def asserted_if_any(text: str) -> list[str]:
    """Return the places that a text asserts; none if no fact of it was understood."""
    try:
        return asserted(text)
    except ScriptError:
        return []


@pytest.mark.parametrize(
    "noun",
    ["eye level", "location", "left", "preparation", "elegance", "moss layer adds", "six inches", "buffet style",
     "guest carefully slides", "three o'clock", "type", "start"],
)  # fmt: skip
def test_words_for_no_thing_have_no_place(noun: str) -> None:
    assert not can_have_a_place(noun, known_nouns(default_ontology().kinds))


@pytest.mark.parametrize(
    "noun",
    ["censer", "panel a", "arrangement", "instrument stand", "price tag", "butterfly net", "time switch",
     "spirit level", "watering can", "station", "goods basket", "step stool", "bookcase", "law book"],
)  # fmt: skip
def test_words_for_things_have_places(noun: str) -> None:
    assert can_have_a_place(noun, known_nouns(default_ontology().kinds))


def test_facts_about_phrases_that_name_no_thing_are_reported() -> None:
    reading = read("The jug stands behind the cup. The jug stands above eye level. The plates are near the jug.")
    assert [str(f.content) for f in reading.stated if f.asserted] == ["behind(jug, cup)", "near(plates, jug)"]
    (problem, *_) = reading.sentences[1].problems
    assert "not the name of a thing" in problem.message


def test_things_among_others_keep_their_places() -> None:
    assert asserted("The knife and the preparation are behind the cup.") == ["behind(knife, cup)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The bowl of rice is left of the cup. The bowl of soup is right of the cup.",
         ["left(bowl_1, cup)", "right(bowl_2, cup)"]),
        ("The bowl of rice is left of the cup. The bowl is near the jug.", ["left(bowl, cup)", "near(bowl, jug)"]),
        ("Put the pins along the second row from the bottom, and the nails in the second row from the top.",
         ["ordinal(row_1, '2 from bottom')", "along(pins, row_1)", "ordinal(row_2, '2 from top')",
          "inside(nails, row_2)"]),
        ("The queen stands on the box. The white queen is near the cup. The black queen is near the jug.",
         ["on(white_queen, box)", "near(white_queen, cup)", "near(black_queen, jug)"]),
        ("The plates are behind the cup. Extra plates (small, deep) are on the box.",
         ["behind(plates_1, cup)", "on(plates_2, box)"]),
    ],
)  # fmt: skip
def test_contents_order_and_colour_tell_things_apart(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The knife is on the plate, with the blade facing left.", ["on(knife, plate)", "facing(knife, 'left')"]),
        ("The jug stands behind the cup, not on the box or in front of the pot.",
         ["behind(jug, cup)", "not on(jug, box)", "not in_front(jug, pot)"]),
        ("The napkin goes on the plate or to the left of the fork, but never under the plate.",
         ["on(napkin, plate)", "not under(napkin, plate)", "left(napkin, fork)"]),
        ("The jug stands behind the cup, not high above it.", ["behind(jug, cup)", "not above(jug, cup)"]),
        ("The jug is on the opposite side of the plate from the cup.", ["opposite(jug, cup)"]),
        ("The jug is on the other side of the table. The cup is on the table.", ["side(jug, 'other')", "on(cup)"]),
        ("Put the cup at the left end of the front edge of the box.",
         ["edge(cup, box, 'front')", "end(cup, box, 'left')"]),
        ("Put the cup in the middle of the right side of the box.", ["side(cup, box, 'right')"]),
        ("Put the label on the back side of the box.", ["part(label, box, 'back')"]),
        ("Put the plates at the start of the line.", ["end(plates, line, 'start')"]),
        ("A plate is placed on the table over the forks. The cup is on the table.",
         ["above(plate, forks)", "on(plate)", "on(cup)"]),
        ("Trays stand in front of the individual.", ["in_front(trays, 'individual')"]),
    ],
)  # fmt: skip
def test_places_of_arrangements(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The candle, which represents fire, stands behind the bowl.", ["behind(candle, bowl)"]),
        ("Put the candle behind the bowl, which represents water.", ["behind(candle, bowl)"]),
        ("The tray, which holds a cup, stands behind the jug.", ["on(cup, tray)", "behind(tray, jug)"]),
        ("A small tray, about a foot square, stands behind the jug.", ["behind(tray, jug)"]),
        ("A small tray, 30 cm long and standing six inches high, is behind the jug.", ["behind(tray, jug)"]),
        ("The fork lies left of the plate (and the spoon above it, if you serve soup).", ["left(fork, plate)"]),
        ("The fork lies left of the plate (if you serve soup, the spoon is above it).", ["left(fork, plate)"]),
        ("The fork lies left of the plate (if it is used).", []),
        ("The fork is left of the plate. (the dessert spoon sits above the plate) If you serve soup, turn it.",
         ["left(fork, plate)", "above(dessert_spoon, plate)"]),
    ],
)  # fmt: skip
def test_asides_leave_the_places_of_their_sentence(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The harp is behind the drums, with the flutes and bells on the left and the oboes and gongs on the right.",
         ["behind(harp, drums)", "part(flutes, 'left')", "part(bells, 'left')", "part(oboes, 'right')",
          "part(gongs, 'right')"]),
        ("From left to right across the stage are the violins and the cellos.",
         ["row(violins, cellos, 'left to right')"]),
        ("Put the pan on the box, placing the lid next to it.", ["on(pan, box)", "next_to(lid, pan)"]),
        ("Peas: plant behind the box.", ["behind(peas, box)"]),
        ("Tea pot: a vessel for brewing, usually placed behind the box.", ["behind(tea_pot, box)"]),
        ("Mug: a pen and a ruler. The jug is behind the box.",
         ["inside(pen, mug)", "inside(ruler, mug)", "behind(jug, box)"]),
        ("Put a towel on the box. Towels are behind the jug.", ["on(towel, box)", "behind(towels, jug)"]),
        ("The chopsticks lie between the jug and the bowls of rice and soup.", ["between(chopsticks, jug, bowls)"]),
        ("A picture is on the wall in the corner.", ["corner(picture)", "on(picture, wall)"]),
        ("The bell hangs at eye level behind the jug.", ["behind(bell, jug)"]),
        ("Put a towel under the board to prevent the board from slipping.", ["under(towel, board)"]),
    ],
)  # fmt: skip
def test_things_of_orchestras_kitchens_and_rooms(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("When setting up a desk, place a towel beneath the board.", ["under(towel, board)"]),
        ("After washing the cups, put them on the box.", ["on(cups, box)"]),
        ("When cool, push the rice behind the box.", ["behind(rice, box)"]),
        ("When serving soup, put the spoon behind the box.", []),
        ("When wet, the cup stands behind the box.", []),
        ("When not in use, the cup stands behind the box.", []),
        ("When you face the door, the cup is behind the box.", ["behind(cup, box)"]),
        ("Before leaving, the key hangs behind the box.", []),
        ("The cup may be behind the jug and the pot behind the box.", []),
        ("The cup should be behind the jug and the pot behind the box.", ["behind(cup, jug)", "behind(pot, box)"]),
        ("Prevent the cup from standing behind the box.", []),
        ("Take a step back from the box.", []),
        ("The cup, which I doubt, is behind the box.", []),
        ("Move the cup by keeping both hands around the box.", []),
    ],
)  # fmt: skip
def test_time_and_manner_of_steps(text: str, expected: list[str]) -> None:
    assert asserted_if_any(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("In a buffet style setting the forks are set near the napkins.", ["near(forks, napkins)"]),
        ("In a formal setting there may be a fork behind the spoon. The cup is behind the jug.", ["behind(cup, jug)"]),
        ("The cup is next to the jug, and a pen lies alongside.", ["next_to(cup, jug)", "next_to(pen, cup)"]),
        ("Put the peas along the north edge of the box.", ["edge(peas, box, 'north')"]),
        ("The horns are on the conductor's left. The other brass is on his right.",
         ["left(horns, 'conductor')", "right(brass, 'conductor')"]),
        ("The drum may be behind the cup instead of behind the box.", []),
        ("The drum may be behind the cup, but not behind the box.", ["not behind(drum, box)"]),
    ],
)  # fmt: skip
def test_settings_sides_and_what_may_be(text: str, expected: list[str]) -> None:
    assert asserted_if_any(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The butter plate is behind the cup. The dinner plate is behind the jug. The fork is left of the plate.",
         ["behind(butter_plate, cup)", "behind(dinner_plate, jug)", "left(fork, plate)"]),
        ("The dinner plate is behind the cup. The fork is left of the plate.",
         ["behind(dinner_plate, cup)", "left(fork, dinner_plate)"]),
        ("The string section is behind the drums. The brass section is behind the harp.",
         ["behind(string_section, drums)", "behind(section, harp)"]),
        ("The plate is behind the cup, with a knife across the rim.", ["behind(plate, cup)", "across(knife, plate)"]),
        ("Put a fork to the left of the plate. The spoon and knife are placed to the right.",
         ["left(fork, plate)", "right(spoon, plate)", "right(knife, plate)"]),
        ("Put the pawns in front of the pieces.", ["in_front(pawns, pieces)"]),
        ("Place a towel under the board to keep it from sliding on the box.", ["under(towel, board)"]),
        ("The plate is behind the cup, with a fork on the left and a knife and spoon on the right.",
         ["behind(plate, cup)", "part(fork, 'left')", "part(knife, 'right')", "part(spoon, 'right')"]),
        ("The essential thing stands behind the box. The cup is on the box.", ["on(cup, box)"]),
    ],
)  # fmt: skip
def test_which_things_and_sides_are_meant(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Always face the sofa toward the box.", ["facing(sofa, box)"]),
        ("Mary sits or kneels to the left of the crib.", ["left(mary, crib)"]),
        ("Knives and spoons at right of plate.", ["right(knives, plate)", "right(spoons, plate)"]),
        ("Do not place the right side of the desk against a box. The cup is on the box.", ["on(cup, box)"]),
        ("The bowl should have a cloth across the top. The bowl is on the box.",
         ["across(cloth, bowl)", "on(bowl, box)"]),
        ("The lamp belongs in a position. The cup is on the box.", ["on(cup, box)"]),
        ("Joseph stands to the right of the crib, often with a donkey beside him.",
         ["right(joseph, crib)", "next_to(donkey, joseph)"]),
    ],
)  # fmt: skip
def test_postures_and_persons(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the plate in front of the guest with a fork on the left, above the mat or next to the mat.",
         ["part(fork, 'left')", "in_front(plate, 'guest')", "above(plate, mat)", "next_to(plate, mat)"]),
        ("Put the candle on a shelf or on a stool near the tree.",
         ["on(candle, shelf)", "near(stool, tree)", "on(candle, stool)"]),
        ("All your pens are on the red mat.", ["on(pens, mat)"]),
        ("The bowl can be layered on top of the plate.", ["on(bowl, plate)"]),
        ("A kit consisting of a fork and a knife is left of the plate.", ["left(kit, plate)"]),
        ("There is no room for the lamp, so the lamp is under the shelf.", ["under(lamp, shelf)"]),
        ("The tray, such as often seen in bars, is on the mat.", ["on(tray, mat)"]),
        ("Most traditionally the napkin lies under the fork.", ["under(napkin, fork)"]),
        ("In some cultures, the napkin is under the fork. The cup is left of it.", ["left(cup, napkin)"]),
        ("The jug is on the shelf (easy to reach). The cup is inside the jug.", ["on(jug)", "inside(cup, jug)"]),
        ("The proper place for the fork is to the left of the plate.", ["left(fork, plate)"]),
        ("Glasses should be facing down on the red mat.", ["facing(glasses, 'down')", "on(glasses, mat)"]),
        ("Below the mirror, in the cupboard, live the towels.", ["below(towels, mirror)", "inside(towels, cupboard)"]),
        ("The cup is on the mat. If you serve bread and there is no mat, put it behind the jug.", ["on(cup, mat)"]),
        ("Two pawns are behind the king. Move your two pawns in front of the queen.",
         ["behind(pawn_1, king)", "behind(pawn_2, king)", "in_front(pawn_1, queen)", "in_front(pawn_2, queen)"]),
        ("When loading the rack, put the cups on the red mat.", ["on(cups, mat)"]),
        ("A single stool is best placed opposite the window.", ["opposite(stool, window)"]),
        ("The spoons are placed on the table 2 cm from the edge.", ["distance(spoons, 'edge', 0.02 m)", "on(spoons)"]),
        ("Sofas should not be touching walls - particularly in large rooms.", ["not touching(sofas, walls)"]),
        ("The bass drum is behind the jug. The cymbals are around the drums.",
         ["behind(bass_drum, jug)", "around(cymbals, drums)"]),
        ("Top right, we put the bone, which stands for the lamb.", ["part(bone, 'top right')"]),
        ("Bottom left goes the jug.", ["part(jug, 'bottom left')"]),
        ("Put the pen on the red mat, either beside the cup or behind the jug.",
         ["on(pen, mat)", "next_to(pen, cup)", "behind(pen, jug)"]),
        ("The clamp is near the assembly inside the crate.", ["inside(assembly, crate)", "near(clamp, assembly)"]),
    ],
)  # fmt: skip
def test_words_beside_a_place_change_nothing(text: str, expected: list[str]) -> None:
    assert asserted_if_any(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Anna sits on the shelf. A lamb is beside her.", ["on(anna)", "next_to(lamb, anna)"]),
        ("The doll Anna sits on the mat, with a lamb behind her.", ["on(anna, mat)", "behind(lamb, anna)"]),
        ("Mary is left of the stable, accompanied by an ox behind her.", ["left(mary, stable)", "behind(ox, mary)"]),
    ],
)
def test_figures_with_names_are_he_and_she(text: str, expected: list[str]) -> None:
    assert asserted_if_any(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The mats lie one behind the other on the tray.", ["row(mats)", "on(mats)"]),
        ("Two jugs are on the tray, one behind the other.", ["on(jug_1)", "on(jug_2)", "behind(jug_1, jug_2)"]),
        ("Place the jars one next to the other.", ["near_each_other(jars)"]),
    ],
)
def test_one_by_one_is_a_row(text: str, expected: list[str]) -> None:
    assert asserted_if_any(text) == expected


def test_a_side_of_the_surface_is_a_part_of_it() -> None:
    text = "The jug is on the right side of the table. The chair is on the left side of the table."
    assert asserted(text) == ["part(jug, 'right')", "left(chair, 'table')"]


def test_what_is_probably_wrong_is_a_message_only() -> None:
    reading = read("The jug is behind the cup. The cup is placed along with a spoon above eye level.")
    assert [str(f.content) for f in reading.stated] == ["behind(jug, cup)"]
    assert any("not the name of a thing" in problem.message for problem in reading.sentences[1].problems)


def test_a_place_before_either_is_not_an_option() -> None:
    reading = read("The pen is on the red mat, either beside the cup or behind the jug.")
    assert [(str(f.content), f.alternative) for f in reading.stated if not str(f.content).startswith("colour")] == [
        ("on(pen, mat)", None), ("next_to(pen, cup)", 1), ("behind(pen, jug)", 1),
    ]  # fmt: skip


def test_options_of_a_choice_are_not_denied() -> None:
    script = read_english("The fork is left of the plate, the bowl or the cup.")
    assert [(str(fact), fact.weight) for fact in script.facts] == [
        ("left(fork, plate)", 0.5), ("left(fork, bowl)", 0.5), ("left(fork, cup)", 0.5),
    ]  # fmt: skip


def test_names_of_figures_stand_without_an_article() -> None:
    first, second = read("Mary is left of the manger. A is behind the plate.").sentences
    assert (first.paraphrase, second.paraphrase) == ("Mary is left of the manger.", "A is behind the plate.")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("On the left, the cup must not stand.", ["not part(cup, 'left')"]),
        ("Behind the plate, the cup is not placed.", ["not behind(cup, plate)"]),
        ("To the left of the plate, never place the fork.", ["not left(fork, plate)"]),
        ("In the box, do not keep the pens.", ["not inside(pens, box)"]),
        ("Top right, never put the cup.", ["not part(cup, 'top right')"]),
        ("On the left, you should not place the cup.", ["not part(cup, 'left')"]),
        ("On the left, the cup must not stand on the mat.", ["not on(cup, mat)"]),
        ("Behind the jug, neither the cup nor the pen belongs.", ["not behind(cup, jug)", "not behind(pen, jug)"]),
        ("Do not place the fork but the spoon behind the jug.", ["not behind(fork, jug)", "behind(spoon, jug)"]),
        ("In the middle is not the vase but the jug.", ["not middle(vase)", "middle(jug)"]),
        ("The jug is behind the cup. On the left: never forks.", ["behind(jug, cup)"]),
        ("Forks left, knives right.", ["part(forks, 'left')", "part(knives, 'right')"]),
        ("On the red mat, the cup is not open.", ["on(cup, mat)", "not open(cup)"]),
    ],
)
def test_a_denial_denies_the_place_before_it(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The cup that stood on the mat is broken.", []),
        ("The cup formerly on the mat is red.", []),
        ("The fork is almost on the mat.", ["near(fork, mat)"]),
    ],
)
def test_what_was_so_or_is_nearly_so_is_not_a_place(text: str, expected: list[str]) -> None:
    assert [fact for fact in asserted(text) if not fact.startswith("state")] == expected


@pytest.mark.parametrize(
    "text",
    [
        "There is no place for the fork left of the plate. The cup is behind the jug.",
        "Is the proper place for the fork left of the plate? The cup is behind the jug.",
        "If you have guests, top right goes the fork. The cup is behind the jug.",
    ],
)
def test_places_missing_or_asked_for_give_no_facts(text: str) -> None:
    assert asserted(text) == ["behind(cup, jug)"]
