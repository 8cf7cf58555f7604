"""Read PCD, the format of the Point Cloud Library: ascii, binary and binary_compressed, versions 0.5 to 0.7.

The format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html. A header of lines ``KEYWORD values``
ends with ``DATA``. Compressed data consists of two 32-bit sizes, packed and plain, followed by the LZF-compressed
fields (:mod:`deixis.perception.clouds.formats.lzf`), one field after another. All binary numbers are little-endian. The
position in VIEWPOINT becomes the origin of the cloud; its orientation is not used, because points and origin share a
frame.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.tables.columns import KNOWN, cloud_of_columns, declared
from deixis.perception.clouds.tables.number_table import read_table
from deixis.perception.errors import CloudError

ENCODINGS = ("ascii", "binary", "binary_compressed")
VERSIONS = frozenset({"0.5", ".5", "0.6", ".6", "0.7", ".7"})
PADDING = "_"
"""Name of fields that only pad."""
MAX_POINT_BYTES = 2**20
"""Maximum size of a point, all fields together, in bytes."""

_KEYWORDS = frozenset(
    {"VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"}
)
_TYPES = {"F": ("4", "8"), "I": ("1", "2", "4", "8"), "U": ("1", "2", "4", "8")}


@dataclass(frozen=True)
class Field:
    """One entry of FIELDS: ``count`` little-endian numbers of one type, in every point."""

    name: str
    dtype: np.dtype[np.generic]
    count: int

    @property
    def size(self) -> int:
        """Bytes of the field in each point."""
        return self.dtype.itemsize * self.count


@dataclass(frozen=True)
class PcdHeader:
    """Content of a header, and ``end``, the byte at which the data begins."""

    fields: tuple[Field, ...]
    width: int
    height: int
    origin: tuple[float, float, float]
    encoding: str
    end: int

    @property
    def points(self) -> int:
        """Number of points."""
        return self.width * self.height

    @property
    def organised(self) -> tuple[int, int] | None:
        """Rows and columns if the points are the pixels of an image, else None."""
        return (self.height, self.width) if self.height > 1 else None


@dataclass(frozen=True)
class _Entry:
    """Values after a keyword, and their place as ``file:line``."""

    values: list[str]
    where: str

    def whole(self, value: str) -> int:
        if not re.fullmatch(r"[0-9]{1,15}", value):
            raise CloudError(f"{self.where}: a count must be a whole number of at least 0, got '{shown(value)}'")
        return int(value)

    def single(self) -> str:
        if len(self.values) != 1:
            raise CloudError(f"{self.where}: this entry must have one value, got {len(self.values)}; give just one")
        return self.values[0]


def read_header(content: Content) -> PcdHeader:
    """Return the header of a PCD file.

    Parameters
    ----------
    content
        The file.

    Returns
    -------
    PcdHeader
        The columns, the number of points and the encoding.

    Raises
    ------
    CloudError
        If the header is malformed; the message has the line.
    """
    entries, end = _entries(content)
    encoding = entries["DATA"].single().lower()
    if encoding not in ENCODINGS:
        raise CloudError(
            f"{entries['DATA'].where}: the encoding must be one of {', '.join(ENCODINGS)}, got '{shown(encoding)}'"
        )
    version = entries.get("VERSION")
    if version is not None and version.single() not in VERSIONS:
        raise CloudError(f"{version.where}: the version must be 0.5, 0.6 or 0.7, got '{shown(version.single())}'")
    width, height = _size(entries, content.name)
    named = entries.get("FIELDS", entries.get("COLUMNS"))
    if named is None or not named.values:
        raise CloudError(f"{content.name}: the header has no FIELDS; add the line FIELDS x y z")
    n = len(named.values)
    sizes, types, counts = (
        _one_each(entries.get(keyword), keyword, n, usual)
        for keyword, usual in (("SIZE", "4"), ("TYPE", "F"), ("COUNT", "1"))
    )
    fields = tuple(
        Field(name.lower(), _dtype(entries, kind, size), _count(entries, count))
        for name, kind, size, count in zip(named.values, types, sizes, counts, strict=True)
    )
    names = [field.name for field in fields if field.name != PADDING]
    twice = next((name for place, name in enumerate(names) if name in names[:place]), None)
    if twice is not None:
        raise CloudError(f"{named.where}: the field '{shown(twice)}' is declared twice; rename one")
    if sum(field.size for field in fields) > MAX_POINT_BYTES:
        raise CloudError(f"{named.where}: a point must have at most {MAX_POINT_BYTES} bytes; correct SIZE and COUNT")
    return PcdHeader(fields, width, height, _origin(entries), encoding, end)


def _entries(content: Content) -> tuple[dict[str, _Entry], int]:
    """Return the entries up to DATA by keyword, and the byte at which the data begins."""
    entries: dict[str, _Entry] = {}
    for number, line, end in content.header_lines():
        keyword, *values = line.split() or ["#"]
        where = f"{content.name}:{number}"
        if keyword.startswith("#"):
            continue
        if keyword not in _KEYWORDS:
            remedy = "take the line out" if entries else "this does not look like a PCD file"
            raise CloudError(f"{where}: unknown entry '{shown(keyword)}' in a PCD header; {remedy}")
        if keyword in entries:
            raise CloudError(f"{where}: {keyword} is given twice; take one of them out")
        entries[keyword] = _Entry(values, where)
        if keyword == "DATA":
            return entries, end
    raise AssertionError("header_lines raises at the end of the file")


def _one_each(entry: _Entry | None, keyword: str, n: int, usual: str) -> list[str]:
    if entry is None:
        return [usual] * n
    if len(entry.values) != n:
        raise CloudError(f"{entry.where}: {keyword} has {len(entry.values)} values for {n} fields; give one for each")
    return entry.values


def _dtype(entries: dict[str, _Entry], kind: str, size: str) -> np.dtype[np.generic]:
    if size not in _TYPES.get(kind, ()):
        where = entries["TYPE" if "TYPE" in entries and kind not in _TYPES else "SIZE"].where
        raise CloudError(
            f"{where}: there is no type '{shown(kind)}' of {shown(size)} bytes; F has 4 or 8, I and U have 1, 2, 4 or 8"
        )
    return np.dtype(f"<{kind.lower()}{size}")


def _count(entries: dict[str, _Entry], count: str) -> int:
    if count == "1":
        return 1
    number = entries["COUNT"].whole(count)
    if number == 0:
        raise CloudError(
            f"{entries['COUNT'].where}: the COUNT of a field must be at least 1, got 0; leave the field out"
        )
    return number


def _size(entries: dict[str, _Entry], file: str) -> tuple[int, int]:
    """Return width and height; raise CloudError if they do not agree with POINTS."""
    found = {
        keyword: entries[keyword].whole(entries[keyword].single())
        for keyword in ("WIDTH", "HEIGHT", "POINTS")
        if keyword in entries
    }
    width = found.get("WIDTH", found.get("POINTS"))
    if width is None:
        raise CloudError(f"{file}: the header has neither WIDTH nor POINTS; add the number of points")
    height = found.get("HEIGHT", 1)
    if found.get("POINTS", width * height) != width * height:
        raise CloudError(
            f"{entries['POINTS'].where}: POINTS must be WIDTH times HEIGHT, {width} * {height} = {width * height}, got"
            f" {found['POINTS']}; correct one of them"
        )
    return width, height


def _origin(entries: dict[str, _Entry]) -> tuple[float, float, float]:
    """Return the position in VIEWPOINT: tx ty tz qw qx qy qz."""
    entry = entries.get("VIEWPOINT")
    if entry is None:
        return (0.0, 0.0, 0.0)
    try:
        values = [float(value) for value in entry.values]
    except ValueError:
        values = []
    if len(values) != 7 or not all(math.isfinite(value) for value in values):
        raise CloudError(
            f"{entry.where}: VIEWPOINT must have 7 finite numbers, position and quaternion; the default is"
            " 0 0 0 1 0 0 0"
        )
    return values[0], values[1], values[2]


_Columns = dict[str, NDArray[np.generic]]


def read_pcd(content: Content) -> PointCloud:
    """Return the cloud of a PCD file.

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
    header = read_header(content)
    columns = {"ascii": _ascii, "binary": _binary, "binary_compressed": _compressed}[header.encoding](content, header)
    return cloud_of_columns(columns, content.name, header.organised, header.origin)


def _ascii(content: Content, header: PcdHeader) -> _Columns:
    first = np.cumsum([0, *(field.count for field in header.fields)]).tolist()
    wanted = [(field, first[place]) for place, field in enumerate(header.fields) if _is_known(field)]
    table = read_table(content, header.end, header.points, first[-1], [column for _, column in wanted])
    content.refuse_rest(table.end)
    return {
        field.name: declared(table.columns[:, place], field.dtype, field.name, content.name)
        for place, (field, _) in enumerate(wanted)
    }


def _binary(content: Content, header: PcdHeader) -> _Columns:
    row = sum(field.size for field in header.fields)
    end = header.end + header.points * row
    if end > len(content):
        raise _too_short(content, header.end, header.points * row, len(content) - header.end)
    content.refuse_rest(end)
    starts = np.cumsum([0, *(field.size for field in header.fields)]).tolist()
    known = [(field, starts[place]) for place, field in enumerate(header.fields) if _is_known(field)]
    layout = np.dtype(
        {
            "names": [field.name for field, _ in known],
            "formats": [field.dtype for field, _ in known],
            "offsets": [start for _, start in known],
            "itemsize": row,
        }
    )
    points = content.data[header.end : end].view(layout)
    return {field.name: points[field.name] for field, _ in known}


def _compressed(content: Content, header: PcdHeader) -> _Columns:
    plain = _unpacked(content, header)
    # PCL leaves padding out where it compresses, others do not.
    padded = sum(field.size for field in header.fields) * header.points == len(plain)
    columns, at = {}, 0
    for field in header.fields:
        if field.name == PADDING and not padded:
            continue
        end = at + field.size * header.points
        if _is_known(field):
            columns[field.name] = plain[at:end].view(field.dtype)
        at = end
    return columns


def _unpacked(content: Content, header: PcdHeader) -> NDArray[np.uint8]:
    """Return the plain bytes; sizes are compared with header and file before anything is allocated."""
    from deixis.perception.clouds.formats.lzf import MAX_EXPANSION, decompress

    begin = header.end + 8
    if begin > len(content):
        raise _too_short(content, header.end, 8, len(content) - header.end)
    packed, plain = content.data[header.end : begin].view("<u4").tolist()
    if begin + packed > len(content):
        raise _too_short(content, begin, packed, len(content) - begin)
    content.refuse_rest(begin + packed)
    unpadded = sum(field.size for field in header.fields if field.name != PADDING) * header.points
    whole = sum(field.size for field in header.fields) * header.points
    if plain not in (whole, unpadded) or plain > packed * MAX_EXPANSION:
        raise CloudError(
            f"{content.name}: byte {header.end + 4}: the data declares {packed} packed bytes for {plain} plain ones,"
            f" but the header needs {whole}; the file is damaged, write it again"
        )
    out = np.empty(plain, np.uint8)
    read, written = decompress(content.data[begin : begin + packed], out)
    if read != packed or written != plain:
        raise CloudError(
            f"{content.name}: byte {begin + read}: the compressed data is damaged ({written} of {plain} bytes could be"
            " unpacked); write the file again"
        )
    return out


def _is_known(field: Field) -> bool:
    return field.name in KNOWN and field.count == 1


def _too_short(content: Content, at: int, wanted: int, there: int) -> CloudError:
    return CloudError(
        f"{content.name}: byte {at}: the header declares {wanted} bytes of data, but {there} follow; correct its"
        " counts, or get the whole file"
    )
