"""Fit how far the rays of an arm miss what a person points at, to simulated teachers, and write the shipped model.

    python benchmarks/fit_pointing.py --write

The seeds are apart from those of ``bench_pointing.py``. Prints the spread of each ray alone.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from bench_pointing import matched, random_table
from numpy.typing import NDArray

from deixis.perception.pointing import aim
from deixis.perception.pointing.gesture import Gesture, gestures
from deixis.perception.simulator.teacher import Teacher

FIRST_SEED = 1_000_000
"""Seed of the first teacher; those of the benchmark are smaller."""

RAYS = ("eye to fingertip", "forearm", "hand")
Array = NDArray[np.float64]


def samples(teachers: int) -> tuple[list[Gesture], Array]:
    """Return simulated gestures, and the places that they aim at."""
    found, places = [], []
    for seed in range(FIRST_SEED, FIRST_SEED + teachers):
        random = np.random.default_rng(seed)
        scene = random_table(random)
        recording = Teacher(scene, seed).points_at(list(random.choice(scene.ids, 5)))
        for gesture, target in matched(gestures(recording.skeletons), recording.aims):
            if target is not None:
                found.append(gesture)
                places.append(target.place)
    return found, np.array(places)


def fitted(taken: list[Gesture], places: Array) -> aim.AimModel:
    """Return the model of greatest likelihood: covariances of angles and of places, and the vertical bias."""
    from scipy.optimize import minimize

    rows = [aim.misses(gesture, place[None]) for gesture, place in zip(taken, places, strict=True)]
    off = np.concatenate([row[0] for row in rows])
    scale = 1 / (np.concatenate([row[1] for row in rows]) ** 2 + aim.NEAR**2)
    noise = np.array([np.diag(gesture.scatter**2) for gesture in taken])
    lower = np.tril_indices(3)

    def unpacked(numbers: Array) -> aim.AimModel:
        roots = np.zeros((4, 3, 3))
        for root, part in zip(roots, numbers[:24].reshape(4, 6), strict=True):
            root[lower] = part
        spread = roots @ roots.transpose(0, 2, 1) + 1e-7 * np.eye(3)
        return aim.AimModel(spread[:2], spread[2:] * 0.01, np.stack([np.zeros(3), numbers[24:]]))

    def loss(numbers: Array) -> float:
        model = unpacked(numbers)
        total, log_det = np.zeros(len(off)), np.zeros(len(off))
        for axis in (0, 1):
            spread = model.angles[axis] + noise + scale[:, None, None] * model.places[axis]
            rest = off[:, axis] - model.bias[axis]
            total += np.einsum("ki,ki->k", rest, np.linalg.solve(spread, rest[..., None])[..., 0])
            log_det += np.linalg.slogdet(spread)[1]
        return float(np.mean(log_det / 2 + (aim.TAIL + 6) / 2 * np.log1p(total / aim.TAIL)))

    start = np.zeros(27)
    for part in range(4):
        start[6 * part + np.array([0, 2, 5])] = 0.1
    return unpacked(minimize(loss, start, method="L-BFGS-B", options={"maxfun": 20_000}).x)


def main() -> None:
    """Fit the model, print the spreads, and write it with ``--write``."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--teachers", type=int, default=250)
    parser.add_argument("--write", action="store_true", help="write perception/pointing/aim.json")
    arguments = parser.parse_args()
    taken, places = samples(arguments.teachers)
    model = fitted(taken, places)
    print(f"{len(taken)} gestures")
    for number, ray in enumerate(RAYS):
        near = [np.degrees(np.sqrt(model.angles[axis, number, number])) for axis in (0, 1)]
        off = [1000 * np.sqrt(model.places[axis, number, number]) for axis in (0, 1)]
        bias = np.degrees(model.bias[1, number])
        print(
            f"{ray}: {near[0]:.1f} and {near[1]:.1f} degrees, {off[0]:.0f} and {off[1]:.0f} mm; bias {bias:.1f} degrees"
        )
    if arguments.write:
        file = Path(aim.__file__).with_name("aim.json")
        file.write_text(json.dumps(model.to_dict()) + "\n", encoding="utf-8")
        print(f"wrote {file.name}")


if __name__ == "__main__":
    main()
