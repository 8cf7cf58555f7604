"""Read text files of users within limits, never a folder or a device; replace text files in one step."""

from __future__ import annotations

import contextlib
import fcntl
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import TextIO

from deixis.errors import DeixisError
from deixis.spelling import nearest

MAX_CHARACTERS = 100_000_000
"""Maximum number of characters of a text that is read as a whole."""

MAX_LINE_CHARACTERS = 1_000_000
"""Maximum number of characters of a line."""


MAX_NAMES = 10_000
"""Maximum number of files of a folder among which a similar name is sought."""


def no_such_file(file: str | Path, shown: str | None = None) -> str:
    """Return the message about a missing file, with the most similar name in its folder, if one is similar.

    Parameters
    ----------
    file
        The missing file.
    shown
        Name of the file at the beginning of the message; by default, ``file``.

    Returns
    -------
    str
        The message.

    Examples
    --------
    >>> no_such_file("nowhere/dinner.layout")
    'nowhere/dinner.layout: there is no such file'
    """
    path, near = Path(file), None
    with contextlib.suppress(OSError, ValueError):
        stem, _, ending = path.name.partition(".")
        names = [entry.name.partition(".") for entry in islice(path.parent.iterdir(), MAX_NAMES)]
        alike = nearest(stem, {name[0] for name in names})
        found = nearest(ending, {name[2] for name in names if name[0] == alike})
        near = None if found is None else f"{alike}.{found}"
    hint = f"; did you mean '{path.parent / near}'?" if near else ""
    return f"{file if shown is None else shown}: there is no such file{hint}"


def read_text(file: str | Path, error: type[DeixisError] = DeixisError, most: int = MAX_CHARACTERS) -> str:
    """Return the text of a UTF-8 file, without a byte order mark.

    Parameters
    ----------
    file
        The file, or a pipe.
    error
        Class of the errors.
    most
        Maximum number of characters.

    Returns
    -------
    str
        The text.

    Raises
    ------
    DeixisError
        Of the class ``error``, if the file cannot be read, is a folder or a device, is too large, or is not UTF-8.
    """
    with _opened(file, error) as text:
        found = text.read(most + 1)
    if len(found) > most:
        raise error(f"{file}: the file must have at most {most:,} characters, got more; split it")
    return found


def read_lines(
    file: str | Path,
    error: type[DeixisError] = DeixisError,
    most: int = MAX_LINE_CHARACTERS,
    undecoded: str = "strict",
) -> Iterator[str]:
    """Yield the lines of a UTF-8 file one by one, with their ends and without a byte order mark.

    Parameters
    ----------
    file
        The file, or a pipe.
    error
        Class of the errors.
    most
        Maximum number of characters of a line.
    undecoded
        What becomes of bytes that are not UTF-8: ``strict``, an error, or ``surrogateescape``, single surrogates, with
        which a caller finds the line.

    Yields
    ------
    str
        The lines.

    Raises
    ------
    DeixisError
        Of the class ``error``, if the file cannot be read, is a folder or a device, has a longer line, or is not UTF-8.
    """
    with _opened(file, error, undecoded) as text:
        number = 0
        while line := text.readline(most + 1):
            number += 1
            if len(line) > most:
                raise error(f"{file}:{number}: a line must have at most {most:,} characters, got more; split it")
            yield line


def require_path_or_text(function: str, path: object, text: object) -> None:
    """Raise TypeError unless exactly one of a path and a text is given.

    Parameters
    ----------
    function
        Name of the function that takes them.
    path, text
        The arguments; None for what is not given.
    """
    if (path is None) == (text is None):
        raise TypeError(f"`{function}` must be given a path or `text`, got {'neither' if path is None else 'both'}")


def is_folder(path: str | Path) -> bool:
    """Return whether a path names a folder.

    Parameters
    ----------
    path
        The path.

    Returns
    -------
    bool
        True if there is such a folder; False also for a path that is too long for a file system.
    """
    with contextlib.suppress(OSError):
        return Path(path).is_dir()
    return False


def is_present(path: str | Path) -> bool:
    """Return whether a path names a file, a folder or a device.

    Parameters
    ----------
    path
        The path.

    Returns
    -------
    bool
        True if it does; False also for a path that is too long for a file system.
    """
    with contextlib.suppress(OSError):
        return Path(path).exists()
    return False


@contextmanager
def changing(file: str | Path) -> Iterator[None]:
    """Keep other processes that call this function from changing the files of a folder inside the block.

    Parameters
    ----------
    file
        The file that is read, changed and written. The lock is that of its folder, because :func:`replace_text` makes
        a new file. Where the folder does not exist or cannot be locked, there is no lock.

    Yields
    ------
    None
        Nothing; the lock ends with the block.
    """
    try:
        folder = os.open(Path(file).resolve().parent, os.O_RDONLY)
    except OSError:
        yield
        return
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


def replace_text(file: str | Path, text: str) -> None:
    """Write a text as a UTF-8 file in one step, so that a full disk or the end of the program leaves the earlier file.

    Parameters
    ----------
    file
        The file, whose folder exists. A link is followed, and the permissions of an earlier file stay. A pipe or a
        device is written to directly.
    text
        The text; its line ends are written as they are.

    Raises
    ------
    OSError
        If the file cannot be written; the error names it.
    """
    try:
        _replace_text(Path(file), text)
    except OSError as error:  # which may name the draft, or nothing
        reason = error.strerror if Path(file).parent.is_dir() else "there is no such folder; make it first"
        raise OSError(error.errno, reason, os.fspath(file)) from error


def _replace_text(file: Path, text: str) -> None:
    if file.exists() and not file.is_file():
        file.write_text(text, encoding="utf-8", newline="")
        return
    target = file.resolve()
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        draft.write_text(text, encoding="utf-8", newline="")
        if target.exists():
            draft.chmod(target.stat().st_mode & 0o7777)
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)


@contextmanager
def _opened(file: str | Path, error: type[DeixisError], undecoded: str = "strict") -> Iterator[TextIO]:
    """Open a text file; what goes wrong while it is read is an error of the given class, too."""
    try:
        # Path.open takes no opener
        with open(file, encoding="utf-8-sig", errors=undecoded, opener=_without_waiting) as text:
            mode = os.fstat(text.fileno()).st_mode
            if not stat.S_ISREG(mode) and not stat.S_ISFIFO(mode):
                raise error(f"{file}: this is not a regular file; name a text file")
            os.set_blocking(text.fileno(), True)
            yield text
    except IsADirectoryError:
        raise error(f"{file}: this is a folder; name a file") from None
    except UnicodeDecodeError as wrong:
        raise error(f"{file}: the file is not UTF-8 (byte {wrong.start}); save it as UTF-8") from wrong
    except FileNotFoundError:
        raise error(no_such_file(file)) from None
    except OSError as wrong:
        raise error(f"{file}: cannot be read: {wrong.strerror}") from wrong
    except ValueError as wrong:
        if isinstance(wrong, DeixisError):
            raise
        raise error(f"{file}: cannot be read: {wrong}") from wrong


def _without_waiting(path: str, flags: int) -> int:
    """Open a file without blocking; a pipe that no program writes to is empty."""
    return os.open(path, flags | os.O_NONBLOCK)
