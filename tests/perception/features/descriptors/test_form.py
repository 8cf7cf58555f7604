"""The form descriptor: cavities, necks, blades and handles matter; place, turn, density and size do not."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.descriptors.form import LEVELS, PARTS, STATIONS, FormDescriber, form_parts
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes.tableware import make

Points = NDArray[np.float64]
EYE = (0.0, -0.8, 0.6)


def parts(points: Points, eye: tuple[float, float, float] = EYE) -> dict[str, Points]:
    found = form_parts(PointCloud(points.astype(np.float32), origin=eye))
    assert found is not None
    return found


def front(radius: float = 0.04, height: float = 0.12, top: float | None = None, n: int = 4000) -> Points:
    """Return the front of a pillar, or of a cone if the top has another radius."""
    rng = np.random.default_rng(0)
    share, angle = rng.uniform(0, 1, n), rng.uniform(-np.pi, 0, n)
    wide = radius + ((radius if top is None else top) - radius) * share
    return np.column_stack([wide * np.cos(angle), wide * np.sin(angle), height * share])


def test_the_axis_of_a_round_thing_from_its_front() -> None:
    inner, outer = parts(front())["radii"].reshape(LEVELS, 2).T
    np.testing.assert_allclose(outer, 0.04 / 0.12, atol=0.03)
    np.testing.assert_allclose(inner, outer, atol=0.05)


def test_radii_show_where_a_thing_narrows() -> None:
    outer = parts(front(top=0.01))["radii"].reshape(LEVELS, 2)[:, 1]
    assert outer[0] > 2 * outer[-1]


def test_the_walls_of_a_hollow_face_its_axis() -> None:
    def inward(kind: str) -> float:
        (cloud,) = views_of(make(kind, seed=1).mesh, 1, seed=1, upright=True)
        found = form_parts(cloud)
        assert found is not None
        shares = found["facing_by_height"].reshape(4, 4, 3) ** 2
        assert shares.sum() == pytest.approx(1.0)
        return float(shares[:, :, 0].sum())

    assert inward("bowl") > 0.15 > inward("bottle")


def test_widths_begin_with_the_wider_half() -> None:
    rng = np.random.default_rng(0)
    along = rng.uniform(0, 0.2, 3000)
    spoon = np.column_stack([along, rng.uniform(-1, 1, 3000) * np.where(along > 0.15, 0.02, 0.004), 0 * along])
    for turned in (spoon, spoon * [-1, 1, 1]):
        widths = parts(turned)["widths"]
        assert widths[1] > 2 * widths[STATIONS - 2]


def test_a_gap_reduces_the_filling_of_the_hull() -> None:
    angle = np.random.default_rng(0).uniform(0, 2 * np.pi, 4000)
    radius = np.random.default_rng(1).uniform(0.07, 0.08, 4000)
    ring = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle])
    disc = ring * np.sqrt(np.random.default_rng(2).uniform(0, 1, 4000))[:, None]
    assert parts(ring)["filling"][0] < 0.6 < parts(disc)["filling"][0]


@settings(deadline=None, max_examples=20)
@given(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), st.floats(0, 360))
def test_place_and_turn_do_not_matter(place: tuple[float, float], degrees: float) -> None:
    cosine, sine = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    turn = np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])
    box = np.stack(np.meshgrid(*(np.arange(0, side, 0.004) for side in (0.2, 0.08, 0.05))), -1).reshape(-1, 3)
    box = box[(box[:, 1] == 0) | (box[:, 2] > 0.045)]  # front and top
    moved = parts(box @ turn + [*place, 0], tuple(np.array(EYE) @ turn + [*place, 0]))
    here = parts(box)
    apart = [np.linalg.norm(moved[name] - here[name]) / part.scale for name, part in PARTS.items()]
    assert np.linalg.norm(apart) < 0.6 * np.sqrt(len(PARTS))


def test_the_resolution_hardly_changes_the_form() -> None:
    rough, fine = (
        FormDescriber().describe(PointCloud(front(n=n).astype(np.float32), origin=EYE)) for n in (3000, 12000)
    )
    cone = FormDescriber().describe(PointCloud(front(top=0.01).astype(np.float32), origin=EYE))
    assert np.linalg.norm(rough - fine) < 0.5 * np.linalg.norm(rough - cone)


def test_the_vector_holds_the_parts_over_their_scales() -> None:
    describer, cloud = FormDescriber(), PointCloud(front().astype(np.float32), origin=EYE)
    found, expected = describer.describe(cloud), form_parts(cloud)
    assert expected is not None and found.shape == (1, describer.size)
    whole = np.concatenate([expected[name] / part.scale for name, part in PARTS.items()])
    np.testing.assert_allclose(found[0], whole, rtol=1e-6)
    assert [len(expected[name]) for name in PARTS] == [part.size for part in PARTS.values()]


@pytest.mark.parametrize("count", [0, 1, 2, 3, 5])
def test_few_points_give_a_finite_form_or_none(count: int) -> None:
    points = np.random.default_rng(count).uniform(0, 0.02, (count, 3)).astype(np.float32)
    found = FormDescriber().describe(PointCloud(points, origin=EYE))
    assert len(found) in (0, 1) and np.isfinite(found).all()


def test_a_line_of_points_has_no_form() -> None:
    line = np.linspace([0, 0, 0], [0.2, 0, 0], 50).astype(np.float32)
    assert len(FormDescriber().describe(PointCloud(line, origin=EYE))) == 0
