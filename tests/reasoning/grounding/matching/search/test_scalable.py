"""The scalable engine: always a map, never worse than its start, the best on small problems, in time on large ones."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems
from timing import processor_time_below

from deixis.deadline import Clock, Deadline
from deixis.reasoning.grounding.matching.problem import (
    MatchingError,
    Problem,
    compile_problem,
    to_assignment,
    to_labels,
)
from deixis.reasoning.grounding.matching.search import scalable as module
from deixis.reasoning.grounding.matching.search.local_search import climb, reassign
from deixis.reasoning.grounding.matching.search.scalable import scalable


@settings(max_examples=60, deadline=None)
@given(problems(), st.data())
def test_it_is_a_map_never_worse_than_its_start(problem: Problem, data: st.DataObject) -> None:
    start = np.array(data.draw(st.sampled_from(sorted(every_map(problem)))), dtype=np.int64)
    found = scalable(problem, start=start, effort=0.01)
    problem.require_map(found.assignment)
    assert found.value >= problem.value(start) - 1e-9
    assert found.value == problem.value(found.assignment)


@settings(max_examples=40, deadline=None)
@given(problems())
def test_it_finds_the_best_of_small_problems(problem: Problem) -> None:
    assert scalable(problem).value == pytest.approx(max(every_map(problem).values()), abs=1e-6)


@settings(max_examples=60, deadline=None)
@given(problems(), st.data())
def test_climbing_ends_where_no_move_and_no_swap_helps(problem: Problem, data: st.DataObject) -> None:
    values = every_map(problem)
    n2 = problem.unary.shape[1]
    labels = to_labels(np.array(data.draw(st.sampled_from(sorted(values))), dtype=np.int64), n2)
    climb(labels, compile_problem(problem))
    reached = tuple(to_assignment(labels, n2).tolist())
    for other, value in values.items():
        changed = [i for i in range(len(other)) if other[i] != reached[i]]
        swap = len(changed) == 2 and (other[changed[0]], other[changed[1]]) == (
            reached[changed[1]],
            reached[changed[0]],
        )
        if len(changed) == 1 or swap:
            assert value <= values[reached] + 1e-4  # gains are in single precision


def test_climbing_and_reassigning_end_at_the_deadline() -> None:
    compiled = random_problem(60).compiled
    labels = np.full(60, compiled.unary.shape[1] - 1)
    climb(labels, compiled, Deadline.after(0.0))
    assert reassign(labels, compiled, 20, 0, Deadline.after(0.0)) == 0.0
    assert (labels == compiled.unary.shape[1] - 1).all()
    climb(labels, compiled)
    assert (labels < compiled.unary.shape[1] - 1).any()


def test_the_same_seed_gives_the_same_map() -> None:
    problem = random_problem(60)
    one, two = scalable(problem, seed=3, effort=0.1), scalable(problem, seed=3, effort=0.1)
    assert one.assignment.tolist() == two.assignment.tolist()


def test_past_the_deadline_the_map_is_not_finished() -> None:
    problem = random_problem(300)
    scalable(random_problem(60), effort=0.1)  # loads the compiled code of all steps
    with processor_time_below(2.0):
        found = scalable(problem, Deadline.after(0.1))
    problem.require_map(found.assignment)
    assert not found.finished


class LooksClock(Clock):
    """Clock that advances by a step in seconds with each look of the thread that made it, and by none of others."""

    def __init__(self, step: float) -> None:
        super().__init__()
        self.step, self.looks, self.thread = step, 0, threading.get_ident()

    def now(self) -> float:
        self.looks += threading.get_ident() == self.thread
        return self.looks * self.step


def test_a_short_time_limit_still_cools_all_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[float] = []

    def record(*arguments: Any) -> float:
        seen.extend(arguments[5].tolist())
        return 0.0

    monkeypatch.setattr(module, "anneal", record)
    monkeypatch.setattr(module, "CELLS_PER_CLOCK_CHECK", 1e5)  # so that there are many looks at the clock
    monkeypatch.setattr("deixis.deadline.CLOCK", LooksClock(0.01))
    found = scalable(random_problem(300), Deadline.after(20.0))
    assert not found.finished
    assert seen[-1] == 0.0
    assert sorted(set(seen), reverse=True) == list(dict.fromkeys(seen))
    assert len(set(seen)) == module.SINGLE_TURN_LEVELS + 1


@pytest.mark.parametrize("start", [[0, 0], [0], [5, 1], [-2, 0]])
def test_a_start_that_is_not_a_map_is_refused(start: list[int]) -> None:
    with pytest.raises(MatchingError):
        scalable(random_problem(2), start=np.array(start))


def random_problem(n: int) -> Problem:
    rng = np.random.default_rng(7)
    facts = n * (n - 1) // 2 if n < 3 else 2 * n
    ends = np.array([rng.choice(n, 2, replace=False) for _ in range(facts)]).reshape(-1, 2)
    tables = rng.choice([0.0, 1.0], (4, n, n)).astype(np.float32)
    return Problem(ends, rng.integers(0, 4, facts), tables, np.zeros((n, n)), np.full(n, -1.0))
