"""Time the blackboard beside bare pyoxigraph and bare zenoh in the same run, and kill its owner.

Parts (``--only``): *append*: fluents written in batches and singly, each durable when the call returns (it survives
SIGKILL), beside bare pyoxigraph loading the triples of the same fluents in bulk; also with the copy for SPARQL brought
up to date. *window*: what held in a window, over ``--large`` (1,000,000) fluents and over ``--small`` (10,000), with
the same answer; also memory and disk. *notify*: time from the beginning of a write to the call of a subscriber, in a
thread and in another process, beside a bare zenoh message between two processes. *kills*: ``--kills`` (100) owners
killed at random moments while they write and bring the copy up to date; nothing acknowledged may be missing, and log,
fluents, time index and copy must agree. Ratios are of wall time; processor time is printed beside them.
"""

from __future__ import annotations

import json
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import ClassVar

import pyoxigraph as ox
from records import command_line, count, figure, peer_version, ratio, recorded, seconds

from deixis.memory import folder as files
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Logged
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.projection import follow, is_current
from deixis.memory.episodes.rdf.observations import fluent_iri, fluent_triples
from deixis.memory.semantic.rdf.graphs import FLUENTS
from deixis.memory.semantic.store import SemanticMemory
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.modules import Board, Module, ModuleSpec
from deixis.robot.runtime import Runtime

# After deixis is imported: the folder of the tests has a package of this name too.
sys.path.append(str(Path(__file__).parent.parent / "tests"))

from killing import forks_of

SEEN = Source(Origin.SEEN, "tracker", "frame 7")


def fluents(number: int, prefix: str = "f", first: int = 0) -> list[EpisodicFluent]:
    """Return fluents of 50 things, one starting each 0.1 s and lasting up to 20 s; one in 1,000 does not finish."""
    found = []
    for n in range(first, first + number):
        spread = n * 2_654_435_761 % 997 / 997  # as good as random here, and the same for each size
        start = n / 10
        statement = (f"t{n % 50}", ("on", "near", "left")[n % 3], f"t{(n + 1) % 50}")
        finish = start + 0.1 + 20 * spread if n % 1000 else None
        certainty = round(0.5 + spread / 2, 3)
        found.append(episodic(f"{prefix}{n}", statement, start=start, finish=finish, certainty=certainty, source=SEEN))
    return found


def timed(job: Callable[[], object]) -> tuple[float, float]:
    """Return the wall and the processor time of a job."""
    wall, processor = time.perf_counter(), time.process_time()
    job()
    return time.perf_counter() - wall, time.process_time() - processor


def append(number: int, batch: int, singles: int) -> None:
    """Measure writing, in rounds beside the bulk load of the peer."""
    given, alone = fluents(number), fluents(singles, "s")
    quads = [ox.Quad(t.subject, t.predicate, t.object, FLUENTS) for each in given for t in fluent_triples(each)]
    per_fluent = len(quads) / number
    rounds: dict[str, list[tuple[float, float]]] = {"bare": [], "batches": [], "copy": [], "singly": [], "synced": []}
    for _ in range(3):
        with tempfile.TemporaryDirectory() as scratch:
            bare = ox.Store(Path(scratch) / "bare")

            def load(bare: ox.Store = bare) -> None:
                bare.bulk_extend(quads)
                bare.flush()

            rounds["bare"].append(timed(load))
            memory = Path(scratch) / "m"
            with Blackboard.open(memory, create=True) as board, SemanticMemory.open(memory, create=True) as semantic:

                def write(board: Blackboard = board) -> None:
                    for start in range(0, number, batch):
                        board.write(*map(Add, given[start : start + batch]), by="bench")

                def write_singly(board: Blackboard = board) -> None:
                    for each in alone:
                        board.add(each, by="bench")

                def copy(board: Blackboard = board, semantic: SemanticMemory = semantic) -> None:
                    semantic.update_copy(lambda store: is_current(board, store), lambda store: follow(board, store))

                rounds["batches"].append(timed(write))
                rounds["copy"].append(timed(copy))
                rounds["singly"].append(timed(write_singly))
            with Blackboard.open(Path(scratch) / "synced", create=True, sync=True) as board:
                few = alone[:200]
                rounds["synced"].append(timed(lambda board=board, few=few: [board.add(f, by="bench") for f in few]))  # type: ignore[misc]
    each_time = {
        "bare": [median(column) / number for column in zip(*rounds["bare"], strict=True)],
        "batches": [median(column) / number for column in zip(*rounds["batches"], strict=True)],
        "copy": [median(column) / number for column in zip(*rounds["copy"], strict=True)],
        "singly": [median(column) / singles for column in zip(*rounds["singly"], strict=True)],
        "synced": [median(column) / 200 for column in zip(*rounds["synced"], strict=True)],
    }
    print(f"{number:,} fluents of {per_fluent:.1f} triples; microseconds for one fluent, wall and processor:")
    for name, (wall, processor) in each_time.items():
        print(f"  {name:<8} {wall * 1e6:8.0f} {processor * 1e6:8.0f}   rate of bare pyoxigraph x "
              f"{each_time['bare'][0] / wall:.3f} wall, {each_time['bare'][1] / processor:.3f} processor")  # fmt: skip
    (bare_wall, bare_processor), (wall, processor) = each_time["bare"], each_time["batches"]
    ratio("rate of batches, as a share of bare pyoxigraph's", bare_wall, wall, "pyoxigraph")
    ratio("rate of batches, by processor time", bare_processor, processor, "pyoxigraph")
    ratio("rate of batches with the copy for SPARQL", bare_wall, wall + each_time["copy"][0], "pyoxigraph")
    ratio("rate of single writes", bare_wall, each_time["singly"][0], "pyoxigraph")
    ratio("rate of single writes, by processor time", bare_processor, each_time["singly"][1], "pyoxigraph")


def window(small: int, large: int, batch: int) -> None:
    """Measure windows with the same answer over two sizes."""
    taken: dict[int, list[tuple[float, float]]] = {}
    answers: dict[int, list[list[str]]] = {}
    rng = random.Random(5)
    windows = [(start, start + 1.0) for start in (rng.uniform(50, small / 10 - 50) for _ in range(40))]
    with tempfile.TemporaryDirectory() as scratch:
        boards = {}
        for number in (small, large):
            memory = Path(scratch) / str(number)
            board = boards[number] = Blackboard.open(memory, create=True)
            resident, began = _resident(), time.perf_counter()
            for first in range(0, number, batch):
                finished = (each for each in fluents(batch, first=first) if not each.is_open)
                board.write(*map(Add, finished), by="bench")
            taken_mb = _resident() - resident
            spent = time.perf_counter() - began
            print(f"{number:,} fluents: {spent:.0f} s to make and write, {taken_mb:+.0f} MB of memory")
            board.close()
            disk = sum(file.stat().st_size for file in (memory / files.EPISODES).rglob("*") if file.is_file())
            opened, _ = timed(lambda memory=memory, number=number: boards.update({number: Blackboard.open(memory)}))  # type: ignore[misc]
            print(f"  {disk / 1e6:.0f} MB on disk, {disk / number:.0f} bytes for one; opened in {opened * 1000:.0f} ms")
            figure(f"bytes on disk for one of {number:,} fluents", disk / number, "bytes")
            taken[number], answers[number] = [], []
        for start, end in windows:
            for number, board in boards.items():
                board.holding(start=start, end=end)
                found: list[list[str]] = []
                taken[number].append(
                    timed(lambda: found.append([each.id for each in board.holding(start=start, end=end)]))  # noqa: B023
                )
                answers[number] += found
        for board in boards.values():
            board.close()
    assert answers[small] == answers[large], "the answers must be the same"
    times = {number: median(wall for wall, _ in each) for number, each in taken.items()}
    processor = {number: median(used for _, used in each) for number, each in taken.items()}
    sizes = median(map(len, answers[small]))
    slower, by_processor = times[large] / times[small], processor[large] / processor[small]
    print(f"windows of {sizes:.0f} fluents: {times[small] * 1000:.2f} ms over {small:,} fluents,")
    print(f"  {times[large] * 1000:.2f} ms over {large:,}: {slower:.2f} times, by processor time {by_processor:.2f}")
    figure("time of a window over 100 times the fluents", slower, "times as long")
    seconds("window over the larger blackboard", times[large])
    print(f"largest memory of the process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


def _resident() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE") / 1e6


class Listener(Module):
    """Measures how long after the beginning of each write it is called, and writes the delays when asked."""

    name = "listener"
    reads: ClassVar = (Pattern(predicate="sent"), Pattern(predicate="asked"))
    writes: ClassVar = (Pattern(predicate="delays"),)

    def __init__(self) -> None:
        self._delays: list[float] = []

    def changed(self, change: Logged, board: Board) -> None:
        """Note the delay of a change."""
        delay = time.time() - change.written
        assert change.after is not None
        if change.after.statement.predicate == "sent":
            self._delays.append(delay)
        else:
            text = json.dumps(self._delays)
            board.write(Add(episodic("delays", (self.name, "delays", text), start=0.0, source=SEEN)))


def notified(messages: int, processes: bool, pause: float) -> list[float]:
    """Return the delays of a module, in seconds, while there are writes all the time."""
    listener = ModuleSpec("bench_blackboard:Listener")
    with (
        tempfile.TemporaryDirectory() as scratch,
        Blackboard.open(Path(scratch) / "m", create=True) as board,
        Runtime(board, [listener], processes, print) as runtime,
    ):
        time.sleep(0.5)
        for number in range(messages):
            board.add(episodic(f"m{number}", ("bench", "sent"), start=float(number), source=SEEN), by="bench")
            time.sleep(pause)
        board.add(episodic("asked", ("bench", "asked"), start=0.0, source=SEEN), by="bench")
        runtime.wait(board.sequence, 60)
        end = time.monotonic() + 30
        while board.fluent("delays") is None and time.monotonic() < end:
            time.sleep(0.01)
        answer = board.fluent("delays")
        assert answer is not None
        return [float(delay) for delay in json.loads(str(answer.statement.object))]


RECEIVER = """
import json, sys, time
from deixis.robot.processes import _open
session = _open(connect=[sys.argv[1]])
delays = []
def take(sample):
    delays.append(time.time() - float(bytes(sample.payload).split()[0]))
kept = session.declare_subscriber("bench/message", take)
print("ready", flush=True)
sys.stdin.readline()
print(json.dumps(delays), flush=True)
session.close()
"""


def bare_messages(messages: int, pause: float) -> list[float]:
    """Return the delays of bare zenoh messages of the same length between two processes, in seconds."""
    from deixis.robot.processes import _free_port, _open

    endpoint = f"tcp/127.0.0.1:{_free_port()}"
    session = _open(listen=[endpoint])
    command = [sys.executable, "-c", RECEIVER, endpoint]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None and process.stdout is not None
        process.stdout.readline()
        time.sleep(0.5)
        publisher = session.declare_publisher("bench/message")
        for _ in range(messages):
            publisher.put(b"%r %b" % (time.time(), b"x" * 200))
            time.sleep(pause)
        time.sleep(0.5)
        process.stdin.write("\n")
        process.stdin.flush()
        delays = json.loads(process.stdout.readline())
    session.close()
    return [float(delay) for delay in delays]


def notify(messages: int, pause: float = 0.002) -> None:
    """Measure notification in both settings beside bare messages, in turn."""
    delays: dict[str, list[float]] = {"zenoh": [], "threads": [], "processes": []}
    for _ in range(3):
        delays["zenoh"] += bare_messages(messages, pause)
        delays["threads"] += notified(messages, False, pause)
        delays["processes"] += notified(messages, True, pause)
    bare = median(delays["zenoh"])
    for name, found in delays.items():
        found.sort()
        print(f"{name:<10} {len(found)} of {3 * messages} arrived, median {median(found) * 1e6:.0f} us, 99th "
              f"{found[int(0.99 * len(found))] * 1e6:.0f} us, {median(found) / bare:.2f} times bare zenoh")  # fmt: skip
    for name in ("threads", "processes"):
        figure(
            f"delay of a notice, {name}", median(delays[name]) / bare, "times bare", peer=peer_version("eclipse-zenoh")
        )


WRITER = """
import os
from pathlib import Path
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Finish
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.episodes.projection import follow, is_current
from deixis.memory.semantic.store import SemanticMemory

def work(folder, seed):
    board = Blackboard.open(folder, create=True)
    semantic = SemanticMemory.open(Path(folder), create=True)
    source = Source(Origin.SEEN, "tracker")
    for turn in range(100000):
        ids = [f"{seed}.{turn}.{n}" for n in range(1 + turn % 3)]
        added = [Add(episodic(id, ("cup", "moves"), start=turn, source=source)) for id in ids]
        board.write(*added, Finish(ids[0], turn + 1.0), by="writer")
        os.write(1, b"acknowledged %d\\n" % board.sequence)
        if turn % 4 == 3:
            semantic.update_copy(lambda store: is_current(board, store), lambda store: follow(board, store))
"""


def kills(number: int) -> int:
    """Kill owners, and return how many times something was wrong afterwards."""
    rng, wrong, acknowledged = random.Random(1), 0, 0
    with tempfile.TemporaryDirectory() as scratch, forks_of(WRITER) as writers:
        memory = Path(scratch) / "m"
        for seed in range(number):
            output = writers.kill_after(memory, seed, rng.randrange(12), rng.uniform(0, 0.05))
            acknowledged = int(output[-1].split()[1]) if output else acknowledged
            problem = _problem(memory, acknowledged)
            if problem:
                wrong += 1
                print(f"kill {seed}: {problem}")
    print(f"{number} kills, {acknowledged} changes acknowledged, {wrong} kills with something lost or out of step")
    count("kills", number)
    count("kills with something lost or out of step", wrong)
    return wrong


def _problem(memory: Path, acknowledged: int) -> str | None:
    with Blackboard.open(memory, create=True) as board, SemanticMemory.open(memory, create=True) as semantic:
        if board.sequence < acknowledged or board.troubles:
            return f"{acknowledged} changes were acknowledged, {board.sequence} are there {board.troubles}"
        log = list(board.changes())
        if [change.sequence for change in log] != list(range(1, board.sequence + 1)):
            return "the log has gaps"
        if log and log[-1].last != board.sequence:
            return "half a write is in the log"
        replayed = {change.id: change.after for change in log}
        held = {each.id: each for each in board.holding()}
        if replayed != held:
            return "the fluents differ from the log"
        if {each.id for each in board.holding(start=-1e6, end=1e6)} != set(held):
            return "the time index differs from the fluents"
        semantic.update_copy(lambda store: is_current(board, store), lambda store: follow(board, store))
        identifier = ox.NamedNode("https://w3id.org/deixis/episodes#identifier")
        copied = {quad.subject for quad in semantic.store.quads_for_pattern(None, identifier, None, FLUENTS)}
        if copied != {fluent_iri(id) for id in held}:
            return "the copy for SPARQL differs from the fluents"
    return None


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--only", choices=("append", "window", "notify", "kills"), help="one part only")
    parser.add_argument("--appended", type=int, default=50_000, help="fluents to append")
    parser.add_argument("--singles", type=int, default=3_000, help="fluents to append singly")
    parser.add_argument("--batch", type=int, default=1_000, help="fluents in a batch")
    parser.add_argument("--small", type=int, default=10_000)
    parser.add_argument("--large", type=int, default=1_000_000)
    parser.add_argument("--messages", type=int, default=500, help="messages in each of three rounds")
    parser.add_argument("--kills", type=int, default=100)
    with recorded(parser) as options:
        if options.only in (None, "append"):
            append(options.appended, options.batch, options.singles)
        if options.only in (None, "notify"):
            notify(options.messages)
        if options.only in (None, "window"):
            window(options.small, options.large, options.batch)
        wrong = kills(options.kills) if options.only in (None, "kills") else 0
    if wrong:
        sys.exit(1)


if __name__ == "__main__":
    main()
