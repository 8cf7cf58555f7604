"""Compare both kinds of memory with two dictionaries through random histories, with names of any characters."""

from __future__ import annotations

import tempfile
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import hypothesis.extra.numpy as arrays_of
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from deixis.memory.errors import RejectedWriteError, UnknownCategoryError, UnknownViewError
from deixis.memory.perceptual.exchange import export_views, import_views
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.memory.perceptual.transient import TransientMemory

names = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=12)
floats = st.floats(width=32, allow_nan=True)
shapes = arrays_of.array_shapes(min_dims=2, max_dims=2, min_side=0, max_side=4)
matrices = arrays_of.arrays(np.float32, shapes, elements=floats)
points = arrays_of.arrays(np.float32, st.tuples(st.integers(0, 4), st.just(3)), elements=floats)
finite = st.floats(allow_nan=False, allow_infinity=False)
leaves = st.none() | st.booleans() | st.integers() | finite | st.text(max_size=5)
json = st.dictionaries(st.text(max_size=5), st.recursive(leaves, lambda inner: st.lists(inner, max_size=3)), max_size=3)
zones = st.timedeltas(timedelta(hours=-20), timedelta(hours=20)).map(timezone)
times = st.datetimes(datetime(2, 1, 1), datetime(9998, 1, 1), timezones=zones)
views = st.builds(View, names, names, times, st.dictionaries(names, matrices, max_size=2), st.none() | points, json)
states = st.dictionaries(names.filter(lambda name: name != "__metadata__"), matrices, max_size=2)
records = st.builds(CategoryRecord, names, states, json)


@given(view=views, record=records)
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_record_comes_back(
    view: View, record: CategoryRecord, said: Any, content: Any, one_level: LevelMemory
) -> None:
    for memory in (TransientMemory(), one_level):
        memory.write(Batch([view], [record]))
        assert said(memory.view(view.id)) == said(view)
        assert said(memory.category(record.name)) == said(record)
    with tempfile.TemporaryDirectory() as folder:
        file, other = Path(folder) / "views.zip", TransientMemory()
        export_views(one_level, file)
        import_views(file, other)
        assert content(other) == content(one_level)
    for category in one_level.categories():
        one_level.forget(category)


@pytest.fixture(scope="module")
def one_level() -> Any:
    with tempfile.TemporaryDirectory() as folder, LevelMemory.open(folder + "/m", create=True) as memory:
        yield memory


few_names = st.sampled_from(["a", "a\0", "b", "\U0001f374", "ab"])
few_ids = st.sampled_from([f"v{number}" for number in range(6)])


class Histories(RuleBasedStateMachine):
    """State machine of a memory, a dictionary of views and one of records."""

    memory: PerceptualMemory

    def __init__(self) -> None:
        super().__init__()
        self.views: dict[str, tuple[str, float]] = {}
        self.records: dict[str, float | None] = {}
        self.batches = 0

    def teardown(self) -> None:
        self.memory.close()

    def known(self) -> set[str]:
        return {category for category, _ in self.views.values()} | set(self.records)

    @rule(
        new=st.dictionaries(few_ids, st.tuples(few_names, st.floats(width=32)), max_size=3),
        learned=st.dictionaries(few_names, st.floats(allow_nan=False), max_size=2),
        gone=st.sets(few_ids, max_size=2),
    )
    def write(self, new: dict[str, tuple[str, float]], learned: dict[str, float], gone: set[str]) -> None:
        gone -= set(new)
        batch = Batch(
            [
                View(id, name, datetime(2026, 1, 1, tzinfo=UTC), {"d": np.full((1, 1), x, np.float32)})
                for id, (name, x) in new.items()
            ],
            [CategoryRecord(name, {"x": np.array(x)}) for name, x in learned.items()],
            sorted(gone),
        )
        if gone <= set(self.views):
            self.memory.write(batch)
            self.views = {id: view for id, view in self.views.items() if id not in gone} | new
            self.records |= learned
            self.batches += 1
        else:
            with pytest.raises(UnknownViewError):
                self.memory.write(batch)

    @rule(old=few_names, new=few_names)
    def rename(self, old: str, new: str) -> None:
        if old not in self.known():
            with pytest.raises(UnknownCategoryError):
                self.memory.rename(old, new)
        elif new in self.known():
            with pytest.raises(RejectedWriteError):
                self.memory.rename(old, new)
        else:
            self.memory.rename(old, new)
            self._move(old, new, self.records.get(old))

    @rule(source=few_names, into=few_names)
    @precondition(lambda self: len(self.known()) >= 2)
    def merge(self, source: str, into: str) -> None:
        if source != into and {source, into} <= self.known():
            self.memory.merge(source, into)
            self._move(source, into, None)

    def _move(self, old: str, new: str, state: float | None) -> None:
        self.views = {id: (new if name == old else name, x) for id, (name, x) in self.views.items()}
        self.records.pop(old, None)
        self.records[new] = state
        self.batches += 1

    @rule(category=few_names)
    def forget(self, category: str) -> None:
        if category in self.known():
            self.memory.forget(category)
            self.views = {id: view for id, view in self.views.items() if view[0] != category}
            self.records.pop(category, None)
            self.batches += 1

    @invariant()
    def is_the_same(self) -> None:
        listed = [(view.category, view.id, view.descriptors["d"].tobytes()) for view in self.memory.views()]
        assert listed == sorted((name, id, np.float32(x).tobytes()) for id, (name, x) in self.views.items())
        assert self.memory.categories() == tuple(sorted(self.known()))
        for name in self.known():
            state = self.memory.category(name).state
            expected = self.records.get(name)
            assert ("x" in state) == (expected is not None)
            assert expected is None or float(state["x"]) == expected
            ids = [key.id for key in self.memory.listing(name)]
            assert ids == sorted(id for id, (category, _) in self.views.items() if category == name)
        stats = self.memory.stats()
        assert (stats.views, stats.categories, stats.batches) == (len(self.views), len(self.known()), self.batches)
        assert self.memory.verify() == ()


class LevelHistories(Histories):
    """Memory in a LevelDB, which is sometimes closed and opened again."""

    def __init__(self) -> None:
        super().__init__()
        self._folder = tempfile.TemporaryDirectory()
        self.memory = LevelMemory.open(self._folder.name + "/m", create=True)

    @rule()
    def open_again(self) -> None:
        self.memory.close()
        self.memory = LevelMemory.open(self._folder.name + "/m")

    def teardown(self) -> None:
        super().teardown()
        self._folder.cleanup()


class TransientHistories(Histories):
    """Memory in dictionaries."""

    def __init__(self) -> None:
        super().__init__()
        self.memory = TransientMemory()


TestLevelHistories = LevelHistories.TestCase
TestLevelHistories.settings = settings(max_examples=12, stateful_step_count=15, deadline=None)
TestTransientHistories = TransientHistories.TestCase
TestTransientHistories.settings = settings(max_examples=25, stateful_step_count=15, deadline=None)
