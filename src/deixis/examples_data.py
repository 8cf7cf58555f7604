"""The shipped examples, by name."""

from __future__ import annotations

from pathlib import Path

EXAMPLES = Path(__file__).parent / "examples"


def example(name: str) -> Path:
    """The path of a shipped example, such as ``script1.layout``."""
    return EXAMPLES / name
