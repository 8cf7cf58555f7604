"""Run the experiment: a teacher points at four things, describes layouts on first tables, and the robot checks others.

The robot sees clouds, and the joints of a simulated teacher who points. The truth serves the teacher and the scores.
"""

from __future__ import annotations

import multiprocessing
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from deixis.answers import Answer, count
from deixis.examples_data import example
from deixis.experiments.apprentice.scoring import Count, TableScore, score, total, true_things
from deixis.experiments.apprentice.tables import Tampered, lay_tampered
from deixis.extras import require
from deixis.grammar.utterances import Utterance
from deixis.ontology.things.kinds import plain_name
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.simulator.cameras.depth import DepthSensor
from deixis.perception.simulator.teacher import Teacher
from deixis.robot.looking import Look, TableKnowledge
from deixis.robot.robot import Robot, perceived
from deixis.workflows.layouts.read import read_script
from deixis.workflows.scenes.simulate import CameraSetup, Simulation, simulate

if TYPE_CHECKING:
    from deixis.grammar.script import Script
    from deixis.perception.scene import Scene

LAYOUTS = ("formal_dinner", "script2", "informal", "breakfast", "tea", "childs_place")
"""Layouts of the tables; script2 is the formal dinner with three more glasses, in other words."""

SHOWN = ("dinner_plate", "dinner_fork", "dinner_knife", "napkin")
"""Categories that are taught by pointing."""

FIRST_TABLES = 3
"""Number of tables of each layout on which the teacher describes it."""

Tick = Callable[[], None]


@dataclass(frozen=True)
class ApprenticePlan:
    """The plan of a run.

    Attributes
    ----------
    tables
        Number of further tables, which are checked.
    seed
        Seed of all tables.
    noise
        Factor on the noise of the depth camera.
    first_tables
        Number of tables of each layout on which the teacher describes it.
    layouts
        Names of the shipped layouts.
    processes
        Number of processes; None for one for each processor.
    """

    tables: int = 100
    seed: int = 1
    noise: float = 1.0
    first_tables: int = FIRST_TABLES
    layouts: tuple[str, ...] = LAYOUTS
    processes: int | None = None

    @property
    def steps(self) -> int:
        """Number of tables that are seen."""
        return self.first_tables * len(self.layouts) + self.tables


@dataclass(frozen=True)
class LessonScore:
    """Score of a first table: new things, at which the teacher did not point, and what was learned about them.

    ``singled_out`` counts the new things that the words single out if the table is seen perfectly (its true boxes,
    without names), and those of them that the robot learned right; ``learned`` counts the new things that it learned,
    and how many of these are right.
    """

    layout: str
    singled_out: Count
    learned: Count
    questions: int
    waiting: tuple[str, ...]


@dataclass(frozen=True)
class Taught:
    """A first table with its truth: names of detected things, roles that the words single out, and the questions."""

    number: int
    layout: str
    truth: Mapping[str, str]
    singled_out: tuple[str, ...]
    questions: int


@dataclass(frozen=True, repr=False)
class Apprentice(Answer):
    """The findings of a run."""

    plan: ApprenticePlan
    lessons: tuple[LessonScore, ...]
    tables: tuple[TableScore, ...]

    def summary(self) -> str:
        """Return the numbers of first and of further tables, and the share of things that were named right."""
        named = figures(self)["names_right"]
        further = f"{len(self.tables)} further {'table' if len(self.tables) == 1 else 'tables'}"
        return f"{count(len(self.lessons), 'first table')}, {further}: {named.right} of {named.of} things named right"

    @property
    def questions(self) -> int:
        """Number of questions that the robot asked."""
        return sum(one.questions for one in self.lessons) + sum(one.questions for one in self.tables)


def run(plan: ApprenticePlan, tick: Tick = lambda: None) -> Apprentice:
    """Teach a robot, and let it check further tables.

    Parameters
    ----------
    plan
        The plan. The same plan gives the same findings.
    tick
        Called after each table.

    Returns
    -------
    Apprentice
        Scores of the first tables and of the further ones.
    """
    require("open3d", "simulating tables")
    with tempfile.TemporaryDirectory() as folder, closing(Robot(folder)) as robot:
        taught_lessons = []
        for lesson in teach(robot, plan):
            taught_lessons.append(lesson)
            tick()
        lessons = [lesson_score(robot, lesson) for lesson in taught_lessons]
        knowledge = robot.knowledge()
        numbers = range(plan.tables)
        processes = min(plan.processes or len(os.sched_getaffinity(0)), max(plan.tables, 1))
        if processes == 1:
            scores = []
            for number in numbers:
                scores.append(check_table(knowledge, plan, number))
                tick()
            return Apprentice(plan, tuple(lessons), tuple(scores))
    # The memory is closed: the processes need what was learned, not the stores.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, context, _begin, (knowledge.portable(), plan)) as pool:
        scores = []
        for found in pool.map(_check_in_process, numbers):
            scores.append(found)
            tick()
    return Apprentice(plan, tuple(lessons), tuple(scores))


def teach(robot: Robot, plan: ApprenticePlan) -> Iterator[Taught]:
    """Point at things on the first tables, tell all layouts, answer questions, and let the robot reconsider.

    Parameters
    ----------
    robot
        The robot, whose memory is empty.
    plan
        The plan.

    Yields
    ------
    Taught
        Each first table with its truth.
    """
    scripts = scripts_of(plan)
    pointed_at: set[str] = set()
    for number in range(plan.first_tables):
        for place, name in enumerate(plan.layouts):
            _, look = seen_table(scripts[name], plan, _seed(plan, 0, number, place), mistakes=0)
            scene = robot.sees(look.cloud)
            truth = true_things(look, scene)
            if left := {id: name for id, name in truth.items() if name in SHOWN and name not in pointed_at}:
                pointed_at |= point_at(robot, left, _seed(plan, 2, number, place))
            answer = robot.told(scripts[name])
            wanted = tuple(role for role in singled_out(scripts[name], look) if plain_name(role) not in SHOWN)
            yield Taught(answer.lesson.number, name, truth, wanted, answer_questions(robot, truth))
    robot.reconsider()


def point_at(robot: Robot, things: Mapping[str, str], seed: int) -> set[str]:
    """Let a simulated teacher point at things of the present table, and say what each is.

    The robot sees the noisy joints of the teacher's arms, and learns what :func:`deixis.workflows.scenes.point.point`
    decides.

    Parameters
    ----------
    robot
        The robot.
    things
        Name of each thing by its id.
    seed
        Seed of the teacher.

    Returns
    -------
    set of str
        Names that were taught; the others were refused, since the gesture was not clear.
    """
    from deixis.workflows.scenes.point import point

    order = sorted(things, key=lambda id: things[id])
    recording = Teacher(robot.scene, seed).points_at(order, hold=1.0)
    utterances = [
        Utterance(f"this is a {things[id].replace('_', ' ')}", aim.start, aim.finish)
        for id, aim in zip(order, recording.aims, strict=True)
    ]
    taught = set()
    for label in point(recording.skeletons, robot.scene, utterances).taught:
        assert label.name is not None and label.target is not None
        name = label.name.replace(" ", "_")
        robot.shown(name, label.target, by="teacher")
        taught.add(name)
    return taught


def answer_questions(robot: Robot, truth: Mapping[str, str]) -> int:
    """Let the teacher answer the questions of a robot about the present table.

    Parameters
    ----------
    robot
        The robot.
    truth
        Name of the true thing by id of the detected one.

    Returns
    -------
    int
        Number of questions.
    """
    place = {name: id for id, name in truth.items()}
    number = 0
    while robot.questions:
        question = robot.questions[0]
        robot.answers(question, place.get(question.role), by="teacher")
        number += 1
    return number


def lesson_score(robot: Robot, lesson: Taught) -> LessonScore:
    """Score a lesson by what the robot knows about its table in the end.

    Parameters
    ----------
    robot
        The robot.
    lesson
        The lesson with its truth.

    Returns
    -------
    LessonScore
        The score.
    """
    known = robot.lessons[lesson.number]
    new = [role for role in known.settled if plain_name(role) not in SHOWN]
    right = {role for role in new if lesson.truth.get(known.settled[role].thing) == role}
    return LessonScore(
        lesson.layout,
        Count(sum(role in right for role in lesson.singled_out), len(lesson.singled_out)),
        Count(len(right), len(new)),
        lesson.questions,
        tuple(known.waiting),
    )


def singled_out(script: Script, look: Simulation) -> tuple[str, ...]:
    """Return the roles that the words single out if the table is seen perfectly, without names.

    Parameters
    ----------
    script
        The layout.
    look
        A table that is laid so.

    Returns
    -------
    tuple of str
        Roles whose match in the true boxes is decided.
    """
    from deixis.workflows.grounding.ground import ground

    found = ground(script, look.truth.without_labels())
    return tuple(name for name, match in found.object_matches.items() if match.decided)


def scripts_of(plan: ApprenticePlan) -> dict[str, Script]:
    """Return the layouts of a plan.

    Parameters
    ----------
    plan
        The plan.

    Returns
    -------
    dict
        Script by name of the layout.
    """
    return {name: read_script(example(f"{name}.layout")) for name in plan.layouts}


def _seed(plan: ApprenticePlan, *place: int) -> int:
    """Return the seed of a table, from the seed of the plan and the place of the table in it."""
    return int(np.random.SeedSequence([plan.seed, *place]).generate_state(1)[0])


def seen_table(
    script: Script, plan: ApprenticePlan, seed: int, mistakes: int | None = None
) -> tuple[Tampered, Simulation]:
    """Lay a table, tamper with it, and look at it.

    Parameters
    ----------
    script
        The layout.
    plan
        The plan, which has the noise of the camera.
    seed
        Seed of the table.
    mistakes
        Number of mistakes; None to draw it.

    Returns
    -------
    tuple
        The table with the truth, and the look at it.
    """
    table = lay_tampered(script, seed, mistakes)
    return table, simulate(table.laid, CameraSetup(sensor=DepthSensor(noise=plan.noise)), seed)


def check_table(knowledge: TableKnowledge, plan: ApprenticePlan, number: int) -> TableScore:
    """Let a robot look at a further table, and score what it says.

    Parameters
    ----------
    knowledge
        What the robot learned.
    plan
        The plan.
    number
        Number of the table, from 0.

    Returns
    -------
    TableScore
        The score.
    """
    _, table, look, scene, understood, layout = looked_at(knowledge, plan, number)
    taught = {one.name for one in knowledge.known.recogniser.parts[0].categories}
    return score(understood, table, layout, true_things(look, scene), taught)


def looked_at(
    knowledge: TableKnowledge, plan: ApprenticePlan, number: int
) -> tuple[int, Tampered, Simulation, Scene, Look, str]:
    """Look at a further table.

    Parameters
    ----------
    knowledge
        What the robot learned.
    plan
        The plan.
    number
        Number of the table, from 0.

    Returns
    -------
    tuple
        Seed, table, simulated look, scene, what the robot understood, and the name of the true layout.
    """
    layout = plan.layouts[number % len(plan.layouts)]
    seed = _seed(plan, 1, number)
    table, look = seen_table(scripts_of(plan)[layout], plan, seed)
    bare = PointCloud(look.cloud.points, look.cloud.colours, organised=look.cloud.organised, origin=look.cloud.origin)
    scene = perceived(bare)
    return seed, table, look, scene, knowledge.look(scene), layout


_HELD: dict[str, Any] = {}
"""Knowledge and plan of a process, which its first call sets."""


def _begin(portable: Any, plan: ApprenticePlan) -> None:
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    _HELD["knowledge"], _HELD["plan"] = TableKnowledge.from_portable(portable), plan


def _check_in_process(number: int) -> TableScore:
    return check_table(_HELD["knowledge"], _HELD["plan"], number)


def figures(found: Apprentice) -> dict[str, Count]:
    """Return the figures that the experiment is measured by.

    Parameters
    ----------
    found
        The findings.

    Returns
    -------
    dict
        Count by the key of the JSON report.
    """
    return {
        "new_things_right": total(one.singled_out for one in found.lessons),
        "names_right": total(one.names for one in found.tables),
        "mistake_precision": total(each for one in found.tables for each in one.true_reports.values()),
        "mistake_recall": total(each for one in found.tables for each in one.found.values()),
        "layouts_right": total(one.layout for one in found.tables),
    }


def kinds_of(scores: Sequence[TableScore]) -> dict[str, tuple[Count, Count]]:
    """Return precision and recall by kind of mistake.

    Parameters
    ----------
    scores
        Scores of tables.

    Returns
    -------
    dict
        Count of true reports and of found mistakes, by kind.
    """
    from deixis.reasoning.comparison.explanation import MistakeKind

    return {
        kind.value: (total(one.true_reports[kind] for one in scores), total(one.found[kind] for one in scores))
        for kind in MistakeKind
    }
