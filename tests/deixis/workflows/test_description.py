"""Queries of English descriptions."""

from __future__ import annotations

import pytest

from deixis.grammar.english.parse import parse_english
from deixis.reasoning.grounding.reference.query import Query
from deixis.reasoning.grounding.reference.wording import paraphrase
from deixis.workflows.description import query_of


def query(text: str) -> Query:
    return query_of(parse_english(text))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("The mug beside the kettle.", "the mug next to the kettle"),
        ("It's the green mug closest to the kettle.", "the green mug closest to the kettle"),
        ("Pick the second mug from the left.", "the mug that is second from the left"),
        ("the tray with a spoon on it", "the tray with the spoon on it"),
        ("the mug that is not on the tray", "the mug not on the tray"),
        ("Facing the sink, the mug on the right", "facing the sink, the mug on the right"),
        ("facing the mugs, the one on the left", "facing the mugs, the mug on the left"),
        ("The mug is blue. It is next to the jar.", "the blue mug next to the jar"),
        ("the jug in the middle of the kettle and the jar", "the jug between the kettle and the jar"),
    ],
)
def test_descriptions_become_queries(text: str, said: str) -> None:
    assert paraphrase(query(text)) == said.replace("facing the mugs", "facing the mug")


def test_a_landmark_keeps_its_own_landmark() -> None:
    (left,) = query("the mug to the left of the tray with the teapot").target.relations
    assert left.name == "left"
    assert [inner.arguments[0].noun for inner in left.arguments[0].relations] == ["teapot"]


def test_what_a_viewer_faces_is_meant_by_it() -> None:
    (right,) = query("facing the sink, the mug to the right of it").target.relations
    assert right.arguments[0].noun == "sink"
