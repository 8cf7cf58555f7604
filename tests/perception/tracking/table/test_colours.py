"""Colours of a table: those in its light and in shadows, and those of things on it."""

import numpy as np

from deixis.perception.tracking.table.colours import TableColours


def checked_cloth() -> TableColours:
    rng = np.random.default_rng(0)
    pattern = np.repeat([(200.0, 40.0, 40.0), (235.0, 230.0, 225.0)], 500, axis=0)
    colours = TableColours()
    colours.extend((pattern + rng.normal(0, 2.5, pattern.shape)).astype(np.float32))
    return colours


def test_all_colours_of_a_pattern_are_the_table() -> None:
    found = checked_cloth().include(np.array([(198, 42, 38), (233, 231, 224), (60, 160, 60)], np.float32))
    assert found.tolist() == [True, True, False]


def test_shadows_are_the_table() -> None:
    shadows = np.outer((0.9, 0.75, 0.6), (200, 40, 40)).astype(np.float32)
    assert checked_cloth().include(shadows).all()


def test_rare_colours_are_not_the_table() -> None:
    colours = TableColours()
    pixels = np.tile(np.array([140, 105, 75], np.float32), (1000, 1))
    pixels[:5] = 190, 190, 195  # a fork that was not detected
    colours.extend(pixels)
    assert colours.include(pixels).sum() == 995


def test_table_without_colours_has_every_black_pixel() -> None:
    colours = TableColours()
    colours.extend(np.zeros((100, 3), np.float32))
    assert colours.include(np.zeros((4, 3), np.float32)).all()
