"""The exact Bayes limit of a generated table: what share of the objects anybody can expect to name right.

The likelihood is the generator's own. Of m facts a known number k is off, each choice of k as likely as the next, and
what is said of a fact that is off is drawn evenly from the relations next to the true one. So the maps that are
possible at all are those with exactly k facts off, each by a neighbouring relation; they are listed, all of them, and
weighed by what was drawn. The best decision gives as many objects as can be expected the thing that is theirs: the
assignment with the largest sum of marginals.

Whoever also knows how the generator draws pairs (half of them among near neighbours) can do better, since what was not
said tells something too. Both limits are given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import GeneratedTable, nearest, neighbours
from deixis.ontology.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.matching.exact import exact, maps_within
from deixis.reasoning.grounding.matching.problem import Problem

MAX_MAPS = 1_000_000
IMPOSSIBLE_VALUE = -1e3  # value of a fact that cannot have been said
UNMATCHED_VALUE = -1e6  # value of leaving an object out
CHUNK = 50_000

Matrix = NDArray[np.float64]
Maps = NDArray[np.int64]
Names = NDArray[np.integer]


@dataclass(frozen=True, slots=True)
class Limit:
    """The expected share right of the best decision, ``maps`` possible maps considered.

    Where they could not all be listed (not ``complete``) the figures are those of the maps listed, and no limit.
    """

    words: float  # by what was said of the pairs
    words_and_pairs: float  # and by which pairs were spoken of
    maps: int
    complete: bool


def bayes_limit(table: GeneratedTable, seconds: float = 30.0) -> Limit:
    """Return the limit for a table on which nothing is missing or extra; raises ValueError for another."""
    if len(table.truth) != len(table.boxes) or (table.truth < 0).any():
        raise ValueError("the limit is that of a table on which nothing is missing or extra")
    relations = default_ontology().relations
    said_off = np.zeros((len(relations), len(relations)))
    for relation in relations.of_reading(Reading.EXACT):
        near = neighbours(relation.index, relations)
        said_off[relation.index, near] = 1 / len(near)
    names = box_relations(table.boxes, default_ontology().relations).names
    maps, complete = _possible(table, names, said_off, Deadline.after(seconds))
    parts = [maps[start : start + CHUNK] for start in range(0, len(maps), CHUNK)]
    words = np.concatenate([_word_likelihood(table, names, said_off, part) for part in parts])
    pairs = np.concatenate([_pair_likelihood(table, part) for part in parts])
    return Limit(_expected(maps, words), _expected(maps, words + pairs), len(maps), complete)


def _possible(table: GeneratedTable, names: Names, said_off: Matrix, deadline: Deadline) -> tuple[Maps, bool]:
    """Return the maps with exactly as many facts off as there are, shape (c, n), and whether these are all."""
    n, off = len(table.truth), int(table.off.sum())
    words, kinds = np.unique(table.words, return_inverse=True)
    tables = np.full((len(words), n, n), IMPOSSIBLE_VALUE, dtype=np.float32)
    for rows, word in zip(tables, words.tolist(), strict=True):
        rows[said_off[:, word][names] > 0] = -1.0
        rows[names == word] = 0.0
    problem = Problem(table.ends, kinds.ravel().astype(np.int64), tables, np.zeros((n, n)), np.full(n, UNMATCHED_VALUE))
    best = exact(problem, deadline)
    margin = max(0.0, off + best.value)  # from the fewest that can be off to as many as are
    found = maps_within(problem, margin, deadline, limit=MAX_MAPS)
    possible = np.abs(found.values + off) < 0.5
    if not possible.any():  # not one was found in time; the truth is possible for certain
        return table.truth[None], False
    return found.assignments[possible], found.complete and best.proved


def _word_likelihood(table: GeneratedTable, names: Names, said_off: Matrix, maps: Maps) -> Matrix:
    """Return the logarithm of how probably what is off would have been said, for each of c maps, shape (c,)."""
    true = names[maps[:, table.ends[:, 0]], maps[:, table.ends[:, 1]]]
    said = np.where(true == table.words, 1.0, said_off[true, table.words])
    likelihood: Matrix = np.log(said).sum(axis=1)
    return likelihood


def _pair_likelihood(table: GeneratedTable, maps: Maps) -> Matrix:
    """Return the logarithm of how probably these pairs were drawn, in this order, for each of c maps, shape (c,).

    A draw takes any subject, and evenly often one of its nearest or any object; it is repeated where the two are the
    same or have been paired before, so that each draw is relative to the pairs that were left.
    """
    n = len(table.boxes)
    near = nearest(table.boxes)
    drawn = np.full((n, n), 0.5 / n)
    drawn[np.arange(n)[:, None], near] += 0.5 / near.shape[1]
    np.fill_diagonal(drawn, 0.0)
    drawn /= drawn.sum()
    subjects, objects = maps[:, table.ends[:, 0]], maps[:, table.ends[:, 1]]
    taken = np.cumsum(drawn[subjects, objects] + drawn[objects, subjects], axis=1)
    left = 1.0 - np.concatenate([np.zeros((len(maps), 1)), taken[:, :-1]], axis=1)
    likelihood: Matrix = (np.log(drawn[subjects, objects]) - np.log(left)).sum(axis=1)
    return likelihood


def _expected(maps: Maps, likelihood: Matrix) -> float:
    """Return the share right that the best decision can expect under the posterior over these maps."""
    from scipy.optimize import linear_sum_assignment

    weights = np.exp(likelihood - likelihood.max())
    weights /= weights.sum()
    n = maps.shape[1]
    marginals = np.stack([np.bincount(maps[:, i], weights, minlength=n) for i in range(n)])
    rows, columns = linear_sum_assignment(marginals, maximize=True)
    return float(marginals[rows, columns].mean())
