"""A committee of learners: the member or combination with the best recent success rate answers."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from math import prod

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Learner, Prediction
from deixis.perception.recognition.learners.view_features import ViewFeatures

VOTE, BELIEF = "majority vote", "Dempster-Shafer"


class Committee(Learner):
    """Learner that combines others by majority vote and by Dempster-Shafer evidence, and follows the best of all.

    The method is that of L. Seabra Lopes, A. Chauhan: Open-ended category learning for language acquisition, Connection
    Science 20(4), 2008. Each classifier has its own representation, and combinations count as further classifiers. The
    success of each over the last ``window`` answers that the teacher confirmed or corrected is recorded. Combinations
    are made from the ``best`` most successful classifiers, and the most successful classifier or combination answers
    (before any answer, and among equals, the first in the order of ``accuracies``). Changed: members are whole
    learners, so that any can join. Omitted: features of 2-D images, and the pyramid match.

    A member with the recent success rate r = (successes + 1) / (answers + 2) gives mass r to its first choice and 1 - r
    to ignorance; these are combined by Dempster's rule. ``unknown`` is that of the first member.
    """

    name = "committee"

    def __init__(self, members: Sequence[Learner], window: int = 50, best: int = 3) -> None:
        names = [member.name for member in members]
        if not members or len(set(names)) < len(names) or window < 1 or best < 1:
            raise RecognitionError(
                f"a committee must have at least one member, with distinct names, got {names}; "
                f"`window` ({window}) and `best` ({best}) must be at least 1"
            )
        self._members, self._best = tuple(members), best
        self._recent_successes = {name: deque[bool](maxlen=window) for name in (BELIEF, VOTE, *names)}
        self._last_prediction: tuple[ViewFeatures, dict[str, Prediction]] | None = None

    @property
    def categories(self) -> tuple[str, ...]:
        """Names of the categories, which all members share."""
        return self._members[0].categories

    @property
    def stored(self) -> int:
        """Number of instances that the first member stores."""
        return self._members[0].stored

    @property
    def accuracies(self) -> dict[str, float]:
        """Recent success rate of every member and combination, (successes + 1) / (answers + 2)."""
        return {name: (sum(successes) + 1) / (len(successes) + 2) for name, successes in self._recent_successes.items()}

    @property
    def attended(self) -> str:
        """Name of the member or combination that answers now."""
        accuracies = self.accuracies
        return max(accuracies, key=lambda name: accuracies[name])

    def predict(self, view: ViewFeatures) -> Prediction:
        """Return the prediction of the member or combination that answers now."""
        return self._predictions(view)[self.attended]

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Teach all members."""
        self._changed()
        for member in self._members:
            member.learn(category, view)

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Record which members were right, and correct every member."""
        self._watch(category, view)
        for member in self._members:
            member.correct(category, view)

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Record which members were right, and confirm the answer to every member."""
        self._watch(category, view)
        for member in self._members:
            member.confirm(category, view)

    def forget(self, category: str) -> None:
        """Forget the category in every member, but keep the record of success."""
        self._changed()
        for member in self._members:
            member.forget(category)

    def rename(self, category: str, name: str) -> None:
        """Rename the category in every member."""
        self._changed()
        for member in self._members:
            member.rename(category, name)

    def merge(self, category: str, into: str) -> None:
        """Merge the categories in every member."""
        self._changed()
        for member in self._members:
            member.merge(category, into)

    def _changed(self) -> None:
        self._last_prediction = None

    def _watch(self, category: str, view: ViewFeatures) -> None:
        for name, prediction in self._predictions(view).items():
            self._recent_successes[name].append(prediction.best == category)
        self._changed()

    def _predictions(self, view: ViewFeatures) -> dict[str, Prediction]:
        """Return all predictions for a view; cached, since the teacher answers for the view of the last question."""
        if self._last_prediction is None or self._last_prediction[0] is not view:
            predictions = {member.name: member.predict(view) for member in self._members}
            unknown = next(iter(predictions.values())).unknown
            accuracies = self.accuracies
            chosen = sorted(predictions, key=lambda name: -accuracies[name])[: self._best]
            support = [(predictions[name].best, accuracies[name]) for name in chosen]
            votes = [(category, weight) for category, weight in support if category is not None]
            self._last_prediction = (
                view,
                {
                    **{
                        BELIEF: Prediction.of(dempster_shafer(votes), unknown),
                        VOTE: Prediction.of(majority(votes), unknown),
                    },
                    **predictions,
                },
            )
        return self._last_prediction[1]


def majority(support: Sequence[tuple[str, float]]) -> dict[str, float]:
    """Return the votes by category; ties go to the category of the earlier voter, by less than one vote.

    Parameters
    ----------
    support
        Pairs of the category that a member votes for, and its mass, in the order of the members.

    Returns
    -------
    dict
        Number of votes for each category, reduced by less than one for the later ones.

    Examples
    --------
    >>> votes = majority([("cup", 0.9), ("mug", 0.6), ("mug", 0.5)])
    >>> max(votes, key=votes.__getitem__)
    'mug'
    """
    votes = Counter(category for category, _ in support)
    first = list(dict.fromkeys(category for category, _ in support))
    return {category: votes[category] - 1e-6 * first.index(category) for category in first}


def dempster_shafer(support: Sequence[tuple[str, float]]) -> dict[str, float]:
    """Return the masses of categories combined by Dempster's rule.

    Parameters
    ----------
    support
        Pairs of a category and its mass, below 1; the rest of each mass goes to ignorance.

    Returns
    -------
    dict
        Mass of each category. Together with the mass of ignorance, the sum is 1.

    Examples
    --------
    >>> masses = dempster_shafer([("cup", 0.5), ("mug", 0.5)])
    >>> round(masses["cup"], 3), round(masses["mug"], 3)
    (0.333, 0.333)
    """
    doubts = {
        category: prod(1.0 - mass for name, mass in support if name == category)
        for category in dict.fromkeys(category for category, _ in support)
    }
    ignorance = prod(doubts.values())
    masses = {category: (1.0 - doubt) * ignorance / doubt for category, doubt in doubts.items()}
    total = ignorance + sum(masses.values())
    return {category: mass / total for category, mass in masses.items()}
