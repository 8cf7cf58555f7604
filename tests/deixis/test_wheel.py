"""The wheel that a clean copy of the repository gives: everything that is needed, and nothing but ``deixis``."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def copied(target: Path) -> None:
    """Copies the files that git knows or would take, links as links."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout.decode()
    for name in filter(None, listed.split("\0")):
        source = ROOT / name
        if source.is_symlink() or source.exists():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target / name, follow_symlinks=False)


@pytest.mark.slow
@pytest.mark.skipif(not (ROOT / ".git").exists() or not shutil.which("git"), reason="this is no git repository")
def test_the_wheel_holds_what_it_should(tmp_path: Path) -> None:
    pytest.importorskip("build")
    pytest.importorskip("setuptools", minversion="77")
    copy, out = tmp_path / "copy", tmp_path / "dist"
    copied(copy)
    (copy / "README.md").touch()
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(out), str(copy)]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    (wheel,) = out.glob("*.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    top = {name.partition("/")[0] for name in names}
    assert top == {"deixis", *(name for name in top if name.startswith("deixis-") and name.endswith(".dist-info"))}
    assert len(top) == 2
    needed = ["py.typed", "cli.py", "ontology/deixis.ttl", "grammar/layout.lark", "memory/__init__.py"]
    assert {f"deixis/{name}" for name in needed} <= names
    shipped = {f"deixis/examples/{path.name}" for path in (copy / "examples").iterdir()}
    assert {name for name in names if name.startswith("deixis/examples/")} == shipped
    modules = {
        f"deixis/{room.name}/{module.relative_to(room).as_posix()}"
        for room in (copy / room for room in ("ontology", "reasoning", "grammar", "perception", "memory"))
        for module in room.rglob("*.py")
    }
    assert modules <= names
    stray = [name for name in names if Path(name).name.startswith("test_") or "bench" in name]
    assert not [*stray, *(name for name in names if name.endswith(".pyc"))]
