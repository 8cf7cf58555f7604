"""Facts of instructions with measures, numbered things, qualities and means, which are not things that have a place."""

from __future__ import annotations

import pytest
from asserted_facts import asserted

from deixis.grammar.english.reader import read_english
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.ontology.tbox import default_ontology


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The cork is in the top of the 25mm pipe.", ["part(cork, pipe, 'top')"]),
        ("Put a 100ml flask behind the two 500 ml jars.", ["behind(flask, jar_1)", "behind(flask, jar_2)"]),
        ("Stick a 2 cm round label on the box.", ["on(label, box)"]),
        ("The cup is 5 cm left of the plate.", ["distance(cup, plate, 0.05 m)", "left(cup, plate)"]),
        ("Label 1 points at the valve.", ["pointing(label_1, valve)"]),
        ("Box 3 holds the screws.", ["inside(screws, box_3)"]),
        ("Put a tile on point 13, a coin on point 8 and a die on point 6.",
         ["on(tile, point_13)", "on(coin, point_8)", "on(die, point_6)"]),
        ("The cups stand behind the box or on seats behind the stove.",
         ["behind(cups, box)", "behind(seats, stove)", "on(cups, seats)"]),
    ],
)  # fmt: skip
def test_measures_and_numbers_belong_to_names(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize("noun", ["awkward", "flush", "tangy", "formal", "sharpest", "simplest", "driest"])
def test_qualities_alone_name_no_thing(noun: str) -> None:
    assert not can_have_a_place(noun, known_nouns(default_ontology().kinds))


def test_ones_with_qualities_are_other_things() -> None:
    assert asserted("The lid is in the box. The tall jars stand behind the fragile ones.") == [
        "inside(lid, box)", "behind(jars, jar)"
    ]  # fmt: skip


@pytest.mark.parametrize("noun", ["parts contribute", "wall using nails"])
def test_pieces_of_clauses_name_no_thing(noun: str) -> None:
    assert not can_have_a_place(noun, known_nouns(default_ontology().kinds))


@pytest.mark.parametrize("noun", ["chest", "nest", "vest", "sharp knife", "crispy roll", "clothes line"])
def test_names_with_qualities_name_things(noun: str) -> None:
    assert can_have_a_place(noun, known_nouns(default_ontology().kinds))


@pytest.mark.parametrize(
    "text",
    [
        "Having the radios pointed toward the wall will cause echoes.",
        "Hanging small pans above the bar is handy.",
        "Setting the jug on the stove is dangerous.",
        "The rows are the hats, the most formal at the back.",
        "The jug is washed with soap.",
        "The jar is sealed with wax.",
        "The lid can be removed.",
        "Place the cold pans out before the hot pans.",
        "The desk is in oak.",
        "The band is made up of four sections.",
        "Divide the desk by the rule of thirds.",
        "Do not place soiled, chipped, or cracked jars and pans or bent or tarnished forks next to the jug.",
    ],
)
def test_acts_means_and_possible_states_are_not_stated(text: str) -> None:
    reading = read_english(f"The cup is in the box. {text}").reading
    assert reading is not None
    assert [str(fact.content) for fact in reading.stated if fact.asserted] == ["inside(cup, box)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Hanging above the stove is a lamp.", ["above(lamp, stove)"]),
        ("The shelf is stocked with jars. The lid is in the box.", ["on(jars, shelf)", "inside(lid, box)"]),
        ("Fix the panel on battens rather than flat against the pipe.",
         ["on(panel, battens)", "not against(panel, pipe)"]),
        ("The card is turned face up and set next to the pile.", ["next_to(card, pile)"]),
        ("Place the jug as well as the lamp behind the box.", ["behind(jug, box)", "behind(lamp, box)"]),
        ("The rest of the deck is placed next to the coin.", ["next_to(deck, coin)"]),
        ("Place the towel that you have just folded behind the box.", ["behind(towel, box)"]),
        ("Place the jug you filled behind the box.", ["behind(jug, box)"]),
        ("Forks go to the left and knives to the right of the plate.", ["left(forks, plate)", "right(knives, plate)"]),
        ("Put the salt in front and the pepper behind the jug.", ["in_front(salt, jug)", "behind(pepper, jug)"]),
        ("Put the lamp on the left side of the desk next to the screen.",
         ["next_to(lamp, screen)", "part(lamp, desk, 'left')"]),
        ("The pens hang on the left side of the board and the pins on the right. The lid is in the box.",
         ["part(pens, board, 'left')", "part(pins, board, 'right')", "inside(lid, box)"]),
        ("The centerpiece stands on the cloth, with candles on either side.",
         ["on(centerpiece, cloth)", "each_side(candles, centerpiece)"]),
        ("The only exception is the oyster fork, which is placed to the right of the spoons.",
         ["right(oyster_fork, spoons)"]),
        ("The last step is the napkin, which goes in the box.", ["inside(napkin, box)"]),
        ("Any type of napkin can be placed behind the jug.", ["behind(napkin, jug)"]),
        ("A selection of cheeses stands next to the jug.", ["next_to(cheeses, jug)"]),
        ("A simply folded napkin is laid behind the jug.", ["behind(napkin, jug)"]),
        ("Sort papers into the box.", ["inside(papers, box)"]),
        ("A cup of coffee with saucer and spoon stands behind the jug.", ["behind(cup, jug)"]),
        ("Put the coins on the trade space, and the cards in the corresponding space.",
         ["on(coins, trade_space)", "inside(cards, space)"]),
        ("In either case, place the plates next to the jug.", ["next_to(plates, jug)"]),
        ("Add the candles to glass jars of different sizes.", ["inside(candles, jars)"]),
        ("The southern wall is blue. Two boards lie above the jug: the cans sit on the upper one.",
         ["above(board_1, jug)", "above(board_2, jug)", "on(cans, board_1)"]),
        ("In front of the rice, serve the salt.", ["in_front(salt, rice)"]),
        ("Serve the butter with a fork. The lid is on the pan.", ["on(lid, pan)"]),
        ("Another thing that must be set in front of the rice is the lemon.", ["in_front(lemon, rice)"]),
        ("A flask sits on the base of the stand below the burner.", ["below(flask, burner)", "on(flask, stand)"]),
        ("Center the plate on the table in front of each chair.", ["in_front(plate, chair)", "middle(plate, table)"]),
    ],
)  # fmt: skip
def test_facts_of_restricted_and_shared_phrases(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


def test_lines_that_begin_with_capitals_are_sentences() -> None:
    lines = (
        "Place the tea cup and the saucer of each guest at the right of the spoons and behind the jug of milk",
        "Set the small plates above the forks that are used for the cake, so that they can be reached with ease",
        "Put a fork behind the jug of milk, with the tines up, where everyone who wants to use it can reach it",
        "Serve the cheese with a knife, and never with the fingers, as some guests like to do when they are in a hurry",
    )
    reading = read_english("\n".join(lines)).reading
    assert reading is not None
    assert [sentence.text for sentence in reading.sentences] == list(lines)


def test_wrapped_lines_are_one_sentence() -> None:
    text = (
        "The cup stands on the tray that my aunt brought back with her from a journey to the north of\n"
        "Italy, next to the jug with the blue handle, which is the one that she used most often in\n"
        "summer, and behind the jug there is a box of the biscuits that she liked to eat with her tea\n"
        "when the whole family came to visit."
    )
    reading = read_english(text).reading
    assert reading is not None
    assert len(reading.sentences) == 1


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Rinse the beaker with some solvent. The beaker stands on the tray.", ["on(beaker)"]),
        ("Wet the filter paper with water and put it in the funnel.", ["inside(filter_paper, funnel)"]),
    ],
)
def test_means_of_washing_are_not_contents(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


def test_prices_count_nothing() -> None:
    assert asserted("My $300 computer is on the desk.") == ["on(computer)"]


def test_cabinet_houses_things() -> None:
    assert asserted("The bench houses my sander.") == ["inside(sander, bench)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the drums in the center of the stage on a riser.", ["middle(drums, stage)", "on(drums, riser)"]),
        ("Put the lamp in the corner of the desk on a book.", ["corner(lamp)", "on(lamp, book)"]),
    ],
)
def test_new_support_after_a_region_is_that_of_the_thing(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected
