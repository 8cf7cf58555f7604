"""Find words of noun phrases that can be verbs, for a second look at a sentence that was not understood."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from deixis.grammar.english.chunking.chunk import JOINT_TYPES, Chunk
from deixis.grammar.english.chunking.noun_positions import is_known
from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.relation_words import places_alone, prepositions
from deixis.grammar.english.vocabulary.tables import LITERAL
from deixis.grammar.english.vocabulary.verbs import verb_forms

MAX_POSSIBLE_VERBS = 6
"""Number of words of a sentence that are tried as verbs."""
_BEGINNINGS = JOINT_TYPES | {"", "ADVERB"}


def possible_verbs(chunks: list[Chunk], words: list[Word], nouns: KnownNouns) -> Iterator[frozenset[int]]:
    """Yield sets of words to read as verbs: each word alone, and then the pairs.

    A word can be the verb of a clause if it agrees with the noun before it (*the lamp stands*, *the lamps stand*) and
    if a place, an object or the end of the clause follows; or of a command, where a clause can begin.

    Parameters
    ----------
    chunks
        Chunks of the sentence as it was read first.
    words
        Words of the sentence.
    nouns
        Nouns of the ontology.

    Yields
    ------
    frozenset of int
        Indices of words.
    """
    norms = [word.norm for word in words] + ["", ""]
    found = []
    for i, chunk in enumerate(chunks):
        if chunk.type != "NP":
            continue
        before = chunks[i - 1].type if i else ""
        for at in range(chunk.start, chunk.end):
            norm = norms[at]
            if not norm.isalpha() or norm.startswith(LITERAL) or len(norm) < 3:
                continue
            form = verb_forms().get(norm)
            follows = norms[at + 1] in _relating()
            if at > chunk.start and chunk.type == "NP":
                told_apart = (
                    at == chunk.start + 2
                    and norms[chunk.start] == "the"
                    and (is_adjective(norms[at - 1]) or norms[at - 1] == "other")
                )
                told_apart = told_apart or norms[chunk.start : at] in (["the", "other", "one"], ["one"], ["another"])
                third = form is not None and form.form == "s"  # 'the leftmost holds sand'
                inner = before in ("WITH", "OF", "PREP") and form is not None and form.form == "s"
                agrees = inner or _agrees(norms[at - 1], norm, form is not None and form.form, nouns)
                if (follows and agrees) or (told_apart and third):
                    found.append(at)
            elif at == chunk.start and before in ("REL", "ADVERB", "AND") and form is not None and follows:
                found.append(at)
            elif at == chunk.start and before in _BEGINNINGS and chunk.type == "NP" and at + 1 < len(words):
                base = form is not None and form.form == "base"
                known = nouns.knows(norm) or nouns.knows(" ".join(norms[at : chunk.end]))
                if not known and (base or (form is None and not is_known(norm) and norms[at + 1] in _relating())):
                    found.append(at)
    found = found[:MAX_POSSIBLE_VERBS]
    for at in found:
        yield frozenset({at})
    for k, at in enumerate(found):
        for other in found[k + 1 :]:
            yield frozenset({at, other})


def _agrees(noun: str, verb: str, form: str | bool, nouns: KnownNouns) -> bool:
    """Return True if a verb can follow a noun as its subject: *lamp stands*, *lamps stand*."""
    if not noun[:1].isalpha() or (is_known(noun) and not nouns.knows(noun)):
        return False
    plural = nouns.singular(noun)[1]
    unknown = form is False and not is_known(verb) and not nouns.knows(verb)
    if form == "s" or (unknown and verb.endswith("s") and not verb.endswith("ss")):
        return not plural
    return (form == "base" and plural) or form == "past"


@cache
def _relating() -> frozenset[str]:
    return frozenset(prepositions().keys() | places_alone().keys() | _DETERMINERS)


_DETERMINERS = frozenset({"the", "a", "an", "its", "their", "his", "her", "my", "your", "our", "this", "each"})
