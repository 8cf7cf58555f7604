"""Optional packages, the extra of Deixis that installs each, and the error where one is not installed.

Every import of an optional package follows a call of :func:`require`, inside the function that uses the package.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec

from deixis.errors import DeixisError


@dataclass(frozen=True, slots=True)
class OptionalPackage:
    """An optional package: its distribution, and the extra in ``pyproject.toml`` that installs it.

    ``extra`` is None for a package that belongs to no extra.
    """

    distribution: str
    extra: str | None


OPTIONAL = {
    "matplotlib": OptionalPackage("matplotlib", "plots"),
    "open3d": OptionalPackage("open3d", "perception"),
    "PIL": OptionalPackage("pillow", "perception"),
    "pandas": OptionalPackage("pandas", None),
    "pygls": OptionalPackage("pygls", "lsp"),
    "zenoh": OptionalPackage("eclipse-zenoh", "robot"),
    "sklearn": OptionalPackage("scikit-learn", "experiments"),
}
"""Optional packages by the names under which they are imported."""


class MissingExtraError(DeixisError, ImportError):
    """An optional package that is not installed; the message names the extra that installs it."""


def require(package: str, purpose: str) -> None:
    """Raise MissingExtraError unless an optional package is installed.

    Parameters
    ----------
    package
        Name of the package.
    purpose
        What needs the package, as the beginning of the message.

    Raises
    ------
    MissingExtraError
        If the package is not installed; the message says how to install it.

    Examples
    --------
    >>> import sys
    >>> from unittest.mock import patch
    >>> with patch.dict(sys.modules, matplotlib=None):
    ...     require("matplotlib", "drawing a picture")
    Traceback (most recent call last):
        ...
    deixis.extras.MissingExtraError: drawing a picture needs matplotlib; install it: pip install 'deixis[plots]'
    """
    if find_spec(package) is None:
        missing = OPTIONAL[package]
        wanted = missing.distribution if missing.extra is None else f"'deixis[{missing.extra}]'"
        raise MissingExtraError(f"{purpose} needs {missing.distribution}; install it: pip install {wanted}")
