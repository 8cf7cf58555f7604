"""Warnings about scripts: each code, what is not warned of, and how the command shows them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis as run
from hypothesis import given, settings
from hypothesis import strategies as st
from source_tree import ROOT

import deixis
from deixis.errors import DeixisError
from deixis.reasoning.entailment.redundant import redundant_facts
from deixis.workflows.layouts.lint import CODES, one_letter_away

EXAMPLES = ROOT / "examples"
FACT = st.tuples(st.sampled_from(["left", "right", "top", "on", "top_left"]), *[st.sampled_from("abcde")] * 2)
FACTS = st.lists(FACT.filter(lambda fact: fact[1] != fact[2]), min_size=1, max_size=7)


def codes(text: str, *ignored: str) -> list[str]:
    found = deixis.lint(deixis.read_script(text=text), ignore=ignored)
    return [finding.code for finding in found.findings]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("fork left of plate; spoon right of plate", []),
        ("fork left of plate; spoon right of plaet", ["F004", "N001"]),
        ("dinner_frok left of plate", ["N001"]),
        ("fork left of plate; cup is a mug", ["N002"]),
        ("fork left of thingummy", ["N003"]),
        ("fork left of x; x is a plate", []),
        ("fork left of plate; left(fork, plate)", ["F001"]),
        ("fork left of plate; plate left of cup; fork left of cup", ["F002"]),
        ("fork left of plate; plate right of fork", ["F002"]),
        ("fork left of plate; not right(fork, plate)", ["F002"]),
        ("fork left of plate; plate left of fork", ["F003"]),
        ("fork left of plate; cup on saucer", ["F004"]),
        ("fork left or top left of plate", ["F005"]),
        ("fork next to plate; fork left of plate", []),
        ("spoon above pot; jug right of pot; spoon left of jug; jug not in front of spoon", []),
        ("always fork left of plate", ["H001"]),
        ("fork is rarely not left of plate", ["H002"]),
        ("2 cup left of plate; cup_1 above cup_2", []),
        ("2 cups left of plate; cups_1 above cups_2", ["N004"]),
        ("cup_1, cup_2 left of plate; cup right of plate", ["N005"]),
        ("cup_1, cup_2 left of plate; cup_1 cup_2 right of fork; fork right of plate", ["N006"]),
        ("plate left of cup; cup_plate right of cup", []),
        ("2 scissors left of plate", []),
        ("cup left of plate_a; cup right of plate_b", []),
    ],
)
def test_a_script_has_exactly_these_warnings(text: str, expected: list[str]) -> None:
    ignored = () if "N003" in expected else ("N003",)
    assert sorted(codes(text, *ignored)) == expected


def test_the_most_similar_kind_is_suggested() -> None:
    (finding,) = deixis.lint(deixis.read_script(text="forck left of plate"), select=["N001"]).findings
    assert finding.replacement == "fork"


def test_a_misspelling_has_a_replacement() -> None:
    (finding,) = deixis.lint(deixis.read_script(text="a_fork left of plate; cup on plaet"), select=["N001"]).findings
    assert (finding.replacement, finding.source.column, finding.source.end_column) == ("plate", 30, 35)


def test_a_script_file_without_viewpoint_is_warned_of(tmp_path: Path) -> None:
    file = tmp_path / "some.layout"
    file.write_text("fork left of plate\n")
    assert [finding.code for finding in deixis.lint(file).findings] == ["L001"]


def test_a_comment_suppresses_warnings_of_its_line() -> None:
    assert codes("fork left of thingummy  # noqa") == []
    assert codes("fork left of thingummy  # noqa: n003") == []
    assert codes("fork left of thingummy  # noqa: N001") == ["N003"]


def test_an_unknown_code_is_refused() -> None:
    with pytest.raises(DeixisError, match="no code begins with 'Q'"):
        deixis.lint(deixis.read_script(text="fork left of plate"), select=["Q"])


def test_a_passed_deadline_is_reported() -> None:
    script = deixis.read_script(text="fork left of plate; plate right of fork")
    assert not deixis.lint(script, time_limit=0.0).complete


def test_one_letter_away_is_symmetric() -> None:
    for word, other in [("plate", "plaet"), ("fork", "for"), ("cup", "cups"), ("knife", "knifa")]:
        assert other in one_letter_away(word)
        assert word in one_letter_away(other)


@settings(max_examples=40, deadline=None)
@given(FACTS)
def test_redundant_facts_follow_from_the_others(facts: list[tuple[str, str, str]]) -> None:
    script = deixis.read_script(text="\n".join(f"{word}({subject}, {obj})" for word, subject, obj in facts))
    found = deixis.infer(script)
    if not found.consistent:
        return
    edges, complete = redundant_facts(script.graph())
    rest = [fact for number, fact in enumerate(script.facts) if number not in edges]
    assert complete
    text = "\n".join(f"{fact.relations[0].name}({fact.subject}, {fact.object})" for fact in rest)
    without = deixis.infer(deixis.read_script(text=text)).implications
    for number in edges:
        fact = script.facts[number]
        assert without.holds(fact.relations[0], fact.subject, fact.object)


def test_lint_prints_places_and_exits_with_1() -> None:
    code, out, err = run("lint", EXAMPLES / "contradiction.layout")
    assert (code, err) == (1, "")
    assert "contradiction.layout:8:1: F003 " in out
    assert out.endswith("1 warning.\n")
    assert run("lint", EXAMPLES / "script1.layout")[:2] == (0, "No warnings.\n")
    assert run("lint", EXAMPLES / "contradiction.layout", "--ignore", "F003")[0] == 0


def test_lint_as_json_has_its_schema() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    code, out, _ = run("lint", EXAMPLES / "contradiction.layout", "--json")
    schema = json.loads((ROOT / "docs" / "schema" / "lint.schema.json").read_text(encoding="utf-8"))
    data = json.loads(out)
    jsonschema.validate(data, schema)
    assert (code, data["warnings"][0]["code"], data["complete"]) == (1, "F003", True)


def test_the_page_lists_every_code_with_its_meaning() -> None:
    page = (ROOT / "docs" / "reference" / "lint.md").read_text(encoding="utf-8")
    for code, meaning in CODES.items():
        assert f"| `{code}` | {meaning} |" in page


def english_codes(text: str, *select: str) -> list[tuple[str, int]]:
    found = deixis.lint(deixis.read_script(text=text, english=True), select=select)
    return [(finding.code, finding.source.column) for finding in found.findings]


def test_english_names_are_compared_at_their_words() -> None:
    text = "The fork is left of the plate. The plaet is near the fork. The blorft is on the plate. The jug is red."
    assert english_codes(text, "N") == [("N001", 36), ("N003", 64), ("N002", 92)]


def test_the_hint_for_an_unknown_kind_names_the_page_of_kinds() -> None:
    (finding,) = deixis.lint(deixis.read_script(text="fork left of thingummy"), select=("N003",)).findings
    assert finding.hint is not None and "docs/reference/ontology.md" in finding.hint


def test_phrases_that_are_not_understood_are_warnings() -> None:
    assert english_codes("The cup is left of the jug for the guests.", "E") == [("E001", 28)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The glass is behind the knife. The spoon is next to it.", [("E002", 53)]),
        ("The glass is left of the knife. The spoon is right of it.", []),
        ("The glass is behind the knife. It is next to the spoon.", []),
    ],
)
def test_a_pronoun_with_two_candidates_is_a_warning(text: str, expected: list[tuple[str, int]]) -> None:
    assert english_codes(text, "E") == expected


def test_a_group_of_unknown_size_is_a_warning() -> None:
    assert english_codes("The cups are left of the jug. The scissors are left of the jug.", "E") == [("E003", 5)]
    assert english_codes("Two cups are left of the jug.", "E", "N") == []


def test_places_on_the_table_connect_objects() -> None:
    text = "The lamp is in the far left corner. The cup is in the middle. The jug is left of the cup."
    assert english_codes(text, "F004") == []


@pytest.mark.parametrize("command", [["lint"], ["infer"], ["infer", "--verdict"], ["imagine"]], ids=" ".join)
def test_reading_counts_towards_the_time_limit(command: list[str], tmp_path: Path) -> None:
    text = tmp_path / "long.txt"
    text.write_text("The fork is left of the plate. " * 20_000, encoding="utf-8")
    code, out, err = run(*command, text, "--time-limit", 0.5)
    assert (code, out) == (3, "") and "time" in err
