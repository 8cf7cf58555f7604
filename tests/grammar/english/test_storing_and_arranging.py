"""Facts of advice on where to store and arrange things, and sentences in it that state none."""

from __future__ import annotations

import pytest
from asserted_facts import asserted

from deixis.grammar.english.reader import read_english


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


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The box is filled with spoons.", ["inside(spoons, box)"]),
        ("The box is full of spoons.", ["inside(spoons, box)"]),
        ("The shelf is packed with books.", ["on(books, shelf)"]),
        ("Store the lids with the pots.", ["near(lids, pots)"]),
        ("Keep pens with pencils, cups with mugs.", ["near(pens, pencils)", "near(cups, mugs)"]),
        ("Don't store the lids with the pots.", ["not near(lids, pots)"]),
        ("Place the fork with the blue mat, the cup with the red one.", ["near(fork, blue_mat)", "near(cup, red_mat)"]),
        ("The left corner holds a lamp.", ["corner(lamp, 'left')"]),
        ("Fill in the corners with plants.", ["corner(plants)"]),
        ("The middle of the tray is occupied by a vase.", ["middle(vase)"]),
        ("The corner does not hold a lamp.", ["not corner(lamp)"]),
        ("Align the holes of the lid with the pegs. The cup is on the box.", ["aligned(holes, pegs)", "on(cup, box)"]),
        ("Align the holes on the legs with the pegs.", ["on(holes, legs)", "aligned(holes, pegs)"]),
        ("Drop the beam in near the jar.", ["near(beam, jar)"]),
        ("Place the following items on the box:\n- A cup.\n- A jug.", ["on(cup, box)", "on(jug, box)"]),
        ("Hide the key under the mat.", ["under(key, mat)"]),
        ("There is a box where I keep my pens.", ["inside(pens, box)"]),
        ("Next to the jar is a shelf where the cups and mugs are stored.",
         ["next_to(shelf, jar)", "on(cups, shelf)", "on(mugs, shelf)"]),
        ("There is a box where I do not keep my pens. The cup is on the jar.", ["on(cup, jar)"]),
        ("I prefer keeping cups and such in the box.", ["inside(cups, box)"]),
        ("The cabinet holds cups.", ["inside(cups, cabinet)"]),
        ("To the left as you walk in is the lamp.", ["part(lamp, 'left')"]),
        ("The lamp hangs a bit over half way up the ladder.", ["on(lamp, ladder)"]),
        ("With the bench lying on its front edge, attach the legs to the lid.", ["touching(legs, lid)"]),
        ("The desk stands back-to-back with the bench.", ["touching(desk, bench)"]),
        ("You want the lamp to be next to the jar.", ["next_to(lamp, jar)"]),
        ("You do not want the lamp to be next to the jar. The cup is on the box.", ["on(cup, box)"]),
        ("Next to the jar goes the fork, then the spoon.", ["next_to(fork, jar)", "next_to(spoon, jar)"]),
    ],
)  # fmt: skip
def test_fillings_companions_and_regions(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The cup is next to my cutting/sewing lamp.", ["next_to(cup, sewing_lamp)"]),
        ("Rice (grains boiled in broth) and similar foods are placed on the box.", ["on(rice, box)", "on(foods, box)"]),
        ("Once in the hall, the cup is left of the jug.", ["left(cup, jug)"]),
        ("Two cups, at ground level, are next to the jug.", ["next_to(cup_1, jug)", "next_to(cup_2, jug)"]),
        ("The cup is at or near the jug.", ["near(cup, jug)"]),
        ("There should, however, be a cup on the box.", ["on(cup, box)"]),
        ("A 24\" x 36\" mat lies on the box.", ["on(mat, box)"]),
        ("A 3\u2032 by 4\u2032 mat lies on the box.", ["on(mat, box)"]),
        ("\u2022Put the cup on the box.", ["on(cup, box)"]),
        ("A small to medium cup stands on the box.", ["on(cup, box)"]),
        ("The cup is known as a mug and stands on the box.", ["on(cup, box)"]),
        ("Place the nail 2 in. from the edge of the lid.", ["distance(nail, lid, 'edge', 0.0508 m)"]),
        ("Set the lamp in a quiet, peaceful corner.", ["corner(lamp)"]),
        ("The pots hang on the left to dry and the spoons hang on the right.",
         ["part(pots, 'left')", "part(spoons, 'right')"]),
        ("The candles come in various shapes and sizes. The cup is on the box.", ["on(cup, box)"]),
        ("The hall is open to the stairs. The cup is on the box.", ["on(cup, box)"]),
        ("As the bowl is on the box, put the cup on the jar.", ["on(bowl, box)", "on(cup, jar)"]),
    ],
)  # fmt: skip
def test_words_beside_the_thing_and_its_place(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The rice bowl is on the box. The bowl of soup is on the jar.", ["on(rice_bowl, box)", "on(bowl, jar)"]),
        ("Put a dish on the box and pour water into it. Fill the tank with water. Put the cup in the tank.",
         ["on(dish, box)", "inside(cup, tank)"]),
        ("The foot pieces are in the box. The large pieces are on the jar.",
         ["inside(foot_pieces, box)", "on(pieces, jar)"]),
        ("The white mat is on the box. One cup stands on each mat.", ["on(mat_1, box)", "on(cup, mat_2)"]),
        ("There are two boxes next to the jar. On the box that holds the tea lies a cup.",
         ["next_to(box_1, jar)", "next_to(box_2, jar)", "on(cup, box_1)"]),
        ("Put a cup on the first mat and a jug on the last mat.", ["on(cup, mat_1)", "on(jug, mat_2)"]),
        ("Three cups are in a row. The middle cup is on the box.", ["row(cup_1, cup_2, cup_3)", "on(cup_2, box)"]),
        ("Put the \u2018letter keys\u2019 in front of the lamp.", ["in_front(letter_keys, lamp)"]),
    ],
)  # fmt: skip
def test_which_vessels_and_pieces_are_others(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "The lid of the jar is red.",
        "The wand can go anywhere they fit.",
        "There is little or no dust on the jar.",
        "On the mat, rather than the fork, put the spoon.",
        "On the mat, the fork has no business.",
        "Phones have no place on the mat.",
        "On the mat few forks lie.",
    ],
)
def test_parts_places_and_denials_that_state_no_fact(text: str) -> None:
    reading = read_english(f"{text} The cup is in the box.").reading
    assert reading is not None
    found = [str(fact.content) for fact in reading.stated if fact.asserted and fact.content.positive]
    assert [f for f in found if not f.startswith(("inside(cup", "on(spoon", "count("))] == []


def test_qualities_that_or_joins_are_not_stated() -> None:
    reading = read_english("The plastic or rubber feet are in the box.").reading
    assert reading is not None
    assert [str(fact.content) for fact in reading.stated] == ["inside(feet, box)"]
