"""Groups of household things: their members, words, sizes, and errors in the file."""

from __future__ import annotations

import pytest

from deixis.errors import OntologyError
from deixis.ontology.lexicon.groups import GROUPS_FILE, Groups
from deixis.ontology.tbox import default_ontology

KINDS = default_ontology().kinds


def test_narrower_kinds_are_in_the_groups_of_broader_ones() -> None:
    groups = Groups(KINDS)
    assert "shoes" in {group.label for group in groups.of("running shoes")}
    assert "fruit" in {group.label for group in groups.of("green apples")}


def test_a_longer_listed_name_counts_before_the_head_noun() -> None:
    groups = Groups(KINDS)
    assert groups.known_as("two paper plates")[1] == "paper plate"
    assert "dishes" not in {group.label for group in groups.of("paper plates")}


def test_a_group_in_braces_adds_its_members() -> None:
    groups = Groups(KINDS, "citrus, sour fruit: lemon, orange\nsnacks: cracker, {citrus}")
    assert {group.label for group in groups.of("lemon")} == {"citrus", "snacks"}
    assert groups.of_word("sour fruits") is not None


def test_first_words_of_a_compound_decide_its_group() -> None:
    groups = Groups(KINDS, "frozen food: ice, frozen *\nfruit: peach, frozen grape\nfurniture: chair")
    assert {group.label for group in groups.of("frozen peaches")} == {"frozen food"}
    assert {group.label for group in groups.of("frozen grapes")} == {"fruit"}
    assert not groups.of("frozen")


@pytest.mark.parametrize(
    ("noun", "group"),
    [
        ("oven cleaner", "cleaning supplies"),
        ("used paper cup", "rubbish"),
        ("remote control helicopter", "toy vehicles"),
        ("cat harness", "pet supplies"),
        ("throat lozenges", "medicine"),
        ("cargo shorts", "bottoms"),
        ("saltines", "snacks"),
        ("index cards", "stationery"),
        ("wire strippers", "tools"),
        ("frozen strawberries", "frozen food"),
    ],
)
def test_everyday_things_are_in_the_groups_of_their_use(noun: str, group: str) -> None:
    assert group in {one.label for one in Groups(KINDS).of(noun)}


def test_every_group_has_kinds_and_a_size() -> None:
    groups = Groups(KINDS)
    assert all(group.kinds and groups.size(group) >= len(group.kinds) for group in groups)


def test_the_file_lists_no_member_twice() -> None:
    for line in GROUPS_FILE.read_text(encoding="utf-8").splitlines():
        members = [word.strip() for word in line.partition("#")[0].partition(":")[2].split(",")]
        assert not any(members) or len(members) == len(set(members)), line


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("shoes boot", "groups.txt:1: a line must be"),
        ("a: boot\n\na: shoe", "groups.txt:3: .* already listed"),
        ("a: {b}", "'{b}' must be a listed group"),
        ("a: {b}\nb: {a}", "'{a}' must be a listed group that does not contain itself"),
    ],
)
def test_errors_name_their_line(text: str, message: str) -> None:
    with pytest.raises(OntologyError, match=message):
        list(Groups(KINDS, text))
