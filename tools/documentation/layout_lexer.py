"""Highlight the layout language on the pages of the documentation."""

from __future__ import annotations

import re

from pygments.lexer import RegexLexer, words
from pygments.token import Comment, Keyword, Name, Number, Punctuation, String, Text

from deixis.grammar.layout.words import KEYWORDS
from deixis.ontology.tbox import default_ontology

STATEMENT_WORDS = [word for word, terminal in KEYWORDS.items() if terminal not in ("FUNCTION", "VERB")]


class LayoutLexer(RegexLexer):  # type: ignore[misc]
    """Split a layout script into tokens: the relation words and the hedges are those of the ontology."""

    name = "Layout script"
    aliases = ("layout", "facts")
    filenames = ("*.layout",)
    flags = re.IGNORECASE | re.MULTILINE
    tokens = {  # noqa: RUF012
        "root": [
            (r"#.*$", Comment.Single),
            (r'"[^"\n]*"', String),
            (words(default_ontology().relations.by_word, prefix=r"\b", suffix=r"\b"), Keyword.Type),
            (words((*STATEMENT_WORDS, *default_ontology().hedges), prefix=r"\b", suffix=r"\b"), Keyword),
            (r"\d+", Number),
            (r"\w[\w-]*", Name),
            (r"[,;.:()/]", Punctuation),
            (r"\s+|.", Text),
        ]
    }
