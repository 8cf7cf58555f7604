"""A process that runs queries and can be stopped at any moment, unlike a query in this process.

Oxigraph cannot stop a query. So another process (:mod:`.worker`) evaluates the queries. It is started once, in about
ten milliseconds, and killed where a query reaches a limit or the user presses Ctrl-C.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import select
import signal
import subprocess
import sys
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from deixis.deadline import Deadline
from deixis.memory.errors import MemoryWriteError, QueryError, QueryMemoryError, QueryTimeoutError
from deixis.memory.semantic.queries import worker
from deixis.memory.semantic.queries.limits import QueryLimits, in_words


class QueryProcess:
    """One process with a store open for reading. Only one thread at a time may use it."""

    def __init__(self, path: Path, deadline: Deadline, limits: QueryLimits) -> None:
        command = [sys.executable, "-I", "-S", worker.__file__]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                bufsize=0,
                start_new_session=True,  # Ctrl-C at a terminal goes to this process only, which ends that one
            )
        except OSError as error:
            raise QueryError(f"the process that runs queries cannot be started: {error.strerror}") from error
        self.end = weakref.finalize(self, _end, self._process, os.getpid())
        _processes.add(self)
        self._send(sys.path)
        self.open(path, deadline, limits)

    @property
    def alive(self) -> bool:
        """True if the process can be used."""
        return self.end.alive and self._process.poll() is None

    def open(self, path: Path, deadline: Deadline, limits: QueryLimits) -> None:
        """Open a store instead of the open one.

        Parameters
        ----------
        path
            The store.
        deadline
            Time limit.
        limits
            Limits of the query for which it is opened, which an error names.

        Raises
        ------
        MemoryWriteError
            If it cannot be read.
        QueryTimeoutError
            If the time limit is reached.
        """
        kind, content = self._answer({"open": str(path)}, deadline, limits)
        if kind != worker.READY:
            raise MemoryWriteError(f"{path}: cannot be opened for queries: {content.decode()}")

    def ask(self, request: Mapping[str, Any], limits: QueryLimits, deadline: Deadline) -> tuple[bytes, bytes]:
        """Answer a query in the process.

        After an error, and after Ctrl-C, the process is gone.

        Parameters
        ----------
        request
            The query with its graphs and bindings.
        limits
            Limits of time and memory.
        deadline
            Time limit, with the time for waiting.

        Returns
        -------
        tuple
            Kind of the answer, as defined in :mod:`.worker`, and its bytes.

        Raises
        ------
        QueryTimeoutError, QueryMemoryError
            If a limit is reached.
        QueryError
            If the query ended the process.
        """
        bounds = {"memory": limits.memory, "largest": limits.answer}
        kind, content = self._answer({**request, **bounds}, deadline, limits)
        if kind == worker.MEMORY:
            raise _memory_error(limits)
        if kind == worker.SIZE:
            raise limits.too_large()
        return kind, content

    def _answer(self, request: Mapping[str, Any], deadline: Deadline, limits: QueryLimits) -> tuple[bytes, bytes]:
        backstop = 0.0 if math.isinf(deadline.left) else deadline.left + 1.0
        try:
            self._send({**request, "seconds": backstop})
            kind, ends, length = worker.HEAD.unpack(self._receive(worker.HEAD.size, deadline, limits))
            content = self._receive(length, deadline, limits)
        except BaseException:
            self.end()
            raise
        if ends:
            self.end()
        return kind, content

    def _send(self, message: Any) -> None:
        assert self._process.stdin is not None
        line = memoryview(json.dumps(message).encode() + b"\n")
        with contextlib.suppress(BrokenPipeError):  # it has ended; reading its answer finds the reason
            while line:
                line = line[os.write(self._process.stdin.fileno(), line) :]

    def _receive(self, length: int, deadline: Deadline, limits: QueryLimits) -> bytes:
        assert self._process.stdout is not None
        out = self._process.stdout.fileno()
        ready = select.poll()
        ready.register(out, select.POLLIN)
        parts: list[bytes] = []
        while length:
            if not ready.poll(None if math.isinf(deadline.left) else math.ceil(1000 * deadline.left)):
                raise time_error(limits)
            part = os.read(out, min(length, 2**20))
            if not part:
                raise self._exit_error(limits)
            parts.append(part)
            length -= len(part)
        return b"".join(parts)

    def _exit_error(self, limits: QueryLimits) -> QueryError:
        """Return the error for a process that ended by itself, with the reason."""
        code = self._process.wait()
        if code == -signal.SIGALRM:
            return time_error(limits)
        if code in (-signal.SIGABRT, -signal.SIGKILL):  # a failed allocation, or the system is out of memory
            return _memory_error(limits)
        if code in (-signal.SIGSEGV, -signal.SIGBUS):
            return QueryError("query: it is nested too deeply, or too long, to be evaluated; make it simpler")
        return QueryError(f"query: the process that ran it ended (exit code {code}); try again")


def _end(process: subprocess.Popen[bytes], owner: int) -> None:
    """Kill a process, unless it belongs to the parent of this one."""
    if os.getpid() != owner:
        return
    process.kill()
    process.wait()
    _close(process)


def _close(process: subprocess.Popen[bytes]) -> None:
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()


_processes: weakref.WeakSet[QueryProcess] = weakref.WeakSet()


def _forget_after_fork() -> None:
    """Drop the processes of the parent in a forked child: they end when the parent does."""
    for one in list(_processes):
        one.end.detach()
        one._process.returncode = 0  # otherwise the child would wait for a process of its parent
        _close(one._process)


os.register_at_fork(after_in_child=_forget_after_fork)


def time_error(limits: QueryLimits) -> QueryTimeoutError:
    """Return the error for a query that reached its time limit.

    Parameters
    ----------
    limits
        The limits.

    Returns
    -------
    QueryTimeoutError
        The error, which is not raised.
    """
    return QueryTimeoutError(
        f"query: not answered within the time limit of {limits.time:g} s; narrow it down, or give it more time"
    )


def _memory_error(limits: QueryLimits) -> QueryMemoryError:
    return QueryMemoryError(
        f"query: it needs more than the memory limit of {in_words(limits.memory)}; narrow it down, or raise the limit"
    )
