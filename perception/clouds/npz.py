"""Clouds as .npz files: the arrays points and, where they are known, colours, labels, normals and origin.

Points are (n, 3), or (rows, columns, 3) where they are the pixels of an image; the others are shaped alike. Colours are
bytes, or floats from 0 to 1, and may be called colors. Other arrays are passed over.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.columns import as_bytes, labels_of, single
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.npy import read_npz
from deixis.perception.errors import CloudError

ARRAYS = ("points", "colours", "colors", "labels", "normals", "origin")


def read_npz_cloud(content: Content) -> PointCloud:
    """The cloud in a .npz file; raises CloudError, with the array, where it is malformed."""
    arrays = read_npz(content, ARRAYS)
    if "points" not in arrays:
        raise CloudError(f"{content.name}: there is no array 'points'; save it with numpy.savez(file, points=…)")
    points = arrays["points"]
    if points.ndim not in (2, 3) or points.shape[-1] != 3:
        raise CloudError(f"{content.name}: 'points' has shape {points.shape}; it is (n, 3) or (rows, columns, 3)")
    shape = points.shape[:-1]
    colours = _shaped(arrays, "colours", (*shape, 3), content.name)
    if colours is None:
        colours = _shaped(arrays, "colors", (*shape, 3), content.name)
    labels = _shaped(arrays, "labels", shape, content.name)
    normals = _shaped(arrays, "normals", (*shape, 3), content.name)
    origin = _shaped(arrays, "origin", (3,), content.name)
    x, y, z = (0.0, 0.0, 0.0) if origin is None else single(origin).astype(np.float64).tolist()
    return PointCloud(
        single(points).reshape(-1, 3),
        None if colours is None else as_bytes(colours.reshape(-1, 3), content.name),
        None if labels is None else labels_of(labels.reshape(-1), content.name),
        None if normals is None else single(normals).reshape(-1, 3),
        (shape[0], shape[1]) if len(shape) == 2 else None,
        (x, y, z),
    )


def _shaped(
    arrays: dict[str, NDArray[np.generic]], name: str, shape: tuple[int, ...], file: str
) -> NDArray[np.generic] | None:
    found = arrays.get(name)
    if found is not None and found.shape != shape:
        raise CloudError(f"{file}: '{name}' has shape {found.shape}; it is {shape}, to go with the points")
    return found
