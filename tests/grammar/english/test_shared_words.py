"""Words that clauses share, things that are told apart by them, and statements that hold at times."""

from __future__ import annotations

import pytest
from asserted_facts import asserted as asserted_except

from deixis.grammar.english.reader import read_english


def asserted(text: str) -> list[str]:
    """Return the facts that a text asserts, without counts and sizes."""
    return asserted_except(text, ("count(", "size("))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The knife is on the mat and the fork isn't; the latter is in the box.",
         ["on(knife, mat)", "not on(fork, mat)", "inside(fork, box)"]),
        ("The knife is on the mat and the fork is on the box; the former is red, the latter is blue.",
         ["on(knife, mat)", "on(fork, box)", "colour(knife, 'red')", "colour(fork, 'blue')"]),
        ("On the box is my toy, the big green one, and next to him stands the small one.",
         ["colour(green_toy, 'green')", "on(green_toy, box)", "next_to(small_toy, green_toy)"]),
        ("The sheets lie left of the board with a pencil on each of them.",
         ["left(sheets, board)", "on(pencil, sheets)"]),
        ("The bread is on a plate, and the butter is beside the bread on the same plate.",
         ["on(bread, plate)", "next_to(butter, bread)", "on(butter, plate)"]),
        ("The salt is left of the glass and the pepper is on the other side of it.",
         ["left(salt, glass)", "right(pepper, glass)"]),
        ("I thought of putting the mirror on the box, but it is behind the lamp.", ["behind(mirror, lamp)"]),
        ("My rack has three boards. On the top board is a cup. On the bottom board is a jug. A pen is on the low one.",
         ["on(cup, board_1)", "on(jug, board_2)", "on(pen, board_3)"]),
    ],
)  # fmt: skip
def test_things_that_are_meant_by_other_words(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The label is closer to the jar than the cup is.", ["closer(label, jar, cup)"]),
        ("Two chairs are behind the box, one on the left and the other on the right of the lamp.",
         ["behind(chair_1, box)", "behind(chair_2, box)", "left(chair_1, lamp)", "right(chair_2, lamp)"]),
        ("On the right you have the knife, with the blade facing the jar, and then the spoon.",
         ["part(knife, 'right')", "part(spoon, 'right')", "facing(knife, jar)"]),
        ("On the right there is a knife, then a spoon and then a cup.",
         ["part(knife, 'right')", "part(spoon, 'right')", "part(cup, 'right')"]),
        ("In the middle stands a horse, facing left.", ["facing(horse, 'left')", "middle(horse)"]),
        ("Bin: should be under the rack but is in the hall.", ["inside(bin, hall)"]),
        ("Pans: stacked on the rack, smallest on top.", ["stacked(pans)", "on(pans, rack)"]),
        ("Two cups, one on each side of the cross, are behind the box.",
         ["each_side(cup_1, cross)", "each_side(cup_2, cross)", "behind(cup_1, box)", "behind(cup_2, box)"]),
        ("Four cups, two on each side of the cross, are behind the box.",
         [*(f"each_side(cup_{n}, cross)" for n in range(1, 5)), *(f"behind(cup_{n}, box)" for n in range(1, 5))]),
        ("The shelf the books are on hangs over the lamp.", ["on(books, shelf)", "above(shelf, lamp)"]),
        ("My unit, from left to right: well, sink, speed rail.", ["row(well, sink, rail, 'left to right')"]),
        ("The ring is hidden.", ["state(ring, 'hidden')"]),
    ],
)  # fmt: skip
def test_clauses_that_share_words(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The lid is off the pot.", ["not on(lid, pot)"]),
        ("The pens are out of the box.", ["not inside(pens, box)"]),
        ("The cup is neither red nor blue.", ["not colour(cup, 'red')", "not colour(cup, 'blue')"]),
        ("The chair stands with its back to the lamp.", ["not facing(chair, lamp)"]),
        ("The chair stands with its back to the door.", ["not facing(chair, 'door')"]),
        ("The chair stands with its back to me.", ["facing(chair, 'away')"]),
        ("The cup may stand on the mat but not on the board.", ["not on(cup, board)"]),
        ("The knife is not before the jug.", ["not in_front(knife, jug)"]),
        ("If anyone asks, the pens are in the box.", ["inside(pens, box)"]),
        ("The bowl looks out of place on the box.", ["on(bowl, box)"]),
        ("The bowl looks lost on the box.", ["on(bowl, box)"]),
        ("Wash the cups in the sink and put them on the rack.", ["on(cups, rack)"]),
    ],
)  # fmt: skip
def test_denials_and_conditions_that_do_not_count(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("Most nights the cup is in the jar.", None),
        ("All that's missing is a fork to the left of the plate.", None),
        ("The cup hangs from the rail, but most nights it is in the jar.", "most nights"),
        ("Never put the cup on the mat before dessert.", "before dessert"),
        ("The fork isn't put on the mat until the soup is there.", "until the soup is there"),
        ("If you want honey, the jar is in the box.", "if you want honey"),
        ("Put the pens in the box if anyone asks.", "if anyone asks"),
    ],
)
def test_what_holds_at_times_is_not_asserted(text: str, condition: str | None) -> None:
    reading = read_english(text).reading
    assert reading is not None
    *_, last = reading.stated
    assert not last.asserted and (condition is None or last.condition == condition)


def test_a_paraphrase_says_once_what_is_so_of_several() -> None:
    reading = read_english("Four cups and a jug stand on the box. The cups are stacked.").reading
    assert reading is not None
    first, second = (sentence.paraphrase for sentence in reading.sentences)
    assert first.endswith("; the cups 1 to 4 and the jug are on the box.")
    assert second == "The cups 1 to 4 are on top of each other."
