"""Modules in processes of their own, which reach the blackboard of their owner by zenoh over the loopback interface.

The owner answers calls and sends each module a notice of each change; there is no daemon and no discovery. A notice
holds the log entry if the module reads it, so that the module needs no call; where notices are missing, it reads the
log. All keys begin with a random token, which only the processes of one runtime know. Nothing is stored in zenoh: the
log stays authoritative.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from functools import cached_property
from typing import Any

from deixis import extras
from deixis.errors import DeixisError
from deixis.memory import errors as memory_errors
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Change, Logged
from deixis.memory.episodes.fluents.codec import (
    change_of_list,
    change_to_list,
    decode_fluent,
    decode_logged,
    encode_fluent,
    logged_bytes,
)
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.episodes.subscription import Subscription
from deixis.memory.errors import MemoryWriteError
from deixis.memory.folder import EPISODES
from deixis.memory.journal import Part
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern
from deixis.robot.modules import AccessError, Board, Clock, Module, ModuleBoard, ModuleSpec, Runner, run_until_stopped

CALL_TIMEOUT = 10.0
"""Time in seconds for one call to the owner of the blackboard."""

MAX_STARTS = 6
"""Number of starts of a process, each soon after the one before, after which its module is given up."""

STABLE_SECONDS = 60.0
"""Time in seconds after which a process that ends is started again as if for the first time."""

PAGE = 256
"""Maximum number of log entries in one answer."""


class Hub:
    """The owner's side: answers the calls of module processes, and publishes changes to them."""

    def __init__(self, board: Blackboard, clock: Clock, report: Callable[[str], None]) -> None:
        self._board, self._clock, self._report = board, clock, report
        self._token = secrets.token_hex(16)
        self._boards: dict[str, ModuleBoard] = {}
        self._parts: dict[str, Part] = {}  # of the write over several stores that a module is at
        self._runners: dict[str, ProcessRunner] = {}
        self._endpoint = f"tcp/127.0.0.1:{_free_port()}"
        self._session = _open(listen=[self._endpoint])
        self._calls = self._session.declare_queryable(f"deixis/{self._token}/call/*", self._answer)
        self._positions = self._session.declare_subscriber(f"deixis/{self._token}/position/*", self._moved)
        self._subscriptions: list[Subscription] = []

    def start(self, spec: ModuleSpec, module: Module) -> ProcessRunner:
        """Start a module in a process.

        Parameters
        ----------
        spec
            The module by the name of its class.
        module
            The same module, made here, which says what it declares.

        Returns
        -------
        ProcessRunner
            The running process.
        """
        own = self._boards[module.name] = ModuleBoard(self._board, module, self._clock)
        notices = self._session.declare_publisher(f"deixis/{self._token}/log/{module.name}")

        def publish(change: Logged) -> None:
            data = logged_bytes(change) if own.concerns(change) else b""  # empty: the module does not read it
            notices.put(b"%d " % change.sequence + data)

        self._subscriptions.append(self._board.attend(module.name, lambda change: True, publish))
        where = {"endpoint": self._endpoint, "token": self._token, "factory": spec.factory, "settings": spec.settings}
        runner = self._runners[module.name] = ProcessRunner(module.name, where, self._board.sequence, self._report)
        return runner

    def close(self) -> None:
        """End the publication of changes and close the connection."""
        for subscription in self._subscriptions:
            self._board.unsubscribe(subscription.name)
        self._session.close()

    def _moved(self, sample: Any) -> None:
        runner = self._runners.get(str(sample.key_expr).rpartition("/")[2])
        if runner is not None:
            runner.move(int(bytes(sample.payload)))

    def _answer(self, query: Any) -> None:
        name = str(query.key_expr).rpartition("/")[2]
        try:
            answer = {"answer": self._called(name, json.loads(bytes(query.payload)))}
        except Exception as error:  # whatever a call raises goes to the caller
            answer = {"error": type(error).__name__, "message": str(error)}
        query.reply(query.key_expr, json.dumps(answer).encode())

    def _called(self, name: str, call: dict[str, Any]) -> Any:
        board = self._boards[name]
        match call["method"]:
            case "begin":
                if name in self._parts:  # its process was killed in a write over several stores
                    self._parts.pop(name).settle()
                return self._board.sequence
            case "prepare":
                part = board.part(*map(change_of_list, call["changes"]))
                part.prepare(call["id"])
                self._parts[name] = part
            case "complete":
                self._parts.pop(name).complete()
            case "settle":
                self._parts.pop(name).settle()
            case "write":
                return board.write(*map(change_of_list, call["changes"]))
            case "holding":
                found = board.holding(Pattern(*call["pattern"]), call["start"], call["end"])
                return [encode_fluent(each).decode() for each in found]
            case "now":
                return [encode_fluent(each).decode() for each in board.now(Pattern(*call["pattern"]))]
            case "new_id":
                return board.new_id(call["prefix"])
            case "origin":
                return self._board.origin.isoformat()
            case "log":
                return self._log(board, call["since"])
            case other:
                raise ValueError(f"there is no method '{other}'")

    def _log(self, board: ModuleBoard, since: int) -> dict[str, Any]:
        """Return a page of the log: the entries that the module reads, and the position after them."""
        last = min(self._board.sequence, since + PAGE)
        entries = []
        for change in self._board.changes(since):
            if change.sequence > last:
                break
            if board.concerns(change):
                entries.append([change.sequence, logged_bytes(change).decode()])
        return {"entries": entries, "last": last}


class ProcessRunner(Runner):
    """A module in a process, which is started again if it dies, until :data:`MAX_STARTS` starts have failed."""

    def __init__(self, name: str, where: dict[str, Any], position: int, report: Callable[[str], None]) -> None:
        self._name, self._where, self._report = name, where, report
        self._position = position
        self._moving = threading.Condition()
        self._stopped = threading.Event()
        self._ready = threading.Event()
        self._failure: str | None = None
        self._process = self._begin()
        self._watch = threading.Thread(target=self._watching, name=f"process {name}", daemon=True)
        self._watch.start()
        try:
            self._ready.wait(CALL_TIMEOUT)
        except BaseException:  # Ctrl-C: the process is not known to the runtime yet
            self._stopped.set()
            self._process.kill()
            raise

    @property
    def pid(self) -> int:
        """Number of the process."""
        return self._process.pid

    def position(self) -> int:
        """Return the position in the log."""
        return self._position

    def move(self, position: int) -> None:
        """Note how far the module has come.

        Parameters
        ----------
        position
            Sequence number up to which it has handled the log.
        """
        with self._moving:
            self._position = max(self._position, position)
            self._moving.notify_all()

    def wait(self, sequence: int, timeout: float) -> bool:
        """Wait until the module has handled the log up to a sequence number."""
        with self._moving:
            return self._moving.wait_for(lambda: self._position >= sequence, timeout)

    def failure(self) -> str | None:
        """Return why the module has been given up; None if it runs."""
        return self._failure

    def stop(self) -> None:
        """End the process, and kill it if it does not end within two seconds."""
        self._stopped.set()
        process = self._process
        if process.stdin is not None:
            process.stdin.close()  # the process ends at the end of its input
        try:
            process.wait(2.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        self._watch.join(2.0)

    def _begin(self) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-c", "from deixis.robot.processes import main; main()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            start_new_session=True,  # Ctrl-C reaches the owner alone, which ends this process
        )
        assert process.stdin is not None
        process.stdin.write(json.dumps({**self._where, "since": self._position}) + "\n")
        process.stdin.flush()
        return process

    def _watching(self) -> None:
        starts = 1
        while True:
            began = time.monotonic()
            assert self._process.stdout is not None
            for line in self._process.stdout:
                if line.rstrip("\n") == "ready":
                    self._ready.set()
                else:
                    self._report(line.rstrip("\n"))
            code = self._process.wait()
            self._process.stdout.close()
            if self._process.stdin is not None:
                with contextlib.suppress(OSError):
                    self._process.stdin.close()
            if self._stopped.is_set():
                return
            if time.monotonic() - began > STABLE_SECONDS:
                starts = 0
            ended = f"the process of the module '{self._name}' ended with {code}"
            if starts == MAX_STARTS:
                self._failure = f"{ended} after each of {MAX_STARTS} starts and is not started again"
                self._ready.set()
                self._report(self._failure)
                return
            self._report(f"{ended} and is started again")
            if self._stopped.wait(0.1 * 2**starts):
                return
            starts += 1
            self._process = self._begin()


class RemoteBoard(Board):
    """The module's side: calls the owner of the blackboard."""

    def __init__(self, session: Any, token: str, name: str) -> None:
        self._session, self._key = session, f"deixis/{token}/call/{name}"
        self._clock: Clock | None = None

    def write(self, *changes: Change) -> int:
        """Write changes as one: all of them or, if one is refused, nothing."""
        return int(self._call(method="write", changes=[change_to_list(change) for change in changes]))

    def part(self, *changes: Change) -> Part:
        """Return changes as a part of a write over several stores."""
        return _RemotePart(self, changes)

    def holding(
        self, pattern: Pattern = ANYTHING, start: float | None = None, end: float | None = None
    ) -> tuple[EpisodicFluent, ...]:
        """Return what may have held in a window of time, as far as the module declares to read it."""
        found = self._call(method="holding", pattern=_parts(pattern), start=start, end=end)
        return tuple(decode_fluent(each.encode()) for each in found)

    def now(self, pattern: Pattern = ANYTHING) -> tuple[EpisodicFluent, ...]:
        """Return the fluents that have not finished, as far as the module declares to read them."""
        found = self._call(method="now", pattern=_parts(pattern))
        return tuple(decode_fluent(each.encode()) for each in found)

    def new_id(self, prefix: str) -> str:
        """Return an id that this memory has never given before."""
        return str(self._call(method="new_id", prefix=prefix))

    @cached_property
    def origin(self) -> datetime:
        """Time from which the memory counts seconds."""
        return datetime.fromisoformat(self._call(method="origin"))

    def seconds(self) -> float:
        """Return the present time, which never goes back."""
        if self._clock is None:
            self._clock = Clock(self.origin, _say)
        return self._clock.seconds()

    def log(self, since: int) -> tuple[list[Logged], int]:
        """Return a page of the log.

        Parameters
        ----------
        since
            Sequence number after which it begins.

        Returns
        -------
        tuple
            The entries that the module reads, and the sequence number up to which the page goes.
        """
        page = self._call(method="log", since=since)
        return [decode_logged(number, data.encode()) for number, data in page["entries"]], int(page["last"])

    def _call(self, **call: Any) -> Any:
        for reply in self._session.get(self._key, payload=json.dumps(call).encode(), timeout=CALL_TIMEOUT):
            if reply.ok is not None:
                answer = json.loads(bytes(reply.ok.payload))
                if "error" in answer:
                    raise _error(answer["error"], answer["message"])
                return answer["answer"]
        raise MemoryWriteError("the owner of the blackboard did not answer; is it running?")


class _RemotePart(Part):
    """The part of the owner's blackboard in a write over several stores of a module."""

    store = EPISODES

    def __init__(self, board: RemoteBoard, changes: Sequence[Change]) -> None:
        self._board, self._changes = board, changes

    def prepare(self, id: str) -> None:
        self._board._call(method="prepare", id=id, changes=[change_to_list(change) for change in self._changes])

    def complete(self) -> None:
        self._board._call(method="complete")

    def settle(self) -> None:
        self._board._call(method="settle")


class _Feed:
    """The log as a module process sees it: from notices where they follow on, otherwise by calls."""

    def __init__(self, board: RemoteBoard, since: int) -> None:
        self._board = board
        self._noticed: dict[int, bytes] = {}
        self._lock = threading.Lock()
        self.last = since
        self.wake: Callable[[], None] = lambda: None

    def notice(self, sample: Any) -> None:
        """Keep a notice."""
        number, _, data = bytes(sample.payload).partition(b" ")
        with self._lock:
            if len(self._noticed) < 10 * PAGE:  # a slow module reads the rest from the log
                self._noticed[int(number)] = data
            self.last = max(self.last, int(number))
        self.wake()

    def read(self, since: int) -> Iterator[Logged]:
        """Yield the changes after a position that concern the module."""
        with self._lock:
            self._noticed = {number: kept for number, kept in self._noticed.items() if number > since}
        while since < self.last:
            with self._lock:
                data = self._noticed.get(since + 1)
            if data is None:
                entries, since = self._board.log(since)
                yield from entries
            else:
                since += 1
                if data:
                    yield decode_logged(since, data)


def main() -> None:
    """Run one module in this process until its standard input ends; the first line of the input says which."""
    try:
        _run()
    except (MemoryWriteError, BrokenPipeError) as error:  # the owner has ended, or does not answer
        with contextlib.suppress(OSError):
            _say(str(error))
        os._exit(1)


def _run() -> None:
    where = json.loads(sys.stdin.readline())
    module = ModuleSpec(where["factory"], where["settings"]).module()
    session, token = _open(connect=[where["endpoint"]]), where["token"]
    board = RemoteBoard(session, token, module.name)
    _wait_for_owner(board)
    positions = session.declare_publisher(f"deixis/{token}/position/{module.name}")
    feed = _Feed(board, where["since"])
    subscription = Subscription(
        module.name,
        lambda change: True,  # the owner leaves out what does not concern the module
        lambda change: module.changed(change, board),
        where["since"],
        feed.read,
        lambda: feed.last,
        _say,
        lambda position: positions.put(b"%d" % position),
    )
    feed.wake = subscription.notify
    notices = session.declare_subscriber(f"deixis/{token}/log/{module.name}", feed.notice)
    feed.last = max(feed.last, board._call(method="begin"))
    subscription.begin()
    subscription.notify()
    stopped = threading.Event()
    threading.Thread(target=run_until_stopped, args=(module, board, stopped, _say), daemon=True).start()
    _say("ready")
    sys.stdin.read()
    stopped.set()
    subscription.cancel()
    notices.undeclare()
    session.close()
    os._exit(0)  # a module that hangs must not keep the process


def _wait_for_owner(board: RemoteBoard) -> None:
    """Call the owner until it answers: the connection takes a moment."""
    end = time.monotonic() + CALL_TIMEOUT
    while True:
        try:
            board.seconds()
            return
        except MemoryWriteError:
            if time.monotonic() > end:
                raise
            time.sleep(0.02)


def _say(line: str) -> None:
    print(line, flush=True)


def _open(listen: list[str] | None = None, connect: list[str] | None = None) -> Any:
    extras.require("zenoh", "running modules as processes")
    import zenoh

    settings = {
        "mode": "peer",
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "listen": {"endpoints": listen or []},
        "connect": {"endpoints": connect or []},
    }
    return zenoh.open(zenoh.Config.from_json5(json.dumps(settings)))


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _parts(pattern: Pattern) -> list[str | None]:
    return [pattern.subject, pattern.predicate, pattern.object]


def _error(name: str, message: str) -> DeixisError:
    """Return an error of the owner as one of the same class, or as a DeixisError for a class that is not known."""
    kind = AccessError if name == AccessError.__name__ else getattr(memory_errors, name, DeixisError)
    known = isinstance(kind, type) and issubclass(kind, DeixisError)
    return kind(message) if known else DeixisError(f"{name}: {message}")
