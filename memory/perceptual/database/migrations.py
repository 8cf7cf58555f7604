"""Migrations of the database from each version to the next.

Version 1 sealed arrays and records of categories with 64 bits of NH (Black, Halevi, Krawczyk, Krovetz and Rogaway,
"UMAC: fast and secure message authentication", CRYPTO 1999), at the end of the value, and all else with a CRC-32.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from functools import cache

import numpy as np
import plyvel
from numpy.typing import NDArray

from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.database.codec import checksum, parse_about, seal, write_about

_ODD, _ALL = 0x9E3779B97F4A7C15, (1 << 64) - 1
_NH_BLOCK = 1024  # words of 64 bits


def reseal(old: plyvel.DB, new: plyvel.DB) -> None:
    """Fill a database of version 2 from one of version 1: other checksums, and none after the arrays of a view.

    A value that does not match its checksum is copied unchanged, so that it stays damaged and is reported. LevelDB's
    checksums are not checked: a mismatch would keep the other values from being read.

    Parameters
    ----------
    old
        Database of version 1.
    new
        Empty database.
    """
    for key, value in old.iterator():
        kind = key[:1]
        nh_fits = kind in (keys.ARRAYS, keys.CATEGORY) and _nh_fits(key, value)
        crc_fits = zlib.crc32(value[:-4], zlib.crc32(key)).to_bytes(4, "little") == value[-4:]
        if kind == keys.ARRAYS and nh_fits:
            value = value[:-8]
        elif kind == keys.CATEGORY and nh_fits:
            value = seal(key, value[:-8])
        elif kind == keys.COUNT and crc_fits:
            value = seal(key, value[:-4])
        elif kind == keys.VIEW and crc_fits:
            header = parse_about(key, value[:-4])
            arrays = old.get(header.arrays_key)
            if arrays is not None and arrays[-8:] == header.sum and _nh_fits(header.arrays_key, arrays):
                header = header._replace(sum=checksum(header.arrays_key, arrays[:-8]))
            value = write_about(header)[1]
        new.put(key, value)


def _nh_fits(key: bytes, sealed: bytes) -> bool:
    """Return whether a value of version 1 matches its NH checksum for a key."""
    length = len(sealed) - 8
    if length < 0:
        return False
    words = np.frombuffer(sealed, "<u8", length // 8)
    low, half = np.uint64(0xFFFFFFFF), np.uint64(32)
    total = length
    for first in range(0, words.size, _NH_BLOCK):
        block = words[first : first + _NH_BLOCK]
        secret = _nh_key()[: block.size]
        part = (((block + secret) & low) * (((block >> half) + (secret >> half)) & low)).sum(dtype=np.uint64)
        total = (total ^ int(part)) * _ODD & _ALL
    rest = int.from_bytes(sealed[length // 8 * 8 : length], "little")
    total = (total ^ rest) * _ODD & _ALL ^ zlib.crc32(key) * _ODD & _ALL
    return total.to_bytes(8, "little") == sealed[length:]


@cache
def _nh_key() -> NDArray[np.uint64]:
    """Return the key of NH: SplitMix64 (Steele, Lea and Flood 2014) from 1 on."""
    state = np.arange(1, _NH_BLOCK + 1, dtype=np.uint64) * np.uint64(_ODD)
    state = (state ^ (state >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ (state >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return state ^ (state >> np.uint64(31))


MIGRATIONS: dict[int, Callable[[plyvel.DB, plyvel.DB], None]] = {1: reseal}
"""Migration to the next version, by version."""
