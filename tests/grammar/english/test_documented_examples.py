"""The reference page of English sentences: its examples have the clauses that it states."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deixis.grammar.english.outline import outline
from deixis.grammar.english.parse import parse_english

TEXT = (Path(__file__).parents[3] / "docs" / "reference" / "english.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```text\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
EXAMPLES = list(zip(BLOCKS[::2], BLOCKS[1::2], strict=True))


@pytest.mark.parametrize(("text", "expected"), EXAMPLES, ids=[text.split("\n")[0] for text, _ in EXAMPLES])
def test_example(text: str, expected: str) -> None:
    assert "\n".join(outline(sentence) for sentence in parse_english(text)) + "\n" == expected
