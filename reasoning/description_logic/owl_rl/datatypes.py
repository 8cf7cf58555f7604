"""Literals as data values: equality of values, ill-formed literals, and membership in datatypes.

Source: OWL 2 Web Ontology Language Structural Specification (second edition), section 4, and XML Schema Definition
Language 1.1 Part 2. The datatypes are those of OWL 2 RL, ``owl:real`` and ``owl:rational``. The values of other
datatypes are not known.

>>> value_of('"01"^^<http://www.w3.org/2001/XMLSchema#int>') == value_of('"1.0"^^<http://www.w3.org/2001/XMLSchema#decimal>')
True
"""

from __future__ import annotations

import base64
import binascii
import re
from collections.abc import Callable
from datetime import datetime, timedelta
from enum import Enum
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from deixis.reasoning.description_logic.terms import term


class ValueSpace(Enum):
    """Pairwise disjoint sets of values."""

    REAL = "real"
    FLOAT = "float"
    DOUBLE = "double"
    STRING = "string"  # with or without a language
    BOOLEAN = "boolean"
    URI = "anyURI"
    HEX = "hexBinary"
    BASE64 = "base64Binary"
    TIME = "dateTime"


class DataValue(NamedTuple):
    """A value of a literal; two literals denote the same value exactly if these are equal."""

    space: ValueSpace
    value: object


class IllFormedError(ValueError):
    """A text that is not in the lexical space of its datatype."""


class Datatype(NamedTuple):
    """A datatype: the function that reads its literals, and the test of which values of its space belong to it."""

    space: ValueSpace
    read: Callable[[str], object]
    belongs: Callable[[object], bool] = lambda value: True


_DECIMAL = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)")
_INTEGER = re.compile(r"[+-]?\d+")
_RATIONAL = re.compile(r"([+-]?\d+)\s*/\s*(\d*[1-9]\d*)")
_FLOATING = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|[+-]?INF|NaN")
_TIME = re.compile(
    r"(?P<year>-?(?:[1-9]\d{3,}|0\d{3}))-(?P<month>\d\d)-(?P<day>\d\d)"
    r"T(?P<hour>\d\d):(?P<minute>\d\d):(?P<second>\d\d)(?P<fraction>\.\d+)?(?P<zone>Z|[+-]\d\d:\d\d)?"
)
MOST_DIGITS = 4000
"""Maximum number of digits of a number that is read; the value of a longer one is not known."""


def _matching(pattern: re.Pattern[str], text: str) -> re.Match[str]:
    found = pattern.fullmatch(text)
    if found is None:
        raise IllFormedError(text)
    return found


def _decimal(text: str) -> Fraction:
    return Fraction(_matching(_DECIMAL, text).group())


def _integer(text: str) -> Fraction:
    return Fraction(int(_matching(_INTEGER, text).group()))


def _rational(text: str) -> Fraction:
    numerator, denominator = _matching(_RATIONAL, text).groups()
    return Fraction(int(numerator), int(denominator))


def _double(text: str) -> object:
    number = float(_matching(_FLOATING, text).group())
    return "NaN" if number != number else number + 0.0  # minus zero is zero


def _float(text: str) -> object:
    with np.errstate(over="ignore"):
        number = float(np.float32(float(_matching(_FLOATING, text).group())))
    return "NaN" if number != number else number + 0.0


def _boolean(text: str) -> bool:
    if text not in ("true", "false", "1", "0"):
        raise IllFormedError(text)
    return text in ("true", "1")


def _hex(text: str) -> bytes:
    try:
        return binascii.unhexlify(text)
    except (binascii.Error, ValueError) as error:
        raise IllFormedError(text) from error


def _base64(text: str) -> bytes:
    try:
        return base64.b64decode("".join(text.split()), validate=True)
    except (binascii.Error, ValueError) as error:
        raise IllFormedError(text) from error


def _time(text: str) -> tuple[object, ...]:
    """Return the instant (days since year 0, seconds of the day), and whether it has a time zone."""
    found = _matching(_TIME, text)
    year, month, day, hour, minute, second = map(int, found.groups()[:6])
    midnight = hour == 24
    if midnight and (minute or second or int((found["fraction"] or ".0")[1:])):
        raise IllFormedError(text)
    cycle = year % 400  # the calendar repeats after 400 years; datetime supports years from 1 on
    try:
        moment = datetime(cycle + 400, month, day, 0 if midnight else hour, minute, second) + timedelta(days=midnight)
    except ValueError as error:
        raise IllFormedError(text) from error
    zone = found["zone"]
    if zone not in (None, "Z"):
        hours, minutes = int(zone[1:3]), int(zone[4:])
        if minutes > 59 or hours * 60 + minutes > 14 * 60:
            raise IllFormedError(text)
        moment -= timedelta(minutes=(hours * 60 + minutes) * (-1 if zone[0] == "-" else 1))
    return year // 400 * 400, moment, Fraction(found["fraction"] or "0"), zone is not None


def _is_decimal(value: object) -> bool:
    """Return whether a fraction has finitely many decimals."""
    assert isinstance(value, Fraction)
    rest = value.denominator
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
    return rest == 1


def _within(low: int | None, high: int | None) -> Callable[[object], bool]:
    def belongs(value: object) -> bool:
        assert isinstance(value, Fraction)
        whole = value.denominator == 1
        return whole and (low is None or value >= low) and (high is None or value <= high)

    return belongs


def _text(pattern: str) -> Callable[[object], bool]:
    compiled = re.compile(pattern)
    return lambda value: isinstance(value, str) and compiled.fullmatch(value) is not None


_COLLAPSED = r"(?:[^\s]+(?: [^\s]+)*)?"
_NAME_START, _NAME = r"[^\W\d]", r"[\w.\-·]"


def _checked(belongs: Callable[[object], bool], read: Callable[[str], object]) -> Callable[[str], object]:
    """Return a reader that refuses values that do not belong to the datatype."""

    def checked(text: str) -> object:
        value = read(text)
        if not belongs(value):
            raise IllFormedError(text)
        return value

    return checked


def _integers(low: int | None = None, high: int | None = None) -> Datatype:
    belongs = _within(low, high)
    return Datatype(ValueSpace.REAL, _checked(belongs, _integer), belongs)


def _strings(pattern: str, collapsed: bool = True) -> Datatype:
    belongs = _text(pattern)

    def read(text: str) -> str:
        return " ".join(text.split()) if collapsed else re.sub(r"[\t\n\r]", " ", text)

    return Datatype(ValueSpace.STRING, _checked(belongs, read), belongs)


DATATYPES: dict[str, Datatype] = {
    term(name): datatype
    for name, datatype in {
        "owl:real": Datatype(ValueSpace.REAL, _rational),
        "owl:rational": Datatype(ValueSpace.REAL, _rational),
        "xsd:decimal": Datatype(ValueSpace.REAL, _decimal, _is_decimal),
        "xsd:integer": _integers(),
        "xsd:nonNegativeInteger": _integers(0),
        "xsd:positiveInteger": _integers(1),
        "xsd:nonPositiveInteger": _integers(None, 0),
        "xsd:negativeInteger": _integers(None, -1),
        "xsd:long": _integers(-(2**63), 2**63 - 1),
        "xsd:int": _integers(-(2**31), 2**31 - 1),
        "xsd:short": _integers(-(2**15), 2**15 - 1),
        "xsd:byte": _integers(-(2**7), 2**7 - 1),
        "xsd:unsignedLong": _integers(0, 2**64 - 1),
        "xsd:unsignedInt": _integers(0, 2**32 - 1),
        "xsd:unsignedShort": _integers(0, 2**16 - 1),
        "xsd:unsignedByte": _integers(0, 2**8 - 1),
        "xsd:double": Datatype(ValueSpace.DOUBLE, _double),
        "xsd:float": Datatype(ValueSpace.FLOAT, _float),
        "xsd:string": Datatype(ValueSpace.STRING, str, lambda value: isinstance(value, str)),
        "rdf:PlainLiteral": Datatype(ValueSpace.STRING, str),
        "rdf:langString": Datatype(ValueSpace.STRING, str, lambda value: not isinstance(value, str)),
        "xsd:normalizedString": _strings(r"[^\t\n\r]*", collapsed=False),
        "xsd:token": _strings(_COLLAPSED),
        "xsd:language": _strings(r"[a-zA-Z]{1,8}(-[a-zA-Z0-9]{1,8})*"),
        "xsd:Name": _strings(rf"(?:{_NAME_START}|:)(?:{_NAME}|:)*"),
        "xsd:NCName": _strings(rf"{_NAME_START}{_NAME}*"),
        "xsd:NMTOKEN": _strings(rf"(?:{_NAME}|:)+"),
        "xsd:boolean": Datatype(ValueSpace.BOOLEAN, _boolean),
        "xsd:anyURI": Datatype(ValueSpace.URI, str),
        "xsd:hexBinary": Datatype(ValueSpace.HEX, _hex),
        "xsd:base64Binary": Datatype(ValueSpace.BASE64, _base64),
        "xsd:dateTime": Datatype(ValueSpace.TIME, _time),
        "xsd:dateTimeStamp": Datatype(
            ValueSpace.TIME,
            _checked(lambda value: isinstance(value, tuple) and value[-1] is True, _time),
            lambda value: isinstance(value, tuple) and value[-1] is True,
        ),
    }.items()
}
"""Known datatypes, by their terms."""

LITERAL = term("rdfs:Literal")
_STRING = term("xsd:string")
_PARTS = re.compile(r'"((?:[^"\\]|\\.)*)"(?:@([A-Za-z0-9-]+)|\^\^(<[^>]*>))?', re.DOTALL)
_ESCAPED = re.compile(r"\\(?:u([0-9A-Fa-f]{4})|U([0-9A-Fa-f]{8})|(.))")
_LETTERS = {"t": "\t", "b": "\b", "n": "\n", "r": "\r", "f": "\f"}


@lru_cache(maxsize=65536)
def value_of(literal: str) -> DataValue | None:
    """Return the value that a literal denotes, or None if its datatype is not known.

    Parameters
    ----------
    literal
        Literal in the syntax of N-Triples.

    Returns
    -------
    DataValue or None
        Value and value space, or None.

    Raises
    ------
    IllFormedError
        The text is not in the lexical space of the datatype.
    """
    found = _PARTS.fullmatch(literal)
    if found is None:
        return None
    text = _ESCAPED.sub(_letter, found[1]) if "\\" in found[1] else found[1]
    if found[2]:
        return DataValue(ValueSpace.STRING, (text, found[2].lower()))
    datatype = DATATYPES.get(found[3] or _STRING)
    if datatype is None or (datatype.space is ValueSpace.REAL and len(text) > MOST_DIGITS):
        return None
    spaced = datatype.space is not ValueSpace.STRING  # all other datatypes ignore white space around the text
    return DataValue(datatype.space, datatype.read(text.strip(" \t\n\r") if spaced else text))


def is_in(value: DataValue, datatype: str) -> bool | None:
    """Return whether a value belongs to a datatype, or None if the datatype is not known.

    Parameters
    ----------
    value
        Value of a literal.
    datatype
        Datatype as a term.

    Returns
    -------
    bool or None
        Whether it belongs, or None.

    Examples
    --------
    >>> one = value_of('"1"^^<http://www.w3.org/2001/XMLSchema#integer>')
    >>> [is_in(one, term(name)) for name in ("xsd:byte", "xsd:negativeInteger", "xsd:string")]
    [True, False, False]
    """
    if datatype == LITERAL:
        return True
    known = DATATYPES.get(datatype)
    return None if known is None else value.space is known.space and known.belongs(value.value)


def _letter(found: re.Match[str]) -> str:
    code = found[1] or found[2]
    return chr(min(int(code, 16), 0x10FFFF)) if code else _LETTERS.get(found[3], found[3])
