"""Reading script files, and finding the ones that a script includes: bounded, and never outside its folder."""

from __future__ import annotations

import codecs
import stat
from dataclasses import dataclass, field
from pathlib import Path

from deixis.grammar.errors import Refusal, ScriptFileError, shortened
from deixis.ontology.facts import Source

MAX_FILE_BYTES = 64 * 1024 * 1024  # bytes of one file
MAX_INCLUDE_DEPTH = 32  # includes within includes
MAX_INCLUDED_FILES = 1_000  # included by one script


def read_text(path: Path, shown: str, lenient: bool = False) -> str:
    """Return the text of a file; raises ScriptFileError, which names it as ``shown``, where it cannot be read.

    ``lenient`` reads what is not UTF-8 as the replacement character instead of refusing it.
    """
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise ScriptFileError(f"{shown}: this is a directory, not a layout script")
        if not stat.S_ISREG(status.st_mode):
            raise ScriptFileError(f"{shown}: this is no regular file")
        with path.open("rb") as file:
            data = file.read(MAX_FILE_BYTES + 1)
    except FileNotFoundError:
        raise ScriptFileError(f"{shown}: there is no such file") from None
    except ScriptFileError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ScriptFileError(f"{shown}: this file cannot be read ({reason})") from None
    if len(data) > MAX_FILE_BYTES:
        raise ScriptFileError(f"{shown}: this file is larger than {MAX_FILE_BYTES // 1024**2} MB")
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise ScriptFileError(f"{shown}: this file is UTF-16, not UTF-8; save it as UTF-8")
    try:
        return data.decode("utf-8", "replace" if lenient else "strict")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ScriptFileError(f"{shown}: line {line} is not UTF-8; save the file as UTF-8") from None


@dataclass
class Includes:
    """The files that were included so far, and those that are open right now."""

    folder: Path  # real path of the outermost script's folder
    open: list[Path]  # real paths, the outermost script first
    seen: set[Path] = field(default_factory=set)

    def find(self, path: str, beside: Path, source: Source) -> Path | None:
        """The real path of an included file, None where it was read before; raises Refusal where it is out of bounds.

        ``beside`` is the folder of the including file.
        """
        if not path.strip():
            raise Refusal(source, "an include needs the name of a file")
        try:
            real = (beside / path).resolve()
        except (OSError, ValueError, RuntimeError):
            raise Refusal(source, f"'{shortened(path)}' cannot be a file's name") from None
        if not real.is_relative_to(self.folder):
            raise Refusal(source, f"'{shortened(path)}' is outside the folder of the script")
        if real in self.open:
            names = [path.name for path in self.open[self.open.index(real) :]]
            cycle = " includes ".join([*names, real.name]) if len(names) > 1 else None
            raise Refusal(source, f"'{shortened(path)}' includes itself", cycle)
        if real in self.seen:
            return None
        if len(self.open) > MAX_INCLUDE_DEPTH:
            raise Refusal(source, f"includes are nested deeper than {MAX_INCLUDE_DEPTH}")
        if len(self.seen) >= MAX_INCLUDED_FILES:
            raise Refusal(source, f"more than {MAX_INCLUDED_FILES:,} files are included")
        self.seen.add(real)
        return real
