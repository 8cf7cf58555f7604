"""Read ``nouns.txt``: everyday nouns as kinds below those of the TBox, with synonyms and usual sizes.

The file is plain text and not Turtle because every command reads the TBox at its start, and most need none of these
nouns: they are read at the first word that the TBox does not know. Its format is described at its top.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from deixis.errors import OntologyError
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.things.kinds import Kind
from deixis.ontology.things.sizes import Extent, Outline, SizeRange

NOUNS_FILE = Path(__file__).with_name("nouns.txt")

SPREAD = 1.5
"""Ratio of the greatest to the typical length and of the typical to the least, where the file states none."""

SOURCE = "Estimate of the maintainers, deliberately wide."

_NAMESPACE = DX.THING.value.removesuffix("Thing")

_SIZE = re.compile(r"(d?)([\d.]+)x([\d.]+)(?:x([\d.]+))?(?: \*([\d.]+))?")


@dataclass(frozen=True, slots=True)
class Nouns:
    """Kinds of the lexicon by IRI, their sizes, their parents, and further words of kinds of the TBox."""

    kinds: Mapping[str, Kind]
    sizes: Mapping[str, SizeRange]
    parents: Mapping[str, tuple[str, ...]]
    words: Mapping[str, tuple[Kind, ...]]


@dataclass(frozen=True, slots=True)
class _Line:
    number: int
    depth: int
    nouns: tuple[tuple[str, ...], ...]  # the synonyms of each
    size: str | None

    def error(self, message: str) -> OntologyError:
        return OntologyError(f"{NOUNS_FILE.name}:{self.number}: {message}")


def read_nouns(known: Mapping[str, Kind], text: str | None = None) -> Nouns:
    """Read the nouns of the lexicon.

    Parameters
    ----------
    known
        Kinds of the TBox by word. A line that is not indented starts with one of them, or with a noun of a line above.
    text
        Content of the file; the shipped one by default.

    Returns
    -------
    Nouns
        The nouns with their kinds, synonyms and sizes.

    Raises
    ------
    OntologyError
        If a line cannot be read, with its number, or if a line that is not indented stands for no kind stated before.
    """
    kinds: dict[str, Kind] = {}
    sizes: dict[str, SizeRange] = {}
    parents: dict[str, tuple[str, ...]] = {}
    words: dict[str, list[Kind]] = {}
    above: list[Kind] = []
    for line in _lines(NOUNS_FILE.read_text(encoding="utf-8") if text is None else text):
        if line.depth > len(above):
            raise line.error("a line is at most one step deeper than the noun above, which must be the only one there")
        del above[line.depth :]
        size = _size(line)
        for synonyms in line.nouns:
            if above:
                parent = above[-1]
                iri = iri_of(synonyms[0])
                if iri in kinds or synonyms[0] in known:
                    iri = f"{iri}_{parent.name}"  # a homonym: the fly, an insect, or the sense of a word of the TBox
                if iri in kinds:
                    raise line.error(f"'{synonyms[0]}' is below '{parent.label}' twice")
                kind = kinds[iri] = Kind(iri, synonyms[0], synonyms, parent.broader | {parent.iri})
                parents[iri] = (parent.iri,)
                if size is not None:
                    sizes[iri] = replace(size, stated_of=iri)
            elif (synonyms[0] in known or synonyms[0] in words) and size is None:
                kind = known[synonyms[0]] if synonyms[0] in known else words[synonyms[0]][0]
            else:
                raise line.error(f"'{synonyms[0]}' must be a kind stated before, without a size, or be indented")
            for word in synonyms:
                if known.get(word) is not kind and kind not in words.setdefault(word, []):
                    words[word].append(kind)
        if len(line.nouns) == 1:
            above.append(kind)
    return Nouns(kinds, sizes, parents, {word: tuple(meant) for word, meant in words.items()})


def listed_words(known: Mapping[str, Kind], text: str | None = None) -> frozenset[str]:
    """Return the words that may have a kind in the lexicon, as they are and as one word, without making the kinds.

    It takes a tenth of the time of :func:`read_nouns`, and shows for which words that is needed: not for those that
    only repeat a word of the TBox (``known``) as the noun above others.

    Parameters
    ----------
    known
        Kinds of the TBox by word.
    text
        Text in the format of ``nouns.txt``; the shipped file by default.

    Returns
    -------
    frozenset of str
        The words as they are written, and again without spaces and apostrophes.
    """
    words: set[str] = set()
    for raw in (NOUNS_FILE.read_text(encoding="utf-8") if text is None else text).splitlines():
        named = raw.partition("#")[0].partition(":")[0]
        for noun in named.split(";") if named.strip() else ():
            synonyms = [word.strip() for word in noun.split(",")]
            kind = None if named.startswith(" ") else known.get(synonyms[0])
            words.update(word for word in synonyms if kind is None or known.get(word) is not kind)
    return frozenset(words | {word.replace(" ", "").replace("'", "") for word in words})


def iri_of(label: str) -> str:
    """Return the IRI of the kind with a label.

    Parameters
    ----------
    label
        The label, in words.

    Returns
    -------
    str
        The IRI in the namespace of Deixis.

    Examples
    --------
    >>> iri_of("coffee table").rpartition("#")[2]
    'CoffeeTable'
    """
    return _NAMESPACE + label.replace("'", "").title().replace(" ", "")


def _lines(text: str) -> Iterator[_Line]:
    for number, raw in enumerate(text.splitlines(), 1):
        content = raw.partition("#")[0].rstrip()
        if not content:
            continue
        indented = content.lstrip(" ")
        named, _, size = indented.partition(":")
        nouns = tuple(tuple(word.strip() for word in noun.split(",")) for noun in named.split(";"))
        depth, rest = divmod(len(content) - len(indented), 2)
        line = _Line(number, depth, nouns, size.strip() or None)
        if rest or not all(word for noun in nouns for word in noun):
            raise line.error("indent by two spaces a step, and separate synonyms by ', ' and nouns by '; '")
        yield line


def _size(line: _Line) -> SizeRange | None:
    if line.size is None:
        return None
    found = _SIZE.fullmatch(line.size)
    if found is None or (found[4] is None) != bool(found[1]):
        raise line.error(
            "a size must be LENGTHxWIDTHxHEIGHT or dDIAMETERxHEIGHT in centimetres, with ' *RATIO' for its spread, "
            f"got '{line.size}'"
        )
    ratio = float(found[5] or SPREAD)
    lengths = [float(found[2]), float(found[2] if found[1] else found[3]), float(found[3] if found[1] else found[4])]
    if min(lengths) <= 0 or ratio < 1 or lengths[1] > lengths[0]:
        raise line.error("lengths must be above 0, the width at most the length, and the spread at least 1")
    length, width, height = (Extent(cm / ratio / 100, cm / 100, cm * ratio / 100) for cm in lengths)
    outline = Outline.CIRCLE if found[1] else Outline.RECTANGLE
    return SizeRange(outline, length, width, height, stated_of="", source=SOURCE)
