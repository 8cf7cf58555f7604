"""Provide the cases that engines are compared on: generated tables and photographs, in random orders of both sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.cross_validation import learned_meanings
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.experiments.photographs import photographs
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.grounding.evidence.evidence import Evidence, evidence_from
from deixis.reasoning.grounding.evidence.words.meaning import Meaning

PHOTOGRAPHS = 0
"""Number of objects that stands for photographs, which have any number."""


LARGEST_PHOTOGRAPH = 12
"""Objects that an engine must be able to take to enter the photographs, so that all are compared on the same ones."""


@dataclass(frozen=True, order=True, slots=True)
class Setting:
    """The settings of a generated table; all 0 for photographs."""

    objects: int
    off: float
    facts_each: float
    changed: bool  # a tenth of the described pieces is missing, and as many undescribed ones are added

    @property
    def size(self) -> int:
        """Number of objects that an engine must be able to take."""
        return self.objects if self.objects != PHOTOGRAPHS else LARGEST_PHOTOGRAPH

    @property
    def group(self) -> Group:
        """The size and the noise."""
        return Group(self.objects, self.off)


@dataclass(frozen=True, order=True, slots=True)
class Group:
    """A size and a noise: the cases over which means are taken and differences tested."""

    objects: int
    off: float

    def __str__(self) -> str:
        return "photographs" if self.objects == PHOTOGRAPHS else f"{self.objects} objects, {100 * self.off:.0f} % off"


@dataclass(frozen=True, eq=False)
class Case:
    """A description of n1 objects, n2 boxes, and the truth. Cases of the same unit differ only in the order."""

    setting: Setting
    unit: int
    description: RelationGraph
    boxes: NDArray[np.float64]  # (n2, 2, 2): minimum and maximum corner
    things: tuple[str, ...]  # (n2,): the names of the boxes, which distinguish equal boxes in any order
    truth: NDArray[np.int64]  # (n1,): the thing of each object, UNMATCHED if it is missing
    metric: bool = True  # True if boxes are in metres
    learned: Meaning | None = None  # learned from other cases

    @cached_property
    def scene(self) -> SceneRelations:
        """The perceived scene: the exact relation of every ordered pair."""
        return scene_relations(self.things, self.boxes, self.description.vocabulary)

    def evidence(self, meaning: Meaning, learned: bool = False) -> Evidence:
        """Return the input of an engine: facts, and sizes if the description states kinds; without labels.

        Parameters
        ----------
        meaning
            Meaning of the words and weights of the evidence.
        learned
            True to use the words and sizes that were learned from other cases, by the weights of the meaning.

        Returns
        -------
        Evidence
            Evidence about n1 objects and n2 things.
        """
        if learned and self.learned is not None:
            meaning = replace(self.learned, weights=meaning.weights)
        ontology, unlabelled = default_ontology(), [None] * len(self.boxes)
        return evidence_from(
            self.description,
            self.scene,
            unlabelled,
            ontology.kinds,
            ontology.sizes,
            metric=self.metric,
            meaning=meaning,
        )

    def shuffled(self, rng: np.random.Generator) -> Case:
        """Return the same case in a random order of objects and of things.

        Parameters
        ----------
        rng
            Random generator of the order.

        Returns
        -------
        Case
            Case whose ``truth`` refers to the new order.
        """
        rows, columns = rng.permutation(len(self.truth)), rng.permutation(len(self.boxes))
        place = np.append(np.argsort(columns), -1)  # position of each thing in the new order; the last is for UNMATCHED
        nodes = [self.description.nodes[i] for i in rows]
        return Case(
            self.setting,
            self.unit,
            self.description.subgraph(nodes),
            self.boxes[columns],
            tuple(self.things[p] for p in columns),
            place[self.truth[rows]],
            self.metric,
            self.learned,
        )


def _names(count: int) -> tuple[str, ...]:
    return tuple(f"o{p:04}" for p in range(count))


def table(setting: Setting, number: int, seed: int) -> GeneratedTable:
    """Return table ``number`` of a setting; tables of different settings are drawn independently.

    Parameters
    ----------
    setting
        Number of objects, share of wrong facts, facts per object, and whether things are missing and extra.
    number
        Number of the table.
    seed
        Seed of the experiment.

    Returns
    -------
    GeneratedTable
        The same table for the same arguments.
    """
    drawn = np.random.SeedSequence(
        [
            seed,
            setting.objects,
            round(1000 * setting.facts_each),
            round(1000 * setting.off),
            int(setting.changed),
            number,
        ]
    )
    out = max(1, round(setting.objects / 10)) if setting.changed else 0
    return generate(
        setting.objects, setting.facts_each, setting.off, out, out, seed=int(drawn.generate_state(1, np.uint64)[0])
    )


def generated_cases(settings: Sequence[Setting], count: int, seed: int, *, kinds: bool = False) -> Iterator[Case]:
    """Yield generated tables of each setting, in a random order of objects and things.

    Parameters
    ----------
    settings
        Settings of the tables.
    count
        Number of tables of each setting.
    seed
        Seed of the tables and of the orders.
    kinds
        True if the descriptions state the kind of each object.

    Yields
    ------
    Case
        One case for each table.
    """
    for setting in settings:
        for number in range(count):
            drawn = table(setting, number, seed)
            rng = np.random.default_rng([seed, number, setting.objects])
            description, things = drawn.description(kinds=kinds), _names(len(drawn.boxes))
            yield Case(setting, number, description, drawn.boxes, things, drawn.truth).shuffled(rng)


def photograph_cases(folder: Path, orders: int, most: int | None, seed: int, *, learn: bool = False) -> Iterator[Case]:
    """Yield photographs, each in several random orders of objects and things.

    Parameters
    ----------
    folder
        Folder of the annotations.
    orders
        Number of orders of each photograph.
    most
        Maximum number of photographs, or None for all.
    seed
        Seed of the orders and of the folds.
    learn
        True to add the meanings that were learned from the photographs of other folds.

    Yields
    ------
    Case
        One case for each photograph and order; its boxes are in pixels.

    Raises
    ------
    PhotographError
        If the files are not annotations of photographs.
    """
    setting = Setting(PHOTOGRAPHS, 0.0, 0.0, False)
    images = list(photographs(folder, default_ontology()))
    learned = learned_meanings(images, seed) if learn else [None] * len(images)
    for unit, ((description, boxes), taught) in enumerate(zip(images[:most], learned[:most], strict=True)):
        names, truth = _names(len(boxes)), np.arange(len(boxes))
        case = Case(setting, unit, description, boxes, names, truth, metric=False, learned=taught)
        for order in range(orders):
            yield case.shuffled(np.random.default_rng([seed, unit, order]))
