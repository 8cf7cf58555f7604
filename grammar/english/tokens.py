"""Cut a text into sentences, and a sentence into words: contractions, hyphens and frequent misspellings."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, replace

from deixis.grammar.english.tree import Degree, Span
from deixis.grammar.english.vocabulary.adjectives import QUALITIES, adjectives, degree_of, is_adjective
from deixis.grammar.english.vocabulary.function_words import (
    ADVERBS,
    DETERMINERS,
    HEDGES,
    IS_FORMS,
    MODALS,
    NUMBERS,
    ORDINALS,
    PAST_FORMS,
    POSSESSIVES,
    PRONOUNS,
    TYPOS,
    UNITS,
)
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, PLACE_NOUNS, prepositions
from deixis.grammar.english.vocabulary.tables import LITERAL, word_set
from deixis.grammar.english.vocabulary.verbs import PLACING_VERBS, PUT_VERBS, verb_forms

MAX_LABEL_WORDS = 5
"""Number of words before a dash that can be a label: *sugar bowl - behind the pot*."""
MAX_SENTENCE_WORDS = 400
"""Number of words after which a text without a full stop is cut."""
MAX_SENTENCE_LENGTH = 8000
"""Number of characters after which it is cut, before its words are told apart."""

MAX_ABBREVIATION = 4
"""Number of letters of a word before a full stop and a number that is an abbreviation: *inv. 112*."""

MAX_ASIDE_WORDS = 9
"""Number of words of an aside in a verb: *do not, if you can avoid it, put it there*."""

_PAIRED_DASHES = 2
_AUXILIARIES = MODALS.keys() | {"do", "does", "did"}
_DASHES = frozenset({"-", "\u2013", "\u2014"})
_STRUCK = re.compile(r"~~[^~\n]+~~|(?<=\w)\[\d{1,3}\]|(?<=[\s:;,])\((?:[A-Za-z]|[ivx]{1,4}|\d{1,2})\)(?=\s)")
_CODES = re.compile(
    r"\((?:[A-Za-z]{1,6}\.?\s*)?\d[\w./-]*\)"
    r"|(?<=\w)\s\d+\s?[\u2013-]\s?\d+(?=[\s,;.])(?!\s*(?:cm|mm|m|inch|feet|ft)\b)"
)
"""Codes of things, which say nothing about places: *(inv. 112)*, *samples 1\u20136*."""
_IN_BRACKETS = re.compile(r"\(([^()\n]{3,60})\)")
_CAPITAL = r"[A-Z][\w'\u2019]*"
_TITLE = rf"{_CAPITAL}(?:\s+(?:(?:an?|the|of|and|on|in|at|by|to|for|with|from|under|over|behind|near)\s+)*{_CAPITAL})+"
_TITLES = re.compile(
    r"(?<=[a-z])\s+of\s+(?=(?:On|In|Under|Over|Behind|Beside|Above|Below|Near|At|By)\s)"
    + _TITLE
    + r"|(?<=[a-z]),?\s*[\"\u201c]"
    + _TITLE
    + r"[\"\u201d],?"
    + r"|(?<=\b(?:song|book|film|play|poem|game))\s+"
    + _TITLE
    + r"|(?<=\bnovel|\bmovie|\balbum|\bstory|named)\s+"
    + _TITLE
    + r"|(?<=\bcalled)\s+"
    + _TITLE
)
"""Titles of works and names of things, whose words say nothing about places: *my copy of Under the Volcano*."""
_DEPICTED = re.compile(
    r"(?<=\w)\s+of\s+(?:an?|two|three|some)\s+(?:[\w-]+\s+){1,2}?"
    r"((?:on|in|under|behind|beside|above|near|over|at|with)\s+an?\s+(?:[\w-]+\s+){0,2}?[\w-]+"
    r"(?:\s+(?:on|in|under|behind|beside|above|near|over|at|with)\s+(?:his|her|its|their|an?)\s+[\w-]+)*)"
    r"|(?<=\w)\s+((?:on|in|under|behind|beside|above|near|over|at|with)\s+an?\s+[\w-]+)"
    r"(?=\s+(?:printed|painted|drawn|engraved|embroidered|carved|etched|stamped|woven)\b)"
)
_QUOTED = re.compile(r"[\"\u201c](?:[^\s\"\u201c\u201d]+\s+){2,}[^\s\"\u201c\u201d]+[\"\u201d]")
"""Three words or more that are quoted: a title, a sign, what a person says."""
_DEPICTIONS = re.compile(
    r"\b(?:picture|photo|photograph|painting|drawing|print|image|portrait|sketch|engraving|poster|postcard)s?$", re.I
)
_SHOWN = re.compile(
    r"\b(?:(?:picture|photo|photograph|drawing|print|image|sketch|engraving)\s+(?:on|above|over|in|at|by|behind|beside)\s"
    r"+(?:the|my|our|her|his|their)\s+[\w-]+|(?:photos|photographs|pictures|drawings|sketches)|"
    r"(?:painting|portrait|poster|postcard|mural|tapestry|stamp)"
    r"(?:\s+(?:on|above|over|in|at|by|behind|beside)\s+(?:the|my|our|her|his|their)\s+[\w-]+)?)\s+"
    r"((?:shows?|showed|depicts?|depicted|portrays?|portrayed|showing|depicting)\s[^,.;]*)",
    re.I,
)
"""Words for the content of a picture, which is not in the scene: *the photo on the wall shows a lamp on a desk*."""
_ARROWS = frozenset({"\u2192", "\u21d2", "\u27a1", "\u2794"})
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
_FORMS_OF_ADDRESS = word_set("mr mrs ms dr st prof capt rev sgt lt col gen")
"""Titles before a name, with a full stop that ends no sentence."""
_ABBREVIATIONS = word_set("e.g i.e etc approx mr mrs ms dr st no fig vs cf ca min max incl ft sq a.m p.m")
_WORD = re.compile(
    r"`[^`\n]{1,1000}`|"
    r"(?<!\w)\w[\w-]*?_[\w-]*\w(?!\w)|"  # left_shoe
    r"\b[wW]/(?:o\b)?|\b(?:[A-Za-z]\.){2,}|"  # with, without
    r"[^\W\d_]{1,3}\d+\b|\b[A-Z]\.\d+\b|"  # codes: M1, M.2
    r"[^\W\d_]+(?:['\u2019][^\W\d_]+)*(?:-[^\W_]+(?:['\u2019][^\W\d_]+)*)*"  # words, with apostrophes and hyphens
    r"|\d+(?:[.,:]\d+)*(?:st|nd|rd|th)?(?:-[^\W\d_]+)*"  # numbers, ordinals, 3-level
    r"|['\u2019](?:s|re|m|ll|d|ve)\b"
    r"|[^\s\w]|_",
    re.UNICODE,
)
_CLITICS = ("'s", "'re", "'m", "'ll", "'d", "'ve")
_ENDS = re.compile(r"[.!?\u2026]+[\"'\u201d\u2019)\]]*(?=\s|$)|[.!?](?=[A-Z][a-z])|\n[ \t]*\n|\n")
_ALONE = re.compile(r"\([a-z][^().!?\n]{20,}\)(?=\s+[A-Z])")
"""Sentence in parentheses without a full stop of its own."""
_INCHES = re.compile(r"\d\s*in\.\Z")
"""Abbreviation of inches after a number at the end of what was read so far."""
_STEP = re.compile(
    r"[ \t]*(?:[\u2022\u25a1\u25aa\u25cf\u2610-\u2612\u2713\u2714][ \t]*|"
    r"(?:\(?(?:\d{1,3}|[a-zA-Z]|[ivx]{1,4})[.)]|[-*\u2013]"
    r"|\[[ xX]?\]|step\s+\d+(?:[.:]|[ \t]*[-\u2013\u2014])?|\d{1,3}[.:]\d+)[ \t]+)",
    re.I,
)
_BARE_STEP = re.compile(r"[ \t]*(\d{1,2})[ \t]+(?=([A-Za-z]+))")
MAX_ITEM = 500
"""Number of characters in which the next item of a numbered list begins."""


@dataclass(slots=True)
class Word:
    """A word or a punctuation mark: ``norm`` is its form in lower case with straight apostrophes."""

    text: str
    norm: str
    start: int
    end: int
    is_word: bool  # counts as a word of the sentence: not punctuation, not the second part of a split word


@dataclass(frozen=True, slots=True)
class RawSentence:
    """A sentence before parsing: its place, the number or letter of a list item, and whether it is a heading."""

    start: int
    end: int
    step: str | None = None
    heading: bool = False


def sentences(text: str) -> Iterator[RawSentence]:
    """Yield the sentences of a text.

    Full stops, question marks and blank lines end a sentence. A line end does, where the next line is a list item or
    the line is short and ends without punctuation (a heading); otherwise the lines of a paragraph are joined.

    Parameters
    ----------
    text
        Text in English.

    Yields
    ------
    RawSentence
        Span of a sentence, its list mark, and whether it is a heading; pieces without letters and digits are left out.
    """
    start, length = 0, len(text)
    step: str | None = None
    while start < length:
        while start < length and text[start].isspace():
            start += 1
        if start >= length:
            return
        if start == 0 or text[start - 1] == "\n" or not text[text.rfind("\n", 0, start) + 1 : start].strip():
            mark = _step(text, start)
            if mark is not None and mark.end() < length and text[mark.end() : mark.end() + 1] != "\n":
                step = mark[0].strip()
                start = mark.end()
        end, heading = _end_of_sentence(text, start)
        shown = end
        while shown > start and text[shown - 1].isspace():
            shown -= 1
        while shown - start > MAX_SENTENCE_LENGTH:
            space = text.rfind(" ", start + 1, start + MAX_SENTENCE_LENGTH)
            last = space if space > 0 else start + MAX_SENTENCE_LENGTH
            if any(character.isalnum() for character in text[start:last]):
                yield RawSentence(start, last, step, False)
            start = last
        if any(character.isalnum() for character in text[start:shown]):
            yield RawSentence(start, shown, step, heading and step is None)
        step = None
        start = max(end, start + 1)


def _step(text: str, start: int) -> re.Match[str] | None:
    """Return the mark of a list item that begins here; a number without a full stop counts as its neighbours do."""
    mark = _STEP.match(text, start)
    if mark is not None:
        return mark
    mark = _BARE_STEP.match(text, start)
    if mark is None or not _commands(mark):
        return None
    following = text[start : start + MAX_ITEM].split("\n")[1:]
    earlier = text[max(0, start - MAX_ITEM) : start].split("\n")[::-1]
    for lines, number in ((following, int(mark[1]) + 1), (earlier, int(mark[1]) - 1)):
        other = _BARE_STEP.match(next((line for line in lines if line.strip()), ""))
        if other is not None and int(other[1]) == number and _commands(other):
            return mark
    return None


def _commands(mark: re.Match[str]) -> bool:
    """Return True if the word after the number of a list item is a verb in its base form."""
    verb = mark[2].casefold()
    form = verb_forms().get(verb)
    return verb in PUT_VERBS or (form is not None and form.form == "base")


def _end_of_sentence(text: str, start: int) -> tuple[int, bool]:
    alone = _ALONE.match(text, start)
    if alone is not None:
        return alone.end(), False
    for match in _ENDS.finditer(text, start):
        mark = match[0]
        if mark.startswith("\n"):
            if mark.count("\n") > 1:
                line = text[start : match.start()]
                more = bool(text[match.end() :].strip())
                return match.end(), _is_heading(line) or (more and _is_title(line))
            line = text[start : match.start()]
            following = text[match.end() : match.end() + 80]
            if _step(text, match.end()) or line.rstrip().endswith((":", ";")) or _is_heading(line.rsplit("\n", 1)[-1]):
                return match.end(), _is_heading(line)
            if "\n" not in line and following[:1].isupper() and len(line) < 60 and not line.rstrip().endswith(","):
                return match.end(), False
            continue
        if (
            mark == "."
            and _INCHES.search(text, start, match.end())
            and text[match.end() + 1 : match.end() + 2].islower()
        ):
            continue  # '2 in. from the edge'
        if mark == "." or mark.startswith("."):
            before = text[max(start, match.start() - 8) : match.start()].rsplit(None, 1)
            last = before[-1].casefold().lstrip("(") if before else ""
            following = text[match.end() : match.end() + 2].strip()
            numbered = following[:1].isdigit() and last.isalpha() and 1 < len(last) <= MAX_ABBREVIATION
            abbreviated = last in _ABBREVIATIONS and not following[:1].isupper()
            if abbreviated or numbered or (last in _FORMS_OF_ADDRESS and following):
                continue
        return match.end(), False
    return len(text), _is_heading(text[start:])


def _is_heading(line: str) -> bool:
    words = line.split()
    if not words or len(words) > 8 or line.rstrip()[-1] in ".,;!?":
        return False
    letters = [word for word in words if word[0].isalpha()]
    return (line.upper() == line and any(c.isalpha() for c in line) and len(words) > 1) or bool(
        line.rstrip().endswith(":") and len(words) <= 3 and len(letters) == len(words) and "\n" not in line
    )


def _is_title(line: str) -> bool:
    """Return True for a short line without a full stop before an empty line."""
    return "\n" not in line.strip() and len(line.split()) <= 8 and line.rstrip()[-1:] not in (".", "!", "?", ",", ";")


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
    """Leave out the dimensions before the name of a thing: *a 3' x 4' rug*, *a 3-foot by 4-foot board*."""
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
        i += 1


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
    """Read *a quiet, peaceful corner* without the comma, as the second word is no thing of its own."""
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


def _depicted(text: str, span: Span) -> Iterator[Span]:
    """Yield the words of a sentence that tell what a picture shows, titles of works, and what is quoted."""
    yield from (match.span(1) for match in _SHOWN.finditer(text, *span))
    for match in _QUOTED.finditer(text, *span):
        around = text[span[0] : match.start()] + text[match.end() : span[1]]
        if any(character.isalpha() for character in around):
            yield match.span()
    yield from (match.span() for match in _TITLES.finditer(text, *span))
    for match in _DEPICTED.finditer(text, *span):
        if match[1] is None or _DEPICTIONS.search(text[span[0] : match.start()]):
            yield match.span(1 if match[1] is not None else 2)


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


def _says_no_place(words: str) -> bool:
    """Return True for a list of properties in brackets: *(chrome, lead frayed)*."""
    norms = words.casefold().replace(",", " ").split()
    return "," in words and (prepositions().keys() | PRONOUNS.keys() | IS_FORMS).isdisjoint(norms)


def _without_labels_of_denials(found: list[Word]) -> None:
    """Read *Don't: put salt on the rice* as a command that is denied."""
    first = [word.norm for word in found[:3]]
    colon = 2 if first[:2] == ["do", "not"] else 1 if first[:1] == ["never"] else 0
    if colon and len(found) > colon + 1 and found[colon].norm == ":":
        del found[colon]


_INCH_MARKS = ('"', "\u2033", "\u201d")
"""Marks after a number of inches."""


def _is_inch_mark(text: str, start: int, at: int) -> bool:
    """Return True for a mark right after a number that closes no quotation: *2" from the edge*."""
    quoted = sum(text.count(mark, start, at) for mark in ("\u201c", '"'))
    return at > start and text[at - 1].isdigit() and quoted % 2 == 0


def words_of(text: str, span: Span) -> list[Word]:
    """Return the words and the punctuation marks of a sentence.

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
        Words that are struck out are left out.

    Examples
    --------
    >>> [word.norm for word in words_of("The cup isn't on the left-hand side.", (0, 36))]
    ['the', 'cup', 'is', 'not', 'on', 'the', 'left', 'side', '.']
    """
    found: list[Word] = []
    left_out = [match.span() for marks in (_STRUCK, _CODES) for match in marks.finditer(text, *span)]
    left_out += [match.span() for match in _IN_BRACKETS.finditer(text, *span) if _says_no_place(match[1])]
    left_out += _depicted(text, span)
    struck = {at for first, last in left_out for at in range(first, last)}
    for match in _WORD.finditer(text, *span):
        raw = match[0]
        start, end = match.span()
        if start in struck:
            continue
        norm = raw.casefold().replace("\u2019", "'") if raw.isascii() or "\u2019" in raw else _folded(raw)
        norm = "pick\u00a0up" if norm == "pickup" and not found else TYPOS.get(norm, norm)
        name = "_".join(raw.strip("`").split()).casefold() if raw[0] == "`" or "_" in raw[1:-1] else ""
        if name:
            found.append(Word(raw, f"{LITERAL}{name}{LITERAL}", start, end, True))
            continue
        if not raw[0].isalnum() and norm not in _CLITICS:
            if raw in _INCH_MARKS and _is_inch_mark(text, span[0], start):
                found.append(Word(raw, "inches", start, end, True))
            elif norm in ("and", "at"):
                found.append(Word(raw, norm, start, end, True))
            elif raw == "\u00d7":
                found.append(Word(raw, "x", start, end, True))
            elif raw in _ARROWS:
                found.append(Word(raw, ":", start, end, False))
            elif unicodedata.category(raw)[0] in "SMC" and raw not in "<>=":
                continue  # a pictograph, or a mark of one
            elif raw in _LENGTH_MARKS and found and _is_length(text, span, found[-1], start):
                found[-1].norm, found[-1].end = f"{found[-1].norm}-{_LENGTH_MARKS[raw]}", end
            elif (
                raw == "."
                and len(found) > 1
                and found[-1].norm == "in"
                and found[-2].norm[-1:].isdigit()
                and end < span[1]
            ):
                found[-1].norm = "inches"
            elif raw == "." and found and found[-1].norm in _ABBREVIATIONS and found[-1].end == start and end < span[1]:
                continue
            elif raw not in "\"'\u00b4\u201c\u201d\u2018\u2019`*_#~|[]":
                found.append(Word(raw, raw, start, end, False))
            continue
        for piece, is_first in _pieces(norm):
            shown = raw[: len(piece)] if is_first else piece
            found.append(Word(shown, piece, start, end, is_first))
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


_LENGTH_MARKS = {"'": "foot", "\u2019": "foot", "\u2032": "foot", '"': "inch", "\u201d": "inch", "\u2033": "inch"}
"""Marks of feet and inches after a number, by their unit."""


def _is_length(text: str, span: tuple[int, int], number: Word, at: int) -> bool:
    """Return True for the mark of *the 8' boards*, and not for the end of a quotation that was begun before."""
    mark = text[at]
    opened = sum(text[span[0] : at].count(quote) for quote in {mark, "\u201c" if mark in '"\u201d' else mark})
    apostrophes = len(re.findall(rf"(?<=\w){mark}(?=\w)", text[span[0] : at]))
    quotes = mark not in "\u2032\u2033" and (opened - apostrophes) % 2 == 1
    return number.norm.isdigit() and number.end == at and not quotes


def _folded(raw: str) -> str:
    return unicodedata.normalize("NFKC", raw).casefold().replace("\u2019", "'")


def _pieces(norm: str) -> Iterator[tuple[str, bool]]:
    """Yield the words that were written as one: contractions, *left-hand*, *top-right*."""
    if norm.isalpha():
        if norm == "cannot":
            yield "can", True
            yield "not", False
        else:
            yield norm, True
        return
    if "\u00a0" in norm:
        for i, part in enumerate(norm.split("\u00a0")):
            yield part, i == 0
        return
    if norm.endswith("n't"):
        stem = {"ca": "can", "wo": "will", "sha": "shall"}.get(norm[:-3], norm[:-3])
        if stem:
            yield stem, True
        yield "not", not stem
        return
    for clitic in _CLITICS:
        if norm.endswith(clitic):
            if norm != clitic:
                yield from _pieces(norm[: -len(clitic)])
            yield clitic, norm == clitic
            return
    if norm.endswith("s'"):
        yield norm[:-1], True
        yield "'s", False
        return
    if "-" in norm:
        parts = norm.split("-")
        if all(part in DIRECTION_WORDS or part in ("most", "hand", "side") for part in parts):
            parts = [part for i, part in enumerate(parts) if i == 0 or part not in ("hand",)]
            for i, part in enumerate(parts):
                yield part, i == 0
            return
        if (parts[0] == "in" and parts[-1] in ("between",)) or parts[0] == "next":
            for i, part in enumerate(parts):
                yield part, i == 0
            return
        if len(parts) == 2 and parts[0] in ORDINALS and degree_of(parts[1])[1] is not Degree.PLAIN:
            yield parts[0], True
            yield parts[1], False
            return
        if len(parts) == 3 and parts[1] == "and" and parts[0] in adjectives():
            for i, part in enumerate(parts):
                yield part, i == 0
            return
    yield norm, True
