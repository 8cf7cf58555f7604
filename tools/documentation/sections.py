"""Check that public functions have the numpydoc sections of their parameters and results.

Public is what the Python reference documents: the functions and methods of all packages whose names begin with no
underscore, and everything that ``deixis`` and ``deixis.testing`` export, with the inherited methods of its classes.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from documentation.package_reference import packages

EXPORTING = ("deixis", "deixis.testing")
"""Packages whose exported names must have all sections, wherever they are defined."""

NO_RESULT = (inspect.Signature.empty, None, "None", "NoReturn")
"""Return annotations of functions that return nothing."""


def findings() -> Iterator[str]:
    """Yield a line for each section that a public function lacks, or whose parameters are not those of the function.

    Yields
    ------
    str
        Module and name of the function, and what is missing or wrong.
    """
    checked = set[Callable[..., Any]]()
    for owner, function in public_functions():
        if function not in checked:
            checked.add(function)
            yield from (f"{function.__module__}.{function.__qualname__}: {wrong}" for wrong in lacks(function, owner))


def public_functions() -> Iterator[tuple[type | None, Callable[..., Any]]]:
    """Yield the functions that must have all sections, each with its class or None.

    Yields
    ------
    tuple
        Class and function.
    """
    for name in EXPORTING:
        module = import_module(name)
        for exported in module.__all__:
            yield from _functions(getattr(module, exported))
    for name, folder in packages():
        for module in modules(name, folder):
            members = [value for key, value in vars(module).items() if not key.startswith("_")]
            for member in members:
                if getattr(member, "__module__", None) == module.__name__:
                    yield from _functions(member)


def modules(package: str, folder: Path) -> Iterator[Any]:
    """Yield a package and its modules, imported.

    Parameters
    ----------
    package
        Dotted name of the package.
    folder
        Its folder.

    Yields
    ------
    module
        The package first, then its modules by name.
    """
    yield import_module(package)
    for file in sorted(folder.glob("*.py")):
        if not file.stem.startswith("__"):
            yield import_module(f"{package}.{file.stem}")


def _functions(member: Any) -> Iterator[tuple[type | None, Callable[..., Any]]]:
    """Yield a function, or the public methods of a class that Deixis defines, without those of its generated parts."""
    if inspect.isclass(member):
        for name, value in inspect.getmembers_static(member):
            function = value.__func__ if isinstance(value, staticmethod | classmethod) else value
            if not name.startswith("_") and inspect.isfunction(function) and _is_ours(function):
                yield member, inspect.unwrap(function)
    elif inspect.isfunction(member) and _is_ours(member):
        yield None, inspect.unwrap(member)


def _is_ours(function: Callable[..., Any]) -> bool:
    return function.__module__.startswith("deixis") and bool(function.__doc__)


def lacks(function: Callable[..., Any], owner: type | None = None) -> list[str]:
    """Return what is missing or wrong in the sections of a function.

    Parameters
    ----------
    function
        The function.
    owner
        The class of a method. A method that overrides one with all sections needs none of its own.

    Returns
    -------
    list of str
        One message for each section.

    Examples
    --------
    >>> def area(width: float, height: float) -> float:
    ...     '''Return the area.
    ...
    ...     Parameters
    ...     ----------
    ...     width
    ...         Width in metres.
    ...     '''
    >>> lacks(area)
    ["'Parameters' lacks height", "'Returns' is missing"]
    """
    overridden = [
        base.__dict__[function.__name__]
        for base in (owner.__mro__[1:] if owner else ())
        if function.__name__ in base.__dict__
    ]
    if any(inspect.isfunction(base) and _is_ours(base) and not lacks(base) for base in overridden):
        return []
    signature = inspect.signature(function)
    expected = [name for name in signature.parameters if name not in ("self", "cls") and not name.startswith("_")]
    found = sections(inspect.getdoc(function) or "")
    named = re.findall(r"^\*{0,2}(\w+(?:, \*{0,2}\w+)*)(?: :.*)?$", found.get("Parameters", ""), flags=re.MULTILINE)
    documented = [name.strip(" *") for line in named for name in line.split(",")]
    messages = []
    if missing := [name for name in expected if name not in documented]:
        messages.append(f"'Parameters' lacks {', '.join(missing)}")
    if unknown := [name for name in documented if name not in signature.parameters]:
        messages.append(f"'Parameters' has {', '.join(unknown)}, which the function does not have")
    if signature.return_annotation not in NO_RESULT and not {"Returns", "Yields"} & found.keys():
        messages.append("'Returns' is missing")
    return messages


def without_example(owner: type) -> list[str]:
    """Return the public methods and properties of a class that no example calls.

    The examples are those in the docstrings of the class, of its bases, and of their methods and properties.

    Parameters
    ----------
    owner
        The class.

    Returns
    -------
    list of str
        Names of methods and properties that Deixis or the caller's module defines, sorted.

    Examples
    --------
    >>> class Bell:
    ...     def ring(self):
    ...         '''Ring the bell.'''
    >>> without_example(Bell)
    ['ring']
    """
    members = {
        name: function
        for kind in reversed(owner.__mro__)
        for name, value in vars(kind).items()
        if not name.startswith("_") and (function := _function_of(value)) is not None
    }
    docstrings = "\n".join(map(_doc, [*owner.__mro__, *members.values()]))
    examples = "\n".join(re.findall(r"^\s*(?:>>>|\.\.\.) (.*)$", docstrings, flags=re.MULTILINE))
    return sorted(
        name
        for name, function in members.items()
        if ">>> " not in _doc(function) and not re.search(rf"\.{name}\b", examples)
    )


def _function_of(value: Any) -> Callable[..., Any] | None:
    """Return the function of a method or a property, with a docstring; None for other members."""
    for part in ("__func__", "fget", "func"):
        value = getattr(value, part, value)
    return value if inspect.isfunction(value) and value.__doc__ else None


def _doc(member: Any) -> str:
    return inspect.getdoc(member) or ""


def sections(docstring: str) -> dict[str, str]:
    r"""Split the numpydoc sections off a docstring.

    Parameters
    ----------
    docstring
        The docstring, with its indentation removed.

    Returns
    -------
    dict
        Text of each section by its title.

    Examples
    --------
    >>> sections("Return it.\n\nReturns\n-------\nint\n    A number.")
    {'Returns': 'int\n    A number.'}
    """
    parts = re.split(r"^([A-Z][A-Za-z ]+)\n-{3,}\n", docstring, flags=re.MULTILINE)
    return dict(zip(parts[1::2], (text.strip() for text in parts[2::2]), strict=True))
