"""Follow the things on a table from frame to frame, with what is new, what moves and what is gone.

The table at rest is a reference image of depth, colour and owner of every pixel. A thing rests while enough of its
pixels are unchanged; this costs nothing more. A thing that has left its place is followed by its particle filter.
Pixels that changed and stay as they are, and that are neither a hand's nor a moving thing's, are segmented, and become
new things or the places of things that were lost.

This module is the order of these steps in each frame. Each step has a module: ``looks/`` at the whole table, and
``things/rest``, ``following``, ``arrivals`` and ``completion``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.errors import CloudError
from deixis.perception.scene import Scene
from deixis.perception.tracking.camera.motion import STANDING, CameraMotion, moved_by
from deixis.perception.tracking.camera.registration import levels_of
from deixis.perception.tracking.changes.arrivals import Arrivals
from deixis.perception.tracking.changes.following import Workers, follow, let_go
from deixis.perception.tracking.changes.hands import Hands, something_moves
from deixis.perception.tracking.changes.rest import has_left, is_laid_anew, look_at_resting
from deixis.perception.tracking.completion.completion import complete
from deixis.perception.tracking.frames.image import FrameImage, Optics, TableView, image_of, optics_of, table_view
from deixis.perception.tracking.frames.recent import RecentFrames
from deixis.perception.tracking.looks.correction import SAME_MODEL, Correction, correct, detection_of, look_closely
from deixis.perception.tracking.looks.matching import matches
from deixis.perception.tracking.looks.whole import bare_table, detected_table, lay_out, shown
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.situation import Situation
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.table.reference import GAP, TABLE, UNKNOWN_OWNER, Changes
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.pipeline import Pipeline

MIN_FINITE_SHARE = 0.02
"""Minimum share of points with a depth in a frame that is used."""

EDGE_REACH = 1
"""Distance in pixels within which an equal depth of the reference is looked for, while the camera moves."""

UNSTEADY_FOR = 1.0
"""Time in seconds after a movement of the camera in which pixels are compared within ``EDGE_REACH``."""

BLIND_FOR = 1.5
"""Time in seconds in which nothing is concluded from frames of a moving camera whose place is not known."""

BLINK = 1.5
"""Minimum time in seconds between two frames at which anything may have happened in between."""

STRANGE = "the table is not where it was; the frame is left out"
"""Note about a frame that shows neither the table at its place nor something before it."""

HAND_MEMORY = 0.5
"""Time in seconds after a hand was seen in which it may have moved several things at once."""


class Tracker:
    """Follow the things on one table through the frames of a depth camera.

    Parameters
    ----------
    settings
        Options; the default ones if None.

    Examples
    --------
    >>> from deixis.perception.simulator.films.stage import PassOver, Rest, film
    >>> from deixis.perception.simulator.laying import Placement
    >>> story = film([Placement("mug", "mug", 0.0, 0.0)], [Rest(0.4)])
    >>> with Tracker() as tracker:
    ...     for frame in story.frames(rate=5):
    ...         now = tracker.update(frame.cloud, frame.at)
    >>> [(thing.id, thing.state) for thing in now.things]
    [('t1', 'seen')]
    """

    def __init__(self, settings: TrackingSettings | None = None) -> None:
        self.settings = settings or TrackingSettings()
        self._things, self._hands = Things(self.settings), Hands()
        self._arrivals, self._workers = Arrivals(self.settings), Workers(self.settings.workers)
        self._number = 0
        self._at: float | None = None
        self._motion: CameraMotion | None = None
        self._moved_at = self._placed_at = self._hand_at = -np.inf
        self._strange_since: float | None = None  # since when frames have not shown the table at its place
        self._optics: Optics | None = None
        self._view: TableView | None = None
        self._table: Table | None = None
        self._recent: RecentFrames | None = None
        self._is_looked_at_closely = False
        self._last: tuple[PointCloud, FrameImage, int] | None = None  # the last frame that was used

    def __enter__(self) -> Tracker:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the threads and all things."""
        self._workers.close()
        self._table, self._last = None, None
        self._things.leave(list(self._things))

    def update(self, cloud: PointCloud, at: float) -> Situation:
        """Take in a frame, and return the situation after it.

        A frame that cannot be used changes nothing; the notes of the situation say why.

        Parameters
        ----------
        cloud
            Organised cloud in the camera's frame, in metres.
        at
            Time of the frame in seconds, later than that of the frame before.

        Returns
        -------
        Situation
            All things, with what came and what went.
        """
        number, self._number = self._number, self._number + 1
        problem = self._problem(cloud, at)
        if problem is not None:
            return self._situation(self._at if self._at is not None else at, number, notes=(problem,))
        before, self._at = self._at, at
        if self._table is None:
            return self._begin(cloud, at, number)
        assert self._optics is not None and self._view is not None and before is not None
        image, settings = image_of(cloud, self._optics, self.settings.stride), self.settings
        changes, is_placed = self._seen_from_here(image, at, self._table)
        if not is_placed and at - self._placed_at < BLIND_FOR:
            return replace(self._situation(at, number), busy=True)
        if not _camera_moved(changes):
            self._strange_since = None
        elif self._strange_since is None:
            self._strange_since = at
        if self._strange_since is not None:
            if at - self._strange_since < settings.steady:  # one frame may be wrong
                return replace(self._situation(at, number, notes=(STRANGE,)), busy=True)
            return self._begin_elsewhere(cloud, at, number)
        table, things, view = self._table, self._things, self._view
        table.reference.remember(image, changes, at, settings.tolerance, table.deviation, settings.colour)
        hand = self._hands.see(image, changes, table.outline, view.back, things.resting, at)
        by_hand = bool(hand.any()) or at - self._hand_at < HAND_MEMORY
        if (not by_hand or at - before > BLINK) and is_laid_anew(things.resting, changes, settings.moved):
            return self._begin_anew(cloud, image, changes, at, number)
        if hand.any() or something_moves(image, changes, table.reference, view.back, things, at, settings):
            self._hand_at = at
        self._last = cloud, image, number
        assert self._recent is not None
        self._recent.add(cloud, view.back)
        seen = Observation(image, view, changes, hand, at, self._hand_at, self._camera_moves(at))
        look_at_resting(things, table, seen, settings)
        follow(things, table, seen, self._hands, at - before, self._workers, settings)
        went = let_go(things, at, self._hand_at, settings)
        came = self._arrivals.look(things, table, seen, self._hands, self._mean)
        if self._is_quiet(at) and not self._is_looked_at_closely and at - table.laid_at >= settings.steady:
            self._is_looked_at_closely = True
            closer = look_closely(table, things, self._mean(), image, view, at, settings)
            came, merged = (came, ()) if closer is None else ((*came, *closer.came), closer.merged)
        else:
            merged = complete(things, table, seen, settings)
        return self._situation(at, number, came, went, merged, busy=self._hand_at == at)

    def look_again(self, scene: Scene) -> tuple[Situation, dict[str, str]]:
        """Correct the things by a detection of the whole table in the last frame, in which nothing moves.

        A tracked thing that is a part of a detected one ends, or becomes the whole. A detected thing that is not
        tracked is new. Things that are hidden or out of view stay.

        Parameters
        ----------
        scene
            Scene that was perceived in the cloud of the last frame, with its detection.

        Returns
        -------
        tuple
            The situation, whose ``merged`` things were parts of others; and the id of the tracked thing by that of
            the detected one.

        Raises
        ------
        CloudError
            If no frame was used yet, or the scene was perceived in a cloud of another size.
        """
        found = scene.detection
        if self._last is None or self._table is None or self._view is None or self._at is None:
            raise CloudError("look_again() needs a frame; call update() first")
        cloud, image, number = self._last
        if not isinstance(found, Detection) or len(found.labels) != len(cloud):
            raise CloudError("`scene` must be perceived in the cloud of the last frame")
        whole, at = detection_of(scene), self._at
        result: Correction = correct(
            self._table, self._things, whole, cloud, image, self._view, at, SAME_MODEL, self.settings
        )
        names = {detected.id: result.ids[k] for k, detected in enumerate(scene.objects) if k in result.ids}
        return self._situation(at, number, result.came, merged=result.merged), names

    @property
    def particles(self) -> int:
        """Number of particles that the last frame needed, over all things."""
        return sum(thing.particles for thing in self._things)

    def owners(self) -> NDArray[np.int16]:
        """Return which thing each compared pixel shows.

        Returns
        -------
        ndarray
            Number of the thing among those of the situation, from 0; -1 for none. Every ``settings.stride``-th row and
            column of the image, from ``settings.stride // 2``.
        """
        if self._table is None:
            return np.zeros((0, 0), np.int16)
        number = np.full(max((thing.slot for thing in self._things), default=0) + 2, -1, np.int16)
        for place, thing in enumerate(self._things):
            number[thing.slot] = place
        owner = self._table.reference.owner
        return np.where(owner < len(number) - 1, number[owner], np.int16(-1))

    def _problem(self, cloud: PointCloud, at: float) -> str | None:
        """Return why a frame cannot be used, or None."""
        if not np.isfinite(at):
            return f"the time of the frame must be a number of seconds, got {at}; the frame is left out"
        if self._at is not None and at <= self._at:
            return f"the clock runs backwards: {at:.3f} s after {self._at:.3f} s; the frame is left out"
        if cloud.organised is None:
            return "the cloud is not an image; give clouds with rows and columns; the frame is left out"
        if not len(cloud) or cloud.finite.mean() < MIN_FINITE_SHARE:
            return "the frame is empty; it is left out"
        if self._table is not None:
            stride, (rows, columns) = self.settings.stride, cloud.organised
            first = stride // 2
            size = len(range(first, rows, stride)), len(range(first, columns, stride))
            if size != self._table.reference.depth.shape:
                return f"the size of the image changed to {columns} by {rows} pixels; the frame is left out"
        return None

    def _situation(
        self,
        at: float,
        number: int,
        came: tuple[str, ...] = (),
        went: tuple[Pipeline, ...] = (),
        merged: tuple[Pipeline, ...] = (),
        notes: tuple[str, ...] = (),
        busy: bool = False,
    ) -> Situation:
        things, gone, parts = (tuple(thing.report(at) for thing in each) for each in (self._things, went, merged))
        back = None if self._view is None else self._view.back
        return Situation(at, number, things, came, gone, back, notes, parts, busy)

    # Looks at the whole table

    def _begin(self, cloud: PointCloud, at: float, number: int) -> Situation:
        """Find the table and the things on it."""
        optics = optics_of(cloud)
        if optics is None:
            return self._situation(at, number, notes=("the cloud is not the image of a pinhole camera at its origin",))
        found = detected_table(cloud, self.settings.detection)
        if isinstance(found, str):
            return self._situation(at, number, notes=(found,))
        self._optics, self._motion, self._hands = optics, CameraMotion(found.frame, at), Hands()
        image = image_of(cloud, optics, self.settings.stride)
        self._view = table_view(image.optics, found.frame, image.depth.shape)
        self._table = bare_table(image, self._view, at, self.settings)
        return self._situation(at, number, self._lay_out(found, cloud, image, at, {}))

    def _begin_elsewhere(self, cloud: PointCloud, at: float, number: int) -> Situation:
        """Look for the table again: what was known about places does not hold for another place of the camera."""
        went = tuple(self._things)
        for thing in went:
            thing.lost("gone")
        self._table, self._strange_since = None, None
        self._things.leave(went)
        now, gone = self._begin(cloud, at, number), tuple(thing.report(at) for thing in went)
        return replace(now, went=gone, notes=("the camera moved: the table is looked for again", *now.notes))

    def _begin_anew(self, cloud: PointCloud, image: FrameImage, changes: Changes, at: float, number: int) -> Situation:
        """Look at the whole table again: things that are not at their places are gone, and others are new."""
        found = detected_table(cloud, self.settings.detection)
        if isinstance(found, str):
            return self._situation(at, number, notes=(found,))
        assert self._table is not None and self._view is not None
        there = [thing for thing in self._things.resting if not has_left(thing, changes, self.settings.moved)]
        of = shown(found.labels, cloud, self.settings.stride)
        kept = matches(of, len(found.boxes), image, self._view.back, self._table.reference, there)
        went = tuple(thing for thing in self._things if thing not in kept.values())
        for thing in went:
            thing.lost("gone")
        self._things.leave(went)
        came = self._lay_out(found, cloud, image, at, kept)
        notes = ("most things changed at once: the table is looked at again",)
        return self._situation(at, number, came, went, notes=notes)

    def _lay_out(
        self, found: Detection, cloud: PointCloud, image: FrameImage, at: float, kept: dict[int, Pipeline]
    ) -> tuple[str, ...]:
        """Make a frame the reference and the first keyframe; return the ids of the new things."""
        assert self._table is not None and self._view is not None
        assert self._optics is not None and self._motion is not None
        self._last = cloud, image, self._number - 1
        self._recent, self._is_looked_at_closely = RecentFrames(self._optics, self.settings.recent), False
        self._recent.add(cloud, self._view.back)
        self._table, came = lay_out(self._table, self._things, found, cloud, image, self._view, at, kept, self.settings)
        owner = self._table.reference.owner
        self._motion.add_keyframe(image, levels_of(image), owner, self._view, self._things.rests)
        return came

    def _is_quiet(self, at: float) -> bool:
        """Return True if nothing moves over the table, and nothing has for a while."""
        return at - self._hand_at > HAND_MEMORY and not any(thing.active for thing in self._things)

    def _mean(self) -> PointCloud:
        """Return the last frame with the means of what the last frames measured."""
        assert self._recent is not None and self._table is not None
        return self._recent.mean(self.settings.tolerance, self._table.deviation, self.settings.colour)

    # The camera

    def _seen_from_here(self, image: FrameImage, at: float, table: Table) -> tuple[Changes, bool]:
        """Find where the camera is now, carry the reference to its view, and compare the frame with it.

        The second value is False if a camera that has moved before is now at an unknown place.
        """
        assert self._motion is not None and self._view is not None
        rests = self._things.rests
        found, levels = self._motion.follow(image, at, rests, table.noise)
        new = found is not None and self._motion.needs_keyframe()
        if found is not None:
            self._placed_at = at
            if new:
                self._motion.level(moved(image.points.reshape(-1, 3), self._motion.pose))
            view = table_view(image.optics, self._motion.pose, image.depth.shape)
            if moved_by(self._view, view) > STANDING:
                table.reference.carry(self._view, view, GAP)
                self._view, self._moved_at = view, at
                for thing in self._things:
                    thing.beneath = None
        changes = self._compared(image, at, table)
        if new:
            still = np.where(changes.same, table.reference.owner, np.int16(UNKNOWN_OWNER))
            self._motion.add_keyframe(image, levels, still, self._view, rests)
            on = np.flatnonzero(changes.same & (table.reference.owner == TABLE))
            table.outline.extend(image.places(on, self._view.back)[:, :2])
            table.colours.extend(image.colour.reshape(-1, 3)[on])
            for thing in self._things:
                thing.completed = False  # another side of it may be in view
        return changes, found is not None or np.isinf(self._moved_at)

    def _compared(self, image: FrameImage, at: float, table: Table) -> Changes:
        assert self._view is not None
        labels = max((thing.slot for thing in self._things), default=0)
        settings, reach = self.settings, EDGE_REACH if self._camera_moves(at) else 0
        return table.reference.compared(
            image, self._view.level, labels, settings.tolerance, table.deviation, settings.colour, reach, table.colours
        )

    def _camera_moves(self, at: float) -> bool:
        """Return True if the camera has moved a short while ago."""
        return at - self._moved_at < UNSTEADY_FOR


def _camera_moved(changes: Changes) -> bool:
    """Return True if most of the table is not where it was, although it is not hidden."""
    from deixis.perception.tracking.kernels import COLOUR, FARTHER, SAME

    table = changes.counts[TABLE]
    left = table[FARTHER] + table[COLOUR]
    return bool(left > table[SAME] and left > 0.2 * table.sum())
