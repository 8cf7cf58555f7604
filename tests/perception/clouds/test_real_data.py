"""Real files: complete, and equal to what Open3D reads."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.clouds.mesh_file import read_mesh

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif("DEIXIS_DATA" not in os.environ, reason="DEIXIS_DATA, the folder of reference data, is not set"),
]


def folder(name: str) -> Path:
    return Path(os.environ["DEIXIS_DATA"]) / name


def test_table_scenes_are_organised_with_labels_and_colours() -> None:
    files = sorted(folder("mosd-tabletop").glob("*.pcd"))
    assert len(files) == 10
    for file in files:
        cloud = read_cloud(file)
        assert cloud.organised == (480, 640)
        assert cloud.colours is not None and cloud.labels is not None
        # Its README assigns label 0 to the points without depth.
        np.testing.assert_array_equal(cloud.labels == 0, ~cloud.finite)


def test_single_objects_and_tutorial_clouds_agree_with_open3d() -> None:
    open3d = pytest.importorskip("open3d")
    files = [
        file
        for name in ("kasaei-good", "pcl-tutorials")
        for suffix in ("pcd", "ply")
        for file in sorted(folder(name).rglob(f"*.{suffix}"))
    ]
    assert len(files) >= 20
    for file in files:
        cloud = read_cloud(file)
        theirs = open3d.io.read_point_cloud(str(file), remove_nan_points=False)
        np.testing.assert_array_equal(cloud.points, np.asarray(theirs.points).astype(np.float32))
        if cloud.colours is not None:
            np.testing.assert_array_equal(cloud.colours, np.rint(np.asarray(theirs.colors) * 255))


def test_meshes_have_the_number_of_faces_in_their_index() -> None:
    root = folder("tabletop-meshes")
    with (root / "index.csv").open(newline="") as index:
        rows = list(csv.DictReader(index))
    assert len(rows) >= 74
    for row in rows:
        mesh = read_mesh(root / row["file"])
        assert (len(mesh.vertices), len(mesh.faces)) == (int(row["vertices"]), int(row["faces"]))
        extents = np.ptp(mesh.vertices, axis=0)
        np.testing.assert_allclose(extents, [float(row[f"ext_{axis}"]) for axis in "xyz"], rtol=1e-3, atol=1e-4)
    (setting,) = (root / "place_setting").glob("*.obj")
    assert any("fork" in name for name in read_mesh(setting).names)
