"""Follow the things on a table from frame to frame, with what is new, what moves and what is gone.

The table at rest is a reference image of depth, colour and owner of every pixel. A thing rests while enough of its
pixels are unchanged; this costs nothing more. A thing that has left its place is followed by its particle filter.
Pixels that changed and stay as they are, and that are neither a hand's nor a moving thing's, are segmented, and become
new things or the places of things that were lost.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import BACKGROUND, Detection, detect, detect_above
from deixis.perception.detection.outline import oriented_box, upright_box
from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.detection.table.plane import Plane
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.errors import CloudError
from deixis.perception.scene import Scene
from deixis.perception.tracking.camera.motion import STANDING, CameraMotion, moved_by
from deixis.perception.tracking.camera.registration import levels_of
from deixis.perception.tracking.frames.image import FrameImage, Optics, TableView, image_of, optics_of, table_view
from deixis.perception.tracking.frames.recent import RecentFrames
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.situation import Situation
from deixis.perception.tracking.table.colours import TableColours
from deixis.perception.tracking.table.outline import Outline
from deixis.perception.tracking.table.reference import GAP, TABLE, UNKNOWN_OWNER, Changes, Reference
from deixis.perception.tracking.things.completion import (
    BEYOND,
    MARGIN,
    MIN_BEFORE,
    FlatThing,
    floating_parts,
    revealed_part,
    stands_behind,
    supporting_parts,
)
from deixis.perception.tracking.things.fitting import Fit, fits
from deixis.perception.tracking.things.hands import Hands
from deixis.perception.tracking.things.hidden_ends import hidden_lengths, likely_length
from deixis.perception.tracking.things.model import model_of
from deixis.perception.tracking.things.particles import Estimate
from deixis.perception.tracking.things.pipeline import Pipeline

MIN_FINITE_SHARE = 0.02
"""Minimum share of points with a depth in a frame that is used."""

MIN_OWN_PIXELS = 6
"""Minimum number of measured pixels of a thing that decide whether it rests."""

MIN_WAY = 0.012
"""Minimum distance in metres to its old place at which a thing has moved while this place is hidden."""

MAX_SPEED = 0.8
"""Speed in metres per second at which a thing may move while it is not found."""

MIN_MOVING_PIXELS = 80
"""Minimum number of pixels of something that moves and is not a thing, such as a part of a hand."""

DETECTION_PAUSE = 0.25
"""Minimum time in seconds between two segmentations."""

EDGE_REACH = 1
"""Distance in pixels within which an equal depth of the reference is looked for, while the camera moves."""

UNSTEADY_FOR = 1.0
"""Time in seconds after a movement of the camera in which pixels are compared within ``EDGE_REACH``."""

EXPOSED = 0.3
"""Minimum share of the points of a thing that nothing hides, for its place to be called empty or not."""

ABSENT = 0.2
"""Largest share of agreeing points, of those that nothing hides, at which the place of a thing is empty."""

MIN_GAIN, LEAST_EXPOSED, SEEN_WELL = 0.15, 0.1, 0.5
"""Minimum gain of agreement by which a thing that is mostly hidden has moved, the minimum share of its points that
nothing hides where it rested, for this comparison, and the minimum share that is seen elsewhere without it."""

BACK, BACK_AFTER = 0.7, 0.3
"""Minimum agreement at which a thing that was not found is again where it rested, and how long it was not found."""

AROUND, MIN_EXPLAINED = 0.03, 0.6
"""Distance in metres around a thing that is found far away, and its least share of the points that changed there."""

RETRY_AFTER = 1.0
"""Time in seconds after which changed pixels that gave no thing are by themselves a reason to segment again."""

MAX_TRIES = 2
"""Number of segmentations that find no thing in pixels as high as the table, after which they are the table's."""

FLAT = 0.002
"""Height in metres up to which a point may be the table's."""

ON_ITS_OWNER = -2
"""Mark of a pixel that may show something on the thing that has it in the reference."""

TOGETHER, TOUCHING, ALIKE = 2.0, 0.012, 0.5
"""Largest time in seconds between the coming of a thing and of a piece of it, their distance in metres, and the least
mean likeness of their colours in any light."""

SAME_HUE = 2.0
"""Largest distance in RGB between the median colours of two parts of one thing, across the direction of its light."""

MAX_TABLE_SHARE = 0.6
"""Largest share of the points of a detected object that may be the table's."""

REVEALED = 0.5
"""Minimum share of the pixels of a new thing at which nothing was known, for it to have come into view by itself."""

SET_DOWN = 1.0
"""Time in seconds before a new thing is steady in which the hand that sets it down is near."""

FILLED = 0.5
"""Minimum ratio of the sides of two boxes of one thing."""

CONFIRM_AFTER = 0.3
"""Time in seconds after which what a moving camera may have shown of a thing is compared with the next view."""

AGAIN_AFTER = 1.0
"""Time in seconds after which a moving camera may show the other end of a thing that something partly hides."""

BLIND_FOR = 1.5
"""Time in seconds in which nothing is concluded from frames of a moving camera whose place is not known."""

BLINK = 1.5
"""Minimum time in seconds between two frames at which anything may have happened in between."""

HAND_MEMORY = 0.5
"""Time in seconds after a hand was seen in which it may have moved several things at once."""

SAME_PIXELS = 0.3
"""Minimum intersection over union of pixels at which a detected and a tracked thing may be one."""

SAME_MODEL = 0.8
"""Minimum intersection over union of pixels at which a tracked thing keeps its model at a look at the whole table."""


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
        self._things: list[Pipeline] = []
        self._names = 0
        self._number = 0
        self._at: float | None = None
        self._frame: NDArray[np.float64] | None = None
        self._outline, self._hands = Outline(), Hands()
        self._colours = TableColours()
        self._motion: CameraMotion | None = None
        self._moved_at = self._placed_at = self._laid_out_at = -np.inf
        self._rests = itertools.count(1)
        self._optics: Optics | None = None
        self._view: TableView | None = None
        self._reference: Reference | None = None
        self._recent: RecentFrames | None = None
        self._is_looked_at_closely = False
        self._noise = 0.0015
        self._detected_at = -np.inf
        self._hand_at = -np.inf
        self._workers: ThreadPoolExecutor | None = None
        self._last: tuple[PointCloud, FrameImage, int] | None = None  # the last frame that was used

    def __enter__(self) -> Tracker:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the threads and all things."""
        if self._workers is not None:
            self._workers.shutdown()
        self._workers, self._reference, self._last, self._things = None, None, None, []

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
        if self._reference is None:
            return self._begin(cloud, at, number)
        assert self._optics is not None and self._view is not None and before is not None
        image = image_of(cloud, self._optics, self.settings.stride)
        changes, is_placed = self._seen_from_here(image, at)
        if not is_placed and at - self._placed_at < BLIND_FOR:
            return replace(self._situation(at, number), busy=True)
        if _camera_moved(changes):
            self._reference, self._things = None, []
            return replace(self._begin(cloud, at, number), notes=("the camera moved: the table is looked for again",))
        limits = self.settings
        self._reference.remember(image, changes, at, limits.tolerance, self._deviation, limits.colour)
        resting = [thing for thing in self._things if not thing.active]
        hand = self._hands.see(image, changes, self._outline, self._back, resting, at)
        by_hand = bool(hand.any()) or at - self._hand_at < HAND_MEMORY
        if (not by_hand or at - before > BLINK) and self._is_laid_anew(changes):
            return self._begin_anew(cloud, image, changes, at, number)
        if hand.any() or self._is_busy(image, changes, at):
            self._hand_at = at
        self._last = cloud, image, number
        assert self._recent is not None
        self._recent.add(cloud, self._view.back)
        self._look_at_resting(image, changes, at)
        self._follow(image, changes, at, at - before)
        went = self._let_go(at)
        came = self._look_for_new(image, changes, hand, at)
        if self._is_quiet(at) and not self._is_looked_at_closely and at - self._laid_out_at >= self.settings.steady:
            closer = self._look_closely(at)
            came, merged = (*came, *closer.came), closer.merged
        else:
            merged = tuple(thing.report(at) for thing in self._complete(image, changes, hand, at))
        return replace(self._situation(at, number, came, went), merged=merged, busy=self._hand_at == at)

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
        if self._reference is None:
            return np.zeros((0, 0), np.int16)
        number = np.full(max((thing.slot for thing in self._things), default=0) + 2, -1, np.int16)
        for place, thing in enumerate(self._things):
            number[thing.slot] = place
        owner = self._reference.owner
        return np.where(owner < len(number) - 1, number[owner], np.int16(-1))

    @property
    def _deviation(self) -> float:
        """Difference of depths at one metre that counts as a change."""
        return self.settings.noise_ratio * self._noise

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
        if self._reference is not None:
            stride, (rows, columns) = self.settings.stride, cloud.organised
            first = stride // 2
            if (len(range(first, rows, stride)), len(range(first, columns, stride))) != self._reference.depth.shape:
                return f"the size of the image changed to {columns} by {rows} pixels; the frame is left out"
        return None

    def _situation(
        self,
        at: float,
        number: int,
        came: tuple[str, ...] = (),
        went: tuple[Pipeline, ...] = (),
        notes: tuple[str, ...] = (),
    ) -> Situation:
        things = tuple(thing.report(at) for thing in self._things)
        return Situation(at, number, things, came, tuple(thing.report(at) for thing in went), self._frame, notes)

    # The first frame

    def _begin(self, cloud: PointCloud, at: float, number: int) -> Situation:
        """Find the table and the things on it."""
        optics = optics_of(cloud)
        if optics is None:
            return self._situation(at, number, notes=("the cloud is not the image of a pinhole camera at its origin",))
        found = self._detected_table(cloud)
        if isinstance(found, str):
            return self._situation(at, number, notes=(found,))
        self._optics, self._frame, self._motion = optics, found.frame, CameraMotion(found.frame, at)
        image = image_of(cloud, optics, self.settings.stride)
        self._view = table_view(image.optics, found.frame, image.depth.shape)
        heights = image.points.reshape(-1, 3) @ found.frame[2, :3] + found.frame[2, 3]
        on = np.abs(heights) < 0.01
        self._outline, self._hands, self._colours = Outline(), Hands(), TableColours()
        self._outline.extend(image.places(np.flatnonzero(on), found.frame)[:, :2])
        self._noise = _noise(image.depth.ravel()[on], self._view.level.ravel()[on])
        return self._situation(at, number, self._lay_out(found, cloud, image, at, {}))

    def _lay_out(
        self, found: Detection, cloud: PointCloud, image: FrameImage, at: float, kept: Mapping[int, Pipeline]
    ) -> tuple[str, ...]:
        """Make a frame the reference, in which the objects of a detection are new things or those that are kept."""
        assert self._view is not None
        assert self._optics is not None
        self._last, self._laid_out_at = (cloud, image, self._number - 1), at
        self._recent, self._is_looked_at_closely = RecentFrames(self._optics, self.settings.recent), False
        self._recent.add(cloud, self._view.back)
        of = self._shown(found.labels, cloud)
        self._reference = Reference(image, np.full(of.shape, UNKNOWN_OWNER, np.int16), at)
        near = np.abs(image.depth - self._view.level) < np.maximum(
            self.settings.tolerance, self._deviation * image.depth**2
        )
        plan = moved(image.points.reshape(-1, 3), self._view.back)
        beyond = self._outline.beyond(plan[:, :2]).reshape(of.shape) & (image.depth > 0)
        self._colours.extend(image.colour[(of < 0) & near & (image.depth > 0)])
        self._reference.give(np.flatnonzero((of < 0) & (near | beyond)), TABLE, image)
        came = []
        for k in range(len(found.boxes)):
            own = np.flatnonzero(of == k)
            if k in kept:
                self._reference.give(own, kept[k].slot, image)
            elif not self._outline.is_crossed_by(image.places(own, self._back)):
                came.append(self._enter(found, cloud, np.flatnonzero(found.labels == k), k, at))
                self._reference.give(own, self._things[-1].slot, image)
        self._let_stand(came, image)
        rests = {thing.slot: thing.rest for thing in self._things}
        assert self._motion is not None
        self._motion.add_keyframe(image, levels_of(image), self._reference.owner, self._view, rests)
        return tuple(came)

    def _let_stand(self, ids: Collection[str], image: FrameImage) -> None:
        """Extend new things down to the table whose feet are hidden."""
        assert self._view is not None
        resting = [thing for thing in self._things if not thing.active]
        for thing in resting:
            if thing.id in ids and stands_behind(thing, resting, image, self._view):
                thing.stand()

    def _shown(self, labels: NDArray[np.int32], cloud: PointCloud) -> NDArray[np.int32]:
        """Return the labels of a cloud at the pixels that are compared."""
        assert cloud.organised is not None
        first, stride = self.settings.stride // 2, self.settings.stride
        return labels.reshape(cloud.organised)[first::stride, first::stride]

    def _enter(self, found: Detection, cloud: PointCloud, points: NDArray[np.intp], k: int, at: float) -> str:
        """Begin the pipeline of object ``k`` of a detection, which has the given points of the cloud."""
        used = {pipeline.slot for pipeline in self._things}
        slot = next(slot for slot in range(1, len(used) + 2) if slot not in used)
        self._names += 1
        self._things.append(self._modelled(found, cloud, points, k, f"t{self._names}", slot, at))
        return self._things[-1].id

    def _modelled(
        self, found: Detection, cloud: PointCloud, points: NDArray[np.intp], k: int, id: str, slot: int, at: float
    ) -> Pipeline:
        assert self._frame is not None
        points = self._without_table(cloud, points)
        change = self._frame @ np.linalg.inv(found.frame)  # from the detection's frame to that of the first frame
        model = model_of(found, cloud, points, k, change, self.settings.detection.outlines)
        made = Pipeline(id, slot, model.cloud, model.half, model.oriented, model.pose, at, self.settings)
        made.rest = next(self._rests)
        return made

    def _without_table(self, cloud: PointCloud, points: NDArray[np.intp]) -> NDArray[np.intp]:
        """Return the points of a detected object that do not show the table beside it, as between the tines of a fork.

        These are as low as the table and have its colours; an object of which little else is left keeps all.
        """
        assert self._frame is not None
        if cloud.colours is None:
            return points
        heights = cloud.points[points] @ self._frame[2, :3] + self._frame[2, 3]
        low = (heights < self.settings.tolerance) & self._colours.include(cloud.colours[points].astype(np.float32))
        return points[~low] if low.mean() < MAX_TABLE_SHARE else points

    # Looks at the whole table

    def _detected_table(self, cloud: PointCloud) -> Detection | str:
        """Return what a look at the whole table finds, or why it finds no table."""
        try:
            found = detect(cloud, self.settings.detection)
        except CloudError as error:
            return str(error)
        return found if found.table is not None else "; ".join(found.notes) or "no table was found"

    def _is_laid_anew(self, changes: Changes) -> bool:
        """Return True if most things that were at rest left their places at once."""
        resting = [thing for thing in self._things if not thing.active]
        left = sum(self._has_left(thing, changes) for thing in resting)
        return left >= 2 and 2 * left >= len(resting)

    def _begin_anew(self, cloud: PointCloud, image: FrameImage, changes: Changes, at: float, number: int) -> Situation:
        """Look at the whole table again: things that are not at their places are gone, and others are new."""
        found = self._detected_table(cloud)
        if isinstance(found, str):
            return self._situation(at, number, notes=(found,))
        there = [thing for thing in self._things if not thing.active and not self._has_left(thing, changes)]
        kept = self._matches(self._shown(found.labels, cloud), len(found.boxes), image, there)
        went = tuple(thing for thing in self._things if thing not in kept.values())
        for thing in went:
            thing.lost("gone")
        self._things = [thing for thing in self._things if thing in kept.values()]
        came = self._lay_out(found, cloud, image, at, kept)
        return self._situation(at, number, came, went, ("most things changed at once: the table is looked at again",))

    def _is_quiet(self, at: float) -> bool:
        """Return True if nothing moves over the table, and nothing has for a while."""
        return at - self._hand_at > HAND_MEMORY and not any(thing.active for thing in self._things)

    def _look_closely(self, at: float) -> Situation:
        """Correct the things of the first look by the mean of the frames since, which has less noise.

        The noise of one frame cuts off the ends of thin things, cuts things into pieces, and hides what lies on a
        plate.
        """
        assert self._frame is not None
        self._is_looked_at_closely = True
        plane = Plane(self._frame[2, :3], -float(self._frame[2, 3]))
        cloud = self._mean()
        found = detect_above(cloud, plane, self.settings.detection)
        if found is None:
            return self._situation(at, self._number - 1)
        found = self._reconciled(found, cloud)
        situation, matches = self._correct(found, cloud, at, least_shared=1.0)
        self._free_table(self._shown(found.labels, cloud), matches.values())
        return situation

    def _reconciled(self, found: Detection, cloud: PointCloud) -> Detection:
        """Return a detection in which things that were found before keep what has their colours, and nothing else.

        Whether a knife is cut off from a plate, or the foot of a glass from its bowl, depends on the noise. An object
        that is a piece of a thing and has its colours is joined to it; a thing of other colours than the object in
        which it is keeps its points.
        """
        assert self._last is not None and self._reference is not None and cloud.organised is not None
        if cloud.colours is None:
            return found
        image, labels, owner = self._last[1], found.labels.copy(), self._reference.owner
        of = self._shown(labels, cloud)
        matches = self._matches(of, len(found.boxes), image, self._things)
        tints = cloud.colours.astype(np.float64)
        for thing in self._things:
            own = owner == thing.slot
            if thing in matches.values() or not own.any():
                continue
            k = int(np.bincount(of[own] + 1).argmax()) - 1
            inside = _enlarged(own, self.settings.stride, cloud.organised).ravel() & (labels == k)
            around = (labels == k) & ~inside
            if k >= 0 and around.any() and not _have_one_hue(tints[inside], tints[around]):
                labels[inside] = BACKGROUND
        joined = list(range(len(found.boxes)))
        for k in sorted(set(joined) - set(matches)):
            slots = owner[of == k]
            for whole, thing in matches.items():
                is_its_own = len(slots) > 0 and (slots == thing.slot).mean() > 0.5
                if is_its_own and _have_one_hue(tints[labels == k], tints[labels == whole]):
                    joined[k] = whole
        return _rejoined(replace(found, labels=labels), joined, self.settings.detection.outlines)

    def _free_table(self, of: NDArray[np.int32], ids: Collection[str]) -> None:
        """Give the pixels that things no longer have, and that are as low as the table, to the table."""
        assert self._reference is not None and self._view is not None
        reference, level = self._reference, self._view.level
        near = np.abs(reference.depth - level) < np.maximum(self.settings.tolerance, self._deviation * level**2)
        slots = [thing.slot for thing in self._things if thing.id in ids]
        reference.owner[(of == BACKGROUND) & np.isin(reference.owner, slots) & near] = TABLE

    def _mean(self) -> PointCloud:
        """Return the last frame with the means of what the last frames measured."""
        assert self._recent is not None
        return self._recent.mean(self.settings.tolerance, self._deviation, self.settings.colour)

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
        if self._last is None or self._reference is None or self._at is None:
            raise CloudError("look_again() needs a frame; call update() first")
        cloud = self._last[0]
        if not isinstance(found, Detection) or len(found.labels) != len(cloud):
            raise CloudError("`scene` must be perceived in the cloud of the last frame")
        situation, ids = self._correct(_detected(scene), cloud, self._at, SAME_MODEL)
        return situation, {detected.id: ids[k] for k, detected in enumerate(scene.objects) if k in ids}

    def _correct(
        self, whole: Detection, cloud: PointCloud, at: float, least_shared: float
    ) -> tuple[Situation, dict[int, str]]:
        """Correct the things by a detection of the whole table; return the ids of the detected objects by number.

        A thing keeps its model if its pixels are those of the detected one at least to this intersection over union.
        """
        assert self._last is not None and self._reference is not None
        (_, image, number), reference = self._last, self._reference
        of = self._shown(whole.labels, cloud)
        matches = self._matches(of, len(whole.boxes), image, self._things)
        merged = []
        for thing in self._things:
            if thing in matches.values():
                continue
            if thing.active:
                thing.lost()
                continue
            own = of[reference.owner == thing.slot]
            if len(own) and thing.state == "seen" and (own >= 0).mean() >= 0.5:
                merged.append(thing)
        self._things = [thing for thing in self._things if thing not in merged]
        for thing in merged:
            reference.take(thing.slot, None, set())
        came, modelled, ids = [], [], dict[int, str]()
        for k in range(len(whole.boxes)):
            pixels = np.flatnonzero(of == k)
            points = np.flatnonzero(whole.labels == k)
            if k in matches:
                thing = matches[k]
                if thing.active or _shared(reference.owner == thing.slot, of == k) < least_shared:
                    thing = self._remodelled(thing, self._modelled(whole, cloud, points, k, thing.id, thing.slot, at))
                    modelled.append(thing.id)
            elif self._outline.is_crossed_by(image.places(pixels, self._back)) or self._is_piece(image, pixels):
                continue
            else:
                came.append(self._enter(whole, cloud, points, k, at))
                thing = self._things[-1]
                thing.since = thing.at = float(np.median(reference.since.ravel()[pixels]))
            ids[k] = thing.id
            reference.assign(pixels, thing.slot, image, self.settings.tolerance, self._deviation)
        self._let_stand((*came, *modelled), image)
        situation = self._situation(at, number, tuple(came))
        return replace(situation, merged=tuple(thing.report(at) for thing in merged)), ids

    def _matches(
        self, of: NDArray[np.int32], count: int, image: FrameImage, things: list[Pipeline]
    ) -> dict[int, Pipeline]:
        """Return which of the things each detected object is, by the pixels that both have.

        Pixels beside each other count: a moving camera shows thin things a pixel beside where they were.
        """
        from scipy.ndimage import binary_dilation
        from scipy.optimize import linear_sum_assignment

        assert self._reference is not None
        shared, square = np.zeros((count, len(things))), np.ones((3, 3))
        around = [binary_dilation(of == k, square) for k in range(count)]
        sizes = np.bincount(of[of >= 0], minlength=count)
        above = np.flatnonzero(of >= 0)
        points = image.places(above, self._back)
        for column, thing in enumerate(things):
            own = np.zeros(of.shape, np.bool_)
            if not thing.active:
                own = self._reference.owner == thing.slot
            elif thing.found:
                own.ravel()[above] = thing.contains(points, self.settings.margin)
            near = binary_dilation(own, square)
            both = np.array([near[of == k].sum() + around[k][own].sum() for k in range(count)]) / 2
            shared[:, column] = both / np.maximum(sizes + own.sum() - both, 1)
        pairs = zip(*linear_sum_assignment(-shared), strict=True)
        return {int(k): things[column] for k, column in pairs if shared[k, column] >= SAME_PIXELS}

    def _remodelled(self, thing: Pipeline, new: Pipeline) -> Pipeline:
        """Replace a pipeline by another one of the same thing, and return it.

        What the frame does not show of a thing at rest stays: a camera that moves may have seen it before.
        """
        assert self._last is not None and self._view is not None
        if not thing.active:
            new.rest = thing.rest
            points = thing.placed_points
            hidden = self._view.hides(points, self._last[1].depth, MIN_BEFORE)
            if hidden.any() and thing.cloud.colours is not None:
                new.extend(
                    points[hidden], thing.cloud.colours[hidden].astype(np.float32), self.settings.detection.outlines
                )
        moves = thing.active and float(np.linalg.norm(new.pose[:3, 3] - thing.pose[:3, 3])) > self.settings.still
        new.since, new.at = (new.at if moves else thing.since), thing.at
        self._things[self._things.index(thing)] = new
        return new

    # What rests and what moves

    def _seen_from_here(self, image: FrameImage, at: float) -> tuple[Changes, bool]:
        """Find where the camera is now, carry the reference to its view, and compare the frame with it.

        The second value is False if a camera that has moved before is now at an unknown place.
        """
        assert self._motion is not None and self._reference is not None and self._view is not None
        rests = {thing.slot: thing.rest for thing in self._things if not thing.active}
        found, levels = self._motion.follow(image, at, rests, self._noise)
        new = found is not None and self._motion.needs_keyframe()
        if found is not None:
            self._placed_at = at
            if new:
                self._motion.level(moved(image.points.reshape(-1, 3), self._motion.pose))
            view = table_view(image.optics, self._motion.pose, image.depth.shape)
            if moved_by(self._view, view) > STANDING:
                self._reference.carry(self._view, view, GAP)
                self._view, self._frame, self._moved_at = view, self._motion.pose, at
                for thing in self._things:
                    thing.beneath = None
        changes = self._compare(image, at)
        if new:
            still = np.where(changes.same, self._reference.owner, np.int16(UNKNOWN_OWNER))
            self._motion.add_keyframe(image, levels, still, self._view, rests)
            on = np.flatnonzero(changes.same & (self._reference.owner == TABLE))
            self._outline.extend(image.places(on, self._back)[:, :2])
            self._colours.extend(image.colour.reshape(-1, 3)[on])
            for thing in self._things:
                thing.completed = False  # another side of it may be in view
        return changes, found is not None or np.isinf(self._moved_at)

    def _is_table_coloured(self, image: FrameImage) -> NDArray[np.bool_]:
        """Return a mask (r, c) of the pixels whose colour the table may have."""
        return self._colours.include(image.colour.reshape(-1, 3)).reshape(image.depth.shape)

    def _compare(self, image: FrameImage, at: float) -> Changes:
        assert self._reference is not None and self._view is not None
        labels = max((thing.slot for thing in self._things), default=0)
        settings = self.settings
        return self._reference.compared(
            image, self._view.level, labels, settings.tolerance, self._deviation, settings.colour,
            EDGE_REACH if self._camera_moves(at) else 0, self._colours,
        )  # fmt: skip

    def _camera_moves(self, at: float) -> bool:
        """Return True if the camera has moved a short while ago."""
        return at - self._moved_at < UNSTEADY_FOR

    def _look_at_resting(self, image: FrameImage, changes: Changes, at: float) -> None:
        """Decide by their pixels which resting things are still at their places."""
        from deixis.perception.tracking.kernels import EDGE, MISSING, NEARER, SAME

        assert self._reference is not None
        for thing in self._things:
            if thing.active:
                continue
            count = changes.counts[thing.slot]
            measured = int(count.sum() - count[MISSING] - count[EDGE])
            visible = measured - int(count[NEARER])
            if measured < MIN_OWN_PIXELS:
                self._look_once_more(thing, image, at)
            elif self._has_left(thing, changes):
                self._start(thing)
            elif count[SAME] >= self.settings.doubtful * measured:
                thing.seen_at_rest(at, float(count[SAME]) / max(visible, 1))
                thing.particles = 0

    def _look_once_more(self, thing: Pipeline, image: FrameImage, at: float) -> None:
        """Compare a resting thing without pixels in the reference, such as one that comes into view, with the frame."""
        assert self._reference is not None and self._view is not None
        others = (self._reference.owner != TABLE) & (self._reference.owner != thing.slot)
        agreement, exposed = thing.seen_at_place(image, self._view, others & (self._reference.depth > 0), self._noise)
        if exposed < EXPOSED or ABSENT < agreement < self.settings.fit:
            thing.lost()
        elif agreement <= ABSENT:
            self._start(thing)
        else:
            thing.seen_at_rest(at, agreement)

    def _has_left(self, thing: Pipeline, changes: Changes) -> bool:
        """Return True if the place of a thing that was at rest shows what is behind it."""
        from deixis.perception.tracking.kernels import COLOUR, EDGE, FARTHER, MISSING, NEARER

        count = changes.counts[thing.slot]
        measured = int(count.sum() - count[MISSING] - count[EDGE])
        visible, left = measured - int(count[NEARER]), int(count[FARTHER] + count[COLOUR])
        seen = visible >= max(MIN_OWN_PIXELS, 0.25 * measured)
        return seen and left > self.settings.moved * visible

    def _start(self, thing: Pipeline) -> None:
        """Let a thing move: its pixels are free."""
        assert self._reference is not None
        for other in self._things:
            if other is not thing and not other.active and other.lies_on(thing):
                other.load_onto(thing)
        thing.active = True
        self._reference.take(thing.slot, thing.beneath, {other.slot for other in self._things if other is not thing})
        thing.beneath = None

    def _follow(self, image: FrameImage, changes: Changes, at: float, seconds: float) -> None:
        """Look for the things that move, and for those whose places are mostly hidden."""
        assert self._reference is not None and self._view is not None
        for thing in self._things:
            if not thing.active and thing.seen_at < at and thing.is_carried_off(MIN_WAY):
                self._start(thing)
        moving = sorted((thing for thing in self._things if thing.active), key=lambda thing: -thing.reach)
        doubtful = [
            thing
            for thing in self._things
            if not thing.active and thing.seen_at < at and self._view.shows(thing.pose[:3, 3])
        ]
        if not moving and not doubtful:
            return
        view, reference, limits = self._view, self._reference, self.settings
        same = changes.same
        free = np.flatnonzero(~same & (image.depth > 0))
        points = image.places(free, view.back)
        above = (points[:, 2] > FLAT) | ~self._is_table_coloured(image).ravel()[free]
        free, points = free[above], points[above]
        tints = image.colour.reshape(-1, 3)[free].astype(np.float64)

        def follow(thing: Pipeline) -> tuple[Pipeline, Estimate, float, float]:
            own = reference.owner == thing.slot
            if thing.carrier is not None:  # which may have been given its pixels
                own |= reference.owner == thing.carrier.slot
            taken = (same & ~own) | others
            return thing, *thing.follow(image, view, taken, points, tints, seconds, self._noise)

        others = np.zeros(same.shape, np.bool_)
        for thing in moving:
            if not thing.found:
                self._carry(thing)
        for thing, found, fit, visible in self._each(follow, moving):
            if not thing.active:  # it was set down with what it lies on
                continue
            if not self._is_certain(thing, found, fit, visible, at, seconds, points):
                if self._is_back(thing, image, same, at):
                    self._claim(thing, image, changes)
                    continue
                if thing.found or thing.is_carried_off(MIN_WAY):
                    self._carry(thing)
                if self._camera_moves(at) and not self._outline.beyond(thing.pose[None, :2, 3])[0]:
                    thing.out_of_view |= thing.is_leaving(view, seconds)
                thing.lost()
                continue
            thing.moved_to(found.pose, at, fit)
            thing.visible = visible
            if thing.is_still(at) and (visible > 0.6 or at - self._hand_at > limits.still_for):
                self._settle(thing)
                loads = [load for load in moving if self._is_set_down_with(load, thing, image, same, at)]
                for each in (thing, *loads):
                    self._claim(each, image, changes)
        for thing in moving:  # what is theirs is not another thing that left its place unseen
            if thing.found:
                others.ravel()[free[thing.contains(points, limits.margin)]] = True
        left = ~others.ravel()[free]
        points, tints = points[left], tints[left]
        for thing, found, fit, visible in self._each(follow, doubtful):
            way = float(np.linalg.norm(found.place - thing.pose[:3, 3]))
            moved_there = MIN_WAY < way < limits.jump and fit > 0.6 and visible > limits.visible
            if moved_there and not self._is_as_likely_at_rest(thing, fit, visible, image, same):
                self._start(thing)
                thing.moved_to(found.pose, at, fit)
            else:
                thing.rest_again()
                thing.lost()

    def _is_certain(
        self,
        thing: Pipeline,
        found: Estimate,
        fit: float,
        visible: float,
        at: float,
        seconds: float,
        points: NDArray[np.float64],
    ) -> bool:
        """Return True if a frame shows a thing where it was found.

        Far from where it was, it must be seen well, and be more than a part of what changed there.
        """
        limits = self.settings
        if fit <= limits.fit or visible <= limits.visible:
            return False
        way = thing.way_from_expected(found.place, seconds)
        lost = at - thing.seen_at - seconds if thing.active and not thing.in_hand else 0.0
        if way < limits.jump + MAX_SPEED * max(lost, 0.0):
            return True
        own, around = (thing.contains(points, margin, found.pose).sum() for margin in (limits.margin, AROUND))
        return bool(fit > 0.7 and visible > 0.5 and own > MIN_EXPLAINED * around)

    def _is_as_likely_at_rest(
        self, thing: Pipeline, fit: float, visible: float, image: FrameImage, same: NDArray[np.bool_]
    ) -> bool:
        """Return True if a thing may as well be where it rested as where it was found.

        It agrees as well with the frame there, or its place is hidden and too little of it is seen where it was found.
        """
        agreement, exposed = self._seen_where_it_rested(thing, image, same)
        return agreement > fit - MIN_GAIN if exposed > LEAST_EXPOSED else visible < SEEN_WELL

    def _is_back(self, thing: Pipeline, image: FrameImage, same: NDArray[np.bool_], at: float) -> bool:
        """Let a thing that was not found rest where it rested before, if the frame shows it there."""
        if at - thing.seen_at < BACK_AFTER:
            return False
        agreement, exposed = self._seen_where_it_rested(thing, image, same)
        if exposed < EXPOSED or agreement < BACK:
            return False
        thing.put(thing.last_rest)
        thing.moved_to(thing.last_rest, at, agreement)
        self._settle(thing)
        return True

    def _seen_where_it_rested(self, thing: Pipeline, image: FrameImage, same: NDArray[np.bool_]) -> tuple[float, float]:
        assert self._reference is not None and self._view is not None
        taken = same & (self._reference.owner != thing.slot)
        return thing.seen_at_place(image, self._view, taken, self._noise, thing.last_rest)

    def _is_set_down_with(
        self, load: Pipeline, carrier: Pipeline, image: FrameImage, same: NDArray[np.bool_], at: float
    ) -> bool:
        """Let a thing that was not found rest on what carried it and was set down, if the frame does not deny it."""
        assert self._reference is not None and self._view is not None
        if not load.active or load.found or load.carrier is not carrier or not load.is_carried_off(MIN_WAY):
            return False
        load.ride()
        taken = same & ~np.isin(self._reference.owner, (load.slot, carrier.slot))
        agreement, exposed = load.seen_at_place(image, self._view, taken, self._noise)
        if exposed > EXPOSED and agreement < ABSENT:
            return False
        load.moved_to(load.pose, at, agreement)
        self._settle(load)
        return True

    def _carry(self, thing: Pipeline) -> None:
        """Move a thing that left its place and is not seen with what it lay on, or with the hand that may hold it."""
        if thing.is_carried_off(MIN_WAY):
            thing.ride()
            return
        step = self._hands.carried(thing.pose[:3, 3], thing.reach)
        if step is not None:
            thing.carry(step)

    def _each(self, job, things: list[Pipeline]) -> Iterator:  # type: ignore[no-untyped-def, type-arg]
        """Run a job for each thing, in the threads that all pipelines share."""
        if len(things) == 1 or self.settings.workers == 1:
            return map(job, things)
        if self._workers is None:
            self._workers = ThreadPoolExecutor(self.settings.workers, thread_name_prefix="pipeline")
        return self._workers.map(job, things)

    def _settle(self, thing: Pipeline) -> None:
        thing.settle()
        thing.rest = next(self._rests)

    def _claim(self, thing: Pipeline, image: FrameImage, changes: Changes) -> None:
        """Assign the changed pixels within the box of a thing that has come to rest to this thing.

        What it lies on may own pixels that show the thing.
        """
        from deixis.perception.tracking.kernels import SAME

        assert self._reference is not None and self._view is not None
        below = [other.slot for other in self._things if not other.active and thing.lies_on(other)]
        free = np.flatnonzero((~changes.same | np.isin(self._reference.owner, below)) & (image.depth > 0))
        points = image.places(free, self._view.back)
        things, of = self._things_around(image, free, points, thing.settled_at)
        own = free[(of == things.index(thing)) & thing.contains(points, self.settings.margin) & (points[:, 2] > 0.001)]
        thing.beneath = self._reference.give(own, thing.slot, image)
        changes.state.ravel()[own] = SAME

    def _let_go(self, at: float) -> tuple[Pipeline, ...]:
        """End the pipelines of things that left their places and were not found for a while."""
        limits = self.settings
        gone = []
        for thing in self._things:
            if thing.active and not thing.found:
                alone = at - max(thing.seen_at, self._hand_at)
                patience = limits.away_after if thing.out_of_view else limits.gone_after
                if alone > patience or at - thing.seen_at > limits.lost_after:
                    thing.lost("gone")
                    gone.append(thing)
        self._things = [thing for thing in self._things if thing not in gone]
        return tuple(gone)

    def _complete(
        self, image: FrameImage, changes: Changes, hand: NDArray[np.bool_], at: float
    ) -> tuple[Pipeline, ...]:
        """Add the missing parts to one of the things that have rested for a while; return what was merged."""
        assert self._reference is not None and self._view is not None
        limits, reference, view = self.settings, self._reference, self._view
        moves = self._camera_moves(at)
        ready = (
            thing
            for thing in self._things
            if not thing.active and thing.seen_at == at
            and (not thing.completed or (thing.is_suspected and at - thing.completed_at >= CONFIRM_AFTER)
                 or (moves and thing.cut_off and at - thing.completed_at >= AGAIN_AFTER))
            and at - max(thing.at, thing.settled_at) >= limits.complete_after and self._is_clear(thing, hand, at)
        )  # fmt: skip
        # a moving camera leaves no time to complete all things
        thing = min(ready, key=lambda each: (not each.is_suspected, each.completed_at), default=None)
        if thing is None:
            return ()
        thing.completed, thing.completed_at = True, at
        own = np.flatnonzero(reference.owner == thing.slot)
        if not thing.first_rest and len(own) >= limits.least_pixels:
            taken = (changes.same & (reference.owner != thing.slot)) | hand
            thing.align(image, view, taken, reference.points(own, view), self._noise)
        eye = float(view.back[2, :3] @ image.optics.eye + view.back[2, 3])
        differs = ~changes.same
        if moves:  # at the edges of things, pixels are compared with those beside them
            differs |= np.linalg.norm(image.colour - reference.colour, axis=-1) > limits.colour
        changed = differs & (image.depth > 0) & (at - reference.since >= limits.steady) & ~hand

        def flat() -> FlatThing:
            return FlatThing(thing, reference, view, eye, self._noise, limits.colour, image, changed, thing.views)

        seen = flat()
        resting = [other for other in self._things if other is not thing and not other.active]
        parts_below = supporting_parts(thing, resting)
        merged = list(dict.fromkeys([*seen.pieces(resting), *floating_parts(thing, resting), *parts_below]))
        resting = [other for other in resting if other not in merged]
        parts = np.flatnonzero(np.isin(reference.owner, [piece.slot for piece in merged]))
        if merged:
            reference.owner.ravel()[parts] = thing.slot
            seen = flat()
        new, revealed = seen.missing_part(), revealed_part(thing, resting, reference, view)
        thing.views += 1
        thing.cut_off = seen.is_cut_off
        if seen.is_seen_again or (moves and seen.is_carried):  # what one view shows may be something else
            both = np.union1d(new, revealed)
            is_new = changed.ravel()[both, None]
            seen_now = np.where(is_new, image.places(both, view.back), reference.points(both, view))
            seen_twice = both[thing.confirms(seen_now) & (~thing.contains(seen_now, BEYOND) | seen.is_carried)]
            new, revealed = np.intersect1d(new, seen_twice), np.intersect1d(revealed, seen_twice)
        reference.owner.ravel()[new] = thing.slot
        reference.give(new[changed.ravel()[new]], thing.slot, image)
        new = np.union1d(np.union1d(new, parts), revealed)
        if len(new):
            each = np.repeat(new, limits.stride**2)  # as dense as the thing's own points, of all rows and columns
            colours = reference.colour.reshape(-1, 3)[each]
            thing.extend(reference.points(each, view), colours, limits.detection.outlines)
        ends = thing.unseen_ends(hidden_lengths(thing, resting, reference, view))
        length, width, _ = thing.oriented.extents
        thing.suppose(ends, *(likely_length(length, width, length + sum(ends)) if any(ends) else (length, 0.0)))
        if merged:
            thing.take_name(merged, at)
        self._things = [other for other in self._things if other not in merged]
        return tuple(merged)

    def _is_clear(self, thing: Pipeline, hand: NDArray[np.bool_], at: float) -> bool:
        """Return True if nothing moves over the table, or only a hand that is far from a thing in the image.

        A thing that was followed has pixels that a hand may have spoilt: it is not clear while a hand is in view.
        """
        assert self._reference is not None
        if self._hand_at < at:
            return True
        own = self._reference.owner == thing.slot
        rows, columns = (np.flatnonzero(own.any(axis=axis)) for axis in (1, 0))
        if not hand.any() or not len(rows) or not thing.first_rest:
            return False
        top, left = max(int(rows[0]) - MARGIN, 0), max(int(columns[0]) - MARGIN, 0)
        return not hand[top : int(rows[-1]) + MARGIN + 1, left : int(columns[-1]) + MARGIN + 1].any()

    # What is new

    def _is_busy(self, image: FrameImage, changes: Changes, at: float) -> bool:
        """Return True if something moves that is not one of the things."""
        from deixis.perception.tracking.kernels import NEARER

        assert self._reference is not None
        moves = (changes.state == NEARER) & (at - self._reference.since < 0.5 * self.settings.steady)
        place = np.flatnonzero(moves & (image.depth > 0))
        if len(place) < MIN_MOVING_PIXELS:
            return False
        points = image.places(place, self._back)
        strange = points[:, 2] > 0.01
        for thing in self._things:
            strange &= ~thing.contains(points, self.settings.margin)
        return bool(strange.sum() >= MIN_MOVING_PIXELS)

    @property
    def _back(self) -> NDArray[np.float64]:
        assert self._view is not None
        return self._view.back

    def _look_for_new(self, image: FrameImage, changes: Changes, hand: NDArray[np.bool_], at: float) -> tuple[str, ...]:
        """Segment what changed and stays as it is; return the ids of new things."""
        from deixis.perception.tracking.kernels import FARTHER

        reference, limits = self._reference, self.settings
        assert reference is not None
        steady = at - reference.since >= limits.steady
        free = np.flatnonzero(~changes.same & (image.depth > 0) & steady & ~hand)
        if not len(free):
            return ()
        points = image.places(free, self._back)
        level = np.abs(points[:, 2]) < FLAT
        nothing = self._is_table_coloured(image).ravel()[free] | (reference.tries.ravel()[free] >= MAX_TRIES)
        flat = (level & nothing) | self._outline.beyond(points[:, :2])
        reference.give(free[flat], TABLE, image)
        free, points = free[~flat], points[~flat]
        edge = self._edges(free, at)
        owner = np.where(edge | (changes.state.ravel()[free] == FARTHER), UNKNOWN_OWNER, reference.owner.ravel()[free])
        for thing in self._things:
            if not thing.active:  # what is nearer than a thing, or of another colour, may lie on it
                owner[(owner == thing.slot) & thing.contains(points, limits.margin)] = ON_ITS_OWNER
        things, of = self._things_around(image, free, points, at)
        left = np.ones(len(free), np.bool_)
        for number, thing in enumerate(things):
            own = of == number
            if not thing.active:
                own &= owner != ON_ITS_OWNER
                reference.give(free[own], thing.slot, image)
            left &= ~own
        free = free[left & ~edge]
        untried = int((reference.retry_at.ravel()[free] <= at).sum())
        if untried < limits.least_pixels or at - self._detected_at < DETECTION_PAUSE:
            return ()
        self._detected_at = at
        return self._segment(image, changes, free, at)

    def _things_around(
        self, image: FrameImage, pixels: NDArray[np.intp], points: NDArray[np.float64], at: float
    ) -> tuple[list[Pipeline], NDArray[np.intp]]:
        """Return the things that were found, and the number of the one that each pixel may show, or -1.

        Of several things whose boxes contain a point, it is the one whose points agree best with it in place and
        colour, as for a knife on a plate that were set down together.
        """
        limits = self.settings
        things = [thing for thing in self._things if thing.found or not thing.active or thing.is_carried_off(MIN_WAY)]
        things.sort(key=lambda thing: float(np.prod(thing.oriented.extents)))
        if not things:
            return things, np.full(len(pixels), -1)
        inside = np.array([thing.contains(points, limits.margin) for thing in things])
        wide = np.array([
            thing.contains(points, limits.turned_margin)
            if at - thing.settled_at < limits.turned_for and not thing.active else np.zeros(len(points), np.bool_)
            for thing in things
        ])  # fmt: skip
        inside = np.where(inside.any(axis=0), inside, wide)
        of = np.where(inside.any(axis=0), inside.argmax(axis=0), -1)
        several = np.flatnonzero(inside.sum(axis=0) > 1)
        if len(several):
            unlike = np.full((len(things), len(several)), np.inf)
            for number in np.flatnonzero(inside[:, several].any(axis=1)):
                own = inside[number, several]
                tints = image.colour.reshape(-1, 3)[pixels[several[own]]].astype(np.float64)
                unlike[number, own] = things[number].unlikeness(points[several[own]], tints)
            of[several] = unlike.argmin(axis=0)
        return things, of

    def _edges(self, pixels: NDArray[np.intp], at: float) -> NDArray[np.bool_]:
        """Return a mask of the pixels in strips of one or two pixels beside things, which their edges leave there.

        Edges leave such strips under a camera that moves.
        """
        from scipy.ndimage import binary_dilation, binary_opening

        assert self._reference is not None
        if not self._camera_moves(at):
            return np.zeros(len(pixels), np.bool_)
        mask = np.zeros(self._reference.owner.shape, np.bool_)
        mask.ravel()[pixels] = True
        opened: NDArray[np.bool_] = binary_opening(mask, np.ones((3, 3)))
        beside = binary_dilation(self._reference.owner > TABLE, np.ones((3, 3)), iterations=2)
        found: NDArray[np.bool_] = (~opened & beside).ravel()[pixels]
        return found

    def _segment(self, image: FrameImage, changes: Changes, free: NDArray[np.intp], at: float) -> tuple[str, ...]:
        """Detect objects among the free pixels, which lost things and new ones then have."""
        from scipy.ndimage import binary_dilation

        reference, cloud = self._reference, self._mean()
        assert reference is not None and self._frame is not None and cloud.organised is not None
        mask = np.zeros(image.depth.shape, np.bool_)
        mask.ravel()[free] = True
        shown = mask | ((reference.owner == TABLE) & changes.same)
        stride = self.settings.stride
        everywhere = _enlarged(binary_dilation(shown), stride, cloud.organised).ravel()
        candidates = _enlarged(mask, stride, cloud.organised).ravel()
        points = np.where(everywhere[:, None], cloud.points, np.float32(np.nan))
        plane = Plane(self._frame[2, :3], -float(self._frame[2, 3]))
        found = detect_above(replace(cloud, points=points), plane, self.settings.detection)
        came = []
        taken = np.zeros(len(free), np.bool_)
        of = None
        if found is not None:
            first = stride // 2
            of = found.labels.reshape(cloud.organised)[first::stride, first::stride].ravel()[free]
            sizes = np.bincount(of[of >= 0], minlength=len(found.boxes))
            for k in np.argsort(-sizes, kind="stable").tolist():  # a thing before its pieces
                own = np.flatnonzero(found.labels == k)
                pixels = free[of == k]
                enough = len(pixels) >= self.settings.least_pixels and candidates[own].mean() > 0.5
                if not enough or self._outline.is_crossed_by(image.places(pixels, self._back)):
                    continue
                taken |= of == k
                there = self._filled(found, k)
                if there is not None:
                    reference.give(pixels, there.slot, image)
                    continue
                if self._is_piece(image, pixels):
                    continue
                again = self._recognised(image, changes, pixels, at)
                if again is None:
                    came.append(self._enter(found, cloud, own, k, at))
                    thing = self._things[-1]
                    thing.since = thing.at = float(np.median(reference.since.ravel()[pixels]))
                    thing.revealed = self._is_revealed(thing, pixels)
                    thing.beneath = reference.give(pixels, thing.slot, image)
        self._let_stand(came, image)
        reference.retry_at.ravel()[free[~taken]] = at + RETRY_AFTER
        if self._hand_at < at:  # else a thing that is set down may not be whole yet
            reference.tries.ravel()[free[~taken]] = np.minimum(reference.tries.ravel()[free[~taken]] + 1, MAX_TRIES)
        return tuple(came)

    def _is_revealed(self, thing: Pipeline, pixels: NDArray[np.intp]) -> bool:
        """Return True if a new thing was there before: nothing was known at its pixels, or no hand has been near."""
        assert self._reference is not None
        unknown = float((self._reference.owner.ravel()[pixels] == UNKNOWN_OWNER).mean())
        return unknown > REVEALED or not self._hands.were_near(thing.pose[:3, 3], thing.reach, thing.at - SET_DOWN)

    def _filled(self, found: Detection, k: int) -> Pipeline | None:
        """Return the thing at rest whose box object ``k`` of a detection fills: it is the thing, which was hidden."""
        assert self._frame is not None
        change = self._frame @ np.linalg.inv(found.frame)
        box = found.oriented[k]
        corners = moved(box.corners, change)
        least = FILLED * np.sort(box.extents)[::-1]
        for thing in self._things:
            sides = np.sort(thing.oriented.extents)[::-1]
            fills = (FILLED * sides <= np.sort(box.extents)[::-1]).all() and (least <= sides).all()
            if not thing.active and fills and thing.contains(corners, self.settings.turned_margin).all():
                return thing
        return None

    def _is_piece(self, image: FrameImage, pixels: NDArray[np.intp]) -> bool:
        """Add pixels to the thing of which they show a piece: it came when they did, touches them and has their hue."""
        from scipy.spatial import cKDTree

        assert self._reference is not None
        points, tints = image.places(pixels, self._back), image.colour.reshape(-1, 3)[pixels].astype(np.float64)
        since = float(np.median(self._reference.since.ravel()[pixels]))
        for thing in self._things:
            came = thing.first_rest and not thing.active and thing.since > self._laid_out_at
            if not came or abs(thing.since - since) > TOGETHER or thing.likeness(tints, np.inf).mean() < ALIKE:
                continue
            away = cKDTree(thing.placed_points).query(points)[0]
            if thing.contains(points, self.settings.margin).mean() > 0.9 or away.min() < TOUCHING:
                self._reference.give(pixels, thing.slot, image)
                thing.extend(points, tints.astype(np.float32), self.settings.detection.outlines)
                return True
        return False

    def _recognised(self, image: FrameImage, changes: Changes, pixels: NDArray[np.intp], at: float) -> Pipeline | None:
        """Return the lost thing that pixels show, put there; None if they show a new thing."""
        assert self._reference is not None and self._view is not None
        lost = [thing for thing in self._things if thing.active]
        if not lost:
            return None
        taken = np.ones(image.depth.shape, np.bool_)
        taken.ravel()[pixels] = False
        taken &= changes.same
        best: tuple[Fit, Pipeline] | None = None
        for thing in lost:
            elsewhere = thing.agreement * thing.visible if thing.found else 0.0
            for fit in fits(thing, image, self._view, pixels, taken, self._noise):
                good = fit.agreement > self.settings.fit and fit.visible > 0.3 and fit.explained > 0.7
                if good and fit.score * fit.visible > elsewhere and (best is None or fit.score > best[0].score):
                    best = fit, thing
        if best is None:
            return None
        fit, thing = best
        thing.put(fit.pose)
        thing.moved_to(fit.pose, at, fit.score)
        self._settle(thing)
        thing.beneath = self._reference.give(pixels, thing.slot, image)
        return thing


def _camera_moved(changes: Changes) -> bool:
    """Return True if most of the table is not where it was, although it is not hidden."""
    from deixis.perception.tracking.kernels import COLOUR, FARTHER, SAME

    table = changes.counts[TABLE]
    left = table[FARTHER] + table[COLOUR]
    return bool(left > table[SAME] and left > 0.2 * table.sum())


def _shared(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    """Return the intersection over union of two masks."""
    return float((first & second).sum()) / max(int((first | second).sum()), 1)


def _detected(scene: Scene) -> Detection:
    """Return the detection of a scene with its objects, some of which may have been joined, numbered from 0."""
    found = scene.detection
    assert isinstance(found, Detection)
    number = {int(thing.id[1:]) - 1: place for place, thing in enumerate(scene.objects)}
    places = np.full(max([*number, int(found.labels.max(initial=0))], default=0) + 2, -1, np.int32)
    for old, new in number.items():
        places[old] = new
    oriented = tuple(thing.oriented for thing in scene.objects if thing.oriented is not None)
    return replace(found, labels=places[found.labels], boxes=scene.boxes, oriented=oriented)


def _have_one_hue(tints: NDArray[np.float64], others: NDArray[np.float64]) -> bool:
    """Return True if colours (k, 3) and others (m, 3) are those of one thing, in any light."""
    one, other = np.median(tints, axis=0), np.median(others, axis=0)
    across = one - (one @ other) / max(float(other @ other), 1e-9) * other
    return bool(np.linalg.norm(across) < SAME_HUE)


def _rejoined(found: Detection, joined: list[int], outlines: OutlineSettings) -> Detection:
    """Return a detection in which object k is a part of object ``joined[k]``, numbered from 0 again."""
    left = sorted(set(joined))
    number = np.array([*(left.index(whole) for whole in joined), BACKGROUND], np.int32)
    labels, boxes, oriented = number[found.labels], found.boxes[left].copy(), [found.oriented[k] for k in left]
    for whole in {whole for k, whole in enumerate(joined) if k != whole}:
        k = left.index(whole)
        points = moved(found.cloud.points[labels == k].astype(np.float64), found.frame)
        boxes[k], oriented[k] = upright_box(points, outlines, None), oriented_box(points, outlines, None)
    return replace(found, labels=labels, boxes=boxes, oriented=tuple(oriented))


def _noise(depth: NDArray[np.float32], level: NDArray[np.float32]) -> float:
    """Return the standard deviation of depths at one metre, from those of the table."""
    off = (depth - level) / np.maximum(depth, 0.3) ** 2
    off = off[np.isfinite(off)]
    return max(float(1.4826 * np.median(np.abs(off - np.median(off)))) if len(off) else 0.0, 0.0003)


def _enlarged(mask: NDArray[np.bool_], stride: int, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Return a mask of every ``stride``-th pixel as one of all pixels."""
    large = np.repeat(np.repeat(mask, stride, axis=0), stride, axis=1)
    whole = np.zeros(shape, np.bool_)
    rows, columns = min(shape[0], large.shape[0]), min(shape[1], large.shape[1])
    whole[:rows, :columns] = large[:rows, :columns]
    return whole
