"""Lessons to triples and back: nothing is lost, and no name can inject a triple."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace
from datetime import UTC, datetime

import pyoxigraph as ox
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.graph import Fact, Source
from deixis.ontology.lessons.read import layouts, lesson_records, unknown_layout
from deixis.ontology.lessons.types import Alternative, LayoutConcept, Lesson, Match, Role, next_lesson_id
from deixis.ontology.lessons.write import asserted_triples, episode_triples, learned_triples
from deixis.ontology.rdf.triples import (
    GENID,
    LEARNED,
    decimal,
    last_part,
    learned_iri,
    typed,
    with_blank_nodes,
    with_names,
)
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import PerceivedObject, Scene

RELATIONS = default_ontology().relations
RED = "https://w3id.org/deixis/onto#red"
FISH_KNIFE = "https://w3id.org/deixis/onto#FishKnife"
NAMES = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1, max_size=12)


def lesson(names: list[str], id: str = "dinner-1", decided: bool = True) -> Lesson:
    roles = tuple(
        Role(name, FISH_KNIFE if i == 0 else None, i == 0, RED if i == 1 else None) for i, name in enumerate(names)
    )
    facts = [
        Fact(names[0], (RELATIONS["left"],), names[1], source=Source('a"b:c.layout', 3, 1, 3, 1)),
        Fact(names[1], (RELATIONS["right"], RELATIONS["top_right"]), names[0], weight=0.8),
        Fact(names[0], (RELATIONS["exactly_on"],), names[1], positive=False, optional=True),
    ]
    claims = (
        Claim("row", tuple(names), value="left to right", weight=0.8, source=Source('a"b:c.layout', 4, 1, 4, 1)),
        Claim("distance_less", (names[0],), (names[1],), metres=0.025, positive=False),
        Claim("tallest", (names[1],), optional=True),
    )
    seen = tuple(PerceivedObject(f"o{i}", (0.0, float(i)), (1.0, i + 0.5), name, 0.5) for i, name in enumerate(names))
    return Lesson(
        layout=LayoutConcept(
            id, "dinner", 'Say "dinner"', "chair", roles, tuple(facts), (tuple(sorted(names[:2])),), claims, "desk"
        ),
        scene=Scene(seen),
        relations=(("o0", RELATIONS["exactly_bottom"], "o1"),),
        matches=tuple(
            Match(name, f"o{i}" if decided else "o1", 1.0, math.nan, decided, () if decided else (Alternative("o0"),))
            for i, name in enumerate(names)
        ),
        engine="exact",
        proved_best=True,
        started=datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC),
        ended=datetime(2026, 1, 2, 3, 4, 6, tzinfo=UTC),
        version="0.1.0",
        script_file="a.layout",
        script_text="…",
        scene_text="{}",
    )


@settings(deadline=None, max_examples=60)
@given(st.lists(NAMES, min_size=2, max_size=4, unique=True))
def test_a_layout_survives_the_round_trip_through_triples(names: list[str]) -> None:
    taught = lesson(names)
    (again,) = layouts(learned_triples(taught, RELATIONS), RELATIONS)
    assert again == taught.layout


@settings(deadline=None, max_examples=40)
@given(st.lists(NAMES, min_size=2, max_size=4, unique=True), st.booleans(), st.floats(0, 1))
def test_a_lesson_record_keeps_texts_and_match_probabilities(
    names: list[str], decided: bool, probability: float
) -> None:
    plain = lesson(names, "dinner 1/x", decided)
    matches = tuple(replace(match, probability=probability) for match in plain.matches)
    taught = replace(plain, matches=matches)
    (record,) = lesson_records(learned_triples(taught, RELATIONS), episode_triples(taught))
    assert (record.id, record.script_file, record.words_only) == ("dinner 1/x", "a.layout", False)
    assert (record.script_text, record.scene_text) == (taught.script_text, taught.scene_text)
    assert sorted(map(str, record.matches)) == sorted(map(str, matches))
    taken = {f"o{i}" for i in range(len(names))} if decided else {"o1"}
    assert {match.perceived for match in record.matches} == taken
    assert {match.could_be for match in record.matches} == ({()} if decided else {("o1", "o0")})


def test_the_sureness_of_a_match_without_a_probability() -> None:
    other = (Alternative("o1"), Alternative(None))
    assert Match("fork", "o1", 1.0, math.nan, True, ()).sureness == 1
    assert Match("fork", "o1", 1.0, math.nan, False, ()).sureness == 0
    assert Match("fork", "o2", 1.0, math.nan, False, other).sureness == 0.5
    assert Match("fork", "o2", 1.0, math.nan, False, other, 0.3).sureness == 0.3


def test_a_match_without_a_likeliest_object_is_not_read() -> None:
    """Lessons of the first versions kept only the candidates of an undecided match."""
    taught = lesson(["fork", "plate"], decided=False)
    learned = [t for t in learned_triples(taught, RELATIONS) if t.predicate.value != DX.LIKELIEST]
    (record,) = lesson_records(learned, episode_triples(taught))
    assert record.matches == ()


def test_a_lesson_without_its_texts_gives_no_record() -> None:
    taught = lesson(["fork", "plate"])
    told = [triple for triple in episode_triples(taught) if triple.predicate.value != DX.SCENE_TEXT]
    assert lesson_records(learned_triples(taught, RELATIONS), told) == ()


@settings(deadline=None, max_examples=40)
@given(st.lists(NAMES, min_size=3, max_size=3, unique=True))
def test_no_name_can_inject_a_triple(names: list[str]) -> None:
    plain = lesson(["fork", "plate", "spoon"])
    odd = lesson(names)
    for triples in (lambda x: learned_triples(x, RELATIONS), asserted_triples, episode_triples):
        text = ox.serialize(triples(odd), format=ox.RdfFormat.N_TRIPLES) or b""
        parsed = list(ox.parse(text, format=ox.RdfFormat.N_TRIPLES))
        assert len(parsed) == len(list(triples(plain)))
        assert all(str(quad.graph_name) == "DEFAULT" for quad in parsed)


@given(NAMES)
def test_a_name_stays_within_one_part_of_an_iri(name: str) -> None:
    iri = learned_iri("category", name)
    assert last_part(iri) == name
    assert iri.removeprefix(LEARNED).count("/") == 1


def test_only_decided_matches_teach_a_category() -> None:
    taught = list(learned_triples(lesson(["fork", "plate"]), RELATIONS))
    doubtful = list(learned_triples(lesson(["fork", "plate"], decided=False), RELATIONS))
    assert sum("/category/" in str(t.subject) for t in taught) == 8
    assert not any("/category/" in str(t) for t in doubtful)
    could_be = [t for t in doubtful if t.predicate.value.endswith("#couldBe")]
    assert len(could_be) == 4


def test_class_expressions_are_exported_as_blank_nodes() -> None:
    inside = list(learned_triples(lesson(["fork", "plate"]), RELATIONS))
    assert not any(isinstance(term, ox.BlankNode) for t in inside for term in (t.subject, t.object))
    outside = list(with_blank_nodes(inside))
    assert not any(GENID in str(t) for t in outside)
    assert set(with_names(outside)) == set(inside)


def test_the_error_for_an_unknown_layout_suggests_a_name() -> None:
    assert "did you mean 'dinner'" in str(unknown_layout("diner", ["dinner", "dinner", "picnic"]))
    assert "the learned layouts are: dinner, picnic" in str(unknown_layout("x", ["picnic", "dinner"]))
    assert "the memory has no layouts yet" in str(unknown_layout("diner", ()))


def test_lesson_ids_are_never_used_twice() -> None:
    assert next_lesson_id("a", [].__contains__) == "a-1"
    assert next_lesson_id("a", ["a-1", "a-3"].__contains__) == "a-2"
    taken = {f"a-{number}" for number in range(1, 1001)}
    asked = Counter[str]()

    def is_taken(id: str) -> bool:
        asked[id] += 1
        return id in taken

    assert next_lesson_id("a", is_taken) == "a-1001"
    assert asked.total() < 30


def test_numbers_keep_their_value_and_get_their_datatype() -> None:
    assert str(decimal(1e-7)).startswith('"0.0000001"')
    assert typed(True).value == "true"
    assert typed(3).datatype.value.endswith("#integer")
    assert typed(0.1).datatype.value.endswith("#double")
