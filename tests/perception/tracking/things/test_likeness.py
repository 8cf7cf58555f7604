"""Colours of one thing in the light of its sides."""

import numpy as np

from deixis.perception.tracking.things.likeness import likeness

BLUE = np.array([40.0, 60.0, 160.0])


def test_shade_of_a_colour_is_more_alike_than_another_hue() -> None:
    same, shaded, other = likeness(np.array([BLUE, 0.8 * BLUE, BLUE[::-1]]), BLUE[None])
    assert same == 1.0 and 0.4 < shaded < 1.0 and other < 0.01


def test_any_light_leaves_the_hue_only() -> None:
    shaded, other = likeness(np.array([0.5 * BLUE, BLUE[::-1]]), BLUE[None], np.inf)
    assert shaded > 0.99 and other < 0.01


def test_nearest_of_several_colours_counts() -> None:
    assert likeness(BLUE[None], np.stack([BLUE[::-1], BLUE]))[0] == 1.0
