"""Texts in many voices with the facts that they state, and sentences that must not become facts."""

from pathlib import Path

import pytest
from bench_english import Score, written_facts, written_texts, written_traps

from deixis.grammar.english.reader import read_english
from deixis.ontology.graph.claims import Claim

TEXTS = Path(__file__).parent / "texts"
MIN_FOUND, MIN_RIGHT = 0.8, 0.9
FLOORS = {
    "unseen": (0.75, 0.9), "counters": (0.75, 0.9), "rooms": (0.8, 0.93), "stations": (0.72, 0.9),
    "visitors": (0.78, 0.92), "arrivals": (0.65, 0.87), "boarders": (0.78, 0.92), "mechanics": (0.8, 0.88),
    "galleys": (0.75, 0.87),
}  # fmt: skip
"""Smallest shares of found and of right facts of texts that are harder than the others.

Their authors did not know the reader. It was changed afterwards for those of ``unseen.txt``, ``counters.txt``,
``rooms.txt``, ``stations.txt`` and ``visitors.txt``. The texts of ``arrivals.txt`` and ``boarders.txt``, and those of
``mechanics.txt`` and ``galleys.txt``, were written by authors who knew the reader, before any of them was read; it was
changed for all of them afterwards.
"""


@pytest.mark.parametrize(
    "file", sorted(path for path in TEXTS.glob("*.txt") if path.stem != "traps"), ids=lambda path: path.stem
)
def test_most_stated_facts_are_found_and_right(file: Path) -> None:
    score = Score()
    for text in written_texts(file):
        score.add(text)
    min_found, min_right = FLOORS.get(file.stem, (MIN_FOUND, MIN_RIGHT))
    assert score.found >= min_found * score.stated
    assert score.right >= min_right * score.read_facts


def test_no_trap_becomes_a_fact() -> None:
    assert list(written_traps(TEXTS / "traps.txt")) == []


def test_notation_of_facts_reads_signs_parts_and_names() -> None:
    first, second = written_facts("not corner:far left(lamp, desk); ~between(a cup, jar, pot)")
    assert (first["negated"], first["part"], first["object"]) == (True, "far left", ["desk"])
    assert (second["asserted"], second["subject"], second["object"]) == (False, "a cup", ["jar", "pot"])


def asserted(text: str) -> list[str]:
    """Return the facts that a text asserts, without counts, colours and sizes."""
    reading = read_english(text).reading
    assert reading is not None
    minor = ("count(", "colour(", "size(", "material(", "contents(", "kind(")
    return [str(fact.content) for fact in reading.stated if fact.asserted and not str(fact.content).startswith(minor)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Plate centre, fork left of the plate.", ["middle(plate)", "left(fork, plate)"]),
        ("Around the jar are arranged two nuts.", ["around(nut_1, jar)", "around(nut_2, jar)"]),
        ("The chair on which the coat hangs faces the jar.", ["on(coat, chair)", "facing(chair, jar)"]),
        ("The glue is behind the pot rather than next to it.", ["behind(glue, pot)", "not next_to(glue, pot)"]),
        ("The tape should be in the box, but it is under the box.", ["under(tape, box)"]),
        ("If there is a lemon, put it on the saucer.", []),
        ("Perhaps the cup is behind the jug.", []),
        ("Under no circumstances must the jar stand on the box.", ["not on(jar, box)"]),
        ("There isn't anything under the napkin.", ["none_under(napkin)"]),
        ("Spoons are kept in the jar and forks in the box.", ["inside(spoons, jar)", "inside(forks, box)"]),
        ("The left box holds pens, the right one pencils.", ["inside(pens, left_box)", "inside(pencils, right_box)"]),
        ("On the left:\n- a cup\n- a jug, behind the cup\n",
         ["part(cup, 'left')", "behind(jug, cup)", "part(jug, 'left')"]),
        ("To the left of the pot put the jug.", ["left(jug, pot)"]),
        ("The pot is flanked by two cups.", ["each_side(cup_1, pot)", "each_side(cup_2, pot)"]),
        ("I've got the jar – my best one – behind the pot 🍵.", ["behind(jar, pot)"]),
        ("The cup ~~on the tray~~ is next to the jug.", ["next_to(cup, jug)"]),
        ("A stack of three towels is on the stool. A brush lies on the towels.",
         ["on(stack, stool)", "on(brush, stack)"]),
        ("The cup is on its own saucer.", ["on(cup, saucer)"]),
        ("The cup, not the jug, is on the box.", ["on(cup, box)", "not on(jug, box)"]),
        ("And the knife? It lies behind the bowl.", ["behind(knife, bowl)"]),
        ("The bread I have put it in the basket, the cup is behind of the pot.",
         ["inside(bread, basket)", "behind(cup, pot)"]),
        ("The bottle is too tall to stand on the box.", ["height(bottle, 'tall')"]),
        ("The lid is in the tin, and beside it, propped on the jar, is a card.",
         ["inside(lid, tin)", "next_to(card, lid)", "leaning(card, jar)"]),
        ("The pen was on the box, but my son moved it to the drawer.", ["inside(pen, drawer)"]),
        ("Onions are in the bowl, garlic in the one behind it.",
         ["inside(onions, bowl_1)", "behind(bowl_2, bowl_1)", "inside(garlic, bowl_2)"]),
        ("The cup lies on the box, handle pointing away.", ["on(cup, box)", "pointing(cup, 'away')"]),
        ("Two cups: the red one on the box, a blue one behind the jar.",
         ["on(cup_1, box)", "behind(cup_2, jar)"]),
        ("Two cups: a red one on the box, a blue one behind the jar.", ["on(cup_1, box)", "behind(cup_2, jar)"]),
        ("Two cups are on the box, a blue one is behind the jar.",
         ["on(cup_1, box)", "on(cup_2, box)", "behind(cup_3, jar)"]),
        ("Flowers: low ones between the jars, the tall bunch on a box.",
         ["between(flower, jar_1, jar_2)", "on(bunch, box)"]),
        ("Pens: red ones in the mug, the blue one behind the box.",
         ["inside(red_pen, mug)", "behind(blue_pen, box)"]),
        ("The glasses, a present from my aunt, stand on the box.", ["on(glasses, box)"]),
        ("Four covers already down. The cup is behind the pot.", ["behind(cup, pot)"]),
        ("Six spoons on the box, bowls downwards.",
         [*(f"on(spoon_{n}, box)" for n in range(1, 7)), *(f"pointing(spoon_{n}, 'down')" for n in range(1, 7))]),
        ("The knife lies with its blade to the plate.", ["facing(knife, plate)"]),
        ("Lay the knife right of the plate, with the blade to the plate.",
         ["right(knife, plate)", "facing(knife, plate)"]),
        ("The cup stands with its handle to the right.", ["pointing(cup, 'right')"]),
        ("The cup with its handle to the right is behind the plate.", ["pointing(cup, 'right')", "behind(cup, plate)"]),
        ("The fork is left of the plate with the tines pointing up.", ["left(fork, plate)", "pointing(fork, 'up')"]),
        ("The spoon lies behind the plate with its bowl to the left.",
         ["behind(spoon, plate)", "pointing(spoon, 'left')"]),
        ("The fork lies with its handle to the plate.", ["pointing(fork, plate, 'handle')"]),
        ("Shuffle the cards and put them next to the jar.", ["next_to(cards, jar)"]),
        ("The owner states that the cup is behind the jug.", []),
        ("Neither the fork nor the knife is behind the bowl.", ["not behind(fork, bowl)", "not behind(knife, bowl)"]),
        ("I put the doll on the chair and the rabbit on the box.", ["on(doll, chair)", "on(rabbit, box)"]),
        ("The cup and the jug stand side by side.", ["near_each_other(cup, jug)"]),
        ("The plank lies on two foam blocks.", ["on(plank, foam_block_1)", "on(plank, foam_block_2)"]),
        ("The cup is two squares behind the jug.", ["behind(cup, jug)"]),
        ("No, wait, the cup is under the jug.", ["under(cup, jug)"]),
        ("Keep the bleach from getting near the bread.", ["not near(bleach, bread)"]),
        ("The tube is in row 3 of the rack.", ["inside(tube, rack)"]),
        ("There are two cups behind the jug. The hinges are next to the tin.",
         ["behind(cup_1, jug)", "behind(cup_2, jug)", "next_to(hinges, tin)"]),
        ("The jug would have you put the cup behind the box.", []),
        ("Either the key is in the bowl or she took it.", []),
        ("The cup stands well clear of the jug.", ["far(cup, jug)"]),
        ("The cups – there should be three of them – are next to the jug.", ["next_to(cups, jug)"]),
        ("Forks: two, left of the plate.", ["left(fork_1, plate)", "left(fork_2, plate)"]),
        ("The tray lies on the box, and 5 cm behind the tray a jug.",
         ["on(tray, box)", "distance(jug, tray, 0.05 m)", "behind(jug, tray)"]),
        ("The cups are on the box so that they do not fall.", ["on(cups, box)"]),
        ("The tweezers are on the box when I am not using them.", []),
        ("The jug is behind the box unless fewer than three people eat.", []),
        ("Take the scissors and lay them on the box.", ["on(scissors, box)"]),
        ("The two jars are placed one at each side of the box.", ["each_side(jar_1, box)", "each_side(jar_2, box)"]),
        ("The scanner replaces the bell and stands behind the box.", ["behind(scanner, box)"]),
        ("A pot is on the box. Left of it, two spoons, bowls downwards.",
         ["on(pot, box)", "left(spoon_1, pot)", "left(spoon_2, pot)", "pointing(spoon_1, 'down')",
          "pointing(spoon_2, 'down')"]),
        ("Two cigarette ends are in the bowl.", ["inside(cigarette_end_1, bowl)", "inside(cigarette_end_2, bowl)"]),
        ("The letter, once on the box, is now in the drawer.", ["inside(letter, drawer)"]),
        ("In the photograph the cup is on the box.", []),
        ("The bell must hang on the box and not lie on the stool.", ["on(bell, box)", "not on(bell, stool)"]),
        ("The jar is behind the box, as guests should not see it.", ["behind(jar, box)"]),
        ("The case is behind the jug, lid open towards you.",
         ["behind(case, jug)", "open(case)", "facing(case, 'viewer')"]),
        ("The hat is on the jug, which makes my son laugh.", ["on(hat, jug)"]),
        ("The pen is not in the box, where I looked for it, but under the hat.",
         ["not inside(pen, box)", "under(pen, hat)"]),
        ("The cup goes in the box that is next to the jug and the pot in the basket.",
         ["next_to(box, jug)", "inside(cup, box)", "inside(pot, basket)"]),
        ("The sponge is next to the jars but not touching them.",
         ["next_to(sponge, jars)", "not touching(sponge, jars)"]),
        ("Two cups surround the jug.", ["around(cup_1, jug)", "around(cup_2, jug)"]),
        ("Put the card on the board and stand both on the box.",
         ["on(card, board)", "on(card, box)", "on(board, box)"]),
        ("The rag lies all over the box.", ["on(rag, box)"]),
        ("At 8 a.m. the mat must be behind the box.", ["behind(mat, box)"]),
        ("Lost coins go into the box, keys into the tin.", ["inside(coins, box)", "inside(keys, tin)"]),
        ("Fan the cards around the jug.", ["around(cards, jug)"]),
        ("She kept the ring in a box until it was stolen. The jug is blue.", []),
        ("The mug barely missed landing on the box. The jug is blue.", []),
        ("The jug is blue. You would think the cup was behind it.", []),
        ("The ruler is in the case, and so is the pen.", ["inside(ruler, case)", "inside(pen, case)"]),
        ("The ruler goes in the case, as does the pen.", ["inside(ruler, case)", "inside(pen, case)"]),
        ("The ruler isn't in the case, and neither is the pen.",
         ["not inside(ruler, case)", "not inside(pen, case)"]),
        ("It is the fork that lies on the left, not the knife.", ["part(fork, 'left')", "not part(knife, 'left')"]),
        ("It is on the shelf, not the box, that you will find the pen.", ["on(pen)"]),
        ("If you look behind the curtain, you'll see a box.", ["behind(box, curtain)"]),
        ("All spoons are in the jar except the ladle, which is behind the pot.",
         ["inside(spoons, jar)", "behind(ladle, pot)"]),
        ("Three cups are on the box, one of which is behind the jug.",
         ["on(cup_1, box)", "on(cup_2, box)", "on(cup_3, box)", "behind(cup_1, jug)"]),
        ("Check that the bolt is in the tin and that the nut is under the plate.",
         ["inside(bolt, tin)", "under(nut, plate)"]),
        ("The vase was moved from the box to the shelf. The cup is behind the vase.",
         ["on(vase)", "behind(cup, vase)"]),
        ("The jug should be rinsed and stand behind the box.", ["state(jug, 'rinse')", "behind(jug, box)"]),
        ("The mats lie on the box, each with a pen across it.", ["on(mats, box)", "across(pen, mats)"]),
        ("The phone is on the box, and beneath the phone a card.", ["on(phone, box)", "under(card, phone)"]),
        ("The pins, points to the left, lie behind the box.", ["behind(pins, box)", "pointing(pins, 'left')"]),
        ("Soy, vinegar and oil I keep behind the jar.",
         ["behind(soy, jar)", "behind(vinegar, jar)", "behind(oil, jar)"]),
        ("Keep the cat off the box.", ["not on(cat, box)"]),
        ("The pegs get lined up beside the box.", ["row(pegs)", "next_to(pegs, box)"]),
        ("At no time are cups to be left on the box.", ["not on(cups, box)"]),
        ("The copy is in the box in case the cup breaks.", ["inside(copy, box)"]),
        ("Could you please put the cup on the box?", ["on(cup, box)"]),
        ("The cup, no, the jug, is behind the box.", ["behind(jug, box)"]),
        ("Neither cup is on the box; both stand behind the jug.",
         ["not on(cup_1, box)", "not on(cup_2, box)", "behind(cup_1, jug)", "behind(cup_2, jug)"]),
        ("One cup is on the box; the other lies under the jug.", ["on(cup_1, box)", "under(cup_2, jug)"]),
        ("Top drawer: pens, scissors and tape.",
         ["inside(pens, drawer)", "inside(scissors, drawer)", "inside(tape, drawer)"]),
        ("Centre of the box: jug; left of it, two cups.",
         ["middle(jug, box)", "left(cup_1, jug)", "left(cup_2, jug)"]),
        ("Cups, saucers and spoons on the box, jug behind it.",
         ["on(cups, box)", "on(saucers, box)", "on(spoons, box)", "behind(jug, box)"]),
        ("Lay down the mat; on it, stand the jug.", ["on(jug, mat)"]),
        ("The jug, in turn, stands behind the box.", ["behind(jug, box)"]),
        ("The jug takes the place of honour on the box.", ["on(jug, box)"]),
        ("The pegs have no place on the box.", ["not on(pegs, box)"]),
        ("The cup lies nearest to you.", ["nearest(cup, 'viewer')"]),
        ("The cups must not touch one another.", ["not touching_each_other(cups)"]),
        ("Between the cup and the jug, but closer to the latter, lies a key.",
         ["between(key, cup, jug)", "closer(key, jug)"]),
        ("There hangs a lamp over the box.", ["above(lamp, box)"]),
        ("Every place has a fork to the left of the plate and a knife to the right of it.",
         ["left(fork, plate)", "right(knife, plate)"]),
        ("The coat is draped over the back of the chair.", ["on(coat, chair)"]),
        ("The boots are under the bench with their toes forward.",
         ["under(boot_1, bench)", "under(boot_2, bench)", "pointing(boot_1, 'forward')",
          "pointing(boot_2, 'forward')"]),
        ("The pot is on the box, where the jug used to be.", ["on(pot, box)"]),
        ("You might as well put the cup on the box. The jug is blue.", []),
        ("It looks as if the cup is on the box. The jug is blue.", []),
        ("The photo shows the cup on the box. The jug is blue.", []),
        ("The cup isn't always on the box. The jug is blue.", []),
        ("Few cups are on the box. The jug is blue.", []),
        ("The theory puts the cup on the box. The jug is blue.", []),
        ("The cup is supposedly on the box. The jug is blue.", []),
        ("The boss wants the cup on the box. The jug is blue.", []),
        ("The box on which the cup once stood is blue.", []),
        ("The envelope with the bill stands between the cup and the jug.", ["between(envelope, cup, jug)"]),
        ("A board with the prices leans against the jar.", ["leaning(board, jar)"]),
        ("Pens are in the box, rulers in the tin, and the cup is on the jug.",
         ["inside(pens, box)", "inside(rulers, tin)", "on(cup, jug)"]),
        ("The cup is on the box; neither paper nor cloth may lie under the jug.",
         ["on(cup, box)", "not under(paper, jug)", "not under(cloth, jug)"]),
        ("In the middle stands the jug.", ["middle(jug)"]),
        ("Behind the jar Mr Bell put a nest.", ["behind(nest, jar)"]),
        ("Tins go in the box, glass in the crate beside it.",
         ["inside(tins, box)", "next_to(crate, box)", "inside(glass, crate)"]),
        ("Fold the napkins and tuck one under each fork.", ["under(napkins, fork)"]),
        ("Set the jug above the forks with a knife across it.", ["above(jug, forks)", "across(knife, jug)"]),
        ("The chairs are lined up along the wall.", ["row(chairs)", "along(chairs, wall)"]),
        ("The pen is by the clock, by chance.", ["near(pen, clock)"]),
        ("The window is at my back and the cup on the box.", ["behind(window, 'viewer')", "on(cup, box)"]),
        ("Behind the jug, where only staff may go, is a safe.", ["behind(safe, jug)"]),
        ("The jam is at the top right of the board, the honey at the top left.",
         ["top_right(jam, board)", "top_left(honey, board)"]),
        ("A cup is on the box. A spoon is at the top left.", ["on(cup, box)", "part(spoon, 'top left')"]),
        ("Polish bottles never stand on the towel.", ["not on(bottles, towel)"]),
        ("The vac lives on the floor to the right of the box.", ["right(vac, box)", "on(vac, floor)"]),
        ("Wire, tape and pins are in the first, the second and the third drawer respectively.",
         ["inside(wire, drawer_1)", "inside(tape, drawer_2)", "inside(pins, drawer_3)"]),
        ("Three tins are on the box. From left to right they hold nails, screws and pins.",
         ["on(tin_1, box)", "on(tin_2, box)", "on(tin_3, box)", "inside(nails, tin_1)", "inside(screws, tin_2)",
          "inside(pins, tin_3)", "row(tin_1, tin_2, tin_3, 'left to right')"]),
        ("The two jars hold nails and screws. The cup is on the box.", ["on(cup, box)"]),
        ("The jars hold nails and screws.", ["inside(nails, jars)", "inside(screws, jars)"]),
        ("The bucket's home is under the tap.", ["under(bucket, tap)"]),
        ("The parcel, which now lies behind the jug, is open.", ["behind(parcel, jug)", "open(parcel)"]),
        ("Every player sets a boat inside the box and takes three crates.", ["inside(boat, box)"]),
        ("The flask must not stand between the jug and the student.", ["not between(flask, jug, 'student')"]),
        ("Rinse the jug and return it to its box.", ["inside(jug, box)"]),
        ("The phone is in the box, since the cable is too short.", ["inside(phone, box)"]),
        ("Behind the jug lies a pack, its flap opening away from you. At its left stands a jar.",
         ["behind(pack, jug)", "pointing(flap, 'away')", "left(jar, pack)"]),
        ("The cup is right of the jug; crackers, in a bowl, to the left of it.",
         ["right(cup, jug)", "inside(crackers, bowl)", "left(crackers, jug)"]),
        ("Fold the napkin into a rectangle. The cup is on the box.", ["on(cup, box)"]),
        ("The envelope with the card stands between the two candles.",
         ["between(envelope, candle_1, candle_2)"]),
        ("The tin is lined with felt. The cup is on the box.", ["on(cup, box)"]),
        ("The oil may hang from the hook or lie on the box.", []),
        ("The case has fallen over and now lies across the lid.", ["across(case, lid)"]),
        ("The ribbon is on the rail, and under that you'll find the roll.", ["on(ribbon, rail)", "under(roll, rail)"]),
        ("The bottles stay on the box except the one being poured.", ["on(bottles, box)"]),
        ("You have two crates, one either side of the drum.", ["each_side(crate_1, drum)", "each_side(crate_2, drum)"]),
        ("There's a basket for incoming mail on top of the box.", ["on(basket, box)"]),
        ("The jug is on the box, and behind the jug stand the lilies.", ["on(jug, box)", "behind(lilies, jug)"]),
        ("Whatever she says, the box is under the chair.", ["under(box, chair)"]),
        ("Erasers, by the way, have no place on the box.", ["not on(erasers, box)"]),
        ("Behind the jug is a globe the size of a pumpkin.", ["behind(globe, jug)"]),
        ("The bucket, tongs hooked over its rim, stands behind the jug.",
         ["behind(bucket, jug)", "above(tongs, bucket)"]),
        ("The caps lie along the box's far edge.", ["edge(caps, box, 'far')"]),
        ("Needles stay in the case, and used ones drop into the bin.",
         ["inside(needles, case)", "inside(needle, bin)"]),
        ("Nothing is on the box except the clock.", ["none_on(box)", "on(clock, box)"]),
        ("In a two-player game the pegs stay in the box.", []),
        ("In the event of rain the mat is in front of the box.", []),
        ("I built a boat for the fair and it stands on the box.", ["on(boat, box)"]),
        ("The lathe stands at the left end of the rack, the safe underneath it.",
         ["end(lathe, rack, 'left')", "under(safe, lathe)"]),
        ("Towel first: fold it in half and lay it across the box.", ["across(towel, box)"]),
        ("Sitting at the counter I have the lamp on the box.", ["on(lamp, box)"]),
        ("The pegs must not lie next to the jar, nor may they stand on the box.",
         ["not next_to(pegs, jar)", "not on(pegs, box)"]),
        ("Snips live in the pocket; the knife doesn't, it's on the box.",
         ["inside(snips, pocket)", "not inside(knife, pocket)", "on(knife, box)"]),
        ("Get everything ready before your first shift! The cup is on the box.", ["on(cup, box)"]),
        ("Bread? In the basket.", ["inside(bread, basket)"]),
        ("The bins are under the desk, pushed right back against the box.",
         ["under(bins, desk)", "against(bins, box)"]),
        ("Most books assume that the ink is on the right. The cup is on the box.", ["on(cup, box)"]),
    ],
)  # fmt: skip
def test_constructs_of_many_voices_give_their_facts(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The three jars beside the box held ink.", []),
        ("The pens are in the jar, along with the ruler.", ["inside(pens, jar)", "inside(ruler, jar)"]),
        ("Put the pen in the box together with the ruler.", ["inside(pen, box)", "inside(ruler, box)"]),
        ("The pens were in the jar, along with the ruler.", []),
        ("Do not set the cup on the scale while it is hot.", []),
        ("Do not set the cup on the scale. It is being cleaned.", ["not on(cup, scale)"]),
        ("A comb and a pen lie on the box, with a card between them.",
         ["on(comb, box)", "on(pen, box)", "between(card, comb, pen)"]),
        ("The wheel is strapped to the frame, with a card between them.",
         ["touching(wheel, frame)", "between(card, wheel, frame)"]),
        ("The pot hangs over the fire on a chain.", ["above(pot, fire)", "on(pot, chain)"]),
        ("The coat hangs from a hook on the door.", ["on(hook, door)", "on(coat, hook)"]),
        ("The bag is on the box. The sieve hangs above it from a nail.",
         ["on(bag, box)", "above(sieve, bag)", "on(sieve, nail)"]),
        ("There's a mug for each of you beside the jug.", ["next_to(mug, jug)"]),
        ("Right beside the band saw is where the lamp is mounted.", ["next_to(lamp, band_saw)"]),
        ("Next to the jug is not where the lamp goes. The pen is in the box.", ["inside(pen, box)"]),
        ("Is next to the jug where the lamp goes?", []),
        ("A plant on the mat behind the box looks nice.", ["behind(mat, box)", "on(plant, mat)"]),
        ("The vase would look nice on the sill.", []),
        ("The clock looks at the door.", ["facing(clock, 'door')"]),
        ("There are three drawers. The first holds pens, the second paper, and the third is empty.",
         ["inside(pens, drawer_1)", "inside(paper, drawer_2)", "empty(drawer_3)"]),
        ("Please don't leave mugs on the box or in the jug.", ["not on(mugs, box)", "not inside(mugs, jug)"]),
        ("It can go on the box or to the left of the jug, but never under the jug. The pen is in the box.",
         ["inside(pen, box)"]),
        ("The pen is in the box. Put the cup where it can't tip over, between the box and the jug.",
         ["inside(pen, box)", "between(cup, box, jug)"]),
        ("There is a mirror on the wall and a chair beside it.", ["on(mirror, wall)", "next_to(chair, mirror)"]),
        ("There is a lamp on the box and a jar of honey.", ["on(lamp, box)"]),
        ("The cloth hangs over both ends of the box.", ["on(cloth, box)"]),
        ("The lamp hangs over the box.", ["above(lamp, box)"]),
        ("The cloth does not hang over both ends of the table. The pen is in the box.", ["inside(pen, box)"]),
        ("Three jars stand on the box, of which the one in the middle holds buttons.",
         ["on(jar_1, box)", "on(jar_2, box)", "on(jar_3, box)", "middle(jar_1)", "inside(buttons, jar_1)"]),
        ("The parcel is on the box. The lamp is to my left.", ["on(parcel, box)", "left(lamp, 'viewer')"]),
        ("Keep the jug away from the edge of the box.", ["not edge(jug, box)"]),
        ("The hook is on the back of the door.", ["part(hook, door, 'back')"]),
        ("The floor is clean. The handle goes on the front of the box, just above the label.",
         ["state(floor, 'clean')", "part(handle, box, 'front')", "above(handle, label)"]),
        ("Clear the table. The pen is in the box.", ["inside(pen, box)"]),
        ("A red LED is just below the chip.", ["below(led, chip)"]),
        ("The pot is left of the glass. A card is stuck to the glass in the upper right corner.",
         ["left(pot, glass)", "corner(card, glass, 'top right')", "touching(card, glass)"]),
        ("The dummy stands between the box and the jug with a coat on it.",
         ["between(dummy, box, jug)", "on(coat, dummy)"]),
        ("The bucket stands by the door with the tongs in it.", ["near(bucket, door)", "inside(tongs, bucket)"]),
        ("The filling is in the bowl, and a spoon stands in it.", ["inside(filling, bowl)", "inside(spoon, bowl)"]),
        ("The box was over the door, but the owner had it moved; it is now under the bed.", ["under(box, bed)"]),
        ("The lamp is on the desk. The cup is on the desk to the left of the lamp. The pen is in the box.",
         ["on(lamp, desk)", "left(cup, lamp)", "on(cup, desk)", "inside(pen, box)"]),
        ("The tray is on the box to the left of the lamp.", ["left(box, lamp)", "on(tray, box)"]),
        ("Three posts stand on the box. A tile leans against the post nearest the jug.",
         ["on(post_1, box)", "on(post_2, box)", "on(post_3, box)", "nearest(post_1, jug)", "leaning(tile, post_1)"]),
        ("Leave a finger's width between the pots. The pen is in the box.", ["inside(pen, box)"]),
        ("Stand the lamp at one end of the rail and the screen at the other. The lens is midway between them.",
         ["end(lamp, rail)", "end(screen, rail)", "between(lens, lamp, screen)"]),
        ("The filters are in the box. Take the red one and place it behind the jug.",
         ["inside(filters, box)", "behind(filter, jug)"]),
        ("The pen is in the box, because the postman trips over it.", ["inside(pen, box)"]),
        ("On top of a pile of letters there is a stone.", ["on(stone, letters)"]),
        ("You can't see the safe. The pen is in the box.", ["inside(pen, box)"]),
        ("To the right of the jug stand two frames, one of my mother and one of a ship.",
         ["right(frame_1, jug)", "right(frame_2, jug)"]),
        ("Balloons are tied to the back of the chair.", ["touching(balloons, chair)"]),
        ("Lay the frame on its left side. The pen is in the box.", ["state(frame, 'sideways')", "inside(pen, box)"]),
        ("The cap is next to the tins, label on top, not underneath.", ["next_to(cap, tins)"]),
        ("The spoon you will look for in vain in the box: it's in the jar.", ["inside(spoon, jar)"]),
        ("The kettle is on the left burner, so leave the pan on the other one.",
         ["on(kettle, burner_1)", "on(pan, burner_2)"]),
        ("The drum goes down first, in the middle of the mat.", ["middle(drum, mat)"]),
        ("The owner himself put the cup on the box. The pen itself is in the box.",
         ["on(cup, box)", "inside(pen, box)"]),
        ("The oat milk is in the crate, behind the whole milk.", ["inside(oat_milk, crate)", "behind(oat_milk, milk)"]),
        ("The label is stuck to the front. The pen is in the box.", ["inside(pen, box)"]),
        ("The driftwood leans against the jar, its branches reaching to the left.",
         ["leaning(driftwood, jar)", "pointing(branches, 'left')"]),
    ],
)  # fmt: skip
def test_constructs_of_how_to_texts_give_their_facts(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "absent"),
    [
        ("The cup is on the tray. The jug is not on the tray.", ("jug",)),
        ("The cup is on the tray. The jug is next to the cup and not on the tray.", ()),
        ("The cup is on the tray. The jug was not on the tray.", ()),
    ],
)
def test_what_is_not_on_the_surface_and_nowhere_else_is_absent(text: str, absent: tuple[str, ...]) -> None:
    reading = read_english(text).reading
    assert reading is not None
    assert reading.absent == absent


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("The jar is a hand's width from the pot.", 0.1),
        ("The jar is half a metre from the pot.", 0.5),
        ("The jar is approx. 40 cm to the right of the pot.", 0.4),
        ("The jar stands no closer than 10 cm to the pot.", 0.1),
    ],
)
def test_lengths_are_read_as_they_are_spoken(text: str, metres: float) -> None:
    reading = read_english(text).reading
    assert reading is not None
    claims = [fact.content for fact in reading.stated if isinstance(fact.content, Claim)]
    assert [claim.metres for claim in claims if claim.metres is not None] == [metres]
