"""Write clouds as PCD and PLY, with the colours, labels and normals of the points."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.formats.pcd import ENCODINGS as PCD_ENCODINGS
from deixis.perception.errors import CloudError

PLY_ENCODINGS = ("ascii", "binary")
_CHUNK = 2**14
_PLY_TYPES = {"<f4": "float", "|u1": "uchar", "<i4": "int"}


def pcd_bytes(cloud: PointCloud, encoding: str) -> Iterator[bytes]:
    """Yield a PCD file, version 0.7, piece by piece.

    The origin becomes its viewpoint; an organised cloud keeps its rows and columns.

    Parameters
    ----------
    cloud
        Cloud in metres.
    encoding
        ``ascii``, ``binary`` or ``binary_compressed``.

    Yields
    ------
    bytes
        A piece of the file.
    """
    _check(encoding, PCD_ENCODINGS, "PCD")
    columns = _coordinates(cloud)
    if cloud.colours is not None:
        red, green, blue = cloud.colours.T.astype("<u4")
        columns["rgb"] = red << 16 | green << 8 | blue
    columns |= _rest(cloud, ("normal_x", "normal_y", "normal_z"))
    table = _table(columns)
    height, width = cloud.organised or (1, len(cloud))
    formats = [table.dtype[name] for name in columns]
    yield "\n".join(
        [
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7",
            f"FIELDS {' '.join(columns)}",
            f"SIZE {' '.join(str(kind.itemsize) for kind in formats)}",
            f"TYPE {' '.join(kind.kind.upper() for kind in formats)}",
            f"COUNT {' '.join('1' for _ in formats)}",
            f"WIDTH {width}\nHEIGHT {height}",
            f"VIEWPOINT {' '.join(repr(float(value)) for value in cloud.origin)} 1 0 0 0",
            f"POINTS {len(cloud)}\nDATA {encoding}\n",
        ]
    ).encode()
    yield from _compressed(table) if encoding == "binary_compressed" else _body(table, encoding)


def ply_bytes(cloud: PointCloud, encoding: str) -> Iterator[bytes]:
    """Yield a PLY file piece by piece; ``binary`` is little-endian. PLY cannot store the origin, rows and columns.

    Parameters
    ----------
    cloud
        Cloud in metres.
    encoding
        ``ascii`` or ``binary``.

    Yields
    ------
    bytes
        A piece of the file.
    """
    _check(encoding, PLY_ENCODINGS, "PLY")
    columns = _coordinates(cloud)
    if cloud.colours is not None:
        columns |= dict(zip(("red", "green", "blue"), cloud.colours.T, strict=True))
    columns |= _rest(cloud, ("nx", "ny", "nz"))
    table = _table(columns)
    properties = [f"property {_PLY_TYPES[table.dtype[name].str]} {name}" for name in columns]
    kind = "ascii" if encoding == "ascii" else "binary_little_endian"
    yield "\n".join(["ply", f"format {kind} 1.0", f"element vertex {len(cloud)}", *properties, "end_header\n"]).encode()
    yield from _body(table, encoding)


def _check(encoding: str, known: tuple[str, ...], name: str) -> None:
    if encoding not in known:
        raise CloudError(f"the encoding of {name} must be one of {', '.join(known)}, got '{encoding}'")


def _coordinates(cloud: PointCloud) -> dict[str, NDArray[np.generic]]:
    return {"x": cloud.points[:, 0], "y": cloud.points[:, 1], "z": cloud.points[:, 2]}


def _rest(cloud: PointCloud, normals: tuple[str, str, str]) -> dict[str, NDArray[np.generic]]:
    """Return the normals and labels as columns."""
    columns: dict[str, NDArray[np.generic]] = {}
    if cloud.normals is not None:
        columns |= dict(zip(normals, cloud.normals.T, strict=True))
    if cloud.labels is not None:
        columns["label"] = cloud.labels
    return columns


def _table(columns: dict[str, NDArray[np.generic]]) -> NDArray[np.void]:
    """Return columns as little-endian rows."""
    table = np.empty(len(columns["x"]), [(name, column.dtype.newbyteorder("<")) for name, column in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return table


def _body(table: NDArray[np.void], encoding: str) -> Iterator[bytes]:
    if encoding == "binary":
        yield table.tobytes()
        return
    # Nine digits reproduce any number of single precision exactly.
    names = table.dtype.names or ()
    line = " ".join("%.9g" if table.dtype[name].kind == "f" else "%d" for name in names) + "\n"
    for begin in range(0, len(table), _CHUNK):
        yield "".join([line % row for row in table[begin : begin + _CHUNK].tolist()]).encode()


def _compressed(table: NDArray[np.void]) -> Iterator[bytes]:
    from deixis.perception.clouds.formats.lzf import compress

    plain = b"".join(table[name].tobytes() for name in table.dtype.names or ())
    if len(plain) >= 2**32:
        raise CloudError(
            f"binary_compressed PCD must have less than {2**32} bytes, got {len(plain)}; write it as binary"
        )
    packed = compress(np.frombuffer(plain, np.uint8))
    yield np.array([len(packed), len(plain)], "<u4").tobytes()
    yield packed.tobytes()
