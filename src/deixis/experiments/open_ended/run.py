"""Run the whole experiment from a plan; the same plan gives the same figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from deixis.answers import Answer, count
from deixis.experiments.open_ended.comparison import (
    Matrix,
    NamingMethod,
    Scores,
    Split,
    by_things,
    by_views,
    d2_distances,
    split_scores,
    view_matrix,
)
from deixis.experiments.open_ended.contestants import (
    D2,
    DRAWN,
    EQUATIONS,
    NEAREST,
    SPIN,
    SVDD,
    THINGS,
    UPRIGHT,
    Contestants,
    contestants,
)
from deixis.experiments.open_ended.described_views import DescribedViews, cached_views, describe_views
from deixis.experiments.open_ended.things import FOLDER, from_meshes, rows_of, simulated
from deixis.extras import require
from deixis.perception.recognition.learners.learner import Learner
from deixis.perception.recognition.learners.naive_bayes import Codebook
from deixis.perception.recognition.learners.teaching import Course, Teaching, teach
from deixis.perception.recognition.learners.view_features import ViewFeatures
from deixis.perception.recognition.settings import PAPER
from deixis.perception.simulator.meshes.tableware import FORMS

Tick = Callable[[str], None]
Stage = Callable[[int], AbstractContextManager[Tick]]
"""Function that opens a stage of a number of steps, and gives the function to call after each."""

NAMING_METHODS = (
    NamingMethod(NEAREST, SPIN, None),
    NamingMethod(EQUATIONS, SPIN, PAPER),
    NamingMethod(THINGS, SPIN, DRAWN),
    NamingMethod(UPRIGHT, UPRIGHT, DRAWN),
    NamingMethod("D2 and extents", D2, None),
)
SPLITS = {"new things": by_things, "new views of things taught": by_views}

Ways = dict[tuple[str, str], tuple[Scores, ...]]
"""Scores of each order, by (split, way)."""

QUICK_KINDS = ("Plate", "Bowl", "Mug", "WineGlass", "Fork", "Knife", "Spoon", "Napkin", "Bottle")
"""Kinds of a quick run."""


KINDS = tuple(name for name in FORMS if name not in ("Jug", "MilkJug", "Creamer", "Pot", "Kettle", "SugarBowl"))
"""Kinds of the simulator that are shown; pots and jugs came after the published figures were measured."""


@dataclass(frozen=True)
class OpenEndedPlan:
    """The plan of a run of open-ended learning.

    ``instances`` of each of the simulator's ``kinds`` are shown in ``views`` views each; each category of meshes in
    ``mesh_views`` views. Each learner is taught in ``orders`` random orders, each with a split of its own.
    """

    orders: int = 10
    seed: int = 1
    kinds: tuple[str, ...] = KINDS
    instances: int = 30
    views: int = 2
    mesh_views: int = 60
    asked: int = 10  # views per category of things never taught, after each course
    teaching: Teaching = Teaching()  # noqa: RUF009 (frozen)
    meshes: Path | None = None
    cache: Path | None = None

    def quick(self) -> OpenEndedPlan:
        """Return a smaller plan that takes a minute or two: few of the simulator's kinds, and no meshes.

        Returns
        -------
        OpenEndedPlan
            Plan with at most three orders.
        """
        return replace(self, orders=min(self.orders, 3), kinds=QUICK_KINDS, meshes=None)

    def seeds(self) -> range:
        """Return the seeds of the orders.

        Returns
        -------
        range
            Consecutive seeds, one for each order of teaching.
        """
        return range(self.seed, self.seed + self.orders)


@dataclass(frozen=True)
class CourseResult:
    """A course, and the share of views of never taught things that the learner named correctly after it."""

    contestant: str
    course: Course
    afterwards: float


@dataclass(frozen=True, eq=False)
class Findings:
    """The findings over one set of things: courses, one for each contestant and order, and single views.

    ``kept_back`` are single views of the categories on which no setting was chosen, if settings were chosen on others.
    """

    name: str
    kinds: tuple[str, ...]
    things: int
    views: int
    taught: tuple[CourseResult, ...]
    nearest: Ways
    kept_back: Ways

    def of(self, contestant: str) -> list[CourseResult]:
        """Return the courses of one contestant.

        Parameters
        ----------
        contestant
            Name of a learner.

        Returns
        -------
        list of CourseResult
            One course for each seed.
        """
        return [one for one in self.taught if one.contestant == contestant]


@dataclass(frozen=True, eq=False, repr=False)
class OpenEnded(Answer):
    """The plan, the findings over each set of things, and a list of the parts left out."""

    plan: OpenEndedPlan
    findings: tuple[Findings, ...]
    skipped: tuple[str, ...]

    def summary(self) -> str:
        """Return the numbers of sets of views and of courses."""
        courses = sum(len(one.taught) for one in self.findings)
        return f"{count(len(self.findings), 'set')} of views, {count(courses, 'course')}"


@contextmanager
def silent(_: int) -> Iterator[Tick]:
    """Yield a stage that shows no progress.

    Yields
    ------
    callable
        Tick that ignores its message.
    """
    yield lambda _: None


def run(plan: OpenEndedPlan, stage: Stage = silent, entered: Sequence[str] | None = None) -> OpenEnded:
    """Run the open-ended learning experiment of a plan.

    Parameters
    ----------
    plan
        The kinds, orders and seed of the run.
    stage
        Opens a stage with its number of steps, and gives the function to call after each step.
    entered
        The names of the contestants; all if None.

    Returns
    -------
    The courses and the scores of single views, for each set of things, and a list of the skipped parts.

    Raises
    ------
    MissingExtraError
        Before any work, if the simulator or a contestant needs a package that is not installed.
    """
    if entered is None or SVDD in entered:
        require("sklearn", "the learner SVDD")
    require("open3d", "simulating views")
    codebook = Codebook.of(_simulated_views(plan, 2, plan.seed + 1000, stage).views, seed=plan.seed)
    able = {name: make for name, make in contestants(codebook).items() if entered is None or name in entered}
    findings = [_evaluate(plan, _simulated_views(plan, plan.instances, plan.seed, stage), able, stage)]
    skipped = []
    if plan.meshes is None:
        skipped.append(f"meshes: a full run shows those in $DEIXIS_DATA/{FOLDER}/; a quick run has none")
    else:
        folder = plan.meshes

        def describe() -> DescribedViews:
            with stage(len(rows_of(folder))) as tick:
                return describe_views("meshes", from_meshes(folder, plan.mesh_views, plan.seed), tick)

        meshes = cached_views(plan.cache, f"meshes {folder.resolve()} {plan.mesh_views} {plan.seed}", describe)
        findings.append(_evaluate(plan, meshes, able, stage, keep_back=True))
    return OpenEnded(plan, tuple(findings), tuple(skipped))


def _simulated_views(plan: OpenEndedPlan, instances: int, seed: int, stage: Stage) -> DescribedViews:
    def make() -> DescribedViews:
        with stage(instances * len(plan.kinds)) as tick:
            return describe_views("simulator", simulated(plan.kinds, instances, plan.views, seed), tick)

    return cached_views(plan.cache, f"simulator {plan.kinds} {instances} {plan.views} {seed}", make)


def _evaluate(
    plan: OpenEndedPlan, data: DescribedViews, able: Contestants, stage: Stage, keep_back: bool = False
) -> Findings:
    with stage(len(able) * plan.orders) as tick:
        taught = tuple(
            _run_course(plan, data, name, make, seed, tick) for name, make in able.items() for seed in plan.seeds()
        )
    with stage(2 * len(data.views)) as tick:
        matrices = {D2: d2_distances(data), **{name: view_matrix(data, name, tick) for name in (SPIN, UPRIGHT)}}
    nearest = _score_single_views(plan, data, matrices)
    places = np.concatenate([data.of(kind) for kind in data.kinds[1::2]])
    part = {key: matrix[np.ix_(places, places)] for key, matrix in matrices.items()}
    rest = _score_single_views(plan, data.at(places), part) if keep_back else {}
    things = len(np.unique(data.instances))
    return Findings(data.name, data.kinds, things, len(data.views), taught, nearest, rest)


def _run_course(
    plan: OpenEndedPlan, data: DescribedViews, name: str, make: Callable[[], Learner], seed: int, tick: Tick
) -> CourseResult:
    """Run one course, which depends on the seed alone and is the same for every contestant."""
    split, learner = by_things(data, seed), make()
    order = [str(kind) for kind in np.random.default_rng(seed).permutation(data.kinds)]
    course = teach(learner, _views(data, split, None), order, plan.teaching, seed)
    rest = _views(data, split, plan.asked)
    known = order[: len(course.introduced)]
    right = [learner.predict(view).best == kind for kind in known for view in rest[kind]]
    tick(f"{data.name}: {name}")
    return CourseResult(name, course, float(np.mean(right)))


def _views(data: DescribedViews, split: Split, asked: int | None) -> dict[str, list[ViewFeatures]]:
    places = split.taught if asked is None else split.asked
    found: dict[str, list[ViewFeatures]] = {kind: [] for kind in data.kinds}
    for place in places:
        found[data.categories[place]].append(data.views[place])
    return {kind: views[:asked] for kind, views in found.items()}


def _score_single_views(plan: OpenEndedPlan, data: DescribedViews, matrices: dict[str, Matrix]) -> Ways:
    return {
        (title, way.name): tuple(
            split_scores(data, matrices[way.descriptor], cut(data, seed), way.settings) for seed in plan.seeds()
        )
        for title, cut in SPLITS.items()
        for way in NAMING_METHODS
    }
