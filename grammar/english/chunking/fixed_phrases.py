"""Find fixed phrases that state no place: greetings, opinions, wishes, purposes, denials before the subject."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.chunking.conjunctions import JointChunker
from deixis.grammar.english.chunking.relators import CLAUSE_ENDS
from deixis.grammar.english.chunking.verb_groups import LAYERS
from deixis.grammar.english.tree import NounPhrase
from deixis.grammar.english.vocabulary.adjectives import is_adjective
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    CHAT_WORDS,
    COLLECTIVES,
    GREETINGS,
    HEDGES,
    IS_FORMS,
    MODALS,
    NEGATIONS,
    POSSESSIVES,
    PRONOUNS,
)
from deixis.grammar.english.vocabulary.idioms import IDIOMS
from deixis.grammar.english.vocabulary.nouns import GENERAL, PARTS, PEOPLE, last_word
from deixis.grammar.english.vocabulary.relation_words import (
    CIRCUMSTANCES,
    DIRECTION_WORDS,
    HOLIDAYS,
    OCCURRENCES,
    Preposition,
    places_alone,
    prepositions,
)
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import FIND_VERBS, PUT_VERBS
from deixis.ontology.inflection import singulars


@cache
def _idioms() -> dict[str, list[tuple[str, ...]]]:
    found: dict[str, list[tuple[str, ...]]] = {}
    for phrase in sorted(IDIOMS, key=len, reverse=True):
        found.setdefault(phrase[0], []).append(phrase)
    return found


MAX_JUDGEMENT = 8
"""Number of words before an infinitive in which *it is* can begin a judgement of it."""


class FixedPhraseChunker(JointChunker):
    """Finder of fixed phrases."""

    def _causative(self, at: int) -> int | None:
        """Return the index of the verb of *let the ribbon hang …* and *ask an adult to stand …*; None for others."""
        needs_to = _CAUSATIVES.get(self.norms[at])
        if needs_to is None or self._previous() not in JOINT_TYPES | {"", "ADVERB"} or not self.nouns.starts(at + 1):
            return None
        if self.norms[at + 1] == "no":
            return None  # 'erasers, by the way, have no place on it'
        for i in range(at + 2, min(at + 7, len(self.words))):
            form = self._verbs.get(self.norms[i])
            if form is not None and form.form == "base" and form.kind in ("posture", "lean", "face", "point", "other"):
                has_to = self.norms[i - 1] == "to"
                place = self.norms[i + 1] in prepositions() or self.norms[i + 1] in places_alone()
                if has_to == needs_to and place:
                    return i
            if self.norms[i] in prepositions() and self.norms[i] != "to":
                return None
        return None

    def _denial(self, at: int) -> int | None:
        """Return the end of *under no circumstances* before *must the cup …*: the verb after the subject is denied."""
        if self._previous() not in ("", "COMMA", "CUT", "AND", "ADVERB", "COLON"):
            return None
        if self.norms[at : at + 3] == ["do", "not", "you"]:  # 'don't you ever put it there'
            self._denied = "must"
            return at + 3 + (self.norms[at + 3] in ("ever", "dare", "go"))
        if self.norms[at] == "nor" and self.norms[at + 1] in MODALS and self.nouns.starts(at + 2):
            self._denied = MODALS[self.norms[at + 1]]
            return at + 2  # 'nor may they stand on it'
        for phrase in (*_DENIALS, *self._denied_circumstances(at)):
            end = at + len(phrase)
            if tuple(self.norms[at:end]) == phrase:
                there = self.norms[end + 1 : end + 2] == ["there"]  # 'never is there a cup on it'
                if self.norms[end] in IS_FORMS and self.norms[end] != "'s" and self.nouns.starts(end + 1 + there):
                    past = self.norms[end] in ("was", "were")
                    self._denied_be = VerbGroup("be", "be", "finite", positive=False, past=past)
                    return end + 1 + there
                if self.norms[end] in MODALS or self.norms[end] in ("do", "does", "is", "are"):
                    self._denied = MODALS.get(self.norms[end], "must")
                    return end + 1
                form = self._verbs.get(self.norms[end])
                if form is not None and form.form in ("base", "ing", "s"):
                    self._denied = "must"
                    return end
        return None

    def _denied_circumstances(self, at: int) -> tuple[tuple[str, ...], ...]:
        """Return *under no pretext*: a preposition and a bare noun that *no* denies."""
        if self.norms[at + 1] != "no" or self.norms[at] not in ("under", "on", "at", "in", "by", "for", "to", "with"):
            return ()
        return tuple(tuple(self.norms[at : at + 2 + words]) for words in (1, 2))

    def _idiom(self, at: int) -> Chunk | None:
        norm = self.norms[at]
        previous_joint = self._previous() in ("", "COMMA", "AND", "BUT", "CUT", "ADVERB")
        related = self._relations.longest(self.norms, at)
        able = norm == "as" and self.norms[at + 1] in PRONOUNS and self.norms[at + 2] in ("can", "could", "may", "will")
        if able and self.norms[at + 4] in CLAUSE_ENDS and self.norms[at + 3].isalpha():
            return Chunk("ADVERB", at, at + 4, "as you can")  # 'as far from it as you can manage'
        if (examples := self._examples(at)) is not None:
            return Chunk("ADVERB", at, examples, "such as")
        if norm == "as" and self.norms[at + 1] in ("seen", "viewed") and self.norms[at + 2] == "by":
            return Chunk("PREP", at, at + 3, Relator(Preposition("as seen by", "-")))
        if (shown := self._as_shown(at)) is not None:
            return Chunk("ADVERB", at, shown, "as shown")
        for phrase in _idioms().get(norm, ()):
            end = at + len(phrase)
            longer = related is not None and related[0] > end  # 'out of reach of the cat'
            if (
                tuple(self.norms[at:end]) == phrase
                and not longer
                and not (
                    (phrase in _BEFORE_NOUNS and self.nouns.starts(end))
                    or (phrase == ("that", "is") and (self.norms[at - 1] != "," or self.norms[at + 2] in self._verbs))
                    or (phrase == ("above", "all") and self.norms[end] != ",")
                    or (phrase[-1] == "case" and self._previous() == "BE" and self.norms[end] in CLAUSE_ENDS)
                )
            ):
                return Chunk("ADVERB", at, end, " ".join(phrase))
        if norm == "from" or (
            norm in DIRECTION_WORDS and self.norms[at + 1] == "to" and self.norms[at + 2] in DIRECTION_WORDS
        ):
            order = self._order(at)
            if order is not None:
                return order
        is_command = (
            self.norms[at + 1] in PUT_VERBS and self.nouns.starts(at + 2) and self._previous() in ("", "ADVERB")
        )
        if norm in ("not", "no") and is_command and not self.nouns.is_noun(at + 1):
            return Chunk("PUT", at, at + 2, VerbGroup(self.norms[at + 1], "posture", "base", positive=False))
        called = at + 1 + ((norm, self.norms[at + 1]) in _CALLS)
        if norm in _ATTENTION and self.norms[called] == "," and self._previous() in ("", "ADVERB", "COMMA", "CUT"):
            return Chunk("ADVERB", at, called, norm)  # 'no, wait, the cups are …'
        if (
            norm in ("at", "by", "until", "before", "after", "from", "since")
            and self.norms[at + 2].replace(".", "") in ("am", "pm")
            and self.nouns.number(at + 1) is not None
        ):
            return Chunk("ADVERB", at, at + 3, "time")  # 'at 8 a.m.'
        if (
            norm in ("at", "by", "until", "from", "since")
            and self.nouns.number(at + 1) is not None
            and not {"clock", "o'clock"} & set(self.norms)
        ):
            end = at + 2 + (self.norms[at + 2] in ("sharp", "exactly"))
            if self.norms[end] in CLAUSE_ENDS | {"and"}:
                return Chunk("ADVERB", at, end, "time")  # 'at eleven sharp'
        goal = self._goal(at)
        if goal is not None:
            return Chunk("FIND", at, goal, VerbGroup(norm, "other", "base"))
        if norm == "welcome" and at == 0 and self.norms[1] in ("in", "to", "at"):
            end = next(i for i in range(1, len(self.norms)) if self.norms[i] in ("", ",", "!", ".", ":", ";"))
            return Chunk("ADVERB", at, end, norm)
        if self.nouns.number(at) is not None and self.norms[at + 1] in LAYERS and self._previous() in ("PART", "ADV"):
            return Chunk("ADVERB", at, at + 2, "layers")  # 'stacked two high'
        ends = self.norms[at + 1] in prepositions() or self.norms[at + 1] in ("", ",", ".", "and")
        if norm in ("later", "earlier") and ends and self._previous() in FINITE | {"PART", "TPART", "NP"}:
            return Chunk("ADVERB", at, at + 1, norm)
        if (
            self.norms[at : at + 2] == ["very", "little"]
            and self._previous() == "PART"
            and not self.nouns.is_noun(at + 2)
        ):
            return Chunk("ADVERB", at, at + 2, "very little")  # 'tools that are used very little go there'
        if norm == "in" and self.norms[at + 1] == "first" and self.norms[at + 2] in ("", ",", ".", ";"):
            return Chunk("ADVERB", at, at + 2, "in first")
        if (
            norm in ("in", "over", "up", "down")
            and self._previous() in FINITE
            and self.norms[at + 1] in _UNDER_OR_BEHIND
        ):
            return Chunk("ADVERB", at, at + 1, norm)  # 'it slides in behind the shelf'
        if norm in ("up", "down") and self._previous() == "PART" and self.norms[at + 1] == "inside":
            return Chunk("ADVERB", at, at + 1, norm)  # 'coiled up inside the bucket'
        if norm == "set" and self.norms[at + 1] == "up" and self._previous() in FINITE:
            return Chunk("ADVERB", at, at + 2, "set up")
        if norm == "in" and self.norms[at + 1 : at + 3] == ["order", "of"]:
            return Chunk("ADVERB", at, min(at + 4, len(self.words)), "in order")
        if (
            self.norms[at + 1] == "side"
            and self.norms[at + 2] in ("up", "down", "out", "in", "outwards", "inwards")
            and self._previous() in ("COMMA", "NP")
            and self.norms[at + 3] in CLAUSE_ENDS | {"and", "on", "in"}
        ):
            return Chunk("ADVERB", at, at + 3, "side up")  # 'lay the sheet on the mat, shiny side down'
        if (
            self.norms[at + 1] in ("up", "down", "on", "off", "outwards", "inwards", "uppermost")
            and self._previous() == "COMMA" and self.norms[at + 2] in CLAUSE_ENDS
            and (norm not in PARTS or self.norms[at + 1] in ("on", "off"))
            and norm not in ADVERBS and self.nouns.is_noun(at)
            and not self.norms[at + 3].endswith("ing")
        ):  # fmt: skip
            return Chunk("ADVERB", at, at + 2, "side up")  # 'the cups behind it, lids on'
        if (after := self._time(at)) is not None:
            return Chunk("ADVERB", at, after, "circumstance")
        circumstance = self._circumstance(at)
        if circumstance is not None and (related is None or related[0] <= at + 1):
            return Chunk("ADVERB", at, circumstance, "circumstance")
        if norm in _FITTING and self.norms[at + 1] == "in" and previous_joint and self.nouns.is_determiner(at + 2):
            return Chunk("PUT", at, at + 2, VerbGroup(norm, "posture", "base"))  # 'plug in the cable next to it'
        if norm in PUT_VERBS and self._previous() == "AND" and self.norms[at + 1 : at + 3] == ["in", "place"]:
            return Chunk("ADVERB", at, at + 3, "in place")  # 'press it against the frame and secure in place'
        tried = norm == "try" and self.norms[at + 1] == "to" and self.norms[at + 2] in PUT_VERBS and previous_joint
        if tried and self.nouns.starts(at + 3):  # 'try to keep the lamp behind it'
            return Chunk("PUT", at, at + 3, VerbGroup(self.norms[at + 2], "posture", "base"))
        if norm == "using" and self._previous() == "COMMA" and any(c.type == "PUT" for c in self.chunks):
            end = next(i for i in range(at, len(self.words) + 1) if self.norms[i] in CLAUSE_ENDS)
            return Chunk("ADVERB", at, end, "using")  # 'screw it to the beam, using a bolt on each side'
        avoided = self._verbs.get(self.norms[at + 1]) if norm == "avoid" and previous_joint else None
        if avoided is not None and avoided.form == "ing" and avoided.lemma in PUT_VERBS and self.nouns.starts(at + 2):
            return Chunk("PUT", at, at + 2, VerbGroup(avoided.lemma, "posture", "base", positive=False))
        if norm in _STARTING and self.norms[at + 1] in ("by", "with") and previous_joint:
            form = self._verbs.get(self.norms[at + 2])
            if form is not None and form.form == "ing" and form.lemma in PUT_VERBS:
                return Chunk("PUT", at, at + 3, VerbGroup(form.lemma, "posture", "base"))  # 'begin by placing the cup'
        if previous_joint and (advice := self._advice(at)) is not None:
            return advice
        verb = self.chunks[-1].value if self.chunks else None
        aimed = isinstance(verb, VerbGroup) and verb.kind in ("face", "point")  # 'facing down on the rack'
        if (
            norm in _PARTICLES
            and not aimed
            and self.norms[at + 1] in ("on", "at", "with", "by")
            and (related is None or related[0] == at + 1)
        ):
            return Chunk("ADVERB", at, at + 1, norm)  # 'brought in on the tray'
        if norm in ("inward", "inwards", "outward", "outwards") and self.norms[at + 1] in ("to", "toward", "towards"):
            return Chunk("ADVERB", at, at + 1, norm)
        if norm in ("itself", "himself", "herself", "themselves") and self._previous() == "NP":
            return Chunk("ADVERB", at, at + 1, norm)  # 'not in the box itself'
        if norm in ("consists", "consist", "comprises") and (self.norms[at + 1] == "of" or norm == "comprises"):
            return Chunk("CUT", at, at + (1 if norm == "comprises" else 2))
        if norm in ("marked", "labelled", "labeled") and self._previous() == "NP" and self.nouns.is_noun(at + 1):
            return Chunk("ADVERB", at, at + 2, norm)  # 'the beaker marked "waste" at the end'
        if (
            norm == "over"
            and not self.nouns.starts(at + 1)
            and any(
                form.lemma in _TURNING for word in self.norms[max(0, at - 5) : at] if (form := self._verbs.get(word))
            )
        ):
            return Chunk("ADVERB", at, at + 1, norm)  # 'turn the desk over'
        if norm == "from" and self.norms[at + 1] == "where" and self.norms[at + 2] in ("i", "you", "we"):
            end = at + 3
            while self.norms[end] in IS_FORMS or self.norms[end] in (
                "sit",
                "sat",
                "stand",
                "stood",
                "sitting",
                "standing",
            ):
                end += 1
            return Chunk("ADVERB", at, end, "from where")
        if norm == "out" and self.norms[at + 1] == "of":
            end = at + 2 + (self.norms[at + 2] in ("my", "your", "his", "her", "our", "their", "the"))
            if self.norms[end] in ("reach", "sight", "way", "place", "order") and (
                related is None or related[0] <= end
            ):
                return Chunk("ADVERB", at, end + 1, "out of reach")
        if norm == "say" and self._previous() == "COMMA" and self.norms[at + 1] in prepositions():
            return Chunk("ADVERB", at, at + 1, norm)
        if norm == "one" and self.norms[at + 1] in MODALS:
            person = NounPhrase((self.words[at].start, self.words[at].end), pronoun="someone")
            return Chunk("NP", at, at + 1, person)
        if (
            norm == "there" and self.norms[at + 1] in ("is", "'s") and self.norms[at + 2] == "no"
            and self.norms[at + 3] in ("way", "chance")
        ):  # fmt: skip
            end = at + 4 + (self.norms[at + 4] == "that")
            return Chunk("COMPLEMENT", at, end, VerbGroup("think", "other", "base", positive=False))
        if norm == "had" and at == 0 and "been" in self.norms:
            return Chunk("SUB", at, at + 1, "if")
        if norm in ("i", "we", "it") and previous_joint:
            opinion = self._opinion(at) if norm != "it" else self._impersonal(at)
            if opinion is not None:
                return Chunk("COMPLEMENT", at, opinion[0], opinion[1])
        orders = norm == "be" and self._previous() in JOINT_TYPES | {""} and self.norms[at + 2] in CLAUSE_ENDS
        if orders and self.norms[at + 1] not in self._verbs and not is_adjective(self.norms[at + 1]):
            return Chunk("DO", at, at + 1, VerbGroup("be", "other", "base"))  # 'be polite'
        apart = norm == "one" and self.norms[at + 1] in ("at", "on", "to") and self.norms[at + 2] in ("each", "either")
        if apart and (self._previous() in ("PART", "VERB", "TPART") or self.norms[at - 1] in self._verbs):
            return Chunk("ADVERB", at, at + 1, norm)  # 'placed one at each side of it'
        if norm in ("both", "all", "each") and self._previous() == "BE" and not self.nouns.starts(at + 1):
            return Chunk("ADVERB", at, at + 1, norm)
        if (
            norm == "to"
            and self.norms[at + 1] in PUT_VERBS
            and self._previous()
            and self.nouns.starts(at + 2)
            and (
                self.nouns.is_determiner(at + 2)
                or self.norms[at + 2] in ("it", "them")
                or ((self.norms[at - 1] in _JUDGEMENTS or self._judges(at)) and self.nouns.is_noun(at + 2))
                or self._makes_sense(at)
            )
        ):
            before = self.norms[:at]
            spared = not _NECESSARY.isdisjoint(before)  # 'it is not necessary to put it there'
            denied = any(word in NEGATIONS or word in _FORBIDDING for word in before)
            used = "used" in before  # 'it may be used to cut bread or to spread butter on it'
            is_sure = denied or (self._is_told_to(at) and not used)
            modal = None if is_sure and not (denied and spared) else "might"
            denied = denied and not spared
            return Chunk(
                "PUT", at, at + 2, VerbGroup(self.norms[at + 1], "posture", "base", modal, positive=not denied)
            )
        if norm == "to" and self._previous() == "NP" and self.norms[at + 1] in FIND_VERBS:
            return Chunk("ADVERB", at, at + 2 + (self.norms[at + 2] in ("up", "out")), "to pick")
        if norm in ("you", "we", "i", "that"):
            wished = self._wish(at)
            if wished is not None and self._previous() in ("COMMA", "AND", "BUT") and self._chooses(wished):
                return Chunk("FIND", at, wished, VerbGroup("choose", "other", "base"))
            if wished is not None:
                alone = self._previous() != "NP" or self.nouns.is_determiner(wished)
                placed = self._only_places() and self.nouns.is_determiner(wished)  # 'on its left you want the prawns'
                alone = alone and not placed and self._previous() != "SUB"  # 'if you want honey' is a condition
                return Chunk("CUT" if alone else "ADVERB", at, wished, "you want")
        opens = norm in _STEPS and not norm.endswith("ly") and self.norms[at + 1] == ","
        opens = opens and self._previous() in ("", "CUT")
        if opens and (self._subject_or_command(at + 2) or self.norms[at + 2] in PUT_VERBS | prepositions().keys()):
            return Chunk("ADVERB", at, at + 2, norm)  # 'next, set the fork on the tray'
        if (
            norm in _STEPS
            and self._previous() in ("", "CUT", "THEN", "AND", "COMMA")
            and self._subject_or_command(at + 1)
        ):
            return Chunk("ADVERB", at, at + 1, norm)  # 'first you lay the cloth'
        if norm in CHAT_WORDS and self.norms[at + 1] in ("", ",", ".", ":", "!", "?", ";"):
            return Chunk("ADVERB", at, at + 1, norm)
        if norm == "like" and self._previous() in ("BE", "TVERB", "NP") and self.nouns.number(at + 1) is not None:
            return Chunk("ADVERB", at, at + 1, norm)  # 'there's like three hoodies'
        if (
            norm in GREETINGS
            and self._previous() in ("", "ADVERB")
            and (self.norms[at + 1] in (",", "!") or norm in ("hi", "oh", "hello", "hey", "ok", "okay"))
        ):
            end = at + 1
            if self.norms[end] in GREETINGS:
                end += 1
            return Chunk("ADVERB", at, end, norm)
        return None

    def _circumstance(self, at: int) -> int | None:
        """Return the end of *at this time*, *in a formal setting*, *at a 45-degree angle*; None for other phrases."""
        if self.norms[at] not in ("in", "at", "as", "on", "under"):
            return None
        for i in range(at + 1, at + 6):
            norm = self.norms[i]
            general = norm in _OCCASIONS and self.norms[at + 1] in _GENERAL
            if (norm in CIRCUMSTANCES or general) and not self.nouns.is_noun(i + 1):
                if self.norms[i + 1 : i + 3] == ["of", "thumb"]:
                    return i + 3
                placed = norm == "setting" and ("of" in self.norms[at:i] or self.norms[i - 1] == "place")
                return None if placed or self.norms[i + 1] in ("of", "'s", "to") else i + 1
            several = norm == "of" and self.norms[i - 1] in COLLECTIVES | {"variety"}
            if not norm[:1].isalnum() or (norm in prepositions() and not several) or norm in IS_FORMS:
                return None
        return None

    def _examples(self, at: int) -> int | None:
        """Return the end of *such as yogurt and cheese* after a noun; None for other phrases.

        After *like*, at least two bare nouns are examples of a plural: *snacks like nuts and crackers*.
        """
        alike = self.norms[at] == "like" and self._previous() == "NP" and self.chunks[-1].value.plural
        if (self.norms[at : at + 2] != ["such", "as"] or self._previous() != "NP") and not alike:
            return None
        first = end = at + 2 - alike
        while self.norms[end]:
            found = self.nouns.phrase(end, "PREP")
            if found is None or found[1] is None or found[1].pronoun is not None:
                return None
            if alike and self.nouns.is_determiner(end):
                return None
            end = found[0]
            joint = end
            while self.norms[joint] in (",", "and", "or") and joint < len(self.words):
                joint += 1
            verb = self._verbs.get(self.norms[joint])
            if self.norms[joint] in ("etc", "etc."):
                return joint + 1
            if joint == end or verb is not None or not self.nouns.starts(joint) or self.nouns.is_determiner(joint):
                listed = not {",", "and", "or"}.isdisjoint(self.norms[first:end])
                ends = joint == end or not self.nouns.is_determiner(joint)  # not 'like maps, a knife or your phone'
                return end if (listed and ends) or not alike else None
            end = joint
        return end

    def _as_shown(self, at: int) -> int | None:
        """Return the end of *as shown below* and *as described earlier*; None for other phrases."""
        if self.norms[at] != "as" or self.norms[at + 1] not in _TOLD:
            return None
        end = at + 2
        while self.norms[end] in _IN_THE_TEXT:
            end += 1
        return None if self.nouns.starts(end) and self.norms[end - 1] in prepositions() else end

    def _time(self, at: int) -> int | None:
        """Return the end of *at the start of each round* and *on Christmas morning*; None for other phrases."""
        if self.norms[at] not in _BEFORE_TIMES:
            return None
        i = at + 1 + (self.norms[at + 1] == "the")
        if self.norms[i] in HOLIDAYS:
            while self.norms[i] in HOLIDAYS or self.norms[i] in _DAYS:
                i += 1
            ends = not self.nouns.is_noun(i) or self.nouns.is_determiner(i) or self.norms[i] in PUT_VERBS
            return i if ends and self.norms[i] != "'s" else None
        if self.norms[i] not in _BEGINNINGS or self.norms[i + 1] != "of":
            return None
        end = i + 2
        while self.nouns.is_determiner(end) or self.norms[end] in ("game", "new", "next", "first", "last"):
            end += 1
            if self.norms[end - 1] == "game" and self.norms[end] not in OCCURRENCES:
                return end
        return end + 1 if self.norms[end] in OCCURRENCES and not self.nouns.is_noun(end + 1) else None

    def _subject_or_command(self, at: int) -> bool:
        """Return True if a subject with a determiner, a personal pronoun or a command begins here."""
        norm = self.norms[at]
        return (
            self.nouns.is_determiner(at)
            or norm in ("you", "we", "i", "they", "it")
            or (norm in PUT_VERBS and self.nouns.is_determiner(at + 1))
        )

    def _goal(self, at: int) -> int | None:
        """Return where the goal of a command begins: *go over to the chair by the window*; None for another command.

        The goal of *go to the table and take the cup* is the cup.
        """
        end = at + 1 + (self.norms[at + 1] in ("over", "up", "straight", "back"))
        if not (
            self.norms[at] in _APPROACHING
            and self._previous() in ("", "AND", "COMMA", "THEN", "ADVERB", "CUT")
            and (self.norms[end] in ("to", "toward", "towards") or (self.norms[at], self.norms[end]) == ("head", "for"))
            and self.nouns.is_determiner(end + 1)
            and self.norms[end + 2] not in ("left", "right")
            and "you" not in self.norms[:at]
        ):
            return None
        later = zip(self.norms[end + 1 :], self.norms[end + 2 :], strict=False)
        if any(joint in ("and", ",", "then") and norm in FIND_VERBS | PUT_VERBS | _LOOKING for joint, norm in later):
            return None
        return end + 1

    def _advice(self, at: int) -> Chunk | None:
        """Return the command of *I recommend placing it there*, *consider putting it there*."""
        i, positive, verbs = at, True, _TRYING
        if self.norms[at] in ("i", "we"):
            i, verbs = at + 1, _RECOMMENDING
            while self.norms[i] in ADVERBS | NEGATIONS | _RECOMMENDED_SO:
                positive = positive and self.norms[i] not in NEGATIONS
                i += 1
        form = self._verbs.get(self.norms[i + 1]) if self.norms[i] in verbs else None
        placed = form is not None and form.form == "ing" and (form.lemma in PUT_VERBS or form.lemma == "use")
        if form is None or not placed or not self.nouns.starts(i + 2):
            return None
        return Chunk("PUT", at, i + 2, VerbGroup(form.lemma, "posture", "base", positive=positive))

    def _is_told_to(self, at: int) -> bool:
        """Return True if the words before an infinitive make it a command: *remember to put*, not *afraid to put*."""
        i = at - 1
        while i > 0 and (self.norms[i] in ADVERBS or self.norms[i] in HEDGES):
            i -= 1
        if self.norms[i - 1] == "no":
            return False  # 'there is no need to put it there'
        if self.norms[i] in _GOVERNORS or self._makes_sense(i + 1):
            return True
        first = next((k for k in range(len(self.chunks) - 1, -1, -1) if self.chunks[k].type in JOINT_TYPES), -1)
        if self._previous() == "NP" and any(c.type in ("PUT", "DO", "FIND") for c in self.chunks[first + 1 :]):
            return True  # 'take the cup to put it on the tray'
        joined = self.norms[i] in ("and", "then", ",", "or")
        return joined and not _GOVERNORS.isdisjoint(self.norms[:i])

    def _makes_sense(self, at: int) -> bool:
        """Return True after *it makes sense*, *it makes the most sense*."""
        return self.norms[at - 1] == "sense" and self.norms[at - 2] in _SENSIBLE

    def _opinion(self, at: int) -> tuple[int, VerbGroup] | None:
        """Return the end and the verb of *I think that*, *we don't believe that*, which make a clause probable."""
        i, positive = at + 1, True
        while self.norms[i] in ("do", "not", "never", "really", "would", "can"):
            positive = positive and self.norms[i] not in NEGATIONS
            i += 1
        if self.norms[i] not in ("think", "believe", "guess", "suppose", "assume", "imagine"):
            return None
        i += 1 + (self.norms[i + 1] == "that")
        group = VerbGroup("think", "other", "base", positive=positive, adverbs=("probably",))
        return (i, group) if self.nouns.starts(i) else None

    def _judges(self, at: int) -> bool:
        """Return True if the words before this one are an impersonal judgement: *it is no longer good form*."""
        before = range(max(0, at - MAX_JUDGEMENT), at - 1)
        return any(self.norms[k] == "it" and self.norms[k + 1] in IS_FORMS for k in before)

    def _impersonal(self, at: int) -> tuple[int, VerbGroup] | None:
        """Return the end and the verb of *it seems that*, *it could be that*, *it isn't true that*."""
        i, positive, modal, adverbs = at + 1, True, None, []
        while self.norms[i] not in ("that", "like", "as"):
            norm = self.norms[i]
            if norm in NEGATIONS or norm in ("false", "wrong", "impossible", "unlikely", "untrue"):
                positive = not positive
            elif norm in MODALS:
                modal = MODALS[norm]
            elif norm in (
                "possible",
                "thought",
                "said",
                "believed",
                "rumoured",
                "rumored",
                "claimed",
                "hoped",
                "feared",
            ):
                modal = "might"
            elif norm in ("likely", "probable", "seems", "appears", "looks"):
                adverbs.append("probably")
            elif norm not in IS_FORMS and norm not in ADVERBS and norm not in HEDGES and norm not in _JUDGEMENTS:
                return None
            i += 1
            if i - at > 6:
                return None
        if (self.norms[i] != "that" and self.norms[i - 1] not in ("seems", "appears", "looks")) or i == at + 1:
            return None
        i += 1 + (self.norms[i + 1] == "if")
        if not self.nouns.starts(i) or self.norms[i] in ("a", "an"):
            return None
        return i, VerbGroup("be", "be", "finite", modal, positive, adverbs=tuple(adverbs))

    def _wish(self, at: int) -> int | None:
        """Return the end of *you want (to pick)*, *you are looking for*: such words say nothing about places."""
        i = at + (self.norms[at] == "that")
        if self.norms[i] not in ("you", "we", "i"):
            return None
        i += 1
        while self.norms[i] in ADVERBS or self.norms[i] in _WISHING_MODALS:
            i += 1
        if (
            self.norms[i] in ("are", "'re", "am", "'m")
            and self.norms[i + 1] in ("looking", "searching")
            and self.norms[i + 2] == "for"
        ):
            return i + 3
        if self.norms[i] in ("are", "'re") and self.norms[i + 1] == "to":
            i += 1
        if self.norms[i] in ("tell", "ask") and "to" in self.norms[i + 2 : i + 4]:
            i = self.norms.index("to", i)
        wants = self.norms[i] in ("want", "need", "have", "like", "prefer", "love") and not (
            (self.norms[i] == "have" and self.norms[i + 1] != "to") or self.norms[i + 1] in NEGATIONS
        )
        if wants:
            i += 1
            if self.norms[i] != "to":
                return i
        if self.norms[i] == "to":
            i += 1
            while self.norms[i] in ("go", "be", "look") or self.norms[i] in ADVERBS:
                i += 1
        if self.norms[i] in _CHOOSE or (self.norms[i - 1] in ("to", "should", "must") and self.norms[i] in FIND_VERBS):
            i += 1
            return i + (self.norms[i] in ("for", "on", "out", "up"))
        return i if self.norms[i - 1] in ("to", "go") and i > at + 2 else None

    def _use(self, at: int) -> int | None:
        """Return the end of a relative clause that tells which thing a person means: *the cups you use daily*."""
        i = at + (self.norms[at] in ("that", "which"))
        if self._previous() != "NP" or (user := self._end_of_user(i)) is None:
            return None
        i = user
        while self.norms[i] in ADVERBS | _FREQUENCIES | _HELPING or self.norms[i] in NEGATIONS:
            i += 1
        form, placing = self._verbs.get(self.norms[i]), False
        if form is not None and form.lemma in _WISHING and self.norms[i + 1] == "to":
            i += 2
            form = self._verbs.get(self.norms[i])
            if form is not None and form.form != "base":
                return None
            placing = self.norms[i] in PUT_VERBS or (form is not None and form.kind == "posture")
        elif (self.norms[i] if form is None else form.lemma) not in _USING:
            return None
        i = self._end_of_use(i + 1)
        follows = self._verbs.get(self.norms[i])
        said = self.norms[i] in IS_FORMS | MODALS.keys() or (follows is not None and follows.form in ("base", "s"))
        ends = self.norms[i] in CLAUSE_ENDS | prepositions().keys() and self.norms[i] != "to" and not placing
        return i if said or ends else None

    def _name_used(self) -> None:
        """Make a general noun with such a clause the name of new things: *the items you need*, *anything you use*."""
        last = self.chunks[-1]
        phrase = last.value
        if phrase.pronoun in ("anything", "everything", "something") and not phrase.head:
            last.value = replace(phrase, head="thing", pronoun=None, plural=True)
        elif (
            phrase.plural and last_word(phrase.head) in GENERAL and phrase.determiner in ("the", "those", "these", None)
        ):
            last.value = replace(phrase, determiner="some")  # not the heavy items that were named before

    def _end_of_user(self, at: int) -> int | None:
        """Return the end of the person of such a clause: *you*, *most people*, *your children*."""
        i = at + (self.norms[at] == "most")
        if self.norms[i] in _USERS:
            return i + 1
        owned = self.norms[i] in POSSESSIVES or self.norms[i] in ("the", "some", "many")
        return i + 2 if owned and not PEOPLE.isdisjoint(singulars(self.norms[i + 1])) else None

    def _end_of_use(self, at: int) -> int:
        """Return the end of what follows the verb: *access to*, *most often*, *for cooking*, *with* alone."""
        i = at
        access = next((k for k in range(i, i + 3) if self.norms[k] == "access"), None)
        if access is not None and self.norms[access + 1] == "to":
            i = access + 2  # 'things you need quick access to'
        while True:
            purpose = self.norms[i] == "for" and self.norms[i + 1].endswith("ing") and self.norms[i + 2] in CLAUSE_ENDS
            if purpose or list(self.norms[i : i + 2]) in _FREQUENT_PAIRS:
                i += 2
            elif self._adds_nothing(i):
                i += 1
            else:
                return i

    def _adds_nothing(self, at: int) -> bool:
        """Return True for an adverb, and for a preposition without its noun."""
        adverb = self.norms[at] in _FREQUENCIES or self.norms[at].endswith("ly")
        return adverb or (self.norms[at] in _STRANDED and self._is_stranded(at + 1))

    def _is_stranded(self, at: int) -> bool:
        """Return True where a preposition has no noun after it: *the toys they play with are …*."""
        form = self._verbs.get(self.norms[at])
        finite = self.norms[at] in IS_FORMS | MODALS.keys() or (form is not None and form.form == "s")
        going = form is not None and form.form == "base" and form.kind == "posture"
        again = (
            self.norms[at] in prepositions().keys() | _FREQUENCIES or list(self.norms[at : at + 2]) in _FREQUENT_PAIRS
        )
        return finite or going or again or self.norms[at] in CLAUSE_ENDS

    def _chooses(self, at: int) -> bool:
        """Return True if one of several things is meant: *there are six benches, and you want the leftmost one*."""
        return self.norms[at] == "the" and any(chunk.type == "THERE" for chunk in self.chunks)

    def _order(self, at: int) -> Chunk | None:
        """Return the order *from left to right*, *from the front to the back*."""
        if (
            self.norms[at : at + 2] == ["from", "the"]
            and self.norms[at + 2] in _OTHER_END
            and (self.norms[at + 3] in (":", ",") and self._previous() in ("", "COMMA", "ADVERB", "CUT"))
        ):
            side = self.norms[at + 2]
            return Chunk("ADV", at, at + 3, Relator(Preposition(f"{side} to {_OTHER_END[side]}", "row")))
        listed = self.norms[at + 2] in (":", ")") and self._previous() in ("", "COMMA", "ADVERB", "CUT", "NP")
        if self.norms[at] == "from" and self.norms[at + 1] in ("left", "right") and listed:
            order = f"{self.norms[at + 1]} to {_OTHER_END[self.norms[at + 1]]}"
            return Chunk("ADV", at, at + 2, Relator(Preposition(order, "row")))
        i, sides = at + (self.norms[at] == "from"), []
        for stop in ("to", ""):
            i += self.norms[i] == "the"
            if self.norms[i] not in DIRECTION_WORDS:
                return None
            sides.append(self.norms[i])
            i += 1
            if stop and self.norms[i] != stop:
                return None
            i += bool(stop)
        order = f"{sides[0]} to {sides[1]}"
        return Chunk("ADV", at, i, Relator(Preposition(order, "row")))


_OCCASIONS = word_set("case cases event instance situation situations household households")
"""Nouns that name no place if they are general: *in a rare case*, not *in the case*."""

_TOLD = word_set(
    "shown seen depicted pictured illustrated described explained indicated drawn displayed marked instructed directed"
    " mentioned noted before above below"
)
"""Words after *as* that send the reader to a picture or to another part of the text."""

_IN_THE_TEXT = word_set("below above here earlier opposite previously before overleaf")

_BEFORE_TIMES = word_set("at on in from before after until till by since near over during around towards toward")

_BEGINNINGS = word_set("start beginning outset end close middle conclusion course")

_DAYS = word_set("day eve morning evening afternoon night monday friday sunday time week weekend season holiday")

_FITTING = frozenset({"plug", "slot", "screw", "push", "snap", "slide"})
"""Verbs of which *in* is a part: *plug in the cable*."""

_GENERAL = word_set("a an any some many most more few other certain every each no this that which both all")

_STARTING = word_set("begin start commence finish continue")

_PARTICLES = word_set("in out up down off over through")

_DENIALS = tuple(
    tuple(phrase.split())
    for phrase in (
        "under no circumstances", "at no time", "on no account", "in no case", "by no means", "in no way", "never",
        "at no point",
    )
)  # fmt: skip
"""Denials that can stand before their clause and turn its words round."""

_JUDGEMENTS = word_set(
    "true clear certain important essential vital good bad nice best better the case fact sure acceptable fine polite"
    " proper correct customary usual common traditional advisable idea convenient useful helpful wise sensible smart"
    " practical"
)

_NECESSARY = word_set("necessary required needed essential obligatory mandatory compulsory")
"""Judgements whose denial leaves a choice."""

_FORBIDDING = word_set("forbidden prohibited avoid impossible wrong refuse forget dangerous")

_STEPS = word_set("first second third next last lastly finally")
"""Words that number the steps of a text."""

_GOVERNORS = word_set(
    "remember sure forget need needs have has had got important essential necessary vital crucial best better good"
    " helpful useful advisable advised recommended time ready proceed continue begin start care careful required want"
    " is are step idea convenient wise sensible smart practical helps pays"
)
"""Words before *to* that make the infinitive a command; other words, as *afraid* or *refuse*, do not."""

_SENSIBLE = word_set("make makes good more most perfect")
"""Words before *sense* with which an infinitive is advised: *it makes sense to keep it there*."""

_RECOMMENDING = word_set("recommend love like enjoy prefer")
"""Verbs of writers whose *-ing* form is a command, unlike that of *suggest*: *we recommend*, *I love placing it*."""
_RECOMMENDED_SO = word_set("do would 'd also highly strongly always really personally usually typically often")
"""Words between a writer and what is recommended."""
_WISHING_MODALS = word_set("'ll will would 'd should must may might could")
"""Modals before what a person wants: *you may want to put it there*."""
_TRYING = word_set("consider try recommend begin start continue")
"""Verbs of commands whose *-ing* form is the command: *try placing it there*."""

_USERS = word_set("you we they i people guests everyone")
"""Subjects of relative clauses that tell who uses a thing."""
_USING = word_set(
    "use need want like reach love eat drink wear own buy enjoy access prefer treasure collect require cook bake read"
    " write play work watch handle refer rely care grab consume choose pick admire adore remember forget share value"
    " operate reuse cherish utilize utilise make receive"
)
"""Verbs of such clauses, which say no place."""
_WISHING = word_set("want need like love plan hope wish prefer try intend have tend")
"""Verbs before the infinitive of such a clause: *the pieces you want to show*."""
_HELPING = word_set("'ll will can do don't would might may 've have has 're are 'd must should could 'm am")
_STRANDED = word_set("for with to from about without on at through of")
"""Prepositions that can end such a clause."""
_FREQUENCIES = word_set(
    "most often daily frequently regularly rarely seldom occasionally sometimes weekly less least more always usually"
    " later soon first now already again still"
)
_FREQUENT_PAIRS = (["every", "day"], ["every", "week"], ["all", "day"], ["each", "day"], ["the", "most"], ["a", "lot"],
                   ["right", "away"], ["the", "least"], ["each", "morning"], ["every", "morning"], ["that", "week"],
                   ["this", "week"], ["every", "week"], ["that", "day"], ["that", "evening"])  # fmt: skip
"""Words that tell how often a thing is used, which are not about its place."""

_UNDER_OR_BEHIND = frozenset({"behind", "under", "underneath", "beneath", "between", "beside", "below", "next"})

_ATTENTION = word_set("wait listen look see mind sorry hang hold")
"""Words that ask for attention before a comma."""

_CALLS = {("hang", "on"), ("hold", "on"), ("listen", "up"), ("look", "here"), ("see", "here")}
"""Calls of two words."""

_CHOOSE = word_set("choose select pick click locate")

_CAUSATIVES = {"let": False, "have": False, "make": False, "ask": True, "allow": True, "get": True, "tell": True}
"""Commands that make something else do a thing, and whether *to* stands before its verb."""

_BEFORE_NOUNS = {("in", "two"), ("in", "half"), ("in", "first"), ("in", "last")}
"""Idioms, except before a noun: *in two bowls*."""

_APPROACHING = word_set("go walk turn head move drive navigate proceed run come roll fly step")

_LOOKING = word_set("look search check see watch")

_TURNING = word_set("turn flip roll tip fold hand bend knock")

_OTHER_END = {"left": "right", "right": "left", "top": "bottom", "bottom": "top", "front": "back", "back": "front"}
