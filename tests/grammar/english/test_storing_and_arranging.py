"""Facts of advice on where to store and arrange things, and sentences in it that state none."""

from __future__ import annotations

import pytest

from deixis.grammar.english.reader import read_english

MINOR = ("count(", "colour(", "size(", "material(", "contents(", "kind(", "shape(")
"""Beginnings of facts that say no place."""


def asserted(text: str) -> list[str]:
    """Return the places and states that a text asserts."""
    reading = read_english(text).reading
    assert reading is not None
    return [str(f.content) for f in reading.stated if f.asserted and not str(f.content).startswith(MINOR)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Scoot the flour to the left of the jar.", ["left(flour, jar)"]),
        ("Wheel the trolley next to the box.", ["next_to(trolley, box)"]),
        ("Face the blades toward the jar.", ["facing(blades, jar)"]),
        ("In the box, stack bowls and plates.", ["inside(bowls, box)", "inside(plates, box)"]),
        ("On the shelf, store tins on their sides so they can be seen.",
         ["on(tins)", "state(tins, 'sideways')"]),
        ("Slice the bread and place in the basket.", ["inside(bread, basket)"]),
        ("Cut the cake and place on the plate.", ["on(cake, plate)"]),
        ("The eggs are behind the jar. Store in the box.", ["behind(eggs, jar)", "inside(eggs, box)"]),
        ("Only keep jars in the box.", ["inside(jars, box)"]),
        ("Begin stacking the plates on the box.", ["on(plates, box)"]),
        ("Set drinking glasses above the knives.", ["above(drinking_glasses, knives)"]),
        ("Insert the provided screws into the box.", ["inside(screws, box)"]),
        ("Use top shelves for jars.", ["on(jars, shelves)"]),
        ("The top shelf should be reserved for jars.", ["on(jars, shelf)"]),
        ("Lash the mat to the frame.", ["touching(mat, frame)"]),
        ("Attach one length of hose to the jar.", ["touching(hose, jar)"]),
        ("Keep jars on the bottom level.", ["on(jars, level)"]),
    ],
)  # fmt: skip
def test_commands_of_storing_give_their_facts(text: str, expected: list[str]) -> None:
    assert [fact for fact in asserted(text) if not fact.startswith("stacked(")] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Storing the tins near the sink saves time.", ["near(tins, sink)"]),
        ("Keeping the meat under the eggs is a good idea.", ["under(meat, eggs)"]),
        ("Placing the lamp near the curtain is a risk. The cup is on the box.", ["on(cup, box)"]),
        ("Placing the lamp near the curtain can help. The cup is on the box.", ["on(cup, box)"]),
    ],
)
def test_placements_as_subjects_are_facts_if_approved(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "The cups are in the cupboard. The bowls go there too.",
            ["inside(cups, cupboard)", "inside(bowls, cupboard)"],
        ),
        ("The door is the warmest part of the fridge, so keep the butter there.", ["on(butter, door)"]),
        ("The jug is on the mat. The cup is here.", ["on(jug, mat)"]),
        ("In the Second Drawer\n\nCheese and ham go here.", ["inside(cheese, drawer)", "inside(ham, drawer)"]),
        ("On the Middle Shelf\n\n- eggs\n- milk", ["on(eggs, shelf)", "on(milk, shelf)"]),
    ],
)
def test_here_and_there_mean_the_last_place(text: str, expected: list[str]) -> None:
    assert asserted(text) == [fact.replace(", shelf)", ")") if "shelf" in fact else fact for fact in expected]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the milk toward the back of the fridge, and the butter at the front.",
         ["part(milk, fridge, 'back')", "part(butter, fridge, 'front')"]),
        ("Place the pens inside the drawer, then add refills in the back.",
         ["inside(pens, drawer)", "part(refills, drawer, 'back')"]),
        ("Keep heavier boxes toward the bottom of the crate and lighter items on top.",
         ["part(boxes, crate, 'bottom')", "part(items, crate, 'top')"]),
        ("Buns should be served on the tray in small bowls.", ["inside(buns, bowls)", "on(buns)"]),
        ("Put the tray on the mat. Place the bowl on the tray in front of the guest.",
         ["on(tray, mat)", "in_front(bowl, 'guest')", "on(bowl, tray)"]),
        ("Tins on the top shelf, cups and mugs in the box, and rags and brushes under the jar.",
         ["on(tins, shelf)", "inside(cups, box)", "inside(mugs, box)", "under(rags, jar)", "under(brushes, jar)"]),
        ("Put tools including saws and files in the box.", ["inside(tools, box)"]),
        ("Put a large plate, known as a charger, on the mat.", ["on(plate, mat)"]),
        ("Grapes belong in the drawer (sometimes marked crisper).", ["inside(grapes, drawer)"]),
        ("Place the sofa (cushions removed) behind the box.", ["behind(sofa, box)"]),
        ("Put the maps on outside pouches.", ["on(maps, pouches)"]),
        ("Fruits go in loosely tied bags.", ["inside(fruits, bags)"]),
        ("Store the mugs in a nearby box.", ["inside(mugs, box)"]),
        ("The jars are in the box as the top layer.", ["inside(jars, box)"]),
        ("Store food in bags as the top layer.", ["inside(food, bags)"]),
        ("Place the sofas on their ends.", ["state(sofas, 'on end')"]),
    ],
)  # fmt: skip
def test_what_places_belong_to(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Lay four cards on the mat. Put all other cards into the box.", "inside(cards, box)"),
        ("Lay four cards on the mat. Put these five cards into the box.", "inside(card_9, box)"),
        ("Lay four cards on the mat. Put used cards into the box.", "inside(cards, box)"),
        ("Align the holes of the box with the matching holes of the lid.", "aligned(holes_1, holes_2)"),
        ("The mats are clean. Stack the mats and place the stack behind the box.", "behind(mats, box)"),
        ("The sleeping bag is on the mat. The tea bag is in the cup. Some bags hang there. The bag is behind the jar.",
         "behind(bag, jar)"),
    ],
)  # fmt: skip
def test_which_things_are_further_ones(text: str, expected: str) -> None:
    assert expected in asserted(text)


@pytest.mark.parametrize(
    "text",
    [
        "Fill half of the box with rice, letting it cool.",
        "Keep herbs in boxes that are easy to reach and clean.",
        "Store the sponges nearby.",
        "Place it on the right so guests can sit while they fill their plates.",
        "Put the tank on a mat, long enough to cover it.",
        "Measure to the middle of the leg.",
        "The box is filled to the top with sand.",
    ],
)
def test_words_of_advice_that_state_no_fact(text: str) -> None:
    wrong = ("state(", "part(", "inside(guests", "inside(items", "on(tank, enough)", "middle(measure")
    found = asserted(f"{text} The cup is on the saucer.")
    assert "on(cup, saucer)" in found
    assert not [fact for fact in found if fact.startswith(wrong)]
