"""Lay a script with simulated tableware: boxes that satisfy it, filled with things of its kinds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from numbers import Integral
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.extras import require
from deixis.grammar.script import Script
from deixis.ontology.graph.facts import Fact
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Relation
from deixis.ontology.things.sizes import Extent, Outline, SizeRange
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.laying import (
    LINEN_CLOTH,
    WOOD,
    LaidTable,
    Placement,
    TableTop,
    lay,
    stood,
    top_under,
)
from deixis.perception.simulator.meshes.tableware import drawn_plan, form_of
from deixis.perception.simulator.scatter import scattered
from deixis.reasoning.entailment.realisation.picture import Impossible, Picture, Undecided, realise
from deixis.reasoning.entailment.realisation.verification import facts_that_hold
from deixis.reasoning.geometry.overlap import overlapping
from deixis.workflows.layouts.imagine import Sized, lying_across, sized_objects

if TYPE_CHECKING:
    from deixis.ontology.tbox import Ontology


def is_table(thing: Sized, ontology: Ontology) -> bool:
    """Return whether a thing is of a kind of table.

    Parameters
    ----------
    thing
        The thing with its kind.
    ontology
        The known kinds.

    Returns
    -------
    bool
        True for a table.
    """
    table = ontology.kinds.of_word("table")
    return thing.kind is not None and table is not None and ontology.kinds.is_a(thing.kind, table)


def all_on_it(graph: RelationGraph, tables: Sequence[bool]) -> tuple[RelationGraph, ...]:
    """Return a graph with the facts that everything is on the table that the script names.

    Objects that the script places beside the table, or on such objects, are left out.

    Parameters
    ----------
    graph
        The relation graph of the script.
    tables
        True for each node that is a table.

    Returns
    -------
    tuple of RelationGraph
        One graph, or nothing unless there is exactly one table.
    """
    if sum(tables) != 1:
        return ()
    on, table, facts = graph.vocabulary["on"], graph.nodes[tables.index(True)], list(graph.facts())
    beside = {table}
    while True:
        more = {name for fact in facts for name in _beside_table(fact, on, table, beside)} - beside
        if not more:
            break
        beside |= more
    facts += [Fact(name, (on,), table) for name in graph.nodes if name not in beside]
    return (RelationGraph.from_facts(graph.vocabulary, graph.nodes, facts, graph.kinds, graph.boxes, graph.colours),)


def _beside_table(fact: Fact, on: Relation, table: str, beside: Set[str]) -> Iterator[str]:
    """Yield the objects that a fact places beside the table, or on something beside it."""
    if not fact.positive:
        return
    if on in fact.relations:
        if fact.object != table and fact.object in beside:
            yield fact.subject
    elif table in (fact.subject, fact.object):
        yield fact.object if fact.subject == table else fact.subject


TIME_LIMIT = 30.0
TURN_DEVIATION = np.deg2rad(2.0)
"""Standard deviation of the random turn of each laid thing, in radians."""

MAX_DRAWS = 5
"""Maximum number of draws of other mugs and cups where the first ones do not fit."""

MAX_MESH_EXTENT = 1.5


class NoTableError(DeixisError, ValueError):
    """Error for a script that no table satisfies with things of usual size."""


class TimeIsUpError(DeixisError, TimeoutError):
    """Error for a time limit that was reached before a table was found or proved impossible."""


@dataclass(frozen=True, eq=False)
class LaidScript:
    """Laid table, and the facts of the script that do not hold there: hedged or optional facts that did not fit.

    ``top_name`` is the object of the script that is the table itself, not a thing on it.
    """

    table: LaidTable
    viewpoint: str = "chair"
    missed: tuple[Fact, ...] = ()
    top_name: str | None = None

    @property
    def beside(self) -> tuple[str, ...]:
        """Names of things that are not over the table's top, as the script says so or leaves no other place."""
        low, high = np.array(self.table.top.low), np.array(self.table.top.high)
        middles = {thing.name: thing.box[:, :2].mean(axis=0) for thing in self.table.things}
        return tuple(name for name, middle in middles.items() if not ((low <= middle) & (middle <= high)).all())


def lay_random(
    count: int,
    seed: int,
    meshes: Mapping[str, Mesh] | None = None,
    *,
    cloth: bool = False,
    ontology: Ontology | None = None,
) -> LaidScript:
    """Lay a table with random things at random places.

    Parameters
    ----------
    count
        Number of things.
    seed
        Seed of the kinds, sizes and places.
    meshes
        Further things, in metres with z up, by name.
    cloth
        True to lay a cloth.
    ontology
        The known kinds; default: the shipped ones.

    Returns
    -------
    LaidScript
        The table.
    """
    require("open3d", "simulating a table")
    require_seed(seed)
    foreign = [
        Placement(name, None, 0.0, 0.0, plan=_plan_of(mesh), mesh=mesh)
        for name, mesh in _check_meshes(meshes or {}).items()
    ]
    table = lay(scattered(count, seed, foreign=foreign, ontology=ontology), ontology=ontology)
    return LaidScript(replace(table, top=top_under(table.things, colour=_top_colour(cloth))))


def lay_script(
    script: Script,
    seed: int,
    meshes: Mapping[str, Mesh] | None = None,
    *,
    cloth: bool = False,
    time_limit: float = TIME_LIMIT,
) -> LaidScript:
    """Lay a table that satisfies every firm fact of a script, with things of their kinds, varied from the seed.

    Everything is turned a little off its axis, unless a fact would no longer hold. An object that is a table is the
    table top itself, and everything stands on it unless the script places it elsewhere.

    Parameters
    ----------
    script
        The script.
    seed
        Seed of the sizes, places and angles.
    meshes
        Meshes in metres with z up that stand for objects of the script, by name.
    cloth
        True to lay a cloth.
    time_limit
        Seconds for the search of places.

    Returns
    -------
    LaidScript
        The table.

    Raises
    ------
    NoTableError
        If no table satisfies the script.
    TimeIsUpError
        If the time limit leaves that open.
    SimulationError
        If a mesh stands for nothing in the script.
    """
    require("open3d", "simulating a table")
    require_seed(seed)
    meshes = _check_meshes(meshes or {})
    graph = script.graph().affirming()
    unknown = sorted(set(meshes) - set(graph.nodes))
    if unknown:
        raise SimulationError(
            f"there is a mesh for '{unknown[0]}', which is not an object of {script.file}; "
            f"its objects are {', '.join(graph.nodes)}"
        )
    plan = _plan_boxes(script, graph, meshes, seed, time_limit)
    laid = _lay_and_straighten(plan)
    table = replace(laid, top=_top(plan, laid, cloth))
    top_name = next((name for name, found in zip(graph.nodes, plan.tables, strict=True) if found), None)
    held = facts_that_hold(plan.graph, _boxes_as_laid(plan, table))
    missed = tuple(plan.graph.fact(int(edge)) for edge in np.flatnonzero(~held))
    return LaidScript(table, script.viewpoint or "chair", missed, top_name)


def require_seed(seed: int) -> None:
    """Raise SimulationError unless a seed is a whole number of at least 0.

    Parameters
    ----------
    seed
        The seed.

    Raises
    ------
    SimulationError
        If it is not.
    """
    if not isinstance(seed, Integral) or seed < 0:
        raise SimulationError(f"`seed` must be a whole number of at least 0, got {seed!r}")


@dataclass(frozen=True, eq=False)
class _Plan:
    """The objects of a script with a box in the plan for each, and the meshes that stand for some."""

    graph: RelationGraph
    objects: tuple[Sized, ...]
    boxes: NDArray[np.float64]  # (n, 2, 2)
    tables: tuple[bool, ...]
    meshes: Mapping[str, Mesh]
    seed: int
    ontology: Ontology


def _plan_boxes(
    script: Script, graph: RelationGraph, meshes: Mapping[str, Mesh], seed: int, time_limit: float
) -> _Plan:
    """Return boxes that satisfy the script, of the size of the things that will fill them."""
    ontology = script.ontology
    objects = sized_objects(script, graph)
    lying = lying_across(graph, objects, ontology.kinds)
    tables = tuple(is_table(thing, ontology) for thing in objects)
    graphs = (*all_on_it(graph, tables), graph)
    deadline = Deadline.after(time_limit)
    draws = MAX_DRAWS if any(form_of(thing.kind, ontology).handle for thing in objects) else 1
    for draw in range(draws):
        sizes = [
            _size_in_plan(thing, meshes.get(thing.name), _instance(seed, number) + draw, ontology)
            for number, thing in enumerate(objects)
        ]
        # The graphs share the time that is left; the first that has a picture decides.
        found: Picture | Impossible | Undecided | None = None
        for number, one in enumerate(graphs):
            part = deadline.share(1 / (len(graphs) - number))
            found = realise(one, sizes, lying=lying, deadline=part, rng=np.random.default_rng([seed, draw]))
            if isinstance(found, Picture):
                break
        if isinstance(found, Picture):
            return _Plan(graph, objects, found.boxes, tables, meshes, seed, ontology)
        if not isinstance(found, Impossible):
            raise TimeIsUpError(f"{script.file}: no table was found within {time_limit:g} seconds; give it more time")
    raise NoTableError(
        f"{script.file}: there is no such table with things of their usual sizes; 'deixis imagine' says why"
    )


def _size_in_plan(thing: Sized, mesh: Mesh | None, instance: int, ontology: Ontology) -> SizeRange:
    """Return how much room a thing takes in the plan: its usual size, but with the handle where there is one."""
    if mesh is not None:
        return _exactly(thing.size, *_plan_of(mesh))
    if form_of(thing.kind, ontology).handle:
        return _exactly(thing.size, *drawn_plan(thing.kind, instance, ontology))
    return thing.size


def _exactly(size: SizeRange, *sides: float) -> SizeRange:
    """Return a rectangle of these sides, rounded up to millimetres, as pictures are in whole ones."""
    width, length = (float(np.ceil(1000 * side - 1e-6) / 1000) for side in sorted(sides))
    return replace(
        size,
        outline=Outline.RECTANGLE,
        length=Extent(length, length, length),
        width=Extent(width, width, width),
    )


def _plan_of(mesh: Mesh) -> tuple[float, float]:
    across = np.ptp(mesh.vertices, axis=0)
    return float(across[0]), float(across[1])


def _instance(seed: int, number: int) -> int:
    """Return the seed of the thing with that number."""
    return int(np.random.SeedSequence([seed, number]).generate_state(1)[0])


def _lay_and_straighten(plan: _Plan) -> LaidTable:
    """Lay the things slightly turned; lay those straight that then violate a fact or overlap."""
    rng = np.random.default_rng([plan.seed, 1])
    turns = rng.normal(0.0, TURN_DEVIATION, len(plan.objects))
    while True:
        # What takes up more room is laid first: a thing on another is smaller, and is set down after it.
        area = np.prod(plan.boxes[:, 1] - plan.boxes[:, 0], axis=1)
        order = [i for i in np.argsort(-area, kind="stable").tolist() if not plan.tables[i]]
        laid = lay([_placement(plan, i, float(turns[i])) for i in order], ontology=plan.ontology)
        boxes = _boxes_as_laid(plan, laid)
        # Wrong are things in a fact that holds of the plan and no longer does, and those that come to overlap.
        broken = facts_that_hold(plan.graph, plan.boxes) & ~facts_that_hold(plan.graph, boxes)
        wrong = np.any(overlapping(boxes) & ~overlapping(plan.boxes), axis=1)
        wrong[plan.graph.subjects[broken]] = wrong[plan.graph.objects[broken]] = True
        wrong &= turns != 0
        if not wrong.any():
            by_name = {thing.name: thing for thing in laid.things}
            return replace(laid, things=tuple(by_name[name] for name in plan.graph.nodes if name in by_name))
        turns = np.where(wrong, 0.0, turns)


def _placement(plan: _Plan, number: int, turn: float) -> Placement:
    """Return a thing in the middle of its box, its head away from the viewer or to the left, a handle anywhere."""
    thing, (low, high) = plan.objects[number], plan.boxes[number]
    x, y = ((low + high) / 2).tolist()
    across, deep = (high - low).tolist()
    seed, mesh = _instance(plan.seed, number), plan.meshes.get(thing.name)
    kind = thing.kind.label if thing.kind else None
    if mesh is not None:
        sides = _plan_of(mesh)
        crosswise = (sides[0] > sides[1]) != (across > deep) and abs(across - deep) > 1e-9
        return Placement(thing.name, kind, x, y, turn + (np.pi / 2 if crosswise else 0.0), seed, mesh=mesh)
    lies = across > deep
    turned_round = form_of(thing.kind, plan.ontology).handle and seed % 2 == 1
    yaw = (np.pi / 2 if lies else 0.0) + (np.pi if turned_round else 0.0)
    return Placement(thing.name, kind, x, y, yaw + turn, seed, plan=(min(across, deep), max(across, deep)))


def _boxes_as_laid(plan: _Plan, laid: LaidTable) -> NDArray[np.float64]:
    """Return the boxes of all objects in the plan (n, 2, 2), as they came to lie."""
    boxes = plan.boxes.copy()
    number = {name: i for i, name in enumerate(plan.graph.nodes)}
    for thing in laid.things:
        boxes[number[thing.name]] = thing.box[:, :2]
    return boxes


def _top(plan: _Plan, laid: LaidTable, cloth: bool) -> TableTop:
    """Return the table that the script speaks of, else one that reaches a little beyond everything.

    The former carries all that was planned to be on it; its edge moves a little where a turned thing reaches over it.
    """
    colour = _top_colour(cloth)
    spoken_of = [i for i, found in enumerate(plan.tables) if found]
    if len(spoken_of) > 1:
        names = " and ".join(plan.graph.nodes[i] for i in spoken_of[:2])
        raise SimulationError(f"{names} are tables, and only one table can be simulated; leave one of them out")
    if not spoken_of:
        return top_under(laid.things, colour=colour)
    low, high = plan.boxes[spoken_of[0]]
    over = [
        name
        for name, box in zip(plan.graph.nodes, plan.boxes, strict=True)
        if (box[0] >= low).all() and (box[1] <= high).all()
    ]
    boxes = [thing.box[:, :2] for thing in laid.things if thing.name in over]
    x0, y0 = np.min([low, *(box[0] for box in boxes)], axis=0).tolist()
    x1, y1 = np.max([high, *(box[1] for box in boxes)], axis=0).tolist()
    return TableTop((x0, y0), (x1, y1), colour=colour)


def _top_colour(cloth: bool) -> tuple[int, int, int]:
    return LINEN_CLOTH if cloth else WOOD


def _check_meshes(meshes: Mapping[str, Mesh]) -> dict[str, Mesh]:
    """Return the meshes, standing on z = 0; raises SimulationError for one that cannot be in metres."""
    standing = {}
    for name, mesh in meshes.items():
        try:
            standing[name] = stood(mesh)
        except SimulationError as error:
            raise SimulationError(f"'{name}': {error}") from error
        extents = np.ptp(mesh.vertices, axis=0)
        if extents.max() > MAX_MESH_EXTENT or extents.max() < 1e-3:
            raise SimulationError(
                f"the mesh of '{name}' measures {extents.max():g} m; state the unit that its file is in"
            )
    return standing
