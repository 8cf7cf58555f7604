"""Compare detection with LCCP (Point Cloud Library) and clustering above a plane, on real and simulated tables.

``mosd-tabletop`` (DEIXIS_DATA): the share of true segments of at least 200 points that are found one to one at an
intersection over union above 0.5, and the share of whole objects, some of which have several true segments. The
simulator: the share of the 12 things of a formal setting that are found in this way, and the share found with the box's
centre, as seen from above, within a centimetre of the true one; and hard cases (``hard_tables.py``). Seconds are of
processor time. ``--seeds N`` simulates N tables (50), from seed 0 or ``--first`` on; ``--hard N`` as many of each hard
case (4); ``--quick`` two and one. ``--single N`` instead shows detection N views of each of 22 generated single things,
and of each mesh of ``tabletop-meshes``, without a table. LCCP is built against the library if that is installed
(Debian: libpcl-dev).
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import hard_tables
import numpy as np
from common import data_folder
from hard_tables import CASES, LAYOUT, LEAST
from numpy.typing import NDArray
from peers import lccp_pcl
from records import command_line, mean, recorded, share

from deixis.experiments.open_ended.things import FOLDER, listed_meshes
from deixis.grammar.layout.parser import read_layout
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.detection.detect import detect
from deixis.perception.detection.shown import Shows
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes import tableware
from deixis.perception.simulator.meshes.blocks import block
from deixis.perception.simulator.meshes.size import Size
from deixis.workflows.layouts.lay_table import lay_script
from deixis.workflows.scenes.simulate import Simulation, simulate

LCCP_HEIGHT = 0.005
"""Minimum height in metres above the plane of the points given to LCCP: with less, pieces of the table remain."""
CLOSE = 0.01
Labels = NDArray[np.integer]
Found = tuple[Labels, NDArray[np.float64], float]
"""The result of detection.

It holds the number of its thing for each point, the middles (k, 3) of the things in the cloud's frame, and the seconds
of processor time.
"""

Method = Callable[[PointCloud], Found]


REST = 0.2
"""Seconds before the clock starts, as threads of BLAS that made the cloud spin for a tenth of a second afterwards."""


def ours(cloud: PointCloud) -> Found:
    time.sleep(REST)
    started = time.process_time()
    found = detect(cloud)
    taken = time.process_time() - started
    back = np.linalg.inv(found.frame)
    return found.labels, found.boxes.mean(axis=1) @ back[:3, :3].T + back[:3, 3], taken


def without_image(cloud: PointCloud) -> Found:
    """Detect things in the bare points in random order, so that no image tells which points are neighbours."""
    order = np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite))
    found, middles, taken = ours(cloud.take(order))
    labels = np.full(len(cloud), -1, np.int64)
    labels[order] = found
    return labels, middles, taken


def above_plane(cloud: PointCloud, height: float) -> NDArray[np.intp]:
    """Return the points that are higher than ``height`` metres above the largest plane (RANSAC), (k,)."""
    import open3d

    kept = np.flatnonzero(cloud.finite)
    points = cloud.points[kept].astype(np.float64)
    open3d.utility.random.seed(0)
    o3d = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    plane = np.array(o3d.segment_plane(0.01, 3, 1000)[0])
    heights = points @ plane[:3] + plane[3]
    heights *= np.sign(plane[3]) or 1.0  # the camera, at the origin, is above the table
    above: NDArray[np.intp] = kept[heights > height]
    return above


def middles_of(cloud: PointCloud, labels: Labels) -> NDArray[np.float64]:
    boxes = [cloud.points[labels == k] for k in range(int(labels.max()) + 1)]
    return np.array([(thing.min(axis=0) + thing.max(axis=0)) / 2 for thing in boxes]).reshape(-1, 3)


def clustering(voxel: float, gap: float) -> Method:
    """Return the usual tabletop detector: RANSAC's largest plane, and clusters above it (Open3D's DBSCAN)."""

    def found(cloud: PointCloud) -> Found:
        import open3d

        started = time.process_time()
        above = above_plane(cloud, voxel)
        points = cloud.points[above].astype(np.float64)
        cells, of = np.unique(np.floor(points / voxel).astype(np.int64), axis=0, return_inverse=True)
        of = of.ravel()
        sums = np.stack([np.bincount(of, points[:, axis]) for axis in range(3)], axis=1)
        middles = sums / np.bincount(of, minlength=len(cells))[:, None]
        grouped = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(middles)).cluster_dbscan(gap, 1)
        labels = np.full(len(cloud), -1, np.int64)
        labels[above] = np.array(grouped)[of]
        taken = time.process_time() - started
        return labels, middles_of(cloud, labels), taken

    return found


def lccp(program: Path) -> Method:
    """Return the detector by RANSAC's largest plane and LCCP above it."""

    def found(cloud: PointCloud) -> Found:
        started = time.process_time()
        above = above_plane(cloud, LCCP_HEIGHT)
        plane_taken = time.process_time() - started
        colours = None if cloud.colours is None else cloud.colours[above]
        taken, segments = lccp_pcl.run(program, cloud.points[above], colours)
        labels = np.full(len(cloud), -1, np.int64)
        labels[above] = segments
        return labels, middles_of(cloud, labels), plane_taken + taken

    return found


def methods(folder: Path) -> dict[str, Method]:
    """Return the methods to compare, by name; LCCP if it can be built."""
    found: dict[str, Method] = {"detect": ours, "detect, no image": without_image}
    program = lccp_pcl.build(folder)
    if program is None:
        print("the Point Cloud Library is not installed (Debian: libpcl-dev): LCCP was not run", file=sys.stderr)
    else:
        found["plane, LCCP"] = lccp(program)
    found["cluster 5mm/2cm"] = clustering(0.005, 0.02)
    found["cluster 3mm/1cm"] = clustering(0.003, 0.01)
    return found


def matched(labels: Labels, truth: Labels, wanted: list[int]) -> dict[int, int]:
    """Return the found thing of each true one: one to one, with an intersection over union above 0.5."""
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


def real_scenes(folder: Path, compared: dict[str, Method]) -> None:
    print("mosd-tabletop: true segments found at IoU > 0.5, of those with 200 points; processor seconds\n")
    print(f"{'scene':8}" + "".join(f"{name:>26}" for name in compared))
    rows: dict[str, list[tuple[float, float, int, int, float]]] = {name: [] for name in compared}
    for path in sorted(folder.glob("*.pcd")):
        cloud = read_cloud(path)
        assert cloud.labels is not None
        objects = np.where(cloud.labels >= 20, cloud.labels // 10, 0)  # segments of one object share it
        wanted, whole = _large(cloud.labels, 20), _large(objects, 2)
        line = f"{path.stem:8}"
        for name, method in compared.items():
            labels, middles, taken = method(replace(cloud, labels=None))
            found = len(matched(labels, cloud.labels, wanted))
            of_objects = len(matched(labels, objects, whole)) / len(whole)
            rows[name].append((found / len(wanted), of_objects, found, len(middles), taken))
            line += f"{found:8}/{len(wanted)} of {len(middles):3} {taken:5.2f} s"
        print(line, flush=True)
    for name, row in rows.items():
        mean(f"Kinect scenes, {name}: segments found", [one[0] for one in row])
        mean(f"Kinect scenes, {name}: whole objects found", [one[1] for one in row])
    for place, what in enumerate(("segments, mean", "objects, mean", "segments", "reported", "median seconds")):
        columns = [np.array(row)[:, place] for row in rows.values()]
        fold = (np.mean, np.mean, np.sum, np.sum, np.median)[place]
        print(f"{what:15}" + "".join(f"{fold(column):19.3f}       " for column in columns))


def _large(truth: Labels, least: int) -> list[int]:
    """Return the numbers from ``least`` on that label at least ``LEAST`` points."""
    return [int(k) for k in np.unique(truth) if k >= least and (truth == k).sum() >= LEAST]


def simulated(seeds: range, compared: dict[str, Method]) -> None:
    print(f"\n{len(seeds)} simulated formal settings: things found, and found within 1 cm; wholly right tables\n")
    totals = {name: np.zeros(4) for name in compared}
    for seed in seeds:
        look = simulate(lay_script(read_layout(LAYOUT), seed, cloth=bool(seed % 2)), seed=seed)
        for name, method in compared.items():
            labels, middles, taken = method(replace(look.cloud, labels=None))
            found, placed, count = _right(look, labels, middles)
            totals[name] += (found, placed, placed == count, taken)
    things = len(seeds) * len(look.truth.objects)
    for name, total in totals.items():
        each = total / (things, things, len(seeds), len(seeds))
        share(f"simulated settings, {name}: objects placed within 1 cm", int(total[1]), things)
        rates = f"found {each[0]:6.1%}  placed {each[1]:6.1%}  whole tables {each[2]:4.0%}"
        print(f"{name:16} {rates}  {each[3]:5.2f} s")


def hard_cases(count: int, compared: dict[str, Method]) -> None:
    print(f"\n{count} of each hard case: things of {LEAST} points found at IoU > 0.5; greatest processor seconds\n")
    print(f"{'case':24}" + "".join(f"{name:>22}" for name in compared))
    for name, make in CASES.items():
        cases = [make(seed) for seed in range(count)]
        line = f"{name:24}"
        for method in compared.values():
            looks = [method(replace(case.cloud, labels=None)) for case in cases]
            found = sum(
                len(matched(labels, _truth(case.cloud), case.wanted))
                for case, (labels, _, _) in zip(cases, looks, strict=True)
            )
            slowest = max((taken for _, _, taken in looks), default=0.0)
            line += f"{found:9}/{sum(len(case.wanted) for case in cases):<4} {slowest:5.2f} s"
        print(line, flush=True)


def odd_clouds(seed: int) -> None:
    """Print the seconds for clouds unlike any table, as they are and as bare points in random order."""
    print("\nodd clouds of 307,200 points: processor seconds, as they are and as bare points; detected kind\n")
    for name, cloud in hard_tables.odd_clouds(seed).items():
        order = np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite))
        line = f"{name:44}"
        for each in (cloud, cloud.take(order)):
            started = time.process_time()
            found = detect(each)
            line += f"{time.process_time() - started:7.2f} s {found.shows:8}"
        print(line, flush=True)


def single_things(views: int, seed: int) -> None:
    """Print what detection takes views of single things for, from random directions: generated, and of other makers."""
    sizes = [Size(0.04, 0.04, 0.02), Size(0.1, 0.1, 0.05), Size(0.2, 0.12, 0.02), Size(0.3, 0.18, 0.02)]
    made = [(f"block of {100 * one.width:g} cm", block(one, np.random.default_rng(seed))) for one in sizes]
    made += [(name, tableware.make(name, seed=seed).mesh) for name in tableware.FORMS]
    print_verdicts("generated", made, views, seed)
    folder = data_folder(FOLDER)
    if folder is not None:
        print_verdicts("other makers'", [(name, mesh) for _, name, mesh in listed_meshes(folder)], views, seed)


def print_verdicts(kind: str, things: list[tuple[str, Mesh]], views: int, seed: int) -> None:
    """Print how many views of things are taken as one object, as a table or as something else, and of which things."""
    taken: Counter[str] = Counter()
    wrong: dict[str, Counter[str]] = {}
    for number, (name, mesh) in enumerate(things):
        for cloud in views_of(mesh, views, seed=seed + number):
            found = detect(cloud)
            verdict = str(found.shows) if found.shows is not Shows.OBJECT or len(found.boxes) == 1 else "pieces"
            taken[verdict] += 1
            if verdict != Shows.OBJECT:
                wrong.setdefault(name, Counter())[verdict] += 1
    total = taken.total()
    print(f"{total} views of {len(things)} {kind} things, taken as: {dict(taken.most_common())}", flush=True)
    for name, verdicts in wrong.items():
        print(f"    {name}: {dict(verdicts)}")
    share(f"views of {kind} single things taken as one object", taken[Shows.OBJECT], total)


def _truth(cloud: PointCloud) -> Labels:
    assert cloud.labels is not None
    return cloud.labels


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
    parser = command_line(__file__, __doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--hard", type=int, default=4, help="number of tables of each hard case")
    parser.add_argument("--single", type=int, metavar="N", help="only N views of each of many single things")
    parser.add_argument("--quick", action="store_true")
    with recorded(parser) as given:
        if given.single is not None:
            single_things(given.single, given.first)
            return
        folder = data_folder("mosd-tabletop")
        with tempfile.TemporaryDirectory() as built:
            compared = methods(Path(built))
            if folder is not None:
                detect(read_cloud(next(folder.glob("*.pcd"))))  # compiles
                real_scenes(folder, compared)
            simulated(range(given.first, given.first + (2 if given.quick else given.seeds)), compared)
            hard_cases(
                1 if given.quick else given.hard,
                {name: method for name, method in compared.items() if not name.startswith("cluster")},
            )
            odd_clouds(given.first)


if __name__ == "__main__":
    main()
