"""Queries over a snapshot of a store, in a process of their own.

A store cannot be opened a second time beside its writer. So queries are answered from a snapshot: a backup in the same
folder that shares its files with the store by hard links, which takes little disk space and some milliseconds. It is
made again for the first query after a change. If the folder cannot be written, the snapshot is a copy in a temporary
folder.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pyoxigraph as ox

from deixis.deadline import Deadline
from deixis.memory.folder import SNAPSHOT
from deixis.memory.owner import Closing
from deixis.memory.semantic.queries.limits import QueryLimits
from deixis.memory.semantic.queries.process import QueryProcess, time_error


class SnapshotQueries(Closing):
    """Queries about the store of one folder. Threads may share it; their queries are answered in turn."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._turn = threading.Lock()
        self._changes = 0
        self._place: Path | None = None
        self._kept = -1  # number of changes before the snapshot was made
        self._process: QueryProcess | None = None

    def ask(self, store: ox.Store, request: Mapping[str, Any], limits: QueryLimits) -> tuple[bytes, bytes]:
        """Answer a query from a snapshot, as :meth:`QueryProcess.ask` does.

        Parameters
        ----------
        store
            The store, a snapshot of which is made if it has changed.
        request
            The query with its graphs and bindings.
        limits
            Limits of time and memory; the time includes waiting for other threads.

        Returns
        -------
        tuple
            Kind of the answer, and its bytes.

        Raises
        ------
        QueryTimeoutError
            If the time limit is reached, also while other threads are served.
        """
        deadline = Deadline.after(limits.time)
        if not self._turn.acquire(timeout=min(limits.time, threading.TIMEOUT_MAX)):
            raise time_error(limits)
        try:
            return self._ready(store, deadline, limits).ask(request, limits, deadline)
        finally:
            self._turn.release()

    def changed(self) -> None:
        """Record that the store has changed: the next query is answered from a new snapshot."""
        self._changes += 1

    def close(self) -> None:
        """End the process and remove the snapshot."""
        if self._process is not None:
            self._process.end()
            self._process = None
        if self._place is not None:
            shutil.rmtree(self._place, ignore_errors=True)
            self._place, self._kept = None, -1

    def _ready(self, store: ox.Store, deadline: Deadline, limits: QueryLimits) -> QueryProcess:
        """Return a process that has the present content of the store open."""
        process = self._process if self._process is not None and self._process.alive else None
        changes = self._changes
        if self._place is None or self._kept != changes:
            self._place = self._place or _place(self._folder)
            shutil.rmtree(self._place, ignore_errors=True)
            store.backup(self._place)
            self._kept = changes
            if process is not None:
                process.open(self._place, deadline, limits)
        if process is None:
            process = self._process = QueryProcess(self._place, deadline, limits)
        return process


def _place(folder: Path) -> Path:
    """Return the path of the snapshot of a store."""
    if os.access(folder, os.W_OK):
        return folder / SNAPSHOT
    return Path(tempfile.mkdtemp(prefix="deixis-query-"))
