"""Keep the things that are tracked, each under a name, a label and numbers of rests that no other thing has."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator

import numpy as np

from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.things.model import Model
from deixis.perception.tracking.things.pipeline import Pipeline


class Things:
    """Tracked things, in the order in which they came.

    Parameters
    ----------
    settings
        Options of the tracker.
    """

    def __init__(self, settings: TrackingSettings) -> None:
        self._settings = settings
        self._all: list[Pipeline] = []
        self._names, self._rests = itertools.count(1), itertools.count(1)

    def __iter__(self) -> Iterator[Pipeline]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    @property
    def resting(self) -> list[Pipeline]:
        """Things that are at rest, whether they are seen or hidden."""
        return [thing for thing in self._all if not thing.active]

    @property
    def rests(self) -> dict[int, int]:
        """Number of the present rest of each thing at rest, by its slot."""
        return {thing.slot: thing.rest for thing in self.resting}

    def enter(self, model: Model, at: float) -> Pipeline:
        """Begin the pipeline of a new thing, at rest.

        Parameters
        ----------
        model
            Points, boxes and pose.
        at
            Time of the frame in seconds.

        Returns
        -------
        Pipeline
            The thing, with a new name and the first slot that is free.
        """
        used = {thing.slot for thing in self._all}
        slot = next(slot for slot in range(1, len(used) + 2) if slot not in used)
        self._all.append(self._pipeline(f"t{next(self._names)}", slot, model, at))
        return self._all[-1]

    def remodel(self, thing: Pipeline, model: Model, at: float) -> Pipeline:
        """Begin another pipeline of a thing, which ends the one that it had.

        Parameters
        ----------
        thing
            The thing.
        model
            Points, boxes and pose that a frame shows.
        at
            Time of the frame in seconds.

        Returns
        -------
        Pipeline
            The thing, which keeps its name, its slot, and its rest if it was at rest.
        """
        new = self._pipeline(thing.id, thing.slot, model, at)
        if not thing.active:
            new.rest = thing.rest
        moves = thing.active and float(np.linalg.norm(new.pose[:3, 3] - thing.pose[:3, 3])) > self._settings.still
        new.since = new.at if moves else thing.since
        new.continue_from(thing)
        self._all[self._all.index(thing)] = new
        return new

    def settle(self, thing: Pipeline) -> None:
        """Let a thing come to rest where it was last seen.

        Parameters
        ----------
        thing
            The thing.
        """
        thing.settle()
        thing.rest = next(self._rests)

    def leave(self, others: Collection[Pipeline]) -> None:
        """End the pipelines of things.

        Parameters
        ----------
        others
            The things.
        """
        self._all = [thing for thing in self._all if thing not in others]

    def _pipeline(self, id: str, slot: int, model: Model, at: float) -> Pipeline:
        made = Pipeline(id, slot, model.cloud, model.half, model.oriented, model.pose, at, self._settings)
        made.rest = next(self._rests)
        return made
