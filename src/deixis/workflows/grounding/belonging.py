"""Estimate where missing and misplaced objects of a checked table belong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.grammar.layout.format import layout_script
from deixis.grammar.layout.parser import parse_script
from deixis.reasoning.comparison.checking import RoleVerdict
from deixis.workflows.layouts.imagine import imagine

if TYPE_CHECKING:
    from deixis.workflows.grounding.check import Check

TIME_LIMIT = 2.0
"""Seconds for the example table that distances are taken from."""

MAX_PUSHES = 12
"""Maximum number of moves that free a place from the places of other objects."""

Box = NDArray[np.float64]
"""A box from above, shape (2, 2): least corner, greatest corner, in the scene's unit."""


def places_of(checked: Check, time_limit: float = TIME_LIMIT) -> dict[str, Box]:
    """Estimate where the missing and misplaced objects of a checked table belong.

    Two objects that changed places belong in each other's place. Every other place is taken from an example table that
    satisfies the layout: the object keeps its distances there to the objects that the layout relates it to, as far as
    these are in place or their own places are known, and the median over these objects is taken. If it lies on or in
    some of them, only those count. A place moves aside if it overlaps that of an object from which it is apart in the
    example.

    Parameters
    ----------
    checked
        A table that was checked against a layout.
    time_limit
        Seconds for finding the example table.

    Returns
    -------
    dict
        A box of shape (2, 2) for each missing or misplaced object whose place could be estimated, in the scene's unit.
        It has the size of the object's own thing, or the usual size of its kind where that is missing.
    """
    roles = {role.role: role for role in checked.table.roles}
    boxes = {thing.id: box for thing, box in zip(checked.scene.objects, checked.scene.boxes[:, :, :2], strict=True)}
    wrong = (RoleVerdict.MISSING, RoleVerdict.MISPLACED)
    wanted = [name for name, role in roles.items() if role.verdict in wrong]
    occupied_by = {role.in_place_of: role.perceived for role in roles.values() if role.in_place_of is not None}
    in_place = {
        name: boxes[role.perceived]
        for name, role in roles.items()
        if role.perceived is not None and role.verdict not in wrong
    }
    found: dict[str, Box] = {}
    for name in wanted:
        occupant, own = occupied_by.get(name), roles[name].perceived
        if occupant is not None and own is not None:
            found[name] = _centred_at(boxes[own], boxes[occupant].mean(axis=0))
    rest = [name for name in wanted if name not in found]
    anchors = in_place | found
    example = _example(checked, time_limit) if rest and anchors else {}
    shared = [name for name in anchors if name in example]
    if not shared:
        return found
    scale = float(np.median([_size(anchors[name]) / _size(example[name]) for name in shared]))
    related = _related(checked)
    for name in rest:
        if name not in example:
            continue
        neighbours = [other for other in shared if other in related.get(name, ())] or shared
        neighbours = [other for other in neighbours if _contains(example[other], example[name])] or neighbours
        own = roles[name].perceived
        size = np.ptp(boxes[own], axis=0) if own is not None else scale * np.ptp(example[name], axis=0)
        centres = [_beside(anchors[other], example[other], example[name], size, scale) for other in neighbours]
        centre = np.median(centres, axis=0)
        box = np.stack([centre - size / 2, centre + size / 2])
        places = in_place | found
        found[name] = _cleared(
            box, example[name], [(places[other], example[other]) for other in places if other in example]
        )
    return found


def _cleared(box: Box, example: Box, others: Sequence[tuple[Box, Box]]) -> Box:
    """Return a box moved away from the places of others that it overlaps and that it is apart from in the example.

    ``others`` are places with their boxes in the example. The box moves to the side on which it stands in the
    example, along the axis that takes the shorter way. It stays where it was if no such way is found.
    """
    apart = [(place, other) for place, other in others if not _overlap(example, other)]
    moved = box
    for _ in range(MAX_PUSHES):
        hit = next(((place, other) for place, other in apart if _overlap(moved, place)), None)
        if hit is None:
            return moved
        place, other = hit
        ways: list[NDArray[np.float64]] = []
        for axis in (0, 1):
            way = np.zeros(2)
            if example[0, axis] >= other[1, axis]:
                way[axis] = place[1, axis] - moved[0, axis]
            elif example[1, axis] <= other[0, axis]:
                way[axis] = place[0, axis] - moved[1, axis]
            else:
                continue
            ways.append(1.02 * way)
        moved = moved + min(ways, key=lambda way: float(np.abs(way).sum()))
    return box


def _contains(outer: Box, inner: Box) -> bool:
    return bool((outer[0] <= inner[0]).all() and (inner[1] <= outer[1]).all())


def _overlap(first: Box, second: Box) -> bool:
    return bool((np.minimum(first[1], second[1]) > np.maximum(first[0], second[0])).all())


def _example(checked: Check, time_limit: float) -> Mapping[str, Box]:
    """Return the boxes of an example table of the layout, by name; empty if no table is found in time."""
    try:
        script = parse_script(layout_script(checked.layout, checked.ontology), ontology=checked.ontology)
        tables = imagine(script, time_limit=time_limit).tables
    except DeixisError:
        return {}
    if not tables:
        return {}
    scene = tables[0].scene
    return {str(thing.label): box for thing, box in zip(scene.objects, scene.boxes[:, :, :2], strict=True)}


def _related(checked: Check) -> dict[str, set[str]]:
    related: dict[str, set[str]] = {}
    for fact in checked.layout.facts:
        related.setdefault(fact.subject, set()).add(fact.object)
        related.setdefault(fact.object, set()).add(fact.subject)
    return related


def _size(box: Box) -> float:
    return float(np.ptp(box, axis=0).max()) or 1e-9


def _centred_at(box: Box, centre: NDArray[np.float64]) -> Box:
    half: NDArray[np.float64] = np.ptp(box, axis=0) / 2
    return np.stack([centre - half, centre + half])


def _beside(
    anchor: Box, example_anchor: Box, example: Box, size: NDArray[np.float64], scale: float
) -> NDArray[np.float64]:
    """Return the centre (2,) of a box of a size that keeps an example's distances to an anchor, axis by axis."""
    centre = np.empty(2)
    for axis in (0, 1):
        (anchor_low, anchor_high), (low, high) = example_anchor[:, axis], example[:, axis]
        if low >= anchor_high:
            centre[axis] = anchor[1, axis] + scale * (low - anchor_high) + size[axis] / 2
        elif high <= anchor_low:
            centre[axis] = anchor[0, axis] - scale * (anchor_low - high) - size[axis] / 2
        else:
            offset = (low + high - anchor_low - anchor_high) / 2
            centre[axis] = anchor[:, axis].mean() + scale * offset
    return centre
