"""Directions that things are stated to point or to face in: *the fork points away*, *its handle to the right*.

A claim of direction has the term ``pointing`` or ``facing``. Its value names a part (*with its handle to the plate*), a
direction in the plane as the viewer sees it (*pointing left*), or both (``handle right``). Only the part ``handle``
matters: it is opposite the head of a long thing. Where the direction of a thing is not known, a claim is neutral.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.poses import Poses, bearings
from deixis.reasoning.grounding.evidence.claims.places import TOWARDS
from deixis.reasoning.grounding.evidence.words.meaning import BORDER, EXTREME

Array = NDArray[np.float64]

AIMING = frozenset({"pointing", "facing"})
"""Terms of claims of direction, and relations to the thing that another points at."""

HANDLE = "handle"
"""Word in the value of a claim that is about the direction of the handle."""

DIRECTIONS = {**TOWARDS, "away": (1, 1), "viewer": (1, -1), "you": (1, -1), "me": (1, -1)}
"""Axis and sign of the words for directions in the plane."""

OFF_DIRECTION = ((np.pi / 6, np.pi / 4, np.pi / 2), (0.0, BORDER, EXTREME))
"""Log degree of pointing in a direction by the angle from it, in radians."""


def stated_direction(value: str | None) -> Array | None:
    """Return the direction that the value of a claim names.

    Parameters
    ----------
    value
        Words such as ``left``, ``far right`` or ``handle away``.

    Returns
    -------
    ndarray or None
        Unit vector of shape (2,), x to the viewer's right and y away; None if the words name no direction in the plane.

    Examples
    --------
    >>> stated_direction("handle right"), stated_direction("up"), stated_direction("left right")
    (array([1., 0.]), None, None)
    """
    sides = [DIRECTIONS[word] for word in (value or "").replace("_", " ").split() if word in DIRECTIONS]
    if not sides or len({axis for axis, _ in sides}) < len(sides):
        return None
    direction = np.zeros(2)
    for axis, sign in sides:
        direction[axis] = sign / np.sqrt(len(sides))
    return direction


def is_of_handle(value: str | None) -> bool:
    """Return whether a claim of direction is about the handle of its subject.

    Parameters
    ----------
    value
        Value of the claim.

    Returns
    -------
    bool
        True if one of its words is ``handle``.
    """
    return HANDLE in (value or "").split()


def degree_of_angle(angle: Array) -> Array:
    """Return the degree to which things point in a direction.

    Parameters
    ----------
    angle
        Angles from the direction in radians, of any shape, NaN where they are unknown.

    Returns
    -------
    ndarray
        Degrees in (0, 1], of the shape of ``angle``; NaN where they are unknown.
    """
    return np.asarray(np.exp(np.interp(angle, *OFF_DIRECTION)))


MEAN_DEGREE = float(degree_of_angle(np.linspace(0.0, np.pi, 1801)).mean())
"""Degree of a thing whose direction is not known: the mean over all directions."""


def aim_degrees(term: str, value: str | None, poses: Poses, boxes: Array | None = None) -> Array | None:
    """Return the degree of a claim of direction for each thing, or for each pair.

    Parameters
    ----------
    term
        ``pointing`` or ``facing``.
    value
        Value of the claim.
    poses
        Fronts, heads and long axes of the n things.
    boxes
        Boxes of shape (n, 2, d) for a claim about the direction to another thing; None for one with a stated direction.

    Returns
    -------
    ndarray or None
        Degrees in (0, 1], shape (n,) or (n, n), ``MEAN_DEGREE`` where the direction is not known; None for a value that
        names no direction in the plane.
    """
    wanted = stated_direction(value) if boxes is None else bearings(boxes, boxes)
    if wanted is None:
        return None
    degree = degree_of_angle(poses.aim_angles(wanted, term == "facing", is_of_handle(value)))
    return np.where(np.isnan(degree), MEAN_DEGREE, degree)
