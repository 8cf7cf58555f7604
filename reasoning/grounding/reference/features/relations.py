"""Features of pairs of objects for each relation word: how well a candidate stands in the relation to a landmark.

Features are arrays that broadcast to (v, x, a): viewer, candidate, landmark. Candidates of one class
are rivals: a speaker says *the chair next to the desk* because no other chair is nearer to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.reference.features.room import Room

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Pairs:
    """Candidates and landmarks of one relation in a room.

    Parameters
    ----------
    room
        The scene.
    candidates, landmarks
        Indices of objects, shapes (x,) and (a,).
    rivals
        Positions of the candidates that compete with each other, such as all chairs, and then all red chairs; each
        candidate is compared within the last group that it is in.
    """

    room: Room
    candidates: Indices
    landmarks: Indices
    rivals: tuple[Indices, ...]

    def of(self, matrix: Array) -> Array:
        """Return the entries of a matrix over all objects, for these candidates and landmarks.

        Parameters
        ----------
        matrix
            Values of all pairs of the n objects, shape (n, n).

        Returns
        -------
        ndarray
            Entries, shape (1, x, a).
        """
        return matrix[np.ix_(self.candidates, self.landmarks)][None]

    def least(self, values: Array) -> Array:
        """Return 1 where a candidate has the least value among its rivals.

        Parameters
        ----------
        values
            Values of each candidate and landmark for v viewers, shape (v, x, a).

        Returns
        -------
        ndarray
            Array of 0 and 1, shape (v, x, a).
        """
        found = np.zeros(values.shape)
        for group in self.rivals:
            among = values[:, group]
            found[:, group] = among <= among.min(axis=1, keepdims=True) + 1e-9
        return found

    def rank(self, values: Array) -> Array:
        """Return the share of the rivals with a lesser value.

        Parameters
        ----------
        values
            Values of each candidate and landmark for v viewers, shape (v, x, a).

        Returns
        -------
        ndarray
            Shares in [0, 1], shape (v, x, a).
        """
        found = np.zeros(values.shape)
        for group in self.rivals:
            among = values[:, group]
            found[:, group] = among.argsort(axis=1).argsort(axis=1) / max(len(group) - 1, 1)
        return found


Features = Mapping[str, Array]
Family = Callable[[Pairs, float], Features]
"""Function from pairs and a sign to features; the sign -1 exchanges the word with its opposite."""


def proximity(pairs: Pairs, sign: float) -> Features:
    """Return features of nearness (sign 1) or of distance (sign -1).

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        1 for near, -1 for far.

    Returns
    -------
    dict
        Features by name, each of shape (1, x, a).
    """
    room = pairs.room
    gap, distance = pairs.of(room.gaps), pairs.of(room.distances)
    plane = np.hypot(*np.moveaxis(pairs.of(room.offsets[:, :, :2].reshape(len(room), len(room), 2)), -1, 0))
    level = np.abs(pairs.of(room.offsets[:, :, 2]))
    both = gap + 0.5 * distance
    return {
        "gap": -sign * np.minimum(gap, 6.0),
        "log_gap": -sign * np.log(gap + 0.1),
        "distance": -sign * np.log(distance + 0.2),
        "plane": -sign * np.minimum(plane, 8.0),
        "nearest": pairs.least(sign * gap),
        "nearest_centre": pairs.least(sign * distance),
        "rank": -pairs.rank(sign * both),
        "level": -sign * np.minimum(level, 2.0),
        "owner": (gap <= gap.min(axis=2, keepdims=True) + 1e-9).astype(float),
    }


def support(pairs: Pairs, sign: float) -> Features:
    """Return features of standing or lying on a landmark (sign 1), or of being under it (sign -1).

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        1 for on, -1 for under.

    Returns
    -------
    dict
        Features by name, each of shape (1, x, a).
    """
    room = pairs.room
    low, high, middle = room.boxes[:, 0, 2], room.boxes[:, 1, 2], room.centres[:, 2]
    rise = pairs.of(room.offsets[:, :, 2])
    first, second = (low, high) if sign > 0 else (high, low)
    rest = np.abs(pairs.of((first[:, None] - second[None]) / room.scale))
    clear = pairs.of(sign * (middle[:, None] - second[None]) / room.scale)
    cover, cover_back = pairs.of(room.covered), pairs.of(room.covered.T)
    gap = pairs.of(room.gaps)
    return {
        "covered": cover,
        "covers": cover_back,
        "rest": -np.minimum(rest, 2.0),
        "rise": np.tanh(2 * sign * rise),
        "clear": (clear > 0).astype(float),
        "gap": -np.minimum(gap, 3.0),
        "log_gap": -np.log(gap + 0.05),
        "plane_gap": -np.minimum(pairs.of(room.plane_gaps), 3.0),
        "contained": pairs.of(room.contained),
        "nearest": pairs.least(gap),
        "over": cover * (sign * rise > 0),
        "overlaps": ((cover > 0) & (sign * rise > 0)).astype(float),
        "overlaps_most": pairs.least(-np.maximum(cover, cover_back) * (sign * rise > 0)),
    }


def inside(pairs: Pairs, sign: float) -> Features:
    """Return features of being in a landmark.

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        Not used: the relation has no opposite.

    Returns
    -------
    dict
        Features by name, each of shape (1, x, a).
    """
    del sign
    room = pairs.room
    gap = pairs.of(room.gaps)
    return {
        "contained": pairs.of(room.contained),
        "covered": pairs.of(room.covered),
        "gap": -np.minimum(gap, 3.0),
        "log_gap": -np.log(gap + 0.05),
        "nearest": pairs.least(gap),
        "smaller": np.tanh(pairs.of(_larger(room))),
    }


def sideways(pairs: Pairs, sign: float) -> Features:
    """Return features of being to the right of a landmark (sign 1) or to its left (sign -1) for each viewer.

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        1 for right, -1 for left.

    Returns
    -------
    dict
        Features by name, each of shape (v, x, a).
    """
    room = pairs.room
    right = np.stack([room.views[:, 1], -room.views[:, 0]], axis=1)
    return _along(pairs, sign * right)


def ahead(pairs: Pairs, sign: float) -> Features:
    """Return features of being in front of a landmark (sign 1) or behind it (sign -1).

    Three frames are compared: the viewer's (in front is nearer to the viewer), the landmark's own front, and the room's
    (in front is on the side away from the wall).

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        1 for in front, -1 for behind.

    Returns
    -------
    dict
        Features by name, arrays that broadcast to (v, x, a).
    """
    room = pairs.room
    offset = np.moveaxis(pairs.of(room.offsets), 0, 0)[0][..., :2]
    length = np.maximum(np.linalg.norm(offset, axis=2), 0.3)
    fronts = room.fronts[pairs.landmarks]
    known: NDArray[np.bool_] = np.logical_not(np.isnan(fronts).any(axis=1))
    own = sign * np.einsum("xad,ad->xa", offset, np.where(known[:, None], fronts, 0.0)) / length
    inward = sign * np.einsum("xad,ad->xa", offset, room.inward[pairs.landmarks]) / length
    view = _along(pairs, -sign * room.views)
    fronts = np.where(known[:, None], fronts, 0.0)
    aside = np.abs(offset[..., 0] * fronts[:, 1] - offset[..., 1] * fronts[:, 0])
    width = np.abs(room.extents[pairs.landmarks][:, :2] * fronts[:, ::-1]).sum(axis=1) / (2 * room.scale)
    sector = (own > 0) & (aside < np.maximum(width, 0.2)) & known
    gap = pairs.of(room.gaps)
    by_wall = np.exp(-room.wall_gaps[pairs.landmarks])
    return {
        "own_front": own[None],
        "room_front": (inward * by_wall * ~known)[None],
        "room_front_known": (inward * by_wall * known)[None],
        "view_cosine": view["cosine"],
        "gap": -np.minimum(gap, 6.0),
        "log_gap": -np.log(gap + 0.1),
        "nearest": pairs.least(gap),
        "level": -np.minimum(np.abs(pairs.of(room.offsets[:, :, 2])), 2.0),
        "own_best": pairs.least(-own[None]) * known,
        "own_side": ((own > 0.5) & known)[None].astype(float),
        "own_sector": sector[None].astype(float),
        "own_aside": -np.minimum(aside, 4.0)[None] * known,
    }


def between(pairs: Pairs, sign: float) -> Features:
    """Return features of being between two landmarks; the landmarks are all pairs of ``pairs.landmarks``.

    Parameters
    ----------
    pairs
        The candidates and the a landmarks.
    sign
        Not used: the relation has no opposite.

    Returns
    -------
    dict
        Features by name, each of shape (1, x, a * a).
    """
    del sign
    room, ends = pairs.room, pairs.landmarks
    offset = room.offsets[np.ix_(pairs.candidates, ends)][..., :2]
    apart = np.linalg.norm(offset, axis=2)
    across = np.linalg.norm(room.offsets[np.ix_(ends, ends)][..., :2], axis=2)
    detour = apart[:, :, None] + apart[:, None, :] - across[None]
    cosine = np.einsum("xad,xbd->xab", offset, offset) / np.maximum(apart[:, :, None] * apart[:, None, :], 0.05)
    balance = np.abs(apart[:, :, None] - apart[:, None, :])
    size = len(pairs.candidates)
    flat = Pairs(room, pairs.candidates, np.zeros(len(ends) ** 2, dtype=np.intp), pairs.rivals)
    shaped = {
        "detour": -np.minimum(detour, 6.0),
        "cosine": -cosine,
        "balance": -np.minimum(balance, 6.0),
        "span": -np.minimum(across, 10.0)[None] * np.ones((size, 1, 1)),
    }
    found = {name: values.reshape(1, size, -1) for name, values in shaped.items()}
    return {**found, "least": flat.least(-found["detour"])}


def toward(pairs: Pairs, sign: float) -> Features:
    """Return features of facing a landmark, or of standing opposite it, or (sign -1) of turning the back to it.

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        1 for facing, -1 for turning the back.

    Returns
    -------
    dict
        Features by name, each of shape (1, x, a).
    """
    room = pairs.room
    offset = room.offsets[np.ix_(pairs.candidates, pairs.landmarks)][..., :2]
    length = np.maximum(np.linalg.norm(offset, axis=2), 0.3)
    ours, theirs = room.fronts[pairs.candidates], room.fronts[pairs.landmarks]
    ours, theirs = np.nan_to_num(ours), np.nan_to_num(theirs)
    facing = -sign * np.einsum("xad,xd->xa", offset, ours) / length
    faced = sign * np.einsum("xad,ad->xa", offset, theirs) / length
    inward = np.einsum("xad,ad->xa", offset, room.inward[pairs.landmarks]) / length
    gap = pairs.of(room.gaps)
    lateral = np.minimum(np.abs(offset), 4.0).min(axis=2)
    return {
        "facing": facing[None],
        "faced": faced[None],
        "inward": inward[None],
        "lateral": -lateral[None],
        "gap": -np.minimum(gap, 6.0),
        "far": np.log(gap + 0.1),
        "nearest": pairs.least(gap),
        "nearest_lateral": pairs.least(lateral[None]),
        "facing_best": pairs.least(-facing[None]),
    }


def larger(pairs: Pairs, sign: float) -> Features:
    """Return features of being bigger (sign 1) or smaller (sign -1) than a landmark.

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        1 for bigger, -1 for smaller.

    Returns
    -------
    dict
        The feature ``log_ratio``, in [-1, 1], shape (1, x, a).
    """
    return {"log_ratio": np.tanh(-sign * pairs.of(_larger(pairs.room)))}


def cornered(pairs: Pairs, sign: float) -> Features:
    """Return features of being at a corner or an end of a landmark.

    Parameters
    ----------
    pairs
        The candidates and landmarks.
    sign
        Not used: the relation has no opposite.

    Returns
    -------
    dict
        Features by name, each of shape (1, x, a).
    """
    del sign
    room = pairs.room
    middle = room.centres[pairs.candidates][:, None, :2]
    corners = room.boxes[pairs.landmarks][:, :, :2]
    apart = np.minimum(np.abs(middle - corners[None, :, 0]), np.abs(middle - corners[None, :, 1])) / room.scale
    corner, end = np.hypot(apart[..., 0], apart[..., 1]), apart.min(axis=2)
    wide = room.extents[pairs.landmarks][:, 0] >= room.extents[pairs.landmarks][:, 1]
    tip = np.where(wide[None], apart[..., 0], apart[..., 1])
    found = proximity(pairs, 1.0)
    return {
        "corner": -np.minimum(corner, 3.0)[None],
        "end": -np.minimum(end, 3.0)[None],
        "tip": -np.minimum(tip, 3.0)[None],
        "nearest_corner": pairs.least(corner[None]),
        "nearest_tip": pairs.least(tip[None]),
        "gap": found["gap"],
        "nearest": found["nearest"],
    }


def _along(pairs: Pairs, headings: Array) -> Features:
    """Return features of lying in a direction from the landmark, one heading per viewer, shape (v, 2)."""
    room = pairs.room
    offset = room.offsets[np.ix_(pairs.candidates, pairs.landmarks)][..., :2]
    forward = np.einsum("vd,xad->vxa", headings, offset)
    length = np.maximum(np.linalg.norm(offset, axis=2), 0.3)[None]
    gap = pairs.of(room.gaps)
    ahead_of = forward > 0
    return {
        "cosine": forward / length,
        "forward": np.tanh(forward),
        "ahead": ahead_of.astype(float),
        "gap": -np.minimum(gap, 6.0) * np.ones_like(forward),
        "log_gap": -np.log(gap + 0.1) * np.ones_like(forward),
        "nearest": pairs.least(np.where(ahead_of, gap, 1e6 + gap)),
        "farthest": pairs.least(-forward),
        "aligned": pairs.least(-forward / length),
    }


def _larger(room: Room) -> Array:
    """Return how much larger the second object is than the first one: log ratios of diagonals, shape (n, n)."""
    size = np.log(np.maximum(np.linalg.norm(room.extents, axis=1), 1e-6))
    result: Array = size[None] - size[:, None]
    return result


ANY_RELATION = ("proximity", 1.0)
"""Family and sign of relations without a model of their own, such as *at*: related objects are near each other."""

RELATIONS: dict[str, tuple[str, float]] = {
    "near": ("proximity", 1.0),
    "nearest": ("proximity", 1.0),
    "closer": ("proximity", 1.0),
    "next_to": ("proximity", 1.0),
    "touching": ("proximity", 1.0),
    "against": ("proximity", 1.0),
    "along": ("proximity", 1.0),
    "around": ("proximity", 1.0),
    "among": ("proximity", 1.0),
    "with": ("proximity", 1.0),
    "level_with": ("proximity", 1.0),
    "middle": ("proximity", 1.0),
    "side": ("proximity", 1.0),
    "part": ("proximity", 1.0),
    "leaning": ("proximity", 1.0),
    "aligned": ("proximity", 1.0),
    "parallel": ("proximity", 1.0),
    "across": ("toward", 1.0),
    "far": ("proximity", -1.0),
    "farthest": ("proximity", -1.0),
    "on": ("support", 1.0),
    "stacked": ("support", 1.0),
    "above": ("support", 1.0),
    "under": ("support", -1.0),
    "below": ("support", -1.0),
    "inside": ("inside", 1.0),
    "right": ("sideways", 1.0),
    "left": ("sideways", -1.0),
    "in_front": ("ahead", 1.0),
    "behind": ("ahead", -1.0),
    "between": ("between", 1.0),
    "facing": ("toward", 1.0),
    "opposite": ("toward", 1.0),
    "pointing": ("toward", 1.0),
    "back_to": ("toward", -1.0),
    "bigger": ("larger", 1.0),
    "smaller": ("larger", -1.0),
    "taller": ("larger", 1.0),
    "shorter": ("larger", -1.0),
    "longer": ("larger", 1.0),
    "wider": ("larger", 1.0),
    "corner": ("cornered", 1.0),
    "edge": ("cornered", 1.0),
    "end": ("cornered", 1.0),
}
"""Family and sign of each relation; opposites share their weights with the sign reversed where the features allow."""

FAMILIES: dict[str, Family] = {
    "proximity": proximity,
    "support": support,
    "inside": inside,
    "sideways": sideways,
    "ahead": ahead,
    "between": between,
    "toward": toward,
    "larger": larger,
    "cornered": cornered,
}

VIEWED = frozenset({"sideways", "ahead"})
"""Families whose features depend on the viewer."""
