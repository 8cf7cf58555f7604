"""Fitting of the weights of reference to examples."""

from __future__ import annotations

import numpy as np

from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.reference.features.nouns import Nouns
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.model.fitting import Example, feature_names, fit, initial_weights
from deixis.reasoning.grounding.reference.model.model import Lexis, Model
from deixis.reasoning.grounding.reference.query import Description, Query, Relation

COLOURS = default_ontology().colours
NOUNS = Nouns(default_ontology().lexicon)


def room(seed: int) -> Room:
    centres = np.random.default_rng(seed).uniform(0, 5, size=(5, 3)) * (1, 1, 0)
    boxes = np.stack([centres - 0.2, centres + 0.2], axis=1)
    return Room.of(tuple("abcde"), boxes, ("chair",) * 4 + ("door",))


def test_a_fit_learns_that_near_means_far() -> None:
    """Fit *near* to examples whose target is the farthest chair from the door."""
    query = Query(Description("chair", relations=(Relation("near", (Description("door"),)),)))
    examples = []
    for seed in range(30):
        seen = room(seed)
        examples.append(Example(query, seen, int(np.argmax(seen.distances[:4, 4]))))
    start = Model(
        initial_weights(COLOURS), Lexis(NOUNS.features, NOUNS.similarity, NOUNS.called, NOUNS.number, COLOURS)
    )
    steps: list[tuple[int, int]] = []
    weights = fit(start, examples[:20], 0.1, 15, lambda done, total: steps.append((done, total)))
    assert steps == [(done, 15) for done in range(1, len(steps) + 1)] and len(steps) > 3
    fitted = Model(weights, start.lexis)

    def right(model: Model) -> int:
        return sum(model.probabilities(query, one.room).argmax() == one.target for one in examples[20:])

    assert right(start) <= 2
    assert right(fitted) >= 8


def test_initial_weights_have_a_name_for_each_number() -> None:
    names = feature_names(COLOURS)
    for block, values in initial_weights(COLOURS).items():
        known = names.get(block, names.get(block.partition("/")[0], ("towards",)))
        assert len(values) == len(known)
