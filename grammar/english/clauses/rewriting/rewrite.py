"""Rewrite the chunks of a sentence as plain clauses: each stage leaves fewer ways of saying the same."""

from __future__ import annotations

from deixis.grammar.english.chunking.chunk import Chunk
from deixis.grammar.english.clauses.rewriting.asides import without_asides
from deixis.grammar.english.clauses.rewriting.commands import with_plain_commands
from deixis.grammar.english.clauses.rewriting.ellipses import filled_in
from deixis.grammar.english.clauses.rewriting.insertions import without_insertions, without_parentheses
from deixis.grammar.english.clauses.rewriting.labels import with_labels_as_things
from deixis.grammar.english.clauses.rewriting.lists import with_places_of_members
from deixis.grammar.english.clauses.rewriting.placings import with_plain_places
from deixis.grammar.english.clauses.rewriting.word_order import in_plain_order


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
    chunks = filled_in(without_parentheses(chunks, text))
    for stage in (
        without_insertions, with_places_of_members, with_labels_as_things, with_plain_commands, without_asides,
        in_plain_order, with_plain_places,
    ):  # fmt: skip
        chunks = stage(chunks)
    return chunks
