"""Relate boxes in a calculus: find the atom of every ordered pair.

Boxes have shape (n, 2, d): minimum and maximum corner; x to the viewer's right, y away from the viewer, z up. Calculi
of the plane (all except ``ba``) use x and y only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.errors import GraphError, UnknownTermError
from deixis.reasoning.errors import SettingError, UnknownCalculusError
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.geometry.rectangle import require_boxes
from deixis.reasoning.qualitative.calculi.bridges import (
    Bridge,
    boxes_to_regions,
    joint_to_directions,
    joint_to_distances,
    names_to_boxes,
)
from deixis.reasoning.qualitative.calculi.distance import DEFAULT_RANGES
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.spelling import nearest

CARDINAL_DIRECTIONS: tuple[str, ...] = ("n", "ne", "e", "se", "s", "sw", "w", "nw")
SAME_PLACE = "eq"
CONES: tuple[str, ...] = (*CARDINAL_DIRECTIONS, SAME_PLACE)


def cardinal_directions(boxes: NDArray[np.float64]) -> NDArray[np.str_]:
    """Return the direction from the object's centre to the subject's, for every ordered pair: shape (n, n).

    Parameters
    ----------
    boxes
        Boxes of shape (n, 2, d), d at least 2: minimum and maximum corner; x is east, y is north.

    Returns
    -------
    Members of CONES, shape (n, n); row: subject, column: object. A direction on the border of two cones belongs to
    the clockwise one (22.5 degrees east of north is north-east). Equal centres are ``eq``.

    Examples
    --------
    >>> cardinal_directions(np.array([[[0.0, 2], [1, 3]], [[0, 0], [1, 1]]])).tolist()
    [['eq', 'n'], ['s', 'eq']]
    """
    return np.array(CONES)[cardinal_cones(boxes)]


def cardinal_cones(boxes: NDArray[np.float64]) -> NDArray[np.int16]:
    """Return the direction from the object's centre to the subject's as positions in CONES.

    Parameters
    ----------
    boxes
        Boxes in the plane, shape (n, 2, 2): minimum and maximum corner, y to the north.

    Returns
    -------
    ndarray
        Positions in ``CONES``, shape (n, n), row: subject, column: object; 8 for equal centres.
    """
    centres = boxes.mean(axis=1)
    east = centres[:, None, 0] - centres[None, :, 0]
    north = centres[:, None, 1] - centres[None, :, 1]
    clockwise = np.degrees(np.arctan2(east, north))
    cone = np.floor((clockwise + 22.5) / 45.0).astype(np.int16) % 8
    return np.where((east == 0) & (north == 0), np.int16(8), cone)


AXES = "xyz"
ALONG_AN_AXIS = ("point", "allen")
"""Calculi of one axis."""
Codes = NDArray[np.int16]  # (n, n), row: subject, column: object


@dataclass(frozen=True)
class _Settings:
    axis: str
    tolerance: float
    reference: float | None


def relate(
    boxes: NDArray[np.float64],
    name: str,
    *,
    axis: str = "x",
    tolerance: float = 0.0,
    reference: float | None = None,
) -> Codes:
    """Return the code of every ordered pair's atom in a calculus, shape (n, n); row: subject, column: object.

    Parameters
    ----------
    boxes
        Boxes of shape (n, 2, d): minimum and maximum corner.
    name
        The name of the calculus, one of RELATED.
    axis
        The axis (x, y or z) of ``point``, which relates the boxes' centres, and of ``allen``.
    tolerance
        The greatest difference of coordinates that count as equal, in the boxes' unit.
    reference
        The unit of the distance ranges, as a length in the boxes' unit; required for calculi with distance.

    Returns
    -------
    Codes of atoms; ``signs_of(name)`` lists the signs by code.

    Raises
    ------
    GraphError
        If the boxes have another shape, or lack an axis.
    UnknownCalculusError
        If boxes cannot be related in a calculus of that name.
    SettingError
        If `axis`, `tolerance` or `reference` is out of range.

    Examples
    --------
    >>> fork, plate = [[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]
    >>> codes = relate(np.array([fork, plate]), "cd")
    >>> signs_of("cd")[codes[0, 1]]
    'SW'
    """
    relator = _RELATORS.get(name)
    if relator is None:
        hint = nearest(name, _RELATORS)
        raise UnknownCalculusError(
            f"no calculus '{name}' relates boxes; "
            + (f"did you mean '{hint}'?" if hint else f"there are {', '.join(RELATED)}")
        )
    if not tolerance >= 0:
        raise SettingError(f"`tolerance` must be at least 0, got {tolerance}")
    require_boxes(boxes)
    return relator(boxes, _Settings(axis, tolerance, reference))


@dataclass(frozen=True, eq=False, repr=False)
class Related(Answer):
    """The atoms of one calculus between every ordered pair of named things.

    Examples
    --------
    >>> import deixis
    >>> scene = deixis.Scene.from_boxes([[0.0, 0.0], [0.3, 0.0]], [[0.2, 0.2], [0.32, 0.2]])
    >>> found = deixis.relate(scene, "cd")
    >>> list(found.pairs(subject="o1")), found.signs[found.codes[0, 1]], found.places("o2")
    ([('o1', 'W', 'o2')], 'W', range(1, 2))
    """

    calculus: str
    ids: tuple[str, ...]
    codes: Codes

    def summary(self) -> str:
        """Return the number of things and the calculus."""
        return f"{count(len(self.ids), 'thing')} in {self.calculus}"

    @property
    def signs(self) -> tuple[str, ...]:
        """The signs of the atoms, by code."""
        return signs_of(self.calculus)

    @checks_arguments
    def pairs(self, subject: str | None = None, object: str | None = None) -> Iterator[tuple[str, str, str]]:
        """Yield subject, sign and object of every ordered pair, or of the pairs with the given subject and object.

        Parameters
        ----------
        subject
            Name of the subject; None for every thing.
        object
            Name of the object; None for every thing.

        Yields
        ------
        tuple
            Subject, sign of the relation, and object.

        Raises
        ------
        UnknownTermError
            Nothing has this name.
        """
        subjects, objects, signs = self.places(subject), self.places(object), self.signs
        for i in subjects:
            row = self.codes[i].tolist()
            for j in objects:
                if i != j:
                    yield self.ids[i], signs[row[j]], self.ids[j]

    @checks_arguments
    def places(self, name: str | None) -> range:
        """Return the place of a thing among the ids as a range of length 1; all places if ``name`` is None.

        Parameters
        ----------
        name
            Name of a thing, or None.

        Returns
        -------
        range
            Positions in ``ids``.

        Raises
        ------
        UnknownTermError
            Nothing has this name.
        """
        if name is None:
            return range(len(self.ids))
        if name not in self.ids:
            hint = nearest(name, self.ids)
            advice = f"did you mean '{hint}'?" if hint else f"there are: {', '.join(self.ids) or 'none'}"
            raise UnknownTermError(f"there is no object '{name}'; {advice}")
        place = self.ids.index(name)
        return range(place, place + 1)


def signs_of(name: str) -> tuple[str, ...]:
    """Return the signs that the codes of :func:`relate` stand for.

    Parameters
    ----------
    name
        Name of a calculus, or ``cardir`` for the cones of the cardinal directions.

    Returns
    -------
    tuple of str
        Signs, in the order of the codes.

    Raises
    ------
    UnknownCalculusError
        There is no calculus of this name.
    """
    return CONES if name == "cardir" else calculus(name).atoms


def _axis(boxes: NDArray[np.float64], axis: str) -> NDArray[np.float64]:
    """Return the intervals of the boxes on one axis, shape (n, 2)."""
    if len(axis) != 1 or axis not in AXES:
        raise SettingError(f"`axis` must be x, y or z, got '{axis}'")
    if AXES.index(axis) >= boxes.shape[2]:
        raise GraphError("these boxes have no heights (z): they are flat")
    found: NDArray[np.float64] = boxes[:, :, AXES.index(axis)]
    return found


def _allen_on(boxes: NDArray[np.float64], axis: str, tolerance: float) -> Codes:
    ends = _axis(boxes, axis)
    low, high = ends[:, 0], ends[:, 1]
    codes = allen_relations(low[:, None], high[:, None], low[None, :], high[None, :], tolerance)
    return codes.astype(np.int16)


def _order_on(boxes: NDArray[np.float64], axis: str, tolerance: float) -> Codes:
    """Return the order of the boxes' centres on an axis: 0 less, 1 equal, 2 greater."""
    centres = _axis(boxes, axis).mean(axis=1)
    difference = centres[:, None] - centres[None, :]
    sign: Codes = (difference > tolerance).astype(np.int16) - (difference < -tolerance).astype(np.int16)
    return sign + np.int16(1)


def _product(on: Callable[[NDArray[np.float64], str, float], Codes], axes: str, atoms: int) -> _Relator:
    """Return a function that codes pairs in a product of calculi of ``atoms`` atoms each, last axis fastest."""

    def related(boxes: NDArray[np.float64], settings: _Settings) -> Codes:
        codes = on(boxes, axes[0], settings.tolerance)
        for axis in axes[1:]:
            codes = codes * np.int16(atoms) + on(boxes, axis, settings.tolerance)
        return codes

    return related


def _by_atom(bridge: Callable[[], Bridge]) -> _Relator:
    """Return a function that codes pairs by their rectangle-algebra atom, where the bridge maps it to one atom."""

    def related(boxes: NDArray[np.float64], settings: _Settings) -> Codes:
        table = np.array([admitted.bit_length() - 1 for admitted in bridge().admits], dtype=np.int16)
        return table[_rectangles(boxes, settings)]

    return related


def _distances(boxes: NDArray[np.float64], settings: _Settings) -> Codes:
    reference = settings.reference
    if reference is None:
        raise SettingError("a calculus with distances needs the length `reference`, in the boxes' unit")
    if not 0 < reference < np.inf:
        raise SettingError(f"`reference` must be a length above 0, in the boxes' unit, got {reference}")
    centres = boxes.mean(axis=1)[:, :2]
    offsets = centres[:, None] - centres[None, :]
    distance = np.hypot(offsets[..., 0], offsets[..., 1])
    reach = 1 + np.searchsorted(np.array(DEFAULT_RANGES.bounds) * reference, distance, side="left")
    same = (np.abs(offsets) <= settings.tolerance).all(axis=2)
    return np.where(same, 0, reach).astype(np.int16)


def _directions_with_distances(boxes: NDArray[np.float64], settings: _Settings) -> Codes:
    """Return the code of the one joint atom that has the tile and the range of each pair."""
    tiles, ranges = joint_to_directions(), joint_to_distances()
    atoms = np.full((len(tiles.target.atoms), len(ranges.target.atoms)), -1, dtype=np.int16)
    for code, (tile, reach) in enumerate(zip(tiles.admits, ranges.admits, strict=True)):
        atoms[tile.bit_length() - 1, reach.bit_length() - 1] = code
    return atoms[_directions(boxes, settings), _distances(boxes, settings)]


_Relator = Callable[[NDArray[np.float64], _Settings], Codes]

_rectangles = _product(_allen_on, "xy", 13)
_directions = _product(_order_on, "xy", 3)

_RELATORS: dict[str, _Relator] = {
    "point": lambda boxes, settings: _order_on(boxes, settings.axis, settings.tolerance),
    "allen": lambda boxes, settings: _allen_on(boxes, settings.axis, settings.tolerance),
    "ra": _rectangles,
    "ba": _product(_allen_on, "xyz", 13),
    "cd": _directions,
    "cardir": lambda boxes, settings: cardinal_cones(boxes),
    "rcc8": _by_atom(boxes_to_regions),
    "ten": _by_atom(lambda: names_to_boxes().inverse),
    "distance": _distances,
    "direction-distance": _directions_with_distances,
}

RELATED: tuple[str, ...] = tuple(_RELATORS)
"""Names of the calculi in which boxes can be related, and ``cardir``, the eight cones."""
