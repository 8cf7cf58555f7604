"""numpy's array files, read without its evaluation of the header and without pickles: .npy, and .npz, a zip of them.

The format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html. A member of a zip is unpacked only
where the size that it declares can come out of the bytes that are there.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
import zlib
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.content import Content
from deixis.perception.errors import CloudError

MAGIC = b"\x93NUMPY"
MAX_MEMBER = 256 * 2**20
"""The largest array in a zip, in bytes."""
MAX_DEFLATED = 1032
"""How many bytes one of deflate's gives at the most."""

_MAX_HEADER = 10_000
_HEADER = re.compile(
    r"\{\s*'descr':\s*'([<>|=]?[biuf][1248])',\s*'fortran_order':\s*(True|False),"
    r"\s*'shape':\s*\(((?:[0-9]{1,15},?\s*)*)\)\s*,?\s*\}\s*"
)


def read_npy(data: bytes, where: str) -> NDArray[np.generic]:
    """The array in a .npy file's bytes; raises CloudError where it is none of numbers, or not as long as it says."""
    long = data[6:7] >= b"\x02"
    begin = 12 if long else 10
    size = int.from_bytes(data[8:begin], "little")
    if data[:6] != MAGIC or len(data) < begin or size > _MAX_HEADER or len(data) < begin + size:
        raise CloudError(f"{where}: byte 0: this is no whole .npy file; save it again with numpy.save")
    found = _HEADER.fullmatch(data[begin : begin + size].decode("latin-1"))
    if found is None:
        header = shown(data[begin : begin + size].decode("latin-1").strip())
        raise CloudError(f"{where}: byte {begin}: '{header}' is no array of plain numbers; save it as one, not pickled")
    dtype = np.dtype(found[1])
    shape = tuple(int(length) for length in found[3].replace(",", " ").split())
    wanted = math.prod(shape) * dtype.itemsize
    if wanted != len(data) - begin - size:
        raise CloudError(
            f"{where}: byte {begin + size}: an array of shape {shape} takes {wanted} bytes, and"
            f" {len(data) - begin - size} follow; get the whole file"
        )
    flat: NDArray[np.generic] = np.frombuffer(data, dtype, offset=begin + size)
    return flat.reshape(shape[::-1]).T if found[2] == "True" else flat.reshape(shape)


def read_npz(content: Content, names: Iterable[str]) -> dict[str, NDArray[np.generic]]:
    """Those of the named arrays that a .npz file has; raises CloudError where the file or one of them is damaged."""
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
