"""Detection beside plane plus Euclidean clustering: real scenes with per-point truth, and simulated formal settings.

``mosd-tabletop`` (DEIXIS_DATA): the share of true segments of at least 200 points that are found at an intersection
over union above 0.5, one to one. The simulator: the share of the 12 things of a formal setting that are found in this
way, and that are found with the box's centre, as seen from above, within a centimetre of the truth's. ``--seeds N``
simulates N tables (50), from seed 0 or ``--first`` on; ``--quick`` two.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from common import data_folder
from numpy.typing import NDArray

from deixis.grammar.parser import read_script
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.detection.detect import detect
from deixis.workflows.lay_table import lay_script
from deixis.workflows.simulate import Simulation, simulate

LEAST = 200
CLOSE = 0.01
LAYOUT = Path(__file__).parent.parent / "examples" / "formal_dinner.layout"

Labels = NDArray[np.integer]
Found = tuple[Labels, NDArray[np.float64]]
"""The number of its thing for each point, and the middles (k, 3) of the things in the cloud's frame."""


def ours(cloud: PointCloud) -> Found:
    found = detect(cloud)
    back = np.linalg.inv(found.frame)
    return found.labels, found.boxes.mean(axis=1) @ back[:3, :3].T + back[:3, 3]


def without_image(cloud: PointCloud) -> Found:
    """The same of the bare points in another order: it is not said which of them are next to each other."""
    order = np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite))
    found, middles = ours(cloud.take(order))
    labels = np.full(len(cloud), -1, np.int64)
    labels[order] = found
    return labels, middles


def clustering(voxel: float, gap: float) -> Callable[[PointCloud], Found]:
    """The tabletop detector's method: RANSAC's largest plane, and what is above it in clusters (Open3D's DBSCAN)."""

    def found(cloud: PointCloud) -> Found:
        import open3d

        kept = np.flatnonzero(cloud.finite)
        points = cloud.points[kept].astype(np.float64)
        open3d.utility.random.seed(0)
        o3d = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        plane = np.array(o3d.segment_plane(0.01, 3, 1000)[0])
        heights = points @ plane[:3] + plane[3]
        heights *= np.sign(plane[3]) or 1.0  # the camera, at the origin, is above the table
        above = np.flatnonzero(heights > voxel)
        cells, of = np.unique(np.floor(points[above] / voxel).astype(np.int64), axis=0, return_inverse=True)
        of = of.ravel()
        sums = np.stack([np.bincount(of, points[above][:, axis]) for axis in range(3)], axis=1)
        middles = sums / np.bincount(of, minlength=len(cells))[:, None]
        grouped = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(middles)).cluster_dbscan(gap, 1)
        labels = np.full(len(cloud), -1, np.int64)
        labels[kept[above]] = np.array(grouped)[of]
        boxes = [cloud.points[labels == k] for k in range(int(labels.max()) + 1)]
        return labels, np.array([(thing.min(axis=0) + thing.max(axis=0)) / 2 for thing in boxes]).reshape(-1, 3)

    return found


METHODS: dict[str, Callable[[PointCloud], Found]] = {
    "detect": ours,
    "detect, no image": without_image,
    "cluster 5mm/2cm": clustering(0.005, 0.02),
    "cluster 3mm/1cm": clustering(0.003, 0.01),
}


def matched(labels: Labels, truth: Labels, wanted: list[int]) -> dict[int, int]:
    """The found thing for each true one with an intersection over union above 0.5, which no two can share."""
    sizes = np.bincount(labels[labels >= 0], minlength=1)
    result = {}
    for thing in wanted:
        of = truth == thing
        inside = labels[of & (labels >= 0)]
        if len(inside):
            counts = np.bincount(inside, minlength=len(sizes))
            overlap = counts / (of.sum() + sizes - counts)
            if overlap.max() > 0.5:
                result[thing] = int(overlap.argmax())
    return result


def real_scenes(folder: Path) -> None:
    print("mosd-tabletop: true segments found at IoU > 0.5, of those with 200 points; seconds\n")
    print(f"{'scene':8}" + "".join(f"{name:>26}" for name in METHODS))
    shares: dict[str, list[float]] = {name: [] for name in METHODS}
    for path in sorted(folder.glob("*.pcd")):
        cloud = read_cloud(path)
        assert cloud.labels is not None
        wanted = [int(k) for k in np.unique(cloud.labels) if k >= 20 and (cloud.labels == k).sum() >= LEAST]
        line = f"{path.stem:8}"
        for name, method in METHODS.items():
            started = time.perf_counter()
            labels, middles = method(replace(cloud, labels=None))
            taken = time.perf_counter() - started
            found = len(matched(labels, cloud.labels, wanted))
            shares[name].append(found / len(wanted))
            line += f"{found:8}/{len(wanted)} of {len(middles):3} {taken:5.2f} s"
        print(line, flush=True)
    print("mean    " + "".join(f"{np.mean(share):26.3f}" for share in shares.values()))


def simulated(seeds: range) -> None:
    print(f"\n{len(seeds)} simulated formal settings: things found, and found within 1 cm; wholly right tables\n")
    totals = {name: np.zeros(4) for name in METHODS}
    for seed in seeds:
        look = simulate(lay_script(read_script(LAYOUT), seed, cloth=bool(seed % 2)), seed=seed)
        for name, method in METHODS.items():
            started = time.perf_counter()
            found, placed, count = _right(look, *method(replace(look.cloud, labels=None)))
            totals[name] += (found, placed, placed == count, time.perf_counter() - started)
    things = len(seeds) * len(look.truth.objects)
    for name, total in totals.items():
        share = total / (things, things, len(seeds), len(seeds))
        rates = f"found {share[0]:6.1%}  placed {share[1]:6.1%}  whole tables {share[2]:4.0%}"
        print(f"{name:16} {rates}  {share[3]:5.2f} s")


def _right(look: Simulation, labels: Labels, middles: NDArray[np.float64]) -> tuple[int, int, int]:
    truth = look.cloud.labels
    assert truth is not None
    matches = matched(labels, truth, list(range(1, len(look.truth.objects) + 1)))
    placed = 0
    for thing, number in matches.items():
        there = look.camera.to_table(middles[number : number + 1])[0, :2]
        away = float(np.linalg.norm(there - look.truth.boxes[thing - 1, :, :2].mean(axis=0)))
        placed += away < CLOSE
    return len(matches), placed, len(look.truth.objects)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--quick", action="store_true")
    given = parser.parse_args()
    folder = data_folder("mosd-tabletop")
    if folder is not None:
        detect(read_cloud(next(folder.glob("*.pcd"))))  # compiles
        real_scenes(folder)
    simulated(range(given.first, given.first + (2 if given.quick else given.seeds)))


if __name__ == "__main__":
    main()
