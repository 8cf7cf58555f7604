"""Checks of parsed JSON that the readers of scene and annotation files share; each error names the place."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from deixis.perception.errors import SceneError

MAX_TEXT = 4_096
"""How many characters a name, a label or a file's name in a scene may have."""

MAX_SHOWN = 60
"""How many characters of a value an error message repeats."""


def mapping(data: Any, where: str) -> Mapping[str, Any]:
    """Return a JSON object."""
    if not isinstance(data, Mapping):
        raise SceneError(f"{where}: an object {{…}} is expected here, not {kind(data)}")
    return data


def number(data: Any, where: str) -> float:
    """Return a number, not a truth value, and finite."""
    if isinstance(data, bool) or not isinstance(data, int | float):
        raise SceneError(f"{where}: a number is expected, not {kind(data)}")
    try:
        value = float(data)
    except OverflowError:
        raise SceneError(f"{where}: the number is too large") from None
    if not math.isfinite(value):
        raise SceneError(f"{where}: {json.dumps(value)} is no number to work with; leave the object out")
    return value


def text(data: Any, where: str) -> str:
    """Return a text that is neither blank nor too long, and can be written as UTF-8."""
    if not isinstance(data, str):
        raise SceneError(f"{where}: a text is expected, not {kind(data)}")
    if not data.strip():
        raise SceneError(f"{where}: a text is expected, and this one is blank")
    if len(data) > MAX_TEXT:
        raise SceneError(f"{where}: a text has at most {MAX_TEXT:,} characters, and this one has {len(data):,}")
    if any("\ud800" <= character <= "\udfff" for character in data):
        raise SceneError(f"{where}: the text has half a character in it, and cannot be written")
    return data


def score(entry: Mapping[str, Any], where: str) -> float:
    """Return the ``score`` that a detector gave, a probability; 1 where there is none."""
    found = entry.get("score")
    value = 1.0 if found is None else number(found, f"{where}: 'score'")
    if not 0 <= value <= 1:
        raise SceneError(f"{where}: 'score' is a confidence and lies between 0 and 1, not at {value:g}")
    return value


def pixels(data: Any, where: str) -> float | None:
    """Return an image's height or width, or None where it is not given."""
    if data is None:
        return None
    value = number(data, where)
    if not 0 < value < float("inf"):
        raise SceneError(f"{where}: an image measures some pixels, not {value:g}")
    return value


def items(entry: Mapping[str, Any], key: str, where: str) -> list[Any]:
    """Return the list under ``key``."""
    if key not in entry:
        raise SceneError(f"{where}: '{key}' is missing")
    if not isinstance(entry[key], list):
        raise SceneError(f"{where}: '{key}' must be a list, not {kind(entry[key])}")
    return list(entry[key])


def kind(data: Any) -> str:
    """Return what a JSON value is, in words.

    >>> kind(None), kind(1.5), kind([])
    ('null', 'a number', 'a list')
    """
    if data is None or isinstance(data, bool):
        return {None: "null", True: "true", False: "false"}[data]
    return {"str": "a text", "int": "a number", "float": "a number", "list": "a list"}.get(
        type(data).__name__, "an object"
    )


def shown(value: object) -> str:
    """Return a value as a message repeats it: on one line, never longer than :data:`MAX_SHOWN`, whatever a file holds.

    >>> shown("a.jpg"), len(shown("a" * 1000))
    ('a.jpg', 60)
    >>> print(shown("two\\nlines"))
    two\\nlines
    """
    text = str(value)[: MAX_SHOWN + 1]
    plain = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
    return plain if len(plain) <= MAX_SHOWN else plain[: MAX_SHOWN - 1] + "…"
