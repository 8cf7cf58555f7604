"""Segment by LCCP of the Point Cloud Library (Stein et al. 2014), through a small program built against it.

It is built if the library is installed, and runs with the sanity criterion and otherwise the defaults of the library's
own example.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SOURCE = Path(__file__).with_suffix(".cpp")


def build(folder: Path) -> Path | None:
    """Build the program and return its path; None if the compiler, pkg-config or Debian's libpcl-dev is missing."""
    if not (shutil.which("g++") and shutil.which("pkg-config")):
        return None
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "pcl_segmentation"], capture_output=True, text=True)
    if flags.returncode:
        return None
    program = folder / "lccp_pcl"
    optimised = ["-O3", "-DNDEBUG", "-std=c++17", "-w", "-pthread"]
    subprocess.run(["g++", *optimised, str(SOURCE), "-o", str(program), *flags.stdout.split()], check=True)
    return program


def run(
    program: Path,
    points: NDArray[np.float32],
    colours: NDArray[np.uint8] | None,
    voxel: float = 0.004,
    seed: float = 0.016,
) -> tuple[float, NDArray[np.int64]]:
    """Return seconds of processor time, and the segment of each point (n,), -1 for none."""
    with tempfile.TemporaryDirectory() as name:
        given, found = Path(name) / "cloud", Path(name) / "labels"
        painted = np.full(points.shape, 128, np.uint8) if colours is None else colours
        parts = (np.array([len(points)], np.int32), points.astype(np.float32), painted)
        given.write_bytes(b"".join(np.ascontiguousarray(part).tobytes() for part in parts))
        command = [str(program), str(given), str(found), str(voxel), str(seed)]
        printed = subprocess.run(command, check=True, capture_output=True, text=True)
        labels = np.fromfile(found, np.uint32).astype(np.int64)
    return float(printed.stdout), np.unique(labels, return_inverse=True)[1] - int((labels == 0).any())
