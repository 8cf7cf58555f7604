"""Find phrases beside the statement of a clause: what it is about, how it is done, what follows, what is compared."""

from __future__ import annotations

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, VerbGroup
from deixis.grammar.english.clauses.built import misunderstood
from deixis.grammar.english.clauses.editing import end_before, type_at
from deixis.grammar.english.tree import Degree
from deixis.grammar.english.vocabulary.tables import word_set

Run = tuple[int, Chunk | None]
"""End of a run of chunks, and the chunk that is put in its place, if any."""

_CASES = frozenset({"case", "event"})
_COMMANDS = frozenset({"PUT", "DO", "FIND", "GO"})
_BREAKS = frozenset({"COMMA", "CUT", "BUT"})
_CAUSING = word_set("ensure allow let make cause enable help prevent avoid give create provide leave keep")
"""Verbs of a participle after a comma that tells what a step is good for: *…, ensuring the lid closes*."""
_PLACING = word_set("leave keep")
"""Such verbs that place a thing where a preposition follows their object: *…, leaving the lid on the tray*."""


def framing(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a sentence is about: *in the case of small jars, …*, *broadly speaking, …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index at which the phrase may begin.

    Returns
    -------
    tuple or None
        End of the phrase with its comma, and None; None if no such phrase begins here.
    """
    if any(chunk.type != "ADVERB" for chunk in chunks[:at]):
        return None
    types = [type_at(chunks, at + k) for k in range(5)]
    if types[:2] == ["UNKNOWN", "COMMA"] and chunks[at].value == "speaking" and at:
        return at + 2, None
    case = types == ["PREP", "NP", "OF", "NP", "COMMA"] and chunks[at].value.preposition.relation == "inside"
    clause = case and any(chunk.type in FINITE | _COMMANDS for chunk in chunks[at + 5 :])
    if not clause or chunks[at + 1].value.head not in _CASES or chunks[at + 1].value.adjectives:
        return None
    _leave_out(chunks[at : at + 4], "this says what the sentence is about, not where something is")
    return at + 5, None


def manner(chunks: list[Chunk], at: int) -> Run | None:
    """Find a participle between commas before a command: *and, working clockwise, lay the knives …*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index at which the phrase may begin.

    Returns
    -------
    tuple or None
        End of the phrase with its commas, and None; None if no such phrase begins here.
    """
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at - 1) not in ("AND", "THEN"):
        return None
    end = end_before(chunks, at + 1, JOINT_TYPES)
    inside = chunks[at + 1 : end]
    if type_at(chunks, end) != "COMMA" or type_at(chunks, end + 1) not in _COMMANDS or not inside:
        return None
    first = inside[0].value
    word = first.head.partition(" ")[0] if inside[0].type == "NP" and first.determiner is None else ""
    participle = isinstance(first, VerbGroup) and first.form == "ing"
    if not (participle or word.endswith("ing")):
        return None
    _leave_out(inside, "how something is done is not where it is")
    return end + 1, None


def consequence(chunks: list[Chunk], at: int) -> Run | None:
    """Find what a step is good for: *put the cloth on the tray, ensuring the edges hang down*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the comma before the phrase.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None if no such phrase begins here.
    """
    if type_at(chunks, at) != "COMMA" or type_at(chunks, at + 1) not in ("PART", "TPART") or not at:
        return None
    group = chunks[at + 1].value
    if not isinstance(group, VerbGroup) or group.form != "ing" or group.lemma.removesuffix("ing") not in _STEMS:
        return None
    end = end_before(chunks, at + 1, _BREAKS)
    places = any(chunk.type in ("PREP", "ADV") for chunk in chunks[at + 2 : end])
    if not FINITE.isdisjoint(chunk.type for chunk in chunks[at + 2 : end]):
        places = False
    if places and group.lemma in _PLACING:
        return None
    _leave_out(chunks[at + 1 : end], "what a step is good for does not say where something is")
    return end, None


def compared_quality(chunks: list[Chunk], at: int) -> Run | None:
    """Find a comparison of a quality that has no place: *and lower in pitch than the bell*.

    Parameters
    ----------
    chunks
        Chunks of a sentence.
    at
        Index of the adjective.

    Returns
    -------
    tuple or None
        End of the phrase, and None; None if no such phrase begins here.
    """
    types = [type_at(chunks, at + k) for k in range(5)]
    if types[:3] != ["ADJP", "PREP", "NP"] or chunks[at].value[-1].degree is not Degree.COMPARATIVE:
        return None
    quality = chunks[at + 2].value
    bare = quality.determiner is None and quality.owner is None and bool(quality.head) and not quality.plural
    if not bare or chunks[at + 1].value.preposition.phrase != "in" or types[3] not in ("THAN", *JOINT_TYPES, ""):
        return None
    end = at + 3 + 2 * (types[3:] == ["THAN", "NP"])
    _leave_out(chunks[at:end], "a comparison of a quality does not say where something is")
    return end, None


def _leave_out(chunks: list[Chunk], reason: str) -> None:
    """Report chunks that are left out."""
    misunderstood((chunks[0].span[0], chunks[-1].span[1]), reason)


_STEMS = _CAUSING | {lemma.removesuffix("e") for lemma in _CAUSING}
"""Such verbs, and their stems before *-ing* where no table has the verb."""
