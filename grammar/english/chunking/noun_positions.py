"""Find where noun phrases begin, and which words go on with them, by the classes of the words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

from deixis.grammar.english.tagging.word_classes import FINITE, NOMINAL, NOUN_OR_PREPOSITION, WordClass, closed_words
from deixis.grammar.english.tokens import Word
from deixis.grammar.english.tree import Degree, Span
from deixis.grammar.english.vocabulary.adjectives import adjectives, degree_of, is_adjective, is_material_noun
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    DETERMINERS,
    HEDGES,
    IS_FORMS,
    MODALS,
    NUMBERS,
    ORDINALS,
    POSSESSIVES,
    PRONOUNS,
    UNITS,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.nouns import PEOPLE
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, places_alone, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import FIND_VERBS, PUT_VERBS, verb_forms


@cache
def relating_words() -> frozenset[str]:
    """Return the single words that relate two things, and pronouns; before a noun a few of them are adjectives."""
    single = {phrase for phrase in (*prepositions(), *places_alone()) if " " not in phrase}
    return frozenset(single | PRONOUNS.keys() | DETERMINERS | MODALS.keys() | IS_FORMS)


class NounFinder:
    """Finder of nouns among the words of one sentence."""

    def __init__(self, words: list[Word], norms: list[str], nouns: KnownNouns, classes: Sequence[WordClass]) -> None:
        self.words, self.norms, self.classes, self._nouns = words, norms, classes, nouns
        self._closed, self._verbs, self._adjectives = closed_words(), verb_forms(), adjectives()
        self.relating_words = relating_words()

    def number(self, at: int) -> float | None:
        """Return the value of a number that is written in words or digits.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        float or None
            Value, or None for a word that is not a number.
        """
        norm = self.norms[at]
        if norm in NUMBERS:
            return float(NUMBERS[norm])
        if norm[:1].isdigit():
            try:
                value = float(norm)
            except ValueError:
                return None
            return value if math.isfinite(value) else None
        return None

    def ordinal(self, at: int) -> int | None:
        """Return the rank of an ordinal; -1 for *last*.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        int or None
            Rank, counted from 1; None for a word that is not an ordinal.
        """
        return ORDINALS.get(self.norms[at])

    def is_determiner(self, at: int) -> bool:
        """Return True for a word that can begin a noun phrase before its noun.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            True for a determiner or a possessive, such as *the*, *each* and *your*.
        """
        return self.norms[at] in DETERMINERS or self.norms[at] in POSSESSIVES

    def is_colour_alone(self, at: int) -> bool:
        """Return True for a colour without a noun: *the man in blue*.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            True if neither a noun nor another adjective follows the colour.
        """
        return (
            self._adjectives.get(self.norms[at]) == "colour"
            and not self._nounish(at + 1)
            and not is_adjective(self.norms[at + 1])
        )

    def is_degree_word(self, at: int) -> bool:
        """Return True for *closest*, *furthest*, *closer* and similar words.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            True for a comparative or superlative of *near* or *far* and their synonyms.
        """
        lemma, degree = degree_of(self.norms[at])
        return degree is not Degree.PLAIN and lemma in ("near", "far")

    def is_genitive(self, at: int) -> bool:
        """Return True if the ``'s`` at this place makes an owner, and does not stand for *is*.

        Parameters
        ----------
        at
            Index of the ``'s`` in the sentence.

        Returns
        -------
        bool
            True in *the cup's handle*, False in *the cup's on the tray*; False for any other word.
        """
        if self.norms[at] != "'s":
            return False
        name = at > 0 and self.words[at - 1].text == "I"  # the pronoun has 'I'm'
        if (
            at == 0
            or (not name and self.norms[at - 1] in PRONOUNS and self.norms[at - 1] not in _OWNERS)
            or (self.norms[at - 1] in ("there", "here", "where", "what", "who", "how"))
        ):
            return False
        after = self.norms[at + 1]
        if after in ("far", "near", "opposite", "inside", "outside") and self.adjective_before_noun(at + 1):
            return self.norms[at + 2] in PLACE_NOUNS  # 'along the tray's far edge'
        if after in self._closed or after in ("", ",", "."):
            return False
        if after in ("right", "left") and self.norms[at + 2] in _AFTER_SIDE:
            return self.norms[at - 1] in PEOPLE and self.norms[at - 3 : at - 1] in (["to", "the"], ["on", "the"])
        if after in ("right", "left") and self.norms[at + 2] in PLACE_NOUNS:
            return True
        form = self._verbs.get(after)
        if form is not None and form.form in ("ing", "past", "participle") and not self.is_noun(at + 1):
            return False
        if form is not None and form.form == "ing" and form.kind in ("posture", "lean", "face", "point"):
            return self._nounish(at + 2) and self.is_noun(at + 1)
        if after in PLACE_NOUNS or self.number(at + 1) is not None or after == "o'clock":
            return True
        if is_adjective(after):
            return self._nounish(at + 2) or is_adjective(self.norms[at + 2])
        return True

    def starts(self, at: int) -> bool:
        """Return True if a noun phrase can begin here.

        Parameters
        ----------
        at
            Index of the word in the sentence; it may lie after the last one.

        Returns
        -------
        bool
            True for a possible beginning; the phrase need not be complete.
        """
        norm = self.norms[at]
        if not norm or at >= len(self.words):
            return False
        if norm in PRONOUNS or norm in DETERMINERS or norm in POSSESSIVES:
            if norm == "that" and self.norms[at + 1] in (*IS_FORMS, ",", ".", "and", "you", "we", "i", "there"):
                return True
            return (
                norm not in ("that", "which", "who")
                or self._nounish(at + 1)
                or (norm == "that" and at + 1 == len(self.words))
            )
        if norm in NUMBERS or norm in ORDINALS or norm[0].isdigit():
            return True
        described = norm.endswith("ly") and (is_adjective(self.norms[at + 1]) or self.norms[at + 1].endswith("ed"))
        led = at > 0 and (self.norms[at - 1] in prepositions() or self.follows_command(at))
        if led and described and norm not in HEDGES:
            return self._continues(at + 2)  # 'in loosely tied plastic bags', 'on easily accessible shelves'
        if norm in self._closed:
            if norm in ("about", "around"):
                return self.number(at + 1) is not None
            if (
                norm in ("very", "slightly", "more", "most", "far")
                or norm in HEDGES
                or norm in ("exactly", "only", "just")
            ):
                return self.starts(at + 1)
            return norm in ("opposite", "near", "far") and self.adjective_before_noun(at)
        if norm in ("left", "right") and self.norms[at + 1] in (
            "of",
            "to",
            "in",
            "next",
            "behind",
            "above",
            "below",
            "under",
            "on",
        ):
            return norm == "left" and self.norms[at + 1] == "on"
        if norm in PLACE_NOUNS or is_adjective(norm) or self.is_noun(at) or self.is_participle_of_one(at):
            return True
        after_preposition = at > 0 and (self.norms[at - 1] == "of" or self.norms[at - 1] in prepositions())
        shaped = norm.endswith("ed") and len(norm) > 4 and self._nouns.knows(self.norms[at + 1])
        ordered = shaped and self.follows_command(at)
        return (after_preposition or ordered) and shaped and self.is_noun(at + 1)  # 'with crumpled paper'

    def follows_command(self, at: int) -> bool:
        """Return True after the verb of a command where a clause begins: *put crumpled* in *put crumpled paper*.

        Parameters
        ----------
        at
            Index of the word after the verb.

        Returns
        -------
        bool
            True if the word before can only be the verb of a command there.
        """
        begins = at == 1 or (at > 1 and self.norms[at - 2] in ("and", "then", ",", ";", ":"))
        return begins and self.norms[at - 1] in PUT_VERBS | FIND_VERBS

    def is_participle_of_one(self, at: int) -> bool:
        """Return True for an unknown participle before *one* or *ones*: *unfired ones*.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            False for a participle before any other word.
        """
        unknown = self.norms[at].endswith("ed") and not is_adjective(self.norms[at])  # 'red' is known
        return unknown and self.norms[at + 1] in ("one", "ones")

    def adjective_before_noun(self, at: int) -> bool:
        """Return True if the word is an adjective with a noun after it: *near edge*, *left lamp*.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            True also before *one* and *ones*, and with further adjectives in between.
        """
        if not is_adjective(self.norms[at]) and self.norms[at] not in DIRECTION_WORDS:
            return False
        i = at + 1
        while is_adjective(self.norms[i]) and self._nounish(i + 1):
            i += 1
        return self._nounish(i) or self.norms[i] in ("one", "ones")

    def _nounish(self, at: int) -> bool:
        norm = self.norms[at]
        if not norm or norm in self._closed or at >= len(self.words):
            return norm in ("one", "ones")
        if not norm[0].isalpha():
            return False
        if norm in PLACE_NOUNS:
            return True
        if norm in self._verbs:
            return self.is_noun(at)
        return not norm.endswith("ly") or self._nouns.knows(norm)

    def is_noun(self, at: int) -> bool:
        """Return True if the word is a noun in the best reading of the sentence, or an adjective before one.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            False for a function word, a verb and a participle.
        """
        norm = self.norms[at]
        if not norm or at >= len(self.words) or norm in self._closed or not norm[0].isalpha():
            return False
        return norm not in ("next", "near", "close", "opposite") and self.classes[at] in NOMINAL

    def is_verb(self, at: int) -> bool:
        """Return True if the word is a finite verb, a command or an infinitive in the best reading of the sentence.

        Parameters
        ----------
        at
            Index of the word in the sentence; it may lie after the last one.

        Returns
        -------
        bool
            False for a participle.
        """
        return at < len(self.words) and self.classes[at] in FINITE

    def _is_done(self, at: int) -> bool:
        """Return True for a participle between a determiner and a noun: *provided* of *the provided screws*."""
        form = self._verbs.get(self.norms[at])
        determined = at > 0 and (self.norms[at - 1] in DETERMINERS or self.norms[at - 1] in POSSESSIVES)
        return determined and form is not None and form.form in ("past", "participle") and form.lemma != "leave"

    def turns(self, at: int) -> bool:
        """Return True for *face* before a thing and a direction: *face the blades toward the plate*.

        Parameters
        ----------
        at
            Index of the verb, where a command can begin.

        Returns
        -------
        bool
            False where no direction follows in the clause.
        """
        rest = self.norms[at + 1 : at + 8]
        ends = next((i for i, norm in enumerate(rest) if norm in _CLAUSE_ENDS), len(rest))
        return self.starts(at + 1) and not _TOWARD.isdisjoint(rest[1:ends])

    def _continues(self, at: int) -> bool:
        return self._nounish(at) or is_adjective(self.norms[at]) or self.norms[at] in ("more", "other")

    def is_letter(self, at: int) -> bool:
        """Return True for a name of one capital letter.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            True in *put box A on B* for both letters; False for the pronoun *I* and the article *A*.
        """
        return self._letter(at) is not None

    def _letter(self, at: int) -> str | None:
        """Return a name of one capital letter: *D is left of A*; *I* and *A* only where they are names."""
        if at >= len(self.words):
            return None
        text = self.words[at].text
        if len(text) != 1 or not text.isupper():
            return None
        before = self.norms[at - 1] if at else ""
        after = self.norms[at + 1]
        noun = at > 0 and self.words[at - 1].text.islower() and self._nouns.knows(before)
        follows = after[:1].isalpha() and self._nouns.knows(after) and after not in NOUN_OR_PREPOSITION
        inside = noun and not follows  # 'panel A using screws'
        if text == "A" and not inside:
            form = self._verbs.get(after)
            named = (
                not after[:1].isalpha() or after in self._closed or after in prepositions() or after in ("and", "or")
            )
            if not named and not (form is not None and form.form == "s"):
                return None
            later = self.norms[at + 2]
            if (after in ADVERBS or after.endswith("ly")) and (is_adjective(later) or later.endswith(("ed", "en"))):
                return None  # 'A simply folded napkin'
            if is_adjective(after) and after not in ("left", "right"):
                return None
        if text == "I":
            third = after in ("is", "and", "to", "are", "'s") or (
                after in self._verbs and self._verbs[after].form in ("s", "ing")
            )
            if not third and not (
                before in ("labeled", "labelled", "named", "called")
                or before in prepositions()
                or before == "of"
                or before == "and"
                or before in GENERIC_NOUNS
            ):
                return None
        return text

    def is_known_noun(self, noun: str) -> bool:
        """Return True for a noun of the ontology.

        Parameters
        ----------
        noun
            Noun or compound, in the singular or the plural.

        Returns
        -------
        bool
            True if the ontology or its lexicon has the noun.
        """
        return self._nouns.knows(noun)

    def is_name(self, at: int) -> bool:
        """Return True for a word with one capital letter, the first: a name where it does not begin the sentence.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            False for one letter, and for capitals throughout, as in *USB*.
        """
        text = self.words[at].text
        return len(text) > 1 and text[0].isupper() and text[1:].islower()

    def _noun_here(self, at: int, nouns: list[str]) -> bool:
        """Return True if a noun phrase goes on with a word as its noun, after the nouns that it has so far."""
        norm = self.norms[at]
        if norm[0].isdigit():
            return bool(nouns) and self.classes[at] == "noun" and self.norms[at + 1] not in UNITS
        if not nouns:
            return self.is_noun(at)
        named = self.is_name(at) and self._nouns.knows(nouns[-1]) and self.words[at - 1].text[:1].islower()
        if named or norm in ORDINALS or norm in ("left", "right"):
            return False  # 'behind the aquarium Mr Bell put …'
        if self.number(at) is not None:
            return not self._begins_subject(at)  # 'locker three', but 'at the end of the hall two benches stand'
        if norm == "well" and self.norms[at + 1] in prepositions().keys() | _AWAY:
            return False  # 'keep the candle well away from it'
        if is_adjective(norm) and not is_material_noun(norm) and norm not in _ADJECTIVE_NOUNS:
            return False
        return self.is_noun(at)

    def _begins_subject(self, at: int) -> bool:
        """Return True for a number before a plural noun and its verb, in a clause that begins with a place."""
        if (self.number(at) or 0) <= 1:
            return False
        first = at
        while first > 0 and self.norms[first - 1] not in _CLAUSE_ENDS | {"and", "but"}:
            first -= 1
        noun = at + 1
        while is_adjective(self.norms[noun]) and not self._nouns.knows(self.norms[noun]):
            noun += 1
        form = self._verbs.get(self.norms[noun + 1])
        stands = self.norms[noun + 1] in IS_FORMS or (form is not None and form.form in ("base", "past"))
        return self.norms[first] in prepositions() and self._nouns.singular(self.norms[noun])[1] and stands

    def _span(self, at: int, end: int) -> Span:
        return self.words[at].start, self.words[end - 1].end


_ANYBODY = frozenset(f"{quantity}{person}" for quantity in ("every", "some", "any", "no") for person in ("one", "body"))

_OWNERS = _ANYBODY | {"one", "other", "another", "else"}
"""Pronouns that own by *'s*: *within everyone's reach*."""

GENERIC_NOUNS = frozenset({"object", "objects", "agent", "agents", "thing", "item", "dot"})

_CLAUSE_ENDS = frozenset({",", ";", ":", ".", "!", "?", ""})

_TOWARD = frozenset({"toward", "towards", "away", "inward", "inwards", "outward", "outwards"})
"""Words of the direction of what is turned."""

_AWAY = frozenset({"away", "back", "clear", "apart", "out"})

_AFTER_SIDE = frozenset({"of", "next", "in", "on", "behind", "beside", "by", "at"})
"""Words after *left* and *right* before which ``'s`` stands for *is*: *the phone's left of the lamp*."""

_ADJECTIVE_NOUNS = word_set("light glass square orange cream double metal wood plastic gold silver round inside main")
