"""Rewrite the chunks of a sentence as plain clauses: each stage leaves fewer ways of saying the same."""

from __future__ import annotations

from deixis.grammar.english.chunking.chunk import Chunk
from deixis.grammar.english.clauses.rewriting import (
    asides,
    assignments,
    commands,
    ellipses,
    insertions,
    labels,
    lists,
    placings,
    word_order,
)

STAGES = (ellipses, insertions, lists, labels, assignments, commands, asides, word_order, placings)
"""Modules whose rewritings follow each other."""


def rewritten(chunks: list[Chunk], text: str) -> list[Chunk]:
    """Return the chunks of a sentence in the order and with the words of plain clauses.

    Parameters
    ----------
    chunks
        Chunks of a sentence in the order of the text.
    text
        The whole text, for its parentheses.

    Returns
    -------
    list of Chunk
        Chunks from which the clauses are cut. A chunk that was put in is empty and stands where its words would.
    """
    chunks = insertions.without_parentheses(chunks, text)
    for stage in STAGES:
        for rewrite in stage.REWRITES:
            chunks = rewrite(chunks)
    return chunks
