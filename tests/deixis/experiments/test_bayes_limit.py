"""Compare the Bayes limit with all permutations, and the assumed generator with its draws."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.experiments.scoreboard import bayes_limit as module
from deixis.experiments.scoreboard.bayes_limit import bayes_limit
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import box_relations

RELATIONS = default_ontology().relations
EXACT = {relation.index: relation.word for relation in RELATIONS.of_reading(Reading.EXACT)}
AROUND = ["top", "top_right", "right", "bottom_right", "bottom", "bottom_left", "left", "top_left"]


def _said(word: str, true: str, off: bool) -> float:
    """Return the probability of the word for a pair whose true relation is ``true``."""
    if not off:
        return float(word == true)
    if true not in AROUND:
        return float(word in AROUND) / 8
    return 0.5 if word in AROUND and (AROUND.index(word) - AROUND.index(true)) % 8 in (1, 7) else 0.0


def _by_permutations(table: GeneratedTable) -> tuple[float, float, int]:
    """Return both limits and the number of possible maps, one permutation after the other, in plain Python."""
    n = len(table.truth)
    names = box_relations(table.boxes, RELATIONS).names
    middles = table.boxes.mean(axis=1)
    total, with_pairs = 0.0, 0.0
    marginals, pair_marginals = np.zeros((n, n)), np.zeros((n, n))
    possible = 0
    for things in permutations(range(n)):
        likelihood, off = 1.0, 0
        for (s, o), word in zip(table.ends.tolist(), table.words.tolist(), strict=True):
            true = EXACT[names[things[s], things[o]]]
            wrong = EXACT[word] != true
            off += wrong
            likelihood *= _said(EXACT[word], true, wrong)
        if off != table.off.sum() or likelihood == 0:
            continue
        possible += 1
        drawn = _drawn([(things[s], things[o]) for s, o in table.ends.tolist()], middles)
        total, with_pairs = total + likelihood, with_pairs + likelihood * drawn
        for i, thing in enumerate(things):
            marginals[i, thing] += likelihood
            pair_marginals[i, thing] += likelihood * drawn
    return _best(marginals / total), _best(pair_marginals / with_pairs), possible


def _drawn(pairs: list[tuple[int, int]], middles: np.ndarray) -> float:
    """Return the probability that these pairs are drawn one after the other."""
    n = len(middles)

    def chance(s: int, o: int) -> float:
        others = sorted((j for j in range(n) if j != s), key=lambda j: float(np.linalg.norm(middles[j] - middles[s])))
        near = others[:6]
        return (0.5 * (o in near) / len(near) + 0.5 / n) / n

    left, probability = sum(chance(s, o) for s in range(n) for o in range(n) if s != o), 1.0
    for s, o in pairs:
        probability *= chance(s, o) / left
        left -= chance(s, o) + chance(o, s)
    return probability


def _best(marginals: np.ndarray) -> float:
    n = len(marginals)
    return float(max(marginals[range(n), things].mean() for things in permutations(range(n))))


@pytest.mark.parametrize(("seed", "objects", "facts", "off"), [(1, 6, 1.0, 0.0), (2, 5, 1.0, 0.2), (3, 6, 1.5, 0.2)])
def test_the_limit_is_that_of_all_permutations(seed: int, objects: int, facts: float, off: float) -> None:
    table = generate(objects, facts, off, seed=seed)
    found, (words, pairs, possible) = bayes_limit(table), _by_permutations(table)
    assert found.complete
    assert found.maps == possible
    assert found.words == pytest.approx(words)
    assert found.words_and_pairs == pytest.approx(pairs)


def test_near_objects_are_distinguished_from_far_ones() -> None:
    table = generate(8, 1.0, 0.0, seed=5)
    found, (words, pairs, possible) = bayes_limit(table), _by_permutations(table)
    assert found.maps == possible
    assert found.words == pytest.approx(words)
    assert found.words_and_pairs == pytest.approx(pairs)


def test_pairs_are_drawn_as_the_limit_assumes() -> None:
    """Compare the first pairs of many descriptions of one table with the probabilities in the limit."""
    from deixis.experiments.generated_tables import _draw_pairs

    table = generate(9, 1.0, 0.0, seed=1)
    rng, draws = np.random.default_rng(2), 4000
    seen = Counter(tuple(_draw_pairs(table.boxes, 9, 1, rng)[0].tolist()) for _ in range(draws))
    first = replace(table, ends=np.array([[0, 1]]))
    pairs = [(s, o) for s in range(9) for o in range(9) if s != o]
    everyone = np.array([[s, o, *(i for i in range(9) if i not in (s, o))] for s, o in pairs])
    drawn = np.exp(module._pair_likelihood(first, everyone))
    assert drawn.sum() == pytest.approx(1)
    for maps, probability in zip(everyone.tolist(), drawn, strict=True):
        expected = draws * probability
        assert abs(seen[maps[0], maps[1]] - expected) < 5 * np.sqrt(expected)


def test_tables_with_missing_pieces_are_refused() -> None:
    with pytest.raises(ValueError, match="no missing and no extra pieces"):
        bayes_limit(generate(8, missing=1, seed=0))


def test_an_incomplete_listing_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_MAPS", 1)
    assert not bayes_limit(generate(8, 1.0, 0.1, seed=1)).complete
