"""Several learners side by side, combined, and the one that did best lately gives the answer."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from math import prod

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Learner, Prediction
from deixis.perception.recognition.learners.view_features import ViewFeatures

VOTE, BELIEF = "majority vote", "Dempster-Shafer"


class Committee:
    """Learners over different representations, their majority vote and their Dempster-Shafer combination.

    Taken from L. Seabra Lopes, A. Chauhan: Open-ended category learning for language acquisition, Connection Science
    20(4), 2008: each classifier has a representation of its own; combinations stand beside the classifiers as further
    ones; after every answer that the teacher confirms or corrects the success of each over the last ``window`` such
    answers is known, combinations are made from the ``best`` most successful classifiers, and attention goes to
    whichever, classifier or combination, was the most successful lately (before any answer, and among equals, to the
    first in the order of ``outlook``). Changed: members are whole learners, so that any can join. Left out: their
    features of 2-D images and their pyramid match.

    A member whose recent success rate is r (successes + 1 over answers + 2) lends mass r to its first choice and
    leaves 1 - r to ignorance; Dempster's rule of these. Unknown is the first member's.
    """

    name = "committee"

    def __init__(self, members: Sequence[Learner], window: int = 50, best: int = 3) -> None:
        names = [member.name for member in members]
        if not members or len(set(names)) < len(names) or window < 1 or best < 1:
            raise RecognitionError(
                f"a committee has one member or more, each with a name of its own, not {names}; "
                f"its window ({window}) and its combinations ({best}) are 1 or more"
            )
        self._members, self._best = tuple(members), best
        self._lately = {name: deque[bool](maxlen=window) for name in (BELIEF, VOTE, *names)}
        self._asked: tuple[ViewFeatures, dict[str, Prediction]] | None = None

    @property
    def categories(self) -> tuple[str, ...]:
        """The first member's, which are everybody's."""
        return self._members[0].categories

    @property
    def stored(self) -> int:
        """The first member's: all are taught the same views."""
        return self._members[0].stored

    @property
    def outlook(self) -> dict[str, float]:
        """The recent success rate of every member and combination; (successes + 1) / (answers + 2)."""
        return {name: (sum(lately) + 1) / (len(lately) + 2) for name, lately in self._lately.items()}

    @property
    def attended(self) -> str:
        """The member or combination that answers now."""
        outlook = self.outlook
        return max(outlook, key=lambda name: outlook[name])

    def predict(self, view: ViewFeatures) -> Prediction:
        """Return what the attended one says."""
        return self._opinions(view)[self.attended]

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Teach all members."""
        self._changed()
        for member in self._members:
            member.learn(category, view)

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Note who was right, and correct every member."""
        self._watch(category, view)
        for member in self._members:
            member.correct(category, view)

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Note who was right, and tell every member."""
        self._watch(category, view)
        for member in self._members:
            member.confirm(category, view)

    def forget(self, category: str) -> None:
        """Forget the category in every member; success goes on being counted."""
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
        self._asked = None

    def _watch(self, category: str, view: ViewFeatures) -> None:
        for name, opinion in self._opinions(view).items():
            self._lately[name].append(opinion.best == category)
        self._changed()

    def _opinions(self, view: ViewFeatures) -> dict[str, Prediction]:
        """Return what everybody says of the view; kept, since a teacher tells about the view that was just asked
        for."""
        if self._asked is None or self._asked[0] is not view:
            said = {member.name: member.predict(view) for member in self._members}
            unknown = next(iter(said.values())).unknown
            outlook = self.outlook
            chosen = sorted(said, key=lambda name: -outlook[name])[: self._best]
            support = [(said[name].best, outlook[name]) for name in chosen]
            heard = [(category, weight) for category, weight in support if category is not None]
            self._asked = (
                view,
                {
                    **{
                        BELIEF: Prediction.of(dempster_shafer(heard), unknown),
                        VOTE: Prediction.of(majority(heard), unknown),
                    },
                    **said,
                },
            )
        return self._asked[1]


def majority(support: Sequence[tuple[str, float]]) -> dict[str, float]:
    """Return votes by category; of as many votes the earlier voter's category is ahead, by less than a vote.

    >>> votes = majority([("cup", 0.9), ("mug", 0.6), ("mug", 0.5)])
    >>> max(votes, key=votes.__getitem__)
    'mug'
    """
    votes = Counter(category for category, _ in support)
    first = list(dict.fromkeys(category for category, _ in support))
    return {category: votes[category] - 1e-6 * first.index(category) for category in first}


def dempster_shafer(support: Sequence[tuple[str, float]]) -> dict[str, float]:
    """Return combined masses of categories, each of (category, mass) leaving the rest of its mass to ignorance; masses
    < 1.

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
