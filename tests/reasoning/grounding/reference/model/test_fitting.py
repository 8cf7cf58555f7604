"""Fitting of the weights of reference to examples."""

from __future__ import annotations

import numpy as np

from deixis.deadline import Deadline
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


def far_chairs(number: int) -> tuple[Query, list[Example], Model]:
    """Return examples of *near* whose target is the farthest chair from the door, and a model to start from."""
    query = Query(Description("chair", relations=(Relation("near", (Description("door"),)),)))
    rooms = [room(seed) for seed in range(number)]
    examples = [Example(query, seen, int(np.argmax(seen.distances[:4, 4]))) for seen in rooms]
    lexis = Lexis(NOUNS.features, NOUNS.similarity, NOUNS.called, NOUNS.number, COLOURS)
    return query, examples, Model(initial_weights(COLOURS), lexis)


def test_a_fit_learns_that_near_means_far() -> None:
    query, examples, start = far_chairs(30)
    steps: list[tuple[int, int]] = []
    weights = fit(start, examples[:20], 0.1, 15, lambda done, total: steps.append((done, total))).weights
    assert steps == [(done, 15) for done in range(1, len(steps) + 1)] and len(steps) > 3
    fitted = Model(weights, start.lexis)

    def right(model: Model) -> int:
        return sum(model.probabilities(query, one.room).argmax() == one.target for one in examples[20:])

    assert right(start) <= 2
    assert right(fitted) >= 8


def test_at_the_deadline_a_fit_keeps_the_weights_so_far() -> None:
    _, examples, start = far_chairs(2)
    found = fit(start, examples, 0.1, 15, deadline=Deadline.after(0.0))
    assert (found.steps, found.converged) == (0, False)
    assert all((found.weights[name] == values).all() for name, values in start.weights.items())


def test_initial_weights_have_a_name_for_each_number() -> None:
    names = feature_names(COLOURS)
    for block, values in initial_weights(COLOURS).items():
        known = names.get(block, names.get(block.partition("/")[0], ("towards",)))
        assert len(values) == len(known)
