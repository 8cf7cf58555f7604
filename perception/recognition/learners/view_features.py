"""Features of a view for learners: its descriptors by name."""

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
    """Descriptors (k, d) of one view by name; k is 1 for global ones, and 0 if the view could not be described.

    ``thing`` identifies the thing that the view shows, which a robot knows that tracks it; a view with None shows a
    thing of its own.

    >>> view = ViewFeatures({"good": np.ones((1, 675), np.float32)})
    >>> view["good"].shape, view.has("good"), view.has("spin_images")
    ((1, 675), True, False)
    """

    descriptors: Mapping[str, NDArray[np.float32]]
    thing: str | None = None

    def __post_init__(self) -> None:
        wrong = [name for name, array in self.descriptors.items() if array.ndim != 2 or not array.shape[1]]
        if wrong:
            raise RecognitionError(f"the descriptors '{wrong[0]}' of a view must have shape (k, d) with d at least 1")
        object.__setattr__(self, "descriptors", MappingProxyType(dict(self.descriptors)))

    def __getitem__(self, name: str) -> NDArray[np.float32]:
        """Return the descriptors of a name; raise RecognitionError, with the known names, for an unknown one."""
        if name not in self.descriptors:
            known = ", ".join(self.descriptors) or "nothing"
            raise RecognitionError(f"the view has no descriptor '{name}'; it has {known}")
        return self.descriptors[name]

    def has(self, name: str) -> bool:
        """Return True if there is at least one descriptor of a name.

        Parameters
        ----------
        name
            Name of the descriptor.

        Returns
        -------
        bool
            False for an unknown name, and for a view that could not be described.
        """
        return name in self.descriptors and len(self.descriptors[name]) > 0


def features_of(cloud: PointCloud, describers: Iterable[Describer], thing: str | None = None) -> ViewFeatures:
    """Return the features of a view of one thing by all describers.

    Parameters
    ----------
    cloud
        View of the thing, in metres.
    describers
        Descriptors to compute.
    thing
        Thing that the view shows, if it is known.

    Returns
    -------
    ViewFeatures
        Descriptors by the names of the describers.
    """
    return ViewFeatures({describer.name: describer.describe(cloud) for describer in describers}, thing)


def roots(descriptors: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the square roots of descriptors; numbers below 0, which histograms do not have, count as 0.

    The Euclidean distance between square roots of histograms is the Hellinger distance, in which a few full bins do not
    dominate the others.

    Parameters
    ----------
    descriptors
        Descriptors of shape (k, d).

    Returns
    -------
    ndarray
        Square roots of shape (k, d).

    Notes
    -----
    Square roots of histograms for retrieval: R. Arandjelović and A. Zisserman, "Three things everyone should know to
    improve object retrieval", CVPR 2012.
    """
    return np.sqrt(np.maximum(descriptors, np.float32(0.0)))


def pooled(view: ViewFeatures, names: Iterable[str]) -> NDArray[np.float64] | None:
    """Return one vector for a view: the means over keypoints of the square roots of its descriptors, concatenated.

    Parameters
    ----------
    view
        View with its descriptors.
    names
        Names of the descriptors, in the order of the vector.

    Returns
    -------
    ndarray or None
        Vector whose length is the sum of the descriptors' lengths; None if a name has no descriptor.

    Examples
    --------
    >>> pooled(ViewFeatures({"a": np.array([[4.0], [16.0]]), "b": np.array([[1.0, 0.0]])}), ["a", "b"])
    array([3., 1., 0.])
    """
    if not all(view.has(name) for name in names):
        return None
    return np.concatenate([roots(view[name]).mean(axis=0, dtype=np.float64) for name in names])
