"""Coordinated modifiers that share a head: *the dessert or coffee spoon* is *the dessert spoon or coffee spoon*."""

from __future__ import annotations

from collections.abc import Sequence

from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.function_words import DETERMINERS, POSSESSIVES
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns

_ONE_THING = frozenset({("bread", "butter"), ("cheese", "wine"), ("salt", "pepper")})
"""Modifiers of one thing: *a bread and butter plate*."""


def with_shared_heads(words: Sequence[Word], nouns: KnownNouns) -> list[Word]:
    """Return the words of a sentence with a shared head after each modifier that makes a known noun with it.

    Parameters
    ----------
    words
        Words of a sentence.
    nouns
        Known nouns.

    Returns
    -------
    list of Word
        The words; a head that was repeated is at the place of its modifier, and does not count as a word.

    Examples
    --------
    >>> from deixis.grammar.english.tokens import words_of
    >>> from deixis.grammar.english.vocabulary.known_nouns import known_nouns
    >>> from deixis.ontology.tbox import default_ontology
    >>> nouns, text = known_nouns(default_ontology().kinds), "the salad and dinner forks"
    >>> " ".join(word.norm for word in with_shared_heads(words_of(text, (0, len(text))), nouns))
    'the salad forks and dinner forks'
    """
    found = list(words)
    for at in range(len(found) - 4, -1, -1):
        first, joint, second, head = (word.norm for word in found[at : at + 4])
        before = found[at - 1].norm if at else ","
        if before not in DETERMINERS and before not in POSSESSIVES and before not in (",", "and", ":", ";"):
            continue
        if joint not in ("and", "or") or first == second or (first, second) in _ONE_THING or not head.isalpha():
            continue
        if nouns.knows(f"{first} {head}") and nouns.knows(f"{second} {head}"):
            found.insert(at + 1, Word(head, head, found[at].start, found[at].end, False))
    return found
