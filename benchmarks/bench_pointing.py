"""Measure pointing: which thing simulated teachers point at, from noisy joints, and what a label would be taught to.

    python benchmarks/bench_pointing.py
    python benchmarks/bench_pointing.py --noise 2 --rays

Each table has 3 to 12 things. Each teacher, with a body and a place of their own, points at five things, one gesture
in six at an empty place or between two things. A label is spoken in each hold. The seeds are apart from those of
``fit_pointing.py``.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from records import command_line, figure, recorded, share

from deixis.perception.oriented_box import OrientedBox
from deixis.perception.pointing import aim
from deixis.perception.pointing.gesture import Gesture, gestures
from deixis.perception.scene import PerceivedObject, Scene
from deixis.perception.simulator.teacher import Aim, PointingNoise, Teacher
from deixis.workflows.scenes.point import size_weights

KINDS = {
    "plate": (0.26, 0.26, 0.02),
    "saucer": (0.15, 0.15, 0.02),
    "bowl": (0.16, 0.16, 0.07),
    "mug": (0.09, 0.09, 0.1),
    "glass": (0.07, 0.07, 0.14),
    "bottle": (0.08, 0.08, 0.28),
    "fork": (0.025, 0.2, 0.02),
    "spoon": (0.04, 0.19, 0.02),
    "knife": (0.02, 0.23, 0.01),
    "box": (0.12, 0.08, 0.05),
    "pot": (0.2, 0.2, 0.12),
}
"""Usual extents of table-top things, in metres."""

APART = 0.03
"""Minimum distance between the boxes of two things, in metres."""


def random_table(random: np.random.Generator) -> Scene:
    """Return a table of 1.2 m by 0.8 m with 3 to 12 things, which lie on it at any angle."""
    things: list[PerceivedObject] = []
    wanted = int(random.integers(3, 13))
    for _ in range(1000):
        if len(things) == wanted:
            break
        kind = str(random.choice(list(KINDS)))
        length, width, height = np.array(KINDS[kind]) * random.uniform(0.85, 1.15, 3)
        yaw, (x, y) = random.uniform(0, np.pi), random.uniform((-0.5, -0.3), (0.5, 0.3))
        half = (
            np.array(
                [
                    abs(np.cos(yaw)) * length + abs(np.sin(yaw)) * width,
                    abs(np.sin(yaw)) * length + abs(np.cos(yaw)) * width,
                ]
            )
            / 2
        )
        low, high = np.array([x, y]) - half, np.array([x, y]) + half
        if all(((low - APART > other.maximum[:2]) | (high + APART < other.minimum[:2])).any() for other in things):
            box = OrientedBox((x, y, height / 2), yaw, (length, width, height))
            things.append(
                PerceivedObject(f"o{len(things) + 1}", (*low, 0.0), (*high, height), label=kind, oriented=box)
            )
    return Scene(tuple(things), file="<random table>")


def matched(found: Sequence[Gesture], aims: Sequence[Aim]) -> list[tuple[Gesture, Aim | None]]:
    """Return each true aim with the gesture that overlaps it most in time, and further gestures with None."""
    pairs: list[tuple[Gesture, Aim | None]] = []
    taken: set[int] = set()
    for target in aims:
        both = [
            (min(one.finish, target.finish) - max(one.start, target.start))
            / (max(one.finish, target.finish) - min(one.start, target.start))
            for one in found
        ]
        if both and max(both) > 0:
            taken.add(int(np.argmax(both)))
            pairs.append((found[int(np.argmax(both))], target))
    pairs += [(one, None) for number, one in enumerate(found) if number not in taken]
    return pairs


def main() -> None:
    """Print what a label spoken in each hold would be taught to, beside the nearest thing to each ray."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--gestures", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=0, help="seed of the first table")
    parser.add_argument("--noise", type=float, default=1.0, help="factor of all standard deviations")
    parser.add_argument("--sure", type=float, default=aim.SURE, help="minimum probability of a decided thing")
    parser.add_argument("--no-names", action="store_true", help="leave out the usual sizes of what a name means")
    with recorded(parser) as arguments:
        seed = arguments.first_seed
        right = wrong = refused = missed = empty_taught = empty = extra = extra_taught = 0
        nearest = np.zeros(3, dtype=int)
        probable, hits, spent = [], [], 0.0
        while right + wrong + refused + missed < arguments.gestures:
            random = np.random.default_rng(seed)
            scene = random_table(random)
            teacher = Teacher(scene, seed, PointingNoise().times(arguments.noise))
            targets = [None if random.random() < 1 / 6 else str(random.choice(scene.ids)) for _ in range(5)]
            recording = teacher.points_at(targets)
            started = time.process_time()
            found = gestures(recording.skeletons)
            spent += time.process_time() - started
            pairs = matched(found, recording.aims)
            missed += sum(target.target is not None for target in recording.aims)
            for gesture, target in pairs:
                meant = target.target if target is not None else None
                word = str(scene[meant].label if meant is not None else random.choice(list(KINDS)))
                prior = None if arguments.no_names else size_weights(word, scene)
                answer = aim.pointed_at(gesture, scene, prior=prior, sure=arguments.sure)
                if target is None:
                    extra += 1
                    extra_taught += answer.decided is not None
                elif target.target is None:
                    empty += 1
                    empty_taught += answer.decided is not None
                else:
                    missed -= 1
                    right += answer.decided == target.target
                    wrong += answer.decided not in (None, target.target)
                    refused += answer.decided is None
                    best = next(iter(answer.probabilities))
                    probable.append(answer.probabilities[best])
                    hits.append(best == target.target)
                    nearest += nearest_to_rays(gesture, scene) == target.target
            seed += 1
        total, teachers = right + wrong + refused + missed, seed - arguments.first_seed
        print(f"{total} gestures by {teachers} teachers; noise {arguments.noise:g}, sure from {arguments.sure:g}")
        print(
            f"taught right {right} = {right / total:.3f}, taught wrong {wrong}, refused {refused}, not noticed {missed}"
        )
        print(f"refused or not noticed {(refused + missed) / total:.3f}; most probable thing right {np.mean(hits):.3f}")
        print(f"at an empty place or between things: {empty}, of which something was taught {empty_taught}")
        print(f"holds that are not pointing: {extra}, of which something was taught {extra_taught}")
        for name, value in zip(("eye to fingertip", "forearm", "hand"), nearest / max(len(hits), 1), strict=True):
            print(f"nearest thing to the ray alone, {name}: right {value:.3f}")
        print(f"{spent / teachers:.3f} s a recording")
        share("taught right", right, total)
        share("taught wrong", wrong, total)
        share("refused or not noticed", refused + missed, total)
        share("taught though no thing was meant", empty_taught + extra_taught, empty + extra)
        share("nearest thing to the forearm right", int(nearest[1]), len(hits))
        figure("mean probability of the most probable thing", float(np.mean(probable)), "probability")


def nearest_to_rays(gesture: Gesture, scene: Scene) -> NDArray[np.str_]:
    """Return the id of the thing whose middle each ray misses by the smallest angle, shape (3,)."""
    middles = scene.boxes.mean(axis=1)
    off, _ = aim.misses(gesture, middles)
    angles = np.nan_to_num(np.linalg.norm(off, axis=1), nan=np.inf)
    result: NDArray[np.str_] = np.array(scene.ids)[angles.argmin(axis=0)]
    return result


if __name__ == "__main__":
    main()
