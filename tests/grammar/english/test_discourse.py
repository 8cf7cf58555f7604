"""Facts of English texts: references, groups, denials, conditions and choices."""

from __future__ import annotations

import pytest

from deixis.grammar.english.reader import read_english
from deixis.grammar.errors import ScriptError
from deixis.grammar.reading import Reading
from deixis.ontology.graph.claims import Claim


def reading(text: str) -> Reading:
    found = read_english(text).reading
    assert found is not None
    return found


def asserted(text: str) -> set[str]:
    return {str(fact.content) for fact in reading(text).stated if fact.asserted}


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("The fork is left of the plate; the knife is right of it.", {"left(fork, plate)", "right(knife, plate)"}),
        ("Fold the napkin and put it on the plate.", {"on(napkin, plate)"}),
        (
            "The cake stand is on the mat. The jug is left of the stand.",
            {"on(cake_stand, mat)", "left(jug, cake_stand)"},
        ),
        ("The jug is not on the mat.", {"not on(jug, mat)"}),
        ("The cup was on the saucer.", set()),
        ("If you have guests, the knife is left of the plate.", set()),
        ("Is the knife left of the fork? The cup is on the mat.", {"on(cup, mat)"}),
        ("The spoon might be on the plate. The cup is on the mat.", {"on(cup, mat)"}),
        (
            "The fork goes left of the plate, the knife to its right and the spoon to the right of the knife.",
            {"left(fork, plate)", "right(knife, plate)", "right(spoon, knife)"},
        ),
        ("The cup is above the saucer and to the left of it.", {"above(cup, saucer)", "left(cup, saucer)"}),
        ("The bowl holds a spoon. The cup is on the mat.", {"inside(spoon, bowl)", "on(cup, mat)"}),
        ("None of the cups is on the mat.", {"not on(cups, mat)"}),
        ("The plate is neither left of the fork nor on the mat.", {"not left(plate, fork)", "not on(plate, mat)"}),
        ("The knife, which used to lie left of the plate, is on the mat.", {"on(knife, mat)"}),
        ("The glass would be right of the plate. The cup is on the mat.", {"on(cup, mat)"}),
        ("There are two forks left.", {"count(fork_1, fork_2, '2')"}),
    ],
)
def test_a_text_asserts_these_facts(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


def test_two_groups_of_one_size_are_paired() -> None:
    found = asserted("Three forks lie left of three plates.")
    assert {f"left(fork_{n}, plate_{n})" for n in (1, 2, 3)} <= found
    assert "left(fork_1, plate_2)" not in found


def test_a_comparative_picks_a_member_of_a_group() -> None:
    found = asserted("Two jars are on the mat. The tea is in the taller one, the coffee in the other.")
    assert {"contents(jar_1, 'tea')", "contents(jar_2, 'coffee')"} <= found


def test_a_place_on_the_surface_has_no_argument() -> None:
    text = "The lamp is in the far left corner of the desk."
    assert asserted(text) == {"corner(lamp, 'far left')"}
    assert reading(text).surface == "desk"


def test_what_is_absent_is_not_an_object_of_the_script() -> None:
    script = read_english("The bowl is left of the jug. No spoon was found.")
    assert script.objects == ("bowl", "jug")
    assert script.reading is not None and script.reading.absent == ("spoon",)


def test_a_choice_has_one_number() -> None:
    found = reading("The cup is to the left of the plate or, if you prefer, to the right of it.").stated
    assert {fact.alternative for fact in found} == {1}
    assert all(fact.content.optional for fact in found)


def test_a_span_covers_the_words_of_the_fact() -> None:
    text = "Hello there. The fork is left of the plate."
    (fact,) = reading(text).stated
    assert text[slice(*fact.span)].startswith("The fork is left of the plate")


def test_mentions_are_all_words_for_an_object() -> None:
    found = reading("The burette stand is on the mat. The jug is left of the stand.").mentions
    assert found["burette_stand"] == ("The burette stand", "the stand")


def test_a_text_without_any_place_is_refused() -> None:
    with pytest.raises(ScriptError, match="nothing in this text"):
        read_english("Hello, my friend.")


@pytest.mark.parametrize(
    ("text", "weight"),
    [
        ("The fork is usually left of the plate.", 0.8),
        ("The fork is usually right of the plate.", 0.8),
        ("The fork is probably bigger than the plate.", 0.7),
        ("The fork is perhaps right of the plate.", 0.5),
    ],
)
def test_a_hedge_before_a_place_or_a_comparative_counts(text: str, weight: float) -> None:
    (fact,) = reading(text).stated
    assert fact.content.weight == weight
    assert fact.asserted == (weight > 0.5)


def test_a_noun_means_the_object_of_the_same_noun_first() -> None:
    text = "A fork is right of the plate. A dinner fork is left of the plate. The fork is on the mat."
    assert asserted(text) == {"right(fork, plate)", "left(dinner_fork, plate)", "on(fork, mat)"}


def test_names_in_backticks_or_with_underscores_are_literal() -> None:
    text = "The `left shoe` is on the `table`. The left_shoes are exactly left of the `of`."
    assert asserted(text) == {"on(left_shoe, table)", "exactly_left(left_shoes, of)"}


@pytest.mark.parametrize(
    ("text", "fact"),
    [
        ("The cup is nearer to you than the plate.", "bottom(cup, plate)"),
        ("The cup is farther than the plate.", "top(cup, plate)"),
        ("The book is stacked upon the box.", "stacked(book, box)"),
    ],
)
def test_words_of_the_layout_language_are_read(text: str, fact: str) -> None:
    assert [str(one) for one in read_english(text).facts] == [fact]


def test_a_choice_of_relations_of_one_pair_is_one_fact() -> None:
    script = read_english("The fork is usually either left of the plate or on the plate.")
    (fact,) = script.facts
    assert (str(fact), fact.weight, fact.optional) == ("left or on(fork, plate)", 0.8, False)


def test_ordinals_pick_members_in_their_order() -> None:
    said = asserted("There are three forks. The first fork from the right is on a napkin.")
    assert {"ordinal(fork_3, fork_1, fork_2, '1 from right')", "on(fork_3, napkin)"} <= said
    assert not any(one.startswith("on(fork_1") for one in said)


@pytest.mark.parametrize(
    ("text", "said", "claims"),
    [
        ("The spoon's handle points to the right.", "right", ["pointing(spoon, 'left')"]),
        ("The mug's handle points to the right.", "right", ["pointing(mug, 'right')"]),
        ("The fork points away from the viewer.", "away", ["pointing(fork, 'away')"]),
        ("The fork points to the viewer.", "viewer", ["pointing(fork, 'viewer')"]),
    ],
)
def test_direction_of_a_tool_is_that_of_its_head(text: str, said: str, claims: list[str]) -> None:
    script = read_english(text)
    assert [str(claim) for claim in script.claims] == claims
    assert script.reading is not None
    assert [stated.content.value for stated in script.reading.stated if isinstance(stated.content, Claim)] == [said]


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        (
            "Each mat has a spoon to its left and a bowl to its right.",
            {"left(spoon, mat)", "right(bowl, mat)"},
        ),
        (
            "The tray has a jug on it, a lamp behind it and a towel under it.",
            {"on(jug, tray)", "behind(lamp, tray)", "under(towel, tray)"},
        ),
        ("The jar has nothing in it.", {"none_inside(jar)"}),
        ("No spoon touches the candle.", {"not touching(spoon, candle)"}),
    ],
)
def test_things_that_a_thing_has_beside_it(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


def test_each_of_a_counted_group_has_its_own_things() -> None:
    found = asserted("Each of the two mats has a spoon to its left and a bowl on it.")
    assert {"left(spoon_1, mat_1)", "left(spoon_2, mat_2)", "on(bowl_1, mat_1)", "on(bowl_2, mat_2)"} <= found
    assert not {"on(bowl_1, spoon_1)", "on(bowl_1, mat_2)"} & found


@pytest.mark.parametrize(
    "text",
    ["Two mugs stand on a coaster each.", "Two mugs are each on a coaster.", "Two mugs each stand on a coaster."],
)
def test_floating_each_pairs_the_members(text: str) -> None:
    found = asserted(text)
    assert {"on(mug_1, coaster_1)", "on(mug_2, coaster_2)"} <= found
    assert "on(mug_1, coaster_2)" not in found


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("Two of the three jars are behind the box.", {"behind(jar_1, box)", "behind(jar_2, box)"}),
        ("Half of the four jars are behind the box.", {"behind(jar_1, box)", "behind(jar_2, box)"}),
        (
            "One of the three jars is behind the box; the others are in front of it.",
            {"behind(jar_1, box)", "in_front(jar_2, box)", "in_front(jar_3, box)"},
        ),
        (
            "There are four jars. Two are behind the box, the other two are on a mat.",
            {"count(jar_1, jar_2, jar_3, jar_4, '4')", "behind(jar_1, box)", "behind(jar_2, box)", "on(jar_3, mat)",
             "on(jar_4, mat)"},
        ),
        (
            "Two of the jars are red; the third is blue.",
            {"count(jar_1, jar_2, '2')", "colour(jar_1, 'red')", "colour(jar_2, 'red')", "colour(jar_3, 'blue')"},
        ),
        ("At most two jars are behind the box.", set()),
        ("The jar is at most two centimetres from the box.", {"distance_less(jar, box, 0.02 m)"}),
    ],
)  # fmt: skip
def test_parts_and_bounds_of_groups(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


def test_what_a_thing_is_made_of_has_the_colour_of_its_material() -> None:
    assert asserted("A jug of green glass is behind the box.") == {
        "material(jug, 'glass')", "colour(jug, 'green')", "behind(jug, box)"
    }  # fmt: skip


def test_what_is_elsewhere_and_not_here_is_absent() -> None:
    assert asserted("The knife is now in Vienna.") == {"count(knife, '0')"}
    assert "count(knife, '0')" in asserted("The knife is in the kitchen, not here.")
    assert "count(knife, '0')" not in asserted("The knife is on the tray, not there.")


def test_half_a_dozen_is_six() -> None:
    assert "count(egg_1, egg_2, egg_3, egg_4, egg_5, egg_6, '6')" in asserted("Half a dozen eggs are in the box.")


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("A row of candles is behind the box.", {"row(candles)", "behind(candles, box)"}),
        (
            "A circle of two cups surrounds the jar. The circle is on a tray.",
            {"count(cup_1, cup_2, '2')", "circle(cup_1, cup_2)", "around(cup_1, jar)", "around(cup_2, jar)",
             "on(cup_1, tray)", "on(cup_2, tray)"},
        ),
        ("The pencils form a row.", {"row(pencils)"}),
        ("The bowls are stacked.", {"stacked(bowls)"}),
        ("The pencils are lined up.", {"row(pencils)"}),
        ("The second row of seats is behind the box.", {"behind(row, box)"}),
    ],
)  # fmt: skip
def test_arrangements_are_claims_about_their_things(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("The lid is not on the jar but under it, left of the box.",
         {"not on(lid, jar)", "under(lid, jar)", "left(lid, box)"}),
        ("The lid isn't behind the jar or the box.", {"not behind(lid, jar)", "not behind(lid, box)"}),
        ("The pen is outside the case.", {"not inside(pen, case)"}),
        ("The pen isn't outside the case. The cup is on the mat.", {"on(cup, mat)"}),
        ("The knife lies outside the spoon. The cup is on the mat.", {"on(cup, mat)"}),
    ],
)  # fmt: skip
def test_scope_of_denials(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("There is a lamp and a vase. The former is behind the box, the latter in front of it.",
         {"behind(lamp, box)", "in_front(vase, box)"}),
        ("Is the lamp behind the box? No, it is in front of it.", {"in_front(lamp, box)"}),
        ("There are two cans, a jar and a lamp on the shelf by the door.",
         {"count(can_1, can_2, '2')", "on(can_1)", "on(can_2)", "on(jar)", "on(lamp)"}),
        ("There are a lid and a spoon on a saucer.", {"on(spoon, saucer)"}),
        ("There are two tins. One holds rice. The other holds beans.",
         {"count(tin_1, tin_2, '2')", "contents(tin_1, 'rice')", "inside(beans, tin_2)"}),
    ],
)  # fmt: skip
def test_antecedents_across_clauses(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


def test_a_condition_with_an_unknown_verb_names_its_subject() -> None:
    (fact,) = reading("When the alarm beeps, put it behind the box.").stated
    assert (str(fact.content), fact.asserted) == ("behind(alarm, box)", False)


@pytest.mark.parametrize(
    "text",
    [
        "Seen from the door, the lamp is left of the box.",
        "From the driver's point of view, the lamp is left of the box.",
        "From behind the counter, the lamp is left of the box.",
    ],
)
def test_sides_from_another_viewpoint_are_conditional(text: str) -> None:
    (fact,) = reading(text).stated
    assert str(fact.content) == "left(lamp, box)"
    assert fact.condition == text.partition(",")[0]


@pytest.mark.parametrize(
    "statement",
    [
        "The bench is seen from the door.",
        "Everything is seen from the door.",
        "Left and right are meant as seen from the door.",
        "As seen from the door.",
    ],
)
def test_a_sentence_of_its_own_states_the_viewpoint(statement: str) -> None:
    text = f"{statement} The lamp is left of the box. Seen from the door, the cup is right of the box."
    assert asserted(text) == {"left(lamp, box)", "right(cup, box)"}
    assert read_english(text).viewpoint == "door"


def test_another_viewpoint_than_that_of_the_text_is_conditional() -> None:
    text = "The bench is seen from the stool. The lamp is left of the box. Seen from the door, the cup is right of it."
    assert asserted(text) == {"left(lamp, box)"}


@pytest.mark.parametrize("text", ["The cup can be seen from the door", "The cup is not seen from the door"])
def test_what_can_be_seen_from_a_place_is_not_a_viewpoint(text: str) -> None:
    assert read_english(f"{text}. The cup is left of the box.").viewpoint is None


@pytest.mark.parametrize("frame", ["From where I sit", "From my side of the table", "As you look at it"])
def test_sides_from_the_viewer_are_asserted(frame: str) -> None:
    assert asserted(f"{frame}, the lamp is left of the box.") == {"left(lamp, box)"}


@pytest.mark.parametrize(
    ("text", "facts"),
    [
        ("There are two lamps: one behind the vase and one in front of it.",
         {"count(lamp_1, lamp_2, '2')", "behind(lamp_1, vase)", "in_front(lamp_2, vase)"}),
        ("Two lamps flank the bed: one left of the vase, the other right of it.",
         {"count(lamp_1, lamp_2, '2')", "each_side(lamp_1, bed)", "each_side(lamp_2, bed)", "left(lamp_1, vase)",
          "right(lamp_2, vase)"}),
        ("The salt is next to the oil, both of them behind the pan.",
         {"next_to(salt, oil)", "behind(salt, pan)", "behind(oil, pan)"}),
        ("A jar is behind the pan and its lid lies next to it.", {"behind(jar, pan)", "next_to(lid, jar)"}),
        ("The rightmost jar is behind the pan.", {"rightmost(jar)", "behind(jar, pan)"}),
        ("The pan is behind the jar, wider than everything else.", {"behind(pan, jar)", "widest(pan)"}),
        ("The jar is taller than all the others.", {"tallest(jar)"}),
        ("The jar is as far from the pan as the lid. The lid is on the mat.", {"on(lid, mat)"}),
        ("The clock is on black's right. The lid is on the mat.", {"on(lid, mat)"}),
    ],
)  # fmt: skip
def test_members_told_apart_and_compared(text: str, facts: set[str]) -> None:
    assert asserted(text) == facts


def test_a_sentence_without_facts_has_a_reason() -> None:
    found = reading("The cup is on the mat. The jar is heavier than the box.")
    (problem,) = found.sentences[1].problems
    assert "no relation or property that a fact can state" in problem.message


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("Das Messer liegt rechts. The cup is on the mat.", "write it in English"),
        ("The cup is on the mat, and half past.", None),
    ],
)
def test_instructions_are_not_quoted(text: str, hint: str | None) -> None:
    hints = [problem.hint for sentence in reading(text).sentences for problem in sentence.problems]
    assert all(one is None or not one.startswith("write 'write") for one in hints)
    assert hint is None or hint in hints
