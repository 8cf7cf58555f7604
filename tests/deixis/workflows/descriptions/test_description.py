"""Queries of English descriptions."""

from __future__ import annotations

import pytest

from deixis.grammar.english.parse import parse_english
from deixis.reasoning.grounding.reference.query import Query, readings
from deixis.reasoning.grounding.reference.wording import paraphrase
from deixis.workflows.descriptions.description import query_of


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
        ("The mug under the chopsticks", "the mug under the chopsticks"),
        ("facing the mugs, the one on the left", "facing the mugs, the mug on the left"),
        ("The mug is blue. It is next to the jar.", "the blue mug next to the jar"),
        ("Pick up the mug closest to you.", "the mug closest to you"),
        ("the mug that is the closest one to me", "the mug closest to me"),
        ("the second closest mug to me", "the mug second closest to me"),
        ("Grab the mug on your right.", "from your point of view, the mug on your right"),
        ("From my point of view, the jug on the left", "from my point of view, the jug on the left"),
        ("the furthest away mug", "the farthest mug"),
        ("Pickup the mug in front of me.", "the mug near me"),
        ("the second farthest mug", "the mug that is second from the far side"),
        ("the jug in the middle of the kettle and the jar", "the jug between the kettle and the jar"),
        ("The mug by the sink. Not the mug on the tray.", "the mug near the sink and not on the tray"),
        (
            "The mug. It is not the one by the jar and not the one by the jug.",
            "the mug not near the jar and not near the jug",
        ),
        ("the second mug to the left", "the mug that is second from the left"),
        ("the last mug on the right", "the mug that is first from the right"),
        ("the mug standing by itself", "the mug by itself"),
        ("the blue jug or vase by the sink", "the blue jug or vase near the sink"),
        ("the mug closest to the green wall", "the mug closest to the green wall"),
        ("the mug against the wall", "the mug against a wall"),
        ("It is the far right, under the shelf.", "the one at the far side and on the right and under the shelf"),
        (
            "facing the mugs, the right one. There is a jar by it.",
            "facing the mugs, the mug on the right and with the jar near it",
        ),
    ],
)
def test_descriptions_become_queries(text: str, said: str) -> None:
    assert paraphrase(query(text)) == said


def test_one_of_two_nouns_may_fit() -> None:
    said = query("the jug or vase next to the bowl or dish").target
    (near,) = said.relations
    assert said.nouns == ("jug", "vase")
    assert near.arguments[0].nouns == ("bowl", "dish")


def test_the_last_phrase_may_belong_to_either_noun() -> None:
    said = query("the mug on the tray that is closest to the sink").target
    nested, lifted = readings(said)
    assert [relation.name for relation in nested.relations] == ["on"]
    assert [relation.name for relation in lifted.relations] == ["on", "near"]
    assert lifted.relations[0].arguments[0].relations == ()


def test_a_landmark_keeps_its_own_landmark() -> None:
    (left,) = query("the mug to the left of the tray with the teapot").target.relations
    assert left.name == "left"
    assert [inner.arguments[0].noun for inner in left.arguments[0].relations] == ["teapot"]


def test_what_a_viewer_faces_is_meant_by_it() -> None:
    (right,) = query("facing the sink, the mug to the right of it").target.relations
    assert right.arguments[0].noun == "sink"
