"""Compute the exact Bayes limit of a generated table: the greatest expected share of objects named correctly.

The likelihood is the generator's own. Of m facts a known number k is wrong, every choice of k equally likely, and the
word of a wrong fact is drawn evenly from the relations next to the true one. So the possible maps are those with
exactly k wrong facts, each by a neighbouring relation; all of them are listed and weighted by their likelihood. The
best decision maximises the expected number of objects that are assigned their own things: it is the assignment with the
largest sum of marginals.

A decision that also uses how the generator draws pairs (half of them among near neighbours) can do better, since
unstated facts carry information too. Both limits are given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import GeneratedTable, nearest, neighbours
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.search.exact import exact, maps_within

MAX_MAPS = 1_000_000
IMPOSSIBLE_VALUE = -1e3  # value of an impossible fact
UNMATCHED_VALUE = -1e6  # value of leaving an object out
CHUNK = 50_000

Matrix = NDArray[np.float64]
Maps = NDArray[np.int64]
Names = NDArray[np.integer]


@dataclass(frozen=True, slots=True)
class Limit:
    """The expected share right of the best decision, over ``maps`` possible maps.

    If not all could be listed (not ``complete``), the figures are those of the listed maps, and not a limit.
    """

    words: float  # given the words of the facts
    words_and_pairs: float  # given also which pairs the facts relate
    maps: int
    complete: bool


def bayes_limit(table: GeneratedTable, seconds: float = 30.0) -> Limit:
    """Return the greatest expected share of objects named correctly on a table.

    Parameters
    ----------
    table
        A generated table on which every described piece is present, and no other.
    seconds
        The time limit of listing the possible maps.

    Returns
    -------
    The limits given the words, and given also the pairs of the facts.

    Raises
    ------
    ValueError
        If pieces are missing or extra.
    """
    if len(table.truth) != len(table.boxes) or (table.truth < 0).any():
        raise ValueError("`table` must have no missing and no extra pieces")
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
    """Return the maps with exactly the known number of wrong facts, shape (c, n), and True if they are all listed."""
    n, off = len(table.truth), int(table.off.sum())
    words, kinds = np.unique(table.words, return_inverse=True)
    tables = np.full((len(words), n, n), IMPOSSIBLE_VALUE, dtype=np.float32)
    for rows, word in zip(tables, words.tolist(), strict=True):
        rows[said_off[:, word][names] > 0] = -1.0
        rows[names == word] = 0.0
    problem = Problem(table.ends, kinds.ravel().astype(np.int64), tables, np.zeros((n, n)), np.full(n, UNMATCHED_VALUE))
    best = exact(problem, deadline)
    margin = max(0.0, off + best.value)  # from the fewest possible wrong facts up to the known number
    found = maps_within(problem, margin, deadline, limit=MAX_MAPS)
    possible = np.abs(found.values + off) < 0.5
    if not possible.any():  # none was found in time; the truth is always possible
        return table.truth[None], False
    return found.assignments[possible], found.complete and best.proved


def _word_likelihood(table: GeneratedTable, names: Names, said_off: Matrix, maps: Maps) -> Matrix:
    """Return the logarithm of the probability of the words of the wrong facts for each of c maps, shape (c,)."""
    true = names[maps[:, table.ends[:, 0]], maps[:, table.ends[:, 1]]]
    likelihoods = np.where(true == table.words, 1.0, said_off[true, table.words])
    likelihood: Matrix = np.log(likelihoods).sum(axis=1)
    return likelihood


def _pair_likelihood(table: GeneratedTable, maps: Maps) -> Matrix:
    """Return the logarithm of the probability of drawing these pairs, in this order, for each of c maps, shape (c,).

    A draw takes any subject, and with equal probability one of its nearest objects or any object; it is repeated if the
    two are the same or have been paired before, so that each draw is relative to the remaining pairs.
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
    """Return the greatest expected share right under the posterior over these maps."""
    from scipy.optimize import linear_sum_assignment

    weights = np.exp(likelihood - likelihood.max())
    weights /= weights.sum()
    n = maps.shape[1]
    marginals = np.stack([np.bincount(maps[:, i], weights, minlength=n) for i in range(n)])
    rows, columns = linear_sum_assignment(marginals, maximize=True)
    return float(marginals[rows, columns].mean())
