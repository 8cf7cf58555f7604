"""Stored tables of the grammars: they are those of the grammars, and others are not used."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from lark import Lark
from lark.grammar import Rule
from lark.parsers.lalr_analysis import Shift

from deixis.grammar.english.parse import ENGLISH
from deixis.grammar.layout.language import LAYOUT
from deixis.grammar.parsers import ParsedGrammar


def _states(parser: Lark) -> list[dict[str, str]]:
    """Return the actions of each state by terminal or rule, the states in the order in which a search reaches them."""
    table = parser.parser.parser._parse_table
    (start,) = table.start_states.values()
    order, found = {start: 0}, []
    for state in (reached := [start]):
        actions = {}
        for name, (action, target) in sorted(table.states[state].items()):
            if action is Shift and target not in order:
                order[target] = len(order)
                reached.append(target)
            actions[name] = f"shift {order[target]}" if action is Shift else f"reduce {_written(target)}"
        found.append(actions)
    return found


def _written(rule: Rule) -> str:
    parts = " ".join(f"{part.name}" for part in rule.expansion)
    return f"{rule.origin.name}: {parts} -> {rule.alias} {rule.options}"


@pytest.mark.parametrize("grammar", [LAYOUT, ENGLISH], ids=lambda grammar: grammar.file.name)
def test_the_stored_table_is_that_of_the_grammar(grammar: ParsedGrammar, monkeypatch: pytest.MonkeyPatch) -> None:
    made = grammar.made(grammar.file.read_text(encoding="utf-8"))
    monkeypatch.setattr(ParsedGrammar, "made", lambda *_: pytest.fail("run: python tools/grammar_tables.py"))
    stored = grammar.parser()
    assert _states(stored) == _states(made) and len(_states(made)) > 100
    assert {terminal.name for terminal in stored.terminals} == {terminal.name for terminal in made.terminals}


@pytest.mark.parametrize("change", ["grammar", "lark", "missing"])
def test_a_table_of_another_grammar_or_lark_is_not_used(tmp_path: Path, change: str) -> None:
    file, table = tmp_path / "layout.lark", tmp_path / "layout.table.json"
    shutil.copy(LAYOUT.file, file)
    stored = json.loads(LAYOUT.table_file.read_text(encoding="utf-8"))
    stored["data"] = {}
    if change == "grammar":
        file.write_text(file.read_text() + "\n")
    if change == "lark":
        stored["made_from"][0] = "0.0"
    if change != "missing":
        table.write_text(json.dumps(stored))
    assert _states(replace(LAYOUT, file=file).parser()) == _states(LAYOUT.parser())


def test_a_made_table_is_read_again(tmp_path: Path) -> None:
    copy = replace(LAYOUT, file=tmp_path / "layout.lark")
    shutil.copy(LAYOUT.file, copy.file)
    copy.table_file.write_text(LAYOUT.table())
    assert _states(copy.parser()) == _states(LAYOUT.parser())
