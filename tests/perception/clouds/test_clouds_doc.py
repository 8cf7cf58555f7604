"""Check docs/reference/clouds.md: its Python runs, and it quotes every column and the errors correctly."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import TEXT, read_cloud, write_cloud
from deixis.perception.clouds.depth import read_intrinsics
from deixis.perception.clouds.tables.columns import KNOWN
from deixis.perception.errors import CloudError

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "clouds.md").read_text(encoding="utf-8")
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
FACES = "element face 18\nproperty list uchar int vertex_index\nend_header\n"


def test_the_python_on_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_cloud("table.pcd", PointCloud(np.zeros((6, 3), np.float32), organised=(2, 3)))
    header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    Path("cup.ply").write_text(header + FACES.replace("18", "1") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    programs = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert len(programs) == 2
    for program in programs:
        exec(compile(program, "docs/reference/clouds.md", "exec"), {})
    assert len(read_cloud("table.ply")) == 6


def test_the_page_names_all_columns_suffixes_and_a_valid_camera(tmp_path: Path) -> None:
    assert {name for name in KNOWN | TEXT if f"`{name}`" not in PAGE} == set()
    (camera,) = re.findall(r"```json\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "camera.json").write_text(camera)
    assert read_intrinsics(tmp_path / "camera.json").depth_scale == 1000


def test_the_page_quotes_the_errors_correctly(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("cup.pcd").write_text(
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
        "POINTS 3\nDATA ascii\n"
    )
    header = "ply\nformat ascii 1.0\nelement vertex 98\nproperty float x\nproperty float y\nproperty float z\n"
    Path("cup.ply").write_text(header + FACES + "0 0 0\n" * 98 + "3 0 1 2\n" * 17 + "3 0 1 99\n")
    for name in ("cup.pcd", "cup.ply"):
        with pytest.raises(CloudError) as raised:
            read_cloud(name)
        assert str(raised.value) in PAGE
