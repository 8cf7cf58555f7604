"""Word classes, and which of them each word of a sentence can have by the tables and by its shape."""

from __future__ import annotations

from functools import cache
from typing import Literal, NamedTuple

from deixis.grammar.english.tokens import Word
from deixis.grammar.english.vocabulary.adjectives import is_adjective, is_material_noun
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    CHAT_WORDS,
    DETERMINERS,
    HEDGES,
    IS_FORMS,
    MODALS,
    NEGATIONS,
    NUMBERS,
    ORDINALS,
    POSSESSIVES,
    PRONOUNS,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.relation_words import PLACE_NOUNS, places_alone, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import (
    FIND_VERBS,
    NAMED_LIKE_THINGS,
    NOUNS_BEFORE_VERBS,
    PUT_VERBS,
    REPORTS,
    SAYING,
    VerbForm,
    verb_forms,
)

WordClass = Literal[
    "noun", "adjective", "determiner", "pronoun", "third", "past", "base", "participle", "ing", "be", "modal", "to",
    "preposition", "place", "adverb", "conjunction", "comma", "cut", "subordinate", "relative", "genitive",
]  # fmt: skip
"""Class of a word; ``third`` and ``past`` are finite verbs, ``base`` is a plural verb, a command or an infinitive."""

NOMINAL: frozenset[WordClass] = frozenset({"noun", "adjective"})
FINITE: frozenset[WordClass] = frozenset({"third", "past", "base"})
VERBAL: frozenset[WordClass] = frozenset({"third", "past", "base", "participle", "ing", "modal"})
"""Classes of words that a noun phrase does not go on with as its noun."""


class Possible(NamedTuple):
    """A class that a word can have, with what the word itself says for or against it: keys of the weights."""

    word_class: WordClass
    priors: tuple[str, ...] = ()


@cache
def closed_words() -> frozenset[str]:
    """Return the words that are never nouns."""
    single = {phrase for phrase in (*prepositions(), *places_alone()) if " " not in phrase}
    return frozenset(
        (_NEVER_NOUNS | CHAT_WORDS | single | IS_FORMS | NEGATIONS | ADVERBS | HEDGES | MODALS.keys() | DETERMINERS
         | PRONOUNS.keys() | POSSESSIVES.keys())
        - NOUN_OR_PREPOSITION - NOUN_OR_MODAL - {"back", "flat", "well", "till"}
    )  # fmt: skip


def is_known(word: str) -> bool:
    """Return True for a word of the tables: a function word, a number, an adjective or a form of a verb.

    Parameters
    ----------
    word
        Word in lower case.

    Returns
    -------
    bool
        False for a word that only its position can explain, which is a noun as a rule.
    """
    return (
        word in closed_words()
        or word in NUMBERS
        or word in ORDINALS
        or word in PLACE_NOUNS
        or word in verb_forms()
        or is_adjective(word)
    )


def possible_classes(words: list[Word], norms: list[str], nouns: KnownNouns) -> list[tuple[Possible, ...]]:
    """Return the classes that each word can have.

    Parameters
    ----------
    words
        Words of one sentence.
    norms
        Their normal forms, with empty ones after the last.
    nouns
        Nouns of the ontology.

    Returns
    -------
    list of tuple of Possible
        At least one class for each word.
    """
    found = [_possible(words, norms, at, nouns) for at in range(len(words))]
    at = 0
    while at < len(words):
        end, of_phrase = _phrase(norms, at)
        found[at:end] = [of_phrase] * (end - at)
        at = max(end, at + 1)
    return found


def _phrase(norms: list[str], at: int) -> tuple[int, tuple[Possible, ...]]:
    """Return the end of a preposition or a place of several words that begins here, and the class of its words."""
    for phrase, word_class in _phrases().get(norms[at], ()):
        if tuple(norms[at : at + len(phrase)]) == phrase:
            return at + len(phrase), (Possible(word_class),)
    return at, ()


@cache
def _phrases() -> dict[str, list[tuple[tuple[str, ...], WordClass]]]:
    """Return the prepositions and places of several words by their first word, the longest first."""
    found: dict[str, list[tuple[tuple[str, ...], WordClass]]] = {}
    for phrase in sorted({*prepositions(), *places_alone()}, key=len, reverse=True):
        parts = tuple(phrase.split())
        if len(parts) > 1 and parts[-1] != "to":  # 'to' may belong to a verb
            found.setdefault(parts[0], []).append((parts, "preposition" if phrase in prepositions() else "place"))
    return found


def _possible(words: list[Word], norms: list[str], at: int, nouns: KnownNouns) -> tuple[Possible, ...]:
    norm, form = norms[at], verb_forms().get(norms[at])
    if norm.isdigit() and at and _is_open(norms[at - 1]):
        return Possible("determiner"), Possible("noun", ("number after a word",))
    if (fixed := _function_word(norm)) is not None:
        return fixed
    if at == 0 and norms[1] in IS_FORMS and norm.isalpha() and norm not in ADVERBS | HEDGES:
        return (Possible("noun"),)  # a name: 'Holly is …'
    if norm in PLACE_NOUNS and form is None:
        return (Possible("noun"), Possible("adjective")) if is_adjective(norm) else (Possible("noun"),)
    if norm in closed_words() and form is None:
        if norm not in prepositions() and norm not in places_alone():
            return (Possible("adverb"),)
        return (Possible("preposition"), *([Possible("subordinate")] if norm in _SUBORDINATE else []))
    known = nouns.knows(norm)
    if norm.endswith("ly") and norm.isalpha() and norm not in _LY_NOUNS and not known:
        return (Possible("adverb"),)
    if form is None:
        return _unknown_to_verbs(norm, known, nouns)
    return (*_forms(words, at, norm, form, known), *([Possible("adjective")] if is_adjective(norm) else []))


def _is_open(norm: str) -> bool:
    """Return True for a word that may be a noun with a number after it: *point* of *on point 13*."""
    return norm.isalpha() and norm not in closed_words() and norm not in NUMBERS and _function_word(norm) is None


def _function_word(norm: str) -> tuple[Possible, ...] | None:
    """Return the classes of a function word, a number or a mark; None for a word of an open class."""
    fixed = _FIXED.get(norm)
    if fixed is not None:
        return fixed
    if norm in POSSESSIVES or (norm in DETERMINERS and norm not in PRONOUNS and norm not in _ALONE):
        return (Possible("determiner"),)
    if norm in _ALONE or norm in NUMBERS or norm in ORDINALS or (norm in DETERMINERS and norm in PRONOUNS):
        return Possible("determiner"), Possible("pronoun")
    if norm in PRONOUNS:
        return (Possible("pronoun"),)
    if norm in _SUBORDINATE and norm not in prepositions():
        return (Possible("subordinate"),)
    if norm[0].isdigit():
        return (Possible("determiner"),)
    return None if norm[0].isalpha() else (Possible("noun"),)


def _unknown_to_verbs(norm: str, known: bool, nouns: KnownNouns) -> tuple[Possible, ...]:
    """Return the classes of a word that is not a form of a known verb."""
    adjective = is_adjective(norm)
    if norm in SAYING | REPORTS:
        return Possible("noun"), Possible("third" if norm.endswith("s") else "past", ("verb of saying",))
    if norm.endswith("ing") and len(norm) > 5:
        return Possible("noun"), Possible("ing", ("known noun in -ing" if known else "unknown in -ing",))
    if norm.endswith("ed") and len(norm) > 4 and not adjective and norm not in ED_NOUNS:
        return Possible("noun"), Possible("participle", ("unknown in -ed",))
    part = verb_forms().get(norm.rpartition("-")[2]) if "-" in norm else None
    if part is not None and part.form in ("past", "participle", "ing"):
        return Possible("adjective"), Possible("noun")  # 'half-eaten'
    if adjective:
        material = known or is_material_noun(norm)
        return (Possible("adjective"), *([Possible("noun")] if material else []))
    if norm.endswith("s") and nouns.singular(norm)[0] in NOUNS_BEFORE_VERBS:
        return Possible("noun"), Possible("third", ("rather a plural",))
    if known or not (norm.isalpha() or "-" in norm) or len(norm) < 3 or is_known(norm):
        return (Possible("noun"),)
    if norm.endswith("s") and not norm.endswith("ss"):
        return Possible("noun"), Possible("third", ("unknown in -s",))
    return Possible("noun"), Possible("base", ("unknown plain form",))


def _forms(words: list[Word], at: int, norm: str, form: VerbForm, known: bool) -> tuple[Possible, ...]:
    """Return the classes of a form of a known verb."""
    if form.form == "base":
        commands = ((NAMED_LIKE_THINGS, "command like a thing"), (PUT_VERBS, "put"), (FIND_VERBS, "find"))
        named = next((prior for verbs, prior in commands if norm in verbs), "other command")
        rare = ("rather a noun",) if norm in NOUNS_BEFORE_VERBS else ()
        rare = ("hardly a noun",) if norm in _NEVER_PLURALS else rare
        base = Possible("base", ("plain form of a known noun" if known else "plain form", named, *rare))
        passive = (Possible("participle", ("participle like its base",)),) if norm in _LIKE_BASE else ()
        return (base, *passive) if norm in _ONLY_VERBS else (Possible("noun"), base, *passive)
    if form.form == "s":
        plurals = ("rather a plural",) if form.lemma in _PLURALS_LIKE_VERBS else ()
        plurals = ("never a plural",) if form.lemma in _NEVER_PLURALS else plurals
        third = Possible("third", ("form in -s of a known noun" if known else "form in -s", *plurals))
        return (third,) if norm in _ONLY_VERBS else (Possible("noun"), third)
    if form.form == "ing":
        return Possible("noun"), Possible("ing", ("-ing of a known noun" if known else "-ing of a verb",))
    past_forms = [Possible("past", ("past of a verb",))]
    if norm in _PAST_OR_BASE:
        past_forms.append(Possible("base", ("put",)))
    if norm in _ONLY_VERBS:
        return tuple(past_forms)
    if norm not in _ONLY_PAST:
        past_forms.insert(0, Possible("participle", ("participle of a verb",)))
    acronym = words[at].text.isupper() and len(norm) > 1
    if known or acronym or norm in _PAST_OR_NOUN:
        prior = "acronym" if acronym else "past of a known noun" if known else "past like a noun"
        past_forms.insert(0, Possible("noun", (prior,)))
    return tuple(past_forms)


NOUN_OR_PREPOSITION = word_set("left right top bottom front back inside outside side opposite next near close")

NOUN_OR_MODAL = word_set("can will may need might")

ED_NOUNS = word_set("bed shed sled weed seed reed bread thread spread bunkbed daybed flatbed waterbed")

_NEVER_NOUNS = word_set(
    "and or but nor than not of to from with without at by for as if when while because that which who whom whose"
    " where there then so too wherever otherwise also is are was were be been being am do does did has have had"
    " having n't please let lets upside into onto upon toward towards against among amongst between beside"
    " beneath underneath behind until during such whether whenever via per through 's 're 'm 'll 've 'd it's"
    " although though since unless yet in over down containing comprising consisting"
)

_SUBORDINATE = word_set(
    "if when because while as since until although though unless whether so before after once where how why whenever"
    " wherever than"
)

_ALONE = word_set("what which other another several many few most some any")
"""Determiners that stand for a thing as well: *both stand there*, *the other holds pens*."""

_FIXED: dict[str, tuple[Possible, ...]] = {
    "": (Possible("cut"),),
    "'s": (Possible("be"), Possible("genitive")),
    "to": (Possible("preposition"), Possible("to")),
    "missing": (Possible("adjective"),),
    "till": (Possible("noun"), Possible("preposition")),
    **dict.fromkeys(("couple", "pair", "dozen"), (Possible("noun"), Possible("determiner"))),
    "only": (Possible("determiner"), Possible("adverb")),
    "that": (Possible("relative", ("that",)), Possible("determiner"), Possible("pronoun")),
    "her": (Possible("determiner"), Possible("pronoun")),
    "whose": (Possible("relative"), Possible("determiner")),
    **dict.fromkeys(("which", "who", "whom"), (Possible("relative"), Possible("pronoun"))),
    **dict.fromkeys((".", ";", ":", "!", "?", "-", "\u2013", "\u2014", "\u2026"), (Possible("cut"),)),
    **dict.fromkeys((",", "(", ")", "[", "]", "/"), (Possible("comma"),)),
    **dict.fromkeys(("and", "or", "nor", "but", "plus", "then", "yet"), (Possible("conjunction"),)),
    **dict.fromkeys(IS_FORMS - {"'s"}, (Possible("be"),)),
    **dict.fromkeys(NEGATIONS - {"nor"}, (Possible("adverb"),)),
    **dict.fromkeys((*(MODALS.keys() - NOUN_OR_MODAL), "do", "does", "did"), (Possible("modal"),)),
    **{norm: (Possible("modal", (f"modal {norm}",)), Possible("noun")) for norm in NOUN_OR_MODAL},
    "left": (Possible("adjective"), Possible("preposition"), Possible("participle", ("left over",))),
    **dict.fromkeys(("right", "next", "close", "near", "opposite"), (Possible("adjective"), Possible("preposition"))),
}
"""Classes of single function words and of punctuation."""

_ONLY_VERBS = word_set("has have had put be let stood lay sat went came began ran wore did took gave knew fell rose")
"""Forms of verbs that are never nouns nor participles."""

_ONLY_PAST = word_set("saw")
"""Forms of verbs that are nouns or past forms, and never participles."""

_LIKE_BASE = word_set("put set cut shut split hit spread let")
"""Verbs whose participle is their plain form."""

_PAST_OR_BASE = word_set("set cut run lay put read spread")

_PAST_OR_NOUN = word_set("set cut run saw lay put read spread")

_LY_NOUNS = word_set("family assembly jelly butterfly belly lily supply doily reply")

_NEVER_PLURALS = word_set("lie sit hang go lean belong remain stay come contain touch keep kneel")
"""Verbs whose forms are hardly ever nouns."""

_PLURALS_LIKE_VERBS = word_set(
    "sandwich stack pile ring clip clamp slip string top wipe label plug house screw bolt nail pin tape tip point press"
)
"""Verbs whose third person is more often the plural of a thing: *cups here, sandwiches there*."""
