"""The files of this source tree: all of them, and those that the wheel holds."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).parents[1]


def source_files(root: Path = ROOT) -> list[str]:
    """Return the files that belong to the tree, as POSIX paths from its root, without links.

    Git lists them where the tree is a repository, with new files that it does not ignore; elsewhere (an unpacked ZIP or
    source distribution) they are all files whose path ``.gitignore`` does not name.
    """
    if (root / ".git").exists() and shutil.which("git"):
        command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, cwd=root, capture_output=True, check=True).stdout.decode().split("\0")
    else:
        ignored = [line.rstrip("/") for line in (root / ".gitignore").read_text(encoding="utf-8").splitlines() if line]
        listed = list(_walk(root, ignored))
    rooms = {f"src/deixis/{room}" for room in rooms_of(root)}  # links, or the texts of links
    return sorted(name for name in listed if name and name not in rooms and (root / name).is_file())


def _walk(root: Path, ignored: list[str]) -> Iterator[str]:
    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if not any(fnmatch(name, pattern) for pattern in ignored)]
        for name in files:
            if not any(fnmatch(name, pattern) for pattern in ignored):
                yield (Path(folder) / name).relative_to(root).as_posix()


def rooms_of(root: Path = ROOT) -> list[str]:
    """Return the folders at the top that are packages: what is mapped into ``deixis``."""
    return sorted(path.parent.name for path in root.glob("*/__init__.py"))


def shipped_files(root: Path = ROOT) -> dict[str, str]:
    """Return the files that the wheel must hold: by path in the wheel, the path in the tree.

    They are everything under ``src/deixis`` and in the top folders that are packages.
    """
    rooms, shipped = rooms_of(root), {}
    for name in source_files(root):
        if name.startswith("src/deixis/"):
            shipped[name.removeprefix("src/")] = name
        elif name.partition("/")[0] in rooms:
            shipped[f"deixis/{name}"] = name
    return shipped
