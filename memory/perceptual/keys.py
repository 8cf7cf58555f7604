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

ARRAYS, CATEGORY, JOURNAL, LESSON, COUNT, VIEW = b"a", b"c", b"j", b"l", b"n", b"v"
"""The ranges: a view's arrays; a category's record; the id of the last journal that was applied; the lesson that a view
belongs to; counts; what is said of a view."""

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_END, _ZERO = b"\x00\x00", b"\x00\xff"
_MIDDLE = 1 << 63


def view_key(kind: bytes, category: str, view_id: str, time: int) -> bytes:
    """Return the key of a view; ``time`` in microseconds since 1970."""
    if "\0" in category or "\0" in view_id:
        texts = ended(category) + ended(view_id)
    else:
        texts = f"{category}\0\0{view_id}\0\0".encode()
    return kind + texts + (time + _MIDDLE).to_bytes(8, "big")


def split_view_key(key: bytes) -> tuple[str, str, int]:
    """Return category, id and time of a view's key. Raises ValueError for a key that :func:`view_key` did not make."""
    try:
        category, view_id, end = key[1:-8].decode().split("\0\0")
    except ValueError:  # a zero in a name comes with a 255, which is in no UTF-8
        category, rest = split_ended(key[1:-8])
        view_id, left = split_ended(rest)
        end = left.decode()
    if end:
        raise ValueError("a time has eight bytes")
    return category, view_id, int.from_bytes(key[-8:], "big") - _MIDDLE


def category_prefix(category: str) -> bytes:
    """Return what the keys of all views of a category begin with."""
    return VIEW + ended(category)


def name_key(kind: bytes, name: str) -> bytes:
    """Return the key of what has nothing but a name."""
    return kind + name.encode()


def after(prefix: bytes) -> bytes:
    """Return the least key that is greater than all that begin so; no prefix here ends in 255."""
    return prefix[:-1] + bytes([prefix[-1] + 1])


def microseconds(time: datetime) -> int:
    """Return the microseconds since 1970."""
    since = time - EPOCH
    return (since.days * 86_400 + since.seconds) * 1_000_000 + since.microseconds


def moment(time: int) -> datetime:
    """Return the time of some microseconds since 1970. Raises OverflowError for a year outside 1 to 9999."""
    return EPOCH + timedelta(0, 0, time)  # as with a keyword, and twice as fast


def ended(text: str) -> bytes:
    """Return a text as bytes, with its end."""
    return text.encode().replace(b"\x00", _ZERO) + _END


def split_ended(data: bytes) -> tuple[str, bytes]:
    """Return a text, and what comes after its end. Raises ValueError where it has none."""
    end = data.find(_END)
    if end < 0:
        raise ValueError("a text without an end")
    return data[:end].replace(_ZERO, b"\x00").decode(), data[end + 2 :]
