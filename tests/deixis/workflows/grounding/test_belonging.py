"""Test where missing and misplaced objects of a checked table belong."""

from __future__ import annotations

import numpy as np
import pytest

import deixis
from deixis.workflows.grounding.belonging import places_of

SCRIPT = "fork left of plate; knife right of plate; spoon right of knife"
BOXES = {
    "fork": ([0.00, 0.02], [0.02, 0.22]),
    "plate": ([0.05, 0.00], [0.30, 0.25]),
    "knife": ([0.33, 0.02], [0.35, 0.24]),
    "spoon": ([0.38, 0.02], [0.41, 0.21]),
}


def table(**moved: tuple[float, float] | None) -> dict[str, object]:
    objects = []
    for name, (low, high) in BOXES.items():
        shift = np.array(moved.get(name, (0.0, 0.0)) or (0.0, 0.0))
        if moved.get(name, 0.0) is not None:
            low_corner, high_corner = (np.array(low) + shift).tolist(), (np.array(high) + shift).tolist()
            objects.append({"id": name, "label": name, "min": low_corner, "max": high_corner})
    return {"objects": objects}


def test_a_table_that_is_laid_well_has_nothing_to_move() -> None:
    assert places_of(deixis.check(deixis.read_script(text=SCRIPT), table())) == {}


@pytest.mark.parametrize("name", ["fork", "spoon"])
def test_a_missing_object_belongs_near_its_neighbour(name: str) -> None:
    checked = deixis.check(deixis.read_script(text=SCRIPT), table(**{name: None}))
    low, high = places_of(checked)[name]
    true_low, true_high = np.array(BOXES[name])
    assert abs((low + high)[0] / 2 - (true_low + true_high)[0] / 2) < 0.08
    assert (low[0] > 0.35) if name == "spoon" else (high[0] < 0.05)


def test_objects_that_changed_places_belong_in_each_others() -> None:
    exchanged = table(fork=(0.33, 0.0), knife=(-0.33, 0.0))
    found = places_of(deixis.check(deixis.read_script(text=SCRIPT), exchanged))
    assert found["fork"].mean(axis=0)[0] == pytest.approx(0.01, abs=0.005)
    assert found["knife"].mean(axis=0)[0] == pytest.approx(0.34, abs=0.005)


def test_a_missing_object_belongs_beside_its_neighbours_place() -> None:
    laid = table(fork=(0.33, 0.0), knife=(-0.33, 0.0), spoon=None)
    found = places_of(deixis.check(deixis.read_script(text=SCRIPT), laid))
    assert found["spoon"][0, 0] > 0.35


def test_a_scene_in_pixels_has_places_in_pixels() -> None:
    scene = table(spoon=None)
    for thing in scene["objects"]:  # type: ignore[attr-defined]
        thing["min"], thing["max"] = [1000 * v for v in thing["min"]], [1000 * v for v in thing["max"]]
    found = places_of(deixis.check(deixis.read_script(text=SCRIPT), {**scene, "unit": "px"}))
    assert 350 < found["spoon"].mean(axis=0)[0] < 550


def test_a_missing_object_belongs_where_it_covers_no_other() -> None:
    script = deixis.read_script(text=f"{SCRIPT}; cup above knife")
    low, high = places_of(deixis.check(script, table(fork=(0.33, 0.0), knife=(-0.33, 0.0))))["cup"]
    plate_low, plate_high = np.array(BOXES["plate"])
    assert low[1] >= plate_high[1] or low[0] >= plate_high[0] or (high <= plate_low).any()
    assert abs((low + high)[0] / 2 - 0.34) < 0.06  # above the place where the knife belongs


def test_an_object_that_belongs_on_another_is_drawn_on_it() -> None:
    script = deixis.read_script(text=f"{SCRIPT}; napkin on plate; napkin left of knife")
    low, high = places_of(deixis.check(script, table()))["napkin"]
    plate_low, plate_high = np.array(BOXES["plate"])
    assert (plate_low - 1e-6 <= low).all() and (high <= plate_high + 1e-6).all()
