"""Measure recognition on simulated views: processor time beside kd-trees and matrix products, recall, calibration.

Views are of 16 kinds of tableware, with spin images and with the upright descriptors by which ``deixis recognise``
compares views of a table; targets are other things of the same kinds; every method gives D_C for each category. A
kd-tree is built per view. "Matrix products" is the straightforward way: products of blocks in single precision, and a
compiled minimum. Set OPENBLAS_NUM_THREADS=1 to measure one core. ``--quick`` takes 1,000 views only, otherwise 10,000
too; ``--random`` takes as many of uniformly random descriptors instead, in memory and mapped from files, the case in
which bounds exclude nothing. ``--calibration`` measures only that, ``--constants`` the shipped numbers
(``PRIOR_SPREADS``, ``SHIPPED``), and ``--tables`` how well things found on laid tables are named.
"""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from records import command_line, figure, ratio, recorded, share
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

from deixis.examples_data import example
from deixis.grammar.layout.parser import parse_script
from deixis.learning.views import views as recognising
from deixis.learning.views.views import known_by
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.descriptors.form import PARTS, form_parts
from deixis.perception.features.registry import DESCRIBERS, describer_named
from deixis.perception.recognition.calibration import auroc, expected_calibration_error
from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.index import Nearest, ViewIndex, indexes_of
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.joint import JointRecogniser
from deixis.perception.recognition.settings import DEFAULT, MIN_LABEL_PROBABILITY, PAPER, RecognitionSettings
from deixis.perception.recognition.views import PackedViews, open_views, write_views
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes.tableware import make
from deixis.workflows.grounding.ground import ground
from deixis.workflows.layouts.lay_table import lay_script
from deixis.workflows.scenes.perceive import perceive
from deixis.workflows.scenes.simulate import simulate

KINDS = (
    *("dinner plate", "bowl", "cup", "mug", "glass", "water glass", "wine glass", "champagne glass"),
    *("dinner fork", "dessert fork", "dinner knife", "butter knife", "dessert spoon", "soup spoon", "napkin", "bottle"),
)
EACH = 8
"""Number of views of one thing."""

FIRST_TARGET = 10_000
"""Seed of the first thing that is only ever a target."""

SHAPES: recognising.Comparison = (recognising.UPRIGHT, recognising.FORM)
"""Descriptors by which views of a table are compared if they have no colours."""

Descriptors = NDArray[np.float32]
Describe = Callable[[PointCloud], Descriptors]
SPIN_IMAGES: Describe = describer_named("spin_images").describe
Methods = dict[str, Callable[[Descriptors], list[float]]]


def described(
    kind: str, things: range, each: int = EACH, describe: Describe = SPIN_IMAGES
) -> Iterator[tuple[str, Descriptors]]:
    """Yield views of things of a kind, by the thing's seed and the view's number."""
    for thing in things:
        for number, view in enumerate(views_of_thing(kind, thing, each)):
            yield f"{kind} {thing} {number}", describe(view)


def views_of_thing(kind: str, thing: int, each: int) -> list[PointCloud]:
    """Return views of one thing of a kind, in the table's frame."""
    return views_of(make(kind, seed=thing).mesh, each, seed=thing, upright=True)


def blocked(target: Descriptors, pack: PackedViews, block: int = 2_000) -> float:
    """Compute D_C by matrix products of a block of descriptors at a time, and the least of each view's."""
    best, first = np.inf, 0
    columns, wanted = -2 * target.T, np.square(target).sum(axis=1)
    while first < len(pack):
        last = max(first + 1, int(np.searchsorted(pack.starts, pack.starts[first] + block, side="right")) - 1)
        low, high = pack.starts[first], pack.starts[last]
        products = pack.descriptors[low:high] @ columns
        best = min(best, nearest(products, pack.squares[low:high], pack.starts[first : last + 1] - low, wanted))
        first = last
    return best


@njit(cache=True, error_model="numpy", fastmath={"nnan", "nsz"})
def nearest(products, squares, starts, wanted):  # type: ignore[no-untyped-def]
    """Return the least mean distance from -2 t.v (n, q), |v|^2 (n,) and |t|^2 (q,); ``starts`` separates views."""
    best = np.inf
    least = np.empty(len(wanted), np.float32)
    for view in range(len(starts) - 1):
        least[:] = np.inf
        for k in range(starts[view], starts[view + 1]):
            for t in range(len(wanted)):
                least[t] = min(least[t], products[k, t] + squares[k])
        best = min(best, np.sqrt(np.maximum(least + wanted, np.float32(0))).mean())
    return best


def methods(packs: Sequence[PackedViews], indexes: Sequence[ViewIndex], trees: bool) -> Methods:
    """Return the methods; each gives D_C of every category for a target."""

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


def processor_time(job: Callable[[Descriptors], object], target: Descriptors) -> float:
    """Return the processor seconds of the second run of a job, which other programs affect little."""
    job(target)
    started = time.process_time()
    job(target)
    return time.process_time() - started


def compare(packs: Sequence[PackedViews], targets: Sequence[Descriptors], trees: bool) -> None:
    """Print the median over targets of each method's time, and the recall of the approximate one."""
    started = time.perf_counter()
    indexes = [index for index in indexes_of(packs) if index is not None]
    exactly = time.perf_counter() - started
    files = [index.filed for index in indexes]
    built = time.perf_counter() - started - exactly
    jobs = methods(packs, indexes, trees)
    views, descriptors = sum(map(len, packs)), sum(len(pack.descriptors) for pack in packs)
    size = statistics.mean(map(len, targets))
    print(f"\n{views} views, {descriptors} descriptors; targets of {size:.0f}")
    lists = sum(len(file.centres) for file in files)
    print(f"index made in {exactly:.2f} s; {lists} lists for approximate search in {built:.2f} s more")
    each = [[processor_time(job, target) for job in jobs.values()] for target in targets]
    taken = {name: statistics.median(times) for name, times in zip(jobs, zip(*each, strict=True), strict=True)}
    for name, median in taken.items():
        if name in ("exact", "approximate"):
            ratio(
                f"{views} views of {size:.0f} descriptors, {name}", taken["matrix products"], median, "matrix products"
            )
        print(f"{name:17} {1e3 * median:8.1f} ms   {taken['matrix products'] / median:5.1f} times matrix products")
    exact, found, plain = (
        np.array([jobs[name](target) for target in targets]) for name in ("exact", "approximate", "matrix products")
    )
    labels = (exact.argmin(axis=1) == found.argmin(axis=1)).mean()
    print(f"approximate: recall of D_C {(exact == found).mean():.4f}, of the nearest category {labels:.4f}")
    print(f"largest difference of exact from matrix products: {np.abs(exact - plain).max():.1e}", flush=True)


def simulated(things: int, describe: Describe) -> None:
    """Compare on ``things`` things of every kind, and one more of each as a target."""
    targets = [
        view for kind in KINDS for _, view in described(kind, range(FIRST_TARGET, FIRST_TARGET + 1), 1, describe)
    ]
    compare([PackedViews.of(described(kind, range(things), describe=describe)) for kind in KINDS], targets, things == 8)


def random(each: int) -> None:
    """Compare on ten categories of ``each`` random views, in memory, and then mapped from files."""
    rng = np.random.default_rng(0)
    targets = [rng.random((100, 153), np.float32) for _ in range(9)]
    views = [[(str(i), rng.random((100, 153), np.float32)) for i in range(each)] for _ in range(10)]
    compare([PackedViews.of(category) for category in views], targets, trees=False)
    with tempfile.TemporaryDirectory() as folder:
        places = [Path(folder) / str(number) for number in range(len(views))]
        for place, category in zip(places, views, strict=True):
            write_views(place, category)
        del views
        print("\nthe same, mapped from files", end="")
        compare([open_views(place) for place in places], targets, trees=False)


def taught(things: int, each: int, describe: Describe) -> dict[str, InstanceCategory]:
    """Return every kind as a category of known instances."""
    return {kind: _with_things(kind, list(described(kind, range(things), each, describe))) for kind in KINDS}


def _with_things(kind: str, views: list[tuple[str, Descriptors]]) -> InstanceCategory:
    return InstanceCategory.of(kind, views, {key: key.rsplit(" ", 1)[0] for key, _ in views})


def constants() -> None:
    """Print the shipped constants as measured on simulated tableware."""
    named = {name: describer_named(name).describe for name in DESCRIBERS}
    for name, describe in {"spin_image_roots": recognising.SPIN_IMAGE_ROOTS.describe, **named}.items():
        icds = [category.width(over_things=True).icd or np.nan for category in taught(6, 2, describe).values()]
        print(f"PRIOR_SPREADS: {name} {np.median(icds):.3g}", flush=True)
    learned = [
        [(name, [recognising.COLOUR.describe(cloud)]) for name, cloud in found_on_table(seed)] for seed in TABLES[0]
    ]
    icds = [
        one.intra_category_distance or np.nan for one in _taught((recognising.COLOUR,), learned, DEFAULT).categories
    ]
    print(f"PRIOR_SPREADS: colour {np.median(icds):.3g}, of what is found on laid tables", flush=True)
    forms = [form_parts(view) for kind in KINDS for seed in range(4) for view in views_of_thing(kind, seed, 2)]
    for name in PARTS:
        print(f"PARTS: {name} {np.median(pdist([form[name] for form in forms if form is not None])):.4g}", flush=True)
    for title, comparison in (("SHIPPED", (recognising.UPRIGHT,)), ("SHIPPED_JOINT", SHAPES)):
        kinds = [taught(6, 3, descriptor.describe) for descriptor in comparison]
        folds = [[kind for place, kind in enumerate(KINDS) if place % 4 != fold] for fold in range(4)]
        found = [
            known_by(comparison, [tuple(each[kind] for each in kinds) for kind in fold]).calibrated().recogniser
            for fold in folds
        ]
        for name in ("threshold", "even", "doubt", "choice", "slips", "weights"):
            values = np.array([getattr(each.calibration, name) for each in found])
            least, most = values.min(axis=0), values.max(axis=0)
            print(f"{title}: {name} {np.round(values.mean(axis=0), 3)}, from {least.round(3)} to {most.round(3)}")


def calibration(things: int = 6, each: int = 3) -> None:
    """Print the calibration of the probabilities on unseen things; a quarter of the kinds is unknown in turn."""
    fresh = [
        (kind, view)
        for kind in KINDS
        for thing in range(FIRST_TARGET, FIRST_TARGET + 3)
        for view in views_of_thing(kind, thing, each)
    ]
    print(
        f"\ncalibration: {things} things of {len(KINDS)} kinds, {each} views of each; 3 other things of each as targets"
    )
    for way, comparison in (("upright", (recognising.UPRIGHT,)), ("upright and form", SHAPES)):
        by_things = [taught(things, each, descriptor.describe) for descriptor in comparison]
        by_views = [{kind: replace(known, things={}) for kind, known in kinds.items()} for kinds in by_things]
        seen = [(kind, [descriptor.describe(view) for descriptor in comparison]) for kind, view in fresh]
        for title, kinds in (("views held out", by_views), ("things held out", by_things)):
            rows = [row for fold in range(4) for row in _answers(comparison, kinds, seen, fold)]
            confidence, right, unknown, nd = (np.array(column) for column in zip(*rows, strict=True))
            error, area = expected_calibration_error(confidence, right), auroc(nd[~unknown], nd[unknown])
            print(
                f"{way}, {title:16} expected calibration error {error:.3f}; answers right {right.mean():.3f}, mean"
                f" confidence {confidence.mean():.3f}; unknown told from known: AUROC {area:.3f}",
                flush=True,
            )


def _answers(
    comparison: recognising.Comparison,
    categories: Sequence[dict[str, InstanceCategory]],
    fresh: Sequence[tuple[str, list[Descriptors]]],
    fold: int,
) -> Iterator[tuple[float, bool, bool, float]]:
    """Return probability of the likeliest answer, right, unknown, and ND, for as many unknown as known targets."""
    hidden = set(KINDS[fold::4])
    rest = [tuple(each[kind] for each in categories) for kind in KINDS if kind not in hidden]
    known = known_by(comparison, rest).calibrated().recogniser
    for kind, view in fresh:
        found, unknown = known.recognise(view), kind in hidden
        first = found.candidates[0]
        likeliest = first.category if first.probability >= found.unknown else None
        right = likeliest == (None if unknown else kind)
        row = (max(first.probability, found.unknown), right, unknown, first.normalised)
        yield from [row] * (3 if unknown else 1)


def found_on_table(seed: int) -> list[tuple[str, PointCloud]]:
    """Return the things that detection finds on a formal table, by the words that its layout grounds there."""
    script = parse_script(example("formal_dinner.layout").read_text(encoding="utf-8"))
    scene = perceive(simulate(lay_script(script, seed=seed), seed=seed).cloud)
    matches = ground(example("formal_dinner.layout"), scene).matches
    return [(name, scene.cloud_of(match.perceived)) for name, match in matches.items()]


TABLES = tuple(range(first, first + 6) for first in (1, 7, 31, 37))
"""Seeds of four sets of six tables; each set is named after the next one was taught."""


def tables() -> None:
    """Print how things are named on six tables after one, three and six others were taught, for each set of tables.

    A thing counts as unknown with its category left out. Calibration is that of all answers, known and unknown.
    """
    found = [[found_on_table(seed) for seed in seeds] for seeds in TABLES]
    print(f"\nthings found on {sum(map(len, found))} laid tables: {sum(len(table) for own in found for table in own)}")
    ways = (
        ("equations 1-4", (recognising.SPIN_IMAGE_ROOTS,), PAPER),
        ("spin images", (recognising.SPIN_IMAGE_ROOTS,), DEFAULT),
        ("upright", (recognising.UPRIGHT,), DEFAULT),
        ("upright and form", SHAPES, DEFAULT),
        ("by default", (*SHAPES, recognising.COLOUR), DEFAULT),
    )
    print("taught  way               nearest  named  wrong name  unknown said  AUROC  calibration error")
    for title, comparison, settings in ways:
        described = [
            [[(name, [each.describe(cloud) for each in comparison]) for name, cloud in table] for table in own]
            for own in found
        ]
        for count in (1, 3, 6):
            answers: list[OnTable] = []
            for number, asked in enumerate(described):
                known = _taught(comparison, described[number - 1][:count], settings)
                answers += [_named(known, name, view) for table in asked for name, view in table]
            columns = OnTable(*(np.array(column) for column in zip(*answers, strict=True)))
            sure = np.concatenate([columns.known_sure, columns.unknown_sure])
            right = np.concatenate([columns.known_right, columns.unknown_right])
            what = f"{title}, {count} tables taught"
            share(f"{what}: nearest category right", int(columns.nearest.sum()), len(columns.nearest))
            share(f"{what}: named right", int(columns.named.sum()), len(columns.named))
            share(f"{what}: never taught, called unknown", int(columns.unknown.sum()), len(columns.unknown))
            figure(f"{what}: calibration error", expected_calibration_error(sure, right), "share")
            print(
                f"{count:6}  {title:16}  {columns.nearest.mean():7.3f}  {columns.named.mean():5.3f}"
                f"  {columns.wrong.mean():10.3f}  {columns.unknown.mean():12.3f}"
                f"  {auroc(columns.least, columns.others):5.3f}  {expected_calibration_error(sure, right):17.3f}",
                flush=True,
            )


def _taught(
    comparison: recognising.Comparison,
    learned: Sequence[Sequence[tuple[str, list[Descriptors]]]],
    settings: RecognitionSettings,
) -> JointRecogniser:
    """Return a calibrated recognition of the things of some tables."""
    views = [(name, f"{place} {name}", rows) for place, table in enumerate(learned) for name, rows in table]
    categories = [
        tuple(
            InstanceCategory.of(wanted, [(key, rows[place]) for name, key, rows in views if name == wanted])
            for place in range(len(comparison))
        )
        for wanted in sorted({name for name, _, _ in views})
    ]
    return known_by(comparison, categories, settings).calibrated().recogniser


class OnTable(NamedTuple):
    """An answer, or arrays of many.

    Each holds whether the nearest category, the name and a stated name are right or wrong; whether the answer is
    unknown with the category left out; the least ND with and without the category; and confidence and whether the
    answer is right, with and without.
    """

    nearest: Any
    named: Any
    wrong: Any
    unknown: Any
    least: Any
    others: Any
    known_sure: Any
    known_right: Any
    unknown_sure: Any
    unknown_right: Any


def _named(known: JointRecogniser, name: str, view: Sequence[Descriptors]) -> OnTable:
    found = known.recognise(view)
    least, others = found.candidates[0], np.array([one.normalised for one in found.candidates if one.category != name])
    calibration = known.calibration
    *shares, none = calibration.probabilities(others).tolist()
    by_threshold = known.parts[0].settings.by_threshold
    unknown = others.min() > calibration.threshold if by_threshold else max(shares) < MIN_LABEL_PROBABILITY
    return OnTable(
        least.category == name,
        found.label == name,
        found.label is not None and found.label != name,
        unknown,
        least.normalised,
        others.min(),
        max(least.probability, found.unknown),
        least.category == name and least.probability >= found.unknown,
        max(*shares, none),
        none > max(shares),
    )


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--tables", action="store_true", help="measure naming on laid tables")
    parser.add_argument("--constants", action="store_true", help="measure the shipped numbers")
    parser.add_argument("--calibration", action="store_true", help="measure calibration only")
    parser.add_argument("--random", action="store_true", help="time random descriptors")
    parser.add_argument("--quick", action="store_true", help="1,000 views only")
    with recorded(parser) as options:
        if options.tables:
            tables()
            return
        if options.constants:
            constants()
            return
        if options.calibration:
            calibration()
            return
        quick = options.quick
        if options.random:
            for each in (100,) if quick else (100, 1_000):
                random(each)
            return
        for title, describe in (("spin images", SPIN_IMAGES), ("upright", recognising.UPRIGHT.describe)):
            for things in (8,) if quick else (8, 79):
                print(f"\n{title}", end="")
                simulated(things, describe)
        calibration()


if __name__ == "__main__":
    main()
