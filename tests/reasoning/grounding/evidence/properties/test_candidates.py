"""Evidence of candidate names for matches."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.evidence.properties.candidates import CANDIDATE_OUTLIERS, candidate_ratios
from deixis.testing import assert_grounds

ONTOLOGY = default_ontology()
KINDS = ONTOLOGY.kinds
TABLE = RelationGraph.from_facts(
    ONTOLOGY.relations,
    ["fork", "plate", "gizmo"],
    [Fact("fork", (ONTOLOGY.relations["left"],), "plate"), Fact("gizmo", (ONTOLOGY.relations["left"],), "plate")],
)
W = CANDIDATE_OUTLIERS


def test_probabilities_are_divided_by_their_priors() -> None:
    said = candidate_ratios(TABLE, [{"fork": 0.6, "plate": 0.1}, None], KINDS)
    # two taught names share the prior 1/2: each has 1/4; gizmo was not taught, so that it has what is left, 0.3 of 1/2
    wanted = [(1 - W) * 0.6 * 4 + W, (1 - W) * 0.1 * 4 + W, (1 - W) * 0.3 * 2 + W]
    assert np.exp(said[:, 0]) == pytest.approx(wanted)
    assert said[:, 1].tolist() == [0.0, 0.0, 0.0]


def test_a_name_that_another_thing_has_counts_as_taught() -> None:
    alone, both = (candidate_ratios(TABLE, each, KINDS) for each in ([{"fork": 0.6}], [{"fork": 0.6}, {"plate": 0.5}]))
    assert alone[1, 0] > both[1, 0] == pytest.approx(np.log(W))


def test_no_candidates_say_nothing() -> None:
    assert not candidate_ratios(TABLE, [None, {}], KINDS).any()


@settings(deadline=None, max_examples=30)
@given(st.lists(st.floats(0, 1), min_size=2, max_size=2))
def test_no_name_is_ruled_out_and_a_likelier_one_weighs_more(shares: list[float]) -> None:
    fork, plate = (share / max(1.0, sum(shares)) for share in shares)
    said = candidate_ratios(TABLE, [{"fork": fork, "plate": plate}], KINDS)[:, 0]
    assert np.isfinite(said).all() and (said >= np.log(W) - 1e-12).all()
    assert (fork > plate) <= (said[0] >= said[1])


def test_candidates_settle_what_the_words_leave_open() -> None:
    places = {"o1": 0.0, "o2": 0.4, "o3": 0.8}
    names = {"o1": {"cup": 0.2, "mug": 0.6}, "o2": {"cup": 0.5, "mug": 0.3}}
    things = [
        {"id": id, "min": [x, 0.0], "max": [x + 0.1, 0.1], "candidates": names.get(id, {})} for id, x in places.items()
    ]
    expected = {"cup": "o2", "mug": "o1", "jug": "o3"}
    assert_grounds("cup left of jug; mug left of jug", {"objects": things}, expected)


def test_a_certain_label_stands_against_candidates() -> None:
    things = [
        {"id": "o1", "min": [0, 0], "max": [0.1, 0.1], "label": "cup", "candidates": {"mug": 0.9}},
        {"id": "o2", "min": [0.4, 0], "max": [0.5, 0.1]},
        {"id": "o3", "min": [0.8, 0], "max": [0.9, 0.1]},
    ]
    assert_grounds("cup left of jug; mug left of jug", {"objects": things}, {"cup": "o1"})
