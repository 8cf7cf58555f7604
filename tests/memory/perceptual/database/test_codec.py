"""Values can be read back, have the stated format, and reveal changes."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from safetensors.numpy import load, save

from deixis.memory.perceptual.database.codec import checksum, pack, seal, unpack, unseal
from deixis.memory.perceptual.records import DTYPES

texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
names = texts.filter(lambda name: name not in ("", "__metadata__"))
shapes = arrays_of.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4)
numbers = st.sampled_from(sorted(DTYPES)).flatmap(lambda name: arrays_of.arrays(np.dtype(name), shapes))
named = st.dictionaries(names, numbers, max_size=4)


@given(named, texts)
def test_packed_arrays_are_a_safetensors_file(arrays: dict[str, Any], note: str) -> None:
    packed = pack(arrays, note)
    assert packed == save(arrays, {"deixis": note})
    for found in (load(packed), unpack(packed)[0]):
        assert {name: (array.dtype, array.shape, array.tobytes()) for name, array in found.items()} == {
            name: (array.dtype, array.shape, array.tobytes()) for name, array in arrays.items()
        }
    assert unpack(packed)[1] == note


@given(key=st.binary(max_size=9), value=st.binary(max_size=99), data=st.data())
@settings(deadline=None)
def test_any_changed_byte_of_key_or_value_is_noticed(key: bytes, value: bytes, data: st.DataObject) -> None:
    sealed = seal(key, value)
    assert unseal(key, sealed) == value
    place = data.draw(st.integers(0, len(sealed) - 1))
    changed = bytearray(sealed)
    changed[place] ^= data.draw(st.integers(1, 255))
    assert unseal(key, bytes(changed)) is None
    assert unseal(key + b"x", sealed) is None
    assert unseal(key, sealed[:-1]) is None


def test_what_is_shorter_than_a_checksum_is_noticed() -> None:
    assert unseal(b"key", b"") is None
    assert unseal(b"key", b"abc") is None


def test_changes_in_several_places_are_noticed() -> None:
    """Flip signs in two places or in all, swap words, pages or blocks, and zero a page."""
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
    whole = checksum(b"key", value.tobytes())
    for changed in [*changes, pages, blocks, zeros, negated]:
        assert checksum(b"key", changed.tobytes()) != whole


def test_checksums_are_the_same_for_ever() -> None:
    """Check golden values: a change of the checksum needs a new version, or every existing memory looks damaged."""
    assert checksum(b"key", b"value").hex() == "b19fcf792e11118e"
    assert checksum(b"key", bytes(range(200)) * 99).hex() == "74ab9d07b6509251"
    assert checksum(b"", b"").hex() == "412f1275e10017f3"
