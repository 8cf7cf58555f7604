"""Facts of advice on what to keep where, of lists whose things have places, and of denials around an aside."""

from __future__ import annotations

import pytest
from asserted_facts import asserted

from deixis.grammar.english.reader import read_english


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("It makes sense to keep heavy bottles on the lowest shelf.", ["on(bottles)"]),
        ("I love placing a box on top of the books.", ["on(box, books)"]),
        ("I prefer to keep the salt next to the stove.", ["next_to(salt, stove)"]),
        ("Store fruits and greens like cress in the drawer.", ["inside(fruits, drawer)", "inside(greens, drawer)"]),
        ("Place berries and fresh-squeezed juice on the tray.", ["on(berries)", "on(juice)"]),
        ("Add the cheese to the board.", ["on(cheese, board)"]),
        ("Put the food you need later that week in the box.", ["inside(food, box)"]),
        ("Keep meat in the box, so that no juice falls on other items.", ["inside(meat, box)"]),
        ("Store mugs, and glasses on the tray.", ["on(mugs)", "on(glasses)"]),
        ("Place a cup on the mat and a glass of water on the napkin.", ["on(cup, mat)", "on(glass, napkin)"]),
    ],
)
def test_advice_on_keeping_gives_its_facts(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize("text", ["Put the cup on the top or middle shelf.", "The cup is on the left or right shelf."])
def test_two_sides_share_the_noun_after_or(text: str) -> None:
    reading = read_english(text).reading
    assert reading is not None
    places = [fact for fact in reading.stated if str(fact.content).startswith("on(cup")]
    assert [fact.alternative for fact in places] == [1, 1]
    assert len({str(fact.content) for fact in places}) == 2


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The tray holds a mug, a bar of soap on a dish, a comb, and a jug.",
         {"on(mug, tray)", "on(bar, dish)", "on(comb, tray)", "on(jug, tray)"}),
        ("On the shelf are a mug, a bar on a dish, and a jug.", {"on(bar, dish)", "on(mug)", "on(bar)", "on(jug)"}),
        ("From left to right: a mug, a bar on a dish, a comb, and a jug.",
         {"on(bar, dish)", "row(mug, bar, comb, jug, 'left to right')"}),
        ("There is a cup on the tray, a jug on the mat, and a spoon on the box.",
         {"on(cup)", "on(jug, mat)", "on(spoon, box)"}),
        ("The tray holds a mug, a plate with a napkin on it, a comb and a jug.",
         {"on(mug, tray)", "on(napkin, plate)", "on(comb, tray)", "on(jug, tray)"}),
        ("The tray holds a mug, a candle between a cup, a jug and a plate.",
         {"on(mug, tray)", "between(candle, cup, jug, plate)"}),
    ],
)  # fmt: skip
def test_things_with_places_do_not_end_their_list(text: str, expected: set[str]) -> None:
    assert set(asserted(text)) == expected


@pytest.mark.parametrize(
    "denial",
    [
        "Don't, however, store milk in the box.",
        "Do not, under any circumstances, put milk in the box.",
        "Don't, please, put milk in the box.",
        "You should not, however, put milk in the box.",
        "The milk should not, in any case, be kept in the box.",
        "The milk does not, as a rule, stand in the box.",
    ],
)
def test_an_aside_does_not_end_a_denial(denial: str) -> None:
    assert asserted(denial) == ["not inside(milk, box)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the fork on the mat before placing the cup on the napkin.", ["on(fork, mat)", "on(cup, napkin)"]),
        ("After covering the plates, put the fork on the mat.", ["on(fork, mat)"]),
        ("Place the forks on the mat, so guests can pick these up after filling their plates.", ["on(forks, mat)"]),
    ],
)
def test_a_participle_of_time_is_what_the_reader_does(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The clipper is on the mat, with its cable tucked under it.", ["on(clipper, mat)", "under(cable, clipper)"]),
        ("The clipper is on the mat with its cable beside it.", ["on(clipper, mat)", "next_to(cable, clipper)"]),
    ],
)
def test_its_after_with_is_of_the_subject(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("On the left there is a jug, and behind it, partly hidden, a cup.", "behind(cup, jug)"),
        ("The box with the pens we put behind the lamp.", "behind(box, lamp)"),
    ],
)
def test_turned_clauses_give_their_facts(text: str, expected: str) -> None:
    assert expected in asserted(text)


@pytest.mark.parametrize(
    "text",
    ["Resist the urge to put the fork on the mat.", "The fork is often wrongly placed on the mat."],
)
def test_what_is_done_wrongly_is_not_asserted(text: str) -> None:
    assert asserted(f"{text} The cup is on the saucer.") == ["on(cup, saucer)"]


def test_a_move_ends_where_it_goes_to() -> None:
    assert asserted("Move the fork from the mat to the plate.") == ["on(fork, plate)"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("There is a box containing pens on the shelf.", ["inside(pens, box)", "on(box)"]),
        ("Lean the picture in its frame against the jug.", ["inside(picture, frame)", "against(picture, jug)"]),
    ],
)
def test_participles_and_supports_stand_apart(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "With the plate in front of you, lay the fork on its left.",
            ["in_front(plate, 'viewer')", "left(fork, plate)"],
        ),
        ("The order from left to right is fork, plate and knife.", ["row(fork, plate, knife, 'left to right')"]),
        ("From left to right, the order is fork, plate, and knife.", ["row(fork, plate, knife, 'left to right')"]),
    ],
)
def test_what_is_said_first_is_read_first(text: str, expected: list[str]) -> None:
    assert asserted(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The cup is left of the jug, and the knife and spoon go behind it.", ["left(cup, jug)"]),
        ("The fork, if you need it, rests in the bowl.", []),
        ("The fork rests in the bowl.", ["inside(fork, bowl)"]),
    ],
)
def test_nouns_like_verbs_are_told_by_their_clause(text: str, expected: list[str]) -> None:
    found = asserted(text)
    assert found[: len(expected)] == expected
    assert not [fact for fact in found if "rest" in fact or "left(cup, knife)" in fact]
