"""What grounding has to go by: how far each stated fact holds of each perceived pair, and what labels allow.

A stated fact holds of a pair to a degree: 1 where the pair's exact name is the word itself, 0.5 where the name only
implies the word in its wide reading, else 0. A choice (``or``) holds as far as its best alternative; a denial holds
(1) where none of its relations does, even widely. A fact is *satisfied* where its degree is above 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.errors import GraphError
from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Reading

UNMATCHED = -1


@dataclass(frozen=True, eq=False)
class Evidence:
    """Two graphs side by side: a description of n1 objects by m facts, and a scene of n2 objects, fully related.

    ``allowed`` (n1, n2) says which object may be which perceived one; ``bonus`` (n1, n2), at least 0, is what speaks
    for it besides the facts, in units of one satisfied fact.
    """

    description: RelationGraph
    scene: RelationGraph
    allowed: NDArray[np.bool_]
    bonus: NDArray[np.float64]

    @cached_property
    def names(self) -> NDArray[np.int16]:
        """The exact name of every ordered perceived pair, shape (n2, n2): relation indices, -1 on the diagonal."""
        return exact_names(self.scene)

    @cached_property
    def facts(self) -> NDArray[np.int64]:
        """The edges of the description that can be compared: all but those of an object to itself."""
        return np.flatnonzero(self.description.subjects != self.description.objects)

    def firm(self) -> NDArray[np.bool_]:
        """Which comparable facts must hold: neither optional nor hedged."""
        must: NDArray[np.bool_] = ~self.description.optional[self.facts] & (self.description.weights[self.facts] >= 1)
        return must

    @cached_property
    def degree_table(self) -> NDArray[np.float64]:
        """The degree of each comparable fact by the pair's exact name, shape (facts, relations + 1); last column 0."""
        degrees = self.description.vocabulary.degrees
        sets = self.description.relation_sets[self.facts]
        member = (sets[:, None] >> np.arange(len(degrees))[None, :] & 1).astype(bool)
        best = np.where(member[:, :, None], degrees[None, :, :], 0.0).max(axis=1, initial=0.0)
        denied = np.where(best > 0, 0.0, 1.0)
        table = np.where(self.description.positive[self.facts][:, None], best, denied)
        return np.concatenate([table, np.zeros((len(table), 1))], axis=1)

    def degrees(self, assignment: NDArray[np.int64]) -> NDArray[np.float64]:
        """How far each comparable fact holds, 0 where an object of it is unmatched.

        ``assignment`` has shape (…, n1), the result (…, facts).
        """
        subjects = assignment[..., self.description.subjects[self.facts]]
        objects = assignment[..., self.description.objects[self.facts]]
        matched = (subjects != UNMATCHED) & (objects != UNMATCHED)
        names = np.where(matched, self.names[subjects, objects], -1) if len(self.names) else subjects
        degrees: NDArray[np.float64] = np.where(matched, self.degree_table[np.arange(len(self.facts)), names], 0.0)
        return degrees

    def total(self, assignment: NDArray[np.int64]) -> float:
        """The sum of degrees times weights, plus the bonus of each match."""
        return float(self.totals(assignment[None])[0])

    def totals(self, assignments: NDArray[np.int64]) -> NDArray[np.float64]:
        """The total of each of k assignments (k, n1)."""
        matched = assignments != UNMATCHED
        bonus = self.bonus[np.arange(assignments.shape[1]), np.where(matched, assignments, 0)] if self.bonus.size else 0
        totals: NDArray[np.float64] = self.degrees(assignments) @ self.description.weights[self.facts]
        totals += np.where(matched, bonus, 0.0).sum(axis=1)
        return totals

    def reordered(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Evidence:
        """The same evidence with the objects and the perceived things in another order."""
        return Evidence(
            self.description.subgraph([self.description.nodes[i] for i in rows]),
            self.scene.subgraph([self.scene.nodes[i] for i in columns]),
            self.allowed[np.ix_(rows, columns)],
            self.bonus[np.ix_(rows, columns)],
        )


def exact_names(scene: RelationGraph) -> NDArray[np.int16]:
    """The exact name of every ordered pair of a scene's graph, shape (n, n), -1 on the diagonal.

    Raises GraphError where a pair has no exact name, or more than one.
    """
    n = len(scene.nodes)
    exact = sum(relation.bit for relation in scene.vocabulary.of_reading(Reading.EXACT))
    sets = scene.relation_sets
    single = (np.bitwise_count(sets) == 1) & ((sets & ~np.int64(exact)) == 0) & scene.positive
    names = np.full((n, n), -1, dtype=np.int16)
    names[scene.subjects[single], scene.objects[single]] = np.round(np.log2(sets[single])).astype(np.int16)
    missing = (names < 0) & ~np.eye(n, dtype=bool)
    if missing.any() or len(scene) != n * (n - 1):
        where = np.argwhere(missing)
        pair = f" ({scene.nodes[where[0][0]]}, {scene.nodes[where[0][1]]})" if len(where) else ""
        raise GraphError(f"a scene's graph needs one exact relation for every ordered pair{pair}")
    return names


def no_unary_evidence(description: RelationGraph, scene: RelationGraph) -> Evidence:
    """The evidence of the facts alone: everything is allowed, and nothing else speaks for a match."""
    shape = (len(description.nodes), len(scene.nodes))
    return Evidence(description, scene, np.ones(shape, dtype=bool), np.zeros(shape))
