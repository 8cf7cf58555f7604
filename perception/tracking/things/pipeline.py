"""Pipeline of one tracked thing: its model, its pose, and its particle filter, which start and end with it.

The particle filter is that of :mod:`deixis.perception.tracking.things.particles` (KLD sampling; Fox 2003).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.oriented_box import OrientedBox, turned_axes, yaw_of
from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.situation import State, TrackedThing
from deixis.perception.tracking.table.reference import Beneath
from deixis.perception.tracking.things.likeness import SHADE_SPREAD, likeness
from deixis.perception.tracking.things.model import Model, extended, standing
from deixis.perception.tracking.things.particles import Estimate, ParticleFilter
from deixis.perception.tracking.things.revolution import revolution_around
from deixis.perception.tracking.things.sight import Sight, quaternion

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

COLOURS = 8
"""Number of colours of a thing with which changed pixels are compared."""

MIN_POINTS_BEYOND = 5
"""Minimum number of points outside its box at which the box of a thing is extended."""

MIN_BETTER = 0.02
"""Minimum gain of score for which the pose of a thing at rest is corrected."""

MIN_TURNED, HANDLE_SEEN = np.deg2rad(20.0), 0.5
"""Minimum angle in radians between the supposed and the seen direction of a handle at which a thing is turned, and the
share of the points of the handle that agree, and that nothing hides, above which it is seen where it is supposed to be.
"""

MIN_TILT, MAX_TILT, MAX_WORSE = np.deg2rad(2.0), np.deg2rad(25.0), 0.1
"""Range of the angles in radians by which a thing at rest may seem to be tilted, although it lies as before, and by how
much less it may agree with the frame then."""

ON_TABLE = 0.008
"""Largest distance in metres of the lower side of a thing from the table at which it lies on it."""

FAR_SCORE = 0.06
"""Penalty of a place that is ``jump`` or farther from the predicted one. Without it, a place where something may hide
all points can have a better score than the place where some are seen.
"""

MIN_ALIGNED = 0.6
"""Minimum share of the points of a thing that nothing hides, within the image, for its pose at rest to be corrected."""

PLACE_SPREAD, LEAST_LIKENESS = 0.005, 0.02
"""Standard deviation in metres of a measured place of a thing from its nearest known point, and the least likeness of
a colour, beyond which it may be a part of another colour.
"""

SUSPECTED_VIEWS = 3
"""Number of views of which the parts that the thing may have are kept until another view confirms them."""

ENDS_VIEWS = 2
"""Minimum number of views in a row that show an end that earlier views hid."""

NEAR = 0.04
"""Distance in metres within which the middles of a thing and of a part of it are at one place."""

MIN_ON = 0.7
"""Minimum share of the points of a thing inside the box of another one, from above, at which it lies on that one."""

MIN_PLACES = 3
"""Minimum number of places that must agree for a thing to be at rest, also where frames are far apart in time."""

MEMORY_OF_THE_HIDDEN = 30.0
"""Time in seconds in which the certainty of a thing that is not seen drops by half."""


@dataclass(eq=False)
class Pipeline:
    """One tracked thing. Its own frame has its origin in the middle of the box, parallel to the table's.

    Parameters
    ----------
    id
        Name of the thing.
    slot
        Label of its pixels in the reference.
    cloud
        Points in its own frame.
    half
        Half of the sides of its box, shape (3,).
    oriented
        Box that is turned about the vertical, in its own frame.
    pose
        Transform (4, 4) to the table's frame.
    at
        Time in seconds when it was first seen.
    settings
        Options of the tracker.
    """

    id: str
    slot: int
    cloud: PointCloud
    half: NDArray[np.float64]
    oriented: OrientedBox
    pose: NDArray[np.float64]
    at: float
    settings: TrackingSettings

    since: float = field(init=False)
    seen_at: float = field(init=False)
    state: State = field(default="seen", init=False)
    active: bool = field(default=False, init=False)
    """True while it is not at rest."""
    found: bool = field(default=True, init=False)
    """True if the last frame shows it."""
    out_of_view: bool = field(default=False, init=False)
    """True if it left the image above the table, and has not been found since."""
    agreement: float = field(default=1.0, init=False)
    """Share of its visible points that agree with the last frame."""
    visible: float = field(default=1.0, init=False)
    """Share of its points within the image that the last frame in which it moved showed."""
    beneath: Beneath | None = field(default=None, init=False)
    settled_at: float = field(default=-np.inf, init=False)
    """Time in seconds when it last came to rest."""
    there_at: float = field(default=-np.inf, init=False)
    """Time in seconds of the last frame that showed a part of it where it rests."""
    completed: bool = field(default=False, init=False)
    """True if it was completed during its present rest, from the present side of the table."""
    completed_at: float = field(default=-np.inf, init=False)
    """Time in seconds when it was last completed."""
    is_provisional: bool = field(default=False, init=False)
    """True if a hand, which may have hidden parts of it, was in view shortly before it was last completed."""
    cut_off: bool = field(default=False, init=False)
    """True if something may have hidden its continuation when it was last completed."""
    views: int = field(default=0, init=False)
    """Number of views from which it was completed during its present rest."""
    revealed: bool = field(default=False, init=False)
    """True if it came into view where nothing was known, so that it may be a part of a thing that is older."""
    rest: int = field(default=0, init=False)
    """Number of its present or last rest, which no other rest of any thing has."""
    particles: int = field(default=0, init=False)
    """Number of particles in the last frame, 0 if none were needed."""

    def __post_init__(self) -> None:
        self.since = self.seen_at = self.at
        self._choose_points()
        self._filter = ParticleFilter(self.pose, self.settings.particles, self.settings.seed + self.slot)
        self._places: deque[tuple[float, NDArray[np.float64]]] = deque()
        self._carried: list[NDArray[np.float64]] = []
        self._rest = self.pose
        self._velocity = np.zeros(3)
        self._suspected: deque[NDArray[np.float64]] = deque(maxlen=SUSPECTED_VIEWS)
        self._middles = [(self.at, self.pose[:3, 3])]  # of the box, which parts that are added move
        self._carrier: tuple[Pipeline, NDArray[np.float64]] | None = None  # what it lay on, and its pose on it
        # against and along the long axis of the box: True for ends that were seen, the lengths that were hidden beyond
        # them last, and the numbers of the last views in a row that showed them
        self._ends_seen, self._hidden, self._views_of_end = [False, False], [0.0, 0.0], [0, 0]
        self._unseen, self._spread = (
            (0.0, 0.0),
            0.0,
        )  # supposed lengths beyond the two ends of the box, and their spread

    def _choose_points(self) -> None:
        """Choose the points of the thing that are compared with frames."""
        self._tree: cKDTree | None = None
        limits = self.settings.particles
        few = np.linspace(0, len(self.cloud) - 1, min(limits.points, len(self.cloud))).astype(np.int64)
        order = np.random.default_rng(0).permutation(len(self.cloud))
        chosen = np.sort(order[few])
        self._points = self.cloud.points[chosen].astype(np.float64)
        colours = self.cloud.colours
        self._colours = np.zeros_like(self._points) if colours is None else colours[chosen].astype(np.float64)

    @property
    def first_rest(self) -> bool:
        """True if it has not moved since it was first seen."""
        return not self.active and self.settled_at < self.at

    @property
    def last_rest(self) -> NDArray[np.float64]:
        """Pose (4, 4) in which it was last at rest."""
        return self._rest

    @property
    def in_hand(self) -> bool:
        """True if a hand has carried it since it was last seen."""
        return bool(self._carried)

    @property
    def reach(self) -> float:
        """Distance in metres from its middle to its farthest side."""
        return max(self.oriented.extents) / 2

    def carry(self, step: NDArray[np.float64]) -> None:
        """Move the thing with the hand that hides it.

        Parameters
        ----------
        step
            Movement of the hand, shape (3,), in metres.
        """
        self._carried = self._carried or [self.pose[:3, 3]]
        self.pose = self.pose.copy()
        self.pose[:3, 3] += step
        self._carried.append(self.pose[:3, 3])
        self._filter.reset(self.pose)

    def lies_on(self, other: Pipeline) -> bool:
        """Return True if most of the thing lies within the box of a larger one, seen from above.

        Parameters
        ----------
        other
            The thing that may carry it.

        Returns
        -------
        bool
            False for a thing beside the other one.
        """
        points = self.placed_points
        points[:, 2] = other.placed_corners[:, 2].mean()
        return self.reach < other.reach and bool(other.contains(points, 0.0).mean() > MIN_ON)

    @property
    def carrier(self) -> Pipeline | None:
        """Larger thing on which it lay when that one began to move, until it comes to rest."""
        return None if self._carrier is None else self._carrier[0]

    def load_onto(self, carrier: Pipeline) -> None:
        """Note what the thing lies on, with which it moves.

        Parameters
        ----------
        carrier
            The other thing, where it rests.
        """
        self._carrier = carrier, np.linalg.inv(carrier.pose) @ self.pose

    def is_carried_off(self, least: float) -> bool:
        """Return True if what the thing lay on is found elsewhere.

        Parameters
        ----------
        least
            Distance in metres from which a place is another one.

        Returns
        -------
        bool
            False for a thing that lay on the table.
        """
        if self._carrier is None or not self._carrier[0].found:
            return False
        carrier, on_it = self._carrier
        away = (carrier.pose @ on_it)[:3, 3] - self._rest[:3, 3]
        return bool(np.linalg.norm(away) > least)

    def ride(self) -> None:
        """Move the thing with what it lay on."""
        assert self._carrier is not None, "only a thing that is carried off rides"
        carrier, on_it = self._carrier
        self.pose = carrier.pose @ on_it
        self._filter.reset(self.pose)

    @property
    def placed_points(self) -> NDArray[np.float64]:
        """Its points where they are now in the table's frame, shape (n, 3), in metres."""
        points: NDArray[np.float64] = self.cloud.points.astype(np.float64) @ self.pose[:3, :3].T + self.pose[:3, 3]
        return points

    @property
    def placed_corners(self) -> NDArray[np.float64]:
        """Corners of its turned box in the table's frame, shape (8, 3), in metres."""
        corners: NDArray[np.float64] = self.oriented.corners @ self.pose[:3, :3].T + self.pose[:3, 3]
        return corners

    def near_for(self, place: NDArray[np.float64], before: float) -> float:
        """Return for how long the middle of a thing that has not moved has been near a place.

        Parameters
        ----------
        place
            Place of shape (3,) in the table's frame, in metres.
        before
            Time in seconds from which parts that were added do not count.

        Returns
        -------
        float
            Time in seconds; 0 if it was never near.
        """
        times = [min(at, before) for at, _ in self._middles] + [before]
        lengths = zip(self._middles, times, times[1:], strict=False)
        return sum(end - at for (_, middle), at, end in lengths if np.linalg.norm(middle - place) <= NEAR)

    def continue_from(self, before: Pipeline) -> None:
        """Remember since when an earlier pipeline of the thing has known it, and where.

        Parameters
        ----------
        before
            The earlier pipeline, which has ended.
        """
        self.at, self._middles = before.at, before._middles + self._middles

    def take_name(self, parts: Sequence[Pipeline], at: float) -> None:
        """Take the name of one of the parts that were merged into the thing, if it was known longer by that name.

        That is the name of the part whose middle has been near that of the whole for the longest time; if there is
        none, it is the name of the oldest part. The part gets the other name.

        Parameters
        ----------
        parts
            Things that were merged into this one.
        at
            Time in seconds when they were merged.
        """
        place = self.pose[:3, 3]
        known = min([self, *parts], key=lambda part: (-part.near_for(place, at), part.at))
        self.id, known.id = known.id, self.id
        self.at, self.since = known.at, min(self.since, known.since)

    def is_leaving(self, view: TableView, seconds: float) -> bool:
        """Return True if the thing is not wholly within the image where its movement leads it.

        Parameters
        ----------
        view
            View of the table.
        seconds
            Time since the last frame.

        Returns
        -------
        bool
            True also for a thing that the image had shown in part.
        """
        ahead = self._velocity * seconds
        corners = self.placed_corners + ahead
        return len(view.pixels(corners)[0]) < len(corners)

    def way_from_expected(self, place: NDArray[np.float64], seconds: float) -> float:
        """Return how far a place is from where the thing is expected.

        That is where its velocity leads it, or any place where the hand that carried it may have set it down.

        Parameters
        ----------
        place
            Place of shape (3,) in the table's frame, in metres.
        seconds
            Time since the last frame.

        Returns
        -------
        float
            Distance in metres.
        """
        expected = self._carried or [self.pose[:3, 3] + self._velocity * seconds]
        return float(np.linalg.norm(np.array(expected) - place, axis=1).min())

    def contains(
        self, points: NDArray[np.float64], margin: float, pose: NDArray[np.float64] | None = None
    ) -> NDArray[np.bool_]:
        """Return True for each point that is within the thing's box.

        Parameters
        ----------
        points
            Points of shape (n, 3) in the table's frame, in metres.
        margin
            Distance in metres by which the box is extended on all sides.
        pose
            Pose of the thing; by default the present one.

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        at = self.pose if pose is None else pose
        own = (points - at[:3, 3]) @ at[:3, :3] - np.array(self.oriented.centre)
        sides = np.abs(own @ turned_axes(self.oriented.yaw).T)
        return np.asarray((sides <= np.array(self.oriented.extents) / 2 + margin).all(axis=1))

    def follow(
        self,
        image: FrameImage,
        view: TableView,
        taken: NDArray[np.bool_],
        changed: NDArray[np.float64],
        tints: NDArray[np.float64],
        seconds: float,
        noise: float,
    ) -> tuple[Estimate, float, float]:
        """Look for the thing in a frame.

        Parameters
        ----------
        image
            The frame.
        view
            Its view of the table.
        taken
            Mask (r, c) of the pixels that belong to something else.
        changed
            Points (k, 3) in the table's frame that may be the thing's.
        tints
            Their colours.
        seconds
            Time since the last frame.
        noise
            Standard deviation of depths at one metre.

        Returns
        -------
        tuple
            The estimate; the mean agreement of the points that are not hidden; and the share of points that are seen,
            of those within the image.
        """
        sight = Sight(self._points, self._colours, image, view, taken, noise)

        def weigh(places: NDArray[np.float64], turns: NDArray[np.float64]) -> NDArray[np.float64]:
            found, _ = sight.scores(places, turns)
            away = np.linalg.norm(places - ahead, axis=1)
            found -= FAR_SCORE * np.minimum(away / self.settings.jump, 1.0)
            return found

        ahead = self._filter.expected(seconds)
        drawn = np.cumsum(self.likeness(tints))
        likely = len(drawn) > 0 and drawn[-1] > 0

        def guide(turns: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
            own = rng.integers(len(self._points), size=len(turns))
            tries = np.searchsorted(drawn, rng.random((len(turns), 6)) * drawn[-1], side="right")
            tries = np.minimum(tries, len(drawn) - 1)
            alike = ((tints[tries] - self._colours[own, None]) ** 2).sum(axis=2)
            at = changed[tries[np.arange(len(turns)), alike.argmin(axis=1)]]
            places: NDArray[np.float64] = at - _rotated(turns, self._points[own])
            return places

        self._velocity = self._filter.velocity.copy()
        found = self._filter.step(weigh, guide if likely else None, seconds, lost=not self.found)
        self.particles = found.particles
        agreement = sight.agreement(found.place, found.turn)
        return found, agreement.fit, agreement.visible

    def align(
        self,
        image: FrameImage,
        view: TableView,
        taken: NDArray[np.bool_],
        own: NDArray[np.float64],
        noise: float,
    ) -> None:
        """Correct the pose of the thing at rest, so that its box covers the points that show it.

        While a thing moves, a place that shows more of its points is better than one that hides them, and the points
        of one part of a thing of one colour agree as well with another part. A pose therefore slides away from a hand,
        or from the border of the image, that hides an edge; and a mug turns away from its handle while the hand hides
        it. At rest, only the points that nothing hides count, all that shows the thing must be within its box, its
        handle is where it is seen, and it lies as it did first. It moves along the table and turns about the vertical.
        A rectangular thing agrees almost as well after a turn by a right angle: this is tried if points lie outside.

        Parameters
        ----------
        image, view
            The frame, and its view of the table.
        taken
            Mask (r, c) of the pixels that belong to something else.
        own
            Points (k, 3) that show the thing, in the table's frame.
        noise
            Standard deviation of depths at one metre.
        """
        sight = Sight(self._points, self._colours, image, view, taken, noise)
        self._lay_flat(sight, own)
        if sight.agreement(self.pose[:3, 3], quaternion(self.pose)).exposed >= MIN_ALIGNED:
            few = self._few(own)
            pose, gain = sight.shifted(self.pose, self.oriented, few)
            if (~self.contains(few, 0.0, pose)).sum() >= MIN_POINTS_BEYOND:
                turned, more = sight.shifted(self.pose, self.oriented, few, np.pi / 2)
                pose, gain = (turned, more) if more > gain + MIN_BETTER else (pose, gain)
            if gain > MIN_BETTER:
                self.pose = pose
        self._turn_to_handle(image, view, taken, own, noise)
        if self.pose is not self._rest:
            self._rest = self.pose
            self._filter.reset(self.pose)

    def _lay_flat(self, sight: Sight, own: NDArray[np.float64]) -> None:
        """Let the thing lie as it did when it was first seen, if it is tilted a little and agrees as well without that.

        The particle filter tilts a thing of which a hand or another thing hides a part.
        """
        turn = self.pose[:3, :3]
        if not MIN_TILT < np.arccos(np.clip(turn[2, 2], -1.0, 1.0)) < MAX_TILT:
            return
        flat = self.pose.copy()
        flat[:3, :3] = turned_axes(yaw_of(turn)).T
        if abs(flat[2, 3] - self.half[2]) < ON_TABLE:
            flat[2, 3] = self.half[2]
        flat, _ = sight.shifted(flat, self.oriented, self._few(own))
        tilted, laid = (sight.agreement(pose[:3, 3], quaternion(pose)) for pose in (self.pose, flat))
        if laid.fit > tilted.fit - MAX_WORSE and laid.visible > tilted.visible - MAX_WORSE:
            self.pose = flat

    def _turn_to_handle(
        self,
        image: FrameImage,
        view: TableView,
        taken: NDArray[np.bool_],
        own: NDArray[np.float64],
        noise: float,
    ) -> None:
        """Turn a round thing so that its handle has the direction that points (k, 3) show.

        All directions of the body agree with the frame, also those in which another side of it is seen than before. The
        thing stays as it is if the handle is seen where it is supposed to be.
        """
        points = self.placed_points
        known = revolution_around(points)
        supposed = None if known is None else known.handle(points)
        if known is None or supposed is None:
            return
        seen = known.moved_to(own)
        direction = seen.handle(own)
        if direction is None or np.cos(direction - supposed) > np.cos(MIN_TURNED):
            return
        handle, tints = known.is_handle(points), self.cloud.colours
        colours = np.zeros((int(handle.sum()), 3)) if tints is None else tints[handle].astype(np.float64)
        there = Sight(self.cloud.points[handle].astype(np.float64), colours, image, view, taken, noise)
        agreement = there.agreement(self.pose[:3, 3], quaternion(self.pose))
        if agreement.fit > HANDLE_SEEN and agreement.exposed > HANDLE_SEEN:
            return
        turn = turned_axes(direction - supposed).T
        self.pose = self.pose.copy()
        self.pose[:3, :3] = turn @ self.pose[:3, :3]
        self.pose[:2, 3] = turn[:2, :2] @ (self.pose[:2, 3] - known.centre) + seen.centre

    def laid(
        self,
        start: NDArray[np.float64],
        image: FrameImage,
        view: TableView,
        taken: NDArray[np.bool_],
        own: NDArray[np.float64],
        noise: float,
    ) -> tuple[NDArray[np.float64], float, float]:
        """Return the best pose of the thing around another one, from which it moves along the table and turns about z.

        Parameters
        ----------
        start
            Pose (4, 4) in which it lies on the table.
        image, view, taken, own, noise
            As in :meth:`align`.

        Returns
        -------
        tuple
            The pose, the share of the points that agree, of those that nothing hides, and the share that agrees, of
            those within the image.
        """
        sight = Sight(self._points, self._colours, image, view, taken, noise)
        pose, _ = sight.shifted(start, self.oriented, self._few(own))
        agreement = sight.agreement(pose[:3, 3], quaternion(pose))
        return pose, agreement.fit, agreement.visible

    def _few(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return at most as many of some points as are compared of the thing."""
        few = min(len(points), self.settings.particles.points)
        return points[np.linspace(0, len(points) - 1, few).astype(np.int64)]

    def likeness(self, tints: NDArray[np.float64], shade: float = SHADE_SPREAD) -> NDArray[np.float64]:
        """Return how well colours agree with those of the thing.

        Parameters
        ----------
        tints
            Colours of shape (k, 3).
        shade
            Standard deviation of the lengths of the colours, which change with the light.

        Returns
        -------
        ndarray
            Likeness in [0, 1] to the nearest of a few colours of the thing, shape (k,).
        """
        return likeness(tints, self._colours[:: max(1, len(self._colours) // COLOURS)], shade)

    @property
    def is_suspected(self) -> bool:
        """True if the last view showed parts that the thing may have, and that no other view has confirmed."""
        return len(self._suspected) > 0 and len(self._suspected[-1]) > 0

    def confirms(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Compare what one view shows of the thing with what the last views showed, and keep the rest for the next.

        Parameters
        ----------
        points
            Points of shape (k, 3) in the table's frame that may be parts of the thing, in metres.

        Returns
        -------
        ndarray
            Mask of shape (k,): True for points that an earlier view showed, too.
        """
        from scipy.spatial import cKDTree

        twice = np.zeros(len(points), np.bool_)
        before = np.concatenate([np.zeros((0, 3)), *self._suspected])
        if len(points) and len(before):
            twice = cKDTree(before).query(points)[0] < PLACE_SPREAD
        self._suspected.append(points[~twice])
        return twice

    def distances(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how far measured points are from the thing's nearest own points.

        Parameters
        ----------
        points
            Points of shape (k, 3) in the table's frame, in metres.

        Returns
        -------
        ndarray
            Distances of shape (k,) in metres.
        """
        from scipy.spatial import cKDTree

        tree = self._tree = self._tree or cKDTree(self.cloud.points)
        away: NDArray[np.float64] = tree.query((points - self.pose[:3, 3]) @ self.pose[:3, :3])[0]
        return away

    def unlikeness(self, points: NDArray[np.float64], tints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how badly measured points agree with the thing's own points, by place and by colour.

        Parameters
        ----------
        points
            Points of shape (k, 3) in the table's frame, in metres.
        tints
            Their colours, shape (k, 3).

        Returns
        -------
        ndarray
            Negative logarithms of the likelihood of shape (k,), 0 for a point at a place and of a colour of the thing.
        """
        away = self.distances(points)
        least: NDArray[np.float64] = 0.5 * (away / PLACE_SPREAD) ** 2
        return least - np.log(np.maximum(self.likeness(tints), LEAST_LIKENESS))

    def seen_at_place(
        self,
        image: FrameImage,
        view: TableView,
        taken: NDArray[np.bool_],
        noise: float,
        pose: NDArray[np.float64] | None = None,
    ) -> tuple[float, float]:
        """Compare a frame with the thing in a pose.

        Parameters
        ----------
        image, view
            The frame, and its view of the table.
        taken
            Mask (r, c) of the pixels that belong to something else.
        noise
            Standard deviation of depths at one metre.
        pose
            The pose; by default the present one.

        Returns
        -------
        tuple
            Share of the points that agree, of those that nothing hides; and the share of points that nothing hides.
        """
        at = self.pose if pose is None else pose
        sight = Sight(self._points, self._colours, image, view, taken, noise)
        agreement = sight.agreement(at[:3, 3], quaternion(at))
        return agreement.fit, agreement.exposed

    @property
    def model(self) -> Model:
        """Points, boxes and pose as they are known now."""
        return Model(self.cloud, self.half, self.oriented, self.pose)

    def extend(self, points: NDArray[np.float64], colours: NDArray[np.float32], settings: OutlineSettings) -> None:
        """Add points that belong to the thing, and extend its box and move its origin where they lie outside.

        Parameters
        ----------
        points
            Points of shape (n, 3) in the table's frame, in metres.
        colours
            Their colours, shape (n, 3).
        settings
            Share of outermost points that are noise.
        """
        if (~self.contains(points, 0.0)).sum() < MIN_POINTS_BEYOND:
            return
        ends = self._supposed_ends()
        self._take(extended(self.model, points, colours, settings))
        self._ends_seen, self._hidden, self._views_of_end = [False, False], [0.0, 0.0], [0, 0]
        if any(self._unseen):  # they end where they were supposed to end
            along, (first, last) = self._along_in_table(), self._supposed_ends(seen=True)
            before, after = np.sort(ends @ along)
            self._unseen = max(float(first @ along - before), 0.0), max(float(after - last @ along), 0.0)
            self._spread = self._spread if any(self._unseen) else 0.0
        self._middles.append((self.seen_at, self.report(self.seen_at).centre))

    def stand(self) -> None:
        """Extend the box of the thing down to the table, on which it stands with a hidden foot."""
        self._take(standing(self.model))
        self._middles.append((self.seen_at, self.pose[:3, 3]))

    def _take(self, model: Model) -> None:
        """Take other points, boxes and a pose at the present rest."""
        self.cloud, self.half, self.oriented = model.cloud, model.half, model.oriented
        self.pose = self._rest = model.pose
        self._choose_points()
        self._filter.reset(self.pose)

    def unseen_ends(self, hidden: tuple[float, float]) -> tuple[float, float]:
        """Return how far the thing may go on unseen, where no view has shown its end since its box was extended.

        An end that earlier views hid must be shown by several views in a row, since the edge of what hides it is noisy.

        Parameters
        ----------
        hidden
            Lengths in metres that the present view hides beyond its two ends; 0 where it shows the end.

        Returns
        -------
        tuple
            Lengths in metres.
        """
        for end, length in enumerate(hidden):
            self._views_of_end[end] = 0 if length else self._views_of_end[end] + 1
            if length or self._views_of_end[end] >= (ENDS_VIEWS if self._hidden[end] else 1):
                self._hidden[end] = length
                self._ends_seen[end] |= not length
        first, last = (0.0 if seen else length for seen, length in zip(self._ends_seen, self._hidden, strict=True))
        return first, last

    def suppose(self, ends: tuple[float, float], length: float, spread: float) -> None:
        """Suppose that the thing goes on where something hides its ends, until more of it is seen.

        Parameters
        ----------
        ends
            Lengths in metres that may be hidden beyond the end against the long axis of the box and the one along it.
        length, spread
            Likely length of the whole thing and its standard deviation, in metres.
        """
        share = max(length - self.oriented.extents[0], 0.0) / max(sum(ends), 1e-9)
        self._unseen, self._spread = (share * ends[0], share * ends[1]), spread
        self._middles.append((self.seen_at, self.report(self.seen_at).centre))

    def _along_in_table(self) -> NDArray[np.float64]:
        """Return the direction (3,) of the long axis of the box in the table's frame."""
        along: NDArray[np.float64] = self.pose[:3, :3] @ turned_axes(self.oriented.yaw)[0]
        return along

    def _supposed_ends(self, seen: bool = False) -> NDArray[np.float64]:
        """Return the middles (2, 3) of the ends of the thing, or of what is seen of it, in the table's frame."""
        middle = self.pose[:3, :3] @ np.array(self.oriented.centre) + self.pose[:3, 3]
        unseen = np.zeros(2) if seen else np.array(self._unseen)
        reach = np.array([-1, 1]) * (self.oriented.extents[0] / 2 + unseen)
        ends: NDArray[np.float64] = middle + reach[:, None] * self._along_in_table()
        return ends

    def moved_to(self, pose: NDArray[np.float64], at: float, agreement: float) -> None:
        """Take a pose that was found in a frame.

        Parameters
        ----------
        pose
            Transform (4, 4) to the table's frame.
        at
            Time of the frame in seconds.
        agreement
            Share of its visible points that agree with the frame.
        """
        self.pose, self.seen_at, self.state, self.found, self.out_of_view = pose, at, "seen", True, False
        self.agreement = agreement
        self._carried = []
        self._places.append((at, pose[:3, 3].copy()))
        while len(self._places) > MIN_PLACES and self._places[0][0] < at - self.settings.still_for - 1e-6:
            self._places.popleft()

    def lost(self, state: State = "hidden") -> None:
        """Note that a frame does not show the thing; its last pose stays.

        Parameters
        ----------
        state
            State from now on: hidden or gone.
        """
        self.state, self.found = state, False
        self._places.clear()
        self._filter.reset(self.pose)
        self._velocity = np.zeros(3)

    def seen_at_rest(self, at: float, agreement: float) -> None:
        """Note that a frame shows the thing at its place.

        Parameters
        ----------
        at
            Time of the frame in seconds.
        agreement
            Share of its visible pixels that agree with the reference.
        """
        self.state, self.seen_at, self.found, self.agreement = "seen", at, True, agreement
        self.there_at, self._carried = at, []

    def is_still(self, at: float) -> bool:
        """Return True if the thing has not moved for a while.

        Parameters
        ----------
        at
            Time in seconds.

        Returns
        -------
        bool
            False as long as it has not been followed long enough.
        """
        if len(self._places) < MIN_PLACES or at - self._places[0][0] < 0.7 * self.settings.still_for:
            return False
        places = np.array([place for _, place in self._places])
        return bool(np.ptp(places, axis=0).max() < 2 * self.settings.still)

    def settle(self) -> None:
        """Come to rest at the mean of the last places; keep the time of its arrival if it did not move."""
        pose = self.pose.copy()
        pose[:3, 3] = np.mean([place for _, place in self._places], axis=0)
        if np.linalg.norm(pose[:3, 3] - self._rest[:3, 3]) > 2.5 * self.settings.still:
            self.since = self._places[0][0]
        self.pose, self.active, self._rest = pose, False, pose
        self.completed, self.views, self._carrier = False, 0, None
        self._suspected.clear()
        self.settled_at = self._places[-1][0]
        self._places.clear()
        self._filter.reset(pose)

    def put(self, pose: NDArray[np.float64]) -> None:
        """Begin to look for the thing around another pose.

        Parameters
        ----------
        pose
            Transform (4, 4) to the table's frame.
        """
        self._filter.reset(pose)
        self._places.clear()

    def rest_again(self) -> None:
        """Stop looking for the thing elsewhere: it is at its place."""
        self.pose = self._rest
        self._filter.reset(self._rest)
        self._places.clear()

    def report(self, at: float) -> TrackedThing:
        """Return the thing as it is after a frame.

        Parameters
        ----------
        at
            Time of the frame in seconds.

        Returns
        -------
        TrackedThing
            Boxes, cloud and pose in the table's frame.
        """
        turn = self.pose[:3, :3]
        yaw = yaw_of(turn)
        along, (before, after) = turned_axes(self.oriented.yaw)[0], self._unseen
        shift, more = (after - before) / 2 * along, before + after
        length, width, height = self.oriented.extents
        whole = OrientedBox(  # with what is supposed
            tuple((np.array(self.oriented.centre) + shift).tolist()), self.oriented.yaw, (length + more, width, height)
        )
        pose = self.pose.copy()
        pose[:3, 3] += turn @ shift
        middle = turn @ np.array(whole.centre) + self.pose[:3, 3]
        oriented = OrientedBox(tuple(middle.tolist()), whole.yaw + yaw, whole.extents)
        if np.trace(turn) > 1 + 2 * np.cos(np.deg2rad(3.0)):
            half = self.half + np.abs(along) * more / 2
            box = np.stack([pose[:3, 3] - half, pose[:3, 3] + half])
        else:
            corners = whole.corners @ turn.T + self.pose[:3, 3]
            box = np.stack([corners.min(axis=0), corners.max(axis=0)])
        points = self.cloud.points @ turn.T.astype(np.float32) + self.pose[:3, 3].astype(np.float32)
        faded = 0.5 ** (max(at - self.seen_at, 0.0) / MEMORY_OF_THE_HIDDEN)
        return TrackedThing(
            id=self.id,
            box=box,
            oriented=oriented,
            cloud=PointCloud(points, self.cloud.colours),
            pose=pose,
            certainty=float(np.clip(self.agreement * faded, 0.01, 1.0)),
            since=at if self.active and self.found else self.since,
            first_seen=self.at,
            seen_at=self.seen_at,
            state=self.state,
            moving=self.active and self.found,
            spread=self._spread / 2,
        )


def _rotated(turns: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points (n, 3) rotated by unit quaternions (n, 4), real part first."""
    axis = turns[:, 1:]
    across = 2 * np.cross(axis, points)
    result: NDArray[np.float64] = points + turns[:, :1] * across + np.cross(axis, across)
    return result
