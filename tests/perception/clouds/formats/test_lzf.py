"""LZF: the meaning of single bytes, and unpacking as the inverse of packing."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.perception.clouds.formats.lzf import MAX_EXPANSION, compress, decompress


def unpacked(packed: bytes, size: int) -> tuple[bytes, int, int]:
    out = np.zeros(size, np.uint8)
    read, written = decompress(np.frombuffer(packed, np.uint8), out)
    return out.tobytes(), read, written


@pytest.mark.parametrize(
    ("packed", "plain"),
    [
        (b"\x02abc", b"abc"),
        (b"\x00a\x20\x00", b"aaaa"),  # length 3, distance 1
        (b"\x02abc\x80\x02", b"abcabcabc"),  # length 6, distance 3: source and target overlap
        (b"\x00a\xe0\x00\x00", b"a" * 10),  # length 9, the shortest that takes another byte
        (b"\x00a\xe0\xff\x00", b"a" * 265),  # length 264, the longest
        (b"\x01ab\x20\x01\x00c", b"ababac"[:5] + b"c"),
    ],
)
def test_control_bytes_follow_the_format(packed: bytes, plain: bytes) -> None:
    assert unpacked(packed, len(plain)) == (plain, len(packed), len(plain))


def test_a_reference_reaches_8192_bytes_back() -> None:
    plain = np.random.default_rng(3).integers(0, 256, 8192, np.uint8).tobytes()
    packed = b"".join(b"\x1f" + plain[at : at + 32] for at in range(0, 8192, 32)) + b"\x3f\xff"
    assert unpacked(packed, 8195)[0] == plain + plain[:3]


@pytest.mark.parametrize(
    "packed", [b"\x05abc", b"\x20\x00", b"\x00a\x20\x01", b"\x00a\xe0", b"\x00a\xe0\x00", b"\x00a\x20\x00"]
)
def test_damage_stops_where_it_is_found(packed: bytes) -> None:
    _, read, _ = unpacked(packed, 3)
    assert read < len(packed)


@given(st.lists(st.tuples(st.binary(max_size=40), st.integers(0, 60)), max_size=12))
@settings(deadline=None)  # the first call compiles
def test_unpacking_inverts_packing(parts: list[tuple[bytes, int]]) -> None:
    plain = b"".join(part * times for part, times in parts)
    packed = compress(np.frombuffer(plain, np.uint8))
    assert unpacked(packed.tobytes(), len(plain)) == (plain, len(packed), len(plain))
    assert len(plain) <= len(packed) * MAX_EXPANSION
    assert len(packed) <= len(plain) + len(plain) // 32 + 1


@given(st.binary(max_size=200), st.integers(0, 300))
@settings(deadline=None)
def test_unpacking_any_bytes_stays_within_both_arrays(packed: bytes, size: int) -> None:
    _, read, written = unpacked(packed, size)
    assert 0 <= read <= len(packed) and 0 <= written <= size


def test_repeated_bytes_become_few() -> None:
    assert len(compress(np.zeros(26_400, np.uint8))) < 310
