"""The order of keys is the order of the names in them."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.memory.perceptual.database import keys

names = st.text(min_size=1) | st.text(alphabet="\0\x01a\xff\U0010ffff", min_size=1, max_size=5)
times = st.integers(-(1 << 63), (1 << 63) - 1) | st.integers(-2, 2)
places = st.tuples(names, names, times)


@given(places, places)
def test_keys_are_in_order_of_category_view_and_time(first: tuple[str, str, int], second: tuple[str, str, int]) -> None:
    one, two = keys.view_key(keys.VIEW, *first), keys.view_key(keys.VIEW, *second)
    assert (one < two) == (first < second)
    assert (one == two) == (first == second)


@given(places)
def test_a_key_can_be_split_into_its_parts(place: tuple[str, str, int]) -> None:
    assert keys.split_view_key(keys.view_key(keys.VIEW, *place)) == place


@given(places, names)
def test_a_prefix_holds_the_keys_of_its_category_and_no_others(place: tuple[str, str, int], category: str) -> None:
    key, prefix = keys.view_key(keys.VIEW, *place), keys.category_prefix(category)
    assert key.startswith(prefix) == (place[0] == category)
    assert (prefix <= key < keys.after(prefix)) == (place[0] == category)


@given(st.datetimes(timezones=st.just(UTC)))
def test_times_come_back(time: datetime) -> None:
    assert keys.moment(keys.microseconds(time)) == time


def test_a_key_by_hand() -> None:
    assert (
        keys.view_key(keys.VIEW, "a\0", "é", 1) == b"va\x00\xff\x00\x00\xc3\xa9\x00\x00\x80\x00\x00\x00\x00\x00\x00\x01"
    )


@pytest.mark.parametrize(
    "key", [b"v", b"vabc", b"va\0\0b\0\0short", b"va\0\0b\0\0longer than 8", b"v\xff\0\0b\0\x0012345678"]
)
def test_an_invalid_key_is_refused(key: bytes) -> None:
    with pytest.raises(ValueError, match=r"end|eight|utf-8"):
        keys.split_view_key(key)
