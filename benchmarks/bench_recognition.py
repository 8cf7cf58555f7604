"""Recognition: time beside a kd-tree per view and plain matrix products, recall, and calibration, on simulated views.

Views are of 16 kinds of tableware, targets of other things of the same kinds; every method gives D_C for each category.
Set OPENBLAS_NUM_THREADS=1 to measure one core. ``--quick`` takes 1,000 views only, else 10,000 too; ``--random`` adds
descriptors that are evenly random, the case in which bounds tell nothing. ``--calibration`` measures only that.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np
from common import medians
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from deixis.perception.features.registry import describer_named
from deixis.perception.recognition.calibration import expected_calibration_error
from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.index import Nearest, ViewIndex, indexes_of
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.recogniser import DEFAULT, Recogniser
from deixis.perception.recognition.views import PackedViews
from deixis.perception.simulator.tableware import make
from deixis.perception.simulator.views import views_of

KINDS = (
    *("dinner plate", "bowl", "cup", "mug", "glass", "water glass", "wine glass", "champagne glass"),
    *("dinner fork", "dessert fork", "dinner knife", "butter knife", "dessert spoon", "soup spoon", "napkin", "bottle"),
)
EACH = 8
"""Views of one thing."""

FIRST_TARGET = 10_000
"""The seed of the first thing that is only ever a target."""

Descriptors = NDArray[np.float32]
Methods = dict[str, Callable[[Descriptors], list[float]]]


def described(kind: str, things: range, each: int = EACH) -> Iterator[tuple[str, Descriptors]]:
    """Views of things of a kind, by the thing's seed and the view's number."""
    describe = describer_named("spin_images").describe
    for thing in things:
        for number, view in enumerate(views_of(make(kind, seed=thing).mesh, each, seed=thing)):
            yield f"{kind} {thing} {number}", describe(view)


def blocked(target: Descriptors, pack: PackedViews, block: int = 2_000) -> float:
    """D_C by matrix products of a block of descriptors at a time, and the least of each view's rows."""
    best, first = np.inf, 0
    wanted = np.square(target).sum(axis=1)
    while first < len(pack):
        last = max(first + 1, int(np.searchsorted(pack.starts, pack.starts[first] + block, side="right")) - 1)
        low, high = pack.starts[first], pack.starts[last]
        products = pack.descriptors[low:high] @ target.T
        products *= -2
        products += pack.squares[low:high, None]
        least = np.minimum.reduceat(products, pack.starts[first:last] - low, axis=0)
        best = min(best, float(np.sqrt(np.maximum(least + wanted, 0)).mean(axis=1).min()))
        first = last
    return best


def methods(packs: Sequence[PackedViews], indexes: Sequence[ViewIndex], trees: bool) -> Methods:
    """Each gives D_C of every category for a target."""

    def ours(target: Descriptors, exact: bool) -> list[float]:
        seen, reduced = Target.of(target), indexes[0].reduction(target)
        found: list[Nearest] = [index.nearest(seen, reduced, None if exact else DEFAULT.effort) for index in indexes]
        return [near.distance for near in found]

    named: Methods = {
        "exact": lambda target: ours(target, True),
        "approximate": lambda target: ours(target, False),
        "matrix products": lambda target: [blocked(target, pack) for pack in packs],
    }
    if trees:
        grown = [[cKDTree(pack[i]) for i in range(len(pack))] for pack in packs]
        named["kd-tree per view"] = lambda target: [
            min(float(tree.query(target)[0].mean()) for tree in category) for category in grown
        ]
    return named


def compare(packs: Sequence[PackedViews], targets: Sequence[Descriptors], trees: bool) -> None:
    """Prints the median over targets of each method's time, and the recall of the approximate one."""
    started = time.perf_counter()
    indexes = [index for index in indexes_of(packs) if index is not None]
    built = time.perf_counter() - started
    jobs = methods(packs, indexes, trees)
    views, descriptors = sum(map(len, packs)), sum(len(pack.descriptors) for pack in packs)
    size = statistics.mean(map(len, targets))
    print(f"\n{views} views, {descriptors} descriptors; targets of {size:.0f}; index made in {built:.2f} s")
    each = [medians(*(partial(job, target) for job in jobs.values()), runs=1) for target in targets]
    taken = {name: statistics.median(times) for name, times in zip(jobs, zip(*each, strict=True), strict=True)}
    for name, median in taken.items():
        print(f"{name:17} {1e3 * median:8.1f} ms   {taken['matrix products'] / median:5.1f} times matrix products")
    exact, found, plain = (
        np.array([jobs[name](target) for target in targets]) for name in ("exact", "approximate", "matrix products")
    )
    labels = (exact.argmin(axis=1) == found.argmin(axis=1)).mean()
    print(f"approximate: recall of D_C {(exact == found).mean():.4f}, of the nearest category {labels:.4f}")
    print(f"largest difference of exact from matrix products: {np.abs(exact - plain).max():.1e}", flush=True)


def calibration(things: int = 6, each: int = 3) -> None:
    """Prints how calibrated probabilities are, on things never seen; a quarter of the kinds is unknown in turn."""
    categories = {kind: InstanceCategory.of(kind, described(kind, range(things), each)) for kind in KINDS}
    fresh = [(k, view) for k in KINDS for _, view in described(k, range(FIRST_TARGET, FIRST_TARGET + 3), each)]
    objects = {key: key.rsplit(" ", 1)[0] for category in categories.values() for key in category.views.ids}
    print(
        f"\ncalibration: {things} things of {len(KINDS)} kinds, {each} views of each; 3 other things of each as targets"
    )
    for said, groups in (("views held out", None), ("things held out", objects)):
        rows = [row for fold in range(4) for row in _answers(categories, fresh, fold, groups)]
        confidence, right, unknown, nd = (np.array(column) for column in zip(*rows, strict=True))
        error, auroc = expected_calibration_error(confidence, right), _auroc(nd[~unknown], nd[unknown])
        print(
            f"{said:16} expected calibration error {error:.3f}; answers right {right.mean():.3f}, mean confidence"
            f" {confidence.mean():.3f}; unknown told from known: AUROC {auroc:.3f}"
        )


def _answers(
    categories: dict[str, InstanceCategory],
    fresh: Sequence[tuple[str, Descriptors]],
    fold: int,
    objects: dict[str, str] | None,
) -> Iterator[tuple[float, bool, bool, float]]:
    """Confidence, whether right, whether unknown, and ND; as many unknown targets as known ones, as the prior says."""
    hidden = set(KINDS[fold::4])
    known = Recogniser.of([category for kind, category in categories.items() if kind not in hidden]).calibrated(objects)
    for kind, view in fresh:
        found, unknown = known.recognise(view), kind in hidden
        right = found.label == (None if unknown else kind)
        row = (found.probability, right, unknown, found.candidates[0].normalised)
        yield from [row] * (3 if unknown else 1)


def _auroc(known: NDArray[np.float64], unknown: NDArray[np.float64]) -> float:
    return float(((known[:, None] < unknown) + 0.5 * (known[:, None] == unknown)).mean())


def main() -> None:
    if "--calibration" not in sys.argv:
        targets = [view for kind in KINDS for _, view in described(kind, range(FIRST_TARGET, FIRST_TARGET + 1), 1)]
        for things in (8,) if "--quick" in sys.argv else (8, 79):
            packs = [PackedViews.of(described(kind, range(things))) for kind in KINDS]
            compare(packs, targets, trees=things == 8)
        if "--random" in sys.argv:
            rng = np.random.default_rng(0)
            packs = [
                PackedViews.of((str(i), rng.random((100, 153), np.float32)) for i in range(100)) for _ in range(10)
            ]
            compare(packs, [rng.random((100, 153), np.float32) for _ in range(9)], trees=False)
    calibration()


if __name__ == "__main__":
    main()
