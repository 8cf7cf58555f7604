"""Find prepositions, place words and lengths in the words of a sentence."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache

from deixis.grammar.english.chunking.chunk import FINITE, JOINT_TYPES, Chunk, Relator, VerbGroup
from deixis.grammar.english.chunking.noun_phrases import NounChunker
from deixis.grammar.english.tagging.tagger import Tagging
from deixis.grammar.english.tagging.word_classes import is_known
from deixis.grammar.english.tokens import Word
from deixis.grammar.english.tree import Degree, NounPhrase
from deixis.grammar.english.vocabulary.function_words import (
    DEGREE_ADVERBS,
    HEDGES,
    IS_FORMS,
    MODALS,
    OTHER_UNITS,
    PRONOUNS,
    UNITS,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.nouns import FRONTS, PARTS, last_word
from deixis.grammar.english.vocabulary.relation_words import (
    DIRECTION_WORDS,
    PLACE_NOUNS,
    Preposition,
    places_alone,
    prepositions,
)
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import verb_forms


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
def _alone_phrases() -> _Phrases:
    return _phrases(places_alone())


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


class RelatorChunker:
    """Finder of prepositions, place words and lengths, beside the chunks that were found so far."""

    def __init__(self, words: list[Word], nouns: KnownNouns, tagging: Tagging) -> None:
        self.words = words
        self.norms = [word.norm for word in words] + [""] * 12
        self.nouns = NounChunker(words, self.norms, nouns, tagging.classes)
        self._tried_verbs = tagging.tried
        self.chunks: list[Chunk] = []
        self._denied: str | None = None  # modal of a denial that stands before its subject
        self._denied_be: VerbGroup | None = None  # 'by no means is the cup …': *is* goes after the subject
        self._made: int | None = None  # index of the verb of 'let the ribbon hang …'
        self._object_left_out = False  # True after 'place' of 'cut it and place in the box'
        self._relations, self._alone, self._verbs = _preposition_phrases(), _alone_phrases(), verb_forms()

    def _previous(self) -> str:
        return self.chunks[-1].type if self.chunks else ""

    def _only_places(self) -> bool:
        """Return True if only places stand before in the clause: *to the left of it put …*."""
        first = len(self.chunks)
        while first > 0 and self.chunks[first - 1].type not in JOINT_TYPES:
            first -= 1
        types = [chunk.type for chunk in self.chunks[first:]]
        places = types.count("PREP") + types.count("OF")
        return bool(types) and types[0] in ("PREP", "ADV") and types.count("NP") == places and not (FINITE & set(types))

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
        if self.norms[i] == "already" and self._match(i + 1) is not None:
            i += 1  # 'the silk is already inside the hat'
        while (self.norms[i] in DEGREE_ADVERBS or self.norms[i] in HEDGES or self.norms[i] == "the") and i - at < 4:
            if self._relations.by_first.get(self.norms[i]) and self._match(i) is not None:
                break
            if i == at and (alone := self._alone.longest(self.norms, i)) is not None and alone[0] > i + 1:
                break  # 'dead centre'
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

    def _verb_before_subject(self, at: int) -> bool:
        """Return True for a verb of posture before a subject, which may look like a plural: *stands the cup*."""
        form = self._verbs.get(self.norms[at])
        third = form is not None and form.form == "s" and form.kind == "posture"
        return third and self.nouns.is_determiner(at + 1)

    def _match(self, at: int) -> tuple[int, str, Preposition] | None:
        """Return the end, the type and the relation of the longest phrase that the words after it allow."""
        if self.norms[at] in ("left", "right", "close", "next", "near", "closest", "nearest", "closer") and (
            self._previous() not in ("NP",)
            and self.nouns.starts(at)
            and self.nouns.adjective_before_noun(at)
            and self.norms[at + 1] not in ("to", "of", "by")
        ):
            return None
        led = at > 0 and self.norms[at - 1] in ("on", "in", "to", "at", "into", "onto")
        if self.norms[at] in ("inside", "outside") and led and self.nouns.adjective_before_noun(at):
            return None  # 'on outside pouches'
        if self.norms[at] == "nearby" and at > 0 and self.norms[at - 1] in ("a", "the", "some"):
            return None  # 'on a nearby surface'
        begins = self._previous() in JOINT_TYPES | {"", "ADVERB"}
        if self.norms[at] == "close" and begins and (self.nouns.is_determiner(at + 1) or self.norms[at + 1] == "and"):
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
            takes_object = takes_object or self._turned_after(end)
            if end > at + 1 and preposition.phrase == "in between" and self._verb_before_subject(end):
                takes_object = False  # 'in between stands the cup'
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
                types = [chunk.type for chunk in self.chunks[-3:]]
                stranded = stranded or (types[:2] == ["NP", "NP"] and types[2:] in (["BE"], ["VERB"]))
                stands_alone = end > at + 1 or self.norms[at] in ("near", "against", "beneath", "alongside", "beside")
                if (
                    shorter is None
                    and preposition.relation not in ("from", "to", "with", "without", "at", "facing")
                    and (stranded or stands_alone)
                ):
                    return end, "ADV", preposition
        if self.norms[at] in ("in", "out", "inward", "inwards", "outward", "outwards"):
            last = self.chunks[-1].value if self.chunks else None
            aims = isinstance(last, VerbGroup) and (last.kind in ("face", "point") or last.lemma in _TURNED)
            if aims and self.norms[at + 1] in CLAUSE_ENDS:
                return at + 1, "ADV", places_alone()["inward" if self.norms[at][0] == "i" else "outward"]
            if alone is not None and alone[1].relation in ("inward", "outward"):
                return None
        if alone is not None:
            if (
                self.norms[at] in ("left", "right")
                and self.norms[alone[0]] in _AFTER_RIGHT
                and self.norms[at] == "right"
            ):
                return None  # an adverb: 'right behind'
            if self.norms[at] == "around" and self.norms[alone[0]] in prepositions():
                return None  # 'from sliding around on the floor'
            if alone[1].relation in ("up", "down") and self._previous() == "PART" and self.norms[at - 1] in _ROLLED:
                return None  # 'rolled up and leaning against it'
            if alone[1].relation in ("up", "down") and self.norms[alone[0]] in ("and", "or"):
                return alone[0], "ADV", places_alone()["above" if alone[1].relation == "up" else "below"]
            if alone[1].relation in ("up", "down", "forward", "backward"):
                last = self.chunks[-1] if self.chunks else None
                aims = last is not None and isinstance(last.value, VerbGroup) and last.value.kind in ("face", "point")
                ends = self.norms[alone[0]] in ("", ",", ".", ";", "and")
                noted = last is not None and isinstance(last.value, NounPhrase) and ends and _names_part(last.value)
                if not aims and not noted:
                    return None
            # 'it is in the kitchen, not here'
            denied = self.norms[at - 1 : at + 1] == ["not", "here"] and self.norms[at + 1] in CLAUSE_ENDS
            follows = self._previous() in FINITE | {"ADV", "ADVERB", "NP", "PART"}
            if alone[1].relation == "there" and not denied and not follows:
                return None
            return alone[0], "ADV", alone[1]
        return None

    def _turned_after(self, at: int) -> bool:
        """Return True for *that* before the verb of a turned clause: *on a shelf above that stood his books*."""
        form = self._verbs.get(self.norms[at + 1])
        stands = form is not None and form.kind == "posture" and form.form in ("s", "past", "base")
        return self.norms[at] == "that" and stands and self._only_places()

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
        norm = self.norms[at]
        unknown = (
            verb is None
            and self._previous() == "NP"
            and norm.isalpha()
            and not is_known(norm)
            and not self.nouns.is_known_noun(norm)
        )
        if unknown and (self.nouns.is_determiner(at + 1) or after in PRONOUNS):
            return after != "that"  # 'to clarify the broth'
        if unknown and norm.endswith(_VERBAL) and self.nouns.starts(at + 1):
            return True  # 'to facilitate growth'
        return self.norms[at] == "be" or (
            verb is not None
            and verb.form == "base"
            and self.norms[at] not in NOUNS_TOO
            and (self.nouns.starts(at + 1) or after in ("", ".", ",", "on", "in"))
        )

    def _begins_clause(self, at: int) -> bool:
        """Return True for a subject pronoun before a finite verb: 'over there it is'."""
        return self.norms[at] in ("it", "they", "there", "you", "i", "we") and (
            self.norms[at + 1] in IS_FORMS or self.norms[at + 1] in MODALS
        )

    def _measure(self, at: int) -> Chunk | None:
        if self.norms[at : at + 4] == ["at", "a", "distance", "of"]:
            length = self._measure(at + 4)  # 'at a distance of 20 cm'
            return None if length is None else Chunk(length.type, at, length.end, length.value)
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
        place = self._relations.longest(self.norms, i + 2) if unit in _STEPS else None
        if place is not None and place[1].relation in _DIRECTED and self.nouns.starts(place[0]):
            return Chunk("ADVERB", at, i + 2, "steps")  # 'two squares behind the knight'
        if unit in OTHER_UNITS:
            return Chunk("ADVERB", at, i + 2 + (self.norms[i + 2] in ("old", "long", "ago", "heavy")), "quantity")
        if unit == "a" and self.norms[i + 2] == "half":
            unit = self.norms[i + 2]
        scale = UNITS.get(unit) or (UNITS.get(unit[:-1]) if unit.endswith("s") else None)
        limb = unit in _BODY and self._previous() == "PREP"  # 'into one arm'
        if scale is None or limb or (unit in ("hand", "finger", "foot", "m") and self.norms[i + 2] in IS_FORMS):
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

    def _directed(self, at: int) -> bool:
        """Return True for words after a length that say from what: *a hand away*, *a hand to the right of it*."""
        place = self._relations.longest(self.norms, at)
        aside = self.norms[at : at + 2] == ["to", "the"] and self.norms[at + 2] in ("left", "right")
        directed = place is not None and place[1].relation in _DIRECTED
        return self.norms[at] in ("away", "apart", "from") or aside or directed

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
        elif unit in _BODY and not self._directed(end):
            return None
        follows = self._match(end) is not None or self.norms[end] in ("away", "apart", "from", "", ",", ".", "or")
        return (end, times * scale) if follows and self.norms[end] != "of" else None


_SPOTS = frozenset({"corner", "edge", "end", "side", "part"})


def _names_part(phrase: NounPhrase) -> bool:
    """Return True for *bowls* in *six spoons, bowls downwards*, and False for *four covers* in *four covers down*."""
    bare = bool(phrase.head) and phrase.determiner is None and phrase.count is None
    return bare or last_word(phrase.head) in PARTS | FRONTS


_AIMS = word_set("left right up down forward forwards backward backwards away upward downward sideways")

NOUNS_TOO = word_set("stand rest set place position face point back front top bottom")

CLAUSE_ENDS = frozenset({",", ";", ":", ".", "!", ")", ""})

_STEPS = word_set("square squares place places seat seats row rows notch notches spot spots space spaces field fields")
"""Units of a distance that has no length."""

_DIRECTED = word_set("left right in_front behind above below top bottom far measured_from from")

_BREADTHS = word_set("width breadth length")

_ROLLED = word_set("rolled folded propped stacked piled wrapped coiled curled drawn tied")
"""Participles of which *up* is a part."""

_AFTER_RIGHT = word_set(
    "up down along across over in on at by behind next above below under underneath beneath beside against between"
    " opposite inside outside near around after before to there"
)
"""Words before which *right* is an adverb."""

_TURNED = frozenset({"turn", "angle", "tilt", "fold", "bend", "point"})
"""Verbs before *in* and *outwards* that tell a direction."""

_VERBAL = ("ify", "ate", "ize", "ise")
"""Endings of verbs that hardly any noun without an article has."""
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
