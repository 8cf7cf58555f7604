"""Behaviour without the extras: the core's commands work, and each other command names its missing extra at once."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import packages_distributions
from pathlib import Path

import numpy as np
import pytest
from licences_page import needed
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from source_tree import ROOT, shipped_files

import deixis
from deixis.examples_data import example
from deixis.extras import OPTIONAL, MissingExtraError, require
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import write_cloud

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
SCRIPT, SCENE = example("formal_dinner.layout"), example("place_setting.scene.json")
LABELLED, SECOND = example("place_setting.labelled.scene.json"), example("second_table.scene.json")

CORE = [
    f"parse {SCRIPT}",
    f"parse {SCRIPT} --format turtle",
    f"fmt {SCRIPT}",
    f"infer {SCRIPT}",
    f"imagine {SCRIPT} -o out/imagined.scene.json",
    f"ground {SCRIPT} {SCENE} --time-limit 60",
    f"learn {SCRIPT} {LABELLED}",
    "show formal_dinner",
    f"check formal_dinner {SECOND} --report out/report.ttl",
    f"retrieve {SECOND}",
    "query ASK{?s?p?o}",
    "memory stats",
    "memory export",
    "perceive block.pcd -o out/block.scene.json",
    "teach out/block.scene.json o1 block",
    "recognise out/block.scene.json",
    "category list",
    f"relate {SCENE} --calculus rcc8",
    f"solve {example('place_setting.csp')} --calculus ra",
    f"time {example('serving.fluents.json')}",
    "reason",
    "relation left",
]
LACKING = {
    "simulate --random 2": "perception",
    f"simulate {SCRIPT} -o out/table.pcd": "perception",
    "perceive depth.png --intrinsics camera.json": "perception",
    "demo": "plots",
    f"ground {SCRIPT} {SCENE} --plot found.png": "plots",
    f"check formal_dinner {SECOND} --plot checked.png": "plots",
    f"imagine {SCRIPT} --plot imagined.png": "plots",
    "relation left --plot left.png": "plots",
    "perceive block.pcd --plot seen.png": "plots",
    "recognise out/block.scene.json --plot known.png": "plots",
    "experiment figure6": "plots",
    f"refer plate {SCENE} --plot meant.png": "plots",
    f"retrieve {SCENE} --plot similar.png": "plots",
    f"time {example('serving.fluents.json')} --plot times.png": "plots",
    "experiment scoreboard --plot board.png": "plots",
    "experiment open-ended": "experiments",
    "lsp": "lsp",
}
RUN = """
import io, json, sys
from contextlib import redirect_stderr, redirect_stdout
missing, commands = json.load(sys.stdin)
sys.modules.update(dict.fromkeys(missing))
from deixis.cli.app import main
said = {}
for command in commands:
    sys.argv, out, err = ["deixis", *command.split()], io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            main()
            code = 0
        except SystemExit as end:
            code = end.code or 0
    said[command] = code, out.getvalue(), err.getvalue()
print(json.dumps(said))
"""

Said = dict[str, tuple[int, str, str]]


def beyond_the_core() -> list[str]:
    """Return the modules that are installed here and that the core does not bring."""
    core = {"deixis", *needed("core")}
    by_module = {name: {canonicalize_name(one) for one in owners} for name, owners in packages_distributions().items()}
    return sorted(name for name, owners in by_module.items() if name.isidentifier() and not owners & core)


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> Said:
    """Output of every command in a process that can import only the core."""
    folder = tmp_path_factory.mktemp("slim")
    x, y = (axis.ravel() for axis in np.mgrid[-0.3:0.3:0.01, 0.5:1.1:0.01])
    block = (abs(x) < 0.05) & (abs(y - 0.8) < 0.05)
    points = np.stack([x, y, np.where(block, -0.64, -0.7)], axis=1).astype(np.float32)
    write_cloud(folder / "block.pcd", PointCloud(points))
    (folder / "depth.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    camera = {"width": 4, "height": 4, "fx": 1.0, "fy": 1.0, "cx": 2.0, "cy": 2.0}
    (folder / "camera.json").write_text(json.dumps(camera), encoding="utf-8")
    paths = [str(Path(deixis.__file__).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "DEIXIS_MEMORY": str(folder / "memory")}
    asked = json.dumps([beyond_the_core(), [*CORE, *LACKING]])
    command = [sys.executable, "-c", RUN]
    done = subprocess.run(
        command, input=asked, cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    found: Said = json.loads(done.stdout)
    return found


def test_the_extras_bring_more_than_the_core() -> None:
    assert set(OPTIONAL) | {"pandas", "plotly", "dash"} <= set(beyond_the_core())


@pytest.mark.parametrize("command", CORE, ids=lambda command: " ".join(command.split()[:2]).rpartition("/")[2])
def test_a_command_of_the_core_needs_no_extra(said: Said, command: str) -> None:
    code, out, err = said[command]
    assert (code in (0, 1), err) == (True, ""), (code, out)
    assert out


@pytest.mark.parametrize(("command", "extra"), LACKING.items(), ids=lambda part: part.split("/")[0])
def test_a_command_names_the_extra_that_it_lacks(said: Said, command: str, extra: str) -> None:
    code, out, err = said[command]
    assert (code, out) == (2, "")
    assert err.startswith("deixis: ") and err.count("\n") == 1
    assert f"pip install 'deixis[{extra}]'" in err


@pytest.mark.parametrize("package", [name for name, optional in OPTIONAL.items() if optional.extra is not None])
def test_the_extra_that_an_error_names_brings_the_package(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    optional = OPTIONAL[package]
    assert optional.extra is not None
    listed = [Requirement(line).name for line in PROJECT["optional-dependencies"][optional.extra]]
    assert any(name.startswith(optional.distribution) for name in listed)
    assert not any(Requirement(line).name.startswith(optional.distribution) for line in PROJECT["dependencies"])
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(
        MissingExtraError, match=rf"^this needs {optional.distribution}; .*'deixis\[{optional.extra}\]'$"
    ):
        require(package, "this")


def test_the_extra_all_brings_every_optional_package() -> None:
    assert needed("all").keys() >= {name for extra in ("perception", "plots", "experiments") for name in needed(extra)}


def test_no_module_imports_an_optional_package_as_it_loads() -> None:
    server = "src/deixis/lsp/server.py"  # made of pygls, and loaded by `deixis lsp` alone
    files = [ROOT / path for path in shipped_files().values() if path.endswith(".py") and path != server]
    imported = {file: set(imported_at_load(ast.parse(file.read_text(encoding="utf-8")))) for file in files}
    assert len(files) > 200
    assert {str(file): found & set(OPTIONAL) for file, found in imported.items() if found & set(OPTIONAL)} == {}


def imported_at_load(node: ast.AST) -> Iterator[str]:
    """Yield the top packages that a module imports when it is loaded: not in functions, not for type checkers."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in child.names)
        elif isinstance(child, ast.ImportFrom):
            yield (child.module or "").partition(".")[0]
        elif isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
            continue
        elif not isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from imported_at_load(child)
