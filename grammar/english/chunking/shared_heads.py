"""Coordinated modifiers that share a head: *the dessert or coffee spoon* is *the dessert spoon or coffee spoon*."""

from __future__ import annotations

from collections.abc import Sequence

from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    DETERMINERS,
    IS_FORMS,
    MODALS,
    POSSESSIVES,
    PRONOUNS,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS, prepositions
from deixis.grammar.english.vocabulary.verbs import verb_forms

_ONE_THING = frozenset({("bread", "butter"), ("cheese", "wine"), ("salt", "pepper")})
"""Modifiers of one thing: *a bread and butter plate*."""

_OPPOSITES = (
    {"front", "back"}, {"front", "rear"}, {"left", "right"}, {"top", "bottom"}, {"upper", "lower"}, {"inner", "outer"},
    {"side", "back"}, {"side", "front"}, {"side", "top"}, {"side", "bottom"}, {"first", "second"},
)  # fmt: skip
"""Pairs of modifiers that no single thing has both of."""

_CLOSED = DETERMINERS | POSSESSIVES.keys() | PRONOUNS.keys() | IS_FORMS | MODALS.keys() | ADVERBS | {"and", "or", "but"}
"""Words that are in no noun phrase between its modifiers and its head."""

_MAX_HEAD = 3
"""Largest number of words of a shared head: *the left and right surround speakers*."""


def with_shared_heads(words: Sequence[Word], nouns: KnownNouns) -> list[Word]:
    """Return the words of a sentence with a shared head after each modifier that makes a known noun with it.

    Opposite sides share any plural that is not a place: *the front and back rails*, but not *the left and right sides*.

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
        if {first, second} in _OPPOSITES and (shared := _plural_head(found, at + 3, nouns)):
            start, end = found[at].start, found[at].end
            found[at + 1 : at + 1] = [Word(word, word, start, end, False) for word in shared]
            continue
        if nouns.knows(f"{first} {head}") and nouns.knows(f"{second} {head}"):
            found.insert(at + 1, Word(head, head, found[at].start, found[at].end, False))
    return found


def _plural_head(words: Sequence[Word], at: int, nouns: KnownNouns) -> list[str]:
    """Return the words of a plural that begins at a word: *surround speakers*; none for a place and a singular."""
    head: list[str] = []
    for word in words[at : at + _MAX_HEAD]:
        if not word.norm.isalpha() or word.norm in prepositions() or word.norm in _CLOSED:
            return []
        head.append(word.norm)
        one, plural = nouns.singular(word.norm)
        form = verb_forms().get(word.norm)
        if plural:
            said = form is not None and form.form == "s" and not nouns.knows(word.norm)
            return [] if one in PLACE_NOUNS or said else head
    return []
