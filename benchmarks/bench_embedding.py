"""Measure an embedding learned from procedural shapes, beside its own descriptors, on held-out kinds and meshes.

A kind is a family of solids (vessels, closed solids, sheets, stemmed vessels, two solids joined) with parameters drawn
once; things of a kind vary all of them. The embedding is the linear map of a discriminant analysis (Fisher 1936) over
the form of a view and the mean and spread of its upright descriptors: the spread within kinds is whitened, with a ridge
of ``--ridge`` times the mean variance. Two thirds of the kinds train it. The others, the meshes of ``DEIXIS_DATA`` and
the things found on laid tables are named by the nearest category: by the descriptors together, by the embedding, and by
all. docs/explanation/recognition.md states the results, and why the embedding is not shipped. ``--kinds N`` (240) makes
N kinds, eight things each in two views each, in about eight minutes; ``--write FILE`` keeps the map (.npz).

``--unknown`` measures instead whether other signals than the least distance detect unknown things: how much nearer the
nearest category is than the second and the median one, and whether both descriptors have the same nearest one. Their
logistic regression is fitted to held-out kinds, and reported on other splits of these, and on the meshes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from bench_naming import Views, distances, left_out, split, views_of_meshes
from bench_recognition import TABLES, found_on_table
from common import data_folder
from numpy.typing import NDArray
from records import command_line, figure, recorded
from scipy.interpolate import PchipInterpolator
from scipy.linalg import eigh
from scipy.spatial.distance import cdist

from deixis.experiments.open_ended.things import FOLDER
from deixis.learning.views.views import FORM, UPRIGHT
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.recognition.calibration import SHIPPED_JOINT, auroc
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes.solids import joined, moved, ringed, thick_sheet, tube

Array = NDArray[np.float64]
THINGS, EACH = 8, 2
"""Number of things of a kind, and of views of each."""

DIMENSIONS = (32, 64, 96)
SHARE = 0.4
"""Weight of the embedding beside the descriptors."""

FAMILIES = ("vessel", "solid", "sheet", "pair", "stemmed")
SIDES, LEVELS = 48, 24


@dataclass(frozen=True, eq=False)
class Kind:
    """The common parameters of the things of a kind; lengths are relative to the width, except ``size`` in metres.

    ``knots`` are radii from foot to top, ``power`` and ``aspect`` those of the superellipse of a section, ``widths``
    and ``lifts`` of a sheet along its length. ``vary`` is the standard deviation of the logarithm of every number.
    """

    family: str
    size: float
    slender: float
    knots: Array
    power: float
    aspect: float
    bend: float
    wall: float
    ear: float
    stick: bool
    lying: bool
    widths: Array
    lifts: Array
    thick: float
    tines: int
    stem: float
    cross: Array
    vary: float

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Kind:
        return cls(
            family=str(rng.choice(FAMILIES, p=(0.34, 0.24, 0.24, 0.1, 0.08))),
            size=float(np.exp(rng.uniform(np.log(0.05), np.log(0.3)))),
            slender=float(np.exp(rng.uniform(np.log(0.15), np.log(3.5)))),
            knots=rng.uniform(0.45, 1, rng.integers(2, 6)),
            power=float(rng.choice([2, 2, 2, rng.uniform(2, 4), 8])),
            aspect=float(rng.choice([1, 1, 1, rng.uniform(0.35, 1)])),
            bend=float(rng.choice([0, 0, 0, 0, rng.uniform(0.1, 0.4)])),
            wall=float(rng.uniform(0.015, 0.08)),
            ear=float(rng.choice([0, 0, 0.5, 0.8])),
            stick=bool(rng.random() < 0.15),
            lying=bool(rng.random() < 0.25),
            widths=rng.uniform(0.15, 1, rng.integers(3, 7)) * rng.uniform(0.12, 0.6),
            lifts=rng.uniform(0, 1, rng.integers(2, 6)) * rng.uniform(0, 0.15),
            thick=float(rng.uniform(0.01, 0.06)),
            tines=int(rng.choice([0, 0, 2, 3, 4])),
            stem=float(rng.uniform(0.25, 0.6)),
            cross=rng.uniform(0.15, 0.5, 4),
            vary=float(rng.uniform(0.04, 0.32)),
        )

    def thing(self, rng: np.random.Generator) -> Mesh:
        """Return a thing of the kind, in metres, turned about the vertical at random."""

        def varied(value: float | Array) -> Array:
            return np.asarray(value * np.exp(rng.normal(0, self.vary, np.shape(value))))

        make = {"sheet": self._sheet, "pair": self._pair}.get(self.family, self._round)
        mesh = make(varied, rng)
        vertices = mesh.vertices
        if self.family == "pair" or (self.lying and self.family == "solid"):
            vertices = vertices[:, [0, 2, 1]] * [1, -1, 1]
        vertices = vertices * float(varied(self.size)) / np.ptp(vertices, axis=0).max()
        return moved(Mesh(vertices, mesh.faces), rng.uniform(0, 2 * np.pi))

    def _round(self, varied, rng: np.random.Generator) -> Mesh:  # type: ignore[no-untyped-def]
        """Return a closed solid, or a vessel with a wall, sometimes on a stem, with a handle."""
        slender = float(varied(self.slender))
        radii, heights = smooth(varied(self.knots), LEVELS), np.linspace(0, 1, LEVELS) * slender
        radii *= 0.5 / radii.max()
        if self.family == "solid":
            return ringed(self._rings(radii, heights, self.bend))
        first = 1
        if self.family == "stemmed":
            low = float(np.clip(varied(self.stem), 0.15, 0.7)) * slender
            cup = smooth(radii, LEVELS) * np.minimum(1, 0.2 + 3 * np.linspace(0, 1, LEVELS))
            radii = np.concatenate([[0.35, 0.33, 0.05, 0.035], cup])
            heights = np.concatenate([[0, 0.01, 0.03, low], low + (slender - low) * np.linspace(0.04, 1, LEVELS)])
            first = 3
        wall = min(float(varied(self.wall)), 0.3 * float(radii.min()) if self.family == "vessel" else 0.02)
        inside = slice(None, -first - 1)
        inner = np.maximum(radii[::-1][inside] - wall, 0.004)
        rings = self._rings(np.concatenate([radii, inner]), np.concatenate([heights, heights[::-1][inside]]), 0.0)
        parts, turn = [ringed(rings)], np.linspace(0, np.pi, 20)
        if rng.random() < self.ear and slender > 0.3:
            top, bottom = 0.86 * slender, 0.35 * slender
            base = float(np.interp(top, heights, radii)) * self.aspect - 0.02
            across = base + float(varied(0.25)) * np.sin(turn) ** 0.6
            upward = (top + bottom) / 2 + (top - bottom) / 2 * np.cos(turn)
            parts.append(tube(np.column_stack([0 * turn, across, upward]), 0.1, 0.08))
        if self.stick:
            height = 0.8 * slender
            base = float(np.interp(height, heights, radii)) * self.aspect - 0.02
            along = np.linspace(base, base + float(varied(1.1)), 8)
            parts.append(tube(np.column_stack([0 * along, along, np.linspace(height, height + 0.1, 8)]), 0.14, 0.08))
        return joined(*parts)

    def _sheet(self, varied, rng: np.random.Generator) -> Mesh:  # type: ignore[no-untyped-def]
        """Return a long flat thing, sometimes curved and with tines."""
        rows, columns = 41, 13
        along, across = np.linspace(0, 1, rows), np.linspace(-1, 1, columns)
        half = smooth(varied(self.widths), rows) / 2 * np.sqrt(np.minimum(1, np.minimum(along, 1 - along) * 14 + 0.02))
        x, y = half[:, None] * across, np.repeat(along[:, None], columns, axis=1)
        bottom = smooth(varied(self.lifts), rows)[:, None] + 0.4 * half[:, None] * across**2 * (rng.random() < 0.5)
        cells = np.ones((rows - 1, columns - 1), np.bool_)
        if self.tines:
            cells[int(rows * 0.7) :, np.linspace(0, columns - 1, self.tines + 1)[1:-1].astype(int)] = False
        return thick_sheet(x, y, bottom, bottom + float(varied(self.thick)), cells)

    def _pair(self, varied, rng: np.random.Generator) -> Mesh:  # type: ignore[no-untyped-def]
        """Return a solid across the end of another, like the head of a hammer."""
        shaft = smooth(varied(self.knots), 12) * float(varied(self.cross[0])) * 0.4
        head = smooth(varied(self.knots[::-1]), 8) * float(varied(self.cross[1])) * 0.5
        one = ringed(self._rings(shaft, np.linspace(0, 1, 12), 0.0))
        other = ringed(self._rings(head, np.linspace(-0.5, 0.5, 8) * float(varied(self.cross[2] + 0.2)), 0.0))
        aside = other.vertices[:, [2, 1, 0]] + [0.0, 0.0, 0.6 + 0.8 * (self.cross[3] - 0.15)]
        return joined(one, Mesh(aside, other.faces[:, ::-1]))

    def _rings(self, radii: Array, heights: Array, bend: float) -> Array:
        angles = 2 * np.pi * np.arange(SIDES) / SIDES
        cosine, sine = np.cos(angles), np.sin(angles)
        reach = (np.abs(cosine) ** self.power + np.abs(sine) ** self.power) ** (-1 / self.power)
        section = np.stack([reach * cosine, reach * sine * self.aspect], axis=1)
        rings = np.empty((len(radii), SIDES, 3))
        rings[..., :2] = np.maximum(radii, 1e-3)[:, None, None] * section
        rings[..., 0] += bend * np.square(heights / np.ptp(heights))[:, None]
        rings[..., 2] = heights[:, None]
        return rings


def smooth(knots: Array, count: int) -> Array:
    """Return ``count`` values along a smooth curve through evenly spaced knots."""
    found: Array = PchipInterpolator(np.linspace(0, 1, len(knots)), knots)(np.linspace(0, 1, count))
    return found


def described(rows: Sequence[tuple[str, str, PointCloud]]) -> Views:
    """Describe views (kind, thing, cloud) by the descriptors by which views of a table are compared."""
    found = [(row, UPRIGHT.describe(row[2]), FORM.describe(row[2])) for row in rows]
    kept = [each for each in found if len(each[1]) and len(each[2])]
    kinds, things, clouds = zip(*(each[0] for each in kept), strict=True)
    ways = {UPRIGHT.name: [each[1] for each in kept], FORM.name: [each[2] for each in kept]}
    return Views(np.array(kinds), np.array(things), list(clouds), ways)


def procedural(first: int, last: int) -> Views:
    """Return views of things of the kinds drawn by these seeds."""
    rows: list[tuple[str, str, PointCloud]] = []
    for number in range(first, last):
        kind = Kind.drawn(np.random.default_rng([number, 5]))
        for thing in range(THINGS):
            mesh = kind.thing(np.random.default_rng([number, thing, 9]))
            clouds = views_of(mesh, EACH, seed=100 * number + thing, upright=True)
            rows.extend((f"{number:05}", f"{number} {thing}", cloud) for cloud in clouds)
    return described(rows)


def vectors(views: Views) -> Array:
    """Return the vectors to embed (n, d): the form, and twice the mean and the spread of the upright descriptors."""
    pairs = zip(views.described[FORM.name], views.described[UPRIGHT.name], strict=True)
    whole = 39  # the trailing numbers that are the same at all keypoints
    return np.stack([np.concatenate([f[0], 2 * u.mean(axis=0), 2 * u.std(axis=0)[:-whole]]) for f, u in pairs])


def learned(rows: Array, kinds: NDArray[np.str_], ridge: float, size: int) -> tuple[Array, Array]:
    """Return mean (d,) and map (d, size) of the discriminant analysis."""
    middle = rows.mean(axis=0)
    _, number = np.unique(kinds, return_inverse=True)
    means = np.stack([rows[number == each].mean(axis=0) for each in range(number.max() + 1)])
    within, between = rows - means[number], means - middle
    spread = within.T @ within / len(within)
    spread += ridge * np.trace(spread) / len(spread) * np.eye(len(spread))
    turned: Array = eigh(between.T @ between / len(between), spread)[1][:, ::-1][:, :size]
    return middle, turned


def logarithms(matrix: NDArray[np.floating]) -> Array:
    """Return the logarithms of distances (n, n) over their median, so that several can be averaged."""
    logs: Array = np.log(np.maximum(matrix, 1e-6) / np.median(matrix))
    return logs


def named(scores: Array, views: Views, count: int, splits: int) -> tuple[float, float]:
    """Return the share of views nearest to their own category, and the AUROC of the unknown; means over splits."""
    results = []
    for seed in range(splits):
        taught, asked = split(views, count, seed)
        names = np.unique(views.categories[taught])
        least = np.stack(
            [scores[np.ix_(asked, taught[views.categories[taught] == name])].min(axis=1) for name in names], axis=1
        )
        truth = np.searchsorted(names, views.categories[asked])
        area = auroc(least.min(axis=1), left_out(least, truth).min(axis=1))
        results.append(((least.argmin(axis=1) == truth).mean(), area))
    right, area = np.mean(results, axis=0).tolist()
    return right, area


SIGNALS = {
    "least distance": [0],
    "and margin": [0, 1],
    "and median": [0, 2],
    "and agreement": [0, 3],
    "all four": [0, 1, 2, 3],
}


def signals(views: Views, count: int, seeds: range) -> tuple[Array, NDArray[np.bool_]]:
    """Return the signals (n, 4) of every asked view, with and without its category, and True for those without."""
    parts = [logarithms(distances(views.described[way.name])) for way in (UPRIGHT, FORM)]
    found, unknown = [], []
    for seed in seeds:
        taught, asked = split(views, count, seed)
        names = np.unique(views.categories[taught])
        truth = np.searchsorted(names, views.categories[asked])
        own = [taught[views.categories[taught] == name] for name in names]
        least = [np.stack([part[np.ix_(asked, each)].min(axis=1) for each in own], axis=1) for part in parts]
        for left in (False, True):
            ways = [left_out(each, truth) if left else each for each in least]
            together = np.sort(np.tensordot(SHIPPED_JOINT.weights, ways, axes=1), axis=1)
            agreed = ways[0].argmin(axis=1) == ways[1].argmin(axis=1)
            median = np.median(together[:, : len(names) - left], axis=1)
            first = together[:, 0]
            found.append(np.stack([first, together[:, 1] - first, median - first, agreed], axis=1))
            unknown.append(np.full(len(asked), left))
    return np.concatenate(found), np.concatenate(unknown)


def tell_unknown(held: Views, meshes: Views | None) -> None:
    """Print the AUROC of the unknown by each choice of signals."""
    from sklearn.linear_model import LogisticRegression

    rows, unknown = signals(held, 4, range(3))
    sets = {"other splits": signals(held, 4, range(3, 6))}
    if meshes is not None:
        sets |= {f"meshes, {count} views": signals(meshes, count, range(10)) for count in (3, 24)}
    scale = rows.std(axis=0)
    for signal, chosen in SIGNALS.items():
        fit = LogisticRegression(max_iter=500).fit(rows[:, chosen] / scale[chosen], unknown)
        for what, (asked, truth) in sets.items():
            score = fit.decision_function(asked[:, chosen] / scale[chosen])
            print(f"{signal:15}  {what:16}  AUROC {auroc(score[~truth], score[truth]):.3f}", flush=True)


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--kinds", type=int, default=240, help="number of procedural kinds")
    parser.add_argument("--ridge", type=float, default=1.0, help="ridge of the discriminant analysis")
    parser.add_argument("--unknown", action="store_true", help="measure only the signals of the unknown")
    parser.add_argument("--write", metavar="FILE", help="write the learned projection (.npz)")
    with recorded(parser) as options:
        folder = data_folder(FOLDER)
        kinds = options.kinds
        ridge = options.ridge
        meshes = None if folder is None else views_of_meshes(folder, False, 12)
        held = procedural(2 * kinds // 3, kinds)
        if options.unknown:
            tell_unknown(held, meshes)
            return
        taught = procedural(0, 2 * kinds // 3)
        tables = described(
            [
                (name, f"{seed} {name}", cloud)
                for seeds in TABLES[:2]
                for seed in seeds
                for name, cloud in found_on_table(seed)
            ]
        )
        sets = {"held-out kinds, 8 views": (held, 8, 4), "laid tables, 6 views": (tables, 6, 4)}
        if meshes is not None:
            sets |= {f"meshes, {count} views": (meshes, count, 10) for count in (3, 24)}
        print(f"{len(taught.clouds)} views of {2 * kinds // 3} kinds teach; accuracy and AUROC of the unknown")
        rows = vectors(taught)
        maps = {size: learned(rows, taught.categories, ridge, size) for size in DIMENSIONS}
        if options.write:
            middle, kept = maps[DIMENSIONS[1]]
            np.savez(options.write, mean=middle.astype(np.float32), map=kept.astype(np.float32))
        for title, (views, count, splits) in sets.items():
            parts = [logarithms(distances(views.described[way.name])) for way in (UPRIGHT, FORM)]
            together = np.tensordot(SHIPPED_JOINT.weights, parts, axes=1)
            print(f"{title:24}  upright and form     {'{:.3f}, {:.3f}'.format(*named(together, views, count, splits))}")
            for size, (middle, turn) in maps.items():
                embedded = (vectors(views) - middle) @ turn
                apart = logarithms(cdist(embedded, embedded))
                for how, scores in (("alone", apart), ("beside", (1 - SHARE) * together + SHARE * apart)):
                    right, area = named(scores, views, count, splits)
                    figure(f"{title}, {size} numbers, {how}: named right", right, "share")
                    figure(f"{title}, {size} numbers, {how}: AUROC of the unknown", area, "share")
                    result = f"{right:.3f}, {area:.3f}"
                    print(f"{title:24}  {size} numbers, {how:8} {result}", flush=True)


if __name__ == "__main__":
    main()
