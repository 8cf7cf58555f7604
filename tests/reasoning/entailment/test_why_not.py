"""Reasons why a fact does not follow: pictures satisfy all firm facts but not it, and conflicts exclude it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.errors import GraphError
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.ontology.relations.relation import Reading, Relation
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.conflict import compatible
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.entailment.why_not import why_not
from deixis.reasoning.geometry.allen import allen_relations

MakeGraph = Callable[..., RelationGraph]
R = default_ontology().relations
ORDERED = [r for r in R.values() if r.reading is not Reading.GRADED]  # words that order edges
NAMES = "abcd"

some_facts = st.lists(
    st.builds(
        lambda ends, relations, positive: Fact(ends[0], tuple(relations), ends[1], positive=positive),
        st.sampled_from(list(permutations(NAMES, 2))),
        st.lists(st.sampled_from(ORDERED), min_size=1, max_size=2, unique=True),
        st.sampled_from([True, True, True, False]),
    ),
    max_size=6,
)


def bears(boxes: NDArray[np.float64], s: int, relation: Relation, o: int) -> bool:
    """Return whether a relation holds of two boxes, by their atoms on each axis."""
    masks = (relation.x_atoms, relation.y_atoms, relation.z_atoms or ALL_ALLEN)
    codes = allen_relations(boxes[s, 0], boxes[s, 1], boxes[o, 0], boxes[o, 1])
    return all(mask >> int(code) & 1 for mask, code in zip(masks, codes, strict=True))


@settings(max_examples=80, deadline=None)
@given(stated=some_facts, ends=st.sampled_from(list(permutations(NAMES, 2))), relation=st.sampled_from(ORDERED))
def test_the_reason_is_correct(stated: list[Fact], ends: tuple[str, str], relation: Relation) -> None:
    implied = Implications(RelationGraph.from_facts(R, list(NAMES), stated))
    if not implied.consistent:
        return
    found = why_not(implied, Fact(ends[0], (relation,), ends[1]))
    reasons = (found.follows, found.against, found.conflict, found.picture)
    assert sum(reason is not None for reason in reasons) == 1
    assert (found.follows is not None) == implied.holds(relation, *ends)
    if found.against is not None:
        claim = found.against.claim
        assert isinstance(claim, Fact) and not compatible(claim.relations[0], relation)
        assert implied.holds(claim.relations[0], *ends)
    if found.conflict is not None:
        assert any(fact.subject == ends[0] and fact.relations == (relation,) for fact in found.conflict.facts)
    if found.picture is not None:
        names, boxes = found.picture.objects, found.picture.boxes
        assert (boxes[:, 0] < boxes[:, 1]).all()
        assert set(ends) <= set(names)
        for fact in stated:
            if fact.subject in names:
                s, o = names.index(fact.subject), names.index(fact.object)
                assert any(bears(boxes, s, r, o) for r in fact.relations) == fact.positive
        assert not bears(boxes, names.index(ends[0]), relation, names.index(ends[1]))
        assert found.missing


def test_contradictory_facts_are_refused(graph_of: MakeGraph) -> None:
    with pytest.raises(GraphError, match="the facts must be consistent"):
        why_not(Implications(graph_of("left(a, b)", "left(b, a)")), Fact("a", (R["top"],), "b"))


def test_a_relation_of_an_object_to_itself_is_refused(graph_of: MakeGraph) -> None:
    with pytest.raises(GraphError, match="one relation of two objects"):
        why_not(Implications(graph_of("left(a, b)")), Fact("a", (R["top"],), "a"))
