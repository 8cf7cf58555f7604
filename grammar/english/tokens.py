"""Cut a sentence into words: contractions, hyphens, codes and frequent misspellings."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass

from deixis.grammar.english.tree import Degree, Span
from deixis.grammar.english.vocabulary.adjectives import adjectives, degree_of
from deixis.grammar.english.vocabulary.function_words import (
    IS_FORMS,
    ORDINALS,
    PRONOUNS,
    TYPOS,
)
from deixis.grammar.english.vocabulary.relation_words import DIRECTION_WORDS, prepositions
from deixis.grammar.english.vocabulary.tables import LITERAL, word_set

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
ABBREVIATIONS = word_set("e.g i.e etc approx mr mrs ms dr st no fig vs cf ca min max incl ft sq a.m p.m")
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


@dataclass(slots=True)
class Word:
    """A word or a punctuation mark: ``norm`` is its form in lower case with straight apostrophes."""

    text: str
    norm: str
    start: int
    end: int
    is_word: bool  # counts as a word of the sentence: not punctuation, not the second part of a split word


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


def _says_no_place(words: str) -> bool:
    """Return True for a list of properties in brackets: *(chrome, lead frayed)*."""
    norms = words.casefold().replace(",", " ").split()
    return "," in words and (prepositions().keys() | PRONOUNS.keys() | IS_FORMS).isdisjoint(norms)


_INCH_MARKS = ('"', "\u2033", "\u201d")
"""Marks after a number of inches."""


def _is_inch_mark(text: str, start: int, at: int) -> bool:
    """Return True for a mark right after a number that closes no quotation: *2" from the edge*."""
    quoted = sum(text.count(mark, start, at) for mark in ("\u201c", '"'))
    return at > start and text[at - 1].isdigit() and quoted % 2 == 0


def cut_words(text: str, span: Span) -> list[Word]:
    """Return the words and the punctuation marks of a sentence as they are written.

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
        Words that are struck out are left out, and so are titles and what a picture shows.
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
            elif raw == "." and found and found[-1].norm in ABBREVIATIONS and found[-1].end == start and end < span[1]:
                continue
            elif raw not in "\"'\u00b4\u201c\u201d\u2018\u2019`*_#~|[]":
                found.append(Word(raw, raw, start, end, False))
            continue
        for piece, is_first in _pieces(norm):
            shown = raw[: len(piece)] if is_first else piece
            found.append(Word(shown, piece, start, end, is_first))
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
