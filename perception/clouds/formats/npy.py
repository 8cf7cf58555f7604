"""Read the array files of numpy, .npy and .npz, and the clouds stored in .npz files.

numpy parses the header without running code. The data is viewed in place, so nothing larger than the file is allocated
and nothing is unpickled. A member of a zip is unpacked only if its packed bytes can expand to the declared size.

A cloud in a .npz file has the array points and optionally colours, labels, normals and origin. Points have shape
(n, 3), or (rows, columns, 3) if they are the pixels of an image; the other arrays have corresponding shapes. Colours
are bytes, or floats from 0 to 1, and may be called colors. Other arrays are skipped.
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
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.tables.columns import as_bytes, labels_of, single
from deixis.perception.errors import CloudError

MAGIC = npy_format.MAGIC_PREFIX
"""First bytes of a .npy file."""
MAX_MEMBER = 256 * 2**20
"""Size of the largest array in a zip, in bytes."""
MAX_DEFLATED = 1032
"""Maximum ratio of plain to packed bytes of deflate."""
CLOUD_ARRAYS = ("points", "colours", "colors", "labels", "normals", "origin")


def read_npy(data: bytes, where: str) -> NDArray[np.generic]:
    """Return the array of a .npy file.

    Parameters
    ----------
    data
        Bytes of the file.
    where
        Its name, for messages.

    Returns
    -------
    ndarray
        The array.

    Raises
    ------
    CloudError
        If the file does not hold plain numbers or is truncated.
    """
    file = io.BytesIO(data)
    try:
        version = npy_format.read_magic(file)
        read_header = npy_format.read_array_header_1_0 if version == (1, 0) else npy_format.read_array_header_2_0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # numpy reads headers that Python 2 wrote, but warns about them
            shape, in_columns, dtype = read_header(file)
        if dtype.kind not in "biuf" or dtype.itemsize > 8 or min(shape, default=0) < 0:
            raise ValueError(f"an array of {dtype} of shape {shape}")
        return np.frombuffer(data, dtype, offset=file.tell()).reshape(shape, order="F" if in_columns else "C")
    except Exception as error:  # a damaged header raises any error of Python's own parser, not only ValueError
        raise CloudError(
            f"{where}: not a complete .npy file of plain numbers ({shown(error) or 'its header is damaged'}); save it"
            " again with numpy.save, not pickled"
        ) from error


def read_npz(content: Content, names: Iterable[str]) -> dict[str, NDArray[np.generic]]:
    """Return some arrays of a .npz file.

    Parameters
    ----------
    content
        The file.
    names
        Names of the wanted arrays; those that the file does not have are left out.

    Returns
    -------
    dict
        Array by name.

    Raises
    ------
    CloudError
        If the file or one of the arrays is damaged.
    """
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
        raise CloudError(f"{content.name}: not a complete .npz file ({shown(error)}); save it again") from error
    return found


def _unpacked(archive: zipfile.ZipFile, info: zipfile.ZipInfo, where: str) -> bytes:
    if info.flag_bits & 1 or info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise CloudError(f"{where}: the array is encrypted, or packed by another program; save it with numpy.savez")
    if info.file_size > min(MAX_MEMBER, info.compress_size * MAX_DEFLATED + 64):
        raise CloudError(
            f"{where}: {info.compress_size} packed bytes declare {info.file_size} bytes, which is impossible or more"
            f" than {MAX_MEMBER // 2**20} MiB; save it again, or subsample it"
        )
    with archive.open(info) as member:
        return member.read(info.file_size)


def read_npz_cloud(content: Content) -> PointCloud:
    """Return the cloud of a .npz file.

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
        If the file is malformed; the message names the array.
    """
    arrays = read_npz(content, CLOUD_ARRAYS)
    if "points" not in arrays:
        raise CloudError(f"{content.name}: there is no array 'points'; save it with numpy.savez(file, points=…)")
    points = arrays["points"]
    if points.ndim not in (2, 3) or points.shape[-1] != 3:
        raise CloudError(
            f"{content.name}: 'points' must have shape (n, 3) or (rows, columns, 3), got {points.shape}; reshape it"
        )
    shape = points.shape[:-1]
    wanted = {"colours": (*shape, 3), "colors": (*shape, 3), "labels": shape, "normals": (*shape, 3), "origin": (3,)}
    for name, array in arrays.items():
        if array.shape != wanted.get(name, array.shape):
            raise CloudError(
                f"{content.name}: '{name}' must have shape {wanted[name]} to fit the points, got {array.shape}; reshape"
                " it"
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
