"""Find the parts of a thing at rest that its model lacks.

The noise of one frame, or a thing that stood before it, cut them off, or they were on its other side.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import oriented_box
from deixis.perception.oriented_box import turned_axes
from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.table.reference import TABLE, UNKNOWN_OWNER, Reference
from deixis.perception.tracking.things.likeness import likeness
from deixis.perception.tracking.things.pipeline import Pipeline
from deixis.perception.tracking.things.rectangle import is_rectangular

FLAT = 0.04
"""Height in metres below which a thing may have parts that are lost in the noise of the table; a spoon is 0.03 high."""

MARGIN = 40
"""Distance in pixels from a thing within which its missing parts are looked for."""

MIN_TABLE_PIXELS = 50
"""Minimum number of pixels of the table around a thing, for its missing parts to be looked for."""

REMAINING_NOISE = 0.45
"""Standard deviation of the reference after ten frames, as a share of that of one frame."""

MIN_HEIGHT, MIN_MEAN_HEIGHT = 0.0015, 0.0005
"""Minimum heights in metres above the table: of a pixel of a missing part without its colour, and of the whole part."""

MIN_PART, MIN_APART = 12, 4
"""Minimum numbers of pixels of a part: all, and those that do not touch what is known about the thing."""

MAX_CARRIED_VIEWS = 3
"""Minimum number of views at which the missing parts of a thing that lies on another one are looked for."""

MIN_FAR_PART = 3
"""Minimum number of pixels of a part on the other side of something that stands before the thing."""

MIN_LIKENESS = 0.05
"""Minimum likeness of the colour of a pixel to those of the thing, for it to be a part."""

MIN_SLENDERNESS = 2.0
"""Minimum ratio of the length to the width of a thing that is continued behind others."""

MIN_JOINT_SLENDERNESS = 3.0
"""Minimum ratio of the length to the width of two short ends together, between which something hides the middle."""

BESIDE, SLICE = 0.02, 0.006
"""Width in metres of the strips beside the line of a thing on a plate that show the plate, and the length of the slices
in which they are compared with what is in the line."""

UNLIKE_BESIDE, MIN_BESIDE = 30.0, 4
"""Minimum distance in RGB of a pixel in the line from the plate beside it, and the minimum number of pixels beside
it."""

STRIP_MARGIN = 0.006
"""Distance in metres by which the continuation of a thing may be wider than the thing, on either side."""

MIN_IN_LINE = 0.6
"""Minimum share of the pixels of a piece that lie in the line of a thing and have its colour."""

MIN_INCLUDED = 0.9
"""Minimum share of the points of a piece within the box of its thing."""

GRID, MIN_FILLED = 30, 0.95
"""Number of places along each side of a rectangle at which it is looked for, and the minimum share of them that show it
or are hidden."""

NEAREST = np.float32(1e-6)
"""Depth in metres of a surface that is before all places."""

MAX_LENGTH = 0.28
"""Largest length in metres of a thing and a piece of it together."""

MIN_BEFORE = 0.01
"""Distance in metres by which a surface must be nearer than a place that it hides."""

BEYOND = 0.005
"""Distance in metres from the box of a thing beyond which a point shows a part of it that was not seen before."""

Mask = NDArray[np.bool_]

AROUND = np.ones((3, 3), np.bool_)
"""Neighbourhood of a pixel."""


def revealed_part(
    thing: Pipeline, others: Iterable[Pipeline], reference: Reference, view: TableView
) -> NDArray[np.intp]:
    """Return the pixels of a thing at rest that show what its model lacks, such as the handle of a turned mug.

    Pixels that agree better with another thing whose box contains them show that thing: the rim of a plate that comes
    into view behind what lies on it.

    Parameters
    ----------
    thing
        The thing.
    others
        The other things at rest.
    reference
        The table at rest.
    view
        View of the table in which the reference is.

    Returns
    -------
    ndarray
        Flat indices of shape (k,), empty if all that is seen is within its box.
    """
    own = np.flatnonzero(reference.owner == thing.slot)
    points = reference.points(own, view)
    beyond = ~thing.contains(points, BEYOND)
    own, points = own[beyond], points[beyond]
    if len(own) < MIN_PART:
        return own[:0]
    tints = reference.colour.reshape(-1, 3)[own].astype(np.float64)
    unlike, of_others = thing.unlikeness(points, tints), np.zeros(len(own), np.bool_)
    for other in others:
        held = np.flatnonzero(other.contains(points, thing.settings.margin))
        if len(held):
            of_others[held] |= other.unlikeness(points[held], tints[held]) < unlike[held]
    new = own[~of_others]
    return new if len(new) >= MIN_PART else new[:0]


def joint_length(one: Pipeline, other: Pipeline) -> float:
    """Return the length of the thing of which two things at rest are the ends, in metres.

    Parameters
    ----------
    one, other
        Things at rest.

    Returns
    -------
    float
        Distance of the outer ends.
    """
    middles = [np.array(each.oriented.centre) + each.pose[:3, 3] for each in (one, other)]
    ends = (one.oriented.extents[0] + other.oriented.extents[0]) / 2
    return float(np.linalg.norm(middles[0] - middles[1])) + ends


class FlatThing:
    """Flat thing at rest, with the table, or the thing that it lies on, and the other things around it.

    Parameters
    ----------
    thing
        The thing.
    reference
        The table at rest: a mean over many frames.
    view
        View of the table in which the reference is.
    eye
        Height of the camera above the table in metres.
    noise
        Standard deviation of the depths of one frame at one metre.
    colour
        Distance of two colours in RGB from which they differ.
    image
        The frame.
    changed
        Mask (r, c) of the pixels at which the frame has shown something else than the reference for a while. Those
        without an owner may show parts of the thing that came into view; the others may show something new.
    views
        Number of views from which the thing has been completed during its present rest. In the first one, all changed
        pixels of the table may show something new; in later ones, they may show parts of the thing.
    """

    def __init__(
        self,
        thing: Pipeline,
        reference: Reference,
        view: TableView,
        eye: float,
        noise: float,
        colour: float,
        image: FrameImage,
        changed: Mask,
        views: int,
    ) -> None:
        from scipy.ndimage import binary_dilation

        self._thing, self._reference, self._shape, self._views = thing, reference, reference.owner.shape, views
        own = reference.owner == thing.slot
        rows, columns = (np.flatnonzero(own.any(axis=axis)) for axis in (1, 0))
        self.is_seen = thing.oriented.extents[2] < FLAT and len(rows) > 0
        """False for a thing that is high, or of which no pixel is known: nothing is found around it."""
        self.is_carried = False
        """True if it lies on another thing."""
        if not self.is_seen:
            return
        self._corner = max(int(rows[0]) - MARGIN, 0), max(int(columns[0]) - MARGIN, 0)
        self._window = np.s_[
            self._corner[0] : int(rows[-1]) + MARGIN + 1, self._corner[1] : int(columns[-1]) + MARGIN + 1
        ]
        self._seed, self._owner = own[self._window], reference.owner[self._window]
        depth, level = reference.depth[self._window], view.level[self._window]
        shade = reference.colour[self._window].astype(np.float64)
        around = binary_dilation(self._seed, AROUND, iterations=3) & ~self._seed
        owners, counts = np.unique(self._owner[around & (self._owner != UNKNOWN_OWNER)], return_counts=True)
        carrier = int(owners[counts.argmax()]) if len(owners) else TABLE
        self.is_carried = carrier != TABLE
        unsure = (self._owner == UNKNOWN_OWNER) | ((self._owner == TABLE) & self.is_seen_again)
        fresh = changed[self._window] & unsure & (carrier == TABLE)
        self._strange = fresh & (self._owner == TABLE)  # in its line, it may be the edge of another thing
        depth = np.where(fresh, image.depth[self._window], depth)
        shade = np.where(fresh[..., None], image.colour[self._window], shade)
        table = ((self._owner == carrier) | fresh) & (depth > 0) & np.isfinite(level)
        bare = table & ~fresh & ~binary_dilation(self._seed, iterations=3)
        if bare.sum() < MIN_TABLE_PIXELS:
            self.is_seen = False
            return
        with np.errstate(invalid="ignore", divide="ignore"):
            self._height = np.where(table, eye * (1 - depth / level), 0.0)
            share = np.where(fresh, 1.0, REMAINING_NOISE)
            self._noise = np.where(table, share * noise * depth**2 * eye / level, 0.0)
        ground = np.median(shade[bare], axis=0)
        tinted = np.linalg.norm(shade - ground, axis=-1) > colour
        every = shade.reshape(-1, 3)
        like = thing.likeness(every)
        alike = (like > MIN_LIKENESS) & (like > likeness(every, ground[None]))
        self._alike = tinted & alike.reshape(tinted.shape)
        self._others = ~np.isin(self._owner, (TABLE, carrier, UNKNOWN_OWNER)) & ~self._seed
        self._view, self._eye, self._level = view, eye, level
        self._before = (self._others & (depth < level)) | ((self._owner == UNKNOWN_OWNER) & ~fresh)
        self._line = self._own_line()
        self._hiding = self._line & self._before
        if self.is_carried:
            self._alike = self._candidate = table & self._carried_ends(table, depth, shade, like.reshape(tinted.shape))
        else:
            high = self._height > np.maximum(4 * self._noise, MIN_HEIGHT)
            low = self._height < thing.placed_corners[:, 2].max() + BEYOND
            self._candidate = table & (high | tinted) & (self._height > -4 * self._noise) & low

    @property
    def is_seen_again(self) -> bool:
        """True if the thing lies on the table and has been completed before, from another view."""
        return not self.is_carried and self._views > 0

    @property
    def is_cut_off(self) -> bool:
        """True if something may hide the continuation of the thing, so that another view may show its other end."""
        from scipy.ndimage import binary_dilation

        return self.is_seen and bool((binary_dilation(self._seed, AROUND, iterations=2) & self._hiding).any())

    def missing_part(self) -> NDArray[np.intp]:
        """Return the pixels of the table, or of what the thing lies on, that are parts of the thing.

        Pixels that are higher than the rest of the noise, or of another colour than the table, are the thing's if they
        are connected with it and are, as a whole, higher than the table or of the thing's colour. Those of a plate that
        a thing lies on must have the thing's colour and lie in its line. A long thing continues behind things that
        stand before it: pixels of its colour on their other side are its own if they lie in its line.

        Returns
        -------
        ndarray
            Flat indices of shape (k,), empty if nothing is missing.
        """
        whole = np.zeros(self._shape, np.bool_)
        if self.is_seen and not (self.is_carried and self._views >= MAX_CARRIED_VIEWS):
            near = self._near_part()
            whole[self._window] = near | self._far_part(self._seed | near)
        return np.flatnonzero(whole)

    def _near_part(self) -> Mask:
        from scipy.ndimage import binary_dilation, binary_propagation

        seed = self._seed
        known = seed | self._candidate
        if self.is_seen_again:  # the reference of a camera that moves has gaps
            known = binary_dilation(known, AROUND)
        part: Mask = binary_propagation(seed, AROUND, known) & self._candidate & ~seed
        count = int(part.sum())
        fits = MIN_PART <= count <= max(2 * int(seed.sum()), 4 * MIN_PART)
        if not fits or (self._others & binary_dilation(part, iterations=2)).any():
            return np.zeros_like(seed)
        least = max(MIN_MEAN_HEIGHT, 3 * float(self._noise[part].mean()) / np.sqrt(count))
        apart = part & ~binary_dilation(seed, AROUND)
        is_alike = apart.sum() >= MIN_APART and self._alike[apart].mean() > 0.5
        is_high = not self.is_carried and not self.is_seen_again and self._height[part].mean() >= least
        return part if is_high or is_alike else np.zeros_like(seed)

    def _far_part(self, known: Mask) -> Mask:
        from scipy.ndimage import binary_dilation, binary_propagation

        hiders = np.unique(self._owner[binary_dilation(known, AROUND, iterations=2) & self._hiding])
        edges = binary_dilation(self._others & ~np.isin(self._owner, hiders), AROUND, iterations=3)
        beyond = self._line & self._candidate & self._alike & ~(self._strange & edges)
        far: Mask = binary_propagation(known, AROUND, known | self._hiding | beyond) & beyond
        far &= ~binary_dilation(known, AROUND, iterations=2)
        return far if far.sum() >= MIN_FAR_PART else np.zeros_like(known)

    def pieces(self, things: Iterable[Pipeline]) -> list[Pipeline]:
        """Return the things that are pieces of this one: the first look missed what lies between, or something hid it.

        Parameters
        ----------
        things
            Things at rest.

        Returns
        -------
        list of Pipeline
            Shorter flat things of its colour that have not moved since they came, and that lie in its line or complete
            it as a rectangle. They came with it and are smaller or lie within its box, or one of the two came into view
            without being set down.
        """
        if not self.is_seen:
            return []
        found = []
        for thing in things:
            own = self._owner == thing.slot
            revealed = thing.revealed or self._thing.revealed
            together = (thing.at == self._thing.at or revealed) and thing.first_rest and self._thing.first_rest
            shorter = thing.oriented.extents[0] < self._thing.oriented.extents[0]
            # of a thing that was hidden, any part may be hidden now
            smaller = revealed or own.sum() <= self._seed.sum() or self._includes(thing)
            fits = together and shorter and own.any() and smaller and thing.oriented.extents[2] < FLAT
            if fits and self._is_rectangle_with(thing, own):
                found.append(thing)
                continue
            if not fits or not any(self._leads_to(own, line) for line in (self._line, self._line_to(thing))):
                continue
            if joint_length(thing, self._thing) <= MAX_LENGTH:
                found.append(thing)
        return found

    def _includes(self, piece: Pipeline) -> bool:
        """Return True if most points of a piece lie within the box of the thing."""
        points = piece.placed_points
        return bool(self._thing.contains(points, self._thing.settings.margin).mean() > MIN_INCLUDED)

    def _is_rectangle_with(self, piece: Pipeline, own: Mask) -> bool:
        """Return True if a thing and a piece of its colour show a rectangle of which something hides all the rest."""
        if self._alike[own].mean() < MIN_IN_LINE:
            return False
        points = np.concatenate([self._thing.placed_points, piece.placed_points])
        box = oriented_box(points, self._thing.settings.detection.outlines)
        if not is_rectangular(points, box):
            return False
        sides = np.array(box.extents[:2]) - 2 * BEYOND
        steps = [np.linspace(-side / 2, side / 2, GRID) for side in sides]
        grid = np.stack([*(axis.ravel() for axis in np.meshgrid(*steps)), np.zeros(GRID**2)], axis=1)
        places = np.array(box.centre) + grid @ turned_axes(box.yaw)
        of_pair = np.isin(self._reference.owner, (self._thing.slot, piece.slot))
        before = np.where(of_pair, NEAREST, self._reference.depth)
        return bool(self._view.hides(places, before, MIN_BEFORE).mean() > MIN_FILLED)

    def _leads_to(self, piece: Mask, line: Mask) -> bool:
        """Return True if a piece has the thing's colour and lies in a line that nothing seen interrupts."""
        from scipy.ndimage import binary_dilation, binary_propagation

        if (line & self._alike)[piece].mean() < MIN_IN_LINE:
            return False
        between = self._seed | (line & (self._before | (self._candidate & self._alike)))
        reached = binary_propagation(self._seed, AROUND, between | (line & self._others))
        return bool((binary_dilation(reached & between, AROUND, iterations=2) & piece).any())

    def _carried_ends(
        self, carrier: Mask, depth: NDArray[np.float32], shade: NDArray[np.float64], like: NDArray[np.float64]
    ) -> Mask:
        """Return a mask of the pixels in the line of a thing on a plate, beyond its ends, that differ from the plate.

        They are compared with the plate beside the line, since the wall of a plate has other shades than its middle.
        Where the line crosses the wall at an angle, only the hue tells the thing from the plate.
        """
        if not self._is_slender:
            return np.zeros(carrier.shape, np.bool_)
        box, pose = self._thing.oriented, self._thing.pose
        rows, columns = np.indices(carrier.shape) + np.array(self._corner)[:, None, None]
        rays = np.stack([columns, rows, np.ones(rows.shape)], axis=-1) * depth[..., None]
        places = (rays - self._view.offset) @ np.linalg.inv(self._view.matrix).T
        own = ((places - pose[:3, 3]) @ pose[:3, :3] - np.array(box.centre)) @ turned_axes(box.yaw).T
        along, across = own[..., 0], np.abs(own[..., 1]) - box.extents[1] / 2 - STRIP_MARGIN
        end = (across < 0) & (np.abs(along) > box.extents[0] / 2 - SLICE) & (like > MIN_LIKENESS) & carrier
        beside = carrier & (across > 0) & (across < BESIDE)
        number = np.floor(along / SLICE).astype(np.int64)
        found = np.zeros(carrier.shape, np.bool_)
        for each in np.unique(number[end]):
            plate, here = shade[beside & (number == each)], shade[end & (number == each)]
            if len(plate) >= MIN_BESIDE:
                differs = np.linalg.norm(here - np.median(plate, axis=0), axis=-1) > UNLIKE_BESIDE
                if differs.any():  # the mean has less noise, and pixels at an edge have both hues
                    mean = here[differs].mean(axis=0, keepdims=True)
                    has_hue = self._is_nearer_in_hue(np.concatenate([here, mean]), plate.mean(axis=0))
                    found[end & (number == each)] = differs & has_hue[:-1] & has_hue[-1]
        return found

    def _is_nearer_in_hue(self, colours: NDArray[np.float64], plate: NDArray[np.float64]) -> Mask:
        """Return a mask of the colours (k, 3) that are nearer to the thing's mean than to a plate's, in any light."""
        own = self._thing.cloud.colours
        if own is None:
            return np.zeros(len(colours), np.bool_)
        pair = np.stack([own.mean(axis=0, dtype=np.float64), plate])
        along = colours @ (pair / np.maximum(np.linalg.norm(pair, axis=1, keepdims=True), 1e-9)).T
        nearer: Mask = along[:, 0] > along[:, 1]
        return nearer

    @property
    def _is_slender(self) -> bool:
        length, width, _ = self._thing.oriented.extents
        return length >= MIN_SLENDERNESS * width

    def _own_line(self) -> Mask:
        """Return a mask of the pixels at which the thing would be seen if it were longer, up to ``MAX_LENGTH``."""
        longer = MAX_LENGTH - self._thing.oriented.extents[0]
        if not self._is_slender or longer <= 0:
            return np.zeros(self._level.shape, np.bool_)
        along, across, _ = turned_axes(self._thing.oriented.yaw) @ self._thing.pose[:3, :3].T
        corners = self._thing.placed_corners
        ends = np.sort(corners @ along)[[0, -1]] + np.array([-longer, longer])
        return self._strip(corners @ across, across) & self._strip(ends, along)

    def _line_to(self, thing: Pipeline) -> Mask:
        """Return a mask of the pixels at which a long thing would be seen that ends in this thing and in another.

        A slender thing must have the other one in its own line, as the handle of a spoon has its bowl.
        """
        ends = [each.placed_corners for each in (self._thing, thing)]
        along = ends[1].mean(axis=0) - ends[0].mean(axis=0)
        along[2] = 0.0
        along /= max(float(np.linalg.norm(along)), 1e-9)
        across, both = np.array([-along[1], along[0], 0.0]), np.concatenate(ends)
        width = float(np.ptp(both @ across))
        wider = max(each.oriented.extents[1] for each in (self._thing, thing)) + 2 * STRIP_MARGIN
        if np.ptp(both @ along) < MIN_JOINT_SLENDERNESS * width or (self._is_slender and width > wider):
            return np.zeros(self._level.shape, np.bool_)
        return self._strip(both @ across, across)

    def _strip(self, offsets: NDArray[np.float64], across: NDArray[np.float64]) -> Mask:
        """Return a mask of the pixels that show places between the least and the greatest offset in a direction."""
        rows, columns = np.indices(self._level.shape) + np.array(self._corner)[:, None, None]
        height = self._thing.oriented.extents[2]
        depth = np.where(np.isfinite(self._level), self._level, 0.0) * (1 - height / 2 / self._eye)
        rays = np.stack([columns, rows, np.ones(rows.shape)], axis=-1) * depth[..., None]
        at = (rays - self._view.offset) @ np.linalg.inv(self._view.matrix).T @ across
        line: Mask = (depth > 0) & (at > offsets.min() - STRIP_MARGIN) & (at < offsets.max() + STRIP_MARGIN)
        return line
