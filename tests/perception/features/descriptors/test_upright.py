"""The upright descriptor: height, size and build matter; place and turn do not."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.descriptors.upright import (
    EXTENT_OFFSET,
    HISTOGRAM_CELLS,
    UprightDescriber,
    upright_shape,
)

EYE = (0.0, -1.0, 0.8)


def cone(tip: float, n: int = 6000) -> NDArray[np.float64]:
    """Return the surface of a cone, 12 cm high and 8 cm wide, with its tip at the bottom (0) or at the top (1)."""
    rng = np.random.default_rng(0)
    share, angle = rng.uniform(0, 1, n), rng.uniform(0, 2 * np.pi, n)
    radius = 0.04 * np.abs(share - tip)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0.12 * share])


def box(length: float, width: float, height: float, turned: float = 0.0) -> NDArray[np.float64]:
    corners = np.stack(np.meshgrid(*(np.arange(0, side + 1e-9, 0.005) for side in (length, width, height))), -1)
    points = corners.reshape(-1, 3)
    cosine, sine = np.cos(turned), np.sin(turned)
    return np.column_stack(
        [cosine * points[:, 0] - sine * points[:, 1], sine * points[:, 0] + cosine * points[:, 1], points[:, 2]]
    )


def test_extents_are_height_length_and_width() -> None:
    for turned in (0.0, np.deg2rad(35)):
        shape = upright_shape(box(0.2, 0.1, 0.05, turned))
        assert shape is not None
        np.testing.assert_allclose(np.exp(shape.extents) - EXTENT_OFFSET, [0.05, 0.2, 0.1], atol=0.002)


def test_the_profile_shows_at_which_height_a_thing_is_wide() -> None:
    (below, _), (above, _) = upright_shape(cone(1)), upright_shape(cone(0))  # type: ignore[misc]
    shares = np.stack([below, above]).reshape(2, HISTOGRAM_CELLS, HISTOGRAM_CELLS) ** 2
    np.testing.assert_allclose(shares.sum(axis=(1, 2)), 1.0)
    outside = shares[:, :, HISTOGRAM_CELLS // 2 :].sum(axis=2)  # by height: shares far from the centre
    assert outside[0, 0] > 0.1 > outside[0, -1] == 0
    assert outside[1, -1] > 0.1 > outside[1, 0] == 0


@given(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), st.sampled_from([5.0, 40.0, 90.0, 180.0]))
def test_place_and_turn_do_not_change_the_shape(place: tuple[float, float], degrees: float) -> None:
    turned = box(0.2, 0.1, 0.05, np.deg2rad(degrees))
    here, there = upright_shape(box(0.2, 0.1, 0.05)), upright_shape(turned + np.array([*place, 0.0]))
    assert here is not None and there is not None
    np.testing.assert_allclose(there.extents, here.extents, atol=0.15)
    assert np.linalg.norm(there.profile - here.profile) < 0.4


def test_height_is_measured_from_the_table() -> None:
    tray = box(0.2, 0.1, 0.02)
    low, high = upright_shape(tray), upright_shape(tray + np.array([0, 0, 0.08]))
    assert low is not None and high is not None
    np.testing.assert_allclose(np.exp([low.extents[0], high.extents[0]]) - EXTENT_OFFSET, [0.02, 0.10], atol=0.002)
    assert not high.profile.reshape(HISTOGRAM_CELLS, HISTOGRAM_CELLS)[:4].any()


def test_a_thing_below_0_is_measured_from_its_own_foot() -> None:
    here, there = upright_shape(box(0.2, 0.1, 0.05)), upright_shape(box(0.2, 0.1, 0.05) - np.array([0, 0, 0.7]))
    assert here is not None and there is not None
    np.testing.assert_allclose(there.extents, here.extents, atol=0.05)


def test_an_upside_down_thing_has_another_descriptor() -> None:
    below, above = upright_shape(cone(1)), upright_shape(cone(0))
    assert below is not None and above is not None
    np.testing.assert_allclose(below.extents, above.extents, atol=0.05)
    assert np.linalg.norm(below.profile - above.profile) > 0.8


def test_a_descriptor_is_two_images_and_the_shape() -> None:
    describer = UprightDescriber()
    cloud = PointCloud(box(0.1, 0.06, 0.04).astype(np.float32), origin=EYE)
    found, shape = describer.describe(cloud), upright_shape(cloud.points)
    assert found.shape[1] == describer.size == 66 + 66 + 36 + 3 and shape is not None
    np.testing.assert_allclose((found[:, :66] ** 2).sum(axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose((found[:, 66:132] ** 2).sum(axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose(found[:, 132:168], np.tile(0.35 * shape.profile, (len(found), 1)), atol=1e-6)
    np.testing.assert_allclose(found[:, 168:], np.tile(0.1 * shape.extents, (len(found), 1)), atol=1e-6)


def test_with_weights_0_it_is_the_roots_of_spin_images() -> None:
    from deixis.perception.features.descriptors.spin_images import SpinImageDescriber

    cloud = PointCloud(box(0.1, 0.06, 0.04).astype(np.float32), origin=EYE)
    found = UprightDescriber(profile=0, extents=0).describe(cloud)
    expected = [np.sqrt(SpinImageDescriber(width=5, support=support).describe(cloud)) for support in (0.2, 0.05)]
    np.testing.assert_allclose(found[:, :132], np.concatenate(expected, axis=1), atol=1e-7)
