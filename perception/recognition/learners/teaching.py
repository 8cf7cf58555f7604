"""The protocol of open-ended learning: a simulated teacher names, asks and corrects, until nothing more is learnt.

A. Chauhan, L. Seabra Lopes: Using spoken words to guide open-ended category formation, Cognitive Processing 12, 2011;
measures as in S. H. Kasaei et al.: Interactive open-ended learning for 3D object recognition, Journal of Intelligent
and Robotic Systems 80, 2015.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.calibration import auroc
from deixis.perception.recognition.learners.learner import Learner
from deixis.perception.recognition.learners.view_features import ViewFeatures


@dataclass(frozen=True)
class Teaching:
    """How a teacher teaches: a category more is introduced once the share of right answers is above ``threshold``.

    The share is that over the last ``window`` * n answers, n being the categories known, of those given since the last
    category was introduced, and counts once there are n of them: each category was asked for once. After ``patience``
    answers since then without success the teacher gives up. ``first`` views introduce a category: three, since
    equation 3 needs two, and with two rests on a single pair.
    """

    threshold: float = 0.67
    window: int = 3
    patience: int = 100
    first: int = 3

    def __post_init__(self) -> None:
        if not 0.0 <= self.threshold < 1.0 or min(self.window, self.patience, self.first) < 1:
            raise RecognitionError(
                f"a teacher's threshold lies in [0, 1), and window, patience and first views are 1 or more, not {self}"
            )


class End(Enum):
    """Why a course ended: all categories were learnt, patience ran out, or a category had no view left."""

    LEARNT = "all learnt"
    FRUITLESS = "no progress"
    NO_VIEWS = "no views left"


@dataclass(frozen=True)
class TaughtAnswer:
    """One question: what was shown, what the learner said and its doubt that it was any known category, how many
    categories it knew, how many instances it had stored afterwards, and the share of right answers that the teacher
    watches."""

    category: str
    said: str | None
    unknown: float
    known: int
    stored: int
    accuracy: float

    @property
    def right(self) -> bool:
        return self.said == self.category


@dataclass(frozen=True)
class Course:
    """A course of teaching from beginning to end. ``introduced`` holds, for each category, the answers given before;
    ``doubts`` the learner's doubt about each view that introduced a category, before it was taught any of these; the
    first category has none, as nothing was known."""

    learner: str
    order: tuple[str, ...]
    answers: tuple[TaughtAnswer, ...]
    introduced: tuple[int, ...]
    doubts: tuple[float, ...]
    learnt: int
    stored: int
    end: End

    @property
    def iterations(self) -> int:
        """QCI: question and correction iterations."""
        return len(self.answers)

    @property
    def instances(self) -> float:
        """Instances stored per category that was introduced; their mean over courses is AIC."""
        return self.stored / len(self.introduced)

    @property
    def global_accuracy(self) -> float:
        """GCA: the share of all answers that were right; nan without one."""
        return float(np.mean([answer.right for answer in self.answers])) if self.answers else float("nan")

    @property
    def protocol_accuracy(self) -> float:
        """APA: the mean over iterations of the accuracy that the teacher watches; nan without one."""
        return float(np.mean([answer.accuracy for answer in self.answers])) if self.answers else float("nan")

    @property
    def unknown_auroc(self) -> float:
        """How well the learner's doubt tells views of categories not yet taught from those it was asked about: the
        probability that it is greater of one of the former; nan where no category came after another."""
        return auroc(np.array([answer.unknown for answer in self.answers]), np.array(self.doubts))


def teach(
    learner: Learner,
    views: Mapping[str, Sequence[ViewFeatures]],
    order: Sequence[str],
    teaching: Teaching | None = None,
    seed: int = 0,
    tick: Callable[[], None] = lambda: None,
) -> Course:
    """Teach categories in that order; each view is shown once at most, those of a category in the order given.

    Questions go round: each known category is asked for once, in random order, then again. A wrong answer is
    corrected, a right one confirmed. ``tick`` is called after each answer. Raises RecognitionError where the order is
    empty, names a category twice, or one that has not a view to introduce and one to ask for, and where the learner
    knows something already.
    """
    settings = teaching or Teaching()
    _require(learner, views, order, settings)
    rng, unseen = np.random.default_rng(seed), {name: iter(views[name]) for name in order}
    answers: list[TaughtAnswer] = []
    introduced: list[int] = []
    doubts: list[float] = []
    learnt, end = 0, End.LEARNT
    for category in order:
        first = [next(unseen[category]) for _ in range(settings.first)]
        if introduced:
            doubts += [learner.predict(view).unknown for view in first]
        introduced.append(len(answers))
        for view in first:
            learner.learn(category, view)
        failed = _practise(learner, unseen, order[: len(introduced)], settings, rng, answers, tick)
        if failed is not None:
            end = failed
            break
        learnt += 1
    return Course(
        learner.name, tuple(order), tuple(answers), tuple(introduced), tuple(doubts), learnt, learner.stored, end
    )


def _practise(
    learner: Learner,
    unseen: Mapping[str, Iterator[ViewFeatures]],
    known: Sequence[str],
    settings: Teaching,
    rng: np.random.Generator,
    answers: list[TaughtAnswer],
    tick: Callable[[], None],
) -> End | None:
    """Ask about the known categories until the share of right answers passes; else why it did not."""
    right: list[bool] = []
    while len(right) < settings.patience or len(right) < len(known):
        for place in rng.permutation(len(known)):
            category = known[place]
            view = next(unseen[category], None)
            if view is None:
                return End.NO_VIEWS
            found = learner.predict(view)
            if found.best == category:
                learner.confirm(category, view)
            else:
                learner.correct(category, view)
            right.append(found.best == category)
            accuracy = float(np.mean(right[-settings.window * len(known) :]))
            answers.append(TaughtAnswer(category, found.best, found.unknown, len(known), learner.stored, accuracy))
            tick()
            if len(right) >= len(known) and accuracy > settings.threshold:
                return None
            if len(right) >= max(settings.patience, len(known)):
                break
    return End.FRUITLESS


def _require(
    learner: Learner, views: Mapping[str, Sequence[ViewFeatures]], order: Sequence[str], settings: Teaching
) -> None:
    if not order or len(set(order)) < len(order):
        raise RecognitionError(f"a course teaches one category or more, each once, not {list(order)}")
    if learner.categories:
        raise RecognitionError(f"a course begins from nothing, and the learner knows {', '.join(learner.categories)}")
    for name in order:
        if len(views.get(name, ())) <= settings.first:
            raise RecognitionError(
                f"'{name}' has {len(views.get(name, ()))} views; {settings.first} to introduce it are needed, and one"
                " to ask about"
            )
