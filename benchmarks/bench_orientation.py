"""Measure fronts in clouds: how often the head or the handle of simulated tableware is found in the right direction.

    python benchmarks/bench_orientation.py
    python benchmarks/bench_orientation.py --noise 2

Each thing is turned at random and seen by one depth camera, alone. A front is right within 30 degrees of the true one.
A thing without a head or a handle should have no front. The seeds are apart from those of ``fit_orientation.py``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from records import command_line, figure, recorded, share

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.orientation import orientation
from deixis.perception.simulator.solids import moved
from deixis.perception.simulator.tableware import make
from deixis.perception.simulator.views import views_of

HEADED = ("fork", "dessert fork", "knife", "fish knife", "butter knife", "spoon", "soup spoon")
HANDLED = ("cup", "mug")
ROUND = ("plate", "bowl", "water glass", "wine glass", "champagne glass", "bottle")

FIRST_SEED = 1000
"""Seed of the first thing of each kind."""

RIGHT_WITHIN = np.pi / 6
"""Angle in radians from the true direction up to which a front is right."""


def views(kinds: Sequence[str], seeds: range, noise: float) -> Iterator[tuple[str, PointCloud, NDArray[np.float64]]]:
    """Yield the kind, one view in the frame of the table, and the true direction of its head or handle."""
    for kind in kinds:
        for seed in seeds:
            yaw = float(np.random.default_rng(seed).uniform(0, 2 * np.pi))
            mesh = moved(make(kind, seed=seed).mesh, yaw=yaw)
            (seen,) = views_of(mesh, 1, seed, noise, upright=True)
            yield kind, seen, np.array([-np.sin(yaw), np.cos(yaw)])


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--things", type=int, default=40, help="number of things of each kind")
    parser.add_argument("--noise", type=float, default=1.0, help="factor on the noise of the camera")
    with recorded(parser) as options:
        measure(range(FIRST_SEED, FIRST_SEED + options.things), options.noise)


def measure(seeds: range, noise: float) -> None:
    """Print and record the shares of right, wrong and missing fronts by kind."""
    told, correct = [], []
    print(f"{'':<18}{'right':>8}{'wrong':>8}{'none':>8}")
    for kinds in (HEADED, HANDLED, ROUND):
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
    bins = np.minimum((np.array(told) * 10).astype(int), 9)
    off = np.array(told) - np.array(correct)
    error = sum(abs(off[bins == k].sum()) for k in range(10)) / max(len(off), 1)
    figure("calibration error", float(error), "share")
    print(f"{np.mean(correct):.3f} of {len(correct)} fronts right, calibration error {error:.3f}")


if __name__ == "__main__":
    main()
