"""Strict reading of the JSON that users write: no repeated keys, no ``NaN``, and no numbers beyond double precision."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from deixis.errors import DeixisError
from deixis.printable import shortened

Record = TypeVar("Record")

MAX_DIGITS = 308
"""Maximum number of digits of a whole number, so that each converts to a finite double."""


class NumberTooLargeError(json.JSONDecodeError):
    """A number that no double holds; its place is that of its first digits in the text."""


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
        Message about ``NaN`` and ``Infinity``, after their name. None accepts them, and numbers such as ``1e400`` that
        are infinite as doubles, for readers that check them later.

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
    document = text.removeprefix("\ufeff")

    def refuse(name: str) -> float:
        raise ValueError(f"{name} {no_number}")

    def too_large(digits: str, message: str) -> None:
        raise NumberTooLargeError(message, document, document.find(digits))

    def whole_number(digits: str) -> int:
        count = len(digits.removeprefix("-"))
        if count > MAX_DIGITS:
            too_large(digits, f"a number of {count} digits is too large: at most {MAX_DIGITS} digits are read")
        return int(digits)

    def finite(digits: str) -> float:
        number = float(digits)
        if math.isinf(number):
            too_large(digits, f"the number {shortened(digits, 60)} is too large; the largest is about 1.8e308")
        return number

    def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) != len(pairs):
            counts = Counter(key for key, _ in pairs)
            twice = next(key for key, count in counts.items() if count > 1)
            raise ValueError(f"the key '{shortened(twice, 60)}' occurs twice in one object")
        return found

    try:
        return json.loads(
            document,
            parse_constant=refuse if no_number else None,
            parse_float=finite if no_number else None,
            parse_int=whole_number,
            object_pairs_hook=without_repeats,
        )
    except json.JSONDecodeError as wrong:
        message = wrong.msg
        if not isinstance(wrong, NumberTooLargeError):
            message = f"this is not valid JSON: {json_mistake(wrong.doc, wrong.pos, wrong.msg)}"
        raise error(f"{file}:{wrong.lineno}:{wrong.colno}: {message}") from wrong
    except RecursionError as wrong:
        raise error(
            f"{file}: the JSON is nested too deeply; it must have at most a few hundred levels of brackets"
        ) from wrong
    except ValueError as wrong:
        raise error(f"{file}: {wrong}") from wrong


def parse_json_line(text: str, file: str, line: int, error: type[DeixisError], no_number: str | None) -> Any:
    """Return the data in a line of a file of JSON lines.

    Parameters
    ----------
    text
        The line; single surrogates in it stand for bytes that are not UTF-8.
    file
        Name of the file, for messages.
    line
        Number of the line, from 1.
    error, no_number
        As for :func:`parse_json`.

    Returns
    -------
    object
        The parsed data.

    Raises
    ------
    error
        As :func:`parse_json` raises it, with the number of the line; also if the line is not UTF-8.

    Examples
    --------
    >>> parse_json_line('{"x" 1}', "t.jsonl", 7, DeixisError, None)
    Traceback (most recent call last):
        ...
    deixis.errors.DeixisError: t.jsonl:7:6: this is not valid JSON: a ':' is missing between the key and its value
    """
    try:
        text.encode()
    except UnicodeEncodeError as wrong:
        raise error(f"{file}:{line}:{wrong.start + 1}: the line is not UTF-8; save the file as UTF-8") from wrong
    try:
        return parse_json(text, f"{file}:{line}", error, no_number)
    except error as wrong:
        if isinstance(wrong.__cause__, json.JSONDecodeError):  # it counts its own lines
            if text.strip() in CLOSING:  # the first line of one value that is written over several lines
                raise error(
                    f"{file}:{line}: each line must be a whole JSON object, got only '{text.strip()}'; this may be "
                    "another kind of file"
                ) from wrong
            return parse_json("\n" * (line - 1) + text.removeprefix("\ufeff"), file, error, no_number)
        raise


CLOSING = {"{": "}", "[": "]"}
"""Closing bracket of each opening one."""

STRING_OR_BRACKET = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\]]')

MISTAKES = {
    "Expecting value": "a value is expected here",
    "Expecting property name enclosed in double quotes": "a key in double quotes is expected here",
    "Expecting ':' delimiter": "a ':' is missing between the key and its value",
    "Extra data": "there is more text after the end of the JSON",
    "Invalid control character at": "a string must be closed by '\"' on its own line",
}
"""Replacements for messages of Python's JSON reader that do not say what to do."""


def read_json_lines(
    lines: Iterable[str],
    file: str,
    read: Callable[[Any, str], Record],
    error: type[DeixisError],
    no_number: str | None,
    refused: list[str] | None = None,
) -> Iterator[tuple[int, Record]]:
    """Yield the numbers of the lines of a file of JSON lines, from 1, and what is read from each.

    Parameters
    ----------
    lines
        Lines; blank ones are skipped.
    file
        Name of the file, for messages.
    read
        Function of the data of a line and its place ``file:line``, which raises ``error`` for invalid data.
    error, no_number
        As for :func:`parse_json`.
    refused
        List that gets the message about each invalid line, which is left out then; None to raise an error about the
        first one.

    Yields
    ------
    tuple
        Number of the line, and the result of ``read``.

    Raises
    ------
    error
        If a line is invalid and ``refused`` is None.

    Examples
    --------
    >>> refused = []
    >>> list(read_json_lines(["1", "", "{", "2"], "t.jsonl", lambda data, where: data, DeixisError, None, refused))
    [(1, 1), (4, 2)]
    >>> len(refused)
    1
    """
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            found = read(parse_json_line(line, file, number, error, no_number), f"{file}:{number}")
        except error as wrong:
            if refused is None:
                raise
            refused.append(str(wrong))
        else:
            yield number, found


def json_mistake(text: str, position: int, message: str) -> str:
    """Say what is wrong at the place where reading JSON failed, and what to do.

    Parameters
    ----------
    text
        The JSON text.
    position
        Index of the character at which reading failed.
    message
        Message of Python's reader, for mistakes that are not recognised here.

    Returns
    -------
    str
        A sentence without a full stop; it names the line and column of a bracket that is not closed.

    Examples
    --------
    >>> json_mistake('{"objects": [{"id": "a"]}', 23, "Expecting ',' delimiter")
    "the '{' at 1:14 is not closed; add '}' before this ']'"
    >>> json_mistake('[1, 2,]', 6, "Expecting value")
    "remove the ',' before this ']'"
    """
    if not text.strip():
        return "the text is empty"
    rest, before = text[position:].lstrip(), text[:position].rstrip()
    here = rest[:1]
    opened = _open_brackets(before)
    if opened and (message.startswith("Expecting") or not here):
        start = opened[-1]
        closing = CLOSING[text[start]]
        line = text.count("\n", 0, start) + 1
        bracket = f"the '{text[start]}' at {line}:{start - text.rfind(chr(10), 0, start)}"
        if not here:
            return f"{bracket} is not closed; add '{closing}' at the end"
        if here in "]}" and here != closing:
            return f"{bracket} is not closed; add '{closing}' before this '{here}'"
        if here == "{" == text[start] and before.endswith(","):
            return f"{bracket} is not closed; add '{closing}' before the ',' that precedes this '{{'"
        if here == closing and before.endswith(","):
            return f"remove the ',' before this '{here}'"
    if here == "'":
        return 'write strings in double quotes ("), not in single ones'
    if message == "Expecting ',' delimiter":
        return (
            "a ',' is missing before this"
            if here in '{["-0123456789'
            else "a ',' or a closing bracket is expected here"
        )
    return MISTAKES.get(message, message)


def _open_brackets(text: str) -> list[int]:
    """Return the positions of the brackets that a text opens and does not close, the outermost first."""
    opened: list[int] = []
    for found in STRING_OR_BRACKET.finditer(text):
        if found[0] in CLOSING:
            opened.append(found.start())
        elif found[0] in "}]" and opened:
            opened.pop()
    return opened


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
