"""Find where noun phrases begin, and which words are nouns; an unknown word is a noun by its position."""

from __future__ import annotations

import math
from functools import cache

from deixis.grammar.english.tokens import Word
from deixis.grammar.english.tree import Degree, Span
from deixis.grammar.english.vocabulary.adjectives import adjectives, degree_of, is_adjective, is_material_noun
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    ARTICLES,
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
from deixis.grammar.english.vocabulary.nouns import PARTS, PEOPLE
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, places_alone, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import (
    FIND_VERBS,
    LINKING_VERBS,
    NAMED_LIKE_THINGS,
    PUT_VERBS,
    REPORTS,
    SAYING,
    verb_forms,
)

_BETWEEN_MODAL_AND_VERB = frozenset({"either", "only", "simply", "then", "always", "now", "easily"})
"""Adverbs after *can* that show it to be a modal."""


@cache
def _closed() -> frozenset[str]:
    """Return the words that are never nouns."""
    single = {phrase for phrase in (*prepositions(), *places_alone()) if " " not in phrase}
    return frozenset(
        (_NEVER_NOUNS | CHAT_WORDS | single | IS_FORMS | NEGATIONS | ADVERBS | HEDGES | MODALS.keys() | DETERMINERS
         | PRONOUNS.keys() | POSSESSIVES.keys())
        - NOUN_OR_PREPOSITION - {"can", "will", "may", "need", "back", "flat", "well", "down", "over", "in"}
        - {"till"} | {"in", "over", "down"}
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
        word in _closed()
        or word in NUMBERS
        or word in ORDINALS
        or word in PLACE_NOUNS
        or word in verb_forms()
        or is_adjective(word)
    )


@cache
def relating_words() -> frozenset[str]:
    """Return the single words that relate two things, and pronouns; before a noun a few of them are adjectives."""
    single = {phrase for phrase in (*prepositions(), *places_alone()) if " " not in phrase}
    return frozenset(single | PRONOUNS.keys() | DETERMINERS | MODALS.keys() | IS_FORMS)


class NounFinder:
    """Finder of nouns among the words of one sentence."""

    def __init__(self, words: list[Word], norms: list[str], nouns: KnownNouns) -> None:
        self.words, self.norms, self._nouns = words, norms, nouns
        self._closed, self._verbs, self._adjectives = _closed(), verb_forms(), adjectives()
        self.relating_words = relating_words()
        self.is_object = False  # True while a phrase after *put* or *hold* is read
        self.verbs: frozenset[int] = frozenset()  # words that are tried as verbs

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
            return self._nounish(at + 2) and not self._predicate_follows(at + 1)
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
        if at in self.verbs:
            return False
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
        """Return True if the word, which may also be a verb, is a noun here, judged by the words beside it.

        Parameters
        ----------
        at
            Index of the word in the sentence.

        Returns
        -------
        bool
            False also for a function word.
        """
        norm = self.norms[at]
        if not norm or at in self.verbs or norm in self._closed or not (norm[0].isalpha()):
            return False
        if at == 0 and self.norms[1] in IS_FORMS and norm.isalpha() and norm not in ADVERBS and norm not in HEDGES:
            return True  # a name: Holly is …
        if norm.endswith("ly") and "-" not in norm and norm not in _LY_NOUNS and not self._nouns.knows(norm):
            return False
        if norm in ("next", "near", "close", "opposite"):
            return False
        if norm == "face" and self.norms[at + 1] in ("up", "down") and at and not self.is_determiner(at - 1):
            return False  # 'lay the top face down'
        back = at - 1
        while back > 0 and (
            self.norms[back] in HEDGES or self.norms[back] in ("just", "also", "only", "now", "still", "always")
        ):
            back -= 1
        before = self.norms[back] if at else ""
        after = self.norms[at + 1]
        form = self._verbs.get(norm)
        stands = form is not None and form.form in ("s", "base") and form.kind in ("posture", "lean")
        if back < at - 1 and before in ("which", "who", "that") and stands and self._predicate_follows(at):
            return False  # 'which now lies on it'
        if before == "please" and (form is None or form.form == "base") and norm.isalpha():
            return False
        if at == 1 and before in ("always", "never") and norm in PUT_VERBS and after not in prepositions():
            return False  # 'always store daily items in the front'
        after_determiner = (
            before in DETERMINERS
            or (at and self.number(at - 1) is not None)
            or before in POSSESSIVES
            or (before in ORDINALS and (form is None or form.form == "base"))
            or (before == "'s" and self.norms[back - 1] not in PRONOUNS)
            or (is_adjective(before) and (form is None or form.form != "s" or before not in _PREDICATIVE))
            or self._is_done(back)
        )
        if norm == "can" or norm in ("will", "may", "need", "might"):
            if norm == "can" and after in _BETWEEN_MODAL_AND_VERB:  # 'the napkins can either be placed there'
                at += 1
                after = self.norms[at + 1]
            if norm == "can" and before[:1].isalpha() and before not in self._closed and not is_adjective(before):
                follows = self._verbs.get(after)
                goes = follows is not None and follows.form == "base"
                if before in PEOPLE and self.norms[at + 2] in prepositions():
                    return False  # 'your baby can nap in it'
                if goes and (self._nouns.singular(before)[1] or self._predicate_follows(at + 1)):
                    return False  # 'the candles can stay', 'the lid can stand on it'
            return norm == "can" and not (after in ("be", "not", "see", "have", "you", "also") or before in PRONOUNS)
        if form is None:
            if norm.endswith("ing") and len(norm) > 5 and not after_determiner:
                return (
                    self._compound_ing(at, before, after)
                    or after in IS_FORMS
                    or (self._nounish(at + 1) and after not in PLACE_NOUNS)
                    or (before in ("with", "of") and not self.starts(at + 1))
                )
            if norm.endswith("ed") and len(norm) > 4 and not is_adjective(norm) and norm not in ED_NOUNS:
                return after_determiner and self._nounish(at + 1) is False and not self._takes_preposition(after)
            return True
        named = norm in NAMED_LIKE_THINGS and form.form == "base"
        named = named or (form.lemma in NAMED_LIKE_THINGS and form.form == "s" and after in ("or", "and", ","))
        if named and before.isalpha() and before not in PUT_VERBS and self._nouns.knows(f"{before} {norm}"):
            return True  # 'a fork and a dessert spoon above the plate'
        if form.form == "ing":
            if before == "by" and form.lemma in PUT_VERBS and (self.starts(at + 1) or self._nounish(at + 1)):
                return False  # 'by inserting planking into the slot'
            if norm == "setting" and before in ("place", "table") and not self.is_determiner(at + 1):
                return True
            if (
                before in ("other", "others", "one")
                and form.kind in ("posture", "lean")
                and self._predicate_follows(at)
            ):
                return False  # 'the other standing on a coaster'
            if at + 1 < len(self.words) and self.words[at + 1].text[:1].isupper() and self.norms[at + 2] == "'s":
                return False  # 'putting Anna's radio on it'
            if form.kind in ("transitive", "face", "point") and not after_determiner:
                return False
            if before == "'s" and form.kind in ("posture", "lean") and not self._nounish(at + 1):
                return False
            if before in ("with", "of") and not self.starts(at + 1):
                return True
            if before in IS_FORMS and not after_determiner:
                return False
            if (
                form.kind == "posture"
                and form.lemma not in ("stand", "sit", "lie", "hang")
                and not self.starts(at + 2)
                and (self._nounish(at + 1) and after not in PLACE_NOUNS and self._nouns.singular(after)[0] == after)
            ):
                return True
            return self._compound_ing(at, before, after) or (after_determiner and not self._nounish(at + 1))
        written = self.words[at].text
        acronym = (
            len(written) > 1 and written.rstrip("s").isupper() and not all(w.text.isupper() for w in self.words[:at])
        )
        if acronym and form.form in ("past", "participle") and (is_adjective(before) or before in DETERMINERS):
            return True  # 'a red LED'
        if norm == "saw" and after in (",", ".", "and", ";", "") and before in ("", ",", ":", "and", "or"):
            return True  # 'from left to right: saw, hammer, pliers'
        if (
            norm == "saw"
            and after in IS_FORMS | _CLAUSE_ENDS
            and before.isalpha()
            and before not in self._closed | PEOPLE
        ):
            return True  # 'next to the band saw is …'
        if form.form in ("past", "participle") and not (
            norm in ("set", "cut", "run", "left", "saw") and after_determiner and not self._nounish(at + 1)
        ):
            return False
        if (
            at > 1
            and self.number(at - 1) is not None
            and self.norms[at - 2] in ("other", "these", "those", "last")
            and form.form == "base"
            and form.kind in ("posture", "lean")
            and self._predicate_follows(at)
        ):  # 'the other two stand on the tray'
            return False
        counted = at > 1 and (self.number(at - 2) or 0) > 1 and before.endswith(_LATIN_PLURALS)
        if counted and form.form == "base" and after in prepositions():
            return False  # 'three fibulae follow in a row'
        if before == "there" and at == 1 and form.form in ("base", "s") and form.kind == "posture":
            return False  # 'there stands a clock'
        spatial = form.kind in ("posture", "lean") and self._predicate_follows(at)
        if spatial and form.form == "base" and before in ("both", "all"):
            return False  # 'both stand on the floor'
        if spatial and form.form == "s" and before == "other" and self.norms[at - 2] == "the":
            return False  # 'the other lies under the bench'
        commanded = at < 2 or self.norms[at - 2] in ("and", ",", "then", "never", "not", "please", "always", ";", ":")
        putting = self._verbs.get(before)
        commanded = commanded or (at > 1 and self.norms[at - 2] == "by" and before not in PUT_VERBS)
        puts = before in PUT_VERBS or (putting is not None and putting.form == "ing" and putting.lemma in PUT_VERBS)
        if form.form == "s" and puts and commanded and self._nouns.singular(norm)[1]:
            return True  # 'keep drinks away from it'
        if form.form == "s" and form.kind == "transitive" and after in _CLAUSE_ENDS and self._nouns.singular(norm)[1]:
            return True  # 'the holes in the corner blocks.'
        together = at > 2 and self.norms[at - 2] == "and" and form.form == "base" and form.kind in ("posture", "lean")
        stands = form.form == "s" and form.kind in ("posture", "lean") and self.is_determiner(at + 1)
        if stands and (before in PLACE_NOUNS or (is_adjective(before) and self._nouns.knows(before))):
            return False  # 'in the middle stands the crucifix'
        one = at > 1 and self.norms[at - 2] in _SINGULAR and is_adjective(before) and self._nouns.knows(before)
        if one and form.form == "s" and form.kind != "posture" and self.is_determiner(at + 1):
            return False  # 'this light creates a glow'
        holds = form.form == "s" and form.kind == "transitive" and before in PLACE_NOUNS and self._nounish(at + 1)
        if holds and not is_adjective(self.norms[at - 2]) and self.is_determiner(at - 2):
            return False  # 'the one in the middle holds buttons'
        if together and self._predicate_follows(at) and not self.is_determiner(at - 1):
            return False  # 'Ann and Tom kneel beside it'
        tools = form.form == "s" and form.lemma in _PLURALS_LIKE_VERBS and "with" in self.norms[max(0, at - 3) : at]
        if tools and not any(self.is_determiner(k) for k in range(max(0, at - 3), at)):
            return True  # 'fix it with long wood screws in the holes'
        accompanied = at > 2 and self.norms[at - 3] == "with" and self.is_determiner(at - 2)
        if accompanied and form.form == "s" and self._nouns.singular(norm)[1]:
            return not (spatial and self._awaits_verb(at - 3))  # 'with the cotton rolls behind it'
        first = next((k for k in range(at - 2, max(0, at - 5), -1) if self.is_determiner(k)), 0)
        if (
            first > 1 and not self.is_determiner(at - 1) and form.form == "base"
            and self.norms[first - 1] == "and" and "and" not in self.norms[first:at]
            and form.kind in ("posture", "lean") and self._predicate_follows(at)
            and not self._nouns.knows(f"{before} {norm}") and not self._nouns.singular(before)[1]
        ):  # fmt: skip
            return False  # 'the cup and the jug stand on the tray'
        if self._reports(at) or (
            form.form == "base" and norm in _STAYING and self.number(at - 1) is not None and at > 1
        ):
            return False
        if norm == "leave" and (self.number(at + 1) is not None or after in ("at", "about", "enough", "some")):
            return False
        if at and self.number(at - 1) is not None and not (self.norms[at - 1] == "one" and form.form == "s"):
            return True
        if norm == "set" and before in IS_FORMS:
            return False
        if form.lemma in ("go", "belong", "remain") and form.form == "base" and not after_determiner:
            return False
        if form.lemma in ("lie", "sit", "hang") and form.form in ("base", "s") and not after_determiner:
            return False
        if form.form == "s" and form.lemma in _NEVER_PLURALS and before not in DETERMINERS:
            return False
        if form.form == "s" and before == "," and self.is_determiner(at + 1):
            return False
        second = form.form == "s" and before == "and" and form.kind in ("other", "transitive", "face")
        second = second and not self._nouns.knows(norm) and not self._lists_plurals(back - 1)
        if second and (self.number(at + 1) is not None or self.is_determiner(at + 1)):
            return False  # 'sets a boat on it and takes three crates'
        handled = self._verbs.get(before)
        holds = handled is not None and handled.kind == "transitive" and handled.form == "base"
        if form.form == "s" and holds and not after_determiner and self._nouns.singular(norm)[1]:
            return not self.is_determiner(at + 1) and not self._predicate_follows(at)  # 'they hold nails and screws'
        if (
            form.form == "s"
            and before in (",", "and")
            and form.lemma in _PLURALS_LIKE_VERBS
            and (self._nouns.knows(norm) or self._nouns.singular(norm)[0] in PARTS)
        ):
            return True
        if (
            form.form == "s"
            and form.kind in ("posture", "lean")
            and self._predicate_follows(at)
            and is_adjective(before)
        ):
            if back == 1 and self.norms[0] in PUT_VERBS | FIND_VERBS:
                return True  # 'use top shelves for glasses'
            if self._nouns.knows(before):  # 'the glass stands above …'
                return False
            two_before = self.norms[back - 1] if back else ""
            return two_before in DETERMINERS or two_before in POSSESSIVES or is_adjective(two_before)
        if (after in IS_FORMS and after != "'s") or (after in MODALS and after != "can"):
            return True
        if after_determiner:
            return True
        after_noun = bool(before) and before not in self._closed and before[0].isalpha() and not is_adjective(before)
        if after_noun:
            plural = self._nouns.singular(before)[1]
            places = after in prepositions() or after in places_alone()
            if form.form == "s" and form.lemma in LINKING_VERBS and is_adjective(after):
                return False  # 'a plant on the windowsill looks nice'
            if form.form == "s" and is_adjective(after) and form.kind in ("posture", "lean") and not places:
                return (
                    self.norms[at + 2] != "of"
                    and self.norms[at + 2] not in PLACE_NOUNS
                    and self.norms[at + 2] not in prepositions().keys() | places_alone().keys()
                )  # 'the missal rests open on its stand'
            if form.form == "s" and after in self._verbs and self._verbs[after].form == "base":
                beyond = self.norms[at + 2]
                return beyond in prepositions() or beyond in places_alone()  # 'the glue sticks go into the box'
            if form.form == "s" and after.endswith(("ing", "ed")) and self.norms[at + 2] in prepositions():
                return True  # 'foam blocks soaking in the sink'
            if form.form == "s":
                return after in self._verbs and self._verbs[after].form == "s" and after != "'s"
            owns = after in POSSESSIVES and after != "whose"
            return not plural and not (after in DETERMINERS or after in NUMBERS or owns)
        if form.form == "base" and before in ADVERBS and self.is_determiner(at + 1) and not is_adjective(before):
            return False  # 'the child really put the fork on it'
        if before == "never" and form.form == "base" and self._predicate_follows(at):
            return False  # 'bottles never stand on the towel'
        if at == 0 or before in ("never", "always", "not", ",", "and", "then", ".", ";", ":", "please"):
            if form.form == "s" and before in ("never", "always") and self.is_determiner(at + 1):
                return False
            if form.form == "s":
                return not self._predicate_follows(at) or at == 0 or before in (".", ";", ":")
            if norm in NAMED_LIKE_THINGS:
                return not self.commands(at) or after == "of"
            if norm == "face" and self.turns(at):
                return False
            imperative = norm in PUT_VERBS or norm in FIND_VERBS
            return (
                not self.starts(at + 1)
                or after == "of"
                or (not imperative and not self.is_determiner(at + 1) and (after not in PRONOUNS))
            )
        return before in self._closed and before not in PRONOUNS and before not in ("to", "not", "which", "that", "who")

    def commands(self, at: int) -> bool:
        """Return True if the words after a verb that is a noun too make it a command: *screw the*, *heap sand on*.

        Parameters
        ----------
        at
            Index of the verb, where a command can begin.

        Returns
        -------
        bool
            False for *screw holes are on the left* and *top shelf: plates*.
        """
        after = at + 1
        if (
            self.is_determiner(after)
            or self.number(after) is not None
            or self.norms[after] in ("it", "them", "both", "all")
        ):
            return self.norms[after] not in ("that", "which")
        if self.norms[after : after + 2] in (["at", "least"], ["at", "most"]):
            return self.number(after + 2) is not None
        if not self.starts(after):
            return self.norms[after] in ("out", "up", "down", "away", "off") or self.norms[at : at + 2] == [
                "turn",
                "on",
            ]
        if is_adjective(self.norms[at]) or self._nouns.knows(f"{self.norms[at]} {self.norms[after]}"):
            return False  # 'top box', 'lower shelf', 'tape measure'
        adverbs = all(norm in ADVERBS or norm in (",", "next", "first", "then") for norm in self.norms[:at])
        placed = at > 1 and self.norms[0] in prepositions() and self.norms.index(",") == at - 1
        if at and self.norms[at - 1] in ("and", ",") and PUT_VERBS.isdisjoint(self.norms[:at]) and not adverbs | placed:
            return False  # but 'also, pack heavy items at the bottom', 'on the shelf, stack plates and bowls in piles'
        rest = self.norms[after : after + 12]
        relative = next((i for i, norm in enumerate(rest) if i and norm in _SUBORDINATE), len(rest))
        rest = rest[:relative]
        ends = next((i for i, norm in enumerate(rest) if norm in _CLAUSE_ENDS), len(rest))
        if rest[ends : ends + 1] == [","] and "and" in rest[ends:]:
            ends = next((i for i, norm in enumerate(rest) if norm in _CLAUSE_ENDS and norm != ","), len(rest))
        rest, mark = rest[:ends], rest[ends : ends + 1]  # 'store milk, eggs and butter in the door'
        states = any(norm in IS_FORMS or norm in MODALS or self._stands(after + i) for i, norm in enumerate(rest))
        named = placed or any(norm in prepositions() for norm in rest[1:])
        return mark != [":"] and not states and named

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

    def _stands(self, at: int) -> bool:
        """Return True for the verb of a statement: *cards stand behind …*."""
        form = self._verbs.get(self.norms[at])
        spatial = form is not None and form.form in ("s", "base") and form.kind in ("posture", "lean", "face")
        return spatial and self._predicate_follows(at) and not self.is_noun(at)

    def _reports(self, at: int) -> bool:
        """Return True for *states* and *claims* before what they report: *the owner states that the cup is …*."""
        following = self.norms[at + 2]
        return (self.norms[at] in SAYING and self.norms[at + 1] in ("it", "they", "he", "she", "there")) or (
            self.norms[at] in REPORTS
            and self.norms[at + 1] == "that"
            and (self.is_determiner(at + 2) or following in PRONOUNS | prepositions().keys() | {"there"})
        )

    def _predicate_follows(self, at: int) -> bool:
        """Return True if a place follows, as after a verb: *lies on*, *stands upright*."""
        after = self.norms[at + 1]
        return (
            after in prepositions()
            or after in places_alone()
            or (after, self.norms[at + 2]) in (("side", "by"), ("face", "down"), ("upside", "down"))
            or after in ADVERBS
            or after in ("in", "next", "left", "right")
        )

    def _compound_ing(self, at: int, before: str, after: str) -> bool:
        """Return True for the first part of a compound: *rolling pin*, *washing machine*."""
        if self._nouns.knows(f"{self.norms[at]} {after}"):
            return True
        described = is_adjective(after) and not (is_material_noun(after) and not self._nounish(at + 2))
        if not self._nounish(at + 1) or described or after in DIRECTION_WORDS:
            return False
        return (
            at == 0 or before in self._closed or not before[0].isalpha() or is_adjective(before) or before in ORDINALS
            or before in NUMBERS or self.follows_command(at)
        )  # fmt: skip

    def _takes_preposition(self, after: str) -> bool:
        return after in prepositions()

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
        if text == "A":
            form = self._verbs.get(after)
            named = (
                not after[:1].isalpha() or after in self._closed or after in prepositions() or after in ("and", "or")
            )
            if not named and not (form is not None and form.form == "s"):
                return None
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

    def ends_as_verb(self, at: int) -> bool:
        """Return True for an unknown verb right after a noun phrase.

        Parameters
        ----------
        at
            Index of the word after the noun phrase.

        Returns
        -------
        bool
            True if the last word of the phrase, or the last two, make the word after it a verb.
        """
        nouns = [self.norms[at - 1]]
        return self._is_unknown_verb(at, nouns) or (at > 1 and self._is_unknown_verb(at, [self.norms[at - 2], *nouns]))

    def _is_unknown_verb(self, at: int, nouns: list[str]) -> bool:
        """Return True for an unknown word that looks like a verb after a known noun: *the lamp blorps at the desk*."""
        norm, after = self.norms[at], self.norms[at + 1]
        if not nouns or is_known(norm) or self._nouns.knows(norm):
            return False
        if not norm.endswith(("ing", "ed")) and self._ends_counted(at, nouns):
            return after in prepositions() or after in ARTICLES
        if not norm.endswith("s") or norm.endswith("ss"):
            return False
        aim = self._verbs.get(self.norms[at + 2])
        aims = after == "to" and ((aim is not None and aim.form == "base") or self.norms[at + 2] == "be")
        if aims and not self._nouns.singular(nouns[-1])[1]:
            return True  # 'milk tends to stand on it'
        if (
            not (after in prepositions() or after in ARTICLES or after in ("you", "me", "us", "them"))
            or self._nouns.singular(nouns[-1])[1]
        ):
            return False
        start = at - len(nouns)
        determined = any(
            self.norms[k] in ("a", "an", "the", "this", "each", "every") for k in range(max(0, start - 3), start)
        )
        if any(self.number(k) is not None for k in range(max(0, start - 3), start)):
            return False
        ends = (k for k in range(at, len(self.norms)) if self.norms[k] in (",", ".", ";", "and", "but", ""))
        verbs_later = any(norm in IS_FORMS for norm in self.norms[at : next(ends)])
        takes_object = after in ARTICLES and not norm.endswith("ings")
        return determined and (takes_object or self._nouns.knows(" ".join(nouns))) and not verbs_later

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
        norm = self.norms[at]
        if norm == "put":
            return False
        if self._reports(at) or self._is_unknown_verb(at, nouns) or (norm == "pick" and self.norms[at + 1] == "up"):
            return False
        form = self._verbs.get(norm)
        if nouns and self.is_object and form is not None and form.form == "s" and self._nouns.singular(norm)[1]:
            return True  # 'keep the cam screws in the bag'
        if nouns and form is not None and form.form == "s" and self._counted(at - len(nouns)):
            return not self._nouns.singular(nouns[-1])[1]  # 'on two foam blocks'
        several = form is not None and form.form == "s" and self._nouns.singular(norm)[1]
        if several and not nouns and at > 1 and is_adjective(self.norms[at - 1]) and self._counted(at):
            return True  # 'on two tall stands'
        named = self.words[at].text[:1].isupper() and self.norms[at + 1] == "'s"
        alone = at == 1 and not self._nouns.knows(self.norms[0])
        if nouns and named and (alone or self.words[at - 1].text[:1].islower()):
            return False  # 'I hope Anna's radio is …'
        if nouns and self._begins_subject(at):
            return False  # 'at the end of the hall two benches stand'
        if nouns and (norm in ORDINALS or (norm == "cause" and self.norms[at + 1] in PRONOUNS)):
            return False
        if norm[0].isdigit():
            return (
                bool(nouns) and norm.isdigit() and self.norms[at + 1] not in ("cm", "mm", "m", "inches", "inch", "feet")
            )
        if not norm[0].isalpha():
            return False
        if nouns and norm in ("left", "right"):
            return False
        if nouns and self.is_name(at) and self._nouns.knows(nouns[-1]) and self.words[at - 1].text[:1].islower():
            return False  # 'behind the aquarium Mr Bell put …'
        if nouns and norm == "well" and self.norms[at + 1] in prepositions().keys() | _AWAY:
            return False  # 'keep the candle well away from it'
        if (
            nouns
            and is_adjective(norm)
            and norm
            in (
                "open",
                "empty",
                "closed",
                "high",
                "low",
                "parallel",
                "tall",
                "closest",
                "farthest",
                "furthest",
                "nearest",
                "closer",
                "further",
                "farther",
                "upright",
                "next",
                "opposite",
                "far",
                "near",
                "close",
                "level",
                "nested",
                "folded",
                "rolled",
                "stacked",
                "adjacent",
                "flat",
            )
        ):
            return False
        if (
            nouns
            and is_adjective(norm)
            and norm not in self._verbs
            and not is_material_noun(norm)
            and norm not in _ADJECTIVE_NOUNS
        ):
            return self._nounish(at + 1) and norm in _ADJECTIVE_NOUNS
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

    def _awaits_verb(self, at: int) -> bool:
        """Return True if the clause has no verb before a place: *the envelope with the card stands between them*."""
        while at > 0 and self.norms[at - 1] not in _CLAUSE_ENDS | {"and", "but"}:
            at -= 1
            form = self._verbs.get(self.norms[at])
            if self.norms[at] in IS_FORMS or (form is not None and not self.is_noun(at)) or self.norms[at] in MODALS:
                return False
        rest = self.norms[at:]
        end = next((i for i, norm in enumerate(rest) if norm in _CLAUSE_ENDS), len(rest))
        return IS_FORMS.isdisjoint(rest[:end])

    def _ends_counted(self, at: int, nouns: list[str]) -> bool:
        """Return True if a word cannot follow a counted plural in one phrase: *three parts contribute*."""
        if not self._nouns.singular(nouns[-1])[1] or not self._counted(at - len(nouns)):
            return False
        following = next((k for k in range(at, len(self.norms)) if not self._nounish(k)), len(self.norms))
        return not any(self._nouns.singular(norm)[1] for norm in self.norms[at:following])

    def _lists_plurals(self, at: int) -> bool:
        """Return True for a bare plural before *and*, as in a list of things."""
        return at > 0 and self._nouns.singular(self.norms[at])[1] and not self.is_determiner(at - 1)

    def _counted(self, at: int) -> bool:
        """Return True if a number above one stands before the nouns that begin here, or before their adjectives."""
        while at > 0 and is_adjective(self.norms[at - 1]):
            at -= 1
        return at > 0 and (self.number(at - 1) or 0) > 1

    def _span(self, at: int, end: int) -> Span:
        return self.words[at].start, self.words[end - 1].end


_ANYBODY = frozenset(f"{quantity}{person}" for quantity in ("every", "some", "any", "no") for person in ("one", "body"))

_OWNERS = _ANYBODY | {"one", "other", "another", "else"}
"""Pronouns that own by *'s*: *within everyone's reach*."""

GENERIC_NOUNS = frozenset({"object", "objects", "agent", "agents", "thing", "item", "dot"})

_NEVER_NOUNS = word_set(
    "and or but nor than not of to from with without at by for as if when while because that which who whom whose"
    " where there then so too wherever otherwise also is are was were be been being am do does did has have had"
    " having n't please let lets upside into onto upon toward towards against among amongst between beside"
    " beneath underneath behind until during such whether whenever via per through 's 're 'm 'll 've 'd it's"
    " although though since unless yet"
)

NOUN_OR_PREPOSITION = word_set("left right top bottom front back inside outside side opposite next near close")

_CLAUSE_ENDS = frozenset({",", ";", ":", ".", "!", "?", ""})

_SUBORDINATE = frozenset({"that", "which", "who", "so", "because", "since", "while", "although", "when", "until"})
"""Words that begin a clause with a verb of its own."""

_TOWARD = frozenset({"toward", "towards", "away", "inward", "inwards", "outward", "outwards"})
"""Words of the direction of what is turned."""

_STAYING = frozenset({"stay", "remain", "lie", "sit", "hang", "belong", "kneel"})

_AWAY = frozenset({"away", "back", "clear", "apart", "out"})

_AFTER_SIDE = frozenset({"of", "next", "in", "on", "behind", "beside", "by", "at"})
"""Words after *left* and *right* before which ``'s`` stands for *is*: *the phone's left of the lamp*."""

_LATIN_PLURALS = ("ae", "i", "a")

_SINGULAR = word_set("a an this that each every another")
"""Determiners of one thing, after which a word in *-s* is a verb."""

_NEVER_PLURALS = word_set("lie sit hang go lean belong remain stay come contain touch keep")

_PLURALS_LIKE_VERBS = word_set(
    "sandwich stack pile ring clip clamp slip string top wipe label plug house screw bolt nail pin tape tip point press"
)
"""Verbs whose third person is more often the plural of a thing: *cups here, sandwiches there*."""

_LY_NOUNS = word_set("family assembly jelly butterfly belly lily supply doily reply")

_PREDICATIVE = frozenset({"left", "right", "close", "level", "parallel", "open"})

ED_NOUNS = word_set("bed shed sled weed seed reed bread thread spread bunkbed daybed flatbed waterbed")

_ADJECTIVE_NOUNS = word_set("light glass square orange cream double metal wood plastic gold silver round inside main")
