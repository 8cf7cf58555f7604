"""Words that coordinated compounds share: *dessert or coffee spoon* is *dessert spoon or coffee spoon*."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    DETERMINERS,
    IS_FORMS,
    MODALS,
    POSSESSIVES,
    PRONOUNS,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.nouns import EVENTS, SUBSTANCES
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import PUT_VERBS, verb_forms

_ONE_THING = frozenset({("bread", "butter"), ("cheese", "wine"), ("salt", "pepper")})
"""Modifiers of one thing: *a cheese and wine set*."""
_BREAD_AND_BUTTER = {
    **dict.fromkeys(("plate", "plates", "dish", "dishes"), "bread"),
    **dict.fromkeys(("knife", "knives", "spreader", "spreaders"), "butter"),
}
"""Word that *bread and butter* stands for before a noun."""
_USES = (
    EVENTS
    | SUBSTANCES
    | word_set(
        "bread dessert salad fruit melon oyster egg fish meat cake luncheon brunch appetizer starter cocktail"
        " champagne picnic"
    )
    | word_set("patio dining serving")
)
"""Nouns that say what the thing of the next noun is for, or where: *dessert spoon*, *picnic table*."""
_CUTLERY = word_set("fork forks knife knives spoon spoons")
_SIZES = frozenset({"size", "sized"})
_ENDINGS = ("spoon", "cup")
"""Nouns that are also written as the end of one word: *teaspoon*, *teacup*."""

_OPPOSITES = (
    {"front", "back"}, {"front", "rear"}, {"left", "right"}, {"top", "bottom"}, {"upper", "lower"}, {"inner", "outer"},
    {"top", "middle"}, {"middle", "bottom"}, {"left", "middle"}, {"middle", "right"},
    {"side", "back"}, {"side", "front"}, {"side", "top"}, {"side", "bottom"}, {"first", "second"}, {"main", "side"},
)  # fmt: skip
"""Pairs of modifiers that no single thing has both of."""

_CLOSED = DETERMINERS | POSSESSIVES.keys() | PRONOUNS.keys() | IS_FORMS | MODALS.keys() | ADVERBS | {"and", "or", "but"}
"""Words that are in no noun phrase between its modifiers and its head."""

_MAX_HEAD = 3
"""Largest number of words of a shared head: *the left and right surround speakers*."""


def with_shared_heads(words: Sequence[Word], nouns: KnownNouns) -> list[Word]:
    """Return the words of a sentence with the words that coordinated compounds share in each of them.

    Opposite sides share any plural that is not a place: *the front and back rails*, but not *the left and right sides*.
    After *or* they share a known singular and a place as well: *the top or middle shelf*.

    Parameters
    ----------
    words
        Words of a sentence.
    nouns
        Known nouns.

    Returns
    -------
    list of Word
        The words; a word that was repeated is at the place of its neighbour, and does not count as a word. *Bread and
        butter* before the noun of a thing is one word.

    Examples
    --------
    >>> from deixis.grammar.english.rewording import words_of
    >>> from deixis.grammar.english.vocabulary.known_nouns import known_nouns
    >>> from deixis.ontology.tbox import default_ontology
    >>> nouns = known_nouns(default_ontology().kinds)
    >>> for text in ("the salad and dinner forks", "a dessert fork and spoon", "the bread and butter plate"):
    ...     print(*(word.norm for word in with_shared_heads(words_of(text, (0, len(text))), nouns)))
    the salad forks and dinner forks
    a dessert fork and dessert spoon
    the bread plate
    """
    found = list(words)
    for at in range(len(found) - 4, -1, -1):
        first, joint, second, last = [*(word.norm for word in found[at : at + 4]), "", ""][:4]
        if (first, joint, second) == ("bread", "and", "butter") and last in _BREAD_AND_BUTTER:
            found[at] = replace(found[at], norm=_BREAD_AND_BUTTER[last], end=found[at + 2].end)
            del found[at + 1 : at + 3]
    for at in range(len(found) - 3, -1, -1):
        first, joint, second, head = [*(word.norm for word in found[at : at + 4]), ""][:4]
        before = at - 1
        while before > 0 and is_adjective(found[before].norm):
            before -= 1
        compound = before >= 0 and (found[before].norm in _USES or nouns.knows(f"{found[before].norm} {first}"))
        before -= compound
        opens = before < 0 or found[before].norm in DETERMINERS | POSSESSIVES.keys() | {",", "and", ":", ";"}
        commanded = not opens and found[before].norm in PUT_VERBS
        commanded = commanded and (before == 0 or found[before - 1].norm in (",", "and", "then"))
        if not (opens or commanded) or first == second or not joint.isalpha():
            continue
        if joint in ("and", "or"):
            opposite = {first, second} in _OPPOSITES
            heads = (
                _head_of_sides(found, at + 3, nouns, joint) if opposite and (first, second) not in _ONE_THING else []
            )
            shared = None if heads else _shared_head(found, at, nouns, sure=not opens or compound)
            found[at + 1 : at + 1] = [Word(word, word, found[at].start, found[at].end, False) for word in heads]
            if shared is not None:
                found.insert(at + 1, Word(shared, shared, found[at].start, found[at].end, False))
        elif second in ("and", "or") and _share_modifier(first, joint, head, nouns):
            found.insert(at + 3, Word(first, first, found[at + 3].start, found[at + 3].start, False))
    return found


def _share_modifier(modifier: str, one: str, other: str, nouns: KnownNouns) -> bool:
    """Return True for two pieces of cutlery that are both known with the modifier: *dessert fork and spoon*."""
    cutlery = one in _CUTLERY and other in _CUTLERY and one != other
    return cutlery and nouns.knows(f"{modifier} {one}") and nouns.knows(f"{modifier} {other}")


def _shared_head(words: Sequence[Word], at: int, nouns: KnownNouns, sure: bool) -> str | None:
    """Return the noun that the modifiers at this place and after the next conjunction share.

    If only what is ``sure`` is wanted, it is known with both modifiers.
    """
    first, joint, second = (word.norm for word in words[at : at + 3])
    ending = next((noun for noun in _ENDINGS if second.endswith(noun) and second != noun), None)
    if ending is not None:
        return ending if first in _USES and nouns.knows(f"{first} {ending}") else None
    following = [word.norm for word in words[at + 3 : at + 5]]
    head = next((norm for norm in following[:2] if norm not in _SIZES), "")
    if not head.isalpha() or (head != following[0] and following[0] not in _SIZES) or (first, second) in _ONE_THING:
        return None
    if is_adjective(first) and len(following) > 1 and nouns.knows(f"{head} {following[1]}"):
        return None  # 'a red or white wine glass'
    if nouns.knows(f"{first} {head}") and nouns.knows(f"{second} {head}"):
        return head
    if sure:
        return None
    several = joint == "or" or nouns.singular(head)[1]
    modified = first in _USES and (second in _USES or nouns.knows(f"{second} {head}"))
    return head if several and modified and nouns.knows(head) else None


def _head_of_sides(words: Sequence[Word], at: int, nouns: KnownNouns, joint: str) -> list[str]:
    """Return the words of the noun that two sides share: *surround speakers*, after *or* also *shelf*."""
    head: list[str] = []
    for word in words[at : at + _MAX_HEAD]:
        if not word.norm.isalpha() or word.norm in prepositions() or word.norm in _CLOSED:
            return []
        head.append(word.norm)
        one, plural = nouns.singular(word.norm)
        form = verb_forms().get(word.norm)
        if joint == "or" and not plural and (nouns.knows(one) or one in PLACE_NOUNS):
            return head
        if plural:
            is_verb = form is not None and form.form == "s" and not nouns.knows(word.norm)
            return [] if one in PLACE_NOUNS or is_verb else head
    return []
