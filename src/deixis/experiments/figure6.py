"""Reproduce Figure 6 of the paper: graph similarity as an indicator of correct matches.

Each point is a sub-graph of the description, matched to the scene by equations 5 to 9 and the Hungarian method: its
graph similarity against the share of its objects that are named correctly. (a) script1 by its sub-graphs of 4 to 12
objects; (b) script2 by all its sub-graphs of 12 of its 15 objects. Both use the annotated place setting, and generated
variants of it, for which only figures are reported.

Where the evidence leaves rows equal, the Hungarian method decides by node order; so every share is a mean over random
node orders, and each accuracy is given with its spread over them, and up to interchangeability.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from deixis.answers import Answer, count
from deixis.examples_data import example
from deixis.experiments.place_settings import formal_setting
from deixis.ontology.graph.graph import PaperGraph, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.plots.figure import INK, PAPER, QUIET, new_figure, require_picture, save
from deixis.reasoning.grounding.answers.symmetry import interchangeable
from deixis.reasoning.grounding.engines.similarity import node_similarity
from deixis.reasoning.grounding.engines.similarity_engine import described
from deixis.reasoning.grounding.evidence.evidence import Evidence, no_unary_evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.workflows.layouts.read import read_script

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


PICTURES = {"script1": "figure6a.png", "script2": "figure6b.png"}
"""File name of each panel, by its script."""

SIZES = range(4, 13)
PER_SIZE = 60
"""Maximum number of sub-graphs of one size; larger sets are sampled."""

POINT_ORDERS = 10
"""Number of node orders in the mean of a point's share."""

DISPLACEMENT = 0.01
"""Maximum displacement of things in the variants, in metres."""


@dataclass(frozen=True)
class Spread:
    """The mean and percentiles of a figure over repetitions."""

    mean: float
    low: float  # 5th percentile
    median: float
    high: float  # 95th percentile

    @classmethod
    def of(cls, values: Sequence[float] | NDArray[np.float64]) -> Spread:
        """Return the spread of the values.

        Parameters
        ----------
        values
            One value for each repetition, at least one.

        Returns
        -------
        Spread
            Mean, 5th percentile, median and 95th percentile.
        """
        array = np.asarray(values, dtype=float)
        low, median, high = np.percentile(array, [5, 50, 95])
        return cls(float(array.mean()), float(low), float(median), float(high))

    def __str__(self) -> str:
        return f"{self.mean:.2f} (5 % {self.low:.2f}, median {self.median:.2f}, 95 % {self.high:.2f})"


@dataclass(frozen=True, eq=False)
class Points:
    """The k sub-graphs of one scene, one entry each."""

    similarity: NDArray[np.float64]
    facts: NDArray[np.float64]  # sum of degrees of the alignment
    right: NDArray[np.float64]  # share named correctly, mean over node orders

    def rho(self, measure: NDArray[np.float64]) -> float:
        """Return Spearman's rank correlation of a measure with the share named correctly; 0 if either is constant.

        Parameters
        ----------
        measure
            Value of each sub-graph, shape (k,).

        Returns
        -------
        float
            Correlation in [-1, 1].
        """
        from scipy.stats import spearmanr

        if np.ptp(measure) == 0 or np.ptp(self.right) == 0:
            return 0.0
        return float(spearmanr(measure, self.right).statistic)


@dataclass(frozen=True)
class Panel:
    """The figures of one panel, and the sub-graphs of the annotated place setting."""

    script: str
    subgraphs: int
    rho_similarity: float
    rho_facts: float
    variants_rho_similarity: Spread
    variants_rho_facts: Spread
    accuracy: dict[str, Spread]
    variants_accuracy: dict[str, Spread]
    points: Points


@dataclass(frozen=True, repr=False)
class Figure6(Answer):
    """Both panels, and the folder of the pictures."""

    a: Panel
    b: Panel
    variants: int
    orders: int
    seed: int
    pictures: tuple[str, ...]

    def summary(self) -> str:
        """Return Spearman's correlation of the graph similarity with the share named right, for both panels."""
        found = f"ρ {self.a.rho_similarity:.2f} and {self.b.rho_similarity:.2f}"
        return f"{count(self.variants, 'variant')}, {count(self.orders, 'node order')}: {found}"


def figure6_to_dict(found: Figure6) -> dict[str, Any]:
    """Return the figures as plain data, without the single sub-graphs.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    dict
        Value by name of the field; those of the panels are nested.
    """
    data = asdict(found)
    for panel in (data["a"], data["b"]):
        del panel["points"]
    return data


def figure6_lines(found: Figure6) -> list[str]:
    """Return the lines of the text report.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    list of str
        The setting of the run, the figures of both panels, and the files of the pictures.
    """
    orders = count(found.orders, "node order")
    head = [f"Figure 6: {count(found.variants, 'variant')}, {orders}, seed {found.seed}", ""]
    return [*head, *_panel_lines("(a)", found.a), "", *_panel_lines("(b)", found.b), "", *found.pictures]


def figure6_rows(found: Figure6) -> Iterator[dict[str, Any]]:
    """Yield a row for each accuracy of each panel.

    Parameters
    ----------
    found
        Results of the experiment.

    Yields
    ------
    dict
        ``panel``, ``script``, ``scene`` (annotated or variants), ``measure``, and its mean, median and percentiles.
    """
    for name, panel in (("a", found.a), ("b", found.b)):
        for scene, accuracy in (("annotated", panel.accuracy), ("variants", panel.variants_accuracy)):
            for measure, spread in accuracy.items():
                yield {"panel": name, "script": panel.script, "scene": scene, "measure": measure, **asdict(spread)}


def _panel_lines(name: str, panel: Panel) -> list[str]:
    lines = [
        f"{name} {panel.script}, {panel.subgraphs} sub-graphs of the annotated place setting",
        f"    Spearman's rho with the share named right: similarity {panel.rho_similarity:.2f}, "
        f"satisfied facts {panel.rho_facts:.2f}",
        f"    over the variants: similarity {panel.variants_rho_similarity}",
        f"                       satisfied facts {panel.variants_rho_facts}",
    ]
    for title, accuracy in (("annotated", panel.accuracy), ("variants", panel.variants_accuracy)):
        lines += [f"    {title}, {what}: {spread}" for what, spread in accuracy.items()]
    return lines


def figure6_figure(found: Figure6, axes: Axes | None = None) -> Figure:
    """Draw both panels side by side: the graph similarity of each sub-graph against the share of objects named right.

    Parameters
    ----------
    found
        Results of the experiment.
    axes
        Axes for panel (a) alone; None for a new figure with both panels.

    Returns
    -------
    Figure
        The figure.
    """
    if axes is not None:
        _draw_panel(axes, "(a)", found.a)
        return axes.figure.figure
    figure, both = new_figure(12.4, 4.4, ncols=2)
    for place, name, panel in zip(both, ("(a)", "(b)"), (found.a, found.b), strict=True):
        _draw_panel(place, name, panel)
    return figure


def _draw_panel(axes: Axes, name: str, panel: Panel) -> None:
    """Draw one point for each sub-graph of the annotated place setting, coloured by satisfied facts."""
    points = panel.points
    drawn = axes.scatter(
        points.similarity, points.right, c=points.facts, cmap="viridis", s=18, alpha=0.75, linewidths=0
    )
    bar = axes.figure.figure.colorbar(drawn, ax=axes, pad=0.02)
    bar.set_label("satisfied facts (sum of degrees)", color=INK, fontsize=9)
    bar.outline.set_edgecolor(QUIET)
    axes.set_xlabel("overall graph similarity", color=INK, fontsize=9)
    axes.set_ylabel("share of objects named right\n(mean over node orders)", color=INK, fontsize=9)
    title = f"{name} {panel.script}: {panel.subgraphs} sub-graphs, Spearman's ρ = {panel.rho_similarity:.2f}"
    axes.set_title(title, color=INK, fontsize=11, loc="left")
    axes.set_ylim(-0.03, 1.03)
    axes.set_facecolor(PAPER)
    axes.grid(color=QUIET, alpha=0.25, linewidth=0.6)
    for side in axes.spines.values():
        side.set_color(QUIET)


def steps(variants: int) -> int:
    """Return how many place settings both panels are tried on.

    Parameters
    ----------
    variants
        The number of generated variants of the place setting.

    Returns
    -------
    int
        Number of calls of ``tick`` in :func:`run`.
    """
    return len(PICTURES) * (1 + variants)


def run(
    out: Path, variants: int = 50, orders: int = 200, seed: int = 1, tick: Callable[[], None] = lambda: None
) -> Figure6:
    """Run both panels and write ``figure6a.png`` and ``figure6b.png`` to ``out``.

    Parameters
    ----------
    out
        The folder of the pictures.
    variants
        The number of generated variants of the place setting.
    orders
        The number of random node orders of each accuracy.
    seed
        The seed of the variants and of the node orders.
    tick
        Function that is called after each place setting.

    Returns
    -------
    The figures of both panels, and the paths of the pictures.
    """
    paths = {script: require_picture(out / name) for script, name in PICTURES.items()}
    annotated = read_scene(example("place_setting.labelled.scene.json"))
    scenes = [formal_setting(seed * 1000 + i, DISPLACEMENT) for i in range(variants)]
    panels: list[Panel] = []
    pictures: list[str] = []
    for script, path in paths.items():
        trial = _Trial(script, np.random.default_rng(seed))
        tried = []
        for number, scene in enumerate([annotated, *scenes]):
            tried.append(trial.run(scene, orders if number == 0 else max(orders // 10, 1)))
            tick()
        (points, accuracy), *varied = tried
        panel = Panel(
            script=trial.name,
            subgraphs=len(points.right),
            rho_similarity=points.rho(points.similarity),
            rho_facts=points.rho(points.facts),
            variants_rho_similarity=Spread.of([p.rho(p.similarity) for p, _ in varied]),
            variants_rho_facts=Spread.of([p.rho(p.facts) for p, _ in varied]),
            accuracy={what: Spread.of(values) for what, values in accuracy.items()},
            variants_accuracy={
                what: Spread.of(np.concatenate([found[what] for _, found in varied])) for what in accuracy
            },
            points=points,
        )
        panels.append(panel)
        figure, axes = new_figure(6.4, 4.4)
        _draw_panel(axes, f"({path.stem[-1]})", panel)
        save(figure, path)
        pictures.append(str(path))
    return Figure6(panels[0], panels[1], variants, orders, seed, tuple(pictures))


_Run = tuple[Points, dict[str, NDArray[np.float64]]]


class _Trial:
    """One script and the scenes on which it is tried, whose labels are the truth."""

    def __init__(self, name: str, rng: np.random.Generator) -> None:
        self.name = name
        self._rng = rng
        self._description: RelationGraph = read_script(example(f"{name}.layout")).graph()
        self._paper: PaperGraph = described(self._description)
        n = len(self._description.nodes)
        sizes = [12] if n > 12 else list(SIZES)
        chosen: list[tuple[int, ...]] = []
        for size in sizes:
            every = list(combinations(range(n), size))
            if n <= 12 and len(every) > PER_SIZE:
                every = [every[i] for i in self._rng.choice(len(every), PER_SIZE, replace=False)]
            chosen += every
        members = np.zeros((len(chosen), n), dtype=bool)
        for row, kept in enumerate(chosen):
            members[row, list(kept)] = True
        self._members = members
        groups = interchangeable(self._description, [0] * len(self._description.nodes))
        self._group = {name: f"group {i}" for i, group in enumerate(groups) for name in group}

    def run(self, scene: Scene, orders: int) -> tuple[Points, dict[str, NDArray[np.float64]]]:
        """Return the points of one scene, and the accuracies over node orders, by selection criterion."""
        evidence = no_unary_evidence(self._description, scene.without_labels().relations(default_ontology().relations))
        # Round, so that rounding errors do not break ties that node order should break.
        matrices = node_similarity(self._paper, evidence.scene.paper_view(), self._members).matrices.round(9)
        full = np.flatnonzero(self._members.sum(axis=1) == self._members.sum(axis=1).max())
        few = _Measured.of(self._in_orders(matrices, self._members, POINT_ORDERS), matrices, evidence)
        many = _Measured.of(self._in_orders(matrices[full], self._members[full], orders), matrices[full], evidence)
        right = self._right(few.assignments, scene, exactly=True)
        points = Points(few.similarity.mean(axis=1), few.facts.mean(axis=1), right.mean(axis=1))
        accuracies = {}
        for choice, keys in (
            ("facts decide", (many.similarity, many.facts)),
            ("similarity decides", (many.facts, many.similarity)),
        ):
            chosen = many.best(keys, self._rng)
            accuracies[f"right, {choice}"] = self._right(chosen, scene, exactly=True)
            accuracies[f"right up to interchangeability, {choice}"] = self._right(chosen, scene, exactly=False)
            if len(many.assignments) > 1:
                present = {thing.label for thing in scene.objects}
                absent = np.array([name not in present for name in self._description.nodes])
                dropped = ((chosen == UNMATCHED) == absent).all(axis=-1).astype(float)
                accuracies[f"exactly the absent dropped, {choice}"] = dropped
        return points, accuracies

    def _in_orders(self, matrices: NDArray[np.float64], members: NDArray[np.bool_], orders: int) -> NDArray[np.int64]:
        """Return the Hungarian assignments with all nodes in random orders, shape (sub-graphs, orders, n1)."""
        found = np.full((len(matrices), orders, matrices.shape[1]), UNMATCHED, dtype=np.int64)
        for matrix, kept, assignments in zip(matrices, members, found, strict=True):
            present = np.flatnonzero(kept)
            for assignment in assignments:
                rows, columns = self._rng.permutation(present), self._rng.permutation(matrix.shape[1])
                i, p = linear_sum_assignment(matrix[rows[:, None], columns], maximize=True)
                assignment[rows[i]] = columns[p]
        return found

    def _right(self, assignments: NDArray[np.int64], scene: Scene, exactly: bool) -> NDArray[np.float64]:
        """Return the share of matched objects whose thing has their name, or an indistinguishable one."""
        names, labels = self._description.nodes, [thing.label or "" for thing in scene.objects]
        group = {name: name if exactly else self._group.get(name, name) for name in (*names, *labels)}
        same = np.array([[group[name] == group[label] for label in labels] for name in names])
        matched = assignments != UNMATCHED
        right = same[np.arange(len(names)), assignments] & matched
        share: NDArray[np.float64] = right.sum(axis=-1) / np.maximum(matched.sum(axis=-1), 1)
        return share


@dataclass(frozen=True, eq=False)
class _Measured:
    """Assignments (sub-graphs, orders, n1) with their similarity and sum of degrees (sub-graphs, orders)."""

    assignments: NDArray[np.int64]
    similarity: NDArray[np.float64]
    facts: NDArray[np.float64]

    @classmethod
    def of(cls, found: NDArray[np.int64], matrices: NDArray[np.float64], evidence: Evidence) -> _Measured:
        matched = found != UNMATCHED
        entries = np.take_along_axis(matrices[:, None], np.maximum(found, 0)[..., None], axis=3)[..., 0]
        similarity = np.where(matched, entries, 0.0).sum(axis=-1) / np.sqrt(matched.sum(axis=-1))
        facts = evidence.totals(found.reshape(-1, found.shape[-1])).reshape(found.shape[:2])
        return cls(found, similarity.round(6), facts.round(6))

    def best(self, keys: tuple[NDArray[np.float64], ...], rng: np.random.Generator) -> NDArray[np.int64]:
        """Return the assignment with the greatest key (last key first, ties at random), shape (orders, n1)."""
        ties = rng.random(self.similarity.shape)
        winner = np.lexsort((ties, *keys), axis=0)[-1]
        chosen: NDArray[np.int64] = self.assignments[winner, np.arange(self.assignments.shape[1])]
        return chosen
