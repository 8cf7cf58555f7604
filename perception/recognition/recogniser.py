"""Recognition by equations 1 to 4 of the paper: nearest category by normalised distance, or unknown.

>>> near, far = np.zeros((3, 4), np.float32), np.full((3, 4), 9, np.float32)
>>> mug = InstanceCategory.of("mug", [("a", near), ("b", near + 1)])
>>> known = Recogniser.of([mug, InstanceCategory.of("fork", [("c", far)])])
>>> known.recognise(near + 0.5).label, known.recognise(near - 20).label
('mug', None)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.calibration import SHIPPED, Calibration, calibrate
from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.held_out import Progress, hold_out
from deixis.perception.recognition.index import Effort, Nearest, ViewIndex, indexes_of
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.settings import DEFAULT, MIN_LABEL_PROBABILITY, RecognitionSettings
from deixis.perception.recognition.spread import Spread, SpreadSource, spreads


@dataclass(frozen=True)
class Candidate:
    """A category compared with the target.

    ``distance`` is D_C (equation 2), ``nearest`` the id of the view that has it, ``spread`` its divisor (the ICD of
    equation 3, or its substitute), and ``normalised`` ND (equation 4). ``views`` is the number of the category's views,
    and ``probability`` that of the category being right. A category of empty views only is infinitely far, and its
    ``nearest`` is None.
    """

    category: str
    distance: float
    spread: Spread
    normalised: float
    nearest: str | None
    views: int
    probability: float


@dataclass(frozen=True)
class Recognition:
    """Answer of recognition: candidates in the order of their normalised distances (ND, equation 4), and the label.

    ``label`` is the category of the first candidate, or None if it is not probable enough. ``unknown`` is the
    probability that no category is right. ``exact`` is False for an approximate search. ``reasons`` explain the
    decision and its limitations in words.
    """

    label: str | None
    candidates: tuple[Candidate, ...]
    unknown: float
    calibration: Calibration
    exact: bool
    reasons: tuple[str, ...]

    @property
    def probability(self) -> float:
        """Probability of the answer: that of the label, or of unknown."""
        return self.candidates[0].probability if self.label is not None else self.unknown


def no_answer(calibration: Calibration, reason: str) -> Recognition:
    """Return the answer unknown, for a reason that prevents a comparison.

    Parameters
    ----------
    calibration
        Calibration of the recogniser.
    reason
        Reason in words.

    Returns
    -------
    Recognition
        Answer without candidates; the probability of unknown is 1.
    """
    return Recognition(None, (), 1.0, calibration, True, (reason,))


def decided(
    ranked: Sequence[Candidate], unknown: float, calibration: Calibration, exact: bool, by_threshold: bool
) -> Recognition:
    """Return the decision between the nearest category and unknown, with its reasons.

    Parameters
    ----------
    ranked
        Candidates in ascending order of ND, at least one.
    unknown
        Probability that no category is right.
    calibration
        Calibration with the threshold.
    exact
        False for an approximate search.
    by_threshold
        If True, compare the least ND with the threshold; if False, compare the probability of the nearest category with
        ``MIN_LABEL_PROBABILITY``.

    Returns
    -------
    Recognition
        Answer with the label, or without one if the view is unknown.
    """
    first = ranked[0]
    known = first.normalised <= calibration.threshold if by_threshold else first.probability >= MIN_LABEL_PROBABILITY
    label = first.category if known and first.nearest is not None else None
    reasons = [_comparison(first, calibration, by_threshold)]
    if first.spread.source in (SpreadSource.POOLED, SpreadSource.PRIOR) and first.nearest is not None:
        width = first.spread.width
        unit = "thing" if width.over_things else "view"
        what = f"has one {unit}" if width.count == 1 else f"has no two {unit}s that differ"
        divisor = "the median ICD of the others" if first.spread.source is SpreadSource.POOLED else "a constant"
        reasons.append(f"'{first.category}' {what}, so that D_C is divided by {divisor}")
    if not exact:
        reasons.append("the search for the nearest views was approximate")
    return Recognition(label, tuple(ranked), unknown, calibration, exact, tuple(reasons))


def _comparison(first: Candidate, calibration: Calibration, by_threshold: bool) -> str:
    """Return the reason for the decision: the nearest category, its distances, and its comparison with the limit."""
    if first.nearest is None:
        return "no remembered view has a descriptor"
    basis = f"from {calibration.known} held-out views" if calibration.calibrated else "a constant, not yet calibrated"
    nearest = (
        f"'{first.category}' is nearest: ND {first.normalised:.3g} (D_C {first.distance:.3g} to view '{first.nearest}'"
        f" / {_divisor(first)})"
    )
    if by_threshold:
        side = "within" if first.normalised <= calibration.threshold else "above"
        return f"{nearest}, {side} the threshold {calibration.threshold:.3g} ({basis})"
    side = "at least" if first.probability >= MIN_LABEL_PROBABILITY else "below"
    return f"{nearest}; its probability is {side} {MIN_LABEL_PROBABILITY:g} ({basis})"


def _divisor(first: Candidate) -> str:
    """Return the divisor of D_C, with its origin if it comes from the category itself."""
    width = first.spread.width
    own = f"{first.spread.value:.3g}: its ICD over {width.count} {'things' if width.over_things else 'views'}"
    match first.spread.source:
        case SpreadSource.MEASURED:
            return own
        case SpreadSource.SHRUNK:
            return f"{own}, {width.icd:.3g}, shrunk towards the median"
        case _:
            return f"{first.spread.value:.3g}"


@dataclass(frozen=True, eq=False)
class Recogniser:
    """Categories with their indexes and settings; it is immutable, and learning returns a new recogniser."""

    categories: tuple[InstanceCategory, ...]
    indexes: tuple[ViewIndex | None, ...]
    settings: RecognitionSettings
    calibration: Calibration

    @classmethod
    def of(
        cls,
        categories: Sequence[InstanceCategory],
        settings: RecognitionSettings = DEFAULT,
        calibration: Calibration = SHIPPED,
    ) -> Recogniser:
        """Return a recogniser of categories, with their indexes.

        Parameters
        ----------
        categories
            Categories with distinct names.
        settings
            Settings of recognition.
        calibration
            Parameters of decision and probabilities.

        Returns
        -------
        Recogniser
            Recogniser with one reduction for all categories.

        Raises
        ------
        RecognitionError
            If names are equal, or descriptors are of unequal length.
        """
        names = [category.name for category in categories]
        if len(set(names)) < len(names):
            raise RecognitionError(f"the names of categories must be distinct, got {', '.join(sorted(names))}")
        _require_one_size(categories)
        indexes = indexes_of([category.views for category in categories])
        return cls(tuple(categories), tuple(indexes), settings, calibration)

    def recognise(self, descriptors: NDArray[np.float32]) -> Recognition:
        """Name a view, or answer that it is unknown, with reasons.

        Parameters
        ----------
        descriptors
            Descriptors of shape (q, d). Without a descriptor (q = 0) or a category the answer is unknown.

        Returns
        -------
        Recognition
            Answer with a candidate for each category.

        Raises
        ------
        RecognitionError
            If descriptors are not finite, or not of the categories' length.
        """
        if not self.categories:
            return no_answer(self.calibration, "no category has been taught")
        if isinstance(descriptors, np.ndarray) and descriptors.ndim == 2 and not len(descriptors):
            return no_answer(self.calibration, "the view has no descriptor: nothing on it could be described")
        target, effort = Target.of(descriptors), self.settings.effort_among(sum(map(len, self.categories)))
        found = self._nearest(target, effort)
        widths = self.spreads
        normalised = np.array([near.distance / width.value for near, width in zip(found, widths, strict=True)])
        *probabilities, unknown = self.calibration.probabilities(normalised).tolist()
        parts = zip(self.categories, found, widths, probabilities, strict=True)
        candidates = [_candidate(*each) for each in parts]
        candidates.sort(key=lambda candidate: (candidate.normalised, candidate.category))
        return decided(candidates, unknown, self.calibration, effort is None, self.settings.by_threshold)

    @cached_property
    def spreads(self) -> list[Spread]:
        """Divisors of the distances D_C (equation 2), one for each category."""
        widths = [category.width(self.settings.over_things) for category in self.categories]
        return spreads(widths, self.settings.prior_spread, self.settings.shrinkage)

    def learned(self, category: InstanceCategory) -> Recogniser:
        """Return a recogniser with the category added, or replaced if there is one of its name.

        Parameters
        ----------
        category
            Category with all its views.

        Returns
        -------
        Recogniser
            Recogniser whose other categories are unchanged.

        Raises
        ------
        RecognitionError
            If the category's descriptors are not of the others' length.
        """
        if category.name not in [known.name for known in self.categories]:
            return self._with((*self.categories, category), (*self.indexes, None), category)
        return self._with(self.categories, self.indexes, category)

    def forgotten(self, name: str) -> Recogniser:
        """Return a recogniser without a category.

        Parameters
        ----------
        name
            Name of the category.

        Returns
        -------
        Recogniser
            Recogniser whose other categories are unchanged.

        Raises
        ------
        RecognitionError
            If the name is unknown.
        """
        places = [i for i, category in enumerate(self.categories) if category.name != name]
        if len(places) == len(self.categories):
            raise RecognitionError(
                f"unknown category '{name}'; the categories are {', '.join(one.name for one in self.categories)}"
            )
        return replace(
            self,
            categories=tuple(self.categories[i] for i in places),
            indexes=tuple(self.indexes[i] for i in places),
        )

    def calibrated(self, progress: Progress | None = None) -> Recogniser:
        """Return a recogniser with threshold and probabilities fitted to its own held-out views.

        Parameters
        ----------
        progress
            Called with the number of views done and the number of all views.

        Returns
        -------
        Recogniser
            Recogniser of the same categories; its calibration is the shipped one if there are too few views.
        """
        held = hold_out(self.categories, self.indexes, self.settings, progress=progress)
        return replace(self, calibration=calibrate(held, self.settings.prior_unknown))

    def _nearest(self, target: Target, effort: Effort | None) -> list[Nearest]:
        """Return the nearest view of each category."""
        nothing = Nearest(float("inf"), -1, 0)
        first = next((index for index in self.indexes if index is not None), None)
        if first is None:
            return [nothing] * len(self.indexes)
        target.require_fit(first.views)
        reduced = first.reduction(target.descriptors)
        return [nothing if index is None else index.nearest(target, reduced, effort) for index in self.indexes]

    def _with(
        self,
        categories: tuple[InstanceCategory, ...],
        indexes: tuple[ViewIndex | None, ...],
        category: InstanceCategory,
    ) -> Recogniser:
        """Return a recogniser with one changed category; reduce all views again if their number has doubled."""
        changed = tuple(category if known.name == category.name else known for known in categories)
        _require_one_size(changed)
        reduction = next((index.reduction for index in indexes if index is not None), None)
        count = sum(len(known.views.descriptors) for known in changed)
        if reduction is None or count > 2 * reduction.count:
            return replace(self, categories=changed, indexes=tuple(indexes_of([known.views for known in changed])))
        kept = tuple(
            (ViewIndex.of(category.views, reduction) if len(category) else None)
            if known.name == category.name
            else index
            for known, index in zip(changed, indexes, strict=True)
        )
        return replace(self, categories=changed, indexes=kept)


def recognise(
    descriptors: NDArray[np.float32],
    categories: Sequence[InstanceCategory],
    settings: RecognitionSettings = DEFAULT,
    calibration: Calibration = SHIPPED,
) -> Recognition:
    """Name one view; to name many, create a :class:`Recogniser` once.

    Parameters
    ----------
    descriptors
        Descriptors of the view, shape (q, d).
    categories
        Categories with distinct names.
    settings
        Settings of recognition.
    calibration
        Parameters of decision and probabilities.

    Returns
    -------
    Recognition
        Answer with a candidate for each category.

    Raises
    ------
    RecognitionError
        If names are equal, or descriptors are not valid or of unequal length.
    """
    return Recogniser.of(categories, settings, calibration).recognise(descriptors)


def _candidate(category: InstanceCategory, near: Nearest, spread: Spread, probability: float) -> Candidate:
    nearest = category.views.ids[near.place] if near.place >= 0 else None
    return Candidate(
        category.name, near.distance, spread, near.distance / spread.value, nearest, len(category), probability
    )


def _require_one_size(categories: Sequence[InstanceCategory]) -> None:
    sizes = {category.views.size: category.name for category in categories if len(category)}
    if len(sizes) > 1:
        sizes_given = ", ".join(f"{size} in '{name}'" for size, name in sizes.items())
        raise RecognitionError(f"categories have descriptors of different lengths: {sizes_given}")
