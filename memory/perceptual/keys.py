"""Keys whose order in bytes is the order of what they name.

A text inside a key is UTF-8, whose order is that of code points; its end is two zero bytes, and a zero byte in it is
followed by 255, so that texts of any characters are kept apart and in order. A time is eight bytes, the largest first.

>>> view_key(VIEW, "cup", "v2", 5) < view_key(VIEW, "cup", "v2", 6) < view_key(VIEW, "cup2", "v1", 0)
True
>>> split_view_key(view_key(VIEW, "a\\0b", "v1", -7))
('a\\x00b', 'v1', -7)
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

ARRAYS, CATEGORY, ABOUT, COUNT, VIEW = b"a", b"c", b"m", b"n", b"v"
"""The ranges: a view's arrays; a category's record; what is said of a view, by id; counts; the views in order."""

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND = timedelta(microseconds=1)
_END, _ZERO = b"\x00\x00", b"\x00\xff"
_MIDDLE = 1 << 63


def view_key(kind: bytes, category: str, id: str, time: int) -> bytes:
    """The key of a view; ``time`` in microseconds since 1970."""
    return b"%b%b%b%b" % (kind, _text(category), _text(id), (time + _MIDDLE).to_bytes(8, "big"))


def split_view_key(key: bytes) -> tuple[str, str, int]:
    """Category, id and time again. Raises ValueError for a key that :func:`view_key` did not make."""
    category, rest = _split(key[1:])
    id, time = _split(rest)
    if len(time) != 8:
        raise ValueError("a time has eight bytes")
    return category, id, int.from_bytes(time, "big") - _MIDDLE


def category_prefix(category: str) -> bytes:
    """How the keys of all views of a category begin."""
    return VIEW + _text(category)


def name_key(kind: bytes, name: str) -> bytes:
    """The key of what has nothing but a name."""
    return kind + name.encode()


def after(prefix: bytes) -> bytes:
    """The least key that is greater than all that begin so; no prefix here ends in 255."""
    return prefix[:-1] + bytes([prefix[-1] + 1])


def microseconds(time: datetime) -> int:
    """Microseconds since 1970."""
    return (time - EPOCH) // _MICROSECOND


def moment(time: int) -> datetime:
    """The time again. Raises OverflowError where no year from 1 to 9999 has it."""
    return EPOCH + timedelta(microseconds=time)


def _text(text: str) -> bytes:
    return text.encode().replace(b"\x00", _ZERO) + _END


def _split(key: bytes) -> tuple[str, bytes]:
    end = key.find(_END)
    if end < 0:
        raise ValueError("a text without an end")
    return key[:end].replace(_ZERO, b"\x00").decode(), key[end + 2 :]
