"""Reword a sentence before its words are classified: leave out asides, join words, and use plainer ones."""

from __future__ import annotations

import re
from dataclasses import replace

from deixis.grammar.english.tagging.word_classes import closed_words
from deixis.grammar.english.tokens import Word, cut_words
from deixis.grammar.english.tree import Degree, Span
from deixis.grammar.english.vocabulary.adjectives import QUALITIES, adjectives, degree_of, is_adjective
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    DETERMINERS,
    HEDGES,
    IS_FORMS,
    MODALS,
    NUMBERS,
    PAST_FORMS,
    POSSESSIVES,
    UNITS,
)
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, prepositions
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import PLACING_VERBS, PUT_VERBS, verb_forms

MAX_LABEL_WORDS = 5
"""Number of words before a dash that can be a label: *sugar bowl - behind the pot*."""
MAX_ASIDE_WORDS = 9
"""Number of words of an aside in a verb: *do not, if you can avoid it, put it there*."""
_PAIRED_DASHES = 2
_AUXILIARIES = MODALS.keys() | {"do", "does", "did"}
_DASHES = frozenset({"-", "\u2013", "\u2014"})
_SUBJECTS = frozenset({"it", "they", "the", "there", "you", "we"})
_CORRECTIONS = frozenset({"sorry", "correction", "wait", "no"})
"""Words by which a speaker takes back the place just said."""
_CORRECTING = frozenset({("scratch", "that"), ("strike", "that"), ("i", "mean"), ("no", "wait")})
"""Pairs of words that do so."""
_FILLERS = frozenset({"uh", "um", "er", "erm", "hmm"})
_RARELY = frozenset({("hardly", "ever"), ("scarcely", "ever"), ("barely", "ever"), ("almost", "never")})
_DENIALS = {
    ("no", "longer"): "never", ("with", "no"): "without", ("far", "from", "being"): "not", ("not", "a", "single"): "no",
    ("not", "anywhere", "near"): "not near", ("not", "anywhere", "close", "to"): "not near",
    ("nowhere", "close", "to"): "not near", ("anything", "but"): "not",
    ("has", "become"): "became", ("have", "become"): "became",
    ("has", "yet", "to", "be"): "is not", ("have", "yet", "to", "be"): "are not", ("stopped", "being"): "is not",
    ("as", "well", "as"): "and",
    ("minus",): "without", ("ceased", "to", "be"): "is not", ("ceases", "to", "be"): "is not",
    ("might", "as", "well"): "might", ("may", "as", "well"): "may", ("could", "as", "well"): "could",
    ("nowhere", "near", "being"): "not", ("nowhere", "to", "be"): "not",
    ("'d", "better"): "should", ("had", "better"): "should", ("little", "or", "no"): "no", ("few", "or", "no"): "no",
    ("at", "or", "near"): "near", ("in", "or", "near"): "near", ("on", "or", "near"): "near",
    **{
        (has, "no", noun, *being): plain
        for has, plain in (("has", "is not"), ("have", "are not"))
        for noun in ("business", "place")
        for being in ((), ("being",))
    },
}  # fmt: skip
"""Phrases that deny what follows them, advise it, or say how it became or about where, with words for the same."""
_CONTRASTS = frozenset({("rather", "than"), ("instead", "of"), ("let", "alone"), ("opposed", "to")})
"""Words that deny what follows them, as ``not`` after a comma does."""


def _join_asides(text: str, words: list[Word]) -> None:
    """Read two dashes as commas, and one dash after a few words without a verb as a colon."""
    places = [
        i for i, word in enumerate(words)
        if word.norm in _DASHES and (word.norm != "-" or text[word.start - 1 : word.start].isspace())
    ]  # fmt: skip
    if len(places) == _PAIRED_DASHES:
        aside = [word.norm for word in words[places[0] + 1 : places[1]]]
        if "," in aside and not IS_FORMS.isdisjoint(aside):
            del words[places[0] : places[1] + 1]  # '– careful, it's hot –'
            return
        for i in places:
            words[i].norm = ","
    elif len(places) == 1 and places[0] <= MAX_LABEL_WORDS:
        verbs = verb_forms()
        if not any(word.norm in IS_FORMS or word.norm in verbs for word in words[: places[0]]):
            words[places[0]].norm = ":"


def _read_hours(words: list[Word]) -> None:
    """Read *at 10:30 on the clock* and *at the 10 o'clock position* as *at 10 o'clock*."""
    for i in range(len(words) - 2, 0, -1):
        hour = _HOUR.fullmatch(words[i].norm)
        if hour is None or words[i - 1].norm not in ("at", "around", "about", "the"):
            continue
        after = [word.norm for word in words[i + 1 : i + 5]]
        if after[:3] in (["on", "the", "clock"], ["on", "a", "clock"]):
            last = i + 3 + (after[3:] == ["face"])
        elif after[:2] == ["o'clock", "position"]:
            last = i + 2
        elif after[:1] == ["o'clock"] and ":" in words[i].norm:
            last = i + 1
        else:
            continue
        words[i].norm, words[i + 1].norm, words[i + 1].end = hour[1], "o'clock", words[last].end
        del words[i + 2 : last + 1]
        if words[i - 1].norm == "the":
            del words[i - 1]


MAX_DIGITS = 4
"""Maximum number of digits of a number in a range."""
_HOUR = re.compile(r"(1[0-2]|[1-9])(?::[0-5]\d)?")
"""An hour of a clock face as a direction; minutes make no difference."""


def _read_levels(words: list[Word]) -> None:
    """Read *eye level* and *elbow height* as one noun, which names no thing."""
    for i in range(len(words) - 2, -1, -1):
        if words[i].norm in _MEASURING_PARTS and words[i + 1].norm in ("level", "height"):
            words[i].norm, words[i].end = f"{words[i].norm}-{words[i + 1].norm}", words[i + 1].end
            del words[i + 1]


def _read_opposites(words: list[Word]) -> None:
    """Read *at opposite ends of the shelf* as *at both ends of the shelf*."""
    for i in range(1, len(words) - 1):
        facing = words[i].norm == "opposite" and words[i + 1].norm in ("ends", "edges", "corners")
        if facing and words[i - 1].norm in ("at", "on", "in", "from", "near"):
            words[i].norm = "both"


def _read_and_or(words: list[Word]) -> None:
    """Read *and/or*, which are three marks, as one *or*."""
    for i in range(len(words) - 3, -1, -1):
        if [word.norm for word in words[i : i + 3]] == ["and", "/", "or"]:
            words[i].norm, words[i].end = "or", words[i + 2].end
            del words[i + 1 : i + 3]


def _read_ranges(words: list[Word]) -> None:
    """Read *two to three cups*, *two/three cups* and *two or three cups* as *2-3 cups*, and *5 mm to 10 mm* as *10 mm*.

    Qualities between which a thing is (*a small to medium bowl*) are left out.
    """
    for i in range(len(words) - 4, -1, -1):
        norms = [word.norm for word in words[i : i + 5]]
        if i and words[i - 1].norm in ("from", "between"):
            continue
        quality = is_adjective(norms[0]) and DIRECTION_WORDS.isdisjoint(norms[:3:2]) and norms[2].isalpha()
        quality = quality and norms[1] == "to" and norms[2] not in DETERMINERS | POSSESSIVES.keys()
        if i and quality and words[i - 1].norm in DETERMINERS and norms[3].isalpha():
            del words[i : i + 3]
            continue
        if len(norms) == 5 and norms[2] == "to" and norms[1] == norms[4] and norms[1] in UNITS:
            del words[i : i + 3]
            continue
        spelled = norms[0].isalpha() and norms[2].isalpha()  # '1/2' is a half
        if norms[1] != "to" and not (norms[1] in ("/", "or") and spelled):
            continue
        first, last = (NUMBERS.get(n, int(n) if n.isdecimal() and len(n) <= MAX_DIGITS else 0) for n in norms[:3:2])
        if not 0 < first < last:
            continue
        if norms[3].isalpha() and norms[3] not in UNITS.keys() | prepositions().keys() | IS_FORMS | {"and", "o'clock"}:
            words[i].norm, words[i].end = f"{first:g}-{last:g}", words[i + 2].end
            del words[i + 1 : i + 3]


def _without_dimensions(words: list[Word]) -> None:
    """Leave out the dimensions before the name of a thing: *a 3' x 4' rug*, *a 3-foot by 4-foot rug*, *a 2cm nail*."""
    i = 0
    while i < len(words) - 1:
        end = i + 1
        while _NUMBER_OF_DIMENSION.fullmatch(words[end - 1].norm) and end < len(words):
            end += end < len(words) and words[end].norm in UNITS
            if end + 1 < len(words) and words[end].norm in ("x", "by"):
                end += 2
            elif end < len(words) and _SECOND_DIMENSION.fullmatch(words[end].norm):
                end += 1
            else:
                break
        several = _NUMBER_OF_DIMENSION.fullmatch(words[i].norm) and end > i + 1 + (words[i + 1].norm in UNITS)
        named = end < len(words) and words[end].norm.isalpha() and words[end].norm not in prepositions()
        if several and named and (i == 0 or words[i - 1].norm in DETERMINERS | POSSESSIVES.keys() | NUMBERS.keys()):
            del words[i:end]
        elif _measures_a_thing(words, i):
            del words[i : i + 2]
        i += 1


def _measures_a_thing(words: list[Word], at: int) -> bool:
    """Return True for a length or a capacity before the name of a thing: *a 25mm pipe*, *two 500 ml flasks*."""
    norms = [word.norm for word in words[at : at + 4]] + [""] * 4
    if not norms[0].replace(".", "", 1).isdecimal() or norms[1] not in _UNITS_OF_THINGS or not norms[2].isalpha():
        return False
    glued = words[at].end == words[at + 1].start
    if not glued and (at == 0 or words[at - 1].norm not in DETERMINERS | POSSESSIVES.keys() | NUMBERS.keys()):
        return False  # 'leave 3 cm space'
    if is_adjective(norms[2]) and norms[2] not in _EXTENTS:
        return norms[3].isalpha() and norms[3] not in closed_words()
    return norms[2] not in closed_words() | _EXTENTS | DIRECTION_WORDS | UNITS.keys()


_UNITS_OF_THINGS = word_set(
    "mm cm m inch in ft foot yard yd ml cl dl l litre liter oz ounce g mg kg lb gallon quart pint cup watt w volt v"
    " \u03bcl ul hz khz kw amp second minute hour day week month year page"
)
"""Units of the measures that stand before the name of a thing, in the singular."""
_EXTENTS = word_set(
    "long wide high tall deep thick broad apart away gap space margin distance clearance overlap overhang drop border"
    " interval strip allowance"
)
"""Words after a length that is not the measure of a thing."""
_NUMBER_OF_DIMENSION = re.compile(r"\d+(?:\.\d+)?(?:-[a-z]+)?")
_SECOND_DIMENSION = re.compile(r"x\d+")


def _without_entering(words: list[Word]) -> None:
    """Read *on the left as you walk in stands a lamp* as *on the left stands a lamp*: left is as one sees it."""
    for i in range(len(words) - 4, 0, -1):
        if [word.norm for word in words[i : i + 2]] != ["as", "you"] or words[i + 2].norm not in _ENTERING:
            continue
        end = i + 3 + (words[i + 3].norm in ("in", "inside", "through"))
        form = verb_forms().get(words[end].norm) if end < len(words) else None
        stands = end < len(words) and (words[end].norm in IS_FORMS or (form is not None and form.kind == "posture"))
        if stands and words[0].norm in prepositions():
            del words[i:end]


_ENTERING = word_set("enter walk come go step")


def _read_halfway(words: list[Word]) -> None:
    """Read *a bit over half way up the wall* as *halfway up the wall*."""
    for i in range(len(words) - 3, -1, -1):
        if [word.norm for word in words[i : i + 2]] == ["half", "way"]:
            words[i].norm, words[i].end = "halfway", words[i + 1].end
            del words[i + 1]
        if words[i].norm != "halfway" or words[i + 1].norm not in ("up", "down", "along", "between"):
            continue
        start = i
        while start and words[start - 1].norm in _NEARLY:
            start -= 1
        del words[start:i]


_NEARLY = word_set("a bit little over about almost roughly nearly just more than less slightly")
"""Words before *halfway* that say how nearly it is so."""


def _without_set_aside(words: list[Word]) -> None:
    """Leave out the particle of *set aside a shelf for pans*, which is not a place."""
    for i in range(len(words) - 2, -1, -1):
        if words[i].norm in ("set", "put", "lay") and words[i + 1].norm == "aside":
            words[i].end = words[i + 1].end
            del words[i + 1]


def _read_setups(words: list[Word]) -> None:
    """Read *in a two-light set up* as one noun, and leave out *built-in* before a place."""
    for i in range(len(words) - 2, 1, -1):
        if [words[i].norm, words[i + 1].norm] == ["set", "up"]:
            before = [word.norm for word in words[max(0, i - 4) : i]]
            start = next((k for k in range(len(before) - 2, -1, -1) if before[k] in _PHRASE_OF_SETUP), None)
            if start is not None and before[start + 1] in DETERMINERS:
                words[i].norm, words[i].end = "setup", words[i + 1].end
                del words[i + 1]
        elif words[i].norm == "built-in" and words[i - 1].is_word and words[i + 1].norm in prepositions():
            del words[i]


def _without_asides_in_verbs(words: list[Word]) -> None:
    """Leave out what stands between commas in a verb: *do not, however, put it there*.

    A place there stays if it is the only one: *do not, on the left, put a fork*.
    """
    for at in range(len(words) - 4, -1, -1):
        start = at + 1 + (words[at + 1].norm in ("not", "never", "n't"))
        if words[at].norm not in _AUXILIARIES or words[start].norm != ",":
            continue
        end = next((k for k in range(start + 1, len(words)) if not words[k].is_word), len(words))
        verb = end + 1
        while verb < len(words) and (words[verb].norm in ADVERBS or words[verb].norm == "be"):
            verb += 1
        form = verb_forms().get(words[verb].norm) if verb < len(words) else None
        if end - start > MAX_ASIDE_WORDS or words[end : end + 1] == [] or words[end].norm != "," or form is None:
            continue
        later = any(word.norm in prepositions() for word in words[verb + 1 :])
        ends_group = form.form == "base" or (words[verb - 1].norm == "be" and form.form in ("past", "participle"))
        if ends_group and (words[start + 1].norm not in prepositions() or later):
            del words[start : end + 1]


def _without_settings(words: list[Word]) -> None:
    """Leave out *in a formal setting* at the beginning of a sentence, which is not a place."""
    place = next((i for i, word in enumerate(words[:8]) if word.norm == "setting"), 0)
    if place < 2 or words[0].norm != "in" or words[1].norm not in ("a", "an"):
        return
    after = place + 1 + (words[place + 1].norm == "," if place + 1 < len(words) else 0)
    has_verb = any(word.norm in IS_FORMS | MODALS.keys() or word.norm in verb_forms() for word in words[after + 1 :])
    if after < len(words) and has_verb:
        named = words[after].norm in DETERMINERS or words[after].norm in POSSESSIVES or after > place + 1
        del words[: after if named else 0]


def _read_viewpoint(words: list[Word]) -> None:
    """Read *the bench is seen from the stool* as *seen from the stool*, which says nothing about the bench."""
    norms = [word.norm for word in words]
    seen = next((i for i in range(len(norms) - 1) if norms[i] in _SEEN and norms[i + 1] in ("from", "by")), 0)
    before = [norm for norm in norms[:seen] if norm not in _MEANT]
    if before and before[-1] in IS_FORMS and len(before) <= MAX_ASIDE_WORDS and not _UNMEANT & set(norms[:-1]):
        del words[:seen]


_SEEN = frozenset({"seen", "viewed"})
_MEANT = frozenset({"all", "always", "as", "described", "given", "here", "meant", "stated", "taken"})
"""Words that may stand between a form of *be* and *seen from*."""
_UNMEANT = frozenset({",", "not", *MODALS})
"""Words of sentences that say more, or from where something can be seen."""


def _read_facing_commands(words: list[Word]) -> None:
    """Read *face the sofa toward the window* as *turn the sofa toward the window*."""
    start = next((i for i, word in enumerate(words) if word.norm not in ADVERBS | HEDGES), 0)
    norms = [word.norm for word in words[start : start + 10]]
    named = norms[1:2] and (norms[1] in DETERMINERS or norms[1] in POSSESSIVES)
    if norms[:1] == ["face"] and named and not {"toward", "towards"}.isdisjoint(norms[3:]):
        words[start].norm = "turn"


_PHRASE_OF_SETUP = frozenset({"in", "for", "with"})
_MEASURING_PARTS = word_set(
    "eye elbow shoulder waist knee chest head hip ear chin heart arm seat counter ceiling roof ground floor table"
)
"""Parts of the body, and of a room, at whose level a thing can be."""


def _read_fractions(words: list[Word]) -> None:
    """Read *1/2* and *1 1/2* before a word as one number, and *the bottom third of it* as *the bottom half of it*."""
    for i in range(len(words) - 3, -1, -1):
        one, slash, other = words[i : i + 3]
        part = _DENOMINATOR.match(other.norm)
        adjacent = one.end == slash.start and slash.end == other.start
        if slash.norm != "/" or not adjacent or part is None or not one.norm.isdigit():
            continue
        if int(one.norm) >= int(part[1]) or not (part[2] or any(word.is_word for word in words[i + 3 : i + 4])):
            continue
        value, first = int(one.norm) / int(part[1]), i
        if i and words[i - 1].norm.isdigit() and words[i - 1].end + 1 == one.start:
            value, first = value + int(words[i - 1].norm), i - 1
        number = Word(one.text, f"{value:.4g}{part[2]}", words[first].start, other.end, True)
        words[first : i + 3] = [number]
    for i in range(1, len(words)):
        ends = i + 1 == len(words) or words[i + 1].norm == "of" or not words[i + 1].is_word
        if words[i].norm in ("third", "quarter") and words[i - 1].norm in _FRACTIONAL and ends:
            words[i].norm = "half"


_FRACTIONAL = frozenset({"top", "bottom", "upper", "lower", "left", "right", "front", "back", "middle"})
_DENOMINATOR = re.compile(r"(2|3|4|8|16)((?:-[a-z]+)?)$")


def _without_cleft(words: list[Word]) -> None:
    """Read *what you see behind the box is a cup* and *all that remains is a cup* without what only introduces."""
    norms = [word.norm for word in words[:8]]
    if len(norms) > 4 and norms[0] == "what" and norms[1] in ("you", "we", "i", "one") and "is" in norms[3:]:
        end = next((i for i in range(2, 5) if norms[i] in ("see", "find", "notice", "have")), None)
        if end is not None:
            del words[: end + 1]
    elif norms[:2] == ["all", "that"] or norms[:2] == ["all", "you"]:
        be = next(
            (i for i in range(2, len(norms)) if norms[i] in ("is", "are") and norms[i + 1 : i + 2] != ["left"]), None
        )
        if be is not None:
            words[0].norm, words[0].end = "there", words[be - 1].end
            del words[1:be]


def _deny_contrasts(words: list[Word]) -> None:
    """Read *rather than*, *instead of* and *let alone* within a sentence as *, not*."""
    for i in range(len(words) - 2, -1, -1):
        if words[i].norm == "nothing" and words[i + 1].norm == "but":
            words[i].norm, words[i].end = "only", words[i + 1].end
            del words[i + 1]
    for i in range(len(words) - 2, -1, -1):
        if words[i].norm in ("anywhere", "everywhere") and words[i + 1].norm in ("except", "but"):
            words[i].norm, words[i].end = "not", words[i + 1].end
            del words[i + 1]
    for i in range(len(words) - 2, -1, -1):
        for length in range(min(4, len(words) - i), 0, -1):
            plain = _DENIALS.get(tuple(word.norm for word in words[i : i + length]))
            if plain == "and" and i and words[i - 1].norm == ",":
                continue  # 'behind the jug, as well as the pan' can be about both
            if plain is not None and (i + length == len(words) or words[i + length].norm != "than"):
                first, *others = plain.split()
                words[i].norm = first
                for word, norm in zip(words[i + 1 :], others, strict=False):
                    word.norm = norm
                words[i + len(others)].end = words[i + length - 1].end
                del words[i + 1 + len(others) : i + length]
                break
    for i in range(len(words) - 3, -1, -1):
        if [word.norm for word in words[i : i + 3]] == ["whether", "or", "not"]:
            del words[i + 1 : i + 3]
    for i in range(len(words) - 2, 0, -1):
        helped = words[i - 1].norm in ("has", "have", "had", "'ve") and words[i].norm == "since"
        if helped and (words[i + 1].norm in verb_forms() or words[i + 1].norm == "been"):
            del words[i]  # 'it has since moved to the corner'
            continue
        form = verb_forms().get(words[i + 1].norm) if words[i].norm == "once" else None
        did = form is not None and form.form in ("past", "participle") and i + 2 < len(words)
        did = did and words[i - 1].is_word and words[i + 2].norm in DETERMINERS | POSSESSIVES.keys()
        past = words[i].norm == "once" and (words[i + 1].norm in PAST_FORMS or did)
        if past and words[i - 1].norm not in ("that", "which"):
            del words[i]  # 'the cup once stood here', 'a boy once put the cup there'
    for i in range(1, len(words) - 2):
        if words[i].norm in ("provided", "providing") and words[i - 1].norm == "," and words[i + 1].norm in _SUBJECTS:
            words[i].norm = "if"  # 'right of it, provided it is clean'
        if words[i].norm == "but" and words[i + 1].norm == "no":
            words[i].norm = "and"  # 'a tray, but no cup on it'
    denied = any(word.norm in ("not", "never", "no") for word in words)
    for i in range(len(words) - 1, 0, -1):
        last = i + 1 == len(words) or not words[i + 1].is_word
        if words[i].norm in ("yet", "anymore") and denied and last and words[i - 1].is_word:
            del words[i]  # 'it is not on the saucer yet'
    for i in range(1, len(words) - 1):
        if words[i].norm == "high" and words[i + 1].norm == "above" and words[i - 1].norm not in DETERMINERS:
            words[i].norm, words[i].end = "above", words[i + 1].end
            del words[i + 1]  # 'high above the cup'
            break
    for i in range(len(words) - 3, -1, -1):
        if [word.norm for word in words[i : i + 3]] == ["not", "you", "dare"]:
            del words[i + 1 : i + 3]
    for i in range(len(words) - 2, -1, -1):
        if (words[i].norm, words[i + 1].norm) in _RARELY:
            words[i].norm, words[i].end = "rarely", words[i + 1].end
            del words[i + 1]
    for i in range(len(words) - 4, -1, -1):
        if [word.norm for word in words[i : i + 2]] == ["all", "but"] and words[i + 3].norm == "of":
            words[i].norm, words[i].end = "most", words[i + 2].end  # 'all but one of the forks'
            del words[i + 1 : i + 3]
    for i in range(len(words) - 3, 0, -1):
        if (words[i].norm, words[i + 1].norm) not in _CONTRASTS or words[i - 1].norm in (";", ":", "."):
            continue
        end = next((k for k in range(i + 2, len(words) - 1) if words[k].norm == ","), 0)
        fronted = words[i - 1].norm == "," or words[0].norm in prepositions()
        if fronted and end and words[end + 1].norm in PUT_VERBS:
            del words[i : end + (words[i - 1].norm == ",")]  # 'on the mat, rather than the fork, put the spoon'
        else:
            words[i].norm, words[i + 1].norm = ",", "not"
            quality = i + 3 < len(words) and adjectives().get(words[i + 2].norm, "position") != "position"
            if quality and words[i + 3].norm in prepositions():
                del words[i + 2]  # 'on battens rather than flat against the wall'


def _without_inserted_adverbs(words: list[Word]) -> None:
    """Read *there should, however, be a cup* without the commas, which part a modal verb from its verb."""
    for i in range(len(words) - 4, 0, -1):
        inserted = [word.norm for word in words[i : i + 3 : 2]] == [",", ","]
        said = words[i + 1].norm in ADVERBS | HEDGES and words[i - 1].norm in MODALS.keys() | IS_FORMS
        if inserted and said and (words[i + 3].norm in IS_FORMS or words[i + 3].norm in verb_forms()):
            del words[i + 2], words[i]


def _without_following(words: list[Word]) -> None:
    """Read *put the following cups on it* as *put the cups on it*, and *the following* alone as *the items*."""
    for i in range(len(words) - 2, 0, -1):
        if words[i].norm == "following" and words[i - 1].norm in ("the", "these"):
            if words[i + 1].norm.isalpha() and words[i + 1].norm not in prepositions():
                del words[i]
            else:
                words[i].norm = "items"


def _join_qualities(words: list[Word]) -> None:
    """Read *a quiet, peaceful corner* without the comma, because the second word names no thing."""
    for i in range(len(words) - 3, 1, -1):
        if words[i].norm == "," and words[i - 2].norm in DETERMINERS and words[i - 1].norm in QUALITIES:
            after = words[i + 1].norm
            quality = after in QUALITIES or is_adjective(after) or after.endswith(_ENDINGS_OF_QUALITIES)
            if quality and words[i + 2].norm.isalpha() and words[i + 2].norm not in ("and", "or", "but"):
                del words[i]


_ENDINGS_OF_QUALITIES = ("ful", "less", "ous", "able", "ible", "ive", "ish")


def _without_bare_purposes(words: list[Word]) -> None:
    """Read *the cups hang there to dry* without *to dry*, which says what for."""
    for i in range(len(words) - 2, 0, -1):
        ends = i + 2 == len(words) or not words[i + 2].is_word or words[i + 2].norm in ("and", "but", "while")
        if words[i].norm == "to" and words[i + 1].norm in _DRYING and ends:
            del words[i : i + 2]


_DRYING = word_set("dry cool drain soak air-dry")


def _without_and_such(words: list[Word]) -> None:
    """Read *plates and cups and such* without *and such*."""
    for i in range(len(words) - 2, 1, -1):
        last = i + 2 == len(words) or not words[i + 2].is_word
        if [word.norm for word in words[i : i + 2]] in (["and", "such"], ["and", "so"], ["or", "so"]) and last:
            del words[i : i + 2]


def _without_particles_of_filling(words: list[Word]) -> None:
    """Read *fill in the corners* and *fill up the jar* without *in* and *up*."""
    for i in range(len(words) - 2, 0, -1):
        filled = words[i - 1].norm in ("fill", "filled", "filling") and words[i].norm in ("in", "up")
        if filled and words[i + 1].norm in DETERMINERS | POSSESSIVES.keys():
            del words[i]


def _count_halves(words: list[Word]) -> None:
    """Read *half a dozen* as 6, and *half of the eight cups* as *4 of the eight cups*."""
    for i in range(len(words) - 3, -1, -1):
        norms = [word.norm for word in words[i : i + 4]]
        if norms[:3] == ["half", "a", "dozen"]:
            words[i].norm, words[i].end = "6", words[i + 2].end
            del words[i + 1 : i + 3]
        elif (
            len(norms) == 4 and norms[0] == "half" and norms[1] == "of" and norms[2] in DETERMINERS | POSSESSIVES.keys()
        ):
            number = NUMBERS.get(norms[3]) or (int(norms[3]) if norms[3].isdecimal() else 1)
            if number % 2 == 0:
                words[i].norm = str(number // 2)


def _without_floating_each(words: list[Word]) -> None:
    """Leave out *each* after the things that it is about: *the cups each have a lid*, *they have a lid each*.

    *One each side of it* is *one either side of it*.
    """
    for i in range(len(words) - 3, 0, -1):
        if [word.norm for word in words[i : i + 3]] == ["each", "side", "of"] and words[i - 1].norm in ("one", "two"):
            words[i].norm = "either"
    for i in range(len(words) - 1, 1, -1):
        before, after = words[i - 1], words[i + 1].norm if i + 1 < len(words) else "."
        if words[i].norm != "each" or not before.is_word:
            continue
        noun = before.norm not in _BEFORE_EACH and before.norm not in prepositions()
        form = verb_forms().get(after)
        verb = after in ("have", "are") or (form is not None and form.form == "base" and form.kind == "posture")
        if (noun and (verb or after in (".", ",", ";", "!", "and"))) or (
            before.norm in ("are", "were") and after in prepositions()
        ):
            words[i - 1].end = words[i].end
            del words[i]


_BEFORE_EACH = word_set("one and or but of with then have has are is were was be")
"""Words after which *each* is a subject or a number of its own: *one each*."""


def without_request(words: list[Word]) -> bool:
    """Leave out the words that make a command polite, and return True if there are any.

    Parameters
    ----------
    words
        Words of a sentence, which are changed: *could you please put the cup on it?* becomes *put the cup on it*.
        A question about placing something, without *please*, stays one.

    Returns
    -------
    bool
        False for a question or a statement.
    """
    start = next((i for i, word in enumerate(words) if word.is_word and word.norm not in _BEFORE_REQUESTS), 0)
    norms = [word.norm for word in words[start : start + 4]]
    if len(norms) < 4 or norms[0] not in ("can", "could", "would", "will") or norms[1] != "you":
        return False
    verb = start + 2 + (norms[2] in ("please", "kindly", "just"))
    form = verb_forms().get(words[verb].norm)
    if words[verb].norm in PUT_VERBS:
        asked = any(word.norm == "please" for word in words)
    else:
        asked = form is not None and form.form == "base" and form.kind == "other"
    thing = words[verb + 1].norm if verb + 1 < len(words) else ""
    named = thing in POSSESSIVES or thing in ("the", "this", "that", "these", "those", "it", "them")
    if not asked or not named or words[verb].norm in _NOT_ASKED:
        return False  # 'would you put a cup on it?' may mean that no person would
    del words[start:verb]
    return True


_BEFORE_REQUESTS = word_set("oh and hi so please ok okay also then now but hey")
_NOT_ASKED = word_set("think believe want like say know mean need prefer see find expect happen allow let")
"""Verbs after *could you* that ask for no action."""


def _join_corrections(words: list[Word]) -> None:
    """Make each correction one word between commas: *uh, scratch that, in front of it*, *sorry, no, the cup …*."""
    for i in range(len(words) - 1, 0, -1):
        if words[i].norm in _FILLERS and words[i - 1].norm == ",":
            closed = i + 1 < len(words) and words[i + 1].norm == ","
            del words[i - closed : i + 1]
    for i in range(len(words) - 2, 0, -1):
        if (words[i].norm, words[i + 1].norm) in _CORRECTING and not words[i - 1].is_word:
            words[i].norm, words[i].end = "correction", words[i + 1].end
            del words[i + 1]
            if i + 1 < len(words) and words[i + 1].is_word:
                words.insert(i + 1, replace(words[i], norm=",", is_word=False))
    for i in range(len(words) - 3, 0, -1):
        if words[i].norm in _CORRECTIONS and words[i + 1].norm == "," and words[i + 2].norm in _CORRECTIONS:
            del words[i : i + 2]


def _is_preposition(words: list[Word], at: int) -> bool:
    """Return True for a preposition of one or two words: *on*, *left of*."""
    return words[at].norm in prepositions() or " ".join(word.norm for word in words[at : at + 2]) in prepositions()


def _without_corrected(words: list[Word]) -> None:
    """Leave out a place or a thing that the speaker takes back: *on the left, no, sorry, on the right*."""
    for i in range(len(words) - 3, 1, -1):
        corrects = words[i].norm in _CORRECTIONS and not words[i - 1].is_word and not words[i + 1].is_word
        if not corrects or not _is_preposition(words, i + 2):
            continue
        start = i - 1
        while start > 0 and (not words[start].is_word or words[start].norm == "no"):
            start -= 1
        while start > 0 and (words[start].norm == "of" or not _is_preposition(words, start)):
            start -= 1
        if start > 0:
            del words[start : i + 2]
            return
    for i in range(2, len(words) - 3):
        corrects = words[i].norm in _CORRECTIONS and words[i - 1].norm == "," and words[i + 1].norm == ","
        if not corrects or words[i + 2].norm not in DETERMINERS:
            continue
        start = i - 2
        while start > 0 and words[start].is_word and words[start].norm not in DETERMINERS:
            start -= 1
        if words[start].norm in DETERMINERS:
            del words[start : i + 2]  # 'the cup, no, the glass, is …'
            return


def _read_progressive(words: list[Word]) -> None:
    """Read *we are putting the flowers on it* as *we put the flowers on it*."""
    for i in range(len(words) - 3, 0, -1):
        form = verb_forms().get(words[i + 1].norm)
        placing = form is not None and form.form == "ing" and form.lemma in PLACING_VERBS
        placing = placing and words[i + 2].norm in DETERMINERS | POSSESSIVES.keys()
        if placing and form is not None and words[i].norm in ("am", "are") and words[i - 1].norm in ("i", "we", "you"):
            words[i + 1].norm = form.lemma
            del words[i]


def _with_commands_after_places(words: list[Word]) -> None:
    """Read *to the right we place the cup* and *on those place the cup* as *to the right, place the cup*."""
    if all(word.norm != "than" for word in words):
        for i in range(len(words) - 3, -1, -1):
            after = [word.norm for word in words[i + 1 : i + 4]]
            if words[i].norm in ("further", "farther") and after in (["to", "the", "left"], ["to", "the", "right"]):
                del words[i]
    for verb in range(len(words) - 2, 1, -1):
        following = words[verb + 1].norm
        commands = words[verb].norm in PUT_VERBS and (following in DETERMINERS or following in POSSESSIVES)
        if not commands:
            continue
        end = verb
        while end > 1 and words[end - 1].norm in ("now", "should", "then"):
            end -= 1
        if words[end - 1].norm in ("you", "we"):
            end -= 1
        elif end < verb:
            continue
        has_words_before_verb = end < verb
        first = end - 1
        while first > 0 and words[first - 1].norm not in (";", ":", ".", "and", "then", "("):
            first -= 1
        opening = [word.norm for word in words[first:end] if word.norm not in ADVERBS]
        while opening and (opening[0] in HEDGES or degree_of(opening[0])[1] is not Degree.PLAIN):
            del opening[0]
        rest = [word.norm for word in words[verb + 1 :]]
        rest = rest[: next((i for i, norm in enumerate(rest) if norm in (",", ";", ":", ".")), len(rest))]
        place = opening[:1] != [] and (opening[0] in _FRONTED or opening[0] in DIRECTION_WORDS) and len(opening) > 1
        if not place or not _SAYS_MORE.isdisjoint(opening) or not IS_FORMS.isdisjoint(rest):
            continue
        marked = words[end - 1].norm == ","
        if not has_words_before_verb and (marked or words[end - 1].norm not in _POINTING | PLACE_NOUNS.keys()):
            continue
        comma = [] if marked else [Word(",", ",", words[end - 1].end, words[end - 1].end, False)]
        words[end:verb] = comma


_FRONTED = word_set("on at in to above below beneath under behind beside between next near over across opposite inside")
"""Prepositions with which a place begins that stands before a command."""
_POINTING = frozenset({"this", "that", "these", "those"})
_SAYS_MORE = IS_FORMS | MODALS.keys() | word_set("if when while before after until you we they who which order")
"""Words of clauses, and of phrases that do not name a place."""
DOUBT = re.compile(
    r"\s*if\s+(?:in\s+doubt\s*,"
    r"|you(?:\s+are|['\u2019]re|\s+were)?\s*(?:not|\s(?:are|were)n['\u2019]t|ever\s+un|un)\s*(?:sure|certain)\b[^,.;]*,"
    r"|you\s+(?:ever\s+)?(?:forget|(?:do\s+not|don['\u2019]t)\s+(?:know|remember)|mix\s+up)\s+(?:where|which|how)\b[^,.;]*,)",
    re.I,
)
"""Beginning of a sentence that limits nothing: *if in doubt, …*, *if you are not sure where it goes, …*."""


def _without_doubts_of_the_reader(text: str, span: Span, words: list[Word]) -> None:
    """Leave out *if in doubt* and similar phrases at the beginning of a sentence."""
    doubt = DOUBT.match(text, *span)
    if doubt is not None:
        words[:] = [word for word in words if word.start >= doubt.end()]


def _without_labels_of_denials(found: list[Word]) -> None:
    """Read *Don't: put salt on the rice* as a command that is denied."""
    first = [word.norm for word in found[:3]]
    colon = 2 if first[:2] == ["do", "not"] else 1 if first[:1] == ["never"] else 0
    if colon and len(found) > colon + 1 and found[colon].norm == ":":
        del found[colon]


def words_of(text: str, span: Span) -> list[Word]:
    """Return the words and the punctuation marks of a sentence, reworded.

    Parameters
    ----------
    text
        Text in English.
    span
        First and last character of the sentence, counted from 0, the end exclusive.

    Returns
    -------
    list of Word
        Words with their places and normal forms: lower case, full forms for contractions, corrected typing errors.
        Words that say nothing about places are left out, and phrases are replaced by plainer ones.

    Examples
    --------
    >>> [word.norm for word in words_of("The cup isn't on the left-hand side.", (0, 36))]
    ['the', 'cup', 'is', 'not', 'on', 'the', 'left', 'side', '.']
    """
    found = cut_words(text, span)
    ends = len(found) - (not found[-1].is_word and found[-1].norm in (".", "!")) if found else 0
    brackets = [i for i in range(ends) if found[i].norm in ("(", ")")]
    if brackets == [0, ends - 1]:
        del found[ends - 1], found[0]  # the whole sentence is in parentheses
    _without_labels_of_denials(found)
    _join_asides(text, found)
    _read_hours(found)
    _read_levels(found)
    _read_opposites(found)
    _read_and_or(found)
    _read_ranges(found)
    _without_dimensions(found)
    _read_halfway(found)
    _without_entering(found)
    _without_set_aside(found)
    _read_setups(found)
    _without_asides_in_verbs(found)
    _without_settings(found)
    _read_viewpoint(found)
    _read_facing_commands(found)
    _read_fractions(found)
    _without_cleft(found)
    _deny_contrasts(found)
    _without_inserted_adverbs(found)
    _without_following(found)
    _without_particles_of_filling(found)
    _without_and_such(found)
    _join_qualities(found)
    _without_bare_purposes(found)
    _count_halves(found)
    _without_floating_each(found)
    _join_corrections(found)
    _without_corrected(found)
    _read_progressive(found)
    _without_doubts_of_the_reader(text, span, found)
    _with_commands_after_places(found)
    for i in range(len(found) - 2, -1, -1):
        if found[i].norm in ("'ve", "have", "has", "'s", "'d") and found[i + 1].norm == "got":
            found[i].norm = "has" if found[i].norm in ("has", "'s") else "have"
            found[i].end = found[i + 1].end
            del found[i + 1]
    for i in range(len(found) - 2, -1, -1):
        if found[i].norm == found[i + 1].norm and found[i].norm in ("to", "the", "is", "a", "of", "on", "in", "and"):
            found[i].end = found[i + 1].end
            del found[i + 1]
    for i in range(len(found) - 2, 0, -1):
        if (
            found[i].norm == "it"
            and found[i + 1].norm == "'s"
            and found[i - 1].norm in ("to", "on", "with", "of", "in", "at")
        ):
            found[i].norm, found[i].end = "its", found[i + 1].end
            del found[i + 1]
    for i in range(len(found) - 1):
        if found[i].norm == "closet" and found[i + 1].norm == "to":
            found[i].norm = "closest"
        if found[i].norm == "its" and found[i + 1].norm in ("the", "a", "an", "not", "on", "in", "next", "to", "it"):
            found[i].norm = "it"
            found.insert(i + 1, Word(found[i].text, "'s", found[i].start, found[i].end, False))
    return found
