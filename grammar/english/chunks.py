"""Cut the words of a sentence into chunks: noun phrases, verb groups, prepositions, joints.

A word can have several categories (*left*, *stand*, *that*); the words beside it decide. The chunks are the terminals
of ``english.lark``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

from deixis.grammar.english.known_nouns import KnownNouns
from deixis.grammar.english.nouns import PEOPLE, last_word
from deixis.grammar.english.phrases import NounChunker, is_known
from deixis.grammar.english.tokens import Word
from deixis.grammar.english.tree import Adjective, Degree, NounPhrase, Span
from deixis.grammar.english.words import (
    ADVERBS,
    CHAT_WORDS,
    DEGREE_ADVERBS,
    DIRECTION_WORDS,
    FACE_VERBS,
    FIND_VERBS,
    GREETINGS,
    HEDGES,
    IDIOMS,
    IS_FORMS,
    MODALS,
    NAMED_LIKE_THINGS,
    NEGATIONS,
    OTHER_UNITS,
    PLACE_NOUNS,
    PRONOUNS,
    PUT_VERBS,
    REPORTS,
    SAYING,
    UNITS,
    Preposition,
    is_adjective,
    places_alone,
    prepositions,
    verb_forms,
    word_set,
)

FINITE = frozenset({"BE", "VERB", "TVERB"})
PAST_ONLY = word_set(
    "stood lay sat went came began ran wore saw was were did had took gave knew fell rose"
    " wrote ate drank spoke broke drew threw flew grew sang swore"
)
SUBORDINATORS = word_set(
    "wherever if when while because since unless although though once so where whereas until whether whenever"
)
_PUNCTUATION = {
    ",": "COMMA", ";": "CUT", ":": "COLON", ".": "CUT", "!": "CUT", "?": "CUT", "(": "COMMA", ")": "COMMA",
    "[": "COMMA", "]": "COMMA", "\u2013": "CUT", "\u2014": "CUT", "-": "CUT", "/": "OR", "\u2026": "CUT",
}  # fmt: skip
_CONJUNCTIONS = {"and": "AND", "plus": "AND", "or": "OR", "nor": "OR", "but": "BUT", "yet": "BUT", "then": "THEN"}


@dataclass(slots=True)
class Chunk:
    """A terminal of the grammar: its type, the words from ``start`` to ``end`` and what was found in them."""

    type: str
    start: int
    end: int
    value: Any = None
    span: Span = (0, 0)


@dataclass(frozen=True, slots=True)
class VerbGroup:
    """A verb with its auxiliaries: *must not stand* has the lemma ``stand``, ``must`` and is not positive."""

    lemma: str
    kind: str
    form: str
    modal: str | None = None
    positive: bool = True
    past: bool = False
    adverbs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Relator:
    """A preposition or a place word with its adverbs: *slightly to the left of*, *second closest to*."""

    preposition: Preposition
    adverbs: tuple[str, ...] = ()
    rank: int | None = None
    positive: bool = True


@dataclass(slots=True)
class _Phrases:
    """Phrases of several words by their first word, longest first."""

    by_first: dict[str, list[tuple[tuple[str, ...], Preposition]]] = field(default_factory=dict)

    def longest(self, norms: list[str], at: int) -> tuple[int, Preposition] | None:
        for phrase, found in self.by_first.get(norms[at], ()):
            end = at + len(phrase)
            if tuple(norms[at:end]) == phrase:
                return end, found
        return None


def _phrases(table: dict[str, Preposition]) -> _Phrases:
    found = _Phrases()
    for phrase, entry in table.items():
        words = tuple(phrase.split())
        found.by_first.setdefault(words[0], []).append((words, entry))
    for entries in found.by_first.values():
        entries.sort(key=lambda entry: -len(entry[0]))
    return found


@cache
def _preposition_phrases() -> _Phrases:
    return _phrases(prepositions())


@cache
def _idioms() -> dict[str, list[tuple[str, ...]]]:
    found: dict[str, list[tuple[str, ...]]] = {}
    for phrase in sorted(IDIOMS, key=len, reverse=True):
        found.setdefault(phrase[0], []).append(phrase)
    return found


@cache
def _alone_phrases() -> _Phrases:
    return _phrases(places_alone())


class Chunker:
    """Chunker of the words of one sentence."""

    def __init__(self, words: list[Word], nouns: KnownNouns) -> None:
        self.words = words
        self.norms = [word.norm for word in words] + [""] * 12
        self.nouns = NounChunker(words, self.norms, nouns)
        self.chunks: list[Chunk] = []
        self._denied: str | None = None  # modal of a denial that stands before its subject
        self._denied_be: VerbGroup | None = None  # 'by no means is the cup …': *is* goes after the subject
        self._made: int | None = None  # index of the verb of 'let the ribbon hang …'
        self._relations, self._alone, self._verbs = _preposition_phrases(), _alone_phrases(), verb_forms()

    def run(self) -> list[Chunk]:
        """Return the chunks of the sentence; every word is in one of them.

        Returns
        -------
        list of Chunk
            Chunks in the order of the text.
        """
        at, end = 0, len(self.words)
        while at < end:
            chunk = self._chunk(at)
            chunk.span = self.words[at].start, self.words[chunk.end - 1].end
            if chunk.type == "GO":  # 'stand back': you stand back
                start = chunk.span[0]
                you = NounPhrase((start, start), pronoun="you")
                self.chunks.append(Chunk("NP", at, at, you, (start, start)))
                chunk.type = "VERB"
            self.chunks.append(chunk)
            at = chunk.end
            if self._denied_be is not None and chunk.type == "NP" and self.norms[at] not in ("of", "and", "or"):
                self.chunks.append(Chunk("BE", at, at, self._denied_be, (chunk.span[1], chunk.span[1])))
                self._denied_be = None
        return self.chunks

    def _previous(self) -> str:
        return self.chunks[-1].type if self.chunks else ""

    def _chunk(self, at: int) -> Chunk:
        norm = self.norms[at]
        fixed = _PUNCTUATION.get(norm)
        if fixed is not None:
            return Chunk(fixed, at, at + 1)
        if self.norms[at : at + 1] and (end := self._denial(at)) is not None:
            return Chunk("ADVERB", at, end, "never")
        if (verb := self._causative(at)) is not None:
            self._made = verb
            return Chunk("ADVERB", at, at + 1, norm)
        if self._made is not None and at >= self._made - (norm == "to"):
            verb, self._made = self._made, None
            form = self._verbs[self.norms[verb]]
            return Chunk("VERB", at, verb + 1, VerbGroup(form.lemma, form.kind, "s"))
        for find in (self._measure, self._idiom, self._joint, self._relator, self._verb_group, self._noun_phrase):
            chunk = find(at)
            if chunk is not None:
                return chunk
        if norm in NEGATIONS:
            return Chunk("NOT", at, at + 1)
        if norm in ADVERBS or norm in HEDGES or norm.endswith("ly"):
            return Chunk("ADVERB", at, at + 1, norm)
        return Chunk("UNKNOWN", at, at + 1, norm)

    def _causative(self, at: int) -> int | None:
        """Return the index of the verb of *let the ribbon hang …* and *ask an adult to stand …*; None for others."""
        needs_to = _CAUSATIVES.get(self.norms[at])
        if needs_to is None or self._previous() not in JOINT_TYPES | {"", "ADVERB"} or not self.nouns.starts(at + 1):
            return None
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
        for phrase in (*_DENIALS, *self._denied_circumstances(at)):
            end = at + len(phrase)
            if tuple(self.norms[at:end]) == phrase:
                if self.norms[end] in IS_FORMS and self.norms[end] != "'s" and self.nouns.starts(end + 1):
                    past = self.norms[end] in ("was", "were")
                    self._denied_be = VerbGroup("be", "be", "finite", positive=False, past=past)
                    return end + 1
                if self.norms[end] in MODALS or self.norms[end] in ("do", "does", "is", "are"):
                    self._denied = MODALS.get(self.norms[end], "must")
                    return end + 1
                if self._verbs.get(self.norms[end]) is not None:
                    self._denied = "must"
                    return end
        return None

    def _denied_circumstances(self, at: int) -> tuple[tuple[str, ...], ...]:
        """Return *under no pretext*: a preposition and a bare noun that *no* denies."""
        if self.norms[at + 1] != "no" or self.norms[at] not in ("under", "on", "at", "in", "by", "for", "to", "with"):
            return ()
        return tuple(tuple(self.norms[at : at + 2 + words]) for words in (1, 2))

    # joints and function words

    def _idiom(self, at: int) -> Chunk | None:
        norm = self.norms[at]
        previous_joint = self._previous() in ("", "COMMA", "AND", "BUT", "CUT", "ADVERB")
        for phrase in _idioms().get(norm, ()):
            end = at + len(phrase)
            if tuple(self.norms[at:end]) == phrase and not (
                (phrase in _BEFORE_NOUNS and self.nouns.starts(end))
                or (phrase == ("that", "is") and (self.norms[at - 1] != "," or self.norms[at + 2] in self._verbs))
                or (phrase == ("above", "all") and self.norms[end] != ",")
            ):
                return Chunk("ADVERB", at, end, " ".join(phrase))
        if norm == "from" or (
            norm in DIRECTION_WORDS and self.norms[at + 1] == "to" and self.norms[at + 2] in DIRECTION_WORDS
        ):
            order = self._order(at)
            if order is not None:
                return order
        told = self.norms[at + 1] in PUT_VERBS and self.nouns.starts(at + 2) and self._previous() in ("", "ADVERB")
        if norm in ("not", "no") and told and not self.nouns.is_noun(at + 1):
            return Chunk("PUT", at, at + 2, VerbGroup(self.norms[at + 1], "posture", "base", positive=False))
        goal = self._goal(at)
        if goal is not None:
            return Chunk("FIND", at, goal, VerbGroup(norm, "other", "base"))
        if norm == "welcome" and at == 0 and self.norms[1] in ("in", "to", "at"):
            end = next(i for i in range(1, len(self.norms)) if self.norms[i] in ("", ",", "!", ".", ":", ";"))
            return Chunk("ADVERB", at, end, norm)
        if self.nouns.number(at) is not None and self.norms[at + 1] in _LAYERS and self._previous() in ("PART", "ADV"):
            return Chunk("ADVERB", at, at + 2, "layers")  # 'stacked two high'
        ends = self.norms[at + 1] in prepositions() or self.norms[at + 1] in ("", ",", ".", "and")
        if norm in ("later", "earlier") and ends and self._previous() in FINITE | {"PART", "TPART", "NP"}:
            return Chunk("ADVERB", at, at + 1, norm)
        if norm == "in" and self.norms[at + 1] == "first" and self.norms[at + 2] in ("", ",", ".", ";"):
            return Chunk("ADVERB", at, at + 2, "in first")
        if (
            norm in ("in", "over", "up", "down")
            and self._previous() in FINITE
            and self.norms[at + 1] in _UNDER_OR_BEHIND
        ):
            return Chunk("ADVERB", at, at + 1, norm)  # 'it slides in behind the shelf'
        if norm == "set" and self.norms[at + 1] == "up" and self._previous() in FINITE:
            return Chunk("ADVERB", at, at + 2, "set up")
        if norm == "in" and self.norms[at + 1 : at + 3] == ["order", "of"]:
            return Chunk("ADVERB", at, min(at + 4, len(self.words)), "in order")
        if (
            self.norms[at + 1] == "side"
            and self.norms[at + 2] in ("up", "down", "out", "in", "outwards", "inwards")
            and self._previous() in ("COMMA", "NP")
            and self.norms[at + 3] in _CLAUSE_ENDS | {"and", "on", "in"}
        ):
            return Chunk("ADVERB", at, at + 3, "side up")  # 'lay the sheet on the mat, shiny side down'
        if norm in ("itself", "themselves") and self._previous() == "NP":
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
            if self.norms[end] in ("reach", "sight", "way", "place", "order"):
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
        orders = norm == "be" and self._previous() in JOINT_TYPES | {""} and self.norms[at + 2] in _CLAUSE_ENDS
        if orders and self.norms[at + 1] not in self._verbs and not is_adjective(self.norms[at + 1]):
            return Chunk("DO", at, at + 1, VerbGroup("be", "other", "base"))  # 'be polite'
        if norm in ("both", "all", "each") and self._previous() == "BE" and not self.nouns.starts(at + 1):
            return Chunk("ADVERB", at, at + 1, norm)
        if (
            norm == "to"
            and self.norms[at + 1] in PUT_VERBS
            and self._previous()
            and self.nouns.starts(at + 2)
            and (self.nouns.is_determiner(at + 2) or self.norms[at + 2] in ("it", "them"))
        ):
            denied = any(word in NEGATIONS or word in _FORBIDDING for word in self.norms[:at])
            modal = None if denied or self._is_told_to(at) else "might"
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
                return Chunk("CUT" if alone and not placed else "ADVERB", at, wished, "you want")
        if norm in CHAT_WORDS and self.norms[at + 1] in ("", ",", ".", ":", "!", "?", ";"):
            return Chunk("ADVERB", at, at + 1, norm)
        if norm == "like" and self._previous() in ("BE", "TVERB") and self.nouns.number(at + 1) is not None:
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

    def _is_told_to(self, at: int) -> bool:
        """Return True if the words before an infinitive make it a command: *remember to put*, not *afraid to put*."""
        i = at - 1
        while i > 0 and (self.norms[i] in ADVERBS or self.norms[i] in HEDGES):
            i -= 1
        if self.norms[i] in _GOVERNORS:
            return True
        first = next((k for k in range(len(self.chunks) - 1, -1, -1) if self.chunks[k].type in JOINT_TYPES), -1)
        if self._previous() == "NP" and any(c.type in ("PUT", "DO", "FIND") for c in self.chunks[first + 1 :]):
            return True  # 'take the cup to put it on the tray'
        joined = self.norms[i] in ("and", "then", ",", "or")
        return joined and not _GOVERNORS.isdisjoint(self.norms[:i])

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
        """Return the end of *you want (to pick)*, *you are looking for*: such words say nothing of places."""
        i = at + (self.norms[at] == "that")
        if self.norms[i] not in ("you", "we", "i"):
            return None
        i += 1
        while self.norms[i] in ADVERBS or self.norms[i] in ("'ll", "will", "would", "'d", "should", "must"):
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
        wants = self.norms[i] in ("want", "need", "have", "like") and not (
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

    def _joint(self, at: int) -> Chunk | None:
        norm, after = self.norms[at], self.norms[at + 1]
        previous = self._previous()
        before = self.chunks[-2].type if len(self.chunks) > 1 else ""
        told = previous in FINITE or previous == "DO" or (previous in ("PART", "ADJP") and before == "BE")
        told = told or (previous in ("ADV", "ADVERB") and before in ("VERB", "TVERB"))
        if norm == "that" and told and (after in PRONOUNS or self.nouns.starts(at + 1)):
            return Chunk("COMPLEMENT", at, at + 1)
        if norm == "that" and previous in ("NP", "COMMA", "ADV", "AND") and not self._demonstrative(at):
            return Chunk("REL", at, at + 1)
        follows_noun = previous == "NP" or (previous in ("COMMA", "ADV") and norm != "where")
        if norm in ("which", "who", "whom", "where") and follows_noun and at > 0:
            return Chunk("REL", at, at + 1)
        if (norm == "unlike" and not previous) or (
            not previous and (norm, after) in (("instead", "of"), ("rather", "than"))
        ):
            return Chunk("SUB", at, at + (1 if norm == "unlike" else 2), "instead")
        if norm == "that" and previous == "PREP" and (self.nouns.is_determiner(at + 1) or after in ("", ",", ".", ";")):
            return Chunk("NP", at, at + 1, NounPhrase((self.words[at].start, self.words[at].end), pronoun="this"))
        if norm == "whose":
            return Chunk("WHOSE", at, at + 1)
        if norm in ("where", "how", "why") or (norm == "when" and after in IS_FORMS):
            return Chunk(
                "WHERE" if norm == "where" and (after in IS_FORMS or after in MODALS) else "SUB", at, at + 1, norm
            )
        if norm == "there" and (
            after in IS_FORMS
            or (after == "used" and self.norms[at + 2] == "to")
            or after in ("'ll", "should", "must", "will", "can", "may", "might", "shall")
            or (previous in FINITE and at == 1)
        ):
            return Chunk("THERE", at, at + 1)
        if norm == "out" and after == "of" and previous in ("", "COMMA", "ADVERB", "CUT"):
            return Chunk("PREP", at, at + 2, Relator(Preposition("out of", "among")))
        if (
            norm in ("to", "against", "toward", "towards")
            and previous == "BE"
            and len(self.chunks) > 1
            and self._is_back(self.chunks[-2])
        ):
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "back_to")))
        directed = bool({self.norms[at + 1], self.norms[at + 2], self.norms[at + 3]} & _LATERAL)
        if norm in ("from", "to") and previous == "MEASURE" and self.nouns.starts(at + 1) and not directed:
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "measured_from")))
        if norm == "to" and previous == "THAN":
            return Chunk("ADVERB", at, at + 1, norm)
        if norm in ("neither", "either", "both") and (after in prepositions() or self._match(at + 1)):
            return Chunk("NOT" if norm == "neither" else "ADVERB", at, at + 1, norm)
        if norm == "of":
            if previous == "MEASURE":
                return Chunk("PREP", at, at + 1, Relator(Preposition("of", "measured_from")))
            if previous in ("", "COMMA", "CUT") or (previous == "ADVERB" and len(self.chunks) == 1):
                return Chunk("PREP", at, at + 1, Relator(Preposition("of", "among")))
            return Chunk("OF", at, at + 1)
        if norm == "in" and self.nouns.is_colour_alone(at + 1):
            return Chunk("ADVERB", at, at + 1, "in")
        if (
            norm == "as"
            and previous == "NP"
            and (
                self.chunks[-1].value.determiner == "same"
                or any(a.word == "same" for a in self.chunks[-1].value.adjectives)
            )
        ):
            return Chunk("PREP", at, at + 1, Relator(Preposition("as", "as")))
        if norm == "than":
            return Chunk("THAN", at, at + 1)
        form = self._verbs.get(after)
        told = form is not None and form.form in ("past", "participle") and previous in ("COMMA", "")
        if norm == "as" and told and self.norms[at + 2] not in IS_FORMS:
            return Chunk("ADVERB", at, at + 2, "as told")  # 'as left on Friday'
        if norm == "as" and after in ("you", "if", "seen", "viewed", "one", "i", "we"):
            return Chunk("SUB", at, at + 1, "as")
        excepting = previous == "NP" and self.chunks[-1].value.pronoun in _ALL
        about = (
            norm == "about"
            and previous in ("BE", "NP")
            and self.nouns.starts(at + 1)
            and self.nouns.number(at + 1) is None
        )
        if norm == "about" and previous == "PART" and self.nouns.starts(at + 1):
            return Chunk("PREP", at, at + 1, Relator(Preposition("about", "around")))  # 'scattered about it'
        if (norm == "but" and excepting) or about:
            return Chunk("PREP", at, at + 1, Relator(Preposition(norm, "-")))
        if norm in _CONJUNCTIONS:
            return Chunk(_CONJUNCTIONS[norm], at, at + 1, norm)
        if tuple(self.norms[at : at + 3]) in _SUBORDINATING:
            return Chunk("SUB", at, at + 3, "when")
        if (norm, after) == ("except", "that"):
            return Chunk("CUT", at, at + 2)
        if tuple(self.norms[at : at + 2]) in _SUBORDINATING:
            return Chunk("SUB", at, at + 2, "if")
        if at == 0 and norm in ("suppose", "assume", "imagine") and any(word in IS_FORMS for word in self.norms):
            return Chunk("SUB", at, at + 1 + (after == "that"), "if")
        if at == 0 and norm == "let" and "be" in self.norms:
            return Chunk("ADVERB", at, at + 1, norm)
        if norm == "cause" and (after in PRONOUNS or after in ("there", "theres")):
            return Chunk("SUB", at, at + 1, "because")
        if norm == "so" and previous in FINITE and (is_adjective(after) or self._match(at + 1) is not None):
            return None  # 'stood so close to it'
        if norm == "otherwise" and previous == "SUB":
            return Chunk("ADVERB", at, at + 1, norm)  # 'because otherwise it falls'
        if norm in _WHOEVER:
            return Chunk("SUB", at, at + 1, "if")
        if norm in SUBORDINATORS:
            return Chunk("SUB", at, at + 1, norm)
        if norm in ("before", "after") and (
            after in ("you", "we", "i") or after.endswith("ing") or self._clause_follows(at + 1)
        ):
            return Chunk("SUB", at, at + 1, norm)
        return None

    def _clause_follows(self, at: int) -> bool:
        """Return True if a noun phrase with a verb after it begins here: *before the guests enter*."""
        found = self.nouns.phrase(at, "SUB") if self.nouns.starts(at) else None
        if found is None or found[1] is None:
            return False
        norm = self.norms[found[0]]
        form = self._verbs.get(norm)
        return (
            norm in IS_FORMS
            or norm in MODALS
            or (form is not None and form.form in ("s", "past", "base") and norm not in ("left", "set"))
        )

    def _is_back(self, chunk: Chunk) -> bool:
        """Return True for *your back*."""
        return chunk.type == "NP" and chunk.value.head == "back" and chunk.value.owner is not None

    def _demonstrative(self, at: int) -> bool:
        """Return True if *that* stands for a thing or before a noun, and does not begin a relative clause."""
        if self._previous() in ("NP", "ADV"):
            return False
        after = self.norms[at + 1]
        return self._previous() == "AND" and after in IS_FORMS

    def _measure(self, at: int) -> Chunk | None:
        number = self.nouns.number(at)
        i, hedge, bound = at, None, None
        while number is None and self.norms[i] in _MEASURE_WORDS:
            if (spoken := self._spoken_length(i)) is not None:
                break
            if self.norms[i] in _BOUNDS:
                bound = _BOUNDS[self.norms[i]]
                if i > at and self.norms[i - 1] in ("no", "not"):
                    bound = "<" if bound == ">" else ">"
            elif self.norms[i] in HEDGES:
                hedge = self.norms[i]
            i += 1
            number = self.nouns.number(i)
        spoken = self._spoken_length(i)
        if spoken is not None:
            end, metres = spoken
            if self.norms[end] in ("away", "apart") and self.norms[end + 1] != "from":
                end += 1
            return Chunk("MEASURE", at, end, (metres, hedge or "about", bound))
        if number is None:
            attached = _ATTACHED_UNIT(self.norms[i])
            if attached is None:
                return None
            return Chunk("MEASURE", at, i + 1, (attached, hedge, bound))
        unit = self.norms[i + 1]
        if unit in OTHER_UNITS:
            return Chunk("ADVERB", at, i + 2 + (self.norms[i + 2] in ("old", "long", "ago", "heavy")), "quantity")
        if unit == "a" and self.norms[i + 2] == "half":
            unit = self.norms[i + 2]
        scale = UNITS.get(unit) or (UNITS.get(unit[:-1]) if unit.endswith("s") else None)
        if scale is None or (unit in ("hand", "finger", "foot", "m") and self.norms[i + 2] in IS_FORMS):
            return None
        end = i + 2
        if (self.norms[end] == "of" and bound is None) or self.norms[end] in (
            "tall",
            "long",
            "wide",
            "high",
            "thick",
            "deep",
        ):
            return None
        if self.norms[end] in ("away", "apart") and self.norms[end + 1] != "from":
            end += 1
        return Chunk("MEASURE", at, end, (number * scale, hedge, bound))

    def _spoken_length(self, at: int) -> tuple[int, float] | None:
        """Return the end and the metres of *a hand's width*, *half a metre*, *an inch*, *a few centimetres*."""
        i, times = at, 1.0
        if self.norms[i] == "half" and self.norms[i + 1] in ("a", "an"):
            times, i = 0.5, i + 2
        elif self.norms[i] in ("a", "an") and self.norms[i + 1] in ("few", "couple"):
            times, i = 3.0 if self.norms[i + 1] == "few" else 2.0, i + 2
            i += self.norms[i] == "of"
        elif self.norms[i] in ("a", "an", "one"):
            i += 1
        else:
            return None
        unit = self.norms[i]
        scale = UNITS.get(unit) or (UNITS.get(unit[:-1]) if unit.endswith("s") else None)
        if scale is None or unit == "m":
            return None
        end = i + 1
        if self.norms[end] in ("'s", "s") and self.norms[end + 1] in _BREADTHS:
            end += 2
        elif self.norms[end] in _BREADTHS:
            end += 1
        elif unit in _BODY:
            return None
        follows = self._match(end) is not None or self.norms[end] in ("away", "apart", "from", "", ",", ".", "or")
        return (end, times * scale) if follows and self.norms[end] != "of" else None

    def _relator(self, at: int) -> Chunk | None:
        i, adverbs, positive, rank = at, [], True, None
        if self.norms[i] == "nowhere" or tuple(self.norms[i : i + 2]) == ("anything", "but"):
            positive, i = False, i + 1 + (self.norms[i] == "anything")
        if self.norms[i] == "not" and i + 1 < len(self.words):
            positive, i = False, i + 1
        if self.norms[i] == "a" and self.norms[i + 1] in ("bit", "little"):
            adverbs.append("slightly")
            i += 2
        if self.norms[i] == "as" and self.norms[i + 1] in ("close", "far", "near"):
            adverbs.append("as")
            i += 1
        while (self.norms[i] in DEGREE_ADVERBS or self.norms[i] in HEDGES or self.norms[i] == "the") and i - at < 4:
            if self._relations.by_first.get(self.norms[i]) and self._match(i) is not None:
                break
            if self.norms[i] == "the" and self.nouns.is_degree_word(i + 1) is False:
                return None
            if self.norms[i] != "the":
                adverbs.append(self.norms[i])
            i += 1
        if adverbs[:1] == ["as"] and "as" in self.norms[i + 1 :] and "possible" not in self.norms[i + 1 :]:
            return None  # 'as far from the bowl as from the jar'
        ranked = self.nouns.ordinal(i)
        if ranked is not None and self.nouns.is_degree_word(i + 1):
            rank, i = ranked, i + 1
        found = self._match(i)
        if found is None:
            return None
        end, kind, preposition = found
        if preposition.degree is not Degree.PLAIN and end == i + 1 and self.norms[end] in ("one", "ones"):
            return None  # 'the closest one to you'
        if self.norms[at] == "the" and (kind == "ADV" or preposition.degree is Degree.PLAIN):
            return None
        if preposition.relation == "without":
            preposition, positive, kind = prepositions()["with"], not positive, "WITH"
        elif preposition.relation == "with":
            kind = "WITH"
        return Chunk(kind, at, end, Relator(preposition, tuple(adverbs), rank, positive))

    def _match(self, at: int) -> tuple[int, str, Preposition] | None:
        """Return the end, the type and the relation of the longest phrase that the words after it allow."""
        if self.norms[at] in ("left", "right", "close", "next", "near", "closest", "nearest", "closer") and (
            self._previous() not in ("NP",)
            and self.nouns.starts(at)
            and self.nouns.adjective_before_noun(at)
            and self.norms[at + 1] not in ("to", "of", "by")
        ):
            return None
        begins = self._previous() in JOINT_TYPES | {"", "ADVERB"}
        if self.norms[at] == "close" and begins and self.nouns.is_determiner(at + 1):
            return None  # 'close the lid'
        alone = self._alone.longest(self.norms, at)
        if alone is not None and alone[1].phrase.startswith("far ") and PLACE_NOUNS.get(self.norms[alone[0]]) in _SPOTS:
            alone = None  # 'far left corner'
        if alone is not None and self.norms[alone[0] - 1] == "own" and self.nouns.is_noun(alone[0]):
            alone = None  # 'on its own saucer'
        found = self._relations.longest(self.norms, at)
        if self.norms[at] == "round" and not (self.nouns.is_determiner(at + 1) or self.norms[at + 1] in ("it", "them")):
            return None
        if self.norms[at] == "left" and (self._leaves(at) or self._is_left_behind(at)):
            return None
        if found is not None:
            end, preposition = found
            if preposition.relation == "from" and self.norms[end] == "where":
                return None
            if (
                preposition.relation in ("facing", "pointing")
                and self.norms[end] in _AIMS
                and not self.nouns.adjective_before_noun(end)
            ):
                return None
            ends_open = end == at + 1 or self.norms[end - 1] == "away"
            if preposition.degree is not Degree.PLAIN and ends_open and not self._object_of_degree(at, end):
                return None
            takes_object = self.nouns.starts(end) or self.norms[end] == "which"
            takes_object = takes_object or (self.norms[end] == "that" and self.nouns.is_determiner(end + 1))
            if self.norms[at] == "to" and end == at + 1 and self._infinitive(end):
                return None
            shorter_alone = (
                alone is None
                or alone[0] < end
                or (
                    alone[0] == end
                    and (self._previous() == "NP" or alone[1].relation != "there" or not self._begins_clause(end))
                )
            )
            if takes_object and shorter_alone:
                return end, "PREP", preposition
            if alone is None or alone[0] < end:
                if takes_object or preposition.relation in ("-",):
                    return (end, "PREP", preposition) if takes_object else None
                shorter = self._alone.longest(self.norms, at)
                stranded = any(chunk.type == "REL" for chunk in self.chunks) or self.norms[end] in ("and", "or", ",")
                stands_alone = end > at + 1 or self.norms[at] in ("near", "against", "beneath", "alongside", "beside")
                if (
                    shorter is None
                    and preposition.relation not in ("from", "to", "with", "without", "at", "facing")
                    and (stranded or stands_alone)
                ):
                    return end, "ADV", preposition
        if self.norms[at] in ("in", "out", "inward", "inwards", "outward", "outwards"):
            last = self.chunks[-1].value if self.chunks else None
            if isinstance(last, VerbGroup) and last.kind in ("face", "point") and self.norms[at + 1] in _CLAUSE_ENDS:
                return at + 1, "ADV", places_alone()["inward" if self.norms[at][0] == "i" else "outward"]
            if alone is not None and alone[1].relation in ("inward", "outward"):
                return None
        if alone is not None:
            if (
                self.norms[at] in ("left", "right")
                and self.norms[alone[0]] in ("in", "on", "behind", "next", "above", "below", "under", "beside", "there")
                and self.norms[at] == "right"
            ):
                return None  # an adverb: 'right behind'
            if alone[1].relation in ("up", "down") and self.norms[alone[0]] in ("and", "or"):
                return alone[0], "ADV", places_alone()["above" if alone[1].relation == "up" else "below"]
            if alone[1].relation in ("up", "down", "forward", "backward"):
                last = self.chunks[-1] if self.chunks else None
                aims = last is not None and isinstance(last.value, VerbGroup) and last.value.kind in ("face", "point")
                ends = self.norms[alone[0]] in ("", ",", ".", ";", "and")
                if not aims and not (self._previous() == "NP" and ends):
                    return None
            if alone[1].relation == "there" and self._previous() not in FINITE | {"ADV", "ADVERB", "NP", "PART"}:
                return None
            return alone[0], "ADV", alone[1]
        return None

    def _object_of_degree(self, at: int, end: int) -> bool:
        """Return True for *nearest the door* and *chair nearest door*, and False for *the nearest chair*."""
        if self.nouns.is_determiner(end) or self.norms[end] in PRONOUNS:
            return True
        if not self.nouns.starts(end):
            return self._alone.longest(self.norms, at) is not None
        return (
            self.norms[at - 1] != "the"
            and self._previous() in ("NP", "BE", "REL", "VERB", "ADV", "PART", "ADJP")
            and (not self.nouns.is_determiner(at - 1))
        )

    def _is_left_behind(self, at: int) -> bool:
        """Return True for the participle of *leave*: *the glass left on the table*, *must not be left on it*."""
        placed = ("on", "in", "inside", "at", "by", "lying", "standing", "along", "against", "under", "beneath")
        return self.norms[at + 1] in placed and (
            self._previous() == "BE" or (self._previous() == "NP" and self.nouns.starts(at + 2))
        )

    def _leaves(self, at: int) -> bool:
        """Return True for the past of *leave*: *the guests left the table*."""
        return (
            self.norms[at] == "left"
            and self._previous() == "NP"
            and (self.nouns.is_determiner(at + 1) or self.norms[at + 1] in ("it", "them"))
            and self.norms[at + 1] not in ("that", "which")
            and (at < 2 or self.norms[at - 1] not in DIRECTION_WORDS)
        )

    def _infinitive(self, at: int) -> bool:
        verb = self._verbs.get(self.norms[at])
        after = self.norms[at + 1]
        return self.norms[at] == "be" or (
            verb is not None
            and verb.form == "base"
            and self.norms[at] not in _NOUNS_TOO
            and (self.nouns.starts(at + 1) or after in ("", ".", ",", "on", "in"))
        )

    def _begins_clause(self, at: int) -> bool:
        """Return True for a subject pronoun before a finite verb: 'over there it is'."""
        return self.norms[at] in ("it", "they", "there", "you", "i", "we") and (
            self.norms[at + 1] in IS_FORMS or self.norms[at + 1] in MODALS
        )

    # verbs

    def _verb_group(self, at: int) -> Chunk | None:
        if self._denied is not None and self._previous() in ("NP", "ADVERB"):
            return self._denied_verb(at)
        i, adverbs, modal, positive, past = at, [], None, True, False
        while (self.norms[i] in ADVERBS | HEDGES and self.norms[i] != "about") or self.norms[i] == "never":
            if self.norms[i] == "never":
                positive = False
            else:
                adverbs.append(self.norms[i])
            i += 1
            if i - at > 3:
                return None
        if self.norms[i] == "used" and self.norms[i + 1] == "to" and self._infinitive(i + 2):
            past, i = True, i + 2
        if (
            i > at
            and not past
            and not self._auxiliary(i)
            and self.norms[i] not in ("seems", "appears")
            and (self.norms[i] not in self._verbs or (self.nouns.is_noun(i) and not self._orders(i)))
        ):
            return None
        if self.norms[at] in ("both", "all", "each", "either") and self._previous() != "NP":
            return None
        first = i
        verb = None
        while True:
            norm = self.norms[i]
            if norm == "may" and self.norms[i + 1 : i + 4] == ["or", "may", "not"]:
                modal, i = "may", i + 3
            elif norm in MODALS and (i == first or modal is None) and self._modal(i):
                modal = MODALS[norm]
                if norm == "need" or norm == "needs" or norm == "ought":
                    i += self.norms[i + 1] == "to"
            elif norm in ("do", "does", "did") and self._auxiliary(i):
                past = past or norm == "did"
            elif (norm == "no" and self.norms[i + 1] in ("longer", "more") and i > first) or (
                tuple(self.norms[i : i + 3]) in (("by", "no", "means"), ("in", "no", "way")) and i > first
            ):
                positive, i = False, i + (1 if norm == "no" else 2)
            elif norm == "under" and tuple(self.norms[i + 1 : i + 3]) == ("no", "circumstances"):
                positive, i = False, i + 2
            elif norm in NEGATIONS and i > first:
                positive = not positive if norm != "nor" else positive
            elif i > first and (
                ((norm in ADVERBS or norm in HEDGES) and self._goes_on(i + 1))
                or (verb == "be" and norm in HEDGES and norm not in _HEDGES_OF_PLACES)
            ):
                adverbs.append(norm)
            elif norm in ("has", "have", "had", "having", "'ve") and self._perfect(i):
                past = past or norm == "had" or modal in _UNREAL
            elif norm in ("seems", "seem", "appears", "appear", "seemed", "appeared") and self.norms[i + 1 : i + 3] == [
                "to",
                "be",
            ]:
                adverbs.append("apparently")
                i += 1
            elif norm == "to" and i > first and self.norms[i + 1] in ("be", "stand", "go", "have"):
                modal = "should" if verb == "be" and modal is None else modal
            elif norm == "to" and i > first and verb == "be" and self._is_base(i + 1):
                modal, verb = "should", None  # 'it is to stand on the box'
            elif norm == "used" and self.norms[i + 1] == "to":
                past = True
                i += 1
            elif norm in ("has", "have", "had") and self.norms[i + 1] == "to" and self._is_base(i + 2):
                modal, i = "have to", i + 1
            elif norm in _TENDING and self.norms[i + 1] == "to" and self._is_base(i + 2):
                modal, verb, i = _TENDING[norm], None if self.norms[i + 2] != "be" else verb, i + 1
            elif norm in IS_FORMS and not (norm == "'s" and self.nouns.is_genitive(i)):
                verb, past = "be", past or norm in ("was", "were")
            else:
                break
            i += 1
        if verb == "be" and self.norms[i] == "got" and self.nouns.starts(i + 1):
            return Chunk(
                "TVERB", at, i + 1, VerbGroup("have", "transitive", "s", modal, positive, past, tuple(adverbs))
            )
        if verb == "be":
            return Chunk("BE", at, i, VerbGroup("be", "be", "finite", modal, positive, past, tuple(adverbs)))
        return self._lexical(at, first, i, VerbGroup("", "", "", modal, positive, past, tuple(adverbs)))

    def _is_base(self, at: int) -> bool:
        form = self._verbs.get(self.norms[at])
        return self.norms[at] == "be" or (form is not None and form.form == "base")

    def _denied_verb(self, at: int) -> Chunk | None:
        """Return the verb of a clause whose denial and modal verb stand before its subject."""
        i = at + (self.norms[at] == "be")
        form = self._verbs.get(self.norms[i])
        command = self._previous() == "ADVERB"
        if command and form is not None and self.norms[at] in _GOING and self._goes(at + 1):
            self._denied = None
            return Chunk("GO", at, at + 1, VerbGroup(form.lemma, form.kind, form.form, None, False))
        if self.norms[at] == "be" and (form is None or self.norms[i] in prepositions()):
            modal, self._denied = self._denied, None
            return Chunk("BE", at, i, VerbGroup("be", "be", "finite", modal, False))
        if form is None or (i == at and form.form not in ("base", "ing") and self._previous() != "NP"):
            return None
        if not command and form.form == "base" and self.nouns.is_noun(i) and not self._predicate_after(i):
            return None
        modal, self._denied = self._denied, None
        if self.norms[at] == "be":
            return Chunk("BE", at, i, VerbGroup("be", "be", "finite", modal, False))
        group = VerbGroup(form.lemma, form.kind, form.form, None if command else modal, False)
        return Chunk("PUT", at, i + 1, group) if command else self._finite(at, i + 1, group)

    def _predicate_after(self, at: int) -> bool:
        return self.norms[at + 1] in prepositions() or self.norms[at + 1] in places_alone()

    def _lexical(self, at: int, first: int, i: int, group: VerbGroup) -> Chunk | None:
        norm = self.norms[i]
        form = self._verbs.get(norm)
        helped = i > first
        told = self.norms[i + 1] == "that" or (norm in SAYING and self.norms[i + 1] in _TOLD)
        if norm in REPORTS | SAYING and told and self._previous() == "NP":
            return Chunk(
                "COMPLEMENT",
                at,
                i + 1 + (self.norms[i + 1] == "that"),
                replace(_with(group, norm, "other", "s"), modal="might"),
            )
        if helped and (form is None or form.form not in ("base",)) and group.modal is None and not group.past:
            form = form if form is not None and form.form in ("base", "past", "participle") else None
            if form is None and self.norms[first] in ("has", "have", "had", "'ve", "having") and norm.endswith("ed"):
                return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "past"))
            if form is None:
                if self.norms[first] == "do" and not self._previous() and self.nouns.is_determiner(i + 1):
                    return Chunk("DO", at, i + 1, _with(group, norm, "unknown", "base"))  # 'do not tighten the screws'
                return (
                    Chunk("VERB", at, i, _with(group, "do", "other", "s"))
                    if self.norms[first] in ("do", "does")
                    else None
                )
        if (
            form is None
            and not helped
            and norm.endswith("s")
            and self.nouns.is_determiner(i + 1)
            and self._only_places()
        ):
            return Chunk("VERB", at, i + 1, _with(group, norm, "posture", "s"))  # 'behind it rises a goblet'
        if form is None:
            if helped and group.modal is not None:  # 'the cup can', 'you should blarp'
                return Chunk("BE", at, i, _with(group, "be", "be", "finite"))
            if (
                self._previous() == "REL"
                and norm.endswith("s")
                and len(norm) > 3
                and (self.nouns.is_determiner(i + 1) or self.norms[i + 1] in prepositions())
            ):
                return Chunk(
                    "TVERB" if self.nouns.starts(i + 1) else "VERB", at, i + 1, _with(group, norm, "unknown", "s")
                )
            alone = self._previous() == "NP" and self.norms[self.chunks[-1].start : at] in _THIRD_PERSONS
            if alone and i == at and norm.endswith("s") and len(norm) > 3 and norm.isalpha() and norm not in PRONOUNS:
                return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "s"))
            if self._previous() == "NP" and i == at and self.nouns.ends_as_verb(at):
                return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "s"))
            return self._unknown_participle(at, i, group)
        found = _with(group, form.lemma, form.kind, form.form)
        end = i + 1
        if form.kind == "posture" and self.norms[end] in _PARTICLES and self.nouns.is_determiner(end + 1):
            end += group.past or self.norms[i - 1] in ("have", "has", "had", "'ve")
        phrasal = _PHRASAL.get((form.lemma, self.norms[end]))
        if phrasal is not None:
            found, end = _with(group, *phrasal, form.form), end + 1
            return Chunk("TVERB" if self.nouns.starts(end) else "VERB", at, end, found)
        if not helped and self._inverts(form.form, i):
            return Chunk("ADVERB", at, end, norm)
        if helped:
            if self.norms[first] == "do" and self._previous() in JOINT_TYPES | {"", "ADVERB"}:
                kind = "FIND" if norm in FIND_VERBS else "PUT" if norm in PUT_VERBS or form.kind == "posture" else "DO"
                return Chunk(kind, at, end, found)
            return self._finite(at, end, found)
        if norm == "left" and helped and self.nouns.is_determiner(end):
            return Chunk("TVERB", at, end, _with(group, "leave", "posture", "past"))
        if norm == "left" and self._is_left_behind(i):
            return Chunk("PART", at, end, found)
        if norm == "left" and not self._leaves(i):
            return None
        if norm == "left":
            return Chunk("TVERB", at, end, _with(group, "leave", "posture", "past", past=True))
        if (
            norm in ("lay", "put", "set")
            and self._previous() in ("", "AND", "COMMA", "THEN", "CUT")
            and (
                self.nouns.is_determiner(end)
                or self.nouns.number(end) is not None
                or self.norms[end] in ("it", "them", "out", "down", "up")
                or (not self._previous() and self.nouns.is_noun(end))
            )
        ):
            end += self.norms[end] in ("out", "down", "up")
            return Chunk("PUT", at, end, _with(group, norm, "posture", "base"))
        if (
            norm in _BEGINNING
            and self.norms[end] in ("with", "by")
            and self._previous() in JOINT_TYPES | {"", "ADVERB"}
        ):
            return Chunk("DO", at, end + 1, found)
        if norm in PAST_ONLY:
            return self._finite(at, end, _with(group, form.lemma, form.kind, "past", past=True))
        if norm == "chose" and self._previous() in ("", "COMMA", "AND", "CUT") and self.nouns.is_determiner(end):
            return Chunk("FIND", at, end, found)
        if form.form == "past" and form.kind in ("posture", "lean") and self._previous() == "NP" and not helped:
            subject = self.chunks[-1].value
            if subject.pronoun in ("me", "we", "he", "she") and not subject.head and self.nouns.starts(end):
                return self._finite(at, end, found)  # 'I hung the mirror on the pole'
        subject = self.chunks[-1].value if self._previous() == "NP" else None
        person = subject is not None and last_word(subject.head) in PEOPLE and self.nouns.is_determiner(end)
        handled = person or self.norms[end] in ("it", "them", "him", "us")
        owned = handled and form.form == "past" and subject is not None
        if owned or (
            form.form == "past" and self._previous() == "NP" and self.norms[self.chunks[-1].start] in _SUBJECTS
        ):
            return self._finite(at, end, found)  # 'the cups you asked about'
        if form.form in ("past", "participle", "ing"):
            if self._previous() in ("PREP", "OF", "WITH", "THAN", "TVERB", "FIND", "PUT") and self.nouns.is_noun(end):
                return None
            named = self.nouns.is_noun(end) and self.norms[end + 1] in IS_FORMS
            if (
                self._previous() in ("", "COMMA")
                and form.form == "past"
                and named
                and not self.nouns.is_determiner(end)
            ):
                return None  # 'finished pieces are on it'
            if not self._previous() and form.form == "past" and is_adjective(norm) and self.nouns.is_noun(end):
                return None  # 'used tea bags'
            if norm in ("lay", "put", "set") and self._previous() in ("", "AND", "COMMA", "THEN", "ADVERB", "CUT"):
                return Chunk("PUT", at, end, found)
            if self.nouns.is_noun(i) and self._previous() != "NP":
                return None
            end += self.norms[end] in ("back", "out", "up", "down") and self._measure(end + 1) is not None
            return Chunk("TPART" if self._takes_object(form.kind, end) else "PART", at, end, found)
        if norm in ("set", "put") and self._previous() == "BE":
            return Chunk("PART", at, end, found)
        if form.form == "base":
            subject = self._previous()
            subject_is_you = subject == "NP" and self.norms[self.chunks[-1].start] == "you"
            if (
                norm in FIND_VERBS
                and norm in ("choose", "select", "pick", "find", "click", "locate", "hit")
                and subject == "NP"
                and (self.nouns.is_determiner(end) and not self.chunks[-1].value.plural)
            ):
                return Chunk("FIND", at, end, found)
            imperative = subject in ("", "AND", "COMMA", "THEN", "ADVERB", "CUT", "COLON", "SUB", "BUT") or (
                subject_is_you
            )
            imperative = imperative or (norm in PUT_VERBS and self.nouns.is_determiner(end) and self._only_places())
            imperative = imperative or (subject == "OR" and norm in PUT_VERBS and self.norms[end] in ("it", "them"))
            if imperative and norm in FIND_VERBS and self.norms[end] == "and" and self.norms[end + 1] in FIND_VERBS:
                return Chunk("ADVERB", at, end + 1, norm)
            starts = norm in ("start", "begin") and self.norms[end] in ("at", "in", "on") and not self._previous()
            if starts:
                return Chunk("GO", at, end, found)  # 'start at the back'
            if imperative and not subject_is_you and norm in _GOING and self._goes(end):
                end += self.norms[end] in ("back", "away", "aside", "here")
                return Chunk("GO", at, end, found)
            if imperative and not subject_is_you and norm in NAMED_LIKE_THINGS and not self.nouns.commands(i):
                return None
            if imperative and (norm in PUT_VERBS or norm in FIND_VERBS) and self._imperative_object(end):
                kind = "FIND" if norm in FIND_VERBS else "PUT"
                if norm in ("pick", "point", "look", "single", "search") and self.norms[end] in (
                    "out",
                    "for",
                    "to",
                    "up",
                ):
                    end += 1
                if norm == "turn" and self.norms[end] in ("on", "off"):
                    return Chunk("DO", at, end + 1, found)
                if (
                    kind == "PUT"
                    and self.norms[end] in ("out", "up", "down", "back", "away")
                    and self.nouns.starts(end + 1)
                ):
                    end += 1
                return Chunk(kind, at, end, found)
            if imperative and norm in ("look", "search") and self.norms[end] == "for":
                return Chunk("FIND", at, end + 1, found)
            if imperative and norm in FACE_VERBS and not subject_is_you:
                if norm in ("look", "turn") and self.norms[end] in ("at", "to", "toward", "towards"):
                    end += 1
                return Chunk("TPART", at, end, found)
            if imperative and not subject_is_you and self.nouns.is_determiner(end):
                return Chunk("DO", at, end, found)
            if subject == "REL":
                return self._finite(at, end, found)
            if subject not in ("NP", "AND") or self.nouns.is_noun(i):
                return None
            return self._finite(at, end, found)
        if self.nouns.is_noun(i) and self._previous() not in ("NP", "REL"):  # third person
            return None
        return self._finite(at, end, found)

    def _only_places(self) -> bool:
        """Return True if only places stand before in the clause: *to the left of it put …*."""
        first = len(self.chunks)
        while first > 0 and self.chunks[first - 1].type not in JOINT_TYPES:
            first -= 1
        types = [chunk.type for chunk in self.chunks[first:]]
        places = types.count("PREP") + types.count("OF")
        return bool(types) and types[0] in ("PREP", "ADV") and types.count("NP") == places and not (FINITE & set(types))

    def _inverts(self, form: str, at: int) -> bool:
        """Return True for the participle of *at its left end is bolted the vice*, before its subject."""
        if form not in ("past", "participle", "ing") or self._previous() != "BE" or len(self.chunks) < 2:
            return False
        if not (self.nouns.is_determiner(at + 1) or self.nouns.number(at + 1) is not None):
            return False
        first = len(self.chunks) - 1
        while first > 0 and self.chunks[first - 1].type not in JOINT_TYPES:
            first -= 1
        before = [chunk.type for chunk in self.chunks[first:-1]]
        return (
            bool(before)
            and before[0] in ("PREP", "ADV")
            and before.count("NP") <= before.count("PREP") + (before.count("OF"))
        )

    def _finite(self, at: int, end: int, group: VerbGroup) -> Chunk:
        if (
            group.lemma in FACE_VERBS | {"come", "walk", "go", "step", "get"}
            and self.norms[end] == "in"
            and (not self.nouns.starts(end + 1) or self.norms[end + 1] == "there")
        ):
            return Chunk("VERB", at, end + 1, _with(group, "enter", "other", group.form))
        if group.lemma == "look" and self.norms[end] in ("at", "toward", "towards"):
            return Chunk("TVERB", at, end + 1, group)
        stands = (
            group.kind in ("posture", "lean") and group.lemma not in PUT_ONLY and group.form in ("s", "past", "base")
        )
        subject = self.norms[self.chunks[-1].start] if self.chunks else ""
        if stands and subject not in ("i", "you", "we", "they"):
            return Chunk("VERB", at, end, group)
        return Chunk("TVERB" if self._takes_object(group.kind, end) else "VERB", at, end, group)

    def _takes_object(self, kind: str, at: int) -> bool:
        if not self.nouns.starts(at) or self._alone.longest(self.norms, at) is not None or self._match(at) is not None:
            return False
        if self.norms[at] in ("later", "earlier") and self.norms[at + 1] in prepositions():
            return False
        if self._relator(at) is not None or self._measure(at) is not None:
            return False
        if self.norms[at] in ("left", "right", "up", "down", "back", "forward", "forwards") and not self.nouns.starts(
            at + 1
        ):
            return False
        if self.nouns.number(at) is not None and self.norms[at + 1] in _LAYERS:
            return False
        found = self.nouns.phrase(at, "TVERB")
        return found is not None and found[1] is not None

    def _unknown_participle(self, at: int, i: int, group: VerbGroup) -> Chunk | None:
        """Return the participle of a verb that no table holds: *the window shrouded in fog*."""
        norm = self.norms[i]
        previous = self._previous()
        if previous == "ADVERB" and len(self.chunks) > 1 and self.chunks[-2].type in ("COMMA", "BE"):
            previous = self.chunks[-2].type  # 'a loaf, perfectly preserved'
        if (
            len(norm) < 5
            or not norm.endswith(("ed", "ing"))
            or previous not in ("NP", "BE", "COMMA", "AND", "REL", "NOT")
            or norm in PRONOUNS
        ):
            return None
        if previous == "NP" and len(self.chunks) > 1 and self.chunks[-2].type == "REL" and norm.endswith("ed"):
            return Chunk("VERB", at, i + 1, _with(group, norm, "unknown", "past"))
        if previous == "NP" and self.norms[self.chunks[-1].start] in _SUBJECTS and norm.endswith("ed"):
            kind = "TVERB" if self.nouns.starts(i + 1) else "VERB"
            return Chunk(kind, at, i + 1, _with(group, norm, "unknown", "past", past=True))
        if self.nouns.is_noun(i) or (previous != "BE" and self.nouns.is_noun(i)):
            return None
        return Chunk("PART", at, i + 1, _with(group, norm, "unknown", "ing" if norm.endswith("ing") else "past"))

    def _orders(self, at: int) -> bool:
        """Return True for the verb of a command after an adverb: *now lower the lid*."""
        return (
            self._previous() in JOINT_TYPES | {""}
            and self.norms[at] in NAMED_LIKE_THINGS
            and self.nouns.is_determiner(at + 1)
        )

    def _goes(self, at: int) -> bool:
        """Return True if a place and not an object follows a command such as *stand* or *sit*."""
        if self._previous() in ("AND", "COMMA") and not any(c.type in ("PUT", "DO", "GO") for c in self.chunks):
            return False
        after = self.norms[at]
        return after in ("back", "away", "aside", "here") or (
            after not in ("for", "at", "to") and not self.nouns.is_determiner(at) and self._relator(at) is not None
        )

    def _imperative_object(self, at: int) -> bool:
        return self.nouns.starts(at) or self.norms[at] in ("out", "for", "on", "to", "up")

    def _auxiliary(self, at: int) -> bool:
        norm = self.norms[at]
        if norm in ("do", "does", "did"):
            return self.norms[at + 1] in NEGATIONS or self._verbs.get(self.norms[at + 1]) is not None or at == 0
        return norm in IS_FORMS or (norm in MODALS and self._modal(at)) or norm in ("has", "have", "had")

    def _modal(self, at: int) -> bool:
        """Return True for a modal verb; *can*, *will* and *need* are other words too."""
        after = self.norms[at + 1]
        if self.norms[at] == "need" or self.norms[at] == "needs":
            return after in ("to", "not")
        if self.norms[at] not in ("can", "may", "will", "might"):
            return True
        form = self._verbs.get(after)
        if (
            self._previous() in ("NP", "REL")
            and self.chunks
            and self.norms[self.chunks[-1].start] in ("you", "we", "i", "it")
        ):
            return True
        return (
            after in ("be", "not", "have", "well", "also", "only", "you", "usually", "never", "the", "i", "it")
            or (form is not None and form.form == "base" and not (self.norms[at] == "can" and after in _NOUNS_TOO))
            or after in HEDGES
        ) and not (self.norms[at] == "can" and after in ("the", "it", "i") and self._previous() == "NP")

    def _perfect(self, at: int) -> bool:
        i = at + 1
        while self.norms[i] in ADVERBS or self.norms[i] in NEGATIONS:
            i += 1
        if self.norms[i] == "been":
            return True
        form = self._verbs.get(self.norms[i])
        if form is None:
            return self.norms[i].endswith("ed") and not self.nouns.is_noun(i)
        if self.norms[i] in ("put", "set", "cut", "hit", "let") and self.norms[at] != "having":
            i += self.norms[i + 1] in _PARTICLES
            return self.nouns.starts(i + 1) or self.norms[i + 1] in prepositions()
        if self.norms[i] == "left":
            return self.nouns.is_determiner(i + 1)
        return form.form in ("past", "participle") and self.norms[i] != "set"

    def _goes_on(self, at: int) -> bool:
        norm = self.norms[at]
        return (
            norm in IS_FORMS or norm in self._verbs or norm in NEGATIONS or (norm in ADVERBS and self._goes_on(at + 1))
        )

    def _unknown_imperative(self, at: int) -> bool:
        """Return True for an unknown word before a determiner where a command can begin: *tighten the screws*."""
        norm = self.norms[at]
        if (
            is_known(norm)
            or not norm.isalpha()
            or self.nouns.is_known_noun(norm)
            or self.norms[at + 1] in ("that", "which")
        ):
            return False
        if not self.nouns.is_determiner(at + 1) or self.nouns.is_letter(at + 1):
            return False
        previous = self._previous()
        return previous in ("", "CUT") or (
            previous in ("AND", "COMMA", "THEN", "ADVERB") and any(chunk.type in ("PUT", "DO") for chunk in self.chunks)
        )

    def _noun_phrase(self, at: int) -> Chunk | None:
        """Return a noun phrase, or an adjective phrase."""
        if self._unknown_imperative(at):
            return Chunk("DO", at, at + 1, VerbGroup(self.norms[at], "unknown", "base"))
        if (
            not self._previous() and self.norms[at + 1] in _PARTICLES and self.nouns.is_determiner(at + 2)
            and self.norms[at].isalpha() and self.norms[at] not in DIRECTION_WORDS and not self._relator(at)
        ):  # fmt: skip
            return Chunk("DO", at, at + 2, VerbGroup(self.norms[at], "unknown", "base"))  # 'wipe off the oil'
        if (
            self.norms[at] == "back"
            and self._previous() in FINITE | {"PART", "NP"}
            and (self.norms[at + 1] in prepositions() and self.norms[at + 1] not in ("of", "to"))
        ):
            return Chunk("ADVERB", at, at + 1, "back")
        if self.norms[at + 1] in ("quarters", "quarter", "thirds", "third") and self.norms[at + 2] in _HALF_STATES:
            span = self.words[at].start, self.words[at + 2].end
            return Chunk("ADJP", at, at + 3, (Adjective(f"partly {self.norms[at + 2]}", "state", Degree.PLAIN, span),))
        if self.norms[at] in ("missing", "absent") and self._previous() == "BE":
            span = self.words[at].start, self.words[at].end
            return Chunk("ADJP", at, at + 1, (Adjective("missing", "state", Degree.PLAIN, span),))
        if self.norms[at] == "half" and self.norms[at + 1] in _HALF_STATES | ADVERBS:
            span = self.words[at].start, self.words[at + 1].end
            return Chunk("ADJP", at, at + 2, (Adjective(f"half {self.norms[at + 1]}", "state", Degree.PLAIN, span),))
        self.nouns.is_object = self._previous() == "PUT" or (
            self._previous() == "TVERB" and self.chunks[-1].value.lemma in ("hold", "contain", "have", "keep")
        )
        found = self.nouns.phrase(at, self._previous())
        if found is None:
            return None
        end, phrase, adjectives = found
        if self._made is not None and at < self._made < end:
            verb, self.norms[self._made] = self.norms[self._made], ","  # 'let ivy trail over the rim'
            found = self.nouns.phrase(at, self._previous()) or found
            self.norms[self._made] = verb
            end, phrase, adjectives = found
        if self._denied is not None and end - at > 1 and self._is_base(end - 1) and self._predicate_after(end - 1):
            verb, self.norms[end - 1] = self.norms[end - 1], ","  # 'must the container stand on it'
            shorter = self.nouns.phrase(at, self._previous())
            self.norms[end - 1] = verb
            end, phrase, adjectives = shorter or found
        if (
            phrase is not None
            and not phrase.head
            and not phrase.pronoun
            and phrase.determiner is None
            and (
                (self._previous() in ("NP", "BE") or self.norms[end + 2] in DIRECTION_WORDS)
                and self._previous() in ("NP", "BE", "COMMA")
                and self.norms[end] == "from"
                and phrase.adjectives
                and phrase.count is None
            )
        ):
            return Chunk("ADJP", at, end, phrase.adjectives)  # 'the block second from the left'
        if end == at + 1 and phrase is not None and self._previous() == "BE" and (words := self.nouns.predicative(at)):
            return Chunk("ADJP", at, end, words)
        if phrase is None:
            if self._previous() in ("PREP", "TPART", "WITH", "OF", "TVERB", "FIND", "PUT") or self.norms[end] == "of":
                span = self.words[at].start, self.words[end - 1].end
                return Chunk("NP", at, end, NounPhrase(span, adjectives=adjectives))
            return Chunk("ADJP", at, end, adjectives)
        return Chunk("NP", at, end, phrase)


JOINT_TYPES = frozenset({"COMMA", "AND", "OR", "BUT", "THEN", "CUT", "COLON", "SUB"})
_DENIALS = tuple(
    tuple(phrase.split())
    for phrase in (
        "under no circumstances", "at no time", "on no account", "in no case", "by no means", "in no way", "never",
        "at no point",
    )
)  # fmt: skip
"""Denials that can stand before their clause and turn its words round."""
PUT_ONLY = word_set(
    "put place keep leave set lay use see find position have cover stack fold roll store fill top flank screw bolt"
)
_JUDGEMENTS = word_set("true clear certain important essential vital good bad nice best better the case fact sure")
_SUBORDINATING = {
    ("as", "soon", "as"), ("as", "long", "as"), ("so", "long", "as"), ("even", "if"), ("only", "if"), ("in", "case"),
    ("provided", "that"), ("given", "that"),
}  # fmt: skip
_TOLD = word_set("it they he she there")
_LAYERS = frozenset({"high", "deep", "abreast"})
_THIRD_PERSONS = (["it"], ["he"], ["she"])
_SUBJECTS = word_set("i you we he she they")
"""Pronouns before which no participle stands: the verb after them is finite."""
_WHOEVER = word_set("otherwise whoever whatever whichever whomever")
"""Words for any person or thing of which the clause holds: it is a condition."""
_FORBIDDING = word_set("forbidden prohibited avoid impossible wrong refuse forget dangerous")
_GOVERNORS = word_set(
    "remember sure forget need needs have has had got important essential necessary vital crucial best better good"
    " helpful useful advisable advised recommended time ready proceed continue begin start care careful required want"
    " is are step"
)
"""Words before *to* that make the infinitive a command; other words, as *afraid* or *refuse*, do not."""
_HALF_STATES = word_set("dead empty full open closed finished done eaten asleep")
_ALL = frozenset({"all", "everything", "nothing", "none", "anything"})
_UNDER_OR_BEHIND = frozenset({"behind", "under", "underneath", "beneath", "between", "beside", "below", "next"})
_SPOTS = frozenset({"corner", "edge", "end", "side", "part"})
_LATERAL = frozenset({"left", "right"})
_CHOOSE = word_set("choose select pick click locate")
_AIMS = word_set("left right up down forward forwards backward backwards away upward downward sideways")
_NOUNS_TOO = word_set("stand rest set place position face point back front top bottom")
_HEDGES_OF_PLACES = word_set("about around roughly approximately approx almost nearly")
"""Hedges that belong to the place or the measure after them, and not to the verb."""

_UNREAL = frozenset({"must", "may", "ought", "should", "could", "would", "might"})
"""Modal verbs that, before *have*, say what was not."""
_TENDING = {
    "supposed": "should", "meant": "should", "intended": "should", "allowed": "can", "permitted": "can",
    "about": "would", "going": "will", "likely": "might", "required": "must",
    **dict.fromkeys(
        ("said", "believed", "thought", "rumoured", "rumored", "reported", "alleged", "reputed", "presumed", "assumed",
         "claimed", "understood", "expected", "unlikely", "hoped", "feared", "suspected"), "might",
    ),
}  # fmt: skip
"""Modal verb that a word between *is* and *to* amounts to: *is allowed to stand*."""
_CAUSATIVES = {"let": False, "have": False, "make": False, "ask": True, "allow": True, "get": True, "tell": True}
"""Commands that make something else do a thing, and whether *to* stands before its verb."""
_CLAUSE_ENDS = frozenset({",", ";", ":", ".", "!", ")", ""})
_BEFORE_NOUNS = {("in", "two"), ("in", "half"), ("in", "first"), ("in", "last")}
"""Idioms, except before a noun: *in two bowls*."""
_APPROACHING = word_set("go walk turn head move drive navigate proceed run come roll fly step")
_LOOKING = word_set("look search check see watch")
_GOING = word_set("stand sit step walk go kneel stay wait look")
"""Verbs of commands that take no object."""
_TURNING = word_set("turn flip roll tip fold hand bend knock")
_BEGINNING = word_set("start begin finish continue proceed end")
_OTHER_END = {"left": "right", "right": "left", "top": "bottom", "bottom": "top", "front": "back", "back": "front"}
_PHRASAL = {("make", "out"): ("see", "posture"), ("take", "up"): ("occupy", "transitive")}
"""Verbs with a particle: the verb and the kind that they amount to."""
_PARTICLES = word_set("off up down out away over")
_BREADTHS = word_set("width breadth length")
_BODY = word_set("hand hands finger fingers thumb thumbs palm fist arm foot feet stride pace")
_MEASURE_WORDS = HEDGES | frozenset(
    {
        "within",
        "less",
        "than",
        "more",
        "at",
        "least",
        "most",
        "exactly",
        "only",
        "under",
        "over",
        "up",
        "to",
        "some",
        "just",
        "a",
        "no",
        "not",
    }
)
_MEASURE_WORDS |= {"closer", "nearer", "farther", "further"}
_BOUNDS = {
    "closer": "<",
    "nearer": "<",
    "farther": ">",
    "further": ">",
    "within": "<",
    "less": "<",
    "more": ">",
    "least": ">",
    "most": "<",
    "under": "<",
    "over": ">",
}


def _with(group: VerbGroup, lemma: str, kind: str, form: str, past: bool | None = None) -> VerbGroup:
    return VerbGroup(
        lemma, kind, form, group.modal, group.positive, group.past if past is None else past, group.adverbs
    )


def _ATTACHED_UNIT(norm: str) -> float | None:  # noqa: N802
    """Return the metres of a number and unit written as one word: ``10cm``."""
    digits = norm.rstrip("abcdefghijklmnopqrstuvwxyz")
    scale = UNITS.get(norm[len(digits) :].lstrip("-"))
    if not digits or scale is None:
        return None
    try:
        return float(digits.rstrip("-")) * scale
    except ValueError:
        return None
