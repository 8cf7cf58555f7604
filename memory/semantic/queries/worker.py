"""Program of the process that runs queries: it reads requests, and writes one answer to each.

:class:`deixis.memory.semantic.queries.process.QueryProcess` runs it as a script. It imports no module of Deixis, so
that it starts in milliseconds. One thread evaluates queries, with a stack large enough for deeply nested ones; the main
thread waits for requests, and ends the process as soon as the starting process is gone. The kernel enforces both
limits: the memory limit by ``RLIMIT_DATA``, and the time limit by a timer in case the starting process is suspended.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import queue
import resource
import signal
import struct
import sys
import threading
from typing import Any, BinaryIO

STACK = 256 * 2**20
"""Bytes of stack of the evaluating thread. Only used pages take memory."""

MAX_GROWTH = 128 * 2**20
"""Bytes of memory beyond those of the open store that the process may keep between queries; with more it ends."""

BASE = "urn:deixis:query"
"""Base of relative IRIs in a query without BASE."""

HEAD = struct.Struct("<c?Q")
"""Head of an answer: its kind, whether the process ends after it, and the number of bytes that follow."""

READY, SOLUTIONS, TRIPLES, SYNTAX, VALUE, STORAGE, MEMORY, SIZE = b"R", b"S", b"T", b"Y", b"V", b"D", b"M", b"L"
"""Kinds of answers, in this order:

a store is open; SPARQL results as JSON; N-Triples; a malformed query; an impossible value in a query; a store that
cannot be read; the memory limit is reached; the answer is too large.
"""


class _AnswerTooLargeError(Exception):
    """The answer is larger than its limit."""


class _Answer(io.RawIOBase):
    """File that collects bytes up to a limit."""

    def __init__(self, limit: int) -> None:
        self.content = bytearray()
        self._limit = limit

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        if len(self.content) + len(data) > self._limit:
            raise _AnswerTooLargeError
        self.content += data
        return len(data)


def _taken() -> int:
    """Return the bytes of this process's data, as ``RLIMIT_DATA`` counts them; 0 on systems that do not report them."""
    try:
        with open("/proc/self/statm", "rb") as status:
            return int(status.read().split()[5]) * resource.getpagesize()
    except OSError:
        return 0


class _Evaluator:
    """The open store, and the requests that it answers."""

    def __init__(self) -> None:
        self._store: Any = None
        self._at_start = 0  # bytes of data when the first store was opened

    @property
    def grown(self) -> int:
        """Bytes of memory beyond those at the start."""
        return _taken() - self._at_start

    def open(self, path: str) -> tuple[bytes, bytes]:
        import pyoxigraph as ox

        self._store = None
        self._store = ox.Store.read_only(path)
        self._at_start = self._at_start or _taken()
        return READY, b""

    def query(self, request: dict[str, Any]) -> tuple[bytes, bytes]:
        import pyoxigraph as ox

        options: dict[str, Any] = {}
        for graphs in ("default_graph", "named_graphs"):
            if request[graphs] is not None:
                options[graphs] = [ox.NamedNode(name) for name in request[graphs]]
        if request["bindings"] is not None:
            given: Any = ox.parse_query_results(json.dumps(request["bindings"]), format=ox.QueryResultsFormat.JSON)
            (row,) = list(given)
            options["substitutions"] = dict(zip(given.variables, row, strict=True))
        found: Any = self._store.query(request["text"], base_iri=BASE, prefixes=request["prefixes"], **options)
        out = _Answer(request["largest"])
        triples = isinstance(found, ox.QueryTriples)
        found.serialize(out, ox.RdfFormat.N_TRIPLES if triples else ox.QueryResultsFormat.JSON)
        return TRIPLES if triples else SOLUTIONS, bytes(out.content)

    def answer(self, request: dict[str, Any]) -> tuple[bytes, bytes]:
        try:
            if "open" in request:
                return self.open(request["open"])
            limit = self._at_start + request["memory"]
            with contextlib.suppress(OSError, ValueError, OverflowError):  # too large, or refused outside Linux
                resource.setrlimit(resource.RLIMIT_DATA, (limit, resource.RLIM_INFINITY))
            return self.query(request)
        except MemoryError:
            return MEMORY, b""
        except _AnswerTooLargeError:
            return SIZE, b""
        except SyntaxError as error:
            return SYNTAX, str(error).encode("utf-8", "replace")
        except ValueError as error:
            return VALUE, str(error).encode("utf-8", "replace")
        except (OSError, RuntimeError) as error:
            if "Cannot allocate memory" in str(error):
                return MEMORY, b""
            return STORAGE, str(error).encode("utf-8", "replace")


def _evaluate(requests: queue.SimpleQueue[dict[str, Any]], out: BinaryIO) -> None:
    evaluator = _Evaluator()
    while True:
        request = requests.get()
        signal.setitimer(signal.ITIMER_REAL, request.get("seconds", 0.0))
        kind, content = evaluator.answer(request)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        ends = evaluator.grown > MAX_GROWTH
        out.write(HEAD.pack(kind, ends, len(content)))
        out.write(content)
        out.flush()
        if ends:
            os._exit(0)


def main() -> None:
    """Serve requests, a line of JSON each, until standard input ends."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    sys.path[:] = json.loads(sys.stdin.buffer.readline())
    requests: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
    threading.stack_size(STACK)
    threading.Thread(target=_evaluate, args=(requests, sys.stdout.buffer), daemon=True).start()
    for line in sys.stdin.buffer:
        requests.put(json.loads(line))
    os._exit(0)


if __name__ == "__main__":
    main()
