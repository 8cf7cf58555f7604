"""The reference of the language: its examples run, and its relation words are those of the ontology."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.parser import parse_script
from deixis.ontology.tbox import default_ontology

TEXT = (Path(__file__).parents[3] / "docs" / "reference" / "language.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```([a-z-]+)\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
EXAMPLES = [(tag, text, BLOCKS[i + 1]) for i, (tag, text) in enumerate(BLOCKS) if tag in ("layout", "layout-error")]


def relation_table() -> str:
    """Return the table of relation words that the reference must contain."""
    rows = ["| relation | written | also |", "|---|---|---|"]
    for relation in default_ontology().relations.values():
        also = sorted({*relation.words} - {relation.phrase})
        rows.append(f"| `{relation.name}` | {relation.phrase} | {', '.join(also)} |")
    return "\n".join(rows)


def test_the_table_of_relations_is_current() -> None:
    found = re.search(r"<!-- relations: begin -->\n(.*?)\n<!-- relations: end -->", TEXT, re.DOTALL)
    assert found is not None
    assert found[1] == relation_table()


def test_the_hedges_are_documented() -> None:
    for hedge in default_ontology().hedges:
        assert re.search(rf"\b{hedge}\b", TEXT), hedge


@pytest.mark.parametrize(("tag", "text", "following"), EXAMPLES, ids=[text.split("\n")[0] for _, text, _ in EXAMPLES])
def test_example(tag: str, text: str, following: tuple[str, str]) -> None:
    kind, expected = following
    if tag == "layout":
        assert kind == "facts"
        script = parse_script(text, "example.layout")
        assert "".join(f"{fact}\n" for fact in script.stated) == expected
        assert parse_script(format_script(script)).objects == script.objects
    else:
        assert kind == "error"
        with pytest.raises(ScriptError) as caught:
            parse_script(text, "example.layout")
        assert str(caught.value) + "\n" == expected
