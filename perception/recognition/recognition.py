"""What recognising gives: a name or none, and every number that speaks for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deixis.perception.recognition.calibration import Calibration
from deixis.perception.recognition.spread import Spread, SpreadSource


@dataclass(frozen=True)
class Candidate:
    """A category beside the target.

    ``distance`` is D_C (equation 2), ``nearest`` the id of the view that has it, ``spread`` what it is divided by, the
    ICD (equation 3) or what stands for it, ``normalised`` ND (equation 4). ``probability`` is that of the category
    being the right one. A category of empty views only is infinitely far, and ``nearest`` is None.
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
    """Candidates from the least ND up; ``label`` is the first one's, or None if its ND is above the threshold: unknown.

    ``unknown`` is the probability that no category is right. ``exact`` says whether every D_C is the least there is.
    ``reasons`` say in words what decided, and what was not as it should be.
    """

    label: str | None
    candidates: tuple[Candidate, ...]
    unknown: float
    calibration: Calibration
    exact: bool
    reasons: tuple[str, ...]

    @property
    def probability(self) -> float:
        """The probability of the answer: of the label, or of there being none."""
        return self.candidates[0].probability if self.label is not None else self.unknown


def no_answer(calibration: Calibration, reason: str) -> Recognition:
    """Unknown, because there was nothing to compare."""
    return Recognition(None, (), 1.0, calibration, True, (reason,))


def decided(ranked: Sequence[Candidate], unknown: float, calibration: Calibration, exact: bool) -> Recognition:
    """The decision between the nearest category and none, with its reasons."""
    first = ranked[0]
    label = first.category if first.normalised <= calibration.threshold else None
    reasons = [_comparison(first, calibration)]
    if first.spread.source in (SpreadSource.POOLED, SpreadSource.PRIOR) and first.nearest is not None:
        reasons.append(_stand_in(first))
    if not exact:
        reasons.append("distances are of the nearest views that an approximate search found")
    return Recognition(label, tuple(ranked), unknown, calibration, exact, tuple(reasons))


def _comparison(first: Candidate, calibration: Calibration) -> str:
    if first.nearest is None:
        return "no remembered view has a descriptor"
    basis = f"from {calibration.known} held-out views" if calibration.calibrated else "a constant, not yet calibrated"
    side = "within" if first.normalised <= calibration.threshold else "above"
    return (
        f"'{first.category}' is nearest: ND {first.normalised:.3g} (D_C {first.distance:.3g} to view '{first.nearest}'"
        f" / {_divisor(first)}), {side} the threshold {calibration.threshold:.3g} ({basis})"
    )


def _divisor(first: Candidate) -> str:
    """The number that D_C is divided by, and what it is where it comes from the category itself."""
    width = first.spread.width
    own = f"{first.spread.value:.3g}: its ICD over {width.count} {'things' if width.over_things else 'views'}"
    match first.spread.source:
        case SpreadSource.MEASURED:
            return own
        case SpreadSource.SHRUNK:
            return f"{own}, {width.icd:.3g}, drawn to the median one"
        case _:
            return f"{first.spread.value:.3g}"


def _stand_in(first: Candidate) -> str:
    width = first.spread.width
    unit = "thing" if width.over_things else "view"
    what = f"has one {unit}" if width.count == 1 else f"has no two {unit}s that differ"
    whence = "the median ICD of others" if first.spread.source is SpreadSource.POOLED else "a constant"
    return f"'{first.category}' {what}, so that D_C is divided by {whence}"
