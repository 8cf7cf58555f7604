"""Small views, and both kinds of memory."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory, PerceptualReading
from deixis.memory.perceptual.records import CategoryRecord, View
from deixis.memory.perceptual.transient import TransientMemory

IN_MEMORY = "/dev/shm"
"""Folder in memory, where the system has one.

The tests check what survives a process, not a machine, and waiting for a disk takes most of the time.
"""

ROOM = 1 << 30
"""Minimum number of free bytes in the folder; containers often have fewer."""

NOON = datetime(2026, 5, 1, 12, tzinfo=UTC)


def _view(id: str, category: str = "mug", seed: int = 0, minutes: int = 0) -> View:
    rng = np.random.default_rng([seed, *id.encode()])
    return View(
        id,
        category,
        NOON + timedelta(minutes=minutes),
        {"spin": rng.random((3, 153), np.float32), "good": rng.random((1, 75), np.float32)},
        rng.random((5, 3), np.float32),
        {"scene": "s1", "object": f"o{seed}", "teacher": "Ada"},
    )


def _record(name: str, threshold: float = 0.5) -> CategoryRecord:
    state = {
        "threshold": np.array(threshold),
        "icd": np.arange(4, dtype=np.int64),
        "none": np.zeros((0, 3), np.float32),
    }
    return CategoryRecord(name, state, {"learner": "instances"})


def _said(record: View | CategoryRecord) -> dict[str, Any]:
    arrays_aside = ("descriptors", "state", "points")
    named = {name: value for name, value in vars(record).items() if name not in arrays_aside}
    arrays: dict[str, Any] = dict(record.descriptors if isinstance(record, View) else record.state)
    if isinstance(record, View) and record.points is not None:
        arrays["points"] = record.points
    looks = {name: (array.dtype.str, array.shape, array.tobytes()) for name, array in arrays.items()}
    return {**named, "metadata": dict(record.metadata), "arrays": looks}


def _content(memory: PerceptualReading) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    return [_said(view) for view in memory.views()], [_said(memory.category(name)) for name in memory.categories()]


@pytest.fixture(autouse=True, scope="module")
def _in_memory() -> Iterator[None]:
    """Put temporary folders in memory."""
    with pytest.MonkeyPatch.context() as patched:
        if os.access(IN_MEMORY, os.W_OK) and shutil.disk_usage(IN_MEMORY).free > ROOM:
            patched.setattr(tempfile, "tempdir", IN_MEMORY)
        yield


@pytest.fixture
def tmp_path() -> Iterator[Path]:
    """Folder of a test's own."""
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


@pytest.fixture(scope="session")
def make_view() -> Callable[..., View]:
    """Make a view with arrays computed from its id and a seed."""
    return _view


@pytest.fixture(scope="session")
def make_record() -> Callable[..., CategoryRecord]:
    """Make a record of a category, with a threshold."""
    return _record


@pytest.fixture(scope="session")
def said() -> Callable[[View | CategoryRecord], dict[str, Any]]:
    """Return the content of a record for comparisons: arrays by type, shape and bytes."""
    return _said


@pytest.fixture(scope="session")
def content() -> Callable[[PerceptualReading], tuple[list[dict[str, Any]], list[dict[str, Any]]]]:
    """Return the content of a memory, in its order."""
    return _content


@pytest.fixture(params=["level", "transient"])
def memory(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[PerceptualMemory]:
    """Empty memory of each kind."""
    if request.param == "level":
        with LevelMemory.open(tmp_path / "perceptual", create=True) as level:
            yield level
    else:
        with TransientMemory() as transient:
            yield transient


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """Closed memory of ten views in three categories, written in two sessions."""
    from deixis.memory.perceptual.records import Batch

    folder = tmp_path / "kept"
    for sitting, categories in enumerate((("mug", "plate"), ("mug", "fork"))):
        with LevelMemory.open(folder, create=True) as memory:
            for category in categories:
                views = [_view(f"{category}-{sitting}-{number}", category, number, number) for number in range(3)]
                memory.write(Batch(views[: 3 - sitting], [_record(category, 0.1 * sitting)]))
    return folder
