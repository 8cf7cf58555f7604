"""Facts that claims imply: with their derivations, their conflicts, and their truth in tables where the claims hold."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.grammar.layout.parser import parse_script
from deixis.ontology.graph.claims import ROW_ORDERS, Claim
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.claim_facts import COMPARATIVES, facts_of_claims
from deixis.workflows.layouts.infer import infer, verdict_of

RELATIONS = default_ontology().relations


def inferred(text: str) -> dict[str, tuple[str, tuple[int, ...]]]:
    return {str(entry.fact): (entry.rule.value, entry.lines) for entry in infer(parse_script(text)).inferred()}


@pytest.mark.parametrize(
    ("text", "follows"),
    [
        ("a, b, c in a row from left to right", ["left(a, b)", "left(b, c)", "left(a, c)", "right(c, a)"]),
        ("a, b in a row from near to far", ["bottom(a, b)", "top(b, a)"]),
        ("a is leftmost; b on c", ["left(a, b)", "left(a, c)"]),
        ("a is the tallest of b; c on b", ["taller(a, b)", "shorter(b, a)"]),
        ("a is last from the left of b, c", ["right(a, b)", "right(a, c)"]),
        ("a, b, c near each other", ["near(a, b)", "near(b, c)", "near(c, a)"]),
        ("x between a and b; b right of a", ["left(a, x)", "left(x, b)", "right(x, a)"]),
        ("x between a and b; a above c; c above b", ["top(a, x)", "top(x, b)"]),
    ],
)
def test_what_follows_from_claims(text: str, follows: list[str]) -> None:
    found = inferred(text)
    assert set(follows) <= found.keys()


@pytest.mark.parametrize(
    "text",
    ["not a is leftmost; a on b", "usually a is leftmost; a on b", "x between a and b; a on c", "a, b in a row",
     "a is second from the left; b on c"],
)  # fmt: skip
def test_denied_hedged_and_unordered_claims_imply_no_order(text: str) -> None:
    assert not {fact for fact in inferred(text) if fact.startswith(("left", "right", "top", "bottom"))}


def test_a_derivation_names_the_claims_and_what_they_rest_on() -> None:
    script = parse_script("a, b in a row from left to right\nb left of c\nx between a and c")
    inference = infer(script)
    derivation = inference.derive(RELATIONS["left"], "x", "c")
    assert derivation is not None
    assert [line.strip().split("   ")[0] for line in derivation.lines()] == [
        "left(x, c)",
        "between(x, a, c)",
        "left(a, c)",
        "left(a, b)",
        "row(a, b, 'left to right')",
        "left(b, c)",
    ]
    assert inferred("a, b in a row from left to right\nb left of c\nx between a and c")["left(x, c)"] == (
        "claim",
        (1, 2, 3),
    )


def test_claims_that_contradict_facts_are_a_conflict() -> None:
    text = "a, b, c in a row from left to right; c left of a"
    conflict = infer(parse_script(text)).conflict
    assert conflict is not None
    assert {str(fact) for fact in conflict.facts} >= {"left(c, a)"}
    assert verdict_of(parse_script(text)) is False


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1), st.sampled_from(sorted(COMPARATIVES)), st.sampled_from(sorted(ROW_ORDERS)))
def test_implied_facts_hold_where_the_claim_is_true(seed: int, term: str, order: str) -> None:
    rng = np.random.default_rng(seed)
    low = rng.uniform(0, 1, (4, 3)) + 2 * np.arange(4)[:, None]
    boxes = np.stack([low, low + rng.uniform(0.2, 0.9, (4, 3))], axis=1)
    extents = boxes[:, 1] - boxes[:, 0]
    measure = {
        "largest": extents.prod(axis=1), "smallest": -extents.prod(axis=1), "tallest": extents[:, 2],
        "shortest": -extents[:, 2], "longest": extents.max(axis=1), "widest": extents[:, 0],
        "narrowest": -extents[:, 0], "leftmost": -boxes[:, 0, 0], "rightmost": boxes[:, 0, 0],
    }[term]  # fmt: skip
    names = ["a", "b", "c", "d"]
    best = names[int(measure.argmax())]
    for entry in facts_of_claims([Claim(term, (best,))], names, RELATIONS):
        assert entry.fact.subject == best
        assert measure[names.index(best)] >= measure[names.index(entry.fact.object)]
    axis, sign = {"left": (0, 1), "right": (0, -1), "bottom": (1, 1), "top": (1, -1)}[ROW_ORDERS[order]]
    row = [names[i] for i in np.argsort(sign * boxes[:, 0, axis])]
    for entry in facts_of_claims([Claim("row", tuple(row), value=order)], names, RELATIONS):
        ends = [boxes[names.index(name), :, axis] for name in (entry.fact.subject, entry.fact.object)]
        assert ends[0][1] <= ends[1][0] if sign > 0 else ends[1][1] <= ends[0][0]
