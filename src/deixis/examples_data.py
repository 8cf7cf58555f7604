"""The shipped examples, by name."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

EXAMPLES = Path(str(files("deixis.examples")))


def example(name: str) -> Path:
    """Return the path of a shipped example, such as ``script1.layout``."""
    return EXAMPLES / name
