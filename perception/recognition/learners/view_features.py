"""What learners are told of a view: its descriptors, by the name of what described it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import RecognitionError
from deixis.perception.features.describer import Describer


@dataclass(frozen=True, eq=False)
class ViewFeatures:
    """Descriptors (k, d) of one view by name, k = 1 for global ones and k = 0 where nothing could be described.

    ``thing`` tells things apart where it is known which one a view shows, as a robot knows that follows a thing with
    its eyes; views of None show things of their own.

    >>> view = ViewFeatures({"good": np.ones((1, 675), np.float32)})
    >>> view["good"].shape, view.has("good"), view.has("spin_images")
    ((1, 675), True, False)
    """

    descriptors: Mapping[str, NDArray[np.float32]]
    thing: str | None = None

    def __post_init__(self) -> None:
        wrong = [name for name, array in self.descriptors.items() if array.ndim != 2 or not array.shape[1]]
        if wrong:
            raise RecognitionError(f"the descriptors '{wrong[0]}' of a view have shape (k, d), d of 1 or more")
        object.__setattr__(self, "descriptors", MappingProxyType(dict(self.descriptors)))

    def __getitem__(self, name: str) -> NDArray[np.float32]:
        """Return the descriptors of that name; raises RecognitionError, with the names there are, where there are
        none."""
        if name not in self.descriptors:
            known = ", ".join(self.descriptors) or "nothing"
            raise RecognitionError(f"the view was not described by '{name}', only by {known}")
        return self.descriptors[name]

    def has(self, name: str) -> bool:
        """Return whether there is at least one descriptor of that name."""
        return name in self.descriptors and len(self.descriptors[name]) > 0


def features_of(cloud: PointCloud, describers: Iterable[Describer], thing: str | None = None) -> ViewFeatures:
    """Return a view of one thing as every describer describes it."""
    return ViewFeatures({describer.name: describer.describe(cloud) for describer in describers}, thing)


def roots(descriptors: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the square roots of descriptors; numbers below 0, which no histogram has, count as 0.

    The Euclidean distance between square roots of histograms is Hellinger's, in which a few full bins do not drown
    the others.
    """
    return np.sqrt(np.maximum(descriptors, np.float32(0.0)))


def pooled(view: ViewFeatures, names: Iterable[str]) -> NDArray[np.float64] | None:
    """Return one vector for a view: the mean over keypoints of the roots of its descriptors, one name after the other.

    None where a name has no descriptor.

    >>> pooled(ViewFeatures({"a": np.array([[4.0], [16.0]]), "b": np.array([[1.0, 0.0]])}), ["a", "b"])
    array([3., 1., 0.])
    """
    if not all(view.has(name) for name in names):
        return None
    return np.concatenate([roots(view[name]).mean(axis=0, dtype=np.float64) for name in names])
