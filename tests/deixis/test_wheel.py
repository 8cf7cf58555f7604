"""Builds of the repository: the same wheel from a clone, from a ZIP and from the source distribution."""

from __future__ import annotations

import shutil
import site
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from source_tree import ROOT, rooms_of, shipped_files, source_files

pytestmark = pytest.mark.slow

LINKED_ROOMS = [room for room in rooms_of() if room != "examples"]
"""Folders that type checkers see through links under ``src/deixis``."""


def copied(target: Path, links: str) -> Path:
    """Copy the tree, with links under ``src/deixis`` as a clone, a checkout without links or an sdist has them."""
    for name in source_files():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, target / name)
    for room in LINKED_ROOMS:
        link = target / "src" / "deixis" / room
        if links == "links":
            link.symlink_to(f"../../{room}")
        elif links == "texts":  # core.symlinks=false, and a ZIP unpacked by Python
            link.write_text(f"../../{room}", encoding="utf-8")
    return target


def run(*command: object, cwd: Path | None = None) -> str:
    done = subprocess.run([*map(str, command)], cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def build(tree: Path, out: Path, *options: str) -> set[str]:
    """Return the names of the files in the wheel."""
    pytest.importorskip("build")
    pytest.importorskip("setuptools", minversion="77")
    run(sys.executable, "-m", "build", *options, "--no-isolation", "--outdir", out, tree)
    (wheel,) = out.glob("*.whl")
    return set(zipfile.ZipFile(wheel).namelist())


def packaged(names: set[str]) -> set[str]:
    """Return the files of the package; what the wheel holds besides is its own description."""
    files = {name for name in names if name.startswith("deixis/")}
    (about,) = {name.partition("/")[0] for name in names - files}
    assert about.startswith("deixis-")
    assert about.endswith(".dist-info")
    return files


@pytest.mark.parametrize("links", ["links", "texts", "nothing"])
def test_the_wheel_holds_the_tree(tmp_path: Path, links: str) -> None:
    tree = copied(tmp_path / "tree", links)
    assert packaged(build(tree, tmp_path / "dist", "--wheel")) == set(shipped_files())


def test_the_sdist_holds_all_sources_and_builds_the_wheel(tmp_path: Path) -> None:
    tree, out = copied(tmp_path / "tree", "links"), tmp_path / "dist"
    assert packaged(build(tree, out)) == set(shipped_files())  # built from the sdist
    (sdist,) = out.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        held = {member.name.partition("/")[2] for member in archive if member.isfile()}
    assert set(source_files()) <= held
    assert [name for name in held if name.startswith(tuple(f"src/deixis/{room}/" for room in LINKED_ROOMS))] == []


def test_an_editable_install_needs_no_links(tmp_path: Path) -> None:
    pytest.importorskip("pip")
    tree, target = copied(tmp_path / "tree", "texts"), tmp_path / "installed"
    options = ["--quiet", "--disable-pip-version-check", "--no-deps", "--no-build-isolation"]
    run(sys.executable, "-m", "pip", "install", *options, "--target", target, "--editable", tree)
    imported = [f"deixis.{room}" for room in rooms_of()]
    program = (
        "import importlib, site, sys; site.addsitedir(sys.argv[1]); sys.path += sys.argv[2].split('|'); "
        "print(*(importlib.import_module(name).__file__ for name in sys.argv[3:]), sep='\\n')"
    )
    libraries = "|".join(site.getsitepackages())  # on the path without their .pth files
    found = run(sys.executable, "-S", "-c", program, target, libraries, *imported, cwd=tmp_path).split()
    assert [Path(file).resolve().parent for file in found] == [(tree / room).resolve() for room in rooms_of()]


def test_every_room_is_linked_for_type_checkers() -> None:
    links = [path for path in (ROOT / "src" / "deixis").iterdir() if path.is_symlink()]
    if not links:
        pytest.skip("this tree has no links")
    assert sorted(link.name for link in links) == LINKED_ROOMS
    assert all((link / "__init__.py").samefile(ROOT / link.name / "__init__.py") for link in links)
