"""SHACL on each write: compiled checks agree with pyshacl, and a refused write changes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from episodic_fluents import SEEN, on, some_fluents
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.rdf.guard import SHIPPED, shipped_guard
from deixis.memory.episodes.rdf.observations import fluent_triples, statement_triple
from deixis.memory.errors import RejectedWriteError, ShapesError
from deixis.memory.semantic.validation.shacl import violations

WRONG = [
    episodic("w1", ("t1", "at"), start=0.0, source=SEEN),
    episodic("w2", ("t1", "isA"), start=0.0, source=SEEN),
    episodic("w3", ("anna", "said"), start=0.0, source=SEEN),
    episodic("w4", ("anna", "moved", "t1"), start=0.0, source=Source(Origin.INFERRED, "learner")),
    episodic("w5", ("anna", "took", "the big cup, I think"), start=0.0, source=SEEN),
]
RIGHT = [
    episodic("r1", ("t1", "at", "[0, 0, 0, 1, 1, 1]"), start=0.0, source=SEEN),
    episodic("r2", ("t1", "isA", "fish knife"), start=0.0, certainty=1e-7, source=SEEN),
    episodic("r4", ("anna", "put", "t1"), start=0.0, certainty=0.9, source=SEEN),
    episodic("r5", ("anna", "moved", "t1"), start=None, finish=9.0, source=Source(Origin.SAID, "ben", "s1")),
    episodic("r3", ("t1", "gone"), start=-4e9, finish=4e9, source=SEEN),
]


@settings(max_examples=4, deadline=None)
@given(some_fluents(2), st.sets(st.integers(0, 4)))
def test_compiled_checks_agree_with_pyshacl(fluents: list[EpisodicFluent], wrong: set[int]) -> None:
    for fluent in (*fluents, *(WRONG[number] for number in wrong)):
        found = violations([*fluent_triples(fluent), statement_triple(fluent.statement)], file=SHIPPED)
        assert shipped_guard().accepts(fluent) == (not found)


@pytest.mark.parametrize("fluent", RIGHT, ids=lambda fluent: fluent.statement.predicate)
def test_well_formed_statements_need_no_pyshacl(fluent: EpisodicFluent) -> None:
    assert shipped_guard().accepts(fluent)


@pytest.mark.parametrize("fluent", WRONG, ids=lambda fluent: fluent.statement.predicate)
def test_refused_write_changes_nothing_and_names_the_shape(fluent: EpisodicFluent) -> None:
    with Blackboard.transient() as board:
        with pytest.raises(RejectedWriteError) as refused:
            board.write(Add(on("f1")), Add(fluent), by="test")
        assert (board.sequence, board.now()) == (0, ())
    (result,) = refused.value.results
    assert result.shape in (
        "box of a thing",
        "category of a thing",
        "words that were said",
        "origin of an act",
        "thing of an act",
    )
    assert str(refused.value).startswith("nothing was written")


def test_an_act_is_associated_with_its_person() -> None:
    act = episodic("f1", ("anna", "moved", "t1"), start=0.0, source=SEEN)
    triples = {(each.predicate.value, getattr(each.object, "value", "")) for each in fluent_triples(act)}
    agent = "https://w3id.org/deixis/episodes/agent/anna"
    assert ("http://www.w3.org/ns/prov#wasAssociatedWith", agent) in triples
    assert sum(predicate.endswith("wasAttributedTo") for predicate, _ in triples) == 1


def test_own_shapes_guard_later_writes(tmp_path: Path) -> None:
    shapes = tmp_path / "shapes.ttl"
    shapes.write_text(
        "@prefix sh: <http://www.w3.org/ns/shacl#> .\n@prefix ep: <https://w3id.org/deixis/episodes#> .\n"
        "<urn:sure> a sh:NodeShape ; sh:targetClass ep:Fluent ; sh:property <urn:half> .\n"
        '<urn:half> sh:path ep:certainty ; sh:name "sure enough" ; sh:minInclusive 0.5 ; '
        'sh:message "too uncertain" .\n'
    )
    with Blackboard.transient() as board:
        board.guard(shapes)
        board.add(on("f1"), by="test")
        unsure = episodic("f2", ("cup", "near", "plate"), start=0.0, certainty=0.4, source=SEEN)
        with pytest.raises(RejectedWriteError, match="too uncertain"):
            board.add(unsure, by="test")
        with pytest.raises(ShapesError, match="cannot be read"):
            board.guard(tmp_path / "missing.ttl")
