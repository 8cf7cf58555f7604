"""Categories as sets of taught views, with the distances of equation 3 kept up to date."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.distances import view_distances
from deixis.perception.recognition.spread import Width
from deixis.perception.recognition.views import PackedViews


@dataclass(frozen=True, eq=False)
class InstanceCategory:
    """A category: a name, n views, and ``distances[i, j]``, the distance D_V (equation 1) of view i to view j.

    Adding a view computes only its distances to and from the views of this category; removing one computes nothing.
    ``things`` maps ids of views to the things that they show; a view that is not in it shows a thing of its own.
    ``empty`` holds the ids of views without a descriptor: they belong to the category and enter no equation.

    >>> category = InstanceCategory("mug").with_view("a", np.array([[0.0]])).with_view("b", np.array([[2.0], [3.0]]))
    >>> category.distances.tolist(), category.intra_category_distance
    ([[0.0, 2.0], [2.5, 0.0]], 2.25)
    """

    name: str
    views: PackedViews = field(default_factory=lambda: PackedViews.of(()))
    distances: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))  # (n, n)
    empty: tuple[str, ...] = ()
    things: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = len(self.views)
        if self.distances.shape != (n, n):
            raise RecognitionError(
                f"the distances of category '{self.name}' must have shape ({n}, {n}), got {self.distances.shape}"
            )

    @classmethod
    def of(
        cls, name: str, views: Iterable[tuple[str, NDArray[np.float32]]], things: Mapping[str, str] | None = None
    ) -> InstanceCategory:
        """Return a category of views, with all distances computed.

        Parameters
        ----------
        name
            Name of the category.
        views
            Pairs of an id and descriptors of shape (k, d); k may be 0.
        things
            Thing that each view shows, by the view's id.

        Returns
        -------
        InstanceCategory
            Category whose views have the order of ``views``.

        Raises
        ------
        RecognitionError
            If an id is repeated, or descriptors are not valid or differ in length.
        """
        named = list(views)
        packed = PackedViews.of((key, array) for key, array in named if len(array))
        return cls.among(name, packed, tuple(key for key, array in named if not len(array)), things or {})

    @classmethod
    def among(
        cls, name: str, views: PackedViews, empty: tuple[str, ...], things: Mapping[str, str]
    ) -> InstanceCategory:
        """Return a category of packed views, with all distances computed.

        Parameters
        ----------
        name
            Name of the category.
        views
            Views with at least one descriptor.
        empty
            Ids of views without a descriptor.
        things
            Thing that each view shows, by the view's id.

        Returns
        -------
        InstanceCategory
            Category with distances between all pairs of ``views``.
        """
        return cls(name, views, _distances(views, views), empty, dict(things))

    def __len__(self) -> int:
        return len(self.views)

    @property
    def intra_category_distance(self) -> float | None:
        """Intra-category distance (ICD, equation 3): the mean over ordered pairs of views; None for fewer than two.

        It is 0 if all views are equal. :mod:`.spread` derives the divisor of equation 4 from it.
        """
        return self.width(over_things=False).icd

    @cached_property
    def shown(self) -> NDArray[np.int64]:
        """Number of the thing that each view shows (n,)."""
        names = [(key in self.things, self.things.get(key, key)) for key in self.views.ids]
        numbers = {name: number for number, name in enumerate(dict.fromkeys(names))}
        return np.array([numbers[name] for name in names], np.int64)

    def width(self, over_things: bool, places: NDArray[np.intp] | None = None) -> Width:
        """Return the intra-category distance (ICD, equation 3) over views of different things, or over all views.

        Parameters
        ----------
        over_things
            If False, compare also views of one thing.
        places
            Indices of the views to compare; all by default.

        Returns
        -------
        Width
            Mean distance, and the number of things or views.
        """
        at = np.arange(len(self)) if places is None else places
        return Width.of(self.distances[np.ix_(at, at)], self.shown[at] if over_things else None)

    def with_view(self, key: str, descriptors: NDArray[np.float32], thing: str | None = None) -> InstanceCategory:
        """Return the category with one more view, at the end.

        Parameters
        ----------
        key
            Id of the view.
        descriptors
            Its descriptors, shape (k, d); k may be 0.
        thing
            Thing that the view shows, if it is known.

        Returns
        -------
        InstanceCategory
            Category with the distances to the view.

        Raises
        ------
        RecognitionError
            If the view is known already, or its descriptors have another length.
        """
        if key in self.views.ids or key in self.empty:
            raise RecognitionError(f"category '{self.name}' already has a view '{key}'; give the new one another id")
        things = self.things if thing is None else {**self.things, key: thing}
        if not len(descriptors):
            return replace(self, empty=(*self.empty, key), things=things)
        new = PackedViews.of([(key, descriptors)])
        n = len(self.views)
        distances = np.zeros((n + 1, n + 1))
        distances[:n, :n] = self.distances
        distances[n, :n] = _distances(new, self.views)[0]
        distances[:n, n] = _distances(self.views, new)[:, 0]
        return replace(self, views=self.views.joined(new), distances=distances, things=things)

    def without_view(self, key: str) -> InstanceCategory:
        """Return the category without a view.

        Parameters
        ----------
        key
            Id of the view.

        Returns
        -------
        InstanceCategory
            Category without the view's distances.

        Raises
        ------
        RecognitionError
            If the category has no such view.
        """
        things = {view: thing for view, thing in self.things.items() if view != key}
        if key in self.empty:
            return replace(self, empty=tuple(name for name in self.empty if name != key), things=things)
        if key not in self.views.ids:
            raise RecognitionError(f"category '{self.name}' has no view '{key}'")
        place = self.views.ids.index(key)
        distances = np.delete(np.delete(self.distances, place, axis=0), place, axis=1)
        return replace(self, views=self.views.without(place), distances=distances, things=things)


def _distances(seen: PackedViews, views: PackedViews) -> NDArray[np.float64]:
    """Return D_V (n, m) between each of n views and each of m views.

    Two views of one descriptor each are always compared by the same sum, so that a distance does not depend on the
    other views that it is computed with.
    """
    from scipy.spatial.distance import cdist

    rows, columns = (np.flatnonzero(np.diff(one.starts) == 1) for one in (seen, views))
    distances = np.empty((len(seen), len(views)))
    if seen is not views or len(rows) < len(seen):  # also checks that the descriptors of other views fit
        for i in range(len(seen)):
            distances[i] = view_distances(seen[i], views)
    if len(rows) and len(columns):
        single, others = (
            one.descriptors[one.starts[at]].astype(np.float64) for one, at in ((seen, rows), (views, columns))
        )
        distances[np.ix_(rows, columns)] = cdist(single, others)
    return distances
