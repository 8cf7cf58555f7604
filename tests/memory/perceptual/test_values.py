"""Values: what is written comes back, in the format it is said to be in, and a change is noticed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from safetensors.numpy import load, save

from deixis.memory.perceptual.checksum import open_small, open_wide, seal_small, seal_wide
from deixis.memory.perceptual.records import DTYPES
from deixis.memory.perceptual.tensors import pack, unpack

texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
names = texts.filter(lambda name: name not in ("", "__metadata__"))
shapes = arrays_of.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4)
numbers = st.sampled_from(sorted(DTYPES)).flatmap(lambda name: arrays_of.arrays(np.dtype(name), shapes))
named = st.dictionaries(names, numbers, max_size=4)
SEALS = [(seal_small, open_small), (seal_wide, open_wide)]


@given(named, texts)
def test_packed_arrays_are_a_safetensors_file(arrays: dict[str, Any], note: str) -> None:
    packed = b"".join(pack(arrays, note))
    assert packed == save(arrays, {"deixis": note} if note else None)
    for found in (load(packed), unpack(memoryview(packed))[0]):
        assert {name: (array.dtype, array.shape, array.tobytes()) for name, array in found.items()} == {
            name: (array.dtype, array.shape, array.tobytes()) for name, array in arrays.items()
        }
    assert unpack(memoryview(packed))[1] == note


@pytest.mark.parametrize(("seal", "opened"), SEALS)
@given(key=st.binary(max_size=9), value=st.binary(max_size=99), data=st.data())
@settings(deadline=None)
def test_any_changed_byte_of_key_or_value_is_noticed(
    seal: Any, opened: Any, key: bytes, value: bytes, data: st.DataObject
) -> None:
    sealed = seal(key, value)
    assert bytes(opened(key, sealed)) == value
    place = data.draw(st.integers(0, len(sealed) - 1))
    changed = bytearray(sealed)
    changed[place] ^= data.draw(st.integers(1, 255))
    assert opened(key, bytes(changed)) is None
    assert opened(key + b"x", sealed) is None
    assert opened(key, sealed[:-1]) is None


@pytest.mark.parametrize(("seal", "opened"), SEALS)
def test_what_is_shorter_than_a_checksum_is_noticed(seal: Any, opened: Any) -> None:
    assert opened(b"key", b"") is None
    assert opened(b"key", b"abc") is None


def test_changes_in_several_places_are_noticed() -> None:
    """Signs flipped in two places or in all, words, pages or blocks that changed places, zeros for a page."""
    rng = np.random.default_rng(1)
    value = rng.random((100, 153), np.float32)
    words = value.reshape(-1).view(np.uint64)
    changes = []
    for _ in range(200):
        one, two = rng.choice(len(words), 2, replace=False)
        signs, swapped = words.copy(), words.copy()
        signs[[one, two]] ^= np.uint64(1 << 63)
        swapped[[one, two]] = swapped[[two, one]]
        changes += [signs, swapped]
    pages, zeros, negated = words.copy(), words.copy(), (-value).reshape(-1).view(np.uint64)
    pages[:512], pages[1024:1536] = words[1024:1536], words[:512]
    blocks = words.copy()
    blocks[:1024], blocks[1024:2048] = words[1024:2048], words[:1024]
    zeros[512:1024] = 0
    sealed = seal_wide(b"key", value.data.cast("B"))
    assert open_wide(b"key", sealed) is not None
    for changed in [*changes, pages, blocks, zeros, negated]:
        assert open_wide(b"key", changed.tobytes() + bytes(sealed[-8:])) is None


def test_checksums_are_the_same_for_ever() -> None:
    """Golden values: whoever changes the sum must raise the version, or every memory there is will look damaged."""
    assert seal_small(b"key", b"value")[-4:].hex() == "e6f355c6"
    assert seal_wide(b"key", bytes(range(200)) * 99)[-8:].hex() == "983b25e7fab94d9d"


def test_the_sum_is_the_one_that_is_described() -> None:
    """In plain integers, of the definition."""
    import zlib

    mask, half, odd = (1 << 64) - 1, 1 << 32, 0x9E3779B97F4A7C15

    def key(number: int) -> int:
        state = number * odd & mask
        state = (state ^ state >> 30) * 0xBF58476D1CE4E5B9 & mask
        state = (state ^ state >> 27) * 0x94D049BB133111EB & mask
        return state ^ state >> 31

    value = bytes(range(251)) * 80 + b"rest"
    total = len(value)
    words = [int.from_bytes(value[place : place + 8], "little") for place in range(0, len(value), 8)]
    rest = words.pop() if len(value) % 8 else 0
    for first in range(0, len(words), 1024):
        part = sum(
            (word % half + key(place) % half) % half * ((word // half + key(place) // half) % half)
            for place, word in enumerate(words[first : first + 1024], start=1)
        )
        total = (total ^ part & mask) * odd & mask
    expected = (total ^ rest) * odd & mask ^ zlib.crc32(b"key") * odd & mask
    assert seal_wide(b"key", value)[-8:] == expected.to_bytes(8, "little")
