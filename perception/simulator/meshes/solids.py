"""Build closed meshes: solids of revolution, skins over rings and thick sheets.

Faces are counter-clockwise as seen from outside.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deixis.perception.clouds.mesh import Mesh

SEGMENTS = 96
"""Number of sides of a round thing."""


def revolved(profile: Sequence[tuple[float, float]], segments: int = SEGMENTS) -> Mesh:
    """Return the solid that a profile sweeps around the z axis.

    Parameters
    ----------
    profile
        Pairs of radius and height. They run counter-clockwise, from the axis (radius 0) below outwards and back to the
        axis above, so that the solid lies on their left.
    segments
        Number of sides of each ring.

    Returns
    -------
    Mesh
        Closed mesh with ``segments`` vertices for each inner point of the profile, and one for each end.

    Raises
    ------
    ValueError
        If an end is not on the axis, or another point is.

    Examples
    --------
    >>> revolved([(0, 0), (1, 0), (1, 2), (0, 2)], segments=4).vertices.shape
    (10, 3)
    """
    points = np.asarray(profile, dtype=np.float64)
    if points[0, 0] != 0 or points[-1, 0] != 0 or (points[1:-1, 0] <= 0).any():
        raise ValueError("a profile must have its ends, and no other points, on the axis")
    angles = 2 * np.pi * np.arange(segments) / segments
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = np.empty((len(points) - 2, segments, 3))
    rings[..., :2] = points[1:-1, 0, None, None] * around
    rings[..., 2] = points[1:-1, 1, None]
    return ringed(rings, first=(0.0, 0.0, points[0, 1]), last=(0.0, 0.0, points[-1, 1]))


def ringed(rings: NDArray[np.float64], first: ArrayLike | None = None, last: ArrayLike | None = None) -> Mesh:
    """Return a skin over closed rings, closed at both ends by a fan.

    Parameters
    ----------
    rings
        Rings of k points each, shape (s, k, 3), counter-clockwise as seen from where the last one lies.
    first, last
        Tips of the fans, shape (3,); without them the ends are flat.

    Returns
    -------
    Mesh
        Closed mesh with s * k + 2 vertices.
    """
    count, sides, _ = rings.shape
    tips = [rings[0].mean(axis=0) if first is None else first, rings[-1].mean(axis=0) if last is None else last]
    vertices = np.concatenate([rings.reshape(-1, 3), np.asarray(tips, dtype=np.float64)])
    here = np.arange(sides)
    beside = (here + 1) % sides
    base = sides * np.arange(count - 1)[:, None]
    a, b, c, d = base + here, base + beside, base + sides + beside, base + sides + here
    skin = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)]).reshape(-1, 3)
    bottom, top = count * sides, count * sides + 1
    end = (count - 1) * sides
    below = np.stack([np.full(sides, bottom), beside, here], axis=1)
    above = np.stack([np.full(sides, top), end + here, end + beside], axis=1)
    return Mesh(vertices, np.concatenate([skin, below, above]).astype(np.int32))


def tube(path: NDArray[np.float64], width: ArrayLike, depth: ArrayLike, sides: int = 16) -> Mesh:
    """Return a bar of elliptic section along a path in the plane x = 0.

    Parameters
    ----------
    path
        Points of shape (s, 3), in metres.
    width
        Diameter along x in metres; one for all points or one for each, shape (s,).
    depth
        Diameter across the path in the plane x = 0, in metres; one for all points or one for each, shape (s,).
    sides
        Number of sides of each ring.

    Returns
    -------
    Mesh
        Closed mesh.
    """
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack([np.zeros(len(path)), along[:, 2], -along[:, 1]], axis=1)
    angles = 2 * np.pi * np.arange(sides) / sides
    wide, deep = (np.broadcast_to(np.asarray(side, dtype=np.float64), len(path)) / 2 for side in (width, depth))
    rings = path[:, None] + deep[:, None, None] * np.sin(angles)[None, :, None] * across[:, None]
    rings[..., 0] += wide[:, None] * np.cos(angles)
    return ringed(rings)


def thick_sheet(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    bottom: NDArray[np.float64],
    top: NDArray[np.float64],
    cells: NDArray[np.bool_] | None = None,
) -> Mesh:
    """Return the solid between two surfaces over one grid in plan, such as cutlery or cloth.

    Parameters
    ----------
    x, y
        Places in plan, shape (rows, columns). x must grow with the column and y with the row, or else the faces point
        inwards.
    bottom, top
        Heights of the two surfaces, shape (rows, columns).
    cells
        Mask of the cells that exist, shape (rows - 1, columns - 1); by default all.

    Returns
    -------
    Mesh
        Closed mesh, with walls where cells end.

    Examples
    --------
    >>> x, y = np.meshgrid([0.0, 1.0], [0.0, 1.0])
    >>> len(thick_sheet(x, y, 0 * x, 0 * x + 1).faces)
    12
    """
    rows, columns = x.shape
    index = np.arange(rows * columns).reshape(rows, columns)
    there = np.ones((rows - 1, columns - 1), dtype=np.bool_) if cells is None else cells
    a, b, c, d = (part[there] for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    upper = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    edges = np.concatenate([np.stack(pair, axis=1) for pair in ((a, b), (b, c), (c, d), (d, a))])
    n = rows * columns
    found: NDArray[np.bool_] = np.isin(edges[:, 0] * n + edges[:, 1], edges[:, 1] * n + edges[:, 0])
    border = edges[~found]
    below = rows * columns
    walls = [
        np.stack([border[:, 0] + below, border[:, 1] + below, border[:, 1]], axis=1),
        np.stack([border[:, 0] + below, border[:, 1], border[:, 0]], axis=1),
    ]
    vertices = np.concatenate([np.stack([x, y, z], axis=-1).reshape(-1, 3) for z in (top, bottom)])
    faces = np.concatenate([upper, upper[:, ::-1] + below, *walls])
    used, renumbered = np.unique(faces, return_inverse=True)
    return Mesh(vertices[used], renumbered.reshape(faces.shape).astype(np.int32))


def smooth_curve(stations: NDArray[np.float64], nodes: Mapping[float, float]) -> NDArray[np.float64]:
    """Interpolate between nodes along curves that do not overshoot.

    Parameters
    ----------
    stations
        Places of shape (s,).
    nodes
        Value at each of some places, which ascend.

    Returns
    -------
    numpy.ndarray
        Values of shape (s,), in the unit of those of the nodes.

    Notes
    -----
    Piecewise cubic Hermite interpolation of Fritsch and Butland (1984), :class:`scipy.interpolate.PchipInterpolator`.
    """
    from scipy.interpolate import PchipInterpolator

    values: NDArray[np.float64] = PchipInterpolator(list(nodes), list(nodes.values()))(stations)
    return values


def joined(*meshes: Mesh) -> Mesh:
    """Return several meshes as one; inner faces stay where they overlap.

    Parameters
    ----------
    meshes
        Meshes, at least one.

    Returns
    -------
    Mesh
        Mesh with all vertices and faces.
    """
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def fitted(mesh: Mesh, width: float, length: float, height: float) -> Mesh:
    """Return the mesh scaled to given extents; its box is centred on the z axis and stands on z = 0.

    Parameters
    ----------
    mesh
        Mesh to scale.
    width, length, height
        Extents along x, y and z, in metres.

    Returns
    -------
    Mesh
        Mesh with equal faces.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    unit = (mesh.vertices - low) / np.where(high > low, high - low, 1.0)
    return Mesh((unit - (0.5, 0.5, 0.0)) * (width, length, height), mesh.faces)


def moved(mesh: Mesh, yaw: float = 0.0, by: ArrayLike = (0.0, 0.0, 0.0)) -> Mesh:
    """Return the mesh turned about the z axis, then shifted.

    Parameters
    ----------
    mesh
        Mesh to move.
    yaw
        Angle in radians, counter-clockwise from above.
    by
        Shift of shape (3,), in metres.

    Returns
    -------
    Mesh
        Mesh with equal faces.
    """
    cosine, sine = _turn(yaw)
    turned = mesh.vertices @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return Mesh(turned + np.asarray(by, dtype=np.float64), mesh.faces)


def _turn(yaw: float) -> tuple[float, float]:
    """Return cosine and sine; exact for quarter turns, so that a fitted mesh stays in its box."""
    quarters = yaw / (np.pi / 2)
    if abs(quarters - round(quarters)) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarters) % 4]
    return float(np.cos(yaw)), float(np.sin(yaw))
