"""Random tables: things of random kinds at random places, some of them on plates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.tbox import Ontology, default_ontology
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.laying import Placement
from deixis.perception.simulator.meshes.tableware import drawn_plan, kind_named

KINDS = (
    *("dinner plate", "bread plate", "bowl", "mug", "cup", "water glass", "wine glass", "champagne glass", "bottle"),
    *("dinner fork", "salad fork", "dessert fork", "dinner knife", "fish knife", "butter knife"),
    *("soup spoon", "dessert spoon", "teaspoon", "napkin"),
)
"""Kinds of things on random tables."""

PLATED_KINDS = ("napkin", "butter knife", "teaspoon", "dessert fork")
"""Kinds that are laid on a plate half the time, if there is a free one that is large enough."""

MIN_GAP = 0.012
"""Minimum distance between things, in metres."""

MAX_THINGS = 300

_MAX_TRIES = 60


def scattered(
    count: int,
    seed: int,
    kinds: Sequence[str] = KINDS,
    foreign: Sequence[Placement] = (),
    ontology: Ontology | None = None,
) -> list[Placement]:
    """Return things of random kinds, and foreign ones, at random places and angles.

    Things are at least ``MIN_GAP`` apart, except those on plates; the area that they cover is wider than deep.

    Parameters
    ----------
    count
        Number of things of random kinds.
    seed
        Seed of kinds, shapes and places.
    kinds
        Words for the kinds to choose from.
    foreign
        Things that are placed first. They have their own meshes.
    ontology
        Kinds and their sizes; by default :func:`default_ontology`.

    Returns
    -------
    list of Placement
        The foreign things, and then the others, those on plates last. Names of the others are kinds with numbers.

    Raises
    ------
    SimulationError
        If ``count`` is above ``MAX_THINGS``, there are no things, or a kind is not known.
    """
    if not 0 <= count <= MAX_THINGS or count + len(foreign) == 0:
        raise SimulationError(f"a random table must have 1 to {MAX_THINGS} things, got {count}")
    ontology, rng = ontology or default_ontology(), np.random.default_rng(seed)
    floor = _Floor(rng)
    placed = [floor.put(placement, placement.plan or (0.1, 0.1)) for placement in foreign]
    chosen = [str(kind) for kind in rng.choice(np.array(kinds), count)]
    chosen.sort(key=lambda kind: kind in PLATED_KINDS)  # things below are set down first
    for number, kind in enumerate(chosen):
        name = f"{kind.replace(' ', '_')}_{chosen[:number].count(kind) + 1}"
        instance = int(rng.integers(2**31))
        plan = drawn_plan(kind_named(kind, ontology), instance, ontology)
        thing = Placement(name, kind, 0.0, 0.0, seed=instance)
        on_plate = floor.put_on_plate(thing, plan) if kind in PLATED_KINDS and rng.random() < 0.5 else None
        placed.append(on_plate or floor.put(thing, plan))
    return placed


class _Floor:
    """Occupied places: rectangles in plan, and empty plates."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._taken = np.empty((0, 4, 2))
        self._plates: list[tuple[float, float, float]] = []
        self._half = 0.15

    def put(self, thing: Placement, plan: tuple[float, float]) -> Placement:
        """Return the thing at a free place; the area grows until one is found."""
        while True:
            for _ in range(_MAX_TRIES):
                x, y = self._rng.uniform(-1, 1, 2) * (1.2 * self._half, 0.85 * self._half)
                yaw = float(self._rng.uniform(0, 2 * np.pi))
                corners = _corners(x, y, yaw, plan)
                own = corners[1:3] - corners[:2]
                others = (self._taken[:, 1:3] - self._taken[:, :2]).transpose(0, 2, 1)
                apart = _apart(corners @ own.T, self._taken @ own.T) | _apart(corners @ others, self._taken @ others)
                if bool(apart.all()):
                    self._taken = np.append(self._taken, corners[None], axis=0)
                    x, y = float(x), float(y)
                    if thing.kind is not None and thing.kind.endswith("plate"):
                        self._plates.append((plan[0], x, y))
                    return _at(thing, x, y, yaw)
            self._half *= 1.15

    def put_on_plate(self, thing: Placement, plan: tuple[float, float]) -> Placement | None:
        """Return the thing on the first free plate that is large enough, or None."""
        for place, (across, x, y) in enumerate(self._plates):
            if float(np.hypot(*plan)) < across:
                del self._plates[place]
                return _at(thing, x, y, float(self._rng.uniform(0, 2 * np.pi)))
        return None


def _at(thing: Placement, x: float, y: float, yaw: float) -> Placement:
    return Placement(thing.name, thing.kind, x, y, yaw, thing.seed, thing.plan, thing.mesh)


def _corners(x: float, y: float, yaw: float, plan: tuple[float, float]) -> NDArray[np.float64]:
    """Return the corners of a rectangle with half a gap around it, counter-clockwise, (4, 2)."""
    half = (np.array(plan) + MIN_GAP) / 2
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    turned: NDArray[np.float64] = corners @ turn + (x, y)
    return turned


def _apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return True (m,) where corners (…, 4, directions) and the others' do not overlap along some direction."""
    beyond = (one.max(axis=-2) <= other.min(axis=-2)) | (other.max(axis=-2) <= one.min(axis=-2))
    result: NDArray[np.bool_] = beyond.any(axis=-1)
    return result
