"""numpy's array files, .npy and zips of them, .npz: arrays, and clouds kept as arrays.

numpy reads the header, which it parses without running code; the data behind it is looked at in place, so that nothing
larger than the file is allocated and nothing is unpickled. A member of a zip is unpacked only where the size that it
declares can come out of the bytes that are there.

A cloud in a .npz file has the array points and, where they are known, colours, labels, normals and origin. Points are
(n, 3), or (rows, columns, 3) where they are the pixels of an image; the others are shaped alike. Colours are bytes, or
floats from 0 to 1, and may be called colors. Other arrays are passed over.
"""

from __future__ import annotations

import io
import warnings
import zipfile
import zlib
from collections.abc import Iterable

import numpy as np
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.columns import as_bytes, labels_of, single
from deixis.perception.clouds.content import Content
from deixis.perception.errors import CloudError

MAGIC = npy_format.MAGIC_PREFIX
"""The first bytes of a .npy file."""
MAX_MEMBER = 256 * 2**20
"""The largest array in a zip, in bytes."""
MAX_DEFLATED = 1032
"""The largest number of bytes that one byte of deflate's gives."""
CLOUD_ARRAYS = ("points", "colours", "colors", "labels", "normals", "origin")


def read_npy(data: bytes, where: str) -> NDArray[np.generic]:
    """Return the array in a .npy file's bytes; raise CloudError where it is not one of plain numbers, or not whole."""
    file = io.BytesIO(data)
    try:
        version = npy_format.read_magic(file)
        read_header = npy_format.read_array_header_1_0 if version == (1, 0) else npy_format.read_array_header_2_0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # numpy warns of headers that Python 2 wrote, and reads them
            shape, in_columns, dtype = read_header(file)
        if dtype.kind not in "biuf" or dtype.itemsize > 8 or min(shape, default=0) < 0:
            raise ValueError(f"an array of {dtype} of shape {shape}")
        return np.frombuffer(data, dtype, offset=file.tell()).reshape(shape, order="F" if in_columns else "C")
    except Exception as error:  # a damaged header raises whatever Python's own parser raises, not ValueError alone
        raise CloudError(
            f"{where}: this is no whole .npy file of plain numbers ({shown(error) or 'its header is damaged'}); save it"
            " again with numpy.save, not pickled"
        ) from error


def read_npz(content: Content, names: Iterable[str]) -> dict[str, NDArray[np.generic]]:
    """Return those of the named arrays that a .npz file has; raise CloudError where it or one of them is damaged."""
    found = {}
    try:
        with zipfile.ZipFile(io.BytesIO(content.data.data)) as archive:
            members = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
            for name in names:
                if name in members:
                    where = f"{content.name}: '{name}'"
                    found[name] = read_npy(_unpacked(archive, members[name], where), where)
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, NotImplementedError) as error:
        if isinstance(error, CloudError):
            raise
        raise CloudError(f"{content.name}: this is no whole .npz file ({shown(error)}); save it again") from error
    return found


def _unpacked(archive: zipfile.ZipFile, info: zipfile.ZipInfo, where: str) -> bytes:
    if info.flag_bits & 1 or info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise CloudError(f"{where}: it is encrypted or packed in a way that numpy does not; save it with numpy.savez")
    if info.file_size > min(MAX_MEMBER, info.compress_size * MAX_DEFLATED + 64):
        raise CloudError(
            f"{where}: {info.file_size} bytes are declared, in {info.compress_size} packed ones; it must be possible,"
            f" and no more than {MAX_MEMBER // 2**20} MiB: save it again, or thin it"
        )
    with archive.open(info) as member:
        return member.read(info.file_size)


def read_npz_cloud(content: Content) -> PointCloud:
    """Return the cloud in a .npz file; raise CloudError, with the array, where it is malformed."""
    arrays = read_npz(content, CLOUD_ARRAYS)
    if "points" not in arrays:
        raise CloudError(f"{content.name}: there is no array 'points'; save it with numpy.savez(file, points=…)")
    points = arrays["points"]
    if points.ndim not in (2, 3) or points.shape[-1] != 3:
        raise CloudError(f"{content.name}: 'points' has shape {points.shape}; it is (n, 3) or (rows, columns, 3)")
    shape = points.shape[:-1]
    wanted = {"colours": (*shape, 3), "colors": (*shape, 3), "labels": shape, "normals": (*shape, 3), "origin": (3,)}
    for name, array in arrays.items():
        if array.shape != wanted.get(name, array.shape):
            raise CloudError(
                f"{content.name}: '{name}' has shape {array.shape}; it is {wanted[name]}, to go with the points"
            )
    colours, labels, normals = arrays.get("colours", arrays.get("colors")), arrays.get("labels"), arrays.get("normals")
    x, y, z = single(arrays["origin"]).astype(np.float64).tolist() if "origin" in arrays else (0.0, 0.0, 0.0)
    return PointCloud(
        single(points).reshape(-1, 3),
        None if colours is None else as_bytes(colours.reshape(-1, 3), content.name),
        None if labels is None else labels_of(labels.reshape(-1), content.name),
        None if normals is None else single(normals).reshape(-1, 3),
        (shape[0], shape[1]) if len(shape) == 2 else None,
        (x, y, z),
    )
