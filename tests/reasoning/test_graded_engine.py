"""The graded engine: right on the shipped settings, crisp maps where meaning is clear, and honest where it is not."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Relations
from deixis.perception.settings import formal_setting
from deixis.reasoning.errors import SettingError
from deixis.reasoning.evidence import no_unary_evidence
from deixis.reasoning.graded_engine import GradedEngine
from deixis.reasoning.grounding import ground
from deixis.reasoning.rectangle import perceived_graph

MakeGraph = Callable[..., RelationGraph]


def scene(relations: Relations, seed: int | None = None) -> RelationGraph:
    seen = formal_setting(seed)
    boxes = np.array([[thing.minimum, thing.maximum] for thing in seen.objects])
    return perceived_graph([thing.id for thing in seen.objects], boxes, relations)


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_full_description_of_a_setting_names_everything_right(
    seed: int | None, relations: Relations, graph_of: MakeGraph, full_script: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*full_script), scene(relations, seed)), GradedEngine())
    assert found.proved_best
    assert {name: match.perceived for name, match in found.matches.items()} == {name: name for name in found.matches}
    assert len(found.matches) == 12


def test_what_is_absent_is_left_out(
    relations: Relations, graph_of: MakeGraph, full_script: list[str], absent_glasses: list[str]
) -> None:
    description = graph_of(*full_script, *absent_glasses)
    found = ground(no_unary_evidence(description, scene(relations)), GradedEngine())
    left_out = {left.name for left in found.unmatched_objects}
    assert left_out == {"white_wine_glass", "red_wine_glass", "champagne_glass"}


def test_interchangeable_things_are_not_called_decided(
    relations: Relations, graph_of: MakeGraph, figure_7: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*figure_7), scene(relations)), GradedEngine())
    for group in found.interchangeable:
        assert not any(found.matches[name].decided for name in group)
    assert found.matches["dinner_plate"].decided


def test_without_boxes_there_is_no_graded_meaning(relations: Relations, graph_of: MakeGraph) -> None:
    seen = RelationGraph.from_facts(relations, [], [])
    with pytest.raises(SettingError, match="this scene has none"):
        ground(no_unary_evidence(graph_of("left(a, b)"), seen), GradedEngine())


def test_where_no_time_is_left_the_answer_is_not_called_proved(
    relations: Relations, graph_of: MakeGraph, figure_7: list[str]
) -> None:
    found = ground(no_unary_evidence(graph_of(*figure_7), scene(relations)), GradedEngine(), time_limit=0.0)
    assert not any(match.decided for match in found.matches.values())
