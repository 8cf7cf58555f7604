"""Read script files, and find the files that a script includes, within limits and never outside its folder."""

from __future__ import annotations

import codecs
import stat
from dataclasses import dataclass, field
from pathlib import Path

from deixis.grammar.errors import ScriptFileError, StatementError, shortened
from deixis.ontology.graph.facts import Source
from deixis.text_files import no_such_file

MAX_FILE_BYTES = 4 * 1024 * 1024  # bytes of one file; reading it takes up to 150 times as much memory
MAX_INCLUDE_DEPTH = 32  # maximum depth of nested includes
MAX_INCLUDED_FILES = 1_000  # maximum number of files that one script includes


def read_text(path: Path, shown: str, undecoded: str = "strict") -> str:
    """Return the text of a file, decoded from UTF-8.

    Parameters
    ----------
    path
        The file to read.
    shown
        Name of the file in error messages.
    undecoded
        What becomes of bytes that are not UTF-8: ``strict``, an error; ``replace``, the replacement character; or
        ``surrogateescape``, single surrogates, with which a caller finds the line.

    Returns
    -------
    str
        The text.

    Raises
    ------
    ScriptFileError
        If the file is missing, not a regular file, larger than ``MAX_FILE_BYTES``, unreadable or not UTF-8.
    """
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise ScriptFileError(f"{shown or '(an empty name)'}: this is a folder; name a file")
        if not stat.S_ISREG(status.st_mode):
            raise ScriptFileError(f"{shown}: this is not a regular file")
        with path.open("rb") as file:
            data = file.read(MAX_FILE_BYTES + 1)
    except FileNotFoundError:
        raise ScriptFileError(no_such_file(path, shown)) from None
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
        return data.decode("utf-8", undecoded)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ScriptFileError(f"{shown}: line {line} is not UTF-8; save the file as UTF-8") from None


@dataclass
class Includes:
    """Files that were included so far, and files that are being read."""

    folder: Path  # real path of the outermost script's folder
    open: list[Path]  # real paths, the outermost script first
    seen: set[Path] = field(default_factory=set)

    def find(self, path: str, beside: Path, source: Source) -> Path | None:
        """Return the real path of an included file.

        Parameters
        ----------
        path
            Path as the script writes it.
        beside
            Folder of the including file.
        source
            Place of the statement.

        Returns
        -------
        Path or None
            The path, or None if the file was read before.

        Raises
        ------
        StatementError
            If the path is outside the script's folder, a file includes itself, or there are more or deeper includes
            than the limits allow.
        """
        if not path.strip():
            raise StatementError(source, "an include needs a file name")
        try:
            real = (beside / path).resolve()
        except (OSError, ValueError, RuntimeError):
            raise StatementError(source, f"'{shortened(path)}' is not a valid file name") from None
        if not real.is_relative_to(self.folder):
            raise StatementError(source, f"'{shortened(path)}' is outside the folder of the script")
        if real in self.open:
            names = [path.name for path in self.open[self.open.index(real) :]]
            cycle = " includes ".join([*names, real.name]) if len(names) > 1 else None
            raise StatementError(source, f"'{shortened(path)}' includes itself", cycle)
        if real in self.seen:
            return None
        if len(self.open) > MAX_INCLUDE_DEPTH:
            raise StatementError(source, f"includes are nested deeper than {MAX_INCLUDE_DEPTH}")
        if len(self.seen) >= MAX_INCLUDED_FILES:
            raise StatementError(source, f"more than {MAX_INCLUDED_FILES:,} files are included")
        self.seen.add(real)
        return real
