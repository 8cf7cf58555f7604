"""The header of a PLY file, checked line by line."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from deixis.perception.checks import shown
from deixis.perception.clouds.content import Content
from deixis.perception.errors import CloudError

ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
"""Formats, and the order of bytes as numpy writes it."""
MAX_PROPERTIES = 1024
"""How many properties an element has at the most."""

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"},
}


@dataclass(frozen=True)
class Property:
    """A number in every row of an element; or, where ``length`` is given, a list with a length of that type first."""

    name: str
    dtype: np.dtype[np.generic]
    length: np.dtype[np.generic] | None = None

    @property
    def least_bytes(self) -> int:
        """How many bytes it has in a binary row at the least."""
        return (self.length or self.dtype).itemsize


@dataclass(frozen=True)
class Element:
    """A table of ``rows`` rows, in each its properties one after the other."""

    name: str
    rows: int
    properties: tuple[Property, ...]

    @property
    def has_lists(self) -> bool:
        return any(column.length is not None for column in self.properties)


@dataclass(frozen=True)
class PlyHeader:
    """What a header declares, and ``end``, the byte at which the data begins."""

    encoding: str
    elements: tuple[Element, ...]
    end: int


def read_header(content: Content) -> PlyHeader:
    """The header of a PLY file; raises CloudError, with the line, where it is none."""
    encoding = ""
    elements: list[Element] = []
    for number, line, end in content.header_lines():
        keyword, *words = line.split() or ["comment"]
        where = f"{content.name}:{number}"
        if number == 1 and line != "ply":
            raise CloudError(f"{where}: a PLY file begins with the line 'ply'; this is another format")
        if keyword == "format":
            encoding = _encoding(words, encoding, where)
        elif keyword == "element":
            elements.append(_element(words, elements, encoding, where))
        elif keyword == "property":
            elements[-1:] = [_with_property(words, elements, ORDERS[encoding or "ascii"], where)]
        elif keyword == "end_header":
            if all(element.name != "vertex" for element in elements):
                raise CloudError(f"{where}: the header has no element 'vertex', so there are no points; add it")
            return PlyHeader(encoding, tuple(elements), end)
        elif number > 1 and keyword not in ("comment", "obj_info"):
            raise CloudError(f"{where}: '{shown(keyword)}' is no entry of a PLY header; take the line out")
    raise AssertionError("header_lines raises at the end of the file")


def _encoding(words: list[str], before: str, where: str) -> str:
    if before or len(words) != 2 or words[0] not in ORDERS or words[1] != "1.0":
        raise CloudError(f"{where}: give one format: {', '.join(ORDERS)}, and 1.0 after it")
    return words[0]


def _element(words: list[str], before: list[Element], encoding: str, where: str) -> Element:
    if not encoding:
        raise CloudError(f"{where}: an element before the format; put the line 'format ascii 1.0' or the like first")
    if len(words) != 2 or not re.fullmatch(r"[0-9]{1,15}", words[1]):
        raise CloudError(f"{where}: an element has a name and a whole number of rows: element vertex 8")
    if any(element.name == words[0] for element in before):
        raise CloudError(f"{where}: a second element '{shown(words[0])}'; rename one")
    return Element(words[0], int(words[1]), ())


def _with_property(words: list[str], elements: list[Element], order: str, where: str) -> Element:
    """The last element with one property more."""
    if not elements:
        raise CloudError(f"{where}: a property before any element; put the line 'element …' before it")
    types = [_TYPES.get(word) for word in (words[1:3] if words[:1] == ["list"] else words[:1])]
    if len(words) != (4 if words[:1] == ["list"] else 2) or None in types:
        raise CloudError(
            f"{where}: a property has a type and a name ('float x'), or is a list ('list uchar int vertex_indices');"
            f" types are {', '.join(sorted(_TYPES))}"
        )
    dtypes = [np.dtype(f"{order}{kind}") for kind in types]
    last = elements[-1]
    if any(column.name == words[-1] for column in last.properties):
        raise CloudError(f"{where}: a second property '{shown(words[-1])}' of '{shown(last.name)}'; rename one")
    if len(last.properties) == MAX_PROPERTIES:
        raise CloudError(f"{where}: more than {MAX_PROPERTIES} properties of '{shown(last.name)}'; leave some out")
    if len(dtypes) == 2 and dtypes[0].kind == "f":
        raise CloudError(f"{where}: the length of a list is a whole number; give a type such as uchar")
    added = Property(words[-1], dtypes[-1], dtypes[0] if len(dtypes) == 2 else None)
    return Element(last.name, last.rows, (*last.properties, added))
