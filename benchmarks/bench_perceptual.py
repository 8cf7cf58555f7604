"""Time putting and getting views of 60 KB, beside bare plyvel with values of the same size in the same run.

There are two kinds of descriptors, 100 of 153 numbers: dense random ones, which no compression shrinks, and sparse
ones, two thirds zeros, like spin images. Bare plyvel is measured with the options with which Deixis opens its database,
and with its own. Both sides write without sync, one batch per view or per ten views, and return only verified data:
bare plyvel verifies LevelDB's CRC-32C; Deixis verifies the CRC-32C of a view's metadata, and the 64-bit XXH3 of the
arrays. Bare plyvel is also read without verification. A view (arrays, time, metadata) is compared with a byte string,
by the clock, which other programs of the machine affect, and by the CPU time of the thread, which they affect little.

A view copies its arrays when it is made, so that they cannot change. The time to make one is printed too, and counts
for neither side: byte strings must be made too.
"""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
import plyvel
from records import command_line, figure, peer_version, recorded

from deixis.memory.perceptual.database.handle import OPTIONS
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, View

ROUNDS = 9
Times = dict[str, list[float]]


def make_views(number: int, sparse: bool) -> list[View]:
    """Return views with the metadata that a robot would give."""
    rng, start = np.random.default_rng(0), datetime(2026, 5, 1, tzinfo=UTC)
    views = []
    for place in range(number):
        spin = rng.random((100, 153), np.float32)
        if sparse:
            spin *= rng.random(spin.shape) < 1 / 3
        metadata = {"scene": f"scene{place // 10}", "object": f"o{place % 10}", "teacher": "Ada", "source": "scene.pcd"}
        category, when = f"category{place % 7}", start + timedelta(seconds=place)
        views.append(View(f"view{place:06}", category, when, {"spin": spin}, metadata=metadata))
    return views


def timed(times: Times, name: str, job: Callable[[], object]) -> None:
    """Add the seconds of a job to the times."""
    started, started_cpu = time.perf_counter(), time.thread_time()
    job()
    times.setdefault(f"{name}, CPU", []).append(time.thread_time() - started_cpu)
    times.setdefault(name, []).append(time.perf_counter() - started)


def settle(db: Any) -> None:
    """Flush the log into a table, so that both sides read from tables."""
    db.compact_range(start=b"\xfe", stop=b"\xff")


def bare_round(times: Times, name: str, options: dict[str, Any], values: Sequence[bytes], batch: int) -> None:
    """Put and get byte strings."""
    folder = tempfile.mkdtemp()
    with plyvel.DB(folder + "/db", create_if_missing=True, **options) as db:
        keys = [b"view%06d" % place for place in range(len(values))]

        def put() -> None:
            for first in range(0, len(values), batch):
                with db.write_batch() as written:
                    for key, value in zip(keys[first : first + batch], values[first : first + batch], strict=True):
                        written.put(key, value)

        timed(times, f"{name} put", put)
        settle(db)
        timed(times, f"{name} get", lambda: [len(db.get(key, verify_checksums=True)) for key in keys])
        timed(times, f"{name} scan", lambda: [len(value) for _, value in db.iterator(verify_checksums=True)])
        timed(times, f"{name} get, unverified", lambda: [len(db.get(key)) for key in keys])
    shutil.rmtree(folder)


def our_round(times: Times, views: Sequence[View], batch: int) -> None:
    """Write and read views."""
    folder = tempfile.mkdtemp()
    with LevelMemory.open(folder + "/m", create=True) as memory:
        batches = [Batch(views[first : first + batch]) for first in range(0, len(views), batch)]
        timed(times, "deixis make", lambda: [replace(view) for view in views])
        timed(times, "deixis put", lambda: [memory.write(part) for part in batches])  # type: ignore[func-returns-value]
        with memory.handle as db:
            settle(db)
        timed(times, "deixis get", lambda: [len(memory.view(view.id).descriptors) for view in views])
        timed(times, "deixis scan", lambda: [len(view.descriptors) for view in memory.views()])
    shutil.rmtree(folder)


def ratios(times: Times, ours: str, theirs: str) -> str:
    """Return our throughput relative to theirs: the median over the rounds, each of which measured both."""
    each = [their / our for our, their in zip(times[ours][1:], times[theirs][1:], strict=True)]
    return f"{statistics.median(each):4.0%} ({min(each):.0%} to {max(each):.0%})"


def rows(times: Times, number: int, title: str) -> Iterator[str]:
    """Yield the lines of the table."""
    yield f"  make  deixis {statistics.median(times['deixis make, CPU'][1:]) / number * 1e6:7.1f} us per view"
    for what in ("put", "get", "scan"):
        yield f"  {what:<5} deixis {statistics.median(times[f'deixis {what}'][1:]) / number * 1e6:7.1f} us per view"
        for other in (f"same options {what}", f"own options {what}", f"same options {what}, unverified"):
            if other in times:
                relative = statistics.median(
                    their / our
                    for our, their in zip(times[f"deixis {what}, CPU"][1:], times[f"{other}, CPU"][1:], strict=True)
                )
                figure(f"{title}: {what}, {other}", relative, "times as long", peer=peer_version("plyvel"))
                median = statistics.median(times[other][1:]) / number * 1e6
                clock, cpu = (ratios(times, f"deixis {what}{kind}", f"{other}{kind}") for kind in ("", ", CPU"))
                yield f"        {other:<30} {median:7.1f} us, deixis has {clock}; of CPU time {cpu}"


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("views", type=int, nargs="?", default=400, help="number of views")
    with recorded(parser) as options:
        number = options.views
        for sparse in (False, True):
            views = make_views(number, sparse)
            values = [view.descriptors["spin"].tobytes() for view in views]
            for batch in (1, 10):
                times: Times = {}
                for _ in range(ROUNDS):  # the first round only warms up
                    our_round(times, views, batch)
                    bare_round(times, "same options", OPTIONS, values, batch)
                    bare_round(times, "own options", {}, values, batch)
                title = f"{number} {'sparse' if sparse else 'dense'} views, {batch} per batch"
                print(title)
                print("\n".join(rows(times, number, title)), flush=True)


if __name__ == "__main__":
    main()
