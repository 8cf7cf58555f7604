"""Adjectives that describe things, by the dimension that they are about: colour, size, material, shape and others.

``adjectives.txt`` lists them. The colours of the TBox (:mod:`deixis.ontology.things.colours`) are not repeated there;
:meth:`Lexicon.adjective <deixis.ontology.lexicon.lexicon.Lexicon.adjective>` looks up both.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from deixis.errors import OntologyError

ADJECTIVES_FILE = Path(__file__).with_name("adjectives.txt")

DIMENSIONS = (
    "colour",
    "size",
    "height",
    "length",
    "width",
    "thickness",
    "material",
    "shape",
    "position",
    "state",
    "pattern",
    "age",
    "other",
)
"""Dimensions of adjectives."""


@dataclass(frozen=True, slots=True)
class Description:
    """Meaning of an adjective: a value on a dimension, such as ``round`` on ``shape``.

    ``sign`` is 1 for words at the greater end of a scale (*big*, *tall*), -1 for the smaller end, and 0 elsewhere.
    ``value`` is the first of the synonyms in the file: that of *circular* is ``round``.
    """

    dimension: str
    value: str
    sign: int = 0


@lru_cache(maxsize=1)
def adjectives() -> Mapping[str, Description]:
    """Return all adjectives in their plain degree by word, except the colours of the TBox.

    >>> adjectives()["circular"], adjectives()["tiny"].sign
    (Description(dimension='shape', value='round', sign=0), -1)
    """
    return read_adjectives(ADJECTIVES_FILE.read_text(encoding="utf-8"))


def read_adjectives(text: str) -> dict[str, Description]:
    """Read lines ``dimension [+|-]: word, synonym, …``.

    Parameters
    ----------
    text
        Content of the file.

    Returns
    -------
    dict
        Meaning by adjective.

    Raises
    ------
    OntologyError
        If a line differs; the message has its number.
    """
    found: dict[str, Description] = {}
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.partition("#")[0].strip()
        if not line:
            continue
        named, _, listed = line.partition(":")
        dimension, _, end = named.partition(" ")
        words = [word.strip() for word in listed.split(",")]
        if dimension not in DIMENSIONS or end not in ("", "+", "-") or not all(words):
            raise OntologyError(
                f"{ADJECTIVES_FILE.name}:{number}: a line must be 'dimension: word, synonym' with one of "
                f"{', '.join(DIMENSIONS)}, got '{line}'"
            )
        for word in words:
            if word in found:
                raise OntologyError(f"{ADJECTIVES_FILE.name}:{number}: '{word}' is in the file twice")
            found[word] = Description(dimension, words[0], {"": 0, "+": 1, "-": -1}[end])
    return found
