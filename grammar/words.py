"""The closed-class words of the layout language.

Relation words, hedges, kinds of things and colours are not here: they come from the ontology.
"""

from __future__ import annotations

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

# Words that carry no name of a thing. One of them inside an unquoted name means that the sentence was not understood,
# so they are refused there instead of becoming part of an object called "spoon to the".
_FUNCTION_WORDS = """
about across after against all almost along although am among any approximately around as aside at because
been before being beside besides between both but by can close closer could diagonally did directly do does
down during each either else every exactly far farther for further had has have he her here hers him his how i
if immediately in into it its itself just may me might mine must my near nearer nearly neither next no nobody
none nor nothing now of off once one only onto opposite other our out outside over per please precisely rather
relative roughly she should since slightly so some such than that their them then there these they this those
though through throughout till to together too toward towards until up us very via was we were what when where
whereas whether which while who whom whose why will with without would yet you your
"""
FUNCTION_WORDS = frozenset(_FUNCTION_WORDS.split())
NOUNS_TOO = frozenset({"can", "mine", "till"})  # a watering can, and others that things may be called

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
    "not": "NOT",
    "never": "NOT",
    "optional": "OPTIONAL",
    "optionally": "OPTIONAL",
}
"""The terminal of each word that is no part of a name."""
