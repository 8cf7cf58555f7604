"""Test the experiment of the apprentice: tables with mistakes, scores, and a small run."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from answers import assert_is_answer
from schemas import errors_in

from deixis.examples_data import example
from deixis.experiments.apprentice.report import lines, to_dict
from deixis.experiments.apprentice.run import LAYOUTS, Apprentice, ApprenticePlan, run
from deixis.experiments.apprentice.scoring import Count
from deixis.experiments.apprentice.tables import lay_tampered
from deixis.grammar.read import read_script_file
from deixis.grammar.script import Script
from deixis.reasoning.comparison.explanation import MistakeKind
from deixis.reasoning.entailment.realisation.verification import facts_that_hold
from deixis.report.renderers import to_rows

TINY = ApprenticePlan(tables=1, seed=3, first_tables=1, layouts=("childs_place",), processes=1)


@pytest.fixture(scope="module")
def found() -> Apprentice:
    return run(TINY)


@pytest.fixture(scope="module")
def script() -> Script:
    return read_script_file(str(example("childs_place.layout")))


def test_small_run_reports_valid_json_and_intervals(found: Apprentice) -> None:
    answer = json.loads(json.dumps(to_dict(found)))
    assert not errors_in("apprentice", answer)
    assert answer["first_tables"] == 1
    assert answer["counts"]["layouts_right"]["of"] == 1
    assert "interval of 95 %" in "\n".join(lines(found))


def test_the_result_is_an_answer(found: Apprentice) -> None:
    assert_is_answer(found)
    shares = {row["figure"]: row["share"] for row in to_rows(found)}
    assert shares["layouts_right"] == found.to_dict()["layouts_right"]


def test_words_teach_new_things_of_the_first_table(found: Apprentice) -> None:
    (lesson,) = found.lessons
    assert lesson.learned.right >= 4
    assert lesson.learned.right == lesson.learned.of


def test_same_seed_makes_the_same_mistakes(script: Script) -> None:
    one, two = (lay_tampered(script, 8, 2) for _ in range(2))
    assert one.mistakes == two.mistakes
    assert len(one.mistakes) == 2
    assert [thing.box.tolist() for thing in one.laid.table.things] == [
        thing.box.tolist() for thing in two.laid.table.things
    ]


def test_mistakes_show_on_the_table(script: Script) -> None:
    clean = {thing.name: thing for thing in lay_tampered(script, 5, 0).laid.table.things}
    for seed in range(5, 9):
        table = lay_tampered(script, seed, 3)
        there = {thing.name for thing in table.laid.table.things}
        for mistake in table.mistakes:
            (first, *_) = mistake.names
            assert (first in there) == (mistake.kind is not MistakeKind.MISSING)
            assert (first in clean) == (mistake.kind is not MistakeKind.EXTRA)


def test_displaced_things_violate_facts_about_things_in_place() -> None:
    script = read_script_file(str(example("tea.layout")))
    table = lay_tampered(script, 9, 3)
    graph = script.graph()
    boxes = {thing.name: thing.box[:, :2] for thing in table.laid.table.things}
    moved = {name for one in table.mistakes for name in one.names}
    nowhere = np.array([[0.0, 0.0], [1e-6, 1e-6]])
    held = facts_that_hold(graph, np.array([boxes.get(node, nowhere) for node in graph.nodes]))
    violated = [
        {fact.subject, fact.object}
        for fact, holds in zip(graph.facts(), held, strict=True)
        if not holds and {fact.subject, fact.object} <= boxes.keys()
    ]
    for one in table.mistakes:
        if one.kind in (MistakeKind.DISPLACED, MistakeKind.SWAPPED):
            others = moved - set(one.names)
            assert any(ends & set(one.names) and not ends & others for ends in violated)


def test_table_without_mistakes_is_as_laid(script: Script) -> None:
    assert lay_tampered(script, 4, 0).mistakes == ()


def test_interval_of_wilson_contains_the_share() -> None:
    low, high = Count(9, 10).interval or (np.nan, np.nan)
    assert low == pytest.approx(0.596, abs=0.002)
    assert high == pytest.approx(0.982, abs=0.002)
    assert Count().interval is None


def test_all_layouts_are_shipped() -> None:
    for name in LAYOUTS:
        assert read_script_file(str(example(f"{name}.layout"))).name == name


def test_plan_counts_first_and_further_tables() -> None:
    assert replace(TINY, tables=4).steps == 5
