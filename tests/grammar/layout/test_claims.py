"""Claims in the layout language: their phrases, and English texts written as scripts."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.grammar.english.reader import read_english
from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.claims import meaning, phrase_of
from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.parser import parse_script
from deixis.ontology.graph.claims import PLACES, SUPERLATIVES, Claim
from deixis.report.json_answers import script_to_dict
from deixis.report.layouts.read import reading_to_dict

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "english.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```text\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
SENTENCES = [
    *(line for block in BLOCKS[::2] for line in block.splitlines()),
    *("On my desk there is a big monitor, with a blue and white mug at the far right.", "The pen is the longest."),
    *("The boots stand near the right edge, side by side, toes pointing forward.", "The salt is 3 mm from the cup."),
    *("Three jars stand in a row from left to right.", "Nothing lies between the jars.", "The bag holds sugar."),
    *("The card is in the middle of the near edge.", "A lamp is plugged into the wall.", "Usually the box is open."),
]
SIDES = st.sampled_from([None, "left", "far left", "near", "back", "top right"])
METRES = st.floats(0.001, 9, allow_subnormal=False) | st.integers(1, 500).map(lambda cm: cm / 100)

CLAIMS = st.one_of(
    st.builds(lambda term, side: Claim(term, ("a",), value=side), st.sampled_from(sorted(PLACES - {"part"})), SIDES),
    st.builds(lambda term, side: Claim(term, ("a",), ("b",), side), st.sampled_from(sorted(PLACES)), SIDES),
    st.builds(lambda term, m: Claim(term, ("a",), ("b",), metres=m),
              st.sampled_from(["distance", "distance_less", "distance_more"]), METRES),
    st.builds(lambda term: Claim(term, ("a",), ("b", "c")),
              st.sampled_from([*SUPERLATIVES, "between", "among", "closer", "farther", "nearest", "farthest"])),
    st.builds(lambda rank, side, others: Claim("ordinal", ("a",), others, f"{rank} from {side}"),
              st.integers(1, 99) | st.just(-1), SIDES.filter(bool), st.sampled_from([(), ("b",)])),
    st.builds(lambda term: Claim(term, ("a", "b", "c")),
              st.sampled_from(["row", "circle", "near_each_other", "touching_each_other", "parallel_each_other"])),
)  # fmt: skip


def facts(answer: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the stated facts of an answer, with the keys that parse prints, without places in the text."""
    kept = [fact for fact in answer["facts"] if fact.get("asserted", True)]
    left_out = {
        "file",
        "line",
        "column",
        "sentence",
        "span",
        "asserted",
        "confidence",
        "condition",
        "past",
        "uncertain",
    }
    left_out |= {"alternative", "quantifier", "subjects", "arguments", "value", "metres"}
    return [
        {key: value for key, value in fact.items() if key not in left_out}
        | {key: fact.get(key) or None for key in ("arguments", "value", "metres")}
        | {"relation": fact["relations"][0]}
        for fact in kept
    ]


@given(CLAIMS)
def test_a_claim_is_read_back_from_its_phrase(claim: Claim) -> None:
    phrase = phrase_of(claim)
    assert phrase is not None
    read = meaning(phrase)
    assert (read.term, read.value, read.metres) == (claim.relation, claim.value, claim.metres)


@settings(deadline=None, max_examples=40)
@given(st.lists(st.sampled_from(SENTENCES), min_size=1, max_size=4, unique=True))
def test_an_english_text_keeps_its_facts_as_a_layout(sentences: list[str]) -> None:
    try:
        script = read_english(" ".join(sentences))
    except ScriptError:
        return
    if any(content.weight not in (*script.ontology.hedges.values(), 1.0) for content in script.stated):
        return  # a script says a weight by a hedge, which a choice of three has not
    again = parse_script(format_script(script))
    absent = set(script.reading.absent) if script.reading else set()
    said = [fact for fact in facts(reading_to_dict(script)) if absent.isdisjoint({fact["subject"], fact["object"]})]
    assert facts(script_to_dict(again)) == said
    assert set(again.objects) <= set(script.objects)
    assert again.colours == script.colours


@pytest.mark.parametrize(
    ("text", "canonical"),
    [
        ("the fork is between the plate and the knife", "fork between plate and knife\n"),
        ("cup is 20 mm away from jug", "cup about 2 cm from jug\n"),
        ("the candle stands in the far-left corner", "candle at far left corner\n"),
        ("a, b are the largest; c is the 2nd from the left", "a, b are largest\nc is second from left\n"),
        ("knife with the blade facing toward the plate", "knife with its blade to plate\n"),
        ("knife has cup; the mug with its grip at the right", None),
        ("mug is with its grip turned to the right", "mug with its handle to right\n"),
        ("nothing left or right of cup", None),
        ("2 cup in a row; cup at the edge", None),
    ],
)
def test_canonical_form_of_claims(text: str, canonical: str | None) -> None:
    if canonical is None:
        with pytest.raises(ScriptError):
            parse_script(text)
    else:
        assert format_script(parse_script(text)) == canonical


def test_the_surface_of_the_header_is_not_an_object() -> None:
    script = parse_script("layout tea on tray; cup on tray; pot at the left end of tray; jug left of cup")
    assert script.objects == ("cup", "pot", "jug")
    assert [fact["arguments"] for fact in script_to_dict(script)["facts"] if "arguments" in fact] == [
        ["tray"],
        ["tray"],
    ]
    with pytest.raises(ScriptError, match="is the surface"):
        parse_script("layout on tray; cup left of tray")


def test_in_before_a_region_is_a_place() -> None:
    script = parse_script("pen in cup; lamp in the middle; cup_1, cup_2 in a row; lid not in box")
    assert [str(fact) for fact in script.facts] == ["inside(pen, cup)", "not inside(lid, box)"]
    assert [str(claim) for claim in script.claims] == ["middle(lamp)", "row(cup_1, cup_2)"]


@pytest.mark.parametrize("statement", ["cup vertically above plate", "cup quite near plate", "another cup near plate"])
def test_adverbs_and_other_words_end_no_name(statement: str) -> None:
    with pytest.raises(ScriptError, match="expected a"):
        parse_script(statement)


@pytest.mark.parametrize(
    ("statement", "name"), [("plum jelly near plate", "plum_jelly"), ("Sally near plate", "Sally")]
)
def test_nouns_with_the_ending_of_adverbs_are_names(statement: str, name: str) -> None:
    (fact,) = parse_script(statement).facts
    assert fact.subject == name
