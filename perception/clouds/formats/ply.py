"""Read PLY, the Stanford polygon format, as clouds and as meshes: ascii, and binary in either byte order.

The format: G. Turk, "The PLY Polygon File Format" (1994). The readers keep the columns of the element ``vertex`` that
:mod:`deixis.perception.clouds.tables.columns` knows, and the list of corners of the element ``face``; they skip
everything else. A file that is read as a cloud is checked to its end too.
"""

from __future__ import annotations

import re
from collections.abc import Set
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.mesh import Mesh, fans
from deixis.perception.clouds.tables.columns import KNOWN, POINT, Columns, cloud_of_columns, declared
from deixis.perception.clouds.tables.number_table import read_table
from deixis.perception.errors import CloudError

ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
"""Byte order of each format, as a numpy character."""
MAX_PROPERTIES = 1024
"""Maximum number of properties of an element."""

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"},
}


@dataclass(frozen=True)
class Property:
    """Number in every row of an element; or a list, if ``length`` gives the type of the length before its values."""

    name: str
    dtype: np.dtype[np.number]
    length: np.dtype[np.generic] | None = None

    @property
    def least_bytes(self) -> int:
        """Minimum number of bytes of the property in a binary row."""
        return (self.length or self.dtype).itemsize


@dataclass(frozen=True)
class Element:
    """Table of ``rows`` rows, each with the properties one after another."""

    name: str
    rows: int
    properties: tuple[Property, ...]

    @property
    def has_lists(self) -> bool:
        """True if a property is a list."""
        return any(column.length is not None for column in self.properties)


@dataclass(frozen=True)
class PlyHeader:
    """Content of a header, and ``end``, the byte at which the data begins."""

    encoding: str
    elements: tuple[Element, ...]
    end: int


def read_header(content: Content) -> PlyHeader:
    """Return the header of a PLY file.

    Parameters
    ----------
    content
        The file.

    Returns
    -------
    PlyHeader
        The elements with their properties, and the encoding.

    Raises
    ------
    CloudError
        If the header is malformed; the message has the line.
    """
    encoding = ""
    elements: dict[str, Element] = {}
    for number, line, end in content.header_lines():
        keyword, *words = line.split() or ["comment"]
        where = f"{content.name}:{number}"
        if number == 1 and line != "ply":
            raise CloudError(f"{where}: the first line of a PLY file must be 'ply'; this is another format")
        if keyword == "format":
            encoding = _encoding(words, encoding, where)
        elif keyword == "element":
            added = _element(words, elements, encoding, where)
            elements[added.name] = added
        elif keyword == "property":
            widened = _with_property(words, elements, ORDERS[encoding or "ascii"], where)
            elements[widened.name] = widened
        elif keyword == "end_header":
            if "vertex" not in elements:
                raise CloudError(f"{where}: the header has no element 'vertex', so there are no points; add it")
            for element in elements.values():
                if element.rows and not element.properties:
                    raise CloudError(
                        f"{where}: the element '{shown(element.name)}' has no property; add one, or take it out"
                    )
            return PlyHeader(encoding, tuple(elements.values()), end)
        elif number > 1 and keyword not in ("comment", "obj_info"):
            raise CloudError(f"{where}: unknown entry '{shown(keyword)}' in a PLY header; take the line out")
    raise AssertionError("header_lines raises at the end of the file")


def _encoding(words: list[str], before: str, where: str) -> str:
    if before or len(words) != 2 or words[0] not in ORDERS or words[1] != "1.0":
        raise CloudError(f"{where}: the format must be given once, as {', '.join(ORDERS)}, followed by 1.0")
    return words[0]


def _element(words: list[str], before: dict[str, Element], encoding: str, where: str) -> Element:
    if not encoding:
        raise CloudError(
            f"{where}: the format must come before the first element; add a line such as 'format ascii 1.0'"
        )
    if len(words) != 2 or not re.fullmatch(r"[0-9]{1,15}", words[1]):
        raise CloudError(f"{where}: an element must have a name and a number of rows, such as 'element vertex 8'")
    if words[0] in before:
        raise CloudError(f"{where}: the element '{shown(words[0])}' is declared twice; rename one")
    return Element(words[0], int(words[1]), ())


def _with_property(words: list[str], elements: dict[str, Element], order: str, where: str) -> Element:
    """Return the last element with one more property."""
    if not elements:
        raise CloudError(f"{where}: a property must follow an element; put a line 'element …' before it")
    types = [_TYPES.get(word) for word in (words[1:3] if words[:1] == ["list"] else words[:1])]
    if len(words) != (4 if words[:1] == ["list"] else 2) or None in types:
        raise CloudError(
            f"{where}: a property must have a type and a name ('float x'), or be a list ('list uchar int"
            f" vertex_indices'); the types are {', '.join(sorted(_TYPES))}"
        )
    dtypes = [np.dtype(f"{order}{kind}") for kind in types]
    last = next(reversed(elements.values()))
    if any(column.name == words[-1] for column in last.properties):
        raise CloudError(
            f"{where}: the property '{shown(words[-1])}' of '{shown(last.name)}' is declared twice; rename one"
        )
    if len(last.properties) == MAX_PROPERTIES:
        raise CloudError(
            f"{where}: '{shown(last.name)}' must have at most {MAX_PROPERTIES} properties, got more; leave some out"
        )
    if len(dtypes) == 2 and dtypes[0].kind == "f":
        raise CloudError(f"{where}: the length of a list must be a whole number; give a type such as uchar")
    added = Property(words[-1], dtypes[-1], dtypes[0] if len(dtypes) == 2 else None)
    return Element(last.name, last.rows, (*last.properties, added))


@dataclass(frozen=True, eq=False)
class ElementTable:
    """Columns and list that were read from one element, and ``end``, the byte at which the next element begins."""

    end: int
    columns: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    lengths: NDArray[np.int64] | None = None
    values: NDArray[np.number] | None = None


def text_table(content: Content, at: int, element: Element, wanted: Set[str]) -> ElementTable:
    """Read an ascii element, one row per line.

    Parameters
    ----------
    content
        The file.
    at
        Byte at which the element begins.
    element
        Its properties and its number of rows.
    wanted
        Names of the properties to read.

    Returns
    -------
    ElementTable
        The properties, and the end of the element in bytes.

    Raises
    ------
    CloudError
        If the element is malformed; the message has the line.
    """
    properties = list(enumerate(element.properties))
    lists = [place for place, column in properties if column.length is not None]
    kept = next((place for place in lists if element.properties[place].name in wanted), -1)
    scalars = [place for place, column in properties if column.length is None and column.name in wanted]
    read = read_table(content, at, element.rows, len(properties), scalars, lists, kept)
    columns = {}
    for slot, place in enumerate(scalars):
        column = element.properties[place]
        columns[column.name] = declared(read.columns[:, slot], column.dtype, column.name, content.name)
    if kept < 0:
        return ElementTable(read.end, columns)
    return ElementTable(read.end, columns, read.lengths, read.values)


def binary_table(content: Content, at: int, element: Element, wanted: Set[str]) -> ElementTable:
    """Read a binary element.

    Parameters
    ----------
    content
        The file.
    at
        Byte at which the element begins.
    element
        Its properties and its number of rows.
    wanted
        Names of the properties to read.

    Returns
    -------
    ElementTable
        The properties, and the end of the element in bytes.

    Raises
    ------
    CloudError
        If the file is too short for it; the message has the byte.
    """
    least = element.rows * sum(column.least_bytes for column in element.properties)
    if at + least > len(content):
        raise _too_short(content, at, element, least)
    if element.has_lists:
        return _binary_lists(content, at, element, wanted)
    layout = np.dtype([(f"{place}", column.dtype) for place, column in enumerate(element.properties)])
    rows = content.data[at : at + least].view(layout) if least else np.empty(element.rows, layout)
    names = [column.name for column in element.properties]
    return ElementTable(at + least, {name: rows[f"{place}"] for place, name in enumerate(names) if name in wanted})


def _binary_lists(content: Content, at: int, element: Element, wanted: Set[str]) -> ElementTable:
    from deixis.perception.clouds.tables.table_kernels import BAD_LENGTH, SKIPPED, TOO_SHORT, walk_rows

    properties = element.properties
    chosen = [place for place, column in enumerate(properties) if column.name in wanted]
    slots = np.full(len(properties), SKIPPED, np.int64)
    slots[chosen] = np.arange(len(chosen))
    starts, lengths = np.empty((2, element.rows, len(chosen)), np.int64)
    status, at, row = walk_rows(
        content.data,
        at,
        np.array([column.dtype.itemsize for column in properties]),
        np.array([0 if column.length is None else column.length.itemsize for column in properties]),
        np.array([column.length is not None and column.length.kind == "i" for column in properties]),
        any((column.length or column.dtype).str[0] == ">" for column in properties),
        slots,
        starts,
        lengths,
    )
    if status == BAD_LENGTH:
        raise CloudError(
            f"{content.name}: byte {at}: the length of a list is negative in {element.name} {row}; correct it"
        )
    if status == TOO_SHORT:
        raise _too_short(content, at, element, 0, row)
    table = ElementTable(at)
    for slot, place in enumerate(chosen):
        column = properties[place]
        values = _gathered(content.data, starts[:, slot], lengths[:, slot], column.dtype)
        if column.length is None:
            table.columns[column.name] = values
        else:
            table = ElementTable(at, table.columns, lengths[:, slot], values)
    return table


def _gathered(
    data: NDArray[np.uint8], starts: NDArray[np.int64], lengths: NDArray[np.int64], dtype: np.dtype[np.number]
) -> NDArray[np.number]:
    """Return the values of all lists, concatenated; list i begins at byte ``starts[i]``."""
    size = dtype.itemsize
    before = np.cumsum(lengths) - lengths
    at = np.repeat(starts - before * size, lengths) + np.arange(lengths.sum()) * size
    values: NDArray[np.number] = data[at[:, None] + np.arange(size)].view(dtype)[:, 0]
    return values


def _too_short(content: Content, at: int, element: Element, least: int, row: int = 0) -> CloudError:
    what = f"in row {row} of" if row or not least else f"the header declares at least {least} bytes for"
    return CloudError(
        f"{content.name}: byte {at}: the file ends {len(content) - at} bytes later, within element"
        f" '{shown(element.name)}' ({what} its {element.rows} rows); correct the count, or get the whole file"
    )


CORNERS = frozenset({"vertex_indices", "vertex_index"})


def read_ply(content: Content) -> PointCloud:
    """Return the vertices of a PLY file as a cloud.

    Parameters
    ----------
    content
        The file.

    Returns
    -------
    PointCloud
        The cloud.

    Raises
    ------
    CloudError
        If the file is malformed; the message has the line or byte.
    """
    columns, _, _ = _body(content)
    return cloud_of_columns(columns, content.name)


def read_ply_mesh(content: Content) -> Mesh:
    """Return the vertices and faces of a PLY file as a mesh.

    Parameters
    ----------
    content
        The file.

    Returns
    -------
    Mesh
        The mesh.

    Raises
    ------
    CloudError
        If the file has no faces or is malformed.
    """
    columns, lengths, corners = _body(content)
    missing = [name for name in POINT if name not in columns]
    if missing:
        raise CloudError(f"{content.name}: there is no property '{missing[0]}' of vertex; add x, y and z")
    faces, _ = fans(lengths, corners)
    if not len(faces):
        raise CloudError(f"{content.name}: there is no face in this file; it is a cloud and not a mesh")
    return Mesh(np.stack([columns[name] for name in POINT], axis=1).astype(np.float64), faces)


def _body(content: Content) -> tuple[Columns, NDArray[np.int64], NDArray[np.int64]]:
    """Return the columns of the vertices, the number of corners of each face, and all corners, concatenated."""
    header = read_header(content)
    read = text_table if header.encoding == "ascii" else binary_table
    tables: dict[str, ElementTable] = {}
    at = header.end
    for element in header.elements:
        wanted = {"vertex": KNOWN, "face": CORNERS}.get(element.name, frozenset[str]())
        tables[element.name] = read(content, at, element, wanted)
        at = tables[element.name].end
    content.refuse_rest(at)
    face = tables.get("face")
    if face is None or face.lengths is None or face.values is None:
        return tables["vertex"].columns, np.empty(0, np.int64), np.empty(0, np.int64)
    vertices = next(element.rows for element in header.elements if element.name == "vertex")
    return tables["vertex"].columns, face.lengths, _corners(content.name, vertices, face.lengths, face.values)


def _corners(file: str, vertices: int, lengths: NDArray[np.int64], values: NDArray[np.number]) -> NDArray[np.int64]:
    """Return the values as corners; raise CloudError if one is not a vertex."""
    good = (values >= 0) & (values < vertices) & (values == np.floor(values))
    if not good.all():
        wrong = int(np.argmin(good))
        face = int(np.searchsorted(np.cumsum(lengths), wrong, side="right"))
        raise CloudError(
            f"{file}: the corners of face {face} must be vertices from 0 to {vertices - 1}, got {values[wrong]:g};"
            " correct the face or the count"
        )
    return values.astype(np.int64)
