"""Facts of instructions to build, pack and set up things, and sentences in them that state none."""

from __future__ import annotations

import pytest
from asserted_facts import MINOR
from asserted_facts import asserted as asserted_except

from deixis.grammar.english.reader import read_english
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.grammar.english.vocabulary.things import can_have_a_place
from deixis.grammar.reading import Reading
from deixis.ontology.tbox import default_ontology


def read(text: str) -> Reading:
    reading = read_english(text).reading
    assert reading is not None
    return reading


def asserted(text: str) -> list[str]:
    """Return the places that a text asserts."""
    return asserted_except(text, (*MINOR, "state("))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The lid is then placed on the pot.", ["on(lid, pot)"]),
        ("The nurse then places the towel behind the box.", ["behind(towel, box)"]),
        ("Put shredded bark around the fern.", ["around(bark, fern)"]),
        ("Mounted lamps should be hung above the fern.", ["above(lamps, fern)"]),
        ("Lay the cloth on the box, and lift and fold the corners over the dough.",
         ["on(cloth, box)", "on(corners, dough)"]),
        ("Make a thin layer of sand on the gravel.", ["on(sand, gravel)"]),
        ("After oiling the hinge, replace the lid on the box.", ["on(lid, box)"]),
        ("Replace the cup with a glass. The jug is on the box.", ["on(jug, box)"]),
        ("In one corner place the dish and in the corner next to it put the bottle.",
         ["corner(dish)", "corner(bottle)", "next_to(bottle, dish)"]),
        ("Place the cup on the saucer and to the left of it put the spoon.",
         ["on(cup, saucer)", "left(spoon, cup)"]),
        ("Screwdrivers go in the drawer right beneath the lid.",
         ["under(drawer, lid)", "inside(screwdrivers, drawer)"]),
        ("Place the jar on a flat, stable slab.", ["on(jar, stable_slab)"]),
        ("A probe and a mirror are commonly put on the cloth.", ["on(probe, cloth)", "on(mirror, cloth)"]),
        ("Put the spears on the corresponding spaces.", ["on(spears, spaces)"]),
        ("Your speaker should be above your wall display.", ["above(speaker, wall_display)"]),
    ],
)  # fmt: skip
def test_commands_and_what_they_put(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("In the case of small jars, the lids are kept in the drawer.", ["inside(lids, drawer)"]),
        ("In such a case, the boxes must not be next to the stove.", ["not next_to(boxes, stove)"]),
        ("Broadly speaking, the fern should stand behind the moss.", ["behind(fern, moss)"]),
        ("In lifting the drum, keep the sticks in the bag.", ["inside(sticks, bag)"]),
        ("Put the brush on the jar and, working clockwise, lay the tiles around the drain.",
         ["on(brush, jar)", "around(tiles, drain)"]),
        ("Spread the mat behind the jug, ensuring the corners lie on the frame.", ["behind(mat, jug)"]),
        ("Set the bell behind the jug, leaving the rope on the hook.", ["behind(bell, jug)", "on(rope, hook)"]),
        ("The gongs are behind the harp and higher in tone than the bells.", ["behind(gongs, harp)"]),
        ("Put small tools, such as awls, files and rasps, in the crate.", ["inside(tools, crate)"]),
        ("Pack heavy things, like jars, tins and books, in the crate.", ["inside(things, crate)"]),
        ("Line the crate with a soft liner, such as straw or wool.", ["inside(liner, crate)"]),
        ("Put the tools that you use the most in the top drawer.", ["inside(tools, drawer)"]),
        ("Lay the tokens beside the box, letter side up.", ["next_to(tokens, box)"]),
        ("Set the rooks (the pieces that look like towers) on the corner squares.", ["on(rooks, corner_squares)"]),
        ("Place a pot behind the jug to save potting mix.", ["behind(pot, jug)"]),
        ("The king is next to the queen, followed by the rook, bishop and knight.",
         ["next_to(king, queen)", "next_to(rook, king)", "next_to(bishop, rook)", "next_to(knight, bishop)"]),
    ],
)  # fmt: skip
def test_phrases_beside_the_statement(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Use flat trays for nails and screws and keep them in the cabinet.", ["inside(trays, cabinet)"]),
        ("Take your heavy tins and put them under the bed.", ["under(tins, bed)"]),
        ("The sleeping bag goes into the bag.", ["inside(sleeping_bag, bag)"]),
        ("The files hang in the top drawers, and the rulers go into the shallow drawer.",
         ["inside(files, drawers)", "inside(rulers, drawer)"]),
        ("The wine glasses stand behind the jug. The tall glass stands near the pot.",
         ["behind(wine_glasses, jug)", "near(glass, pot)"]),
        ("The paper napkins are behind the jug. Folded napkins are near the pot.",
         ["behind(paper_napkins, jug)", "near(napkins, pot)"]),
        ("Heaviest things should be kept in the middle of the crate.", ["middle(things, crate)"]),
        ("The lid of the jar is behind the cup.", ["behind(lid, cup)"]),
        ("The nurse should place the lid of the jar behind the cup.", ["behind(lid, cup)"]),
        ("The lid of the box faces the wall.", ["facing(box, 'wall')"]),
        ("The speakers stand at opposite ends of the rail.", ["end(speakers, rail)"]),
        ("Put the 8' boards under the bed.", ["under(boards, bed)"]),
    ],
)  # fmt: skip
def test_which_thing_of_several_is_meant(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the lamp on the desk next to the phone.", ["next_to(lamp, phone)", "on(lamp, desk)"]),
        ("There is a vase on the shelf behind the books.", ["behind(vase, books)", "on(vase, shelf)"]),
        ("Put the tray on the bench next to the sofa.", ["next_to(bench, sofa)", "on(tray, bench)"]),
        ("Put the cup on the tray next to the jug. The pot is on the box.",
         ["next_to(tray, jug)", "on(cup, tray)", "on(pot, box)"]),
    ],
)  # fmt: skip
def test_places_beside_things_on_the_same_support(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("She suggested we put the lamp behind the sofa. The cup is on the box.", ["on(cup, box)"]),
        ("Fix it by drilling two screws in the frame. The cup is on the box.", ["on(cup, box)"]),
        ("Put the glass on the paper and wrap it around it.", ["on(glass, paper)"]),
        ("One side has a lamp above or below the box. The cup is on the jar.", ["on(cup, jar)"]),
        ("This light creates a glow behind the vase. The cup is on the jar.", ["on(cup, jar)"]),
        ("Tools are kept in the highest drawers.", ["inside(tools, drawers)"]),
        ("Turn the label away from you.", ["facing(label, 'away')"]),
        ("The crate is bolted to the frame by a bracket.", ["touching(crate, frame)"]),
        ("The towel is tucked behind the box by the nurse.", ["behind(towel, box)"]),
        ("The cup is placed by the lamp.", ["near(cup, lamp)"]),
        ("Put the cup behind the jug without placing the spoon next to it.", ["behind(cup, jug)"]),
        ("The chest is behind the door, not covered by a cloth.", ["behind(chest, door)", "not on(cloth, chest)"]),
        ("Put a three drawer unit behind the box.", ["behind(drawer_unit, box)"]),
        ("Stand the lamp in front of the chair on the opposite side of the vase.",
         ["opposite(lamp, vase)", "in_front(lamp, chair)"]),
        ("Place the jar on a clean cloth with the inside facing up.", ["on(jar, cloth)", "facing(jar, 'up')"]),
    ],
)  # fmt: skip
def test_words_that_state_no_place(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize("noun", ["enough water flow", "drilling two screws"])
def test_amounts_and_acts_have_no_place(noun: str) -> None:
    assert not can_have_a_place(noun, known_nouns(default_ontology().kinds))


def test_needs_and_alternative_names_state_nothing() -> None:
    reading = read("The jar stands on the box, which needs to be emptied. The pieces are known as pawns.")
    assert [str(fact.content) for fact in reading.stated if fact.asserted] == ["on(jar, box)"]


@pytest.mark.parametrize(
    "text",
    [
        "Place a spoon or a fork next to the plate.",
        "A spoon or a fork lies next to the plate.",
        "Cover the bowl with a cloth or a lid.",
    ],
)
def test_things_joined_by_or_are_a_choice(text: str) -> None:
    first, second = read(text).stated
    assert first.alternative is not None
    assert first.alternative == second.alternative
    assert first.content.optional and second.content.optional


@pytest.mark.parametrize(
    "text",
    ["Knives or scissors go into the drawer.", "Stones and/or bricks lie in the drawer.",
     "A knife or a fork must not be in the drawer."],
)  # fmt: skip
def test_kinds_and_denials_joined_by_or_are_not(text: str) -> None:
    assert all(fact.alternative is None for fact in read(text).stated)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("We highly recommend using a mat under the chair.", ["under(mat, chair)"]),
        ("I don't recommend placing the lamp near the bed.", ["not near(lamp, bed)"]),
        ("Consider placing the fern behind the vase.", ["behind(fern, vase)"]),
        ("It makes sense to put the mugs next to the kettle.", ["next_to(mugs, kettle)"]),
        ("It makes little sense to put the mugs next to the kettle.", []),
        ("It's smart to keep your lamp near the bed.", ["near(lamp, bed)"]),
        ("You will want to put the jar behind the box.", ["behind(jar, box)"]),
        ("They will want to put the jar behind the box. The lid is on the jar.", ["on(lid, jar)"]),
        ("The placement of the spoon should be to the right of the cup.", ["right(spoon, cup)"]),
        ("The position of the lamp is important. The jar is on the box.", ["on(jar, box)"]),
        ("They recommend placing the lamp near the bed. The jar is on the box.", ["on(jar, box)"]),
        ("We considered placing the lamp near the bed. The jar is on the box.", ["on(jar, box)"]),
        ("If it flickers, try putting the clock behind the vase.", []),
    ],
)  # fmt: skip
def test_advice_is_read_as_a_command(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Protect the towels by putting them in a crate under the bench.",
         ["under(crate, bench)", "inside(towels, crate)"]),
        ("The gas is then collected by placing a tube behind the flask.", ["behind(tube, flask)"]),
        ("By placing the desk behind the sofa, you gain room before the guests come.", ["behind(desk, sofa)"]),
        ("The bone is on the plate. Cool the egg by placing it in the jar.", ["on(bone, plate)", "inside(egg, jar)"]),
        ("The jars are carried by keeping both hands under the tray. The lid is on the box.", ["on(lid, box)"]),
        ("The game was started by placing a card next to the box. The lid is on the jar.", ["on(lid, jar)"]),
        ("Don't clean the lid by placing it in the jar. The box is behind the fern.", ["behind(box, fern)"]),
        ("You can save room by placing the lamp on the box. The fern is behind the vase.", ["behind(fern, vase)"]),
        ("Save room by hanging it on the hook if you like. The fern is behind the vase.", ["behind(fern, vase)"]),
    ],
)  # fmt: skip
def test_means_that_are_placements(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Set tea and coffee pots on the box.", ["on(tea_pot, box)", "on(coffee_pots, box)"]),
        ("Set fruit juice and cocktail glasses behind the box.",
         ["behind(fruit_juice_glass, box)", "behind(cocktail_glasses, box)"]),
        ("Place soup and dessert spoons behind the box.", ["behind(soup_spoon, box)", "behind(dessert_spoons, box)"]),
        ("Put food and water bottles in the crate.", ["inside(food, crate)", "inside(water_bottles, crate)"]),
        ("Place a plate and dessert spoons behind the box.", ["behind(plate, box)", "behind(dessert_spoons, box)"]),
        ("Keep the jar near the vase, but not too close to the stove or the oven.",
         ["near(jar, vase)", "not near(jar, stove)", "not near(jar, oven)"]),
        ("The cap is on the box, along with the jar.", ["on(cap, box)", "on(jar, box)"]),
        ("The lids and napkins can either be placed near the box or behind it.",
         ["near(lids, box)", "near(napkins, box)", "behind(lids, box)", "behind(napkins, box)"]),
        ("Set the jars on mats or small boxes to protect the cloth.", ["on(jars, mats)", "on(jars, boxes)"]),
        ("Tools that are used very little can easily be kept behind the box.", ["behind(tools, box)"]),
    ],
)  # fmt: skip
def test_coordinated_things_and_places(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Keep cleaning supplies like sprays, sponges, and cloths under the box.", ["under(cleaning_supplies, box)"]),
        ("Items such as soap, sponges and brushes go behind the box.", ["behind(items, box)"]),
        ("Store small things like keys, a knife, or your phone in the crate.", ["inside(things, crate)"]),
        ("Put the plate, cup with a lid, spoon and fork on the box.",
         ["on(plate, box)", "on(cup, box)", "on(spoon, box)", "on(fork, box)"]),
        ("In the crate there is a drum, a doll with a hat, a kite and a ball.",
         ["inside(drum, crate)", "inside(doll, crate)", "inside(kite, crate)", "inside(ball, crate)"]),
        ("You should have a tarp that goes under the tent, the tent body, poles and stakes.", ["under(tarp, tent)"]),
        ("The chest contains a mat under the jar, a rope and a lamp.",
         ["inside(mat, chest)", "inside(rope, chest)", "inside(lamp, chest)", "under(mat, jar)"]),
        ("We have a rug between the jar, the chair and the box.", ["between(rug, jar, chair, box)"]),
    ],
)  # fmt: skip
def test_members_of_lists_are_all_placed(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Slide the crate with the hinges onto the rack.", ["on(crate, rack)"]),
        ("Insert the board with drilled holes into the slot.", ["inside(board, slot)"]),
        ("Drop the bag of tea with the paper tag into the pot.", ["inside(bag, pot)"]),
        ("Place on the stove the kettle.", ["on(kettle, stove)"]),
        ("Insert into the slot, the panel of glass.", ["inside(panel, slot)"]),
        ("Push the rods into one arm.", ["inside(rods, arm)"]),
        ("The cup is one arm from the jug.", ["distance(cup, jug, 0.7 m)"]),
    ],
)
def test_goal_of_motion_is_that_of_the_object(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Fix the seat by sliding the bar between the legs.", ["between(bar, leg_1, leg_2)"]),
        ("Fasten it by inserting screws into the holes.", ["inside(screws, holes)"]),
        ("Pack the dish by wrapping each bowl and then putting them in a box. The lid is on the box.",
         ["on(lid, box)"]),
    ],
)  # fmt: skip
def test_means_put_things_where_the_sentence_says(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put two to three lemons in the jug.", ["inside(lemons, jug)"]),
        ("Stand three/four candles on the box.", ["on(candles, box)"]),
        ("Put a 5 mm to 10 mm layer of moss on the box.", ["on(moss, box)"]),
        ("Move the dial from two to three. The jug is on the box.", ["on(jug, box)"]),
    ],
)
def test_ranges_of_numbers_count_things(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Lay the lid face down on the towel.", ["on(lid, towel)", "upside_down(lid)"]),
        ("Turn the stool on its back.", []),
        ("Place the stool in the proper position on the mat.", ["on(stool, mat)"]),
        ("Put these wrapped cups in the box.", ["inside(cups, box)"]),
        ("Fill the bottom third of the jar with pebbles.", ["inside(pebbles, jar)"]),
        ("Pour beads in your favourite colour into the bowl.", ["inside(beads, bowl)"]),
        ("Push the stool back to make room. The jug is on the mat.", ["on(jug, mat)"]),
        ("Set aside a shelf for pans. The jug is on the mat.", ["on(jug, mat)"]),
    ],
)
def test_words_about_posture_and_manner_name_no_place(text: str, expected: list[str]) -> None:
    assert sorted(asserted(text)) == expected


@pytest.mark.parametrize("text", ["Three panels contribute to the view.", "Two lamps glimmer on the shelf."])
def test_word_after_a_counted_plural_is_a_verb(text: str) -> None:
    reading = read(f"The cup is on the box. {text}")
    assert not any("contribute" in str(f.content) or "glimmer" in str(f.content) for f in reading.stated)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Add a layer of charcoal to clarify the water. The cup is on the box.", ["on(cup, box)"]),
        ("Add a layer of charcoal to facilitate growth. The cup is on the box.", ["on(cup, box)"]),
        ("Attach the cable to the ethernet port.", ["touching(cable, ethernet_port)"]),
        ("Put frequently used jars in the box.", ["inside(jars, box)"]),
        ("Always store daily items in the front.", ["part(items, 'front')"]),
        ("Hang the pan on a hook mounted inside the door.", ["inside(hook, 'door')", "on(pan, hook)"]),
    ],
)
def test_words_that_can_be_nouns_or_verbs(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected
