"""Measure fronts in clouds: how often the head or the handle of simulated tableware is found in the right direction.

    python benchmarks/bench_orientation.py
    python benchmarks/bench_orientation.py --noise 2
    python benchmarks/bench_orientation.py --tables 120 --things 0

``--things`` turns each thing at random and lets one depth camera see it alone. ``--tables`` detects the things on
whole tables: place settings, a part of whose things lie the wrong way round, and random tables with pens, combs and
other things without a head. There, things hide parts of each other, and detection cuts or joins some. Half of the
clouds are smoothed as the robot does it. A front is right within 30 degrees of the true direction of the thing with
most of the points; a thing without a head or a handle should have no front. The seeds are apart from those of
``fit_orientation.py``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from records import command_line, figure, recorded, share

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.smoothing import smoothed
from deixis.perception.detection.detect import detect
from deixis.perception.errors import CloudError
from deixis.perception.features.orientation import MIN_PROBABILITY, near, orientation, thinned
from deixis.perception.simulator.cameras.camera import chair_camera
from deixis.perception.simulator.cameras.depth import see
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.laying import Placement, lay
from deixis.perception.simulator.meshes.solids import moved
from deixis.perception.simulator.meshes.tableware import make
from deixis.perception.simulator.scatter import KINDS, scattered

HEADED = (
    *("fork", "dinner fork", "salad fork", "dessert fork", "knife", "dinner knife", "fish knife", "butter knife"),
    *("spoon", "soup spoon", "dessert spoon", "teaspoon"),
)
HANDLED = ("cup", "mug")
ROUND = ("plate", "bowl", "water glass", "wine glass", "champagne glass", "bottle")
ALONE = ("fork", "dessert fork", "knife", "fish knife", "butter knife", "spoon", "soup spoon")
"""Headed things that are measured alone."""

PLAIN = ("pen", "chopstick", "remote control", "comb", "ruler", "salt shaker", "candle", "book")
"""Things of random tables that have neither a head nor a handle."""

FIRST_SEED = 1000
"""Seed of the first thing of each kind, and of the first table."""

RIGHT_WITHIN = np.pi / 6
"""Angle in radians from the true direction up to which a front is right."""

TURNED_AROUND = 0.2
"""Share of the cutlery of place settings that lies the wrong way round."""

SURE = 0.95
"""Minimum probability at which a front counts in grounding and checks."""

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Segment:
    """Thing that was detected on a simulated table.

    Attributes
    ----------
    kind
        Kind of the thing to which most of its points belong; None for the table.
    points, others
        Its thinned points, and those of things near it, in the detected frame of the table.
    truth
        True direction of the head or the handle in this frame, shape (2,).
    """

    kind: str | None
    points: Array
    others: Array
    truth: Array

    def is_right(self, front: tuple[float, float] | Array) -> bool:
        """Return whether a front is that of the thing.

        Parameters
        ----------
        front
            Unit vector in the plane.

        Returns
        -------
        bool
            False for any front of a thing without a head or a handle.
        """
        return self.kind in (*HEADED, *HANDLED) and float(self.truth @ np.array(front)) > np.cos(RIGHT_WITHIN)


def views(kinds: Sequence[str], seeds: range, noise: float) -> Iterator[tuple[str, PointCloud, Array]]:
    """Yield the kind, one view in the frame of the table, and the true direction of its head or handle."""
    for kind in kinds:
        for seed in seeds:
            yaw = float(np.random.default_rng(seed).uniform(0, 2 * np.pi))
            mesh = moved(make(kind, seed=seed).mesh, yaw=yaw)
            (seen,) = views_of(mesh, 1, seed, noise, upright=True)
            yield kind, seen, np.array([-np.sin(yaw), np.cos(yaw)])


def place_settings(seed: int) -> list[Placement]:
    """Return one or two place settings with random things, some of which lie the wrong way round."""
    rng = np.random.default_rng(seed)
    things: list[Placement] = []
    for setting in range(int(rng.integers(1, 3))):

        def put(kind: str, x: float, y: float, yaw: float | None = None, left: float = 0.75 * setting) -> None:
            if yaw is None:
                turn = float(rng.uniform(0, 2 * np.pi))
            else:
                turn = yaw + float(rng.normal(0, 0.09)) + np.pi * (rng.random() < TURNED_AROUND)
            place = left + x + rng.normal(0, 0.004), y + rng.normal(0, 0.008)
            things.append(Placement(f"{kind}_{len(things)}", kind, *place, turn, int(rng.integers(2**31))))

        def sometimes(chance: float) -> bool:
            return bool(rng.random() < chance)

        put("dinner plate", 0.0, 0.0)
        if sometimes(0.4):
            put("bowl", 0.0, 0.0)
        left, right = -0.17, 0.17
        for kind in ("dinner fork", "salad fork")[: rng.integers(1, 3)]:
            put(kind, left, 0.0, 0.0)
            left -= rng.uniform(0.033, 0.06)
        if sometimes(0.5):
            put("napkin", left - 0.06, 0.0, 0.0)
        for kind in ("dinner knife", "soup spoon", "fish knife")[: rng.integers(1, 4)]:
            put(kind, right, 0.0, 0.0)
            right += rng.uniform(0.03, 0.055)
        if sometimes(0.6):
            put("dessert spoon", 0.0, 0.20, np.pi / 2)
        if sometimes(0.5):
            put("dessert fork", 0.0, 0.25, -np.pi / 2)
        if sometimes(0.6):
            put("bread plate", -0.27, 0.22)
            put("butter knife", -0.27, 0.22)
        put(str(rng.choice(["water glass", "wine glass", "champagne glass"])), 0.2, 0.21)
        if sometimes(0.5):
            put("wine glass", 0.29, 0.2)
        if sometimes(0.7):
            put(str(rng.choice(HANDLED)), 0.33, 0.06 if right < 0.3 else 0.3)
        if sometimes(0.3):
            put("bottle", -0.02, 0.38)
        if sometimes(0.5):
            put(str(rng.choice(PLAIN[:4])), 0.05, 0.32)
    return things


def segments(seed: int) -> list[Segment]:
    """Return the things that are detected on a simulated table; none if detection fails."""
    rng = np.random.default_rng([seed, 7])
    things = place_settings(seed) if seed % 2 else scattered(14, seed, (*KINDS, *PLAIN))
    laid = lay(things)
    camera = chair_camera(laid, rng.uniform(0.45, 0.9), rng.uniform(0, 0.25), rng.uniform(-0.7, 0.7))
    cloud = see(laid, camera, seed=seed)
    truth = cloud.labels
    assert truth is not None
    try:
        found = detect(smoothed(cloud) if seed % 4 >= 2 else cloud)
    except CloudError:
        return []
    turn = found.frame[:3, :3] @ camera.pose[:3, :3].T
    seen = found.cloud.points.astype(np.float64) @ found.frame[:3, :3].T + found.frame[:3, 3]
    parts = [found.labels == number for number in range(len(found.boxes))]
    clouds = [thinned(seen[part]) for part in parts]
    result = []
    for part, points in zip(parts, clouds, strict=True):
        owner = int(np.bincount(np.maximum(truth[part], 0)).argmax())
        yaw = things[owner - 1].yaw if owner else 0.0
        way = (turn @ np.array([-np.sin(yaw), np.cos(yaw), 0.0]))[:2]
        if len(points):
            others = near(points, [other for other in clouds if other is not points])
            result.append(Segment(things[owner - 1].kind if owner else None, points, others, way))
    return result


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--things", type=int, default=40, help="number of things of each kind that are seen alone")
    parser.add_argument("--tables", type=int, default=60, help="number of whole tables")
    parser.add_argument("--noise", type=float, default=1.0, help="factor on the noise of the camera for things alone")
    with recorded(parser) as options:
        if options.things:
            measure_alone(range(FIRST_SEED, FIRST_SEED + options.things), options.noise)
        if options.tables:
            measure_tables(range(FIRST_SEED, FIRST_SEED + options.tables))


def measure_alone(seeds: range, noise: float) -> None:
    """Print and record the shares of right, wrong and missing fronts of single things by kind."""
    told, correct = [], []
    print(f"{'':<18}{'right':>8}{'wrong':>8}{'none':>8}")
    for kinds in (ALONE, HANDLED, ROUND):
        for kind in kinds:
            right = wrong = 0
            for _, seen, truth in views([kind], seeds, noise):
                found = orientation(seen.points)
                if found.front is None:
                    continue
                is_right = kinds is not ROUND and float(truth @ found.front) > np.cos(RIGHT_WITHIN)
                right, wrong = right + is_right, wrong + (not is_right)
                told.append(found.confidence)
                correct.append(is_right)
            n = len(seeds)
            print(f"{kind:<18}{right / n:>8.3f}{wrong / n:>8.3f}{(n - right - wrong) / n:>8.3f}")
            if kinds is ROUND:
                share(f"{kind}: no front", n - right - wrong, n)
            else:
                share(f"{kind}: front right", right, n)
                share(f"{kind}: front wrong", wrong, n)
    error = calibration_error(np.array(told), np.array(correct))
    figure("calibration error", error, "share")
    print(f"{np.mean(correct):.3f} of {len(correct)} fronts right, calibration error {error:.3f}")


def measure_tables(seeds: range) -> None:
    """Print and record how many headings of things on whole tables are right, by their probability."""
    told, correct, fronted, known = [], [], 0, 0
    for seed in seeds:
        for segment in segments(seed):
            found = orientation(segment.points, segment.others)
            fronted += segment.kind in (*HEADED, *HANDLED)
            if found.front is not None and found.confidence >= MIN_PROBABILITY:
                is_right = segment.is_right(found.front)
                told.append(found.confidence)
                correct.append(is_right)
                known += is_right and found.confidence >= SURE
    probability, right = np.array(told), np.array(correct)
    for least, most in ((SURE, 1.01), (0.8, SURE), (MIN_PROBABILITY, 0.8)):
        chosen = (probability >= least) & (probability < most)
        print(f"whole tables, probability from {least:g}: {(~right[chosen]).sum()} of {chosen.sum()} headings wrong")
        share(f"whole tables: right from {least:g}", int(right[chosen].sum()), int(chosen.sum()))
    error = calibration_error(probability, right)
    print(f"{known} of {fronted} things with a front have a right heading from {SURE:g}; calibration error {error:.3f}")
    share("whole tables: things with a right, sure heading", known, fronted)
    figure("whole tables: calibration error", error, "share")


def calibration_error(told: Array, correct: NDArray[np.bool_]) -> float:
    """Return the expected calibration error of probabilities, in ten bins."""
    bins, off = np.minimum((told * 10).astype(int), 9), told - correct
    return float(sum(abs(off[bins == k].sum()) for k in range(10)) / max(len(off), 1))


if __name__ == "__main__":
    main()
