"""A view as it is written: what is said of it, and its arrays, each under a key of its own.

A view does not change, so this is worked out once, when it is made, and not while others wait for the memory.
"""

from __future__ import annotations

from datetime import datetime
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.memory.perceptual import keys
from deixis.memory.perceptual.checksum import WIDE, seal_in_place, seal_small
from deixis.memory.perceptual.tensors import lay_out

Arrays = dict[str, NDArray[np.float32]]


class Written(NamedTuple):
    """Two keys with their values. What is said of a view begins with the checksum of its arrays."""

    key: bytes
    said: bytes
    arrays_key: bytes
    arrays: bytearray


def written(category: str, id: str, time: datetime, arrays: Arrays, metadata: str) -> tuple[Written, Arrays]:
    """A view as it is written, and the copies of its arrays that lie there; ``metadata`` is JSON."""
    data, copies = lay_out(arrays, WIDE)
    key = keys.view_key(keys.VIEW, category, id, keys.microseconds(time))
    arrays_key = keys.ARRAYS + key[1:]
    sealed = seal_in_place(arrays_key, data)
    said = seal_small(key, b"%b\0\0%b" % (bytes(sealed[-WIDE:]), metadata.encode()))
    return Written(key, said, arrays_key, sealed), copies
