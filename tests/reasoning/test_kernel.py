"""Check that kernels give the same results interpreted and compiled, and that numba is imported only when needed."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.deadline import Deadline
from deixis.grammar.layout.parser import parse_script
from deixis.reasoning.kernel import MAX_GIVEN, MAX_INTERPRETED, Kernel, kernel, load_compiled, njit
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.derivation import explain
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import solve
from deixis.reasoning.temporal.errors import TemporalConflictError
from deixis.reasoning.temporal.fluent import AllenStatement, Fluent, Statement
from deixis.reasoning.temporal.timeline import Timeline
from deixis.workflows.layouts.infer import inference_of

WORDS = st.sampled_from(["left of", "right of", "above", "below", "on", "under", "top left of", "bottom right of"])
CHOICES = st.sampled_from(["left of or above", "not above", "right of or on", "not left of"])
NAMES = st.integers(0, 7).map("n{}".format)
FACTS = st.lists(st.tuples(NAMES, WORDS, NAMES).filter(lambda fact: fact[0] != fact[2]), min_size=1, max_size=12)


@kernel()
def doubled(number):  # type: ignore[no-untyped-def]
    return 2 * number


@kernel()
def sum_of_doubles(numbers):  # type: ignore[no-untyped-def]
    total = 0
    for number in numbers:
        total += doubled(number)
    return total


@contextmanager
def given_so_far(elements: int) -> Iterator[None]:
    """Set the elements given to interpreted kernels so far, and restore the number afterwards."""
    before, Kernel.interpreted = Kernel.interpreted, elements
    try:
        yield
    finally:
        Kernel.interpreted = before


def inferred(text: str) -> tuple[Any, ...]:
    """Return everything inferred from a script: the conflict, or the conclusions with their premises."""
    found = inference_of(parse_script(text))
    if found.conflict is not None:
        return (str(found.conflict),)
    facts = [(str(one.fact), one.rule, one.steps, one.lines) for one in found.inferred()]
    return facts, found.implications.ntriples()


def both_ways(answer: Callable[[], Any]) -> tuple[Any, Any]:
    """Return the answers of a small job interpreted, and compiled."""
    with given_so_far(0):
        interpreted = answer()
        assert 0 < Kernel.interpreted <= MAX_INTERPRETED
    with given_so_far(MAX_INTERPRETED + 1):
        return interpreted, answer()


def text_of(facts: list[tuple[str, str, str]]) -> str:
    return "\n".join(f"{subject} {word} {other}" for subject, word, other in facts)


@settings(max_examples=60)
@given(FACTS)
def test_interpreted_and_compiled_inference_agree(facts: list[tuple[str, str, str]]) -> None:
    interpreted, compiled = both_ways(lambda: inferred(text_of(facts)))
    assert interpreted == compiled


@settings(max_examples=30)
@given(FACTS, st.lists(st.tuples(NAMES, CHOICES, NAMES).filter(lambda fact: fact[0] != fact[2]), max_size=4))
def test_interpreted_and_compiled_choices_agree(plain: list[Any], choices: list[Any]) -> None:
    interpreted, compiled = both_ways(lambda: inferred(text_of([*plain, *choices])))
    assert interpreted == compiled


@settings(max_examples=80, deadline=None)
@given(st.data(), st.sampled_from(["point", "allen", "rcc8", "ra", "direction-distance"]), st.integers(2, 6))
def test_interpreted_and_compiled_networks_agree(data: st.DataObject, name: str, size: int) -> None:
    calculus_ = calculus(name)
    things = st.integers(0, size - 1)
    pairs = data.draw(st.lists(st.tuples(things, things).filter(lambda pair: pair[0] < pair[1]), max_size=2 * size))
    atoms = st.lists(st.integers(0, len(calculus_.atoms) - 1), min_size=1, max_size=6, unique=True)
    stated = tuple(Constraint(i, k, sum(1 << atom for atom in data.draw(atoms))) for i, k in pairs)
    network = Network(calculus_, size, stated)

    def answer() -> tuple[Any, ...]:
        closed, found = close(network), solve(network, scenario=True)
        step = explain(network, 0, 1)
        return (
            *(part.tolist() for part in closed.parts),
            (closed.emptied, closed.narrowed, closed.passes),
            (found.verdict, found.choices, found.dead_ends, found.reason),
            found.scenario and found.scenario.constraints,
            None if step is None else str(step),
        )

    with given_so_far(0):
        interpreted = answer()
    with given_so_far(MAX_INTERPRETED + 1):
        assert answer() == interpreted


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(*[st.integers(0, 3)] * 2, st.integers(1, (1 << 13) - 1)), max_size=5))
def test_interpreted_and_compiled_timelines_agree(relations: list[tuple[int, int, int]]) -> None:
    def answer() -> tuple[str, ...]:
        timeline = Timeline([Fluent(f"f{i}", Statement("cup", "on", f"tray {i}")) for i in range(4)])
        for first, second, mask in relations:
            if first != second:
                try:
                    timeline.add(AllenStatement(f"f{first}", mask, f"f{second}"))
                except TemporalConflictError as error:
                    return (str(error),)
        try:
            found = timeline.chronology()
        except TemporalConflictError as error:
            return (str(error),)
        return str(found.masks.tolist()), str(found.spans.tolist()), found.status

    interpreted, compiled = both_ways(answer)
    assert interpreted == compiled


def test_a_large_call_and_all_later_calls_are_compiled() -> None:
    with given_so_far(0):
        assert sum_of_doubles(np.arange(4)) == 12
        assert Kernel.interpreted == 4
        assert sum_of_doubles(np.ones(MAX_GIVEN + 1, np.int64)) == 2 * (MAX_GIVEN + 1)
        assert Kernel.interpreted > MAX_INTERPRETED
        assert sum_of_doubles.dispatcher is not None and sum_of_doubles.dispatcher.signatures  # type: ignore[attr-defined]
        assert sum_of_doubles(np.arange(4)) == 12


def test_many_small_calls_are_compiled_eventually() -> None:
    with given_so_far(MAX_INTERPRETED - 20):
        assert [sum_of_doubles(np.arange(4)) for _ in range(10)] == [12] * 10
        assert Kernel.interpreted > MAX_INTERPRETED


def test_preloaded_kernels_are_not_interpreted() -> None:
    with given_so_far(0):
        load_compiled()
        before = Kernel.interpreted
        assert sum_of_doubles(np.arange(3)) == 6
        assert Kernel.interpreted == before


def test_importing_kernels_imports_no_numba() -> None:
    code = (
        "import sys, deixis.reasoning.grounding.ground, deixis.reasoning.constraints.kernels,"
        " deixis.reasoning.temporal.kernels, deixis.reasoning.entailment.kernels;"
        "sys.exit('numba' in sys.modules or 'scipy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_compiling_does_not_use_up_the_time_limit() -> None:
    squared, cubed = njit()(lambda number: number**2), njit()(lambda number: number**3)  # not kept on disk
    assert squared(3) == 9  # imports numba
    deadline, started = Deadline.after(1000.0), time.monotonic()
    assert cubed(3) == 27
    took = time.monotonic() - started
    assert 1000.0 - deadline.left < max(0.01, 0.5 * took)
