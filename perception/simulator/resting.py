"""How a thing comes to rest on what lies below it: the stiff is lowered until it touches, the soft drapes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.rays import RayCaster
from deixis.perception.simulator.solids import moved

CLEARANCE = 0.0002
"""Metres that are left between things that touch, for what lies between the places where heights are compared."""

STEP = 0.002
"""Metres between these places, beside the vertices of both."""

PlanBox = tuple[NDArray[np.float64], NDArray[np.float64]]
"""The least and the greatest corner (2,) in the plan."""


def overlap_in_plan(box: PlanBox, other: PlanBox) -> bool:
    """Whether two boxes of the plan overlap."""
    return bool((box[0] < other[1]).all() and (other[0] < box[1]).all())


def plan_box(mesh: Mesh) -> PlanBox:
    """The box around a mesh, seen from above."""
    return mesh.vertices[:, :2].min(axis=0), mesh.vertices[:, :2].max(axis=0)


def lowered(mesh: Mesh, below: Sequence[Mesh]) -> Mesh:
    """A stiff thing that stands on z = 0, raised so far that it rests on whatever lies below it, level as it is."""
    if not below:
        return mesh
    lower, upper = RayCaster(below), RayCaster([mesh])
    plan = _places([mesh, *below], *plan_box(mesh))
    overlap = lower.tops(plan) - upper.bottoms(plan)
    overlap = overlap[np.isfinite(overlap)]
    return moved(mesh, by=(0.0, 0.0, max(float(overlap.max()) + CLEARANCE, 0.0))) if len(overlap) else mesh


def draped(mesh: Mesh, below: Sequence[Mesh], cell: float) -> Mesh:
    """A soft thing that lies on z = 0, laid over whatever lies below it: each vertex is raised by what is under it.

    No edge of the mesh may be longer in the plan than ``cell`` (metres) times the root of 2. What is under a vertex
    is the highest place within that distance on each axis, so that no face cuts into what it lies on.
    """
    from scipy.ndimage import map_coordinates, maximum_filter

    if not below:
        return mesh
    fine = cell / 2
    reach = int(np.ceil(np.sqrt(2) * cell / fine)) + 1
    low, high = plan_box(mesh)
    axes = [np.arange(low[axis] - reach * fine, high[axis] + reach * fine, fine) for axis in (0, 1)]
    x, y = np.meshgrid(*axes, indexing="ij")
    heights = np.nan_to_num(RayCaster(below).tops(np.column_stack([x.ravel(), y.ravel()])), nan=0.0).reshape(x.shape)
    _raise_to_vertices(heights, below, low=np.array([axes[0][0], axes[1][0]]), fine=fine)
    under = maximum_filter(np.maximum(heights, 0.0), size=2 * reach + 1)
    at = [(mesh.vertices[:, axis] - axes[axis][0]) / fine for axis in (0, 1)]
    raised = map_coordinates(under, at, order=1, mode="nearest")
    lift = np.column_stack([0 * raised, 0 * raised, raised + CLEARANCE * (raised > 0)])
    return Mesh(mesh.vertices + lift, mesh.faces)


def _raise_to_vertices(
    heights: NDArray[np.float64], meshes: Sequence[Mesh], low: NDArray[np.float64], fine: float
) -> None:
    """Raises a grid of heights to the vertices nearest to its points: a rim between the points is not missed."""
    for mesh in meshes:
        cell = np.rint((mesh.vertices[:, :2] - low) / fine).astype(np.int64)
        there = ((cell >= 0) & (cell < heights.shape)).all(axis=1)
        np.maximum.at(heights, (cell[there, 0], cell[there, 1]), mesh.vertices[there, 2])


def _places(meshes: Sequence[Mesh], low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """A grid over a part of the plan, and the vertices in it."""
    axes = [np.linspace(low[axis], high[axis], int((high[axis] - low[axis]) / STEP) + 2) for axis in (0, 1)]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    vertices = np.concatenate([mesh.vertices[:, :2] for mesh in meshes])
    inside = ((vertices >= low) & (vertices <= high)).all(axis=1)
    return np.concatenate([grid, vertices[inside]])
