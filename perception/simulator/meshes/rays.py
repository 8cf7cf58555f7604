"""Ray casting against meshes, by Open3D (Embree)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.open3d import open3d


@dataclass(frozen=True, eq=False)
class Hits:
    """First hits of r rays; distances are in lengths of the ray's direction, and infinite without a hit."""

    distance: NDArray[np.float32]  # (r,)
    mesh: NDArray[np.int32]  # (r,): number of the mesh, -1 for none
    normals: NDArray[np.float32]  # (r, 3): unit vectors; either side of a face may be meant


class RayCaster:
    """Ray caster for several meshes, which are numbered in order."""

    def __init__(self, meshes: Sequence[Mesh]) -> None:
        core = open3d().core
        self._tensor: Any = core.Tensor
        self._scene: Any = open3d().t.geometry.RaycastingScene()
        for mesh in meshes:
            vertices = core.Tensor(np.ascontiguousarray(mesh.vertices, dtype=np.float32))
            self._scene.add_triangles(vertices, core.Tensor(np.ascontiguousarray(mesh.faces, dtype=np.uint32)))

    def cast(self, origins: NDArray[np.floating], directions: NDArray[np.floating]) -> Hits:
        """Return the first hit of every ray.

        Parameters
        ----------
        origins
            Start of each ray, shape (r, 3), or one start for all, shape (3,).
        directions
            Direction of each ray, shape (r, 3).

        Returns
        -------
        Hits
            Distance, mesh and normal for each ray.
        """
        rays = np.empty((len(directions), 6), dtype=np.float32)
        rays[:, :3], rays[:, 3:] = origins, directions
        found = self._scene.cast_rays(self._tensor(rays))
        mesh = found["geometry_ids"].numpy().astype(np.int64)
        none = mesh == self._scene.INVALID_ID
        return Hits(
            distance=found["t_hit"].numpy(),
            mesh=np.where(none, -1, mesh).astype(np.int32),
            normals=found["primitive_normals"].numpy(),
        )

    def tops(self, plan: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height of the top of the meshes at places in plan.

        Parameters
        ----------
        plan
            Places of shape (p, 2), in metres.

        Returns
        -------
        ndarray
            Heights of shape (p,), in metres; NaN where there is no mesh.
        """
        return self._vertical(plan, start=10.0, down=True)

    def bottoms(self, plan: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height of the bottom of the meshes at places in plan.

        Parameters
        ----------
        plan
            Places of shape (p, 2), in metres.

        Returns
        -------
        ndarray
            Heights of shape (p,), in metres; NaN where there is no mesh.
        """
        return self._vertical(plan, start=-10.0, down=False)

    def _vertical(self, plan: NDArray[np.float64], start: float, down: bool) -> NDArray[np.float64]:
        origins = np.column_stack([plan, np.full(len(plan), start)])
        hits = self.cast(origins, np.tile([0.0, 0.0, -1.0 if down else 1.0], (len(plan), 1)))
        distance = hits.distance.astype(np.float64)
        height = start - distance if down else start + distance
        return np.where(hits.mesh < 0, np.nan, height)
