"""Run the shipped notebooks, cell by cell."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest
from source_tree import ROOT

NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))


def cells(path: Path) -> list[dict[str, Any]]:
    return list(json.loads(path.read_text(encoding="utf-8"))["cells"])


def test_there_are_three() -> None:
    assert len(NOTEBOOKS) == 3


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_from_top_to_bottom(path: Path) -> None:
    if path.stem == "from_a_cloud":
        pytest.importorskip("open3d")
    pytest.importorskip("matplotlib")
    namespace: dict[str, Any] = {}
    for number, cell in enumerate(cells(path)):
        if cell["cell_type"] != "code":
            continue
        body = ast.parse("".join(cell["source"])).body
        last = body.pop() if isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), f"{path.name}[{number}]", "exec"), namespace)
        if isinstance(last, ast.Expr):
            shown = eval(compile(ast.Expression(last.value), f"{path.name}[{number}]", "eval"), namespace)
            for display in ("_repr_html_", "_repr_png_"):
                if hasattr(shown, display):
                    getattr(shown, display)()
            if ast.unparse(last).endswith(".plot()"):
                assert shown._repr_png_().startswith(b"\x89PNG"), "a notebook shows no figure without this"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_no_cell_hides_its_picture(path: Path) -> None:
    for cell in cells(path):
        assert not "".join(cell["source"]).rstrip().endswith(".plot();")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_outputs(path: Path) -> None:
    for cell in cells(path):
        assert cell.get("outputs", []) == []
        assert cell.get("execution_count") is None
