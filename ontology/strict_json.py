"""Strict reading of the JSON that users write: no repeated keys, no ``NaN``, and no numbers of unlimited length."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

from deixis.errors import DeixisError
from deixis.printable import shortened

MAX_DIGITS = 4000
"""Maximum number of digits of a whole number, a little below Python's own limit."""


def parse_json(text: str, file: str, error: type[DeixisError], no_number: str | None) -> Any:
    """Return the data in a JSON text.

    Parameters
    ----------
    text
        The JSON text; a byte order mark at its start is skipped.
    file
        Name of the file, for messages.
    error
        The type of the error to raise.
    no_number
        Message about ``NaN`` and ``Infinity``, after their name. None accepts them, for readers that check them later.

    Returns
    -------
    object
        The parsed data.

    Raises
    ------
    error
        If the text is not valid JSON, with the file, line and column, or breaks one of the limits, with the file.

    Examples
    --------
    >>> parse_json('{"x": 1}', "t.json", DeixisError, "is not a number")
    {'x': 1}
    >>> parse_json('{"x": NaN}', "t.json", DeixisError, "is not a number")
    Traceback (most recent call last):
        ...
    deixis.errors.DeixisError: t.json: NaN is not a number
    """

    def refuse(name: str) -> float:
        raise ValueError(f"{name} {no_number}")

    def whole_number(digits: str) -> int:
        if len(digits) > MAX_DIGITS:
            raise ValueError(f"a number of {len(digits)} digits is too large: at most {MAX_DIGITS} digits are read")
        return int(digits)

    def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) != len(pairs):
            counts = Counter(key for key, _ in pairs)
            twice = next(key for key, count in counts.items() if count > 1)
            raise ValueError(f"the key '{shortened(twice, 60)}' occurs twice in one object")
        return found

    try:
        return json.loads(
            text.removeprefix("\ufeff"),
            parse_constant=refuse if no_number else None,
            parse_int=whole_number,
            object_pairs_hook=without_repeats,
        )
    except json.JSONDecodeError as wrong:
        raise error(f"{file}:{wrong.lineno}:{wrong.colno}: this is not valid JSON: {wrong.msg}") from wrong
    except RecursionError as wrong:
        raise error(f"{file}: the JSON is nested too deeply") from wrong
    except ValueError as wrong:
        raise error(f"{file}: {wrong}") from wrong


def json_type(data: Any) -> str:
    """Return the JSON type of a value in words, for messages.

    Parameters
    ----------
    data
        Parsed JSON.

    Returns
    -------
    str
        The type with its article.

    Examples
    --------
    >>> json_type(None), json_type(1.5), json_type([]), json_type("fork")
    ('null', 'a number', 'a list', 'a string')
    """
    if data is None or isinstance(data, bool):
        return {None: "null", True: "true", False: "false"}[data]
    names = {str: "a string", int: "a number", float: "a number", list: "a list", tuple: "a list"}
    return names.get(type(data), "an object")
