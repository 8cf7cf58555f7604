"""Tableware: closed, of its usual size and shape, and the same for the same seed."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from solid_checks import is_closed, volume

from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.sizes import Extent, Outline
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.meshes.rays import RayCaster
from deixis.perception.simulator.meshes.size import quantile, share_below
from deixis.perception.simulator.meshes.tableware import drawn_plan, form_of, kind_named, make

ONTOLOGY = default_ontology()
TABLEWARE = [
    kind.label
    for kind in ONTOLOGY.kinds
    if ONTOLOGY.kinds.is_a(kind, kind_named("tableware", ONTOLOGY)) and kind.name != "Tableware"
]
SEEDS = range(2)


def extents(mesh: Mesh) -> list[float]:
    across: list[float] = np.ptp(mesh.vertices, axis=0).tolist()
    return across


@pytest.mark.parametrize("kind", TABLEWARE)
def test_things_of_every_kind_are_closed_and_of_the_usual_size(kind: str) -> None:
    usual = ONTOLOGY.sizes.of(kind_named(kind, ONTOLOGY).iri)
    for seed in SEEDS:
        thing = make(kind, seed)
        width, length, height = extents(thing.mesh)
        assert is_closed(thing.mesh)
        assert volume(thing.mesh) > 0
        assert usual.width.admits(width, 1e-9)
        assert usual.height.admits(height, 1e-9)
        if not thing.form.handle:
            assert usual.length.admits(length, 1e-9)
            assert usual.outline is Outline.RECTANGLE or width == pytest.approx(length)
        else:
            reach = usual.reach
            assert reach is not None
            assert reach.least <= length / width - 1 <= reach.greatest
        assert thing.mesh.vertices[:, 2].min() == 0.0


def test_things_depend_on_the_seed() -> None:
    one, again, other = make("soup spoon", 5), make("soup spoon", 5), make("soup spoon", 6)
    assert np.array_equal(one.mesh.vertices, again.mesh.vertices)
    assert np.array_equal(one.mesh.faces, again.mesh.faces)
    assert one.colour == again.colour
    assert not np.allclose(extents(one.mesh), extents(other.mesh), atol=1e-5)


@pytest.mark.parametrize("kind", ["dinner plate", "mug", "dinner fork", "wine glass"])
def test_shapes_vary_and_not_only_sizes(kind: str) -> None:
    def unit(seed: int) -> NDArray[np.float64]:
        mesh = make(kind, seed, plan=(0.1, 0.14) if kind == "mug" else (0.1, 0.1)).mesh
        shape: NDArray[np.float64] = mesh.vertices / mesh.vertices[:, 2].max()
        return shape

    shapes = [unit(seed) for seed in range(5)]
    same = [a.shape == b.shape and np.allclose(a, b, atol=1e-4) for a, b in itertools.pairwise(shapes)]
    assert not any(same)


def test_sizes_spread_over_the_usual_range() -> None:
    widths = np.array([drawn_plan(kind_named("dinner plate", ONTOLOGY), seed, ONTOLOGY)[0] for seed in range(300)])
    assert abs(np.median(widths) - 0.27) < 0.008
    assert widths.min() < 0.25 < 0.285 < widths.max()


def test_a_plan_is_kept_to() -> None:
    thing = make("mug", 3, plan=(0.08, 0.115))
    assert extents(thing.mesh)[:2] == pytest.approx([0.08, 0.115])
    assert drawn_plan(kind_named("mug", ONTOLOGY), 3, ONTOLOGY) == pytest.approx(extents(make("mug", 3).mesh)[:2])


@given(st.floats(0, 1))
def test_the_share_below_a_quantile_is_its_share(share: float) -> None:
    extent = Extent(0.1, 0.13, 0.3)
    assert share_below(extent, quantile(extent, share)) == pytest.approx(share, abs=1e-6)


def heights_across(kind: str, at: float) -> NDArray[np.float64]:
    """Return heights along a line across a thing, at a share of its length from the viewer; NaN beside it."""
    mesh = make(kind, 1).mesh
    width, length, _ = extents(mesh)
    x = np.linspace(-0.6 * width, 0.6 * width, 2001)
    return RayCaster([mesh]).tops(np.stack([x, np.full(2001, (at - 0.5) * length)], axis=1))


@pytest.mark.parametrize(("kind", "tines"), [("dinner fork", 4), ("dessert fork", 3)])
def test_a_fork_has_its_tines(kind: str, tines: int) -> None:
    there = np.isfinite(heights_across(kind, 0.93))
    assert np.count_nonzero(np.diff(there.astype(int)) == 1) == tines


def test_a_spoon_is_hollow_and_a_knife_flat() -> None:
    spoon = heights_across("soup spoon", 0.87)
    spoon = spoon[np.isfinite(spoon)]
    assert spoon[len(spoon) // 2] < min(spoon[20], spoon[-20]) - 0.003
    blade = heights_across("dinner knife", 0.75)
    assert np.nanmax(blade) < 0.004


@pytest.mark.parametrize("kind", ["bowl", "mug", "cup", "tumbler", "wine glass", "champagne glass"])
def test_vessels_are_open_above(kind: str) -> None:
    thing = make(kind, 2)
    middle = -thing.size.length / 2 + thing.size.width / 2  # of the body: the handle is farther away
    assert RayCaster([thing.mesh]).tops(np.array([[0.0, middle]]))[0] < 0.65 * thing.size.height


def test_a_mug_has_a_handle_with_a_hole() -> None:
    thing = make("mug", 1)
    width, length, height = extents(thing.mesh)
    y = np.linspace(-length / 2 + width, length / 2, 200)
    sideways = RayCaster([thing.mesh]).cast(
        np.column_stack([np.full(200, 1.0), y, np.full(200, 0.55 * height)]), np.tile([-1.0, 0.0, 0.0], (200, 1))
    )
    assert (sideways.mesh[-5:] == 0).any()
    assert (sideways.mesh == -1).any()


def test_other_kinds_are_cylinders_or_blocks() -> None:
    shapes = {
        kind: form_of(kind_named(kind, ONTOLOGY), ONTOLOGY) for kind in ("candle", "tray", "saucer", "red wine glass")
    }
    assert {kind: (form.name, form.generic) for kind, form in shapes.items()} == {
        "candle": ("cylinder", True),
        "tray": ("block", True),
        "saucer": ("plate", False),
        "red wine glass": ("wine glass", False),
    }
    assert make(None, 0).form.generic


def test_an_unknown_kind_or_a_bad_plan_is_an_error() -> None:
    with pytest.raises(SimulationError, match="no kind of thing called 'sporkle'"):
        make("sporkle", 0)
    with pytest.raises(SimulationError, match="above 0"):
        make("mug", 0, plan=(0.0, 0.1))
