"""The examples in the docstrings run as they stand.

Modules are imported by their names: where there are no links under ``src/deixis``, pytest's own collector would import
a room's file a second time, under the name of its folder (``reasoning.relate`` beside
``deixis.reasoning.qualitative.relate``).
"""

from __future__ import annotations

import doctest
import importlib

import pytest
from source_tree import ROOT, shipped_files

MODULES = [
    shipped.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    for shipped, source in shipped_files().items()
    if source.endswith(".py") and ">>> " in (ROOT / source).read_text(encoding="utf-8")
]
TOOLS = [
    ".".join(file.relative_to(ROOT / "tools").with_suffix("").parts)
    for file in sorted((ROOT / "tools").rglob("*.py"))
    if ">>> " in file.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", [*MODULES, *TOOLS])
def test_docstring_examples_run(name: str) -> None:
    if name == "documentation.docstrings":
        pytest.importorskip("sphinx", reason="needs sphinx, of the extra docs")
    results = doctest.testmod(importlib.import_module(name))
    assert results.attempted > 0
    assert results.failed == 0
