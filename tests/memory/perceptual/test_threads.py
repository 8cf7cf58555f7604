"""Threads of one process share a memory: readers see complete batches while a writer works."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from deixis.memory.errors import MemoryFormatError
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View

BATCHES = 60


def test_readers_see_whole_batches_while_a_writer_goes_on(
    memory: PerceptualMemory, make_view: Callable[..., View]
) -> None:
    """Rewrite the same three views in each batch, and move them between categories, with one number in all of them."""
    done = threading.Event()

    def batch(number: int) -> Batch:
        array = np.full((1, 1), number, np.float32)
        views = [View(f"v{place}", f"c{number % 2}", make_view("x").time, {"n": array}) for place in range(3)]
        return Batch(views, [CategoryRecord("count", {"n": np.array(number)})])

    def write() -> None:
        for number in range(1, BATCHES):
            memory.write(batch(number))
            if number % 10 == 0:
                memory.rename("count", "other")
                memory.rename("other", "count")
        done.set()

    def read() -> int:
        looked = 0
        while not done.is_set():
            with memory.snapshot() as now:
                numbers = [float(view.descriptors["n"][0, 0]) for view in now.views()]
                name = "count" if "count" in now.categories() else "other"
                assert numbers == [float(now.category(name).state["n"])] * 3
            assert [float(view.descriptors["n"][0, 0]) for view in memory.views()] in [[n] * 3 for n in range(BATCHES)]
            one = memory.view("v1")
            assert one.category == f"c{int(one.descriptors['n'][0, 0]) % 2}"
            looked += 1
        return looked

    memory.write(batch(0))
    with ThreadPoolExecutor(4) as pool:
        readers = [pool.submit(read) for _ in range(3)]
        try:
            pool.submit(write).result()
        finally:
            done.set()
        assert all(reader.result() > 0 for reader in readers)
    assert memory.verify() == ()


def test_two_learners_do_not_lose_each_others_updates(memory: PerceptualMemory) -> None:
    memory.write(Batch([], [CategoryRecord("mug", {"n": np.array(0)})]))

    def learn() -> None:
        for _ in range(25):
            with memory.exclusive():
                known = int(memory.category("mug").state["n"])
                memory.write(Batch([], [CategoryRecord("mug", {"n": np.array(known + 1)})]))

    with ThreadPoolExecutor(2) as pool:
        for learner in [pool.submit(learn), pool.submit(learn)]:
            learner.result()
    assert int(memory.category("mug").state["n"]) == 50


@pytest.mark.parametrize("turn", range(5))
def test_closing_during_reads_raises_errors_in_the_readers(kept: Path, turn: int) -> None:
    memory = LevelMemory.open(kept)
    started = threading.Barrier(4)

    def read(look: Callable[[], object]) -> str:
        started.wait()
        while True:
            try:
                look()
            except MemoryFormatError as error:
                return str(error)

    def look_at_a_snapshot() -> None:
        with memory.snapshot() as now:
            list(now.views())

    looks: list[Callable[[], object]] = [
        lambda: list(memory.views()),
        lambda: memory.view("fork-1-0"),
        look_at_a_snapshot,
    ]
    with ThreadPoolExecutor(3) as pool:
        readers = [pool.submit(read, look) for look in looks]
        started.wait()
        time.sleep(0.01 * turn)
        memory.close()
        assert {reader.result() for reader in readers} == {"this memory is closed: open it again"}
    with LevelMemory.open(kept) as memory:
        assert memory.verify() == ()
