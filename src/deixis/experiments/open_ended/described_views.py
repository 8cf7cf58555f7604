"""Describe views of things, with their categories and instances, and keep them on disk between runs."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import Describer
from deixis.perception.features.descriptors.d2_extents import D2ExtentsDescriber
from deixis.perception.features.descriptors.good import GoodDescriber
from deixis.perception.features.descriptors.spin_images import SpinImageDescriber
from deixis.perception.features.descriptors.upright import UprightDescriber
from deixis.perception.recognition.learners.view_features import ViewFeatures, features_of

DESCRIBERS: tuple[Describer, ...] = (
    SpinImageDescriber(support=0.2),
    GoodDescriber(),
    D2ExtentsDescriber(),
    UprightDescriber(),
)
"""Describers, with the same settings for all data.

The settings of the first and the last were chosen beforehand (docs/explanation/open_ended.md).
"""


class ThingViews(NamedTuple):
    """A thing and views of it; ``instance`` distinguishes things of a category."""

    category: str
    instance: str
    clouds: list[PointCloud]


@dataclass(frozen=True, eq=False)
class DescribedViews:
    """A set of n described views; ``instances`` are numbers, unique across categories."""

    name: str
    categories: tuple[str, ...]  # (n,)
    instances: NDArray[np.int64]  # (n,)
    views: tuple[ViewFeatures, ...]

    @property
    def kinds(self) -> tuple[str, ...]:
        """The categories, each once, in alphabetical order."""
        return tuple(sorted(set(self.categories)))

    def of(self, category: str, instances: Iterable[int] | None = None) -> NDArray[np.int64]:
        """Return the positions of a category's views, or of the given instances only.

        Parameters
        ----------
        category
            Name of a category.
        instances
            Numbers of instances, or None for all.

        Returns
        -------
        array
            Positions in ascending order.
        """
        chosen = np.array(self.categories) == category
        if instances is not None:
            chosen &= np.isin(self.instances, list(instances))
        return np.flatnonzero(chosen)

    def at(self, places: NDArray[np.int64]) -> DescribedViews:
        """Return the views at these positions only.

        Parameters
        ----------
        places
            Positions of views, shape (m,).

        Returns
        -------
        DescribedViews
            The m views in this order, with the numbers of their instances unchanged.
        """
        categories, views = (tuple(each[place] for place in places) for each in (self.categories, self.views))
        return DescribedViews(self.name, categories, self.instances[places], views)

    def instances_of(self, category: str) -> NDArray[np.int64]:
        """Return the numbers of a category's instances.

        Parameters
        ----------
        category
            Name of a category.

        Returns
        -------
        array
            Numbers in ascending order, each once.
        """
        return np.unique(self.instances[self.of(category)])


def describe_views(
    name: str, things: Iterable[ThingViews], tick: Callable[[str], None] = lambda _: None
) -> DescribedViews:
    """Describe all views, except those in which a describer finds nothing.

    Parameters
    ----------
    name
        Name of the set of views.
    things
        Things with the clouds of their views; the position of a thing is the number of its instance.
    tick
        Called with a message after each thing.

    Returns
    -------
    DescribedViews
        Usable views with their categories and instances.
    """
    categories: list[str] = []
    instances: list[int] = []
    views: list[ViewFeatures] = []
    for number, thing in enumerate(things):
        found = [features_of(cloud, DESCRIBERS, str(number)) for cloud in thing.clouds]
        usable = [view for view in found if all(view.has(describer.name) for describer in DESCRIBERS)]
        views += usable
        categories += [thing.category] * len(usable)
        instances += [number] * len(usable)
        tick(f"{name}: {thing.category}")
    return DescribedViews(name, tuple(categories), np.array(instances, np.int64), tuple(views))


class CacheError(DeixisError, OSError):
    """A folder in which views cannot be kept."""


def cached_views(folder: Path | None, key: str, make: Callable[[], DescribedViews]) -> DescribedViews:
    """Return the result of ``make``, read from the file of an earlier call if there is one.

    The file is named after ``key`` and the describers' settings. A file that cannot be read is made again.

    Parameters
    ----------
    folder
        Folder of the files, or None to keep none.
    key
        Text that identifies the input of ``make``.
    make
        Function that computes the views.

    Returns
    -------
    DescribedViews
        Views as computed or as read.

    Raises
    ------
    CacheError
        If the file cannot be written.
    """
    if folder is None:
        return make()
    digest = hashlib.sha256(f"{key} {DESCRIBERS}".encode()).hexdigest()[:16]
    file = folder / f"views-{digest}.npz"
    try:
        return _read(file)
    except (OSError, ValueError, KeyError, BadZipFile):
        data = make()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        arrays: dict[str, NDArray[np.generic]] = {
            "name": np.array(data.name),
            "categories": np.array(data.categories),
            "instances": data.instances,
        }
        for describer in DESCRIBERS:
            parts = [view[describer.name] for view in data.views]
            arrays[f"{describer.name} lengths"] = np.array([len(part) for part in parts])
            arrays[describer.name] = np.concatenate(parts)
        unfinished = file.with_suffix(".part.npz")
        np.savez(unfinished, allow_pickle=False, **arrays)
        unfinished.replace(file)
    except OSError as error:
        raise CacheError(f"{folder}: views cannot be stored here ({error.strerror}); choose another folder") from error
    return data


def _read(file: Path) -> DescribedViews:
    with file.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
        split = {
            describer.name: np.split(stored[describer.name], np.cumsum(stored[f"{describer.name} lengths"])[:-1])
            for describer in DESCRIBERS
        }
        rows, things = zip(*split.values(), strict=True), stored["instances"]
        views = [
            ViewFeatures(dict(zip(split, row, strict=True)), str(thing))
            for row, thing in zip(rows, things, strict=True)
        ]
        return DescribedViews(str(stored["name"]), tuple(map(str, stored["categories"])), things, tuple(views))
