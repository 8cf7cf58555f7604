"""Test explanations of tables by layouts with few mistakes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from deixis.reasoning.comparison.explanation import NOTHING, MistakeKind, MistakeOdds, TableEvidence, explain

LOOKS = np.full((3, 3), -4.0) + 8.0 * np.eye(3)


def evidence(looks: np.ndarray, order: list[int], turned: int | None = None) -> TableEvidence:
    """Return evidence of three things in a row, of which ``order`` gives the places from left to right."""
    m = looks.shape[1]
    place = np.empty(m)
    place[order] = np.arange(m)
    left = np.where(place[:, None] < place[None, :], 1.0, -4.0)
    poses = m + (turned is not None)
    table, turn = np.zeros((poses, poses)), np.full((3, poses), 2.0)
    table[:m, :m] = left
    straight = np.full((3, m), NOTHING)
    if turned is not None:
        table[m, :m], table[:m, m] = left[turned], left[:, turned]
        turn[turned, turned], straight[turned, turned] = -8.0, m
    np.fill_diagonal(table, 0.0)
    ends = np.array([(0, 1), (1, 2), (0, 2)])
    return TableEvidence(looks, turn, straight, ends, np.zeros(3, np.int64), table[None], np.zeros(3, bool))


def mistakes(table: TableEvidence) -> list[tuple[str, tuple[int, ...], tuple[int, ...]]]:
    return [(one.kind.value, one.roles, one.things) for one in explain(table).mistakes]


def test_table_as_described_has_no_mistakes() -> None:
    found = explain(evidence(LOOKS, [0, 1, 2]))
    assert found.mistakes == ()
    assert found.roles_of.argmax(axis=1).tolist() == [0, 1, 2]
    assert np.all(found.roles_of.max(axis=1) > 0.95)


def test_exchanged_things_are_swapped() -> None:
    assert mistakes(evidence(LOOKS, [2, 1, 0])) == [("swapped", (0, 2), (0, 2))]


def test_things_on_each_other_are_not_swapped() -> None:
    table = evidence(LOOKS, [2, 1, 0])
    fixed = TableEvidence(**{**vars(table), "apart": np.zeros((3, 3), bool)})
    assert all(one.kind is not MistakeKind.SWAPPED for one in explain(fixed).mistakes)


def test_missing_and_extra_things_are_told_apart() -> None:
    assert mistakes(evidence(LOOKS[:, :2], [0, 1])) == [("missing", (2,), ())]
    looks = np.column_stack([LOOKS, np.full(3, -9.0)])
    assert mistakes(evidence(looks, [0, 1, 2, 3])) == [("extra", (), (3,))]


def test_displaced_thing_usually_keeps_its_direction() -> None:
    table = evidence(LOOKS, [0, 1, 2], turned=1)
    table.tables[0, 3, :], table.tables[0, :, 3] = 0.0, 0.0  # nothing holds of the straightened thing
    costs = replace(table, odds=MistakeOdds(displaced=-3.4, turned=-4.0))
    assert mistakes(costs) == [("turned", (1,), (1,))]


def test_turned_thing_is_compared_as_it_should_lie() -> None:
    assert mistakes(evidence(LOOKS, [0, 1, 2], turned=1)) == [("turned", (1,), (1,))]


def test_pieces_of_things_are_not_extra() -> None:
    looks = np.column_stack([LOOKS, np.full(3, -9.0)])
    table = evidence(looks, [0, 1, 2, 3])
    piece = TableEvidence(**{**vars(table), "pieces": np.array([False, False, False, True])})
    assert explain(piece).mistakes == ()


def test_probability_of_a_layout_falls_with_mistakes() -> None:
    values = [explain(evidence(LOOKS, order)).evidence for order in ([0, 1, 2], [2, 1, 0])]
    assert values[0] > values[1] + 3


def test_names_stay_open_where_nothing_tells_things_apart() -> None:
    looks = np.zeros((3, 3))
    table = evidence(looks, [0, 1, 2])
    silent = TableEvidence(**{**vars(table), "tables": np.zeros_like(table.tables)})
    assert explain(silent).roles_of[0].max() < 0.6
