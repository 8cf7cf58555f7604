"""Edit lists of chunks: ask for types, put chunks in, and turn chunks into others."""

from __future__ import annotations

from deixis.grammar.english.chunking.chunk import Chunk, Relator


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
