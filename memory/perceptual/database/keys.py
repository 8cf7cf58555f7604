r"""Keys of the database, whose order in bytes is the order of the categories, ids and times in them.

A text inside a key is UTF-8, whose order is that of code points; its end is two zero bytes, and a zero byte in it is
followed by 255, so that texts of any characters are kept apart and in order. A time is eight bytes, the largest first.

>>> view_key(VIEW, "cup", "v2", 5) < view_key(VIEW, "cup", "v2", 6) < view_key(VIEW, "cup2", "v1", 0)
True
>>> split_view_key(view_key(VIEW, "a\0b", "v1", -7))
('a\x00b', 'v1', -7)
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

ARRAYS, CATEGORY, JOURNAL, LESSON, COUNT, TEACHINGS, VIEW = b"a", b"c", b"j", b"l", b"n", b"t", b"v"
"""First bytes of keys.

They are of arrays, category records, the last applied journal, lessons of views, counts, the teachings of views that
were taught more than once, and view headers.
"""

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_END, _ZERO = b"\x00\x00", b"\x00\xff"
_MIDDLE = 1 << 63


def view_key(kind: bytes, category: str, view_id: str, time: int) -> bytes:
    """Return the key of a view.

    Parameters
    ----------
    kind
        First byte of the key: ``VIEW`` or ``ARRAYS``.
    category
        Name of the category.
    view_id
        Id of the view.
    time
        Time of the view in microseconds since 1970.

    Returns
    -------
    bytes
        Key. Keys of one kind are ordered by category, then by id.
    """
    if "\0" in category or "\0" in view_id:
        texts = ended(category) + ended(view_id)
    else:
        texts = f"{category}\0\0{view_id}\0\0".encode()
    return kind + texts + (time + _MIDDLE).to_bytes(8, "big")


def split_view_key(key: bytes) -> tuple[str, str, int]:
    """Return category, id and time of the key of a view.

    Parameters
    ----------
    key
        Key that :func:`view_key` returned.

    Returns
    -------
    tuple
        Category, id, and microseconds since 1970.

    Raises
    ------
    ValueError
        If it is another key.
    """
    try:
        category, view_id, end = key[1:-8].decode().split("\0\0")
    except ValueError:  # a zero byte in a name is followed by 255, which UTF-8 never has
        category, rest = split_ended(key[1:-8])
        view_id, left = split_ended(rest)
        end = left.decode()
    if end:
        raise ValueError("a time has eight bytes")
    return category, view_id, int.from_bytes(key[-8:], "big") - _MIDDLE


def category_prefix(category: str) -> bytes:
    """Return the common prefix of the keys of all views of a category.

    Parameters
    ----------
    category
        Name of the category.

    Returns
    -------
    bytes
        Prefix, which keys of no other category have.
    """
    return VIEW + ended(category)


def name_key(kind: bytes, name: str) -> bytes:
    """Return the key of a record that has only a name.

    Parameters
    ----------
    kind
        First byte of the key.
    name
        Name, in any characters.

    Returns
    -------
    bytes
        Key.
    """
    return kind + name.encode()


def after(prefix: bytes) -> bytes:
    """Return the least key after all keys with a prefix; no prefix here ends in 255.

    Parameters
    ----------
    prefix
        Prefix of one or more bytes.

    Returns
    -------
    bytes
        Key at which an iteration over the prefix stops.
    """
    return prefix[:-1] + bytes([prefix[-1] + 1])


def microseconds(time: datetime) -> int:
    """Return the microseconds since 1970.

    Parameters
    ----------
    time
        Time with a time zone.

    Returns
    -------
    int
        Exact number, negative before 1970.
    """
    since = time - EPOCH
    return (since.days * 86_400 + since.seconds) * 1_000_000 + since.microseconds


def moment(time: int) -> datetime:
    """Return the time of a number of microseconds since 1970.

    Parameters
    ----------
    time
        Number of microseconds.

    Returns
    -------
    datetime
        Time in UTC.

    Raises
    ------
    OverflowError
        If the year is not from 1 to 9999.
    """
    return EPOCH + timedelta(0, 0, time)  # as with a keyword, and twice as fast


def ended(text: str) -> bytes:
    """Return a text as bytes with an end mark.

    Parameters
    ----------
    text
        Text, in which zero bytes are escaped.

    Returns
    -------
    bytes
        Bytes that sort as the text does, and are not a prefix of another text's.
    """
    return text.encode().replace(b"\x00", _ZERO) + _END


def split_ended(data: bytes) -> tuple[str, bytes]:
    """Return a text, and the bytes after its end mark.

    Parameters
    ----------
    data
        Bytes that begin as :func:`ended` returned them.

    Returns
    -------
    tuple
        The text, and the rest.

    Raises
    ------
    ValueError
        If there is no end mark.
    """
    end = data.find(_END)
    if end < 0:
        raise ValueError("a text without an end")
    return data[:end].replace(_ZERO, b"\x00").decode(), data[end + 2 :]
