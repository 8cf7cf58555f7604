"""Edit lists of chunks: ask for types, put chunks in, leave runs of them out, and turn chunks into others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from deixis.grammar.english.chunking.chunk import Chunk, Relator
from deixis.grammar.english.clauses.built import misunderstood
from deixis.grammar.english.tree import Span
from deixis.grammar.english.vocabulary.tables import word_set

ENDS = frozenset({"COMMA", "CUT", ""})
"""Types after the last chunk of a clause."""
BREAKS = frozenset({"COMMA", "CUT", "BUT"})
"""Types that end a phrase."""
PREDICATES = frozenset({"PREP", "ADV", "PART", "TPART"})
"""Types of the first chunk of what is said about a thing."""
HANDS = word_set("hand finger thumb palm fist arm")
"""Parts of the person who does something."""

Run = tuple[int, Chunk | None]
"""End of a run of chunks, and the chunk that is put in its place, if any."""


def type_at(chunks: list[Chunk], at: int) -> str:
    """Return the type of a chunk.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the chunk, which may lie outside the list.

    Returns
    -------
    str
        Type of the chunk; empty outside the list.
    """
    return chunks[at].type if 0 <= at < len(chunks) else ""


def end_before(chunks: list[Chunk], at: int, types: frozenset[str]) -> int:
    """Return the place of the first chunk of one of the types.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index from which the chunk is searched.
    types
        Types that end the search.

    Returns
    -------
    int
        Index of the chunk; the length of the list if there is none.
    """
    return next((k for k in range(at, len(chunks)) if chunks[k].type in types), len(chunks))


def emptied(chunk: Chunk, value: str = "") -> Chunk:
    """Return a chunk as words that say nothing about places.

    Parameters
    ----------
    chunk
        Chunk of any type.
    value
        Adverb that the words amount to.

    Returns
    -------
    Chunk
        Adverb at the place of the chunk.
    """
    return Chunk("ADVERB", chunk.start, chunk.end, value, chunk.span)


def cut(chunk: Chunk) -> Chunk:
    """Return a chunk as the end of a clause.

    Parameters
    ----------
    chunk
        Chunk of any type.

    Returns
    -------
    Chunk
        Joint at the place of the chunk.
    """
    return Chunk("CUT", chunk.start, chunk.end, None, chunk.span)


def put_in(kind: str, before: Chunk, value: Relator | None = None) -> Chunk:
    """Return a chunk without words that stands before another one.

    Parameters
    ----------
    kind
        Type of the new chunk.
    before
        Chunk before which it stands.
    value
        Preposition of the new chunk, if it is one.

    Returns
    -------
    Chunk
        Empty chunk at the beginning of the other one.
    """
    return Chunk(kind, before.start, before.start, value, (before.span[0], before.span[0]))


def without(find: Callable[[list[Chunk], int], Run | None]) -> Callable[[list[Chunk]], list[Chunk]]:
    """Return the rewriting that leaves out each run of chunks that a function finds, or puts its chunk there.

    Parameters
    ----------
    find
        Function of the chunks of a sentence and an index, which returns the run that begins there, or None.

    Returns
    -------
    callable
        Function of the chunks that returns the chunks outside the runs.
    """

    def rewrite(chunks: list[Chunk]) -> list[Chunk]:
        found: list[Chunk] = []
        at = 0
        while at < len(chunks):
            end, instead = find(chunks, at) or (at + 1, chunks[at])
            found += [] if instead is None else [instead]
            at = end
        return found

    return rewrite


def unknown(chunks: list[Chunk], at: int, end: int) -> Run:
    """Return a run with one chunk for it that is reported as not understood.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at, end
        First index of the run, and the index after it.

    Returns
    -------
    tuple
        End of the run, and its chunk.
    """
    span = (chunks[at].span[0], chunks[end - 1].span[1])
    return end, Chunk("UNKNOWN", chunks[at].start, chunks[end - 1].end, None, span)


def leave_out(chunks: list[Chunk], reason: str) -> None:
    """Report chunks that are left out.

    Parameters
    ----------
    chunks
        Chunks next to each other.
    reason
        Why they say nothing about places.
    """
    misunderstood((chunks[0].span[0], chunks[-1].span[1]), reason)


def apart(things: list[Chunk], predicates: list[Chunk], span: Span) -> list[Chunk]:
    """Return the predicates of a thing as a phrase of its own after a cut.

    Parameters
    ----------
    things
        Chunk of the thing, or chunks of several with their joint.
    predicates
        Chunks of the predicates.
    span
        Place of the cut in the text.

    Returns
    -------
    list of Chunk
        The cut, the things with *the*, and their predicates.
    """
    named = [
        replace(chunk, value=replace(chunk.value, determiner="the", count=None) if chunk.type == "NP" else chunk.value)
        for chunk in things
    ]
    return [Chunk("CUT", predicates[0].start, predicates[0].start, None, span), *named, *predicates]


def with_last(chunks: list[Chunk], added: list[Chunk]) -> list[Chunk]:
    """Return the chunks with others at the end, before the full stop.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    added
        Chunks that are put at its end.

    Returns
    -------
    list of Chunk
        All chunks, a full stop last.
    """
    ends = len(chunks) - 1 if added and chunks and chunks[-1].type == "CUT" else len(chunks)
    return [*chunks[:ends], *added, *chunks[ends:]]


def word_of(chunk: Chunk) -> str:
    """Return the preposition of a chunk, or the word of one that is not understood.

    Parameters
    ----------
    chunk
        Chunk of any type.

    Returns
    -------
    str
        Word or words; empty for a chunk without.
    """
    return chunk.value.preposition.phrase if isinstance(chunk.value, Relator) else str(chunk.value or "")
