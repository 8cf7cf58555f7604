"""Measurements of meshes for the tests of the simulator, independent of the simulator's code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.open3d import open3d


def is_closed(mesh: Mesh) -> bool:
    """Return whether each edge belongs to exactly two faces, once in each direction."""
    a, b, c = mesh.faces.T
    start, end, n = (
        np.concatenate([a, b, c]).astype(np.int64),
        np.concatenate([b, c, a]).astype(np.int64),
        len(mesh.vertices),
    )
    there, back = np.sort(start * n + end), np.sort(end * n + start)
    return bool((there == back).all() and (np.diff(there) > 0).all())


def volume(mesh: Mesh) -> float:
    """Compute the volume by the divergence theorem; below 0 where faces are turned inwards."""
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def scene_of(mesh: Mesh) -> object:
    core, t = open3d().core, open3d().t
    scene = t.geometry.RaycastingScene()
    scene.add_triangles(core.Tensor(mesh.vertices.astype(np.float32)), core.Tensor(mesh.faces.astype(np.uint32)))
    return scene


def inside(points: NDArray[np.floating], mesh: Mesh) -> NDArray[np.bool_]:
    """Mark the points inside a mesh, by Open3D's occupancy (a vote of three rays)."""
    core = open3d().core
    query = core.Tensor(np.ascontiguousarray(points, dtype=np.float32))
    found: NDArray[np.bool_] = scene_of(mesh).compute_occupancy(query, nsamples=3).numpy() > 0.5  # type: ignore[attr-defined]
    return found


def distances(points: NDArray[np.floating], mesh: Mesh) -> NDArray[np.float32]:
    """Compute the distances from points to the surface of a mesh, by Open3D."""
    core = open3d().core
    query = core.Tensor(np.ascontiguousarray(points, dtype=np.float32))
    found: NDArray[np.float32] = scene_of(mesh).compute_distance(query).numpy()  # type: ignore[attr-defined]
    return found


def surface_points(mesh: Mesh, count: int, seed: int = 0) -> NDArray[np.float64]:
    """Sample points evenly over a surface, and add all of its vertices."""
    rng = np.random.default_rng(seed)
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    face = rng.choice(len(areas), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return np.concatenate([mesh.vertices, a[face] + u * (b - a)[face] + v * (c - a)[face]])


def boxes_within(a: Mesh, b: Mesh, gap: float) -> bool:
    """Return whether the boxes of two meshes are at most ``gap`` metres apart along each axis."""
    (low, high), (other_low, other_high) = ((m.vertices.min(axis=0), m.vertices.max(axis=0)) for m in (a, b))
    return bool((low <= other_high + gap).all() and (other_low <= high + gap).all())


def deepest(a: Mesh, b: Mesh) -> float:
    """Compute how deep the surface of one mesh reaches into the other, in metres; 0 where they are apart."""
    found = 0.0
    if not boxes_within(a, b, 0.0):
        return found
    for this, other in ((a, b), (b, a)):
        points = surface_points(this, 3000)
        low, high = other.vertices.min(axis=0), other.vertices.max(axis=0)
        points = points[((points >= low) & (points <= high)).all(axis=1)]
        if len(points):
            within = points[inside(points, other)]
            found = max(found, float(distances(within, other).max()) if len(within) else 0.0)
    return found
