"""Recognition by several descriptors jointly: the same views, described in several ways, give one answer.

Each descriptor has its own :class:`.Recogniser` of the same categories, and therefore its own nearest view and ND for
every category. The answer follows from the weighted geometric mean of these ND
(:mod:`deixis.perception.recognition.calibration`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.calibration import SHIPPED_JOINT, Calibration, calibrate_jointly
from deixis.perception.recognition.held_out import HeldOut, Progress, hold_out
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.recogniser import Recogniser, Recognition, decided, no_answer


@dataclass(frozen=True, eq=False)
class JointRecogniser:
    """Recognisers of the same categories with the same views, one for each descriptor.

    Candidates hold D_C, the nearest view and the divisor by the first descriptor, and the joint ND.
    """

    parts: tuple[Recogniser, ...]
    calibration: Calibration = SHIPPED_JOINT

    def __post_init__(self) -> None:
        listed = [[(each.name, each.views.ids) for each in part.categories] for part in self.parts]
        if not listed or any(each != listed[0] for each in listed):
            raise RecognitionError("the parts of a joint recogniser must have the same views in the same categories")
        if len(self.calibration.weights) != len(self.parts):
            counted = f"{len(self.calibration.weights)} weights for {len(self.parts)} descriptors"
            raise RecognitionError(f"a calibration must have a weight for each descriptor, got {counted}")

    @property
    def categories(self) -> tuple[InstanceCategory, ...]:
        """Categories with the views of the first descriptor."""
        return self.parts[0].categories

    def recognise(self, described: Sequence[NDArray[np.float32]]) -> Recognition:
        """Name a view, or answer that it is unknown, with reasons.

        Parameters
        ----------
        described
            Descriptors of shape (q, d) for each part, in order. A view that lacks one of them is unknown.

        Returns
        -------
        Recognition
            Answer whose candidates have the weighted mean of the parts' ND.

        Raises
        ------
        RecognitionError
            If descriptors are not finite, or not of the categories' length.
        """
        found = [part.recognise(each) for part, each in zip(self.parts, described, strict=True)]
        nothing = next((each for each in found if not each.candidates), None)
        if nothing is not None:
            return no_answer(self.calibration, nothing.reasons[0])
        by_name = [{one.category: one.normalised for one in each.candidates} for each in found]
        first = found[0].candidates
        together = self.calibration.mean([np.array([named[one.category] for one in first]) for named in by_name])
        *probabilities, unknown = self.calibration.probabilities(together).tolist()
        ranked = [
            replace(one, normalised=float(normalised), probability=probability)
            for one, normalised, probability in zip(first, together, probabilities, strict=True)
        ]
        ranked.sort(key=lambda candidate: (candidate.normalised, candidate.category))
        by_threshold = self.parts[0].settings.by_threshold
        return decided(ranked, unknown, self.calibration, all(each.exact for each in found), by_threshold)

    def held_out(self, progress: Progress | None = None) -> list[HeldOut]:
        """Return the normalised distances (ND) of held-out views by each descriptor.

        Parameters
        ----------
        progress
            Called with the number of views done and the number of all views, for each part.

        Returns
        -------
        list of HeldOut
            One for each part, about the same views.
        """
        return [hold_out(part.categories, part.indexes, part.settings, progress=progress) for part in self.parts]

    def calibrated(self, progress: Progress | None = None) -> JointRecogniser:
        """Return the recogniser with weights, threshold and probabilities fitted to its own held-out views.

        Parameters
        ----------
        progress
            Called with the number of views done and the number of all views, for each part.

        Returns
        -------
        JointRecogniser
            Recogniser of the same categories; its calibration stays if there are too few views.
        """
        return self.calibrated_by(self.held_out(progress))

    def calibrated_by(self, held: Sequence[HeldOut]) -> JointRecogniser:
        """Return the recogniser calibrated by the normalised distances (ND) of held-out views by each descriptor.

        Parameters
        ----------
        held
            ND of the same held-out views by each part, as :meth:`held_out` returns them.

        Returns
        -------
        JointRecogniser
            Recogniser of the same categories; its calibration stays if there are too few views.
        """
        prior = self.parts[0].settings.prior_unknown
        return replace(self, calibration=calibrate_jointly(held, prior, self.calibration))
