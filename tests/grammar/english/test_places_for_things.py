"""Facts of advice on what a place is for, of things told by their use, of references to pictures, and of actions."""

from __future__ import annotations

import pytest
from asserted_facts import asserted

from deixis.grammar.english.reader import read_english
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.grammar.errors import ScriptError
from deixis.ontology.tbox import default_ontology


def asserted_if_any(text: str) -> list[str]:
    """Return the places that a text asserts; none if no fact of it was understood."""
    try:
        return asserted(text)
    except ScriptError:
        return []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The middle drawer is used for pens.", ["inside(pens, drawer)"]),
        ("The middle drawer is a good place for storing pens.", ["inside(pens, drawer)"]),
        ("The middle drawer is a good place to store pens.", ["inside(pens, drawer)"]),
        ("Use the middle drawer to store pens and rulers.", ["inside(pens, drawer)", "inside(rulers, drawer)"]),
        ("The lower shelf is where the jars go.", ["on(jars, shelf)"]),
        ("The lower shelf is home to the jars.", ["on(jars, shelf)"]),
        ("The lower shelf works well for jars.", ["on(jars, shelf)"]),
        ("The lower shelf is ideal for jars, bowls and pots.",
         ["on(jars, shelf)", "on(bowls, shelf)", "on(pots, shelf)"]),
        ("Designate a drawer for batteries.", ["inside(batteries, drawer)"]),
        ("Dedicate one drawer to batteries.", ["inside(batteries, drawer)"]),
        ("The top shelf should be reserved for foods that need no cooking.", ["on(foods, shelf)"]),
        ("The left side is for forks.", ["part(forks, 'left')"]),
        ("The space behind the piano is perfect for a broom.", ["behind(broom, piano)"]),
        ("Use the upper rack for cups and the lower rack for plates.",
         ["inside(cups, top_rack)", "inside(plates, bottom_rack)"]),
    ],
)  # fmt: skip
def test_what_a_place_is_for_tells_what_is_there(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "The shelf is perfect for small kitchens.",
        "The drawer is not for knives.",
        "If the drawer is for knives, put them there.",
        "The tray is used for serving drinks.",
        "The top shelf could be used for jars.",
        "The drawer is ideal for guests.",
        "The small fork is for salads.",
    ],
)
def test_other_purposes_state_no_places(text: str) -> None:
    assert asserted_if_any(text) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The cup is by the jug. The things you need often belong in the top drawer.",
         ["near(cup, jug)", "inside(things, drawer)"]),
        ("Store the toys your children play with in low bins.", ["inside(toys, bins)"]),
        ("Items you will need quick access to should be kept in the pouch.", ["inside(items, pouch)"]),
        ("The pieces that you want to display go on the box.", ["on(pieces, box)"]),
        ("Keep anything you rarely use in the crate.", ["inside(thing, crate)"]),
        ("The books we have not read are in the crate.", ["inside(books, crate)"]),
        ("The jars that you use for cooking are in the crate.", ["inside(jars, crate)"]),
    ],
)  # fmt: skip
def test_clauses_of_use_tell_which_things_are_meant(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Slide the drawer into the box (above).", ["inside(drawer, box)"]),
        ("Bolt the legs to the frame (inset).", ["touching(legs, frame)"]),
        ("The router (left) sits behind the lamp.", ["behind(router, lamp)"]),
        ("Place the jug (see page 65) on the box.", ["on(jug, box)"]),
        ("Put the basket (mine is from a market) on the box.", ["on(basket, box)"]),
        ("Add a shrub (boxwood is a good choice, or rosemary) to the left of the gate.", ["left(shrub, gate)"]),
        ("The fork (left) and the knife (right) belong together.", ["part(fork, 'left')", "part(knife, 'right')"]),
    ],
)
def test_references_and_comments_in_parentheses_state_no_place(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Stuff socks in the box.", ["inside(socks, box)"]),
        ("File letters in the box.", ["inside(letters, box)"]),
        ("Reposition cups in the box.", ["inside(cups, box)"]),
        ("Ease the tray into the slot.", ["inside(tray, slot)"]),
        ("Oftentimes, the cups are in the box.", ["inside(cups, box)"]),
        ("Traditionally the cups are in the box.", ["inside(cups, box)"]),
        ("Do not hesitate to put the cup in the box.", ["inside(cup, box)"]),
    ],
)
def test_verbs_and_adverbs_at_the_beginning_are_not_names(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    "text", ["Polish spoons in the sink.", "Chop onions on the board.", "Rinse one cup in the sink."]
)
def test_places_of_actions_are_not_those_of_their_objects(text: str) -> None:
    assert asserted_if_any(text) == []


@pytest.mark.parametrize("noun", ["humidity", "airflow", "lightning strike", "responsibility"])
def test_abstract_nouns_have_no_place(noun: str) -> None:
    assert not can_have_a_place(noun, known_nouns(default_ontology().kinds))


@pytest.mark.parametrize("noun", ["vanity", "nativity", "commodity", "cavity"])
def test_things_named_like_qualities_have_places(noun: str) -> None:
    assert can_have_a_place(noun, known_nouns(default_ontology().kinds))


def test_the_thing_to_do_is_not_an_object() -> None:
    reading = read_english("The cup is on the box. The thing to do is to hang the lamp above the box.").reading
    assert reading is not None
    assert [str(fact.content) for fact in reading.stated if fact.asserted] == ["on(cup, box)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Two stools are by the sofa. Put your center stool near the lamp.", ["near(stool_3, lamp)"]),
        ("Two stools are by the sofa. The rear stools go behind the lamp.", ["behind(stools, lamp)"]),
        ("Three stools are by the sofa. The middle stool is near the lamp.", ["near(stool_2, lamp)"]),
        ("The stools stay. Each of the two stools stands near your lamp.",
         ["near(stool_1, lamp)", "near(stool_2, lamp)"]),
        ("The hamper is red. This is the closet in my attic.", ["inside(closet, attic)"]),
        ("The hamper is red. That is the chair next to the lamp.", ["next_to(chair, lamp)"]),
        ("Build an altar with three levels. On the top level of the altar, place a cup.", ["on(cup, level)"]),
    ],
)  # fmt: skip
def test_positions_and_pointing_words_name_other_things(text: str, expected: list[str]) -> None:
    assert [fact for fact in asserted(text) if "sofa" not in fact and not fact.startswith("colour(")] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The mirror hangs above the chest, with a lamp on each side.",
         ["above(mirror, chest)", "each_side(lamp_1, mirror)", "each_side(lamp_2, mirror)"]),
        ("The bed stands against the wall with a lamp on either side.",
         ["each_side(lamp_1, bed)", "each_side(lamp_2, bed)", "against(bed, 'wall')"]),
        ("The drawer has knives in front and forks in back.",
         ["part(knives, drawer, 'front')", "part(forks, drawer, 'back')"]),
        ("Place larger pots in the back and smaller ones in front.", ["part(pots, 'back')", "part(pot, 'front')"]),
        ("Mount a rack on the inside of the door.", ["on(rack, door)"]),
        ("There is a place for the broom behind the piano.", ["behind(broom, piano)"]),
        ("The box holds a stack of books and a pile of papers.", ["inside(stack, box)", "inside(pile, box)"]),
        ("The box holds a jug of milk and a glass of water.", ["inside(jug, box)", "inside(glass, box)"]),
        ("Top shelf: plates. Bottom shelf: heavy pots.", ["on(plates, top_shelf)", "on(pots, bottom_shelf)"]),
        ("Roof box: sleeping bags and pillows.", ["inside(sleeping_bags, roof_box)", "inside(pillows, roof_box)"]),
    ],
)  # fmt: skip
def test_what_holders_have_and_labels_say_tells_places(text: str, expected: list[str]) -> None:
    assert [fact for fact in asserted(text) if not fact.startswith("contents(")] == expected


def test_a_tray_after_the_label_of_a_jug_is_not_its_contents() -> None:
    assert asserted_if_any("Jug: tray. The cup is by the lamp.") == ["near(cup, lamp)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("To the statue's left (your right as you face it), place a cup.", ["left(cup, statue)"]),
        ("Buy a rug to put under the lamp.", ["under(rug, lamp)"]),
        ("You now have a bundle of shirts to place behind the crate.", ["behind(bundle, crate)"]),
        ("Put the eggs where the air stays cool, normally behind the jug.", ["behind(eggs, jug)"]),
        ("Roll ties loosely and place behind the crate.", ["behind(ties, crate)"]),
    ],
)
def test_places_in_other_words_and_intended_places_are_read(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize("text", ["I have three cups to put on the box.", "The chest is too tall to stand on the box."])
def test_plans_and_impossible_places_are_not_facts(text: str) -> None:
    assert [fact for fact in asserted_if_any(text) if fact.startswith("on(")] == []


def test_the_letter_a_after_a_noun_is_part_of_its_name() -> None:
    assert asserted("Attach panel B to panel A using four screws.") == ["touching(panel_b, panel_a)"]


def test_things_told_by_their_use_are_not_those_named_before() -> None:
    text = "Put heavy items in the middle of the pack. Put items you rarely use at the top of the pack."
    assert asserted(text) == ["middle(items_1, pack)", "part(items_2, pack, 'top')"]
