"""Cut a text into sentences, headings and the items of lists."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from deixis.grammar.english.tokens import ABBREVIATIONS
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import PUT_VERBS, verb_forms

MAX_SENTENCE_WORDS = 400
"""Number of words after which a text without a full stop is cut."""
MAX_SENTENCE_LENGTH = 8000
"""Number of characters after which it is cut, before its words are told apart."""
MAX_ABBREVIATION = 4
"""Number of letters of a word before a full stop and a number that is an abbreviation: *inv. 112*."""
_FORMS_OF_ADDRESS = word_set("mr mrs ms dr st prof capt rev sgt lt col gen")
"""Titles before a name, with a full stop that ends no sentence."""
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
MIN_ITEMS = 4
"""Minimum number of lines of a list without marks."""
MIN_SHARE_OF_ITEMS = 0.8
"""Minimum share of the lines of such a list that begin with a capital letter."""
MAX_BLOCK = 2000
"""Number of characters around a line end in which the lines of such a list are counted."""
MAX_ITEM = 500
"""Number of characters in which the next item of a numbered list begins."""


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
            if following[:1].isupper() and _is_line_of_items(text, match.start()):
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
            abbreviated = last in ABBREVIATIONS and not following[:1].isupper()
            if abbreviated or numbered or (last in _FORMS_OF_ADDRESS and following):
                continue
        return match.end(), False
    return len(text), _is_heading(text[start:])


def _is_line_of_items(text: str, at: int) -> bool:
    """Return True if the lines around a line end are items without marks: most have a capital and no full stop."""
    first, last = text.rfind("\n\n", 0, at) + 1, text.find("\n\n", at)
    block = text[max(first, at - MAX_BLOCK) : min(last if last >= 0 else len(text), at + MAX_BLOCK)]
    lines = [line.strip() for line in block.split("\n") if line.strip()]
    capitals = sum(line[:1].isupper() for line in lines)
    stops = sum(line[-1:] in ".!?" for line in lines)
    return len(lines) >= MIN_ITEMS and capitals >= MIN_SHARE_OF_ITEMS * len(lines) and stops <= len(lines) / 2


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
