"""Subject matter of questions: described objects, perceived things, their relations, and the known facts."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Reading, Relation
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.rectangle import SceneRelations

PLACES = (
    ("at the far left", 0, -1),
    ("at the far right", 0, 1),
    ("nearest to the viewer", 1, -1),
    ("farthest from the viewer", 1, 1),
)

MIN_REACH_SHARE = 0.02
"""Minimum lead of the outermost thing over the next one, as a share of the scene's extent."""


@dataclass(frozen=True, eq=False)
class Situation:
    """n1 objects, n2 things, and the R relations in their wide reading that questions may use."""

    objects: tuple[str, ...]  # (n1,)
    things: tuple[str, ...]  # (n2,)
    relations: tuple[Relation, ...]  # (R,)
    degrees: NDArray[np.float64]  # (R, n2, n2): 1 the pair's exact name, 0.5 holds only widely, 0 does not hold
    settled: NDArray[np.bool_]  # (R, n1, n1): the script states, implies or excludes it
    centres: NDArray[np.float64]  # (n2, 2)
    places: tuple[str | None, ...]  # (n2,): description of the thing by its place, or None

    @cached_property
    def apart(self) -> NDArray[np.float64]:
        """Distances of things as a share of the largest distance, shape (n2, n2)."""
        distance = np.linalg.norm(self.centres[:, None] - self.centres[None], axis=2)
        share: NDArray[np.float64] = distance / max(float(distance.max(initial=0.0)), 1e-300)
        return share

    def place(self, thing: int) -> str:
        """Return the words for a thing in a question: its place and its id, or its id alone.

        Parameters
        ----------
        thing
            Position of the thing.

        Returns
        -------
        str
            Words such as *the thing at the far left (p3)*.
        """
        where = self.places[thing]
        return f"the thing {where} ({self.things[thing]})" if where else f"the thing {self.things[thing]}"


def situation_of(description: RelationGraph, scene: SceneRelations, implied: Implications | None = None) -> Situation:
    """Return the situation of a description and a scene.

    Parameters
    ----------
    description
        The objects and the facts.
    scene
        The things with their boxes and relations.
    implied
        Facts that the description implies; None where they are not known.

    Returns
    -------
    Situation
        Properties of both that questions need.

    Raises
    ------
    SettingError
        The scene has no boxes.
    """
    if scene.boxes is None:
        raise SettingError("questions need a scene with boxes, and this scene has none")
    relations = description.vocabulary.of_reading(Reading.WIDE)
    table = np.concatenate([description.vocabulary.degrees, np.zeros((len(description.vocabulary), 1))], axis=1)
    degrees = np.stack([table[relation.index][scene.names] for relation in relations])
    centres = scene.boxes.mean(axis=1)[:, :2]
    settled = _settled(description, relations, implied or Implications(description))
    # the outermost box in each direction, if its lead is clear
    found: list[str | None] = [None] * len(scene.boxes)
    for words, axis, side in PLACES:
        reach = side * scene.boxes[:, (1 + side) // 2, axis]
        if len(reach) > 1:
            order = np.argsort(-reach, kind="stable")
            if (
                reach[order[0]] - reach[order[1]] > MIN_REACH_SHARE * np.ptp(scene.boxes[:, :, axis])
                and found[order[0]] is None
            ):
                found[order[0]] = words
    return Situation(description.nodes, scene.nodes, relations, degrees, settled, centres, tuple(found))


def _settled(description: RelationGraph, relations: tuple[Relation, ...], implied: Implications) -> NDArray[np.bool_]:
    """Return the mask (R, n1, n1) of relations that hold in all pictures of the facts, or that these exclude."""
    n = len(description.nodes)
    holds = np.zeros((len(relations), n, n), dtype=bool)
    for row, relation in enumerate(relations):
        pairs = implied.pairs(relation)
        holds[row, pairs[:, 0], pairs[:, 1]] = True
    denied = np.zeros_like(holds)
    for edge in implied.demands.firm.tolist():
        mask, subject, obj = (
            int(array[edge]) for array in (description.relation_sets, description.subjects, description.objects)
        )
        for row, relation in enumerate(relations):
            if mask & relation.bit and not description.positive[edge]:
                denied[row, subject, obj] = True
            elif mask == relation.bit:
                holds[row, subject, obj] = True
    excluded = np.array(
        [[(a.x_atoms & b.x_atoms == 0 or a.y_atoms & b.y_atoms == 0) for b in relations] for a in relations]
    )
    ruled_out: NDArray[np.bool_] = np.einsum("ab,bij->aij", excluded.astype(np.int64), holds.astype(np.int64)) > 0
    backwards = [relations.index(description.vocabulary[relation.inverse]) for relation in relations]
    known: NDArray[np.bool_] = holds | ruled_out | denied
    both: NDArray[np.bool_] = known | known[backwards].transpose(0, 2, 1)
    return both


def spoken(name: str) -> str:
    """Return an object's name in plain words: ``salad_fork`` is "salad fork".

    Parameters
    ----------
    name
        Name of an object in a script.

    Returns
    -------
    str
        The name with spaces for underscores.

    Examples
    --------
    >>> spoken("wine_glass_2")
    'wine glass 2'
    """
    return re.sub(r"_+", " ", name).strip() or name
