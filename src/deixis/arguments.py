"""Check the arguments of public functions against their annotations, so that a wrong type is reported at the call."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Mapping
from functools import cache, wraps
from numbers import Integral, Real
from reprlib import Repr
from typing import Any, ParamSpec, TypeVar

from deixis.errors import ArgumentError

Given = ParamSpec("Given")
Result = TypeVar("Result")

FUNCTIONS = frozenset({"Callable", "Answerer", "LeftOut", "Progress", "Recording"})
"""Names in annotations that mean a function."""

UNCHECKED = frozenset({"Any", "ArrayLike", "Ask", "NDArray", "Rgb", "object"})
"""Names in annotations for which any value passes, because the function checks it itself."""

PROTOCOLS = {"Board": "now", "Detected": "cloud", "Knowledge": "recollection", "Part": "prepare", "TextIO": "write"}
"""Names in annotations that mean an object with certain methods or properties, each with one of them."""

MANY = frozenset({"Collection", "Sequence", "list", "tuple"})
"""Names in annotations that mean a collection whose entries can be read more than once."""

_VALUES = Repr()
_VALUES.maxstring = _VALUES.maxother = 60


def checks_arguments(function: Callable[Given, Result]) -> Callable[Given, Result]:
    """Make a function raise ArgumentError for an argument that does not have the type of its annotation.

    Parameters
    ----------
    function
        The function, in a module with ``from __future__ import annotations``: the annotations are read as text, so that
        no module is imported for them. A class is recognised by its name.

    Returns
    -------
    Callable
        The function with the check before it.

    Examples
    --------
    >>> @checks_arguments
    ... def repeated(text: str, times: int = 2) -> str:
    ...     return text * times
    >>> repeated("ab")
    'abab'
    >>> repeated("ab", 1.5)
    Traceback (most recent call last):
        ...
    deixis.errors.ArgumentError: `times` must be a whole number, got 1.5
    """
    call: Callable[..., Result] = function
    code = function.__code__
    names = code.co_varnames[: code.co_argcount]
    annotations = function.__annotations__

    def taken(name: str, value: Any) -> Any:
        return typed(name, value, annotations[name]) if name in annotations else value

    @wraps(function)
    def checked(*args: Given.args, **kwargs: Given.kwargs) -> Result:
        __tracebackhide__ = True  # pytest shows the caller instead
        first = (taken(name, value) for name, value in zip(names, args, strict=False))
        named = {name: taken(name, value) for name, value in kwargs.items()}
        return call(*first, *args[len(names) :], **named)

    return checked


def require_fields(record: object, unless: Collection[str] = ()) -> None:
    """Raise ArgumentError unless each field of a dataclass has the type of its annotation.

    Parameters
    ----------
    record
        The object, of a class in a module with ``from __future__ import annotations``.
    unless
        Names of fields that are not checked.

    Raises
    ------
    ArgumentError
        If a field has another type; the message names the field.
    """
    for name, annotation in type(record).__annotations__.items():
        if name not in unless:
            typed(name, getattr(record, name), annotation)


def typed(name: str, value: Any, annotation: str) -> Any:
    """Return a value of the type of an annotation; raise ArgumentError for a value of another type.

    Parameters
    ----------
    name
        Name of the parameter.
    value
        The value that was given for it.
    annotation
        The annotation as text, such as ``str | Path | None``.

    Returns
    -------
    Any
        The value; a scalar of NumPy as a number of Python, which all file formats and stores can hold.

    Raises
    ------
    ArgumentError
        If it has another type, or is not a path; the message says what is expected.

    Examples
    --------
    >>> typed("labels", ["cup", None], "Sequence[str | None]")
    ['cup', None]
    >>> typed("labels", "cup", "Sequence[str | None]")
    Traceback (most recent call last):
        ...
    deixis.errors.ArgumentError: `labels` must be a list of strings or None, got 'cup'
    """
    alternatives = _alternatives(annotation)
    if not any(_is(value, *alternative) for alternative in alternatives):
        raise ArgumentError(f"`{name}` must be {_in_words(alternatives)}, got {_shown(value)}")
    if isinstance(value, str):
        if (not value or "\0" in value) and ("Path", "") in alternatives:
            raise ArgumentError(f"`{name}` must have at least one character, and no NUL character, got {value!r}")
        return value
    return _plain(value, alternatives)


def _plain(value: Any, alternatives: tuple[tuple[str, str], ...]) -> Any:
    """Return a number of a type that is not Python's own as one of Python's, where a number is expected."""
    kinds = {name for name, _ in alternatives}
    if value is None or type(value) in (bool, int, float) or kinds.isdisjoint(("bool", "int", "float")):
        return value
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        return float(value)
    return bool(value) if _KNOWN["bool"](value) else value


@cache
def _alternatives(annotation: str) -> tuple[tuple[str, str], ...]:
    """Return the types of a union, each as its name and what stands in its brackets."""
    split = (part.partition("[") for part in _parts(annotation, "|"))
    return tuple((name, inner.removesuffix("]")) for name, _, inner in split)


def _parts(annotation: str, separator: str) -> list[str]:
    """Return the parts of an annotation between separators that are not in brackets."""
    parts, depth, start = [], 0, 0
    for at, character in enumerate(annotation):
        depth += (character == "[") - (character == "]")
        if character == separator and depth == 0:
            parts.append(annotation[start:at])
            start = at + 1
    return [part.strip() for part in (*parts, annotation[start:])]


def _is(value: object, name: str, inner: str) -> bool:
    """Return whether a value has a type, given by its name and what stands in its brackets."""
    if name in UNCHECKED:
        return True
    if name in FUNCTIONS:
        return callable(value)
    if name in MANY:
        if not isinstance(value, Collection) or isinstance(value, str | bytes | Mapping):
            return False
        entries = _parts(inner.removesuffix(", ..."), ",")
        if _is_fixed(name, inner) and len(value) != len(entries):
            return False
        kinds = map(_alternatives, entries if _is_fixed(name, inner) else entries * len(value))
        return all(any(_is(one, *kind) for kind in of) for one, of in zip(value, kinds, strict=True))
    if name == "Iterable" and inner and isinstance(value, Collection) and not isinstance(value, str | bytes | Mapping):
        return all(any(_is(one, *kind) for kind in _alternatives(inner)) for one in value)
    if name in PROTOCOLS:
        return hasattr(value, PROTOCOLS[name])
    known = _KNOWN.get(name)
    return known(value) if known is not None else any(base.__name__ == name for base in type(value).__mro__)


def _is_fixed(name: str, inner: str) -> bool:
    """Return whether a collection is a tuple with a type for each entry."""
    return name == "tuple" and not inner.endswith("...")


def _is_number(value: object) -> bool:
    """Return whether a value is a real number that a float can hold."""
    if not isinstance(value, Real):
        return False
    try:
        float(value)
    except OverflowError:
        return False
    return True


_KNOWN: dict[str, Callable[[object], bool]] = {
    "None": lambda value: value is None,
    "bool": lambda value: type(value).__name__ in ("bool", "bool_"),  # NumPy's, too
    "int": lambda value: isinstance(value, Integral),
    "float": _is_number,
    "str": lambda value: isinstance(value, str),
    "Path": lambda value: isinstance(value, os.PathLike),
    "Mapping": lambda value: isinstance(value, Mapping),
    "Iterable": lambda value: isinstance(value, Iterable) and not isinstance(value, bytes),
}
"""Tests of types that have another meaning in an annotation than a class of this name."""

_WORDS = {
    "None": ("None", "None"),
    "bool": ("True or False", "booleans"),
    "int": ("a whole number", "whole numbers"),
    "float": ("a number", "numbers"),
    "str": ("a string", "strings"),
    "Path": ("a path", "paths"),
    "Mapping": ("a mapping", "mappings"),
    "Iterable": ("an iterable", "iterables"),
    "TextIO": ("an open text file", "open text files"),
}
"""Names of types in words, in the singular and the plural."""


def _in_words(alternatives: tuple[tuple[str, str], ...], plural: bool = False) -> str:
    """Return the types of a union in words: *a string, a path or None*."""
    words = []
    for name, inner in alternatives:
        if name in MANY:
            inside = _parts(inner.removesuffix(", ..."), ",")
            one, several = ("a tuple", "tuples") if _is_fixed(name, inner) else ("a list", "lists")
            joined = " and ".join(_in_words(_alternatives(part), plural=not _is_fixed(name, inner)) for part in inside)
            words.append(f"{several if plural else one} of {joined}")
        elif name in FUNCTIONS:
            words.append("functions" if plural else "a function")
        elif name in _WORDS:
            words.append(_WORDS[name][plural])
        else:
            words.append(f"{name}s" if plural else f"{'an' if name[0] in 'AEIOU' else 'a'} {name}")
    return " or ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else words[0]


def _shown(value: object) -> str:
    """Return a value in few characters, whatever its ``repr`` does."""
    try:
        return _VALUES.repr(value)
    except Exception:  # repr of a user's class, or of an integer with thousands of digits
        return f"an object of the type {type(value).__name__}"
