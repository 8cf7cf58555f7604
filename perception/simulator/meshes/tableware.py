"""Make tableware of every kind: shapes, sizes and colours, varied by a seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from deixis.ontology.tbox import Ontology, default_ontology
from deixis.ontology.things.kinds import Kind
from deixis.ontology.things.sizes import Extent, Outline, SizeRange
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.meshes.blocks import block, cylinder, napkin
from deixis.perception.simulator.meshes.crockery import (
    bottle,
    bowl,
    champagne_glass,
    cup,
    jug,
    lidded_bowl,
    mug,
    plate,
    teapot,
    tumbler,
    water_glass,
    wine_glass,
)
from deixis.perception.simulator.meshes.cutlery import fork, knife, spoon
from deixis.perception.simulator.meshes.size import Size, drawn_size
from deixis.perception.simulator.meshes.solids import fitted

Colour = tuple[int, int, int]

WHITE, CREAM, BLUE_WARE, GREY_WARE = (238, 238, 234), (232, 224, 204), (160, 184, 206), (172, 172, 168)
STEEL, BRIGHT_STEEL = (176, 178, 184), (198, 200, 204)
FROST, GREEN_GLASS, BLUE_GLASS = (196, 214, 220), (60, 92, 66), (150, 184, 206)
WINE_RED, NAVY, MOSS, SAND = (140, 44, 52), (50, 66, 110), (98, 120, 78), (206, 178, 140)


@dataclass(frozen=True)
class Form:
    """Shape of a kind of things.

    ``handle`` is True if the shape has a handle, which the usual sizes do not include. ``height`` replaces the usual
    heights if the shape is only one form of the kind. A ``soft`` shape drapes. ``generic`` is True for a shape that
    represents kinds without their own.
    """

    name: str
    build: Callable[[Size, np.random.Generator], Mesh]
    colours: tuple[Colour, ...]
    handle: bool = False
    height: Extent | None = None
    soft: bool = False
    generic: bool = False


_CHINA = (WHITE, WHITE, CREAM, BLUE_WARE)
_STONEWARE = (WHITE, BLUE_WARE, GREY_WARE, WINE_RED, MOSS)
_METAL = (STEEL, BRIGHT_STEEL)
_GLASS = (FROST, BLUE_GLASS)

FORMS: dict[str, Form] = {
    "Plate": Form("plate", plate, _CHINA),
    "Bowl": Form("bowl", bowl, _CHINA),
    "Cup": Form("cup", cup, _CHINA, handle=True),
    "Mug": Form("mug", mug, _STONEWARE, handle=True),
    "Jug": Form("jug", jug, _CHINA, handle=True),
    "MilkJug": Form("jug", jug, _CHINA),
    "Creamer": Form("jug", jug, _CHINA),
    "Pot": Form("teapot", teapot, _STONEWARE),
    "Kettle": Form("teapot", teapot, _METAL),
    "SugarBowl": Form("lidded bowl", lidded_bowl, _CHINA),
    "Glassware": Form("tumbler", tumbler, _GLASS),
    "WaterGlass": Form("water glass", water_glass, _GLASS),
    "WineGlass": Form("wine glass", wine_glass, _GLASS),
    "ChampagneGlass": Form("champagne glass", champagne_glass, _GLASS),
    "Fork": Form("fork", fork(), _METAL),
    "DessertFork": Form("fork of three tines", fork(tines=3), _METAL),
    "Knife": Form("knife", knife(), _METAL),
    "FishKnife": Form("fish knife", knife(blade=0.42, grip=0.55, pointed=True), _METAL),
    "ButterKnife": Form("butter knife", knife(blade=0.5, grip=0.62), _METAL),
    "Spoon": Form("spoon", spoon(), _METAL),
    "SoupSpoon": Form("round spoon", spoon(roundness=0.7), _METAL),
    "Napkin": Form("napkin", napkin, (WINE_RED, NAVY, MOSS, SAND), height=Extent(0.003, 0.007, 0.015), soft=True),
    "Bottle": Form("bottle", bottle, (GREEN_GLASS, BLUE_GLASS)),
    "Carafe": Form("bottle", bottle, _GLASS),
}
"""Shapes by the name of the kind in the TBox; they also apply to narrower kinds without a shape of their own."""

_OTHER = (SAND, GREY_WARE, MOSS, CREAM)
CYLINDER = Form("cylinder", cylinder, _OTHER, generic=True)
BLOCK = Form("block", block, _OTHER, generic=True)
"""Shape for kinds without their own that are not round."""


@dataclass(frozen=True, eq=False)
class Instance:
    """A generated thing: its mesh stands on z = 0, centred on the z axis, with its head or handle along y."""

    mesh: Mesh
    colour: Colour
    form: Form
    size: Size


def kind_named(word: str, ontology: Ontology) -> Kind:
    """Return the kind that a word or a name stands for.

    Parameters
    ----------
    word
        Word, such as ``dinner plate``.
    ontology
        Ontology with the kinds.

    Returns
    -------
    Kind
        Kind of the ontology.

    Raises
    ------
    SimulationError
        If the ontology has no kind for the word.
    """
    kind = ontology.kinds.of_word(word)
    if kind is None:
        raise SimulationError(f"the ontology has no kind of thing called '{word}'; try 'dinner plate' or 'fork'")
    return kind


def form_of(kind: Kind | None, ontology: Ontology) -> Form:
    """Return the shape of the nearest broader kind with one, or else a cylinder or a block, by the kind's outline.

    Parameters
    ----------
    kind
        Kind of the thing; None for an unknown one.
    ontology
        Ontology with the broader kinds and the outlines.

    Returns
    -------
    Form
        Shape with its builder and colours.

    Examples
    --------
    >>> ontology = default_ontology()
    >>> [form_of(ontology.kinds.of_word(word), ontology).name for word in ("salad fork", "vase")]
    ['fork', 'cylinder']
    """
    if kind is not None:
        near = [kind, *sorted((ontology.kinds[iri] for iri in kind.broader), key=lambda k: (-len(k.broader), k.iri))]
        found = next((FORMS[k.name] for k in near if k.name in FORMS), None)
        if found is not None:
            return found
    usual = ontology.sizes.of(kind.iri if kind else None)
    return CYLINDER if usual.outline is Outline.CIRCLE else BLOCK


def usual_size(kind: Kind | None, ontology: Ontology) -> SizeRange:
    """Return the range of sizes of generated things: the usual sizes of the kind, with the height of its shape.

    Parameters
    ----------
    kind
        Kind of the thing; None for an unknown one.
    ontology
        Ontology with the usual sizes.

    Returns
    -------
    SizeRange
        Ranges in metres.
    """
    usual = ontology.sizes.of(kind.iri if kind else None)
    form = form_of(kind, ontology)
    return usual if form.height is None else replace(usual, height=form.height)


def make(
    kind: str | None, seed: int, plan: tuple[float, float] | None = None, ontology: Ontology | None = None
) -> Instance:
    """Make one thing of a kind.

    Parameters
    ----------
    kind
        Word for the kind; None for an unknown kind.
    seed
        Seed of shape, size and colour: equal seeds give equal things.
    plan
        Width and length (with the handle) in metres; by default both are drawn from the usual sizes, as the height is.
    ontology
        Kinds and their sizes; by default :func:`default_ontology`.

    Returns
    -------
    Instance
        Thing that stands on z = 0, centred on the z axis.

    Raises
    ------
    SimulationError
        If the kind is not known, or the sides of ``plan`` are not above 0.

    Examples
    --------
    >>> thing = make("dinner plate", seed=1)
    >>> 0.229 <= thing.size.width <= 0.305, thing.form.name
    (True, 'plate')
    """
    ontology = ontology or default_ontology()
    found = None if kind is None else kind_named(kind, ontology)
    if plan is not None and not all(0 < side < np.inf for side in plan):
        raise SimulationError(f"a thing's width and length must be above 0, got {plan[0]:g} and {plan[1]:g}")
    form, rng = form_of(found, ontology), np.random.default_rng(seed)
    size = _size(form, usual_size(found, ontology), rng, plan)
    red, green, blue = np.clip(
        np.array(form.colours[int(rng.integers(len(form.colours)))]) * rng.uniform(0.92, 1.04) + rng.normal(0, 3, 3),
        0,
        255,
    ).astype(int)
    colour = int(red), int(green), int(blue)
    mesh = fitted(form.build(size, rng), size.width, size.length, size.height)
    return Instance(mesh, colour, form, size)


def drawn_plan(kind: Kind | None, seed: int, ontology: Ontology) -> tuple[float, float]:
    """Return width and length of the thing that :func:`make` returns for a seed.

    Parameters
    ----------
    kind
        Kind of the thing; None for an unknown one.
    seed
        Seed of the thing.
    ontology
        Ontology with the usual sizes.

    Returns
    -------
    tuple
        Width and length in metres.
    """
    size = _size(form_of(kind, ontology), usual_size(kind, ontology), np.random.default_rng(seed), None)
    return size.width, size.length


def _size(form: Form, usual: SizeRange, rng: np.random.Generator, plan: tuple[float, float] | None) -> Size:
    reach = 1.0
    if form.handle and usual.reach is not None:
        reach += rng.uniform(usual.reach.least, usual.reach.greatest)
    size = drawn_size(usual, rng, plan)
    return size if plan is not None else Size(size.width, size.length * reach, size.height)
