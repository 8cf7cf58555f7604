"""The teaching protocol of open-ended learning: a simulated teacher names, asks and corrects until progress ends.

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
    """Settings of the teacher, who introduces a new category when the share of right answers is above ``threshold``.

    The share is that of the last ``window`` * n answers since the last introduction, for n known categories, and counts
    after n answers, when each category was asked for once. The teacher gives up after ``patience`` answers without
    success. ``first`` is the number of views that introduce a category: three, since equation 3 needs two, and would
    then depend on a single pair.
    """

    threshold: float = 0.67
    window: int = 3
    patience: int = 100
    first: int = 3

    def __post_init__(self) -> None:
        if not 0.0 <= self.threshold < 1.0 or min(self.window, self.patience, self.first) < 1:
            raise RecognitionError(
                "a teacher's `threshold` must be in [0, 1), and `window`, `patience` and `first` at least 1,"
                f" got {self}"
            )


class End(Enum):
    """Reason for the end of a course: all categories were learned, patience ran out, or a category had no view left."""

    LEARNED = "all learned"
    FRUITLESS = "no progress"
    NO_VIEWS = "no views left"


@dataclass(frozen=True)
class TaughtAnswer:
    """Answer to one question.

    ``category`` was shown, ``predicted`` is the answer, and ``unknown`` the score for no known category. ``known`` is
    the number of known categories, ``stored`` the number of instances stored afterwards, and ``accuracy`` the share of
    right answers that the teacher compares with the threshold.
    """

    category: str
    predicted: str | None
    unknown: float
    known: int
    stored: int
    accuracy: float

    @property
    def right(self) -> bool:
        """True if the answer is the category shown."""
        return self.predicted == self.category


@dataclass(frozen=True)
class Course:
    """A course of teaching from beginning to end.

    ``introduced`` holds, for each category, the number of answers before its introduction. ``doubts`` holds the scores
    for unknown of the views that introduced a category, before they were taught; the first category has none.
    """

    learner: str
    order: tuple[str, ...]
    answers: tuple[TaughtAnswer, ...]
    introduced: tuple[int, ...]
    doubts: tuple[float, ...]
    learned: int
    stored: int
    end: End

    @property
    def iterations(self) -> int:
        """Number of question and correction iterations (QCI)."""
        return len(self.answers)

    @property
    def instances(self) -> float:
        """Number of stored instances per introduced category; its mean over courses is AIC."""
        return self.stored / len(self.introduced)

    @property
    def global_accuracy(self) -> float:
        """Global classification accuracy (GCA), the share of right answers; nan without answers."""
        return float(np.mean([answer.right for answer in self.answers])) if self.answers else float("nan")

    @property
    def protocol_accuracy(self) -> float:
        """Average protocol accuracy (APA), the mean of the answers' ``accuracy``; nan without answers."""
        return float(np.mean([answer.accuracy for answer in self.answers])) if self.answers else float("nan")

    @property
    def unknown_auroc(self) -> float:
        """Area under the ROC curve of the scores for unknown: views of new categories against views of known ones.

        It is nan if only one category was introduced.
        """
        return auroc(np.array([answer.unknown for answer in self.answers]), np.array(self.doubts))


def teach(
    learner: Learner,
    views: Mapping[str, Sequence[ViewFeatures]],
    order: Sequence[str],
    teaching: Teaching | None = None,
    seed: int = 0,
    tick: Callable[[], None] = lambda: None,
) -> Course:
    """Teach categories to a learner by the protocol, and return the course.

    The teacher asks for each known category once per round, in random order, corrects wrong answers and confirms right
    ones.

    Parameters
    ----------
    learner
        A learner without categories.
    views
        Views by category; each is shown at most once, in the order given.
    order
        Categories in the order of their introduction.
    teaching
        Settings of the teacher.
    seed
        Seed of the order of questions.
    tick
        Callback after each answer.

    Returns
    -------
    Course
        Answers in the order of the questions, and the number of answers before each introduction.

    Raises
    ------
    RecognitionError
        If the order is empty or repeats a category, a category has too few views, or the learner has categories.
    """
    settings = teaching or Teaching()
    _require(learner, views, order, settings)
    rng, unseen = np.random.default_rng(seed), {name: iter(views[name]) for name in order}
    answers: list[TaughtAnswer] = []
    introduced: list[int] = []
    doubts: list[float] = []
    learned, end = 0, End.LEARNED
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
        learned += 1
    return Course(
        learner.name, tuple(order), tuple(answers), tuple(introduced), tuple(doubts), learned, learner.stored, end
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
    """Ask for the known categories until the share of right answers passes; return the reason if it does not."""
    right: list[bool] = []
    while len(right) < settings.patience or len(right) < len(known):
        for place in rng.permutation(len(known)):
            category = known[int(place)]
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
        raise RecognitionError(f"a course must teach at least one category, each once, got {list(order)}")
    if learner.categories:
        raise RecognitionError(
            f"a course must begin without categories, but the learner knows {', '.join(learner.categories)}"
        )
    for name in order:
        if len(views.get(name, ())) <= settings.first:
            raise RecognitionError(
                f"'{name}' must have at least {settings.first + 1} views, {settings.first} to introduce it and one to"
                f" ask about, got {len(views.get(name, ()))}"
            )
