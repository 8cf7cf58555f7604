"""Things on a checked table that point the wrong way, and how far each must be turned."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.reasoning.geometry.poses import TOOL_STRETCH, Poses, bearings
from deixis.reasoning.grounding.answers.answer import FactOutcome
from deixis.reasoning.grounding.answers.claims import ClaimOutcome
from deixis.reasoning.grounding.evidence.claims.aims import AIMING, is_of_handle, stated_direction

AIMED_AT = {"faced_by": "facing", "pointed_at_by": "pointing"}
"""Relations whose object is the thing that points at the subject, with their inverses."""


@dataclass(frozen=True, slots=True)
class Turned:
    """A statement of direction that does not hold of a thing, and the turn after which it would.

    ``turn`` is in radians, counter-clockwise as seen from above, in (-pi, pi]; None for a denied direction, from which
    any turn leads away.
    """

    statement: Fact | Claim
    turn: float | None

    @property
    def remedy(self) -> str:
        """Instruction such as ``turn it 90° clockwise``."""
        if self.turn is None:
            return "turn it away from there"
        degrees = round(math.degrees(abs(self.turn)))
        if degrees > 170:
            return "turn it around"
        return f"turn it {degrees}° {'counter-clockwise' if self.turn > 0 else 'clockwise'}"


def is_aim(fact: Fact) -> bool:
    """Return whether a fact states in which direction a thing points.

    Parameters
    ----------
    fact
        A fact.

    Returns
    -------
    bool
        True for *facing* and *pointing to*, and for their inverses.
    """
    return all(relation.word in AIMING or relation.word in AIMED_AT for relation in fact.relations)


def turned_roles(
    broken: Sequence[FactOutcome],
    claims: Sequence[ClaimOutcome],
    things: Sequence[str],
    boxes: NDArray[np.float64] | None,
    poses: Poses | None,
) -> dict[tuple[str, str], tuple[Turned, ...]]:
    """Return the violated statements of direction by the role and its thing that points the wrong way.

    Parameters
    ----------
    broken
        Violated facts.
    claims
        Violated claims.
    things
        Names of the n things of the scene.
    boxes
        Their boxes, shape (n, 2, d); None where the scene has none.
    poses
        Fronts, heads and long axes of the n things; None where they are unknown.

    Returns
    -------
    dict
        Statements with the turns that would make them hold, by the name of the role and that of its thing.
    """
    found: dict[tuple[str, str], list[Turned]] = {}
    if boxes is None or poses is None:
        return {}
    place, way = {name: i for i, name in enumerate(things)}, bearings(boxes, boxes)
    for entry in broken:
        if entry.perceived is not None and is_aim(entry.fact):
            ends = [place[name] for name in entry.perceived]
            swapped = entry.fact.relations[0].word in AIMED_AT
            first, second = reversed(ends) if swapped else ends
            role = entry.fact.object if swapped else entry.fact.subject
            turn = _turn(poses, first, way[first, second], handle=False) if entry.fact.positive else None
            found.setdefault((role, things[first]), []).append(Turned(entry.fact, turn))
    for outcome in claims:
        for role_and_thing, turned in _of_claim(outcome, place, way, poses):
            found.setdefault(role_and_thing, []).append(turned)
    return {role_and_thing: tuple(turns) for role_and_thing, turns in found.items()}


def _of_claim(
    outcome: ClaimOutcome, place: Mapping[str, int], way: NDArray[np.float64], poses: Poses
) -> Iterator[tuple[tuple[str, str], Turned]]:
    claim, handle = outcome.claim, is_of_handle(outcome.claim.value)
    if claim.relation not in AIMING:
        return
    count, direction = len(claim.subjects), stated_direction(claim.value)
    others = [place[name] for name in outcome.perceived[count:]]
    for role, thing in zip(claim.subjects, outcome.perceived[:count], strict=True):
        wanted = direction if not others else way[place[thing], others[0]]
        if wanted is None:
            continue
        turn = _turn(poses, place[thing], wanted, handle)
        if not claim.positive or abs(turn) > np.pi / 4:  # the others of several subjects may be right
            yield (role, thing), Turned(claim, turn if claim.positive else None)


def _turn(poses: Poses, thing: int, wanted: NDArray[np.float64], handle: bool) -> float:
    """Return the angle from the direction of a thing to a wanted one; to the nearer one if its end is unknown."""
    way = poses.pointing[thing]
    if np.isnan(way).any():
        axis = poses.axes[thing]
        way = axis if float(axis @ wanted) >= 0 else -axis
    elif handle and (not poses.fronted[thing] or poses.stretch[thing] >= TOOL_STRETCH):
        way = -way
    cross = float(way[0] * wanted[1] - way[1] * wanted[0])
    return math.atan2(cross, float(way @ wanted))
