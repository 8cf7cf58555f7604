"""Descriptions by the incremental algorithm: they fit their object and no other one."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.reference.expressions import Attributes, Description, reading_order, single_out


def attributes(seed: int, n: int = 7) -> Attributes:
    """Return random objects of three nouns, some without a noun or colour."""
    random = np.random.default_rng(seed)
    low = random.uniform(0, 1, (n, 2))
    boxes = np.stack([low, low + random.uniform(0.02, 0.3, (n, 2))], axis=1)
    apart = np.maximum(0, np.maximum(low[:, None] - boxes[None, :, 1], low[None] - boxes[:, None, 1]))
    return Attributes(
        tuple(["cup", "jug", "fork", None][random.integers(4)] for _ in range(n)),
        tuple(["red", "blue", None][random.integers(3)] for _ in range(n)),
        np.prod(boxes[:, 1] - boxes[:, 0], axis=1),
        scene_relations(tuple(f"o{i}" for i in range(n)), boxes, default_ontology().relations),
        np.sqrt((apart**2).sum(axis=2)),
    )


def fits(said: Description, other: int, known: Attributes, among: range) -> bool:
    """Return True if all that is said about an object is true of another one, tested attribute by attribute."""
    if said.noun is not None and known.nouns[other] not in (None, said.noun):
        return False
    if said.colour is not None and known.colours[other] not in (None, said.colour):
        return False
    if said.size is not None:
        extreme = max if said.size == "largest" else min
        kin = [i for i in among if known.nouns[i] in (None, said.noun) or said.noun is None]
        if other != extreme(kin, key=lambda i: known.sizes[i]) and known.sizes[other] != known.sizes[said.target]:
            return False
    return all(mark == other or word in known.related.relation(other, mark).broader for word, mark in said.relations)


@given(st.integers(0, 100_000))
@settings(max_examples=80, deadline=None)
def test_a_description_without_rivals_fits_one_object(seed: int) -> None:
    known = attributes(seed)
    everything = range(len(known.sizes))
    for target in everything:
        said = single_out(target, everything, known, everything)
        others = [other for other in everything if other != target and fits(said, other, known, everything)]
        assert set(others) <= set(said.rivals)
        assert all(word in known.related.relation(target, mark).broader for word, mark in said.relations)


def test_an_attribute_that_rules_nothing_out_is_left_out() -> None:
    known = attributes(3)
    lone = Attributes(("plate", *["cup"] * 6), ("red", *["blue"] * 6), known.sizes, known.related, known.gaps)
    assert single_out(0, range(7), lone, range(7)) == Description(0, "plate")


@given(st.integers(0, 100_000))
@settings(max_examples=30, deadline=None)
def test_the_reading_order_has_each_object_once(seed: int) -> None:
    known = attributes(seed)
    order = list(reading_order(known))
    assert sorted(order) == list(range(len(known.sizes)))
