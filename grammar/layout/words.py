"""Words of the layout language: closed classes, and the pattern that finds the longest phrase.

Relation words, hedges, kinds of things and colours come from the ontology.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import product
from typing import Any

from deixis.ontology.relations.relation import Reading, Relation
from deixis.ontology.tbox import Ontology

IS = ("is", "are")
VERBS = (
    *("goes", "go", "lies", "lie", "sits", "sit", "stands", "stand", "belongs", "belong", "rests", "rest"),
    *("placed", "laid", "set", "put", "located", "situated", "positioned", "standing", "sitting"),
)
VERBS_OR_NOUNS = frozenset({"stand", "rest", "set", "put"})  # a cake stand, a knife rest, a tea set
NUMBERS = {
    word: value
    for value, word in enumerate(
        ("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"), start=2
    )
}

# Words that never occur in the name of a thing. One of them inside an unquoted name means that the sentence was not
# understood, so it is an error instead of an object called "spoon to the".
_FUNCTION_WORDS = """
about across after against all almost along also although am among another any approximately around as aside at
because been before being beside besides between both but by can close closer could diagonally did directly do does
down during each either else even every exactly fairly far farther for further had has have he her here hers him
his how i if immediately in into it its itself just may me might mine must my near nearer nearly neither next no
nobody none nor nothing now of off once one only onto opposite other our out outside over per please precisely
quite rather relative roughly she should since slightly so some somewhat such that their them then there these they
this those though through throughout till to together too toward towards until up us very via was we were what when
where whereas whether which while who whom whose why will with without would yet you your
"""
# Forms of verbs that state no relation of the language; "lamp hangs on monitor" is no fact about a lamp_hangs.
_OTHER_VERBS = """
be been appears became become becomes came comes contains faces floats gets hang hanging hangs hung holds keeps leans
leant looks moves overlaps occupies points precedes remains seems shows stays surrounds touches
"""
_DENIALS = """
cannot can't couldn't don't doesn't didn't isn't aren't wasn't weren't won't wouldn't shouldn't mustn't
couldnt dont doesnt didnt isnt arent wasnt werent wouldnt shouldnt mustnt
"""
DENIALS = frozenset(_DENIALS.split())
_DEGREES = "least less more most"  # "left most" is one word: leftmost
FUNCTION_WORDS = frozenset(f"{_FUNCTION_WORDS} {_OTHER_VERBS} {_DEGREES}".split()) | DENIALS
NOUNS_TOO = frozenset({"can", "mine", "till"})  # function words that can also name a thing: a watering can

_NOUNS_IN_LY = """
ally anomaly assembly belly brolly bully butterfly doily dolly dragonfly family fly gully holly jelly lily lolly
monopoly panoply rally reply supply tally telly
"""
NOUNS_IN_LY = frozenset(_NOUNS_IN_LY.split())
"""Nouns with the ending of adverbs."""

KEYWORDS: dict[str, str] = {
    **dict.fromkeys(FUNCTION_WORDS, "FUNCTION"),
    **dict.fromkeys(IS, "IS"),
    **dict.fromkeys(VERBS, "VERB"),
    "layout": "_LAYOUT",
    "seen": "_SEEN",
    "from": "_FROM",
    "include": "_INCLUDE",
    "and": "_AND",
    "or": "_OR",
    "than": "_THAN",
    "nothing": "_NOTHING",
    "not": "NOT",
    "never": "NOT",
    "optional": "OPTIONAL",
    "optionally": "OPTIONAL",
}
"""Terminals of the words that cannot be part of an unquoted name."""


BETWEEN = r"[ \t_]+(?:(?:the|an|a)[ \t_]+)*"
"""Pattern of what separates the words of a phrase: blanks and articles."""

BOUNDARY = r"(?![\w-]|[^\x00-\x7f\s])"
"""Pattern of the end of a word, as in the terminal NAME."""


FIRST_WORD = re.compile(r"[^\W\d_]*")
"""Pattern of the letters at the beginning of a phrase, by which it is found: none if it begins with a number."""


def by_first_word(patterns: Iterable[tuple[Iterable[str], str]]) -> dict[str, list[str]]:
    """Return patterns by the first words, in small letters, of the phrases that they match.

    Parameters
    ----------
    patterns
        Patterns, or phrases that stand for themselves, each after the phrases that it begins with.

    Returns
    -------
    dict
        Patterns by first word.

    Examples
    --------
    >>> by_first_word([(("left", "right"), "(?:left|right) of"), (("left",), "left")])
    {'left': ['(?:left|right) of', 'left'], 'right': ['(?:left|right) of']}
    """
    found: dict[str, list[str]] = {}
    for starts, pattern in patterns:
        for word in dict.fromkeys(map(first_word, starts)):
            found.setdefault(word, []).append(pattern)
    return found


def first_word(text: str, start: int = 0) -> str:
    """Return the letters at a place of a text, in small letters.

    Parameters
    ----------
    text
        The text.
    start
        The place.

    Returns
    -------
    str
        The letters, none if there is another character.
    """
    found = FIRST_WORD.match(text, start)
    return found[0].lower() if found is not None else ""


def phrase_pattern(phrases: Iterable[str]) -> str:
    """Return a regular expression that matches the longest of the phrases.

    Blanks, underscores and articles may separate the words of a phrase. The expression is a prefix tree: matching
    costs one branch per letter instead of one per phrase, and tries nothing twice.

    Parameters
    ----------
    phrases
        The phrases.

    Returns
    -------
    str
        The expression.

    Examples
    --------
    >>> pattern = re.compile(phrase_pattern(["left", "to left of"]), re.IGNORECASE)
    >>> [pattern.match(text) is not None for text in ("to the left_of", "left", "left_glass", "lefty")]
    [True, True, False, False]
    """
    tree: dict[str, Any] = {}
    for phrase in phrases:
        node = tree
        for word in phrase.split():
            node = node.setdefault(word, {})
        node[""] = {}
    return _alternatives(tree) + BOUNDARY


def _alternatives(tree: dict[str, Any]) -> str:
    by_letter: dict[str, list[str]] = {}
    for word in sorted(word for word in tree if word):
        node = tree[word]
        longer = f"(?:{BETWEEN}{_alternatives(node)}){'?' if '' in node else ''}" if any(node) else ""
        by_letter.setdefault(word[0], []).append(re.escape(word[1:]) + longer)
    options = [re.escape(letter) + f"(?:{'|'.join(rests)})" for letter, rests in by_letter.items()]
    return f"(?:{'|'.join(options)})"


def chains(ontology: Ontology) -> dict[str, Relation]:
    """Return the relation of each chain head, without its colon: from one side to the opposite, for each direction.

    Parameters
    ----------
    ontology
        The ontology.

    Returns
    -------
    dict
        Relation by chain head.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> found = chains(default_ontology())
    >>> found["left to right"].name, found["top left to bottom right"].name, found["above to below"].name
    ('left', 'top_left', 'top')
    """
    wide = ontology.relations.of_reading(Reading.WIDE)
    directions = [relation for relation in wide if relation.z_atoms == 0]  # on and under have no direction
    found: dict[str, Relation] = {}
    for relation in directions:
        inverse = ontology.relations[relation.inverse]
        for start, end in product(_sides(relation), _sides(inverse)):
            found.setdefault(f"{start} to {end}", relation)
    return found


def _sides(relation: Relation) -> tuple[str, ...]:
    return tuple(dict.fromkeys((relation.word.replace("_", " "), relation.phrase.removesuffix(" of"))))
