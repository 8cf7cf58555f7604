"""PCD, the Point Cloud Library's format: ascii, binary and binary_compressed, versions 0.5 to 0.7.

The format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html. A header of lines ``KEYWORD values``
ends with ``DATA``. Compressed data is two 32-bit sizes, packed and plain, then LZF
(:mod:`deixis.perception.clouds.lzf`) of the fields one after the other. All binary numbers are little-endian. A
viewpoint's position becomes the cloud's origin; its orientation is not used, since points and origin are in one frame.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.columns import KNOWN, cloud_of_columns, declared
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.number_table import read_table
from deixis.perception.clouds.pcd_header import PADDING, Field, PcdHeader, read_header
from deixis.perception.errors import CloudError

_Columns = dict[str, NDArray[np.generic]]


def read_pcd(content: Content) -> PointCloud:
    """The cloud in a PCD file; raises CloudError, with the line or byte, where it is malformed."""
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
    """The plain bytes; sizes are compared with header and file before anything is allocated."""
    from deixis.perception.clouds import lzf

    begin = header.end + 8
    if begin > len(content):
        raise _too_short(content, header.end, 8, len(content) - header.end)
    packed, plain = content.data[header.end : begin].view("<u4").tolist()
    if begin + packed > len(content):
        raise _too_short(content, begin, packed, len(content) - begin)
    content.refuse_rest(begin + packed)
    unpadded = sum(field.size for field in header.fields if field.name != PADDING) * header.points
    whole = sum(field.size for field in header.fields) * header.points
    if plain not in (whole, unpadded) or plain > packed * lzf.MAX_EXPANSION:
        raise CloudError(
            f"{content.name}: byte {header.end + 4}: {packed} bytes that hold {plain} are declared, and the header"
            f" wants {whole}; the file is damaged, write it again"
        )
    out = np.empty(plain, np.uint8)
    read, written = lzf.decompress(content.data[begin : begin + packed], out)
    if read != packed or written != plain:
        raise CloudError(
            f"{content.name}: byte {begin + read}: the compressed data is damaged ({written} of {plain} bytes came"
            " out); write the file again"
        )
    return out


def _is_known(field: Field) -> bool:
    return field.name in KNOWN and field.count == 1


def _too_short(content: Content, at: int, wanted: int, there: int) -> CloudError:
    return CloudError(
        f"{content.name}: byte {at}: {wanted} bytes of data are declared, and {there} follow; correct the header's"
        " counts, or get the whole file"
    )
