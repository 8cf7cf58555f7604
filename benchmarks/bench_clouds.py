"""Time reading a cloud of 307,200 coloured points, an image of 640 by 480, beside Open3D's readers of the same files.

The readers take turns in one run. Open3D has two, and the ratio is to the faster one. The points are those of a table
scene if DEIXIS_DATA is set, otherwise of a wavy surface with a fifth of the points missing. Numbers in text have up to
nine digits.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from common import data_folder, medians
from records import command_line, ratio, recorded

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud

WAYS = [
    *((".pcd", encoding) for encoding in ("ascii", "binary", "binary_compressed")),
    *((".ply", encoding) for encoding in ("ascii", "binary")),
]


def surface() -> PointCloud:
    rng = np.random.default_rng(7)
    v, u = np.mgrid[:480, :640]
    z = 1 + 0.1 * np.sin(u / 40) * np.cos(v / 30) + rng.normal(0, 0.001, u.shape)
    points = np.stack([(u - 319.5) * z / 525, (v - 239.5) * z / 525, z], axis=-1).astype(np.float32).reshape(-1, 3)
    points[rng.random(len(points)) < 0.2] = np.nan
    return PointCloud(points, rng.integers(0, 256, (len(points), 3), np.uint8), organised=(480, 640))


def scene() -> PointCloud:
    folder = data_folder("mosd-tabletop")
    if folder is None:
        return surface()
    found = read_cloud(folder / "test54.pcd")
    return PointCloud(found.points, found.colours, organised=found.organised)


def measure(folder: Path, cloud: PointCloud) -> None:
    import open3d

    for suffix, encoding in WAYS:
        file = folder / f"cloud{suffix}"
        write_cloud(file, cloud, encoding)
        name = str(file)
        ours, legacy, tensor = medians(
            lambda file=file: read_cloud(file),  # type: ignore[misc]
            lambda name=name: open3d.io.read_point_cloud(name, remove_nan_points=False),  # type: ignore[misc]
            lambda name=name: open3d.t.io.read_point_cloud(name),  # type: ignore[misc]
            runs=5,
        )
        best = min(legacy, tensor)
        ratio(f"{suffix[1:].upper()} {encoding}, the faster of two readers", best, ours, "open3d-cpu")
        print(
            f"{suffix[1:].upper()} {encoding:<18} {file.stat().st_size / 2**20:5.1f} MiB  deixis {ours * 1e3:6.1f} ms"
            f"   open3d {legacy * 1e3:6.1f} ms, tensor {tensor * 1e3:6.1f} ms   {best / ours:5.1f} times as fast"
        )


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        try:
            import open3d  # noqa: F401
        except ImportError as error:
            print(f"skipped: Open3D is not installed ({error})", file=sys.stderr)
            return
        with tempfile.TemporaryDirectory() as folder:
            measure(Path(folder), scene())


if __name__ == "__main__":
    main()
