"""The TextMate grammar of layout scripts and the files of the extension that use it."""

from __future__ import annotations

import json
import re

import pytest
from source_tree import ROOT
from textmate_grammar import GRAMMAR, grammar_text

from deixis.cli.app import COMMANDS

EXTENSION = ROOT / "editors" / "vscode"


def scopes(line: str) -> list[tuple[str, str]]:
    """Return the words of a line with their scopes, found as an editor does: leftmost first, then by rule."""
    rules = [(rule["name"], re.compile(rule["match"])) for rule in json.loads(grammar_text())["patterns"]]
    found: list[tuple[str, str]] = []
    at = 0
    while True:
        matches = [(match.start(), n, match) for n, (_, rule) in enumerate(rules) if (match := rule.search(line, at))]
        if not matches:
            return found
        _, number, match = min(matches, key=lambda found: found[:2])
        found.append((match[0], rules[number][0].removesuffix(".deixis-layout")))
        at = match.end()


def test_the_grammar_has_the_words_of_the_ontology() -> None:
    assert GRAMMAR.read_text(encoding="utf-8") == grammar_text(), "run: python tools/textmate_grammar.py"


RELATION, MODIFIER = "keyword.operator.relation", "storage.modifier"


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("left_shoe on mat", {"on": RELATION}),
        ("fork to the Left of plate # x", {"to the Left of": RELATION, "# x": "comment.line.number-sign"}),
        ("left to right: a1, b1", {"left to right:": "keyword.operator.chain"}),
        ("usually not on tray", {"usually": MODIFIER, "not": MODIFIER, "on": RELATION}),
        ("2 cup are under x", {"2": "constant.numeric", "are": "keyword.other.verb", "under": RELATION}),
        ('"left shoe" under mat', {'"left shoe"': "string.quoted.double", "under": RELATION}),
    ],
)
def test_words_have_their_scopes(line: str, expected: dict[str, str]) -> None:
    assert scopes(line) == list(expected.items())


def test_the_manifest_names_files_of_the_extension() -> None:
    manifest = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    (language,), (grammar,) = manifest["contributes"]["languages"], manifest["contributes"]["grammars"]
    assert language["id"] == grammar["language"]
    assert json.loads((EXTENSION / language["configuration"]).read_text(encoding="utf-8"))["comments"]
    assert json.loads((EXTENSION / grammar["path"]).read_text(encoding="utf-8"))["scopeName"] == grammar["scopeName"]


def test_the_extension_starts_a_command_of_deixis() -> None:
    manifest = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    program = (EXTENSION / manifest["main"]).read_text(encoding="utf-8")
    setting = manifest["contributes"]["configuration"]["properties"]["deixis.command"]
    assert setting["default"][0] == "deixis" and setting["default"][1] in COMMANDS
    assert f'"{manifest["contributes"]["languages"][0]["id"]}"' in program
    assert set(re.findall(r'require\("(vscode-[\w-]+)', program)) == set(manifest["dependencies"])
