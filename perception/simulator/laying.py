"""Lay a table: placements become things in the table's frame, set down one after the other.

The table's top is the plane z = 0; x points to the right of a person at the table, and y away from that person. A thing
comes to rest on the things below it: stiff things are lowered until they touch, and soft ones drape. The ground truth
of a laid table is the scene that perception should find.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.tbox import Ontology, default_ontology
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.scene import DEFAULT_VIEWPOINT, PerceivedObject, Scene
from deixis.perception.simulator.meshes.blocks import CLOTH_CELL
from deixis.perception.simulator.meshes.rays import RayCaster
from deixis.perception.simulator.meshes.solids import moved
from deixis.perception.simulator.meshes.tableware import Colour, make

CLEARANCE = 0.0002
"""Gap in metres between things that touch, since heights are compared at some places only."""

HEIGHT_STEP = 0.002
"""Distance in metres between the places where heights are compared, in addition to the vertices."""

PlanBox = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Minimum and maximum corner (2,) in plan."""


def overlap_in_plan(box: PlanBox, other: PlanBox) -> bool:
    """Return True if two boxes overlap in plan.

    Parameters
    ----------
    box, other
        Lower and upper corner of each box in plan, in metres.

    Returns
    -------
    bool
        False for boxes that only touch.
    """
    return bool((box[0] < other[1]).all() and (other[0] < box[1]).all())


def plan_box(mesh: Mesh) -> PlanBox:
    """Return the box around a mesh in plan.

    Parameters
    ----------
    mesh
        Mesh with at least one vertex.

    Returns
    -------
    PlanBox
        Lower and upper corner in plan, each of shape (2,), in metres.
    """
    return mesh.vertices[:, :2].min(axis=0), mesh.vertices[:, :2].max(axis=0)


def lowered(mesh: Mesh, below: Sequence[Mesh]) -> Mesh:
    """Return a stiff thing that stands on z = 0, raised without tilting until it rests on the meshes below.

    Parameters
    ----------
    mesh
        Mesh of the thing, which stands on z = 0.
    below
        Meshes of the things that lie there already.

    Returns
    -------
    Mesh
        The mesh, raised by at least ``CLEARANCE`` above what it rests on; unchanged if nothing is below it.
    """
    if not below:
        return mesh
    lower, upper = RayCaster(below), RayCaster([mesh])
    plan = _places([mesh, *below], *plan_box(mesh))
    overlap = lower.tops(plan) - upper.bottoms(plan)
    overlap = overlap[np.isfinite(overlap)]
    return moved(mesh, by=(0.0, 0.0, max(float(overlap.max()) + CLEARANCE, 0.0))) if len(overlap) else mesh


def draped(mesh: Mesh, below: Sequence[Mesh], cell: float) -> Mesh:
    """Return a soft thing that lies on z = 0, with each vertex raised by the height of the meshes below it.

    The height below a vertex is that of the highest place within the length of an edge along each axis, so that no face
    cuts into the meshes.

    Parameters
    ----------
    mesh
        Mesh of the thing.
    below
        Meshes of the things that lie there already.
    cell
        Side in metres of the cells of the mesh: no edge may be longer in plan than this times the square root of 2.

    Returns
    -------
    Mesh
        The raised mesh.
    """
    from scipy.ndimage import map_coordinates, maximum_filter

    if not below:
        return mesh
    fine = cell / 2
    reach = int(np.ceil(np.sqrt(2) * cell / fine)) + 1
    low, high = plan_box(mesh)
    axes = [np.arange(low[axis] - reach * fine, high[axis] + reach * fine, fine) for axis in (0, 1)]
    x, y = np.meshgrid(*axes, indexing="ij")
    heights = np.nan_to_num(RayCaster(below).tops(np.column_stack([x.ravel(), y.ravel()])), nan=0.0).reshape(x.shape)
    _raise_to_vertices(heights, below, low=np.array([axes[0][0], axes[1][0]]), fine=fine)
    under = maximum_filter(np.maximum(heights, 0.0), size=2 * reach + 1)
    at = [(mesh.vertices[:, axis] - axes[axis][0]) / fine for axis in (0, 1)]
    raised = map_coordinates(under, at, order=1, mode="nearest")
    lift = np.column_stack([0 * raised, 0 * raised, raised + CLEARANCE * (raised > 0)])
    return Mesh(mesh.vertices + lift, mesh.faces)


def _raise_to_vertices(
    heights: NDArray[np.float64], meshes: Sequence[Mesh], low: NDArray[np.float64], fine: float
) -> None:
    """Raise a grid of heights to the vertices nearest to its points, so that no rim between the points is missed."""
    for mesh in meshes:
        cell = np.rint((mesh.vertices[:, :2] - low) / fine).astype(np.int64)
        there = ((cell >= 0) & (cell < heights.shape)).all(axis=1)
        np.maximum.at(heights, (cell[there, 0], cell[there, 1]), mesh.vertices[there, 2])


def _places(meshes: Sequence[Mesh], low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the points of a grid over a part of the plan, and the vertices in that part."""
    axes = [np.linspace(low[axis], high[axis], int((high[axis] - low[axis]) / HEIGHT_STEP) + 2) for axis in (0, 1)]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    vertices = np.concatenate([mesh.vertices[:, :2] for mesh in meshes])
    inside = ((vertices >= low) & (vertices <= high)).all(axis=1)
    return np.concatenate([grid, vertices[inside]])


WOOD: Colour = (150, 112, 78)
LINEN_CLOTH: Colour = (226, 222, 212)
FOREIGN_COLOUR: Colour = (186, 150, 90)
"""Colour of a mesh from a file."""

MARGIN = 0.15
"""Default distance in metres by which a table extends beyond the things on it."""


@dataclass(frozen=True)
class Placement:
    """A thing to lay: its kind, the centre (x, y) of its box before it is turned, and the seed of its shape.

    ``yaw`` is in radians, counter-clockwise from above; at 0 a head or a handle points away from the viewer. ``plan``
    sets width and length (metres) instead of the seed. ``mesh`` (metres, z up) is laid instead of a generated shape.
    """

    name: str
    kind: str | None
    x: float
    y: float
    yaw: float = 0.0
    seed: int = 0
    plan: tuple[float, float] | None = None
    mesh: Mesh | None = None


@dataclass(frozen=True, eq=False)
class LaidThing:
    """A thing on the table: its mesh in the table's frame, and the name of its shape.

    ``generic`` is True if its kind has no shape of its own, so that a block or a cylinder represents it.
    """

    name: str
    kind: str | None
    mesh: Mesh
    colour: Colour
    shape: str
    generic: bool = False

    @property
    def box(self) -> NDArray[np.float64]:
        """Minimum and maximum corner in the table's frame, (2, 3), rounded to micrometres to keep contacts."""
        corners: NDArray[np.float64] = np.stack([self.mesh.vertices.min(axis=0), self.mesh.vertices.max(axis=0)])
        return corners.round(6) + 0.0


@dataclass(frozen=True)
class TableTop:
    """Top of a table: a slab below z = 0 from ``low`` (x0, y0) to ``high`` (x1, y1), in metres, with a colour."""

    low: tuple[float, float]
    high: tuple[float, float]
    thickness: float = 0.03
    colour: Colour = WOOD

    def __post_init__(self) -> None:
        if not (self.low[0] < self.high[0] and self.low[1] < self.high[1] and self.thickness > 0):
            raise SimulationError(
                f"a table must not be empty, got {self.low} to {self.high}, {self.thickness:g} m thick"
            )

    @property
    def mesh(self) -> Mesh:
        """Mesh of the slab."""
        (x0, y0), (x1, y1) = self.low, self.high
        corners = [(x, y, z) for z in (-self.thickness, 0.0) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
        quads = ((3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
        faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
        return Mesh(np.array(corners), np.array(faces, dtype=np.int32))


@dataclass(frozen=True)
class LaidTable:
    """A laid table: its top, and the things on it in the order of their numbers."""

    top: TableTop
    things: tuple[LaidThing, ...]


def lay(placements: Iterable[Placement], top: TableTop | None = None, ontology: Ontology | None = None) -> LaidTable:
    """Set things down in order, each on the table or on the things that lie there already.

    Stiff things stay level and are lowered until they touch; cloth drapes. Things therefore never intersect, and those
    below must come first.

    Parameters
    ----------
    placements
        Things to lay.
    top
        Top of the table; by default it extends a little beyond the things.
    ontology
        Kinds and their sizes; by default :func:`default_ontology`.

    Returns
    -------
    LaidTable
        Table whose things have meshes and boxes in its frame, in metres.

    Raises
    ------
    SimulationError
        If a name is used twice, a kind is not known, or a position is not finite.
    """
    ontology = ontology or default_ontology()
    things: list[LaidThing] = []
    boxes: list[PlanBox] = []
    for placement in placements:
        things.append(_set_down(placement, things, boxes, ontology))
        boxes.append(plan_box(things[-1].mesh))
    return LaidTable(top or top_under(things), tuple(things))


def set_down(placement: Placement, things: Sequence[LaidThing], ontology: Ontology | None = None) -> LaidThing:
    """Return a thing set down on the table or on the things that lie there already.

    Parameters
    ----------
    placement
        Thing to set down.
    things
        Things that lie there already.
    ontology
        Kinds and their sizes; by default :func:`default_ontology`.

    Returns
    -------
    LaidThing
        The thing with its mesh in the table's frame, in metres.

    Raises
    ------
    SimulationError
        If its name is used already, its kind is not known, or its position is not finite.
    """
    return _set_down(placement, things, [plan_box(thing.mesh) for thing in things], ontology or default_ontology())


def _set_down(
    placement: Placement, things: Sequence[LaidThing], boxes: Sequence[PlanBox], ontology: Ontology
) -> LaidThing:
    if any(thing.name == placement.name for thing in things):
        raise SimulationError(f"'{placement.name}' is placed twice; give every thing its own name")
    if not np.isfinite([placement.x, placement.y, placement.yaw]).all():
        raise SimulationError(
            f"the place of '{placement.name}' must be finite, got {placement.x}, {placement.y}, yaw {placement.yaw}"
        )
    laid, soft = _upright(placement, ontology)
    mesh = moved(laid.mesh, placement.yaw, by=(placement.x, placement.y, 0.0))
    own = plan_box(mesh)
    below = [other.mesh for other, box in zip(things, boxes, strict=True) if overlap_in_plan(own, box)]
    return replace(laid, mesh=draped(mesh, below, CLOTH_CELL) if soft else lowered(mesh, below))


def _upright(placement: Placement, ontology: Ontology) -> tuple[LaidThing, bool]:
    """Return the thing at the origin, and True if it is soft."""
    name, kind = placement.name, placement.kind
    if placement.mesh is not None:
        return LaidThing(name, kind, stood(placement.mesh), FOREIGN_COLOUR, "mesh from a file"), False
    made = make(kind, placement.seed, placement.plan, ontology)
    return LaidThing(name, kind, made.mesh, made.colour, made.form.name, made.form.generic), made.form.soft


def stood(mesh: Mesh) -> Mesh:
    """Return the mesh moved so that its box stands on z = 0, centred on the z axis.

    Parameters
    ----------
    mesh
        Mesh in metres, with z up.

    Returns
    -------
    Mesh
        Mesh with equal faces.

    Raises
    ------
    SimulationError
        If the mesh has no faces, or its vertices are not all finite.
    """
    if not len(mesh.faces) or not np.isfinite(mesh.vertices).all():
        raise SimulationError("a mesh must have faces and finite vertices")
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    middle = (low + high) / 2
    return Mesh(mesh.vertices - (middle[0], middle[1], low[2]), mesh.faces)


def top_under(things: Sequence[LaidThing], margin: float = MARGIN, colour: Colour = WOOD) -> TableTop:
    """Return the top of a table that extends beyond all things.

    Parameters
    ----------
    things
        Things on the table; without any, the top is 1 m wide and 0.7 m deep.
    margin
        Distance in metres from the things to the edge of the table.
    colour
        Colour of the table.

    Returns
    -------
    TableTop
        Rectangle in plan, in metres.
    """
    if not things:
        return TableTop((-0.5, -0.35), (0.5, 0.35), colour=colour)
    boxes = [plan_box(thing.mesh) for thing in things]
    low, high = np.min([box[0] for box in boxes], axis=0) - margin, np.max([box[1] for box in boxes], axis=0) + margin
    return TableTop((float(low[0]), float(low[1])), (float(high[0]), float(high[1])), colour=colour)


def truth_scene(table: LaidTable, viewpoint: str = DEFAULT_VIEWPOINT) -> Scene:
    """Return the true scene: every thing with its name and its box in the table's frame.

    The object ``o3`` is the thing whose points have label 3.

    Parameters
    ----------
    table
        Table with its things.
    viewpoint
        Name of the side from which the scene is seen.

    Returns
    -------
    Scene
        Objects ``o1``, ``o2`` and so on. The object ``o3`` is the thing whose points have label 3.
    """
    things = []
    for number, thing in enumerate(table.things, start=1):
        low, high = thing.box.tolist()
        things.append(PerceivedObject(f"o{number}", tuple(low), tuple(high), label=thing.name))
    return Scene(tuple(things), viewpoint=viewpoint, file="<simulated table>")
