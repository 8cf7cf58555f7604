"""Measure naming of unseen things: meshes by other makers, split by things, beside the paper's equations and a forest.

DEIXIS_DATA leads to ``tabletop-meshes``. Things, corrections and exclusions are those of
``deixis.experiments.open_ended.mesh_list``; ``--all`` takes all meshes as they come. Half of the things of each
category teach, by 3, 5 or 24 views per category. All views of the other half are named, each once as it is, and once
with its category left out of the taught ones, so that half of all answers should be *none of these*.
docs/explanation/open_ended.md states which data each choice was made on. Figures are means over splits; the calibration
error is over the answers of all splits. ``--cache FOLDER`` keeps views, descriptors and distances, for later runs.
The whole run takes four minutes of processor time, half of them for the forests; with a cache and ``--no-forest`` it
takes five seconds.

``--words`` names things on tables instead: twelve unseen things at random places, with a description of 20 facts. It
prints how many are named correctly by their shape, by the words alone, and by both together. ``--facts N`` describes
them by N facts. ``--quick`` takes fewer views and splits.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from common import data_folder
from numpy.typing import NDArray
from records import command_line, figure, mean, recorded

import deixis
from deixis.experiments.open_ended.mesh_list import CORRECTED, EXCLUDED
from deixis.experiments.open_ended.things import FOLDER, in_metres, listed_meshes, rows_of, simulated, upright
from deixis.learning.views.views import (
    FORM,
    SPIN_IMAGE_ROOTS,
    UPRIGHT,
    Comparison,
    candidates_of,
    known_by,
)
from deixis.ontology.tbox import default_ontology
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.recognition.calibration import (
    SHIPPED_JOINT,
    Calibration,
    auroc,
    calibrate_jointly,
    expected_calibration_error,
)
from deixis.perception.recognition.distances import Target, view_distances
from deixis.perception.recognition.held_out import HeldOut, shortening
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.settings import DEFAULT, MIN_LABEL_PROBABILITY, PAPER, RecognitionSettings
from deixis.perception.recognition.spread import Width, spreads
from deixis.perception.recognition.views import PackedViews
from deixis.perception.simulator.cameras.views import views_of

Array = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]
TAUGHT_VIEWS = (3, 5, 24)
COMPARISON: Comparison = (UPRIGHT, FORM)
"""Descriptors by which views of a table are compared; meshes have no colours."""

TREES = 150
"""Number of trees of a random forest."""


@dataclass(frozen=True, eq=False)
class Views:
    """A set of n views: category and thing of each, the clouds, and the descriptors by name."""

    categories: NDArray[np.str_]
    things: NDArray[np.str_]
    clouds: list[PointCloud]
    described: dict[str, list[NDArray[np.float32]]]


def meshes(folder: Path, everything: bool) -> Iterator[tuple[str, str, Mesh]]:
    """Yield category, file and mesh of each measured thing."""
    if not everything:
        yield from listed_meshes(folder)
        return
    for category, file, y_up in rows_of(folder):
        yield category, file.relative_to(folder).as_posix(), upright(in_metres(read_mesh(file)), y_up)


WAYS_TO_DESCRIBE = {way.name: way.describe for way in (SPIN_IMAGE_ROOTS, UPRIGHT, FORM)}


def cached(cache: Path | None, key: tuple[object, ...], make: Callable[[], Arrays]) -> Arrays:
    """Return the arrays of a file of the cache, or make and keep them; the key includes the code of perception."""
    if cache is None:
        return make()
    named = sha256(repr((*key, code_digest())).encode()).hexdigest()[:24]
    path = cache / f"{named}.npz"
    if path.exists():
        with np.load(path) as stored:
            return dict(stored)
    cache.mkdir(parents=True, exist_ok=True)
    made = make()
    np.savez(path.with_suffix(".part.npz"), **made)  # type: ignore[arg-type]
    path.with_suffix(".part.npz").replace(path)
    return made


@functools.cache
def code_digest() -> str:
    """Return a digest of the code from which the views, the descriptors and the distances come."""
    from deixis import perception

    (folder,) = perception.__path__
    parts = ("clouds", "features", "simulator", "recognition/distances.py", "recognition/views.py")
    roots = [Path(folder, part) for part in parts]
    files = sorted(path for root in roots for path in (root.rglob("*.py") if root.is_dir() else [root]))
    return sha256(b"".join(path.read_bytes() for path in files)).hexdigest()


def views_of_meshes(folder: Path, everything: bool, each: int, cache: Path | None = None) -> Views:
    """Return ``each`` views of each thing, described in every way; views without a descriptor are left out."""
    described: dict[str, list[NDArray[np.float32]]] = {name: [] for name in WAYS_TO_DESCRIBE}
    rows = []
    for number, (category, name, mesh) in enumerate(meshes(folder, everything)):
        vertices, faces = sha256(mesh.vertices.tobytes()), sha256(mesh.faces.tobytes())
        key = ("views", vertices.hexdigest(), faces.hexdigest(), number, each)
        found = cached(cache, key, functools.partial(describe_views, mesh, number, each))
        for view in range(each):
            arrays = {way: found[f"{way} {view}"] for way in WAYS_TO_DESCRIBE}
            if all(map(len, arrays.values())):
                rows.append((category, name, PointCloud(found[f"cloud {view}"])))
                for way, array in arrays.items():
                    described[way].append(array)
    categories, things, clouds = zip(*rows, strict=True)
    return Views(np.array(categories), np.array(things), list(clouds), described)


def describe_views(mesh: Mesh, number: int, each: int) -> Arrays:
    """Return the points of each view of a mesh, and its descriptors by way and number."""
    made: Arrays = {}
    for view, cloud in enumerate(views_of(mesh, each, seed=70_000 + number, upright=True)):
        made[f"cloud {view}"] = cloud.points
        made.update({f"{way} {view}": describe(cloud) for way, describe in WAYS_TO_DESCRIBE.items()})
    return made


def distances(arrays: Sequence[NDArray[np.float32]], cache: Path | None = None) -> NDArray[np.float32]:
    """Return D_V (n, n) from each view, a row, to each."""

    def make() -> Arrays:
        packed = PackedViews.of((str(number), rows) for number, rows in enumerate(arrays))
        return {"distances": np.stack([view_distances(Target.of(rows), packed) for rows in arrays]).astype(np.float32)}

    digest = sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()
    return cached(cache, ("distances", digest), make)["distances"]


def split(views: Views, count: int, seed: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return positions of ``count`` views per category to teach, from half of its things, and of the others."""
    rng = np.random.default_rng(seed)
    taught: list[int] = []
    asked: list[int] = []
    for category in np.unique(views.categories):
        things = rng.permutation(np.unique(views.things[views.categories == category]))
        half = -(-len(things) // 2)
        if half == len(things):
            continue  # a category of one thing has no other one
        pools = [list(rng.permutation(np.flatnonzero(views.things == thing))) for thing in things[:half]]
        turns = [pool[turn] for turn in range(max(map(len, pools))) for pool in pools if turn < len(pool)]
        taught += turns[:count]
        asked += [int(place) for thing in things[half:] for place in np.flatnonzero(views.things == thing)]
    return np.array(taught), np.array(asked)


@dataclass(frozen=True, eq=False)
class Answers:
    """The scores of one split, ``known`` (q, c) and, without the own category, ``unknown`` (q, c); less is nearer.

    ``probabilities`` (2 q, c + 1) are of both in turn, with *none of these* last; None for methods without
    probabilities.
    """

    truth: NDArray[np.int64]
    known: Array
    unknown: Array
    probabilities: Array | None = None


def left_out(scores: Array, truth: NDArray[np.int64]) -> Array:
    """Return the scores without the own category."""
    rest = scores.copy()
    rest[np.arange(len(truth)), truth] = np.inf
    return rest


def normalised(
    matrix: NDArray[np.float32],
    views: Views,
    taught: NDArray[np.int64],
    asked: NDArray[np.int64],
    settings: RecognitionSettings | None,
) -> tuple[Array, HeldOut]:
    """Return ND (q, c) of the asked views (D_C without settings), and of the taught ones by held-out recognition."""
    names, category = np.unique(views.categories[taught], return_inverse=True)
    places = [taught[category == number] for number in range(len(names))]
    widths = [
        Width.of(matrix[np.ix_(own, own)], views.things[own] if settings is None or settings.over_things else None)
        for own in places
    ]
    divisors = np.ones(len(names))
    if settings is not None:
        divisors = np.array([one.value for one in spreads(widths, settings.prior_spread, settings.shrinkage)])
    found = np.stack([matrix[np.ix_(asked, own)].min(axis=1) for own in places], axis=1) / divisors
    rows = np.stack([matrix[np.ix_(taught, own)].min(axis=1) for own in places], axis=1) / divisors
    fewer: list[tuple[int, float]] = []
    counts = np.array([len(set(views.things[own])) for own in places])
    for row, (place, number) in enumerate(zip(taught, category, strict=True)):
        rest = places[number][views.things[places[number]] != views.things[place]]
        own = matrix[place, rest]
        rows[row, number] = own.min() / divisors[number] if len(rest) else np.inf
        fewer.extend(
            (int(counts[number]) - 1, float(np.log(own.min() / own[views.things[rest] != thing].min())))
            for thing in (set(views.things[rest]) if counts[number] > 2 else ())
        )
    power = -shortening(fewer)
    rows[np.arange(len(taught)), category] *= (counts / np.maximum(counts - 1, 1))[category] ** power
    return found, HeldOut(rows, category, np.unique(views.things[taught], return_inverse=True)[1])


def by_distance(matrix: str, settings: RecognitionSettings | None) -> Callable[..., Answers]:
    """Return a method that names by the nearest category, by D_C (no settings) or ND."""

    def name(
        views: Views, matrices: dict[str, NDArray[np.float32]], taught: NDArray[np.int64], asked: NDArray[np.int64]
    ) -> Answers:
        found, _ = normalised(matrices[matrix], views, taught, asked, settings)
        truth = np.searchsorted(np.unique(views.categories[taught]), views.categories[asked])
        return Answers(truth, found, left_out(found, truth))

    return name


def jointly(
    views: Views, matrices: dict[str, NDArray[np.float32]], taught: NDArray[np.int64], asked: NDArray[np.int64]
) -> Answers:
    """Name as ``deixis recognise`` does: by all descriptors, calibrated on the taught views."""
    ways = [normalised(matrices[way.name], views, taught, asked, DEFAULT) for way in COMPARISON]
    calibration: Calibration = calibrate_jointly([held for _, held in ways], DEFAULT.prior_unknown, SHIPPED_JOINT)
    truth = np.searchsorted(np.unique(views.categories[taught]), views.categories[asked])
    found = calibration.mean([each for each, _ in ways])
    rest = left_out(found, truth)
    return Answers(truth, found, rest, calibration.probabilities(np.concatenate([found, rest])))


def forest(
    views: Views, matrices: dict[str, NDArray[np.float32]], taught: NDArray[np.int64], asked: NDArray[np.int64]
) -> Answers:
    """Name by a random forest (scikit-learn) on the form, and the mean and spread of the local descriptors.

    For the unknown it is trained again without each category. Only leaving out the votes of a category that it was
    trained on would test it on known things: it votes for them, so that few votes are left, and AUROC becomes 0.81 to
    0.88.
    """
    from sklearn.ensemble import RandomForestClassifier

    def rows(places: NDArray[np.int64]) -> Array:
        local, form = views.described[UPRIGHT.name], views.described[FORM.name]
        return np.stack([np.concatenate([form[p][0], local[p].mean(axis=0), local[p].std(axis=0)]) for p in places])

    learned, seen, named = rows(taught), rows(asked), views.categories[taught]
    trees = RandomForestClassifier(TREES, random_state=0).fit(learned, named)
    truth = np.searchsorted(trees.classes_, views.categories[asked])
    known = -trees.predict_proba(seen)
    unknown = np.full_like(known, np.inf)
    for number, category in enumerate(trees.classes_):
        own, others = truth == number, named != category
        fewer = RandomForestClassifier(TREES, random_state=0).fit(learned[others], named[others])
        unknown[np.ix_(own, np.arange(len(trees.classes_)) != number)] = -fewer.predict_proba(seen[own])
    return Answers(truth, known, unknown)


BEFORE = RecognitionSettings(shrinkage=5.0)
WAYS: dict[str, Callable[..., Answers]] = {
    "equations 1-4, spin images": by_distance(SPIN_IMAGE_ROOTS.name, PAPER),
    "equations 1-2, spin images": by_distance(SPIN_IMAGE_ROOTS.name, None),
    "equations 1-2, upright": by_distance(UPRIGHT.name, None),
    "equation 4 drawn by s = 5": by_distance(UPRIGHT.name, BEFORE),
    "equations 1-2, form": by_distance(FORM.name, None),
    "random forest": forest,
    "by default": jointly,
}


def compare(views: Views, matrices: dict[str, NDArray[np.float32]], splits: int, forests: bool) -> None:
    """Print a line for each method and number of views."""
    print("views  way                          right  top 3  AUROC  calibration error  right with none  not named")
    for count in TAUGHT_VIEWS:
        for title, name in WAYS.items():
            if name is forest and not forests:
                continue
            found = [name(views, matrices, *split(views, count, seed)) for seed in range(splits)]
            right = [float((one.known.argmin(axis=1) == one.truth).mean()) for one in found]
            order = [np.argsort(one.known, axis=1)[:, :3] for one in found]
            third = [
                float((top == one.truth[:, None]).any(axis=1).mean()) for top, one in zip(order, found, strict=True)
            ]
            areas = [auroc(one.known.min(axis=1), one.unknown.min(axis=1)) for one in found]
            mean(f"{title}, {count} views: named right", right)
            mean(f"{title}, {count} views: AUROC of the unknown", areas)
            line = f"{count:5}  {title:27}  {np.mean(right):.3f}  {np.mean(third):.3f}  {np.mean(areas):.3f}"
            print(line + calibrated(f"{title}, {count} views", found), flush=True)


def calibrated(title: str, found: Sequence[Answers]) -> str:
    """Return the calibration error of all answers, the share right, and the share of known views left unnamed."""
    given = [one for one in found if one.probabilities is not None]
    if not given:
        return ""
    shares = [one.probabilities for one in given if one.probabilities is not None]
    truths = [np.concatenate([one.truth, np.full(len(one.truth), one.known.shape[1])]) for one in given]
    right = np.concatenate([each.argmax(axis=1) == truth for each, truth in zip(shares, truths, strict=True)])
    sure = np.concatenate([each.max(axis=1) for each in shares])
    named = np.concatenate([each[: len(each) // 2, :-1].max(axis=1) >= MIN_LABEL_PROBABILITY for each in shares])
    error = expected_calibration_error(sure, right)
    figure(f"{title}: calibration error", error, "share")
    return f"  {error:17.3f}  {right.mean():15.3f}  {1 - named.mean():12.3f}"


SIMULATED = (
    "dinner plate",
    "bread plate",
    "bowl",
    "soup bowl",
    "cup",
    "mug",
    "wine glass",
    "water glass",
    "champagne glass",
    "bottle",
    "dinner fork",
    "dessert fork",
    "dinner knife",
    "butter knife",
    "soup spoon",
    "dessert spoon",
    "napkin",
    "vase",
)


def correlation(cache: Path | None) -> None:
    """Print the intraclass correlation of held-out answers to views of one thing, on the simulator's tableware."""
    named, clouds = [], []
    for thing in simulated(SIMULATED, 4, 12, seed=1):
        for cloud in thing.clouds:
            named.append((thing.category, thing.instance))
            clouds.append(cloud)
    described = {way.name: [way.describe(cloud) for cloud in clouds] for way in COMPARISON}
    categories, things = (np.array(column) for column in zip(*named, strict=True))
    views = Views(categories, things, clouds, described)
    matrices = {name: distances(arrays, cache) for name, arrays in described.items()}
    for count in (12, 24):
        found = []
        for seed in range(10):
            taught, asked = split(views, count, seed)
            held = [normalised(matrices[way.name], views, taught, asked, DEFAULT)[1] for way in COMPARISON]
            shown, (_, truth) = views.things[taught], held[0].as_known
            left = np.isfinite(held[0].normalised[np.arange(len(shown)), held[0].truth])
            near = SHIPPED_JOINT.probabilities(SHIPPED_JOINT.mean([one.as_known[0] for one in held]))
            far = SHIPPED_JOINT.probabilities(SHIPPED_JOINT.mean([one.as_unknown for one in held]))
            right = np.log(near[np.arange(len(truth)), truth])
            found.append((intraclass(right, shown[left]), intraclass(np.log(far[:, -1]), shown)))
        known_share, unknown_share = np.mean(found, axis=0)
        print(f"{count} views per category: {known_share:.2f} for known things, {unknown_share:.2f} for unknown ones")


def intraclass(values: Array, groups: NDArray[np.str_]) -> float:
    """Return the intraclass correlation of values (n,) by group, from the analysis of variance (Fisher 1925)."""
    _, place, sizes = np.unique(groups, return_inverse=True, return_counts=True)
    means = np.bincount(place, values) / sizes
    between = (sizes * (means - values.mean()) ** 2).sum() / (len(sizes) - 1)
    within = ((values - means[place]) ** 2).sum() / (len(values) - len(sizes))
    typical = (len(values) - np.square(sizes).sum() / len(values)) / (len(sizes) - 1)
    return float((between - within) / (between + (typical - 1) * within))


def words(views: Views, tables: int, facts: int) -> None:
    """Print how many of twelve new things on a table are named correctly by shape, by words and by both."""
    taught, asked = split(views, 24, 0)
    categories = [
        tuple(
            InstanceCategory.of(
                name,
                [(str(place), views.described[way.name][place]) for place in taught if views.categories[place] == name],
                {str(place): str(views.things[place]) for place in taught},
            )
            for way in COMPARISON
        )
        for name in np.unique(views.categories[taught])
    ]
    known = known_by(COMPARISON, categories).calibrated().recogniser
    totals = np.zeros(3)
    for table in range(tables):
        rng = np.random.default_rng(table)
        chosen = rng.choice(asked, 12, replace=False)
        places = np.stack([rng.permutation(12) % 4 * 0.45, rng.permutation(12) // 4 * 0.45], axis=1)
        things, names, looks = [], [], []
        for number, place in enumerate(chosen):
            answer = known.recognise([views.described[way.name][place] for way in COMPARISON])
            points = views.clouds[place].points.copy()
            middle = (points[:, :2].min(axis=0) + points[:, :2].max(axis=0)) / 2
            points[:, :2] += rng.normal(places[number], 0.05) - middle
            category = str(views.categories[place])
            names.append(f"{category}_{1 + sum(str(views.categories[p]) == category for p in chosen[:number])}")
            looks.append(answer.candidates[0].category == category)
            things.append(
                {
                    "id": f"o{number}",
                    "min": points.min(axis=0).tolist(),
                    "max": points.max(axis=0).tolist(),
                    "candidates": dict(candidates_of(answer)),
                }
            )
        script = describe(names, things, facts, rng)
        bare = [{key: value for key, value in thing.items() if key != "candidates"} for thing in things]
        rights = [float(np.mean(looks)), *(named(script, each, names) for each in (bare, things))]
        totals += rights
        print(f"table {table}: by looks {rights[0]:.2f}; by words alone {rights[1]:.2f}; by both {rights[2]:.2f}")
    looked, by_words, both = totals / tables
    print(f"mean of {tables} tables: by looks {looked:.3f}; by words alone {by_words:.3f}; by both {both:.3f}")


def describe(names: Sequence[str], things: Sequence[dict[str, object]], facts: int, rng: np.random.Generator) -> str:
    """Return facts between pairs, by the exact relations of their boxes, and one for each thing without a fact."""
    scene = deixis.read_scene({"objects": [{k: v for k, v in thing.items() if k != "candidates"} for thing in things]})
    relations = default_ontology().relations
    exact = list(relations.values())
    found = scene.relations(relations).names
    pairs = [(i, j) for i in range(len(names)) for j in range(i)]
    pairs_stated = [pairs[k] for k in rng.choice(len(pairs), facts, replace=False)]
    missing = set(range(len(names))) - {i for pair in pairs_stated for i in pair}
    pairs_stated += [(i, (i + 1) % len(names)) for i in missing]
    return "; ".join(f"{names[i]} {relations.wide(exact[int(found[i, j])]).word} {names[j]}" for i, j in pairs_stated)


def named(script: str, things: Sequence[dict[str, object]], names: Sequence[str]) -> float:
    """Return the share of things to which grounding gives a name of the right category."""
    found = deixis.ground(deixis.read_script(text=script), {"objects": list(things)})
    right = 0
    for name, match in found.matches.items():
        right += names[int(match.perceived[1:])].rsplit("_", 1)[0] == name.rsplit("_", 1)[0]
    return right / len(things)


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--all", action="store_true", help="all meshes, as they come")
    parser.add_argument("--words", action="store_true", help="name things on tables, with a description")
    parser.add_argument("--correlation", action="store_true", help="print the correlation of views of one thing")
    parser.add_argument("--facts", type=int, default=20, help="facts of a description")
    parser.add_argument("--cache", type=Path, metavar="FOLDER", help="keep views, descriptors and distances here")
    parser.add_argument("--no-forest", action="store_true", help="leave the random forest out")
    parser.add_argument("--quick", action="store_true", help="fewer views and splits")
    with recorded(parser) as options:
        if options.correlation:
            correlation(options.cache)
            return
        folder = data_folder(FOLDER)
        if folder is None:
            return
        everything, quick, started = options.all, options.quick, time.process_time()
        for what, entries in (
            ("corrected", {key: each.why for key, each in CORRECTED.items()}),
            ("left out", dict(EXCLUDED)),
        ):
            for name, why in () if everything else entries.items():
                print(f"{what}: {name}: {why}")
        views = views_of_meshes(folder, everything, 4 if quick else 12, options.cache)
        counted = len(np.unique(views.things)), len(np.unique(views.categories))
        print(f"{len(views.clouds)} views of {counted[0]} things of {counted[1]} categories")
        if options.words:
            facts = options.facts
            words(views, 4 if quick else 12, facts)
            return
        matrices = {name: distances(arrays, options.cache) for name, arrays in views.described.items()}
        compare(views, matrices, 3 if quick else 10, not options.no_forest)
        print(f"{time.process_time() - started:.0f} s of processor time")


if __name__ == "__main__":
    main()
