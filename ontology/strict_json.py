"""JSON that users write, read strictly: no repeated keys, no numbers that are none, no digits without end."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

from deixis.errors import DeixisError
from deixis.printable import shortened

MAX_DIGITS = 4000
"""Digits of a whole number: what Python itself reads at the most, nearly."""


def parse_json(text: str, file: str, error: type[DeixisError], no_number: str | None) -> Any:
    """Return the data in a JSON text; raises ``error`` with the file, and the line and column where it is no JSON.

    ``no_number`` says what is wrong with ``NaN`` and ``Infinity``, after their name; None lets them in, for a reader
    that refuses them where they stand.

    >>> parse_json('{"x": 1}', "t.json", DeixisError, "is no number")
    {'x': 1}
    >>> parse_json('{"x": NaN}', "t.json", DeixisError, "is no number")
    Traceback (most recent call last):
        ...
    deixis.errors.DeixisError: t.json: NaN is no number
    """

    def refuse(name: str) -> float:
        raise ValueError(f"{name} {no_number}")

    def whole_number(digits: str) -> int:
        if len(digits) > MAX_DIGITS:
            raise ValueError(f"a number of {len(digits)} digits is too large")
        return int(digits)

    def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) != len(pairs):
            counts = Counter(key for key, _ in pairs)
            twice = next(key for key, count in counts.items() if count > 1)
            raise ValueError(f"the key '{shortened(twice, 60)}' stands twice in one object")
        return found

    try:
        return json.loads(
            text.removeprefix("\ufeff"),
            parse_constant=refuse if no_number else None,
            parse_int=whole_number,
            object_pairs_hook=without_repeats,
        )
    except json.JSONDecodeError as wrong:
        raise error(f"{file}:{wrong.lineno}:{wrong.colno}: this is no JSON: {wrong.msg}") from wrong
    except RecursionError as wrong:
        raise error(f"{file}: the JSON is nested too deeply") from wrong
    except ValueError as wrong:
        raise error(f"{file}: {wrong}") from wrong
