"""Folders that cannot be written, also for root: by what the system says about them."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import pytest


def make_read_only(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make every write under a folder fail, as on a file system mounted read-only: also removing what is missing."""
    real = os.open

    def refusing(path: Any, flags: int, *rest: Any, **more: Any) -> int:
        writing = flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        if writing and str(folder) in os.fspath(path):
            raise OSError(errno.EROFS, os.strerror(errno.EROFS))
        return real(path, flags, *rest, **more)

    def refuse(name: str) -> None:
        before = getattr(os, name)

        def refusing_or(path: Any, *rest: Any, **more: Any) -> Any:
            if str(folder) in os.fspath(path):
                raise OSError(errno.EROFS, os.strerror(errno.EROFS), os.fspath(path))
            return before(path, *rest, **more)

        monkeypatch.setattr(os, name, refusing_or)

    monkeypatch.setattr(os, "open", refusing)
    for name in ("unlink", "rename", "replace"):
        refuse(name)
