"""Places where something absent may have been: where they lie, and that they change nothing between things."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.experiments.generated_tables import generate
from deixis.reasoning.graded.facts import fact_tables
from deixis.reasoning.graded.places import MARGIN, MORE, PLACES, places_for, spread


@st.composite
def scenes(draw: st.DrawFn) -> NDArray[np.float64]:
    n, d = draw(st.integers(1, 6)), draw(st.sampled_from([2, 3]))
    number = st.floats(-5, 5, allow_nan=False)
    low = np.array(draw(st.lists(number, min_size=n * d, max_size=n * d))).reshape(n, d)
    extent = np.array(draw(st.lists(st.floats(0, 3), min_size=n * d, max_size=n * d))).reshape(n, d)
    return np.stack([low, low + extent], axis=1)


@settings(deadline=None)
@given(scenes(), st.integers(0, 40))
def test_places_are_as_large_and_as_high_as_things_and_lie_in_and_around_the_scene(
    boxes: NDArray[np.float64], count: int
) -> None:
    found = spread(boxes, count)
    assert found.shape == (count, *boxes.shape[1:])
    alike = boxes[np.arange(count) % len(boxes)]
    np.testing.assert_allclose(found[:, 1] - found[:, 0], alike[:, 1] - alike[:, 0], atol=1e-9)
    np.testing.assert_array_equal(found[:, :, 2:], alike[:, :, 2:])
    low, high = boxes[:, 0, :2].min(axis=0), boxes[:, 1, :2].max(axis=0)
    around = MARGIN * (high - low) + 1e-9
    centres = found[:, :, :2].mean(axis=1)
    assert (centres >= low - around).all() and (centres <= high + around).all()


def test_places_fill_the_plane_evenly() -> None:
    boxes = np.array([[[0.0, 0.0], [1.0, 1.0]]])
    centres = spread(boxes, PLACES).mean(axis=1)
    quarters = np.bincount(2 * (centres[:, 0] > 0.5) + (centres[:, 1] > 0.5), minlength=4)
    assert (np.abs(quarters - PLACES / 4) <= 2).all()
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2) + np.eye(PLACES)
    assert apart.min() > (1 + 2 * MARGIN) / PLACES**0.5 / 3


def test_places_change_nothing_that_is_said_of_things() -> None:
    table = generate(10, missing=1, extra=2, seed=4)
    alone = fact_tables(table.description(), table.boxes)
    beside = fact_tables(table.description(), table.boxes, places=7)
    n2 = len(table.boxes)
    assert beside.tables.shape[1:] == (n2 + 7, n2 + 7)
    np.testing.assert_array_equal(beside.tables[:, :n2, :n2], alone.tables)


def test_a_place_just_where_a_thing_lies_is_spoken_of_as_the_thing_is() -> None:
    """The one place of a scene of two boxes around one point lies there, and is as large as the first."""
    table = generate(4, 1.5, seed=1)
    inner = table.boxes[np.lexsort(table.boxes.reshape(4, -1).T[::-1])[0]]
    low, high = table.boxes[:, 0].min(axis=0), table.boxes[:, 1].max(axis=0)
    moved = inner - inner.mean(axis=0) + (low + high) / 2
    tables = fact_tables(table.description(), table.boxes, places=1, literal=0.0, saying=False).tables
    there = np.concatenate([table.boxes, moved[None]])
    expected = fact_tables(table.description(), there, literal=0.0, saying=False).tables
    np.testing.assert_allclose(tables, expected, atol=1e-5)


def test_there_are_more_places_where_more_has_to_be_absent_and_none_in_large_descriptions() -> None:
    assert places_for(20, 15) - places_for(15, 15) == 5 * MORE
    assert places_for(15, 20) == places_for(15, 15) == PLACES
    assert places_for(500, 400) == 0
