"""Colours of pictures, as people with each form of colour blindness see them."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from deixis.plots.camera import colours_of
from deixis.plots.figure import LINE_COLOURS, PALETTE, line_look
from deixis.plots.grounding import GROUP_COLOURS

DEFICIENCIES = {
    "none": np.eye(3),
    "protanopia": np.array([[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]]),
    "deuteranopia": np.array([[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]]),
    "tritanopia": np.array([[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]]),
}
"""Matrices on linear RGB by Machado, Oliveira and Fernandes (2009), severity 1."""

APART, PALE = 15.0, 9.0
"""Minimum distances in CIE L*a*b* of two colours of a palette, and of two that may be pale; 2.3 is just seen."""


def nearest(colours: NDArray[np.float64], deficiency: str) -> float:
    """Return the distance in CIE L*a*b* of the two most similar of some colours (n, 3)."""
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ DEFICIENCIES[deficiency].T, 0, 1)
    to_xyz = np.array([[0.4125, 0.3576, 0.1804], [0.2127, 0.7152, 0.0722], [0.0193, 0.1192, 0.9503]])
    xyz = seen @ to_xyz.T / to_xyz.sum(axis=1)
    f = np.where(xyz > 0.008856, np.cbrt(xyz), (903.3 * xyz + 16) / 116)
    lab = np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)
    return min(float(np.linalg.norm(one - other)) for k, one in enumerate(lab) for other in lab[:k])


@pytest.mark.parametrize("deficiency", DEFICIENCIES)
@pytest.mark.parametrize("colours", [PALETTE, LINE_COLOURS, GROUP_COLOURS], ids=["palette", "lines", "groups"])
def test_colours_are_told_apart(colours: tuple[str, ...], deficiency: str) -> None:
    assert nearest(np.array([to_rgb(colour) for colour in colours]), deficiency) >= APART


@pytest.mark.parametrize("deficiency", DEFICIENCIES)
def test_segments_of_a_picture_are_told_apart(deficiency: str) -> None:
    assert nearest(colours_of(np.arange(len(PALETTE))), deficiency) >= APART
    assert nearest(colours_of(np.arange(2 * len(PALETTE))), deficiency) >= PALE


def test_lines_of_one_colour_differ_in_their_dashes() -> None:
    looks = [tuple(line_look(number).values()) for number in range(2 * len(LINE_COLOURS))]
    assert len(set(looks)) == len(looks)
