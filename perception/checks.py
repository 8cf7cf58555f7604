"""Check parsed JSON for the readers of scene and annotation files; each error names the place."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from deixis.ontology.strict_json import json_type
from deixis.perception.errors import SceneError

MAX_TEXT = 4_096
"""Maximum number of characters of an id, a label or a file name in a scene."""

MAX_SHOWN = 60
"""Maximum number of characters of a value that an error message repeats."""


def mapping(data: Any, where: str) -> Mapping[str, Any]:
    """Check that parsed JSON is an object.

    Parameters
    ----------
    data
        Parsed JSON.
    where
        Its place, for the message.

    Returns
    -------
    dict
        The data.

    Raises
    ------
    SceneError
        If it is anything else.
    """
    if not isinstance(data, Mapping):
        raise SceneError(f"{where} must be an object {{…}}, got {json_type(data)}")
    return data


def number(data: Any, where: str) -> float:
    """Check that parsed JSON is a finite number.

    Parameters
    ----------
    data
        Parsed JSON.
    where
        Its place, for the message.

    Returns
    -------
    float
        The number.

    Raises
    ------
    SceneError
        If it is anything else.
    """
    if isinstance(data, bool) or not isinstance(data, int | float):
        raise SceneError(f"{where} must be a number, got {json_type(data)}")
    try:
        value = float(data)
    except OverflowError:
        raise SceneError(f"{where}: the number is too large") from None
    if not math.isfinite(value):
        raise SceneError(f"{where} must be a finite number, got {json.dumps(value)}; leave the object out")
    return value


def text(data: Any, where: str) -> str:
    """Check that parsed JSON is a string that is not blank, not too long, and can be encoded as UTF-8.

    Parameters
    ----------
    data
        Parsed JSON.
    where
        Its place, for the message.

    Returns
    -------
    str
        The string.

    Raises
    ------
    SceneError
        If it is anything else.
    """
    if not isinstance(data, str):
        raise SceneError(f"{where} must be a string, got {json_type(data)}")
    if not data.strip():
        raise SceneError(f"{where} must be a string that is not blank, got {shown(json.dumps(data))}")
    if len(data) > MAX_TEXT:
        raise SceneError(f"{where} must have at most {MAX_TEXT:,} characters, got {len(data):,}; shorten it")
    if any("\ud800" <= character <= "\udfff" for character in data):
        raise SceneError(f"{where} contains half of a surrogate pair; correct it")
    return data


def score(entry: Mapping[str, Any], where: str) -> float:
    """Return the ``score`` of a detector.

    Parameters
    ----------
    entry
        Parsed JSON of one detection.
    where
        Its place, for the message.

    Returns
    -------
    float
        The probability, in [0, 1]; 1 if the entry has no score.

    Raises
    ------
    SceneError
        If the score is not a probability.
    """
    found = entry.get("score")
    value = 1.0 if found is None else number(found, f"{where}: 'score'")
    if not 0 <= value <= 1:
        raise SceneError(f"{where}: 'score' must be from 0 to 1, got {value:g}")
    return value


def pixels(data: Any, where: str) -> float | None:
    """Return the height or width of an image.

    Parameters
    ----------
    data
        Parsed JSON, or None.
    where
        Its place, for the message.

    Returns
    -------
    float or None
        The number of pixels, or None if it is not given.

    Raises
    ------
    SceneError
        If it is not a positive number.
    """
    if data is None:
        return None
    value = number(data, where)
    if not 0 < value < float("inf"):
        raise SceneError(f"{where} must be a number of pixels above 0, got {value:g}")
    return value


def items(entry: Mapping[str, Any], key: str, where: str) -> list[Any]:
    """Return the list under a key.

    Parameters
    ----------
    entry
        Parsed JSON of an object.
    key
        Key of the list.
    where
        Place of the object, for the message.

    Returns
    -------
    list of object
        Entries of the list, which are not checked.

    Raises
    ------
    SceneError
        If it is missing or not a list.
    """
    if key not in entry:
        raise SceneError(f"{where}: '{key}' is missing")
    if not isinstance(entry[key], list):
        raise SceneError(f"{where}: '{key}' must be a list, got {json_type(entry[key])}")
    return list(entry[key])


def shown(value: object) -> str:
    r"""Return a value for an error message.

    Parameters
    ----------
    value
        Value of any type, whose text may be long.

    Returns
    -------
    str
        Text on one line, with at most :data:`MAX_SHOWN` characters.

    Examples
    --------
    >>> shown("a.jpg"), len(shown("a" * 1000))
    ('a.jpg', 60)
    >>> print(shown("two\nlines"))
    two\nlines
    """
    text = str(value)[: MAX_SHOWN + 1]
    plain = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
    return plain if len(plain) <= MAX_SHOWN else plain[: MAX_SHOWN - 1] + "…"
