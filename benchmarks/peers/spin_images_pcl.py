"""Compute spin images by the Point Cloud Library, through a small program built against it if it is installed."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SOURCE = Path(__file__).with_suffix(".cpp")
BINS = 153


def build(folder: Path) -> Path | None:
    """Build the program and return its path; None if the compiler, pkg-config or Debian's libpcl-dev is missing."""
    if not (shutil.which("g++") and shutil.which("pkg-config")):
        return None
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "pcl_features"], capture_output=True, text=True)
    if flags.returncode:
        return None
    program = folder / "spin_images_pcl"
    optimised = ["-O3", "-DNDEBUG", "-DPCL_NO_PRECOMPILE", "-std=c++17", "-w", "-pthread"]
    command = ["g++", *optimised, str(SOURCE), "-o", str(program), *flags.stdout.split()]
    subprocess.run(command, check=True)
    return program


def run(
    program: Path,
    points: NDArray[np.float32],
    normals: NDArray[np.float32],
    keypoints: NDArray[np.int64],
    support: float,
    *,
    width: int = 8,
    support_angle_cos: float = 0.0,
    radial: bool = False,
    angular: bool = False,
    threads: int = 1,
    runs: int = 1,
) -> tuple[list[float], NDArray[np.float32]]:
    """Return the seconds of each run, the search tree included, and the images (k, bins)."""
    with tempfile.TemporaryDirectory() as name:
        given, found = Path(name) / "cloud", Path(name) / "images"
        counts = np.array([len(points), len(keypoints)], np.int32)
        parts = (counts, points, normals, keypoints.astype(np.int32))
        given.write_bytes(b"".join(part.tobytes() for part in parts))
        settings = [width, support, support_angle_cos, int(radial), int(angular), threads, runs]
        command = [str(program), str(given), str(found), *map(str, settings)]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        images = np.fromfile(found, np.float32).reshape(-1, BINS)
    return [float(line) for line in printed.split()], images[:, : (width + 1) * (2 * width + 1)]
