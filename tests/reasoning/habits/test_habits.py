"""Rules from examples, their probabilities, and where other things go."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from deixis.deadline import Deadline
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import SettingError
from deixis.reasoning.habits.concepts import Aspect, Concepts
from deixis.reasoning.habits.habits import Habits

CLOTHES = {"sneakers": "rack", "rain boots": "rack", "wool sweater": "chair", "gym shorts": "chair"}
THINGS = ("apple", "sneakers", "novel", "toy car", "frying pan", "red wool scarf", "telephone", "qwrtz", "teddy bear")
PLACES = ("shelf", "drawer", "box")
SEVEN = ("apple", "teddy bear", "toy car", "sneakers", "novel", "telephone", "frying pan")
TIED = dict(zip(SEVEN, ("shelf",) * 5 + ("drawer", "box"), strict=True))
"""Examples with more equally short descriptions than the search keeps."""


def labels(thing: str, aspect: Aspect) -> set[str]:
    return {concept.label for concept in Concepts(default_ontology()).of(thing) if concept.aspect is aspect}


def test_concepts_are_groups_kinds_words_and_adjectives() -> None:
    assert "cookware" in labels("copper pan", Aspect.GROUP) and "pan" in labels("copper pan", Aspect.KIND)
    assert labels("dark blue wool sweater", Aspect.DESCRIPTION) >= {"blue", "dark"}
    assert labels("copper pans", Aspect.WORD) == {"copper", "pan"}
    assert labels("large spoon", Aspect.SIZE) == {"large"} and labels("wardrobe", Aspect.SIZE) == {"large"}


def test_a_stuffed_zebra_is_a_toy_and_no_animal() -> None:
    assert "stuffed animals" in labels("plush zebra", Aspect.GROUP)
    assert "animal" not in labels("plush zebra", Aspect.KIND)


@pytest.mark.parametrize(
    ("amount", "thing"), [("bag of pretzels", "pretzel"), ("bars of soap", "soap"), ("box of crayons", "crayon")]
)
def test_an_amount_has_the_groups_of_what_it_holds(amount: str, thing: str) -> None:
    concepts = Concepts(default_ontology())
    groups = {concept for concept in concepts.of(thing) if concept.aspect is Aspect.GROUP}
    assert groups and groups <= concepts.of(amount)


def test_a_number_after_a_name_changes_nothing() -> None:
    concepts = Concepts(default_ontology())
    assert concepts.of("baking pan 2") == concepts.of("baking pan")


def test_rules_name_groups_and_place_unseen_things() -> None:
    habits = Habits(CLOTHES)
    assert ("shoes", "rack") in [(rule.concept, rule.place) for rule in habits.rules]
    assert habits.place_of("loafers").place == "rack" and habits.place_of("loafers").because == "shoes"
    assert habits.place_of("cardigan").place == "chair"
    assert not habits.exceptions


def test_an_example_stays_where_it_was_put() -> None:
    odd = {"apple": "bowl", "pear": "bowl", "banana": "bowl", "kiwi": "bowl", "peach": "shelf"}
    habits = Habits(odd)
    assert all(habits.place_of(thing).place == place for thing, place in odd.items())
    assert habits.place_of("plum").place == "bowl"


def test_a_narrower_rule_leaves_the_other_things() -> None:
    habits = Habits({"fork": "tray", "spoon": "tray", "plate": "shelf", "bowl": "shelf", "teapot": "shelf"})
    assert habits.place_of("dessert fork").place == "tray"
    assert habits.place_of("saucer").place == "shelf"


def test_a_stated_rule_holds_against_examples() -> None:
    habits = Habits(CLOTHES, stated={"sandals": "drawer"})
    assert habits.rules[0].stated and habits.rules[0].concept == "sandals"
    assert habits.place_of("flip flops").place == "drawer" and habits.place_of("loafers").place == "rack"


def test_rules_can_be_about_colours_and_materials() -> None:
    habits = Habits({"white shirt": "left", "pale pink dress": "left", "black shirt": "right", "navy dress": "right"})
    assert habits.place_of("dark green skirt").place == "right" and habits.place_of("ivory blouse").place == "left"
    habits = Habits({"wooden spoon": "a", "wooden bowl": "a", "steel fork": "b", "steel pan": "b"})
    assert habits.place_of("wooden tray").place == "a" and habits.place_of("steel whisk").place == "b"


def test_an_unknown_thing_may_go_anywhere() -> None:
    found = Habits(CLOTHES).place_of("qwrtz")
    assert not found.known and found.because is None and found.probability == pytest.approx(0.5)


def test_a_place_without_an_example_has_a_probability() -> None:
    found = Habits(CLOTHES, places=("shelf",)).place_of("loafers")
    assert dict(found.alternatives)["shelf"] > 0


@given(st.dictionaries(st.sampled_from(THINGS), st.sampled_from(PLACES), min_size=1), st.sampled_from(THINGS))
@example(TIED, "red wool scarf")
def test_probabilities_add_up_to_one_in_any_order(examples: dict[str, str], thing: str) -> None:
    found = Habits(examples).place_of(thing)
    shares = [share for _, share in found.alternatives]
    assert np.isclose(sum(shares), 1.0) and shares == sorted(shares, reverse=True)
    turned = dict(reversed(examples.items()))
    assert Habits(turned).place_of(thing) == found


@given(st.dictionaries(st.sampled_from(THINGS), st.sampled_from(PLACES), min_size=1))
def test_renamed_places_change_nothing_else(examples: dict[str, str]) -> None:
    renamed = Habits({thing: f"the {place}" for thing, place in examples.items()})
    expected = [(rule.concept, f"the {rule.place}", rule.examples) for rule in Habits(examples).rules]
    assert [(rule.concept, rule.place, rule.examples) for rule in renamed.rules] == expected


def test_the_time_limit_keeps_the_rules_so_far() -> None:
    assert Habits(CLOTHES, deadline=Deadline.after(0.0)).place_of("sneakers").place == "rack"


@pytest.mark.parametrize(
    ("examples", "stated", "message"),
    [({}, {}, "at least one example"), (CLOTHES, {"qwrtz": "box"}, "'qwrtz' must name a kind")],
)
def test_wrong_habits_are_refused(examples: dict[str, str], stated: dict[str, str], message: str) -> None:
    with pytest.raises(SettingError, match=message):
        Habits(examples, stated=stated)
