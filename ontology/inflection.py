"""Singular and plural of English nouns, by rule and by a list of irregular ones."""

from __future__ import annotations

import re

IRREGULAR = {
    "child": "children",
    "person": "people",
    "man": "men",
    "woman": "women",
    "mouse": "mice",
    "foot": "feet",
    "tooth": "teeth",
    "goose": "geese",
    "ox": "oxen",
    "die": "dice",
    "louse": "lice",
    "cactus": "cacti",
    "fungus": "fungi",
    "quiz": "quizzes",
    "knife": "knives",
    "life": "lives",
    "wife": "wives",
    "leaf": "leaves",
    "loaf": "loaves",
    "shelf": "shelves",
    "half": "halves",
    "scarf": "scarves",
    "calf": "calves",
    "wolf": "wolves",
    "elf": "elves",
    "thief": "thieves",
    "wharf": "wharves",
    "hoof": "hooves",
    "tomato": "tomatoes",
    "potato": "potatoes",
    "echo": "echoes",
    "hero": "heroes",
    "mango": "mangoes",
    "cargo": "cargoes",
    "mosquito": "mosquitoes",
    "bus": "buses",
    "gas": "gases",
    "lens": "lenses",
    "canvas": "canvases",
    "iris": "irises",
}
"""Plurals of nouns that the rules do not give, by singular."""

SAME = frozenset(
    {"sheep", "fish", "deer", "salmon", "trout", "aircraft", "spacecraft", "series", "species", "cutlery", "furniture"}
    | {"clothing", "luggage", "equipment", "scissors", "trousers", "jeans", "pants", "shorts", "tights", "leggings"}
    | {"pyjamas", "pajamas", "overalls", "dungarees", "pliers", "tweezers", "tongs", "binoculars", "headphones"}
    | {"earphones", "goggles", "sunglasses", "eyeglasses", "spectacles", "clothes", "stairs", "barracks", "chess"}
    | {"crockery", "tableware", "cookware", "stationery", "jewellery", "jewelry", "bedding", "footwear", "underwear"}
    | {"outerwear", "headwear", "seafood"}
)
"""Nouns with one form for both numbers, and nouns that are plural only."""

ENDS_OF_COMPOUNDS = ("man", "woman", "child", "mouse", "foot", "tooth", "knife", "shelf", "leaf", "loaf")
"""Irregular nouns that also end words written as one: *fireman*, *bookshelf*."""

_SINGULAR = {many: one for one, many in IRREGULAR.items()} | {"cactuses": "cactus", "mangos": "mango"}


def plural(noun: str) -> str:
    """Return the plural of a noun; of several words, the last one is inflected, and a plural in *s* stays as it is.

    Parameters
    ----------
    noun
        The noun.

    Returns
    -------
    str
        The plural.

    Examples
    --------
    >>> [plural(noun) for noun in ("fork", "wine glass", "kitchen knife", "berry", "toy", "photo", "scissors")]
    ['forks', 'wine glasses', 'kitchen knives', 'berries', 'toys', 'photos', 'scissors']
    """
    before, last = _last_word(noun)
    key = last.casefold()
    if key in SAME or (key.endswith("s") and is_plural(key)):
        return noun
    if key in IRREGULAR:
        return before + IRREGULAR[key]
    for one in ENDS_OF_COMPOUNDS:
        if key.endswith(one) and len(key) > len(one) + 2:
            return before + last[: -len(one)] + IRREGULAR[one]
    if re.search(r"[^aeiou]y$|quy$", key):
        return before + last[:-1] + "ies"
    return noun + ("es" if re.search(r"(s|x|z|ch|sh)$", key) else "s")


def is_plural(noun: str) -> bool:
    """Return True for a noun whose last word is a plural: a verb after it is plural, and it has no article *a*.

    Parameters
    ----------
    noun
        The noun, with spaces, hyphens or underscores between its words.

    Returns
    -------
    bool
        True for a noun that is plural only, irregular, or ends in *s* as a plural does; the lexicon is not consulted.

    Examples
    --------
    >>> [is_plural(noun) for noun in ("chopsticks", "kitchen_scissors", "mice", "series", "chess", "bus")]
    [True, True, True, False, False, False]
    """
    key = _last_word(noun)[1].casefold()
    if key in SAME:
        return key.endswith("s") and not key.endswith(("ss", "ies"))
    return key in _SINGULAR or (key.endswith("s") and singular(key) != key and not key.endswith(("us", "as", "is")))


def singulars(noun: str) -> tuple[str, ...]:
    """Return the possible singulars of a noun.

    Spelling leaves the singular open in some cases: *cookies* and *berries*, *shoes* and *potatoes*.

    Parameters
    ----------
    noun
        A noun in the singular or the plural.

    Returns
    -------
    tuple of str
        The singulars, the most likely first; only the noun itself if it is not a plural.

    Examples
    --------
    >>> singulars("cookies"), singulars("wine glasses"), singulars("menus"), singulars("knives")
    (('cooky', 'cookie'), ('wine glass', 'wine glasse'), ('menus', 'menu'), ('knife',))
    """
    before, last = _last_word(noun)
    return tuple(before + one for one in _singulars(last))


def singular(noun: str) -> str:
    """Return the most likely singular of a noun by its spelling.

    A :class:`~deixis.ontology.lexicon.lexicon.Lexicon` decides the open cases by the nouns that it knows.

    Parameters
    ----------
    noun
        A noun in the singular or the plural.

    Returns
    -------
    str
        The singular.

    Examples
    --------
    >>> [singular(noun) for noun in ("forks", "children", "glass", "boxes", "mice", "trousers")]
    ['fork', 'child', 'glass', 'box', 'mouse', 'trousers']
    """
    return singulars(noun)[0]


def _singulars(word: str) -> tuple[str, ...]:
    key = word.casefold()
    if key in _SINGULAR:
        return (_SINGULAR[key],)
    for one in ENDS_OF_COMPOUNDS:
        many = IRREGULAR[one]
        if key.endswith(many) and len(key) > len(many) + 2:
            return (word[: -len(many)] + one,)
    if key in IRREGULAR or len(key) < 3 or not key.endswith("s") or key.endswith("ss"):
        return (word,)
    if key in SAME or len(key) == 3 or re.search(r"(us|is)$", key):  # 'bus', but also 'menus' and 'kiwis'
        return (word, word[:-1])
    if key.endswith("ies"):
        return (word[:-1],) if len(key) == 4 else (word[:-3] + "y", word[:-1])
    if re.search(r"[^z]zes$", key):
        return (word[:-1], word[:-2])  # 'sizes', but 'quizzes'
    if re.search(r"(s|x|z|ch|sh)es$", key):
        return (word[:-2], word[:-1])
    if key.endswith("oes"):
        return (word[:-1], word[:-2])
    return (word[:-1],)


def _last_word(noun: str) -> tuple[str, str]:
    found = re.match(r"(.*[\s_-])?(.*)$", noun, re.DOTALL)
    assert found is not None
    return found[1] or "", found[2]
