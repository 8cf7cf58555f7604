"""Words that coordinated compounds share: *dessert or coffee spoon* is *dessert spoon or coffee spoon*."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.function_words import DETERMINERS, POSSESSIVES
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.nouns import EVENTS, SUBSTANCES
from deixis.grammar.english.vocabulary.tables import word_set

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


def with_shared_heads(words: Sequence[Word], nouns: KnownNouns) -> list[Word]:
    """Return the words of a sentence with the words that coordinated compounds share in each of them.

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
    >>> from deixis.grammar.english.tokens import words_of
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
        first, joint, second, last = (word.norm for word in found[at : at + 4])
        if (first, joint, second) == ("bread", "and", "butter") and last in _BREAD_AND_BUTTER:
            found[at] = replace(found[at], norm=_BREAD_AND_BUTTER[last], end=found[at + 2].end)
            del found[at + 1 : at + 3]
    for at in range(len(found) - 3, -1, -1):
        first, joint, second, head = [*(word.norm for word in found[at : at + 4]), ""][:4]
        before = at - 1
        while before > 0 and is_adjective(found[before].norm):
            before -= 1
        opens = at == 0 or found[before].norm in DETERMINERS | POSSESSIVES.keys() | {",", "and", ":", ";"}
        if not opens or first == second or not joint.isalpha():
            continue
        if joint in ("and", "or"):
            shared = _shared_head(found, at, nouns)
            if shared is not None:
                found.insert(at + 1, Word(shared, shared, found[at].start, found[at].end, False))
        elif second in ("and", "or") and _share_modifier(first, joint, head, nouns):
            found.insert(at + 3, Word(first, first, found[at + 3].start, found[at + 3].start, False))
    return found


def _share_modifier(modifier: str, one: str, other: str, nouns: KnownNouns) -> bool:
    """Return True for two pieces of cutlery that are both known with the modifier: *dessert fork and spoon*."""
    cutlery = one in _CUTLERY and other in _CUTLERY and one != other
    return cutlery and nouns.knows(f"{modifier} {one}") and nouns.knows(f"{modifier} {other}")


def _shared_head(words: Sequence[Word], at: int, nouns: KnownNouns) -> str | None:
    """Return the noun that the modifiers at this place and after the next conjunction share."""
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
    several = joint == "or" or nouns.singular(head)[1]
    modified = first in _USES and (second in _USES or nouns.knows(f"{second} {head}"))
    return head if several and modified and nouns.knows(head) else None
