"""Valid and invalid records."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime, timedelta, timezone
from typing import Any

import numpy as np
import pytest

from deixis.memory.errors import RecordError
from deixis.memory.perceptual.records import CategoryRecord, View

NOW = datetime(2026, 5, 1, tzinfo=UTC)
GOOD: dict[str, Any] = {"id": "v1", "category": "mug", "time": NOW, "descriptors": {}}

BAD_VIEWS: list[tuple[dict[str, Any], str]] = [
    ({"id": ""}, "a view's id must be a string of one or more characters"),
    ({"id": 7}, "got 7"),
    ({"category": "\ud800"}, "half a character"),
    ({"category": "x" * 1001}, "too long: 1001 bytes"),
    ({"time": datetime(2026, 5, 1)}, "a datetime with a time zone"),
    ({"time": "today"}, "a datetime with a time zone"),
    ({"time": datetime(1, 1, 1, tzinfo=timezone(timedelta(hours=5)))}, "must be in the years 1 to 9999"),
    ({"descriptors": {"": np.zeros((1, 1), np.float32)}}, "a descriptor's name"),
    ({"descriptors": {"spin": np.zeros((1, 1))}}, r"descriptor 'spin' of view 'v1'.*got float64 \(1, 1\)"),
    ({"descriptors": {"spin": np.zeros(3, np.float32)}}, "two dimensions"),
    ({"descriptors": {"spin": [[1.0]]}}, "got list"),
    ({"points": np.zeros((4, 2), np.float32)}, r"must have shape \(n, 3\), got \(4, 2\)"),
    ({"metadata": {"x": float("nan")}}, "cannot be written as JSON"),
    ({"metadata": {"x": object()}}, "cannot be written as JSON"),
    ({"metadata": {1: "x"}}, "strings as keys"),
    ({"metadata": {"x": (1, 2)}}, "use lists"),
    ({"metadata": 7}, "cannot be written as JSON"),
]


@pytest.mark.parametrize(("wrong", "message"), BAD_VIEWS)
def test_a_view_that_cannot_be_kept_is_refused(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(RecordError, match=message):
        View(**{**GOOD, **wrong})


@pytest.mark.parametrize(
    ("state", "message"),
    [
        ({"x": np.array(["a"])}, "'x' of category 'mug' must be an array of numbers"),
        ({"x": np.zeros(1, np.complex64)}, "must be an array of numbers"),
        ({"x": [1]}, "must be an array of numbers"),
        ({"": np.zeros(1)}, "the name of a state"),
    ],
)
def test_a_state_that_cannot_be_kept_is_refused(state: Any, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        CategoryRecord("mug", state)


def test_metadata_is_kept_as_it_was(make_view: Callable[..., View]) -> None:
    said = {"scene": {"id": "s1", "objects": [1, 2.5, None, True]}}
    view = View(**{**GOOD, "metadata": said})
    said["scene"]["id"] = "s2"
    assert view.metadata["scene"]["id"] == "s1"


@pytest.mark.parametrize("array", [np.ones((4, 6), np.float32)[::2, ::3], np.ones((3, 2), np.float32, order="F")])
def test_arrays_in_any_order_of_memory_are_kept_in_one_piece(array: Any) -> None:
    kept = View(**{**GOOD, "descriptors": {"spin": array}}).descriptors["spin"]
    assert kept.flags.c_contiguous
    assert np.array_equal(kept, array)
