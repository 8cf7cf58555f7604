"""A reasoner's classes as Java wants them in memory, kept on disk: reading them anew is half of a short run.

Java calls it class data sharing (JEP 310): a run says which classes it loads, and they are dumped. Java takes classes
of archives only, so that those that owlready2 lays beside HermiT's archive, which go first, are packed as well. What is
kept is for these very archives; Java itself looks whether it is for this Java, and does without it if not.
"""

from __future__ import annotations

import subprocess
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

_KEPT = Path(__file__).parent / "__pycache__"


def class_options(folder: Path) -> list[str]:
    """The options by which Java finds the classes of the reasoner in a folder, kept ones where there are any."""
    packed, dumped = _files(folder)
    if not dumped.exists():
        return ["-cp", f"{folder}:{folder}/*"]
    return [f"-XX:SharedArchiveFile={dumped}", "-Xlog:disable", "-cp", _class_path(folder, packed)]


def keep_classes(folder: Path, command: Callable[[list[str]], list[str]], run: list[str]) -> bool:
    """Keeps the classes that a run of a reasoner loads, and says whether it could.

    ``command`` makes one of Java out of arguments, with the options of any run: what is kept suits no others. ``run``
    is the main class and what it is told.
    """
    packed, dumped = _files(folder)
    try:
        packed.parent.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=packed.parent) as scratch:
            jar, classes, listed = (Path(scratch) / name for name in ("new.jar", "new.jsa", "listed"))
            _pack(folder, jar)
            jar.replace(packed)
            path = ["-cp", _class_path(folder, packed)]
            _quiet(command([f"-XX:DumpLoadedClassList={listed}", *path, *run]))
            dump = ["-Xshare:dump", f"-XX:SharedClassListFile={listed}", f"-XX:SharedArchiveFile={classes}"]
            _quiet(command([*dump, *path]))
            classes.replace(dumped)
    except (OSError, subprocess.SubprocessError):
        return False
    return True


def _files(folder: Path) -> tuple[Path, Path]:
    """Where the packed classes and the dumped ones of a reasoner are."""
    archives = [file.stat() for file in folder.glob("*.jar")]
    size, changed = sum(file.st_size for file in archives), max((file.st_mtime_ns for file in archives), default=0)
    name = f"{folder.name}-{size}-{changed}"
    return _KEPT / f"{name}.jar", _KEPT / f"{name}.jsa"


def _class_path(folder: Path, packed: Path) -> str:
    return ":".join(map(str, [packed, *sorted(folder.glob("*.jar"))]))


def _pack(folder: Path, jar: Path) -> None:
    with zipfile.ZipFile(jar, "w") as packed:
        for file in sorted(folder.rglob("*.class")):
            packed.write(file, file.relative_to(folder).as_posix())


def _quiet(command: list[str]) -> None:
    subprocess.run(command, capture_output=True, check=True, timeout=120)
