"""Implications of facts of graded words."""

from __future__ import annotations

import pytest

from deixis.grammar.layout.parser import parse_script
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.entailment.implications import Implications
from deixis.testing import assert_consistent, assert_contradictory, assert_follows, assert_not_follows


def implied(text: str) -> set[str]:
    return {str(fact) for fact in Implications(parse_script(text).graph()).implied()}


@pytest.mark.parametrize(
    ("text", "follows"),
    [
        ("a near b", {"near(b, a)"}),
        ("a next to b", {"near(a, b)", "near(b, a)", "next_to(b, a)"}),
        ("a bigger than b", {"smaller(b, a)"}),
        ("a behind b", {"top(a, b)", "bottom(b, a)", "in_front(b, a)"}),
        ("a above b", {"bottom(b, a)"}),
        ("a on b", {"under(b, a)", "exactly_on(a, b)", "exactly_under(b, a)"}),
        ("not a near b", set()),
        ("a near or left of b", set()),
    ],
)
def test_exactly_this_follows(text: str, follows: set[str]) -> None:
    assert implied(text) == follows


def test_inside_is_transitive_and_near_is_not() -> None:
    assert_follows("a inside b; b inside c", "inside(a, c)")
    assert_not_follows("a near b; b near c", "near(a, c)")


def test_a_derivation_shows_its_steps() -> None:
    script = parse_script("a inside b; b inside c")
    proof = Implications(script.graph()).derive(script.ontology.relations["containing"], "c", "a")
    assert proof is not None
    assert {str(claim) for claim in proof.stated()} == {"inside(a, b)", "inside(b, c)"}
    assert proof.rule in (Rule.INVERSE, Rule.TRANSITIVITY)


def test_a_denied_word_contradicts_no_other_order() -> None:
    assert_consistent("not a near b; a left of b; not b inside c; b on c")


def test_behind_and_above_contradict_in_front() -> None:
    assert_contradictory("a behind b; a in front of b")
    assert_contradictory("a behind b; a below b")
