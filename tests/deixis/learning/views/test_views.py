"""Teach and recognise in a memory that is older than the present comparison of views."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from deixis.learning.views.views import (
    COLOUR,
    COMPARED,
    FORM,
    SPIN_IMAGE_ROOTS,
    TABLE,
    UPRIGHT,
    batch_of,
    instances_of,
    recogniser_of,
    view_of,
)
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.recognition.calibration import COLOUR_WEIGHT
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes.tableware import make

THINGS = (("plate", 1), ("plate", 2), ("fork", 1), ("fork", 2))


def seen(kind: str, seed: int, look: int | None = None) -> PointCloud:
    return views_of(make(kind, seed=seed).mesh, 1, seed=seed if look is None else look, upright=True)[0]


def view(kind: str, seed: int, frame: str = TABLE) -> View:
    where = {"scene": "table", "object": f"{kind} {seed}"}
    return view_of(seen(kind, seed), frame, kind, datetime(2026, 1, seed, tzinfo=UTC), where)


def keep_views(memory: LevelMemory, views: list[View]) -> None:
    memory.write(batch_of(memory, views)[0])


def as_before(one: View) -> View:
    return replace(one, descriptors={SPIN_IMAGE_ROOTS.name: one.descriptors[SPIN_IMAGE_ROOTS.name]})


@pytest.fixture
def before(tmp_path: Path) -> Path:
    """Memory from the time when views had only square roots of spin images."""
    views = [as_before(view(kind, seed)) for kind, seed in THINGS]
    records = []
    for kind in ("plate", "fork"):
        views_of_kind = sorted((one for one in views if one.category == kind), key=lambda one: one.id)
        category = instances_of(CategoryRecord(kind), views_of_kind, (SPIN_IMAGE_ROOTS,))[0]
        ids: dict[str, object] = {"views": list(category.views.ids)}
        records.append(CategoryRecord(kind, {"distances": category.distances}, ids))
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        memory.write(Batch(views, records))
    return tmp_path / "perceptual"


def test_an_older_memory_is_compared_as_it_was(before: Path) -> None:
    with LevelMemory.open(before) as memory:
        known = recogniser_of(memory, TABLE)
        assert known.comparison == (SPIN_IMAGE_ROOTS,)
        answer = known.recognise(seen("plate", 9))
        assert answer.candidates[0].category == "plate"


def test_new_views_in_an_older_memory_can_be_compared(before: Path) -> None:
    with LevelMemory.open(before) as memory:
        keep_views(memory, [view("plate", 3), view("mug", 1), view("mug", 2)])
        assert memory.category("plate").metadata[COMPARED] == SPIN_IMAGE_ROOTS.name
        known = recogniser_of(memory, TABLE)
        assert known.comparison == (SPIN_IMAGE_ROOTS,)
        assert {one.name: len(one) for one in known.recogniser.categories} == {"plate": 3, "fork": 2, "mug": 2}
        fresh = instances_of(CategoryRecord("mug"), list(memory.views("mug")), (SPIN_IMAGE_ROOTS,))[0]
        mug = next(one for one in known.recogniser.categories if one.name == "mug")
        np.testing.assert_allclose(mug.distances, fresh.distances)


def test_without_older_views_the_new_comparison_is_used(before: Path) -> None:
    with LevelMemory.open(before) as memory:
        keep_views(memory, [view("mug", 1), view("mug", 2)])
        memory.forget("plate")
        memory.forget("fork")
        assert recogniser_of(memory, TABLE).comparison == (UPRIGHT, FORM)


def test_a_new_memory_is_compared_in_the_new_way(tmp_path: Path) -> None:
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        keep_views(memory, [view(kind, seed) for kind, seed in THINGS])
        known = recogniser_of(memory, TABLE)
        assert known.comparison == (UPRIGHT, FORM)
        assert known.recognise(seen("fork", 9)).candidates[0].category == "fork"


def painted(kind: str, seed: int, look: int, colour: tuple[float, ...]) -> PointCloud:
    cloud = seen(kind, seed, look)
    noise = np.random.default_rng(seed).normal(0, 3, (len(cloud), 3))
    return replace(cloud, colours=np.clip(np.array(colour) + noise, 0, 255).astype(np.uint8))


PAINT = {"bills cup": (180, 40, 40), "anns cup": (40, 60, 170)}


def teach_painted_cups(memory: LevelMemory, count: int) -> None:
    """Return cups of the same shapes that differ only in colour."""
    views = [
        view_of(painted("cup", seed, 100 * place + seed, colour), TABLE, name, datetime(2026, 1, seed, tzinfo=UTC), {})
        for place, (name, colour) in enumerate(PAINT.items())
        for seed in range(1, count + 1)
    ]
    keep_views(memory, views)


def test_colour_tells_apart_what_shape_cannot(tmp_path: Path) -> None:
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        teach_painted_cups(memory, 6)
        known = recogniser_of(memory, TABLE)
        assert known.comparison == (UPRIGHT, FORM, COLOUR)
        assert known.recogniser.calibration.weights[-1] > 3 * COLOUR_WEIGHT  # as computed from its own views
        for name, colour in PAINT.items():
            dim = painted("cup", 9, 9, tuple(0.6 * part for part in colour))  # in the shade
            assert known.recognise(dim).candidates[0].category == name


def test_what_has_no_colour_is_compared_by_shape_alone(tmp_path: Path) -> None:
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        teach_painted_cups(memory, 6)
        known = recogniser_of(memory, TABLE)
        grey = known.recognise(seen("cup", 9))
        assert grey.label is None and len(grey.candidates) == 2
        assert known.by_shape is not None and grey == known.by_shape.recognise(seen("cup", 9))
        again = recogniser_of(memory, TABLE)  # with the calibrations that were kept
        assert again.calibrations == known.calibrations and again.recognise(seen("cup", 9)) == grey


def test_colour_counts_only_where_all_views_have_it(tmp_path: Path) -> None:
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        teach_painted_cups(memory, 2)
        keep_views(memory, [view("plate", 1)])
        assert recogniser_of(memory, TABLE).comparison == (UPRIGHT, FORM)


def test_another_frame_uses_descriptors_that_need_no_frame(tmp_path: Path) -> None:
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        keep_views(memory, [view(kind, seed) for kind, seed in THINGS])
        known = recogniser_of(memory, "camera")
        assert known.comparison == (SPIN_IMAGE_ROOTS,)
        assert known.recognise(seen("plate", 9)).candidates[0].category == "plate"
        keep_views(memory, [view("plate", 3, frame="camera")])
        assert memory.category("plate").metadata[COMPARED] == SPIN_IMAGE_ROOTS.name
        assert memory.category("fork").metadata[COMPARED] == UPRIGHT.name
        both = recogniser_of(memory, TABLE)
        assert both.comparison == (SPIN_IMAGE_ROOTS,)
        assert {one.name: len(one) for one in both.recogniser.categories} == {"plate": 3, "fork": 2}


def test_many_views_mapped_from_a_file_give_the_same_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        keep_views(memory, [view(kind, seed) for kind, seed in THINGS])
        held = recogniser_of(memory, TABLE)
        monkeypatch.setattr("deixis.learning.views.views.MAPPED", len(THINGS))
        mapped = recogniser_of(memory, TABLE)
    for one, other in zip(held.recogniser.categories, mapped.recogniser.categories, strict=True):
        assert one.views.descriptors.flags.owndata and not other.views.descriptors.flags.owndata
    assert held.recognise(seen("plate", 9)) == mapped.recognise(seen("plate", 9))


def test_a_view_without_a_descriptor_can_be_kept_and_retaught(tmp_path: Path) -> None:
    bare = replace(view("plate", 1), descriptors={UPRIGHT.name: np.zeros((0, 171), np.float32)})
    with LevelMemory.open(tmp_path / "perceptual", create=True) as memory:
        memory.write(Batch([bare]))
        keep_views(memory, [view("plate", 2), view("mug", 1)])
        assert recogniser_of(memory, TABLE).recogniser.categories[1].empty == (bare.id,)
        keep_views(memory, [view("plate", 1)])
        assert [len(known) for known in recogniser_of(memory, TABLE).recogniser.categories] == [1, 2]
