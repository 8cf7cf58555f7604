"""Write the TextMate grammar of layout scripts from the words of the ontology: ``python tools/textmate_grammar.py``."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from deixis.grammar.layout.claims import CLAIM_OF_PATTERN, CLAIM_PATTERN, HAS_PATTERN
from deixis.grammar.layout.words import BETWEEN, IS, NUMBERS, VERBS, chains
from deixis.ontology.relations.relation import plain_phrase
from deixis.ontology.tbox import Ontology, default_ontology

GRAMMAR = Path(__file__).parents[1] / "editors" / "vscode" / "syntaxes" / "deixis-layout.tmLanguage.json"
"""File of the grammar, in the extension for VS Code."""


def words_pattern(phrases: Iterable[str]) -> str:
    """Return a case-insensitive expression for whole phrases, longer ones first.

    >>> bool(re.fullmatch(words_pattern(["left", "left of"]), "Left of"))
    True
    """
    found = sorted(set(phrases), key=lambda phrase: (-len(phrase), phrase))
    return rf"(?i:(?<![\w-])(?:{'|'.join(BETWEEN.join(map(re.escape, p.split())) for p in found)})(?![\w-]))"


def textmate_grammar(ontology: Ontology) -> dict[str, Any]:
    """Return the grammar as data: the scope of each sort of word, in the order in which they are tried."""
    heads = words_pattern(chains(ontology)).removesuffix(r"(?![\w-]))") + r"[ \t]*:)"
    rules = [
        ("comment.line.number-sign", "#.*$"),
        ("string.quoted.double", '"[^"\n]*"'),
        ("keyword.control", words_pattern(["layout", "include", "seen from"])),
        ("keyword.operator.chain", heads),
        (
            "keyword.operator.claim",
            rf"(?i:(?<![\w-])(?:{CLAIM_PATTERN}|{CLAIM_OF_PATTERN}|{HAS_PATTERN}))",
        ),
        ("keyword.operator.relation", words_pattern(ontology.relations.by_word)),
        (
            "storage.modifier",
            words_pattern(
                ["not", "never", "nothing", "unseen", "optional", "optionally", *map(plain_phrase, ontology.hedges)]
            ),
        ),
        ("keyword.operator.logical", words_pattern(["and", "or", "than"])),
        ("keyword.other.verb", words_pattern([*IS, *VERBS])),
        ("constant.numeric", words_pattern(["[1-9][0-9]?"]).replace(re.escape("[1-9][0-9]?"), "[1-9][0-9]?")),
        ("constant.numeric", words_pattern(NUMBERS)),
        ("comment.block.article", words_pattern(["the", "an", "a"])),
    ]
    patterns = [{"name": f"{scope}.deixis-layout", "match": match} for scope, match in rules]
    return {"name": "Deixis layout", "scopeName": "source.deixis-layout", "patterns": patterns}


def grammar_text() -> str:
    """Return the text of the grammar's file."""
    return json.dumps(textmate_grammar(default_ontology()), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    GRAMMAR.write_text(grammar_text(), encoding="utf-8")
