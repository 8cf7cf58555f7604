"""Time spin images beside the Point Cloud Library's: 500 keypoints of a bottle, four densities, by threads; describers.

Both are timed in turn from points and normals to images, their search structures included; times are medians, ratios
those of medians. Without the library (Debian: libpcl-dev) only our own times are printed. ``--quick`` takes few runs.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from common import medians
from numpy.typing import NDArray
from peers import spin_images_pcl
from records import command_line, ratio, recorded, seconds

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.descriptors.spin_images import spin_images
from deixis.perception.features.points.blocks import available
from deixis.perception.features.points.normals import estimate_normals
from deixis.perception.features.registry import DESCRIBERS, describer_named

SUPPORT = 0.08
KEYPOINTS = 500
SIZES = (4_054, 5_000, 15_000, 45_000)

Cloud = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int64]]
"""Points and normals (n, 3), keypoints (k,)."""

VARIANTS: dict[str, dict[str, Any]] = {
    "rectangular": {},
    "support angle": {"support_angle_cos": 0.5},
    "angular": {"angular": True},
    "radial": {"radial": True},
}


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--quick", action="store_true", help="few runs")
    with recorded(parser) as options:
        rounds = 3 if options.quick else 15
        with tempfile.TemporaryDirectory() as folder:
            program = spin_images_pcl.build(Path(folder))
            if program is None:
                print(
                    "the Point Cloud Library is not installed (Debian: libpcl-dev); our own times only", file=sys.stderr
                )
            print(f"{KEYPOINTS} keypoints, support {SUPPORT} m, {available()} processors; medians of {rounds} rounds")
            print("points  threads     ours        PCL  ratio")
            for size in SIZES:
                cloud = bottle(size)
                for threads in (1, 2):
                    _compare(program, cloud, threads, rounds)
            _describers(bottle(SIZES[0])[0], rounds)
            if program is not None:
                _differences(program, bottle(SIZES[0]))


def bottle(n: int, seed: int = 0) -> Cloud:
    """Return the side of a bottle, 24 cm high and 8 cm across, facing a camera a metre away; normals; keypoints."""
    rng = np.random.default_rng(seed)
    height, angle = rng.uniform(0, 0.24, n), rng.uniform(-1.45, 1.45, n)
    radius = np.interp(height, [0, 0.14, 0.18, 0.24], [0.04, 0.04, 0.014, 0.014])
    points = np.column_stack([radius * np.sin(angle), height, 1.0 - radius * np.cos(angle)])
    points += rng.normal(0, 5e-4, points.shape)
    measured = points.astype(np.float32)
    normals = estimate_normals(measured, neighbours=20)
    return measured, normals, np.linspace(0, n - 1, KEYPOINTS).astype(np.int64)


def _compare(program: Path | None, cloud: Cloud, threads: int, rounds: int) -> None:
    ours, theirs = [], []
    for turn in range(rounds + 1):
        started = time.perf_counter()
        spin_images(*cloud, support=SUPPORT, threads=threads)
        ours += [time.perf_counter() - started] if turn else []
        if program is not None:
            theirs += spin_images_pcl.run(program, *cloud, SUPPORT, threads=threads)[0]
    mine = statistics.median(ours)
    line = f"{len(cloud[0]):6}  {threads:7}  {1e3 * mine:6.1f} ms"
    seconds(f"{len(cloud[0]):,} points, {threads} threads", mine)
    if theirs:
        ratio(f"{len(cloud[0]):,} points, {threads} threads", statistics.median(theirs), mine, "PCL")
        peer = statistics.median(theirs)
        line += f"  {1e3 * peer:6.1f} ms  {peer / mine:5.1f}"
    print(line, flush=True)


def _describers(points: NDArray[np.float32], rounds: int) -> None:
    print(f"\none view of {len(points)} points, defaults, normals and keypoints included")
    for name in DESCRIBERS:
        describe, cloud = describer_named(name).describe, PointCloud(points)
        taken = medians(partial(describe, cloud), runs=rounds)[0]
        print(f"{name:11} {1e3 * taken:6.1f} ms  {describe(cloud).shape}")


def _differences(program: Path, cloud: Cloud) -> None:
    print("\nlargest difference in a bin from PCL, which computes in single precision")
    for name, options in VARIANTS.items():
        theirs = spin_images_pcl.run(program, *cloud, SUPPORT, **options)[1]
        apart = np.abs(spin_images(*cloud, support=SUPPORT, **options) - theirs).max(axis=1)
        print(f"{name:14} {apart.max():.1e}; {int((apart > 1e-6).sum())} of {len(apart)} images by more than 1e-6")


if __name__ == "__main__":
    main()
