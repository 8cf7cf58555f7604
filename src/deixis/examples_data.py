"""The shipped examples, by name."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

EXAMPLES = Path(str(files("deixis.examples")))


def example(name: str) -> Path:
    """Return the path of a shipped example.

    Parameters
    ----------
    name
        Name of its file, such as ``script1.layout``.

    Returns
    -------
    Path
        The path in the installed package.
    """
    return EXAMPLES / name
