"""Keep what is read from files of the package beside Python's bytecode, because reading them takes longer.

Reading the TBox takes a tenth of the start-up time of a small command. Like bytecode, the result is written at the
first use if the folder can be written, and is never used if a file that it was made from has changed since: the digest
of these files, of the code that reads them and of the version of Python is a part of the name.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import sys
from collections.abc import Callable, Iterable
from importlib.util import cache_from_source
from pathlib import Path
from typing import TypeVar

Made = TypeVar("Made")


def kept(name: str, sources: Iterable[Path], make: Callable[[], Made]) -> Made:
    """Return what a function makes from files; read it from the kept result if there is one.

    Parameters
    ----------
    name
        Name of the result, a part of the name of its file.
    sources
        Everything that the result depends on: the files that are read, and those of the code that reads them and of
        the classes in the result. The first one determines the folder.
    make
        Function that makes the result, which can be pickled.

    Returns
    -------
    object
        The result.
    """
    files = list(sources)
    try:
        path = _path(name, files)
        digest, content = path.read_bytes().split(b"\n", 1)
        if hashlib.sha256(content).hexdigest().encode() == digest:
            found: Made = pickle.loads(content)
            return found
    except (OSError, ValueError, NotImplementedError, AttributeError, ImportError, EOFError, pickle.PickleError):
        pass  # there is none, or Python keeps no bytecode
    made = make()
    if not sys.dont_write_bytecode:
        with contextlib.suppress(OSError, NotImplementedError):
            _write(_path(name, files), pickle.dumps(made, protocol=pickle.HIGHEST_PROTOCOL))
    return made


def _path(name: str, files: list[Path]) -> Path:
    """Return the file of a result, in the folder of Python's bytecode."""
    digest = hashlib.sha256(sys.version.encode())
    for file in files:
        content = file.read_bytes()
        digest.update(f"{file.name} {len(content)}\n".encode() + content)
    tag = sys.implementation.cache_tag
    return Path(cache_from_source(str(files[0]))).with_name(f"{name}.{tag}.{digest.hexdigest()[:24]}.kept")


def _write(path: Path, content: bytes) -> None:
    """Write a result with its digest, and remove earlier results of this name."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_suffix(f".{os.getpid()}.new")
    new.write_bytes(hashlib.sha256(content).hexdigest().encode() + b"\n" + content)
    new.replace(path)
    for old in path.parent.glob(f"{path.name.rsplit('.', 2)[0]}.*.kept"):
        if old != path:
            old.unlink()
