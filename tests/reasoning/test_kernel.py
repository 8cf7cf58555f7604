"""Kernels: interpreted and compiled they do the same, and numba is imported only where there is work for it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.grammar.parser import parse_script
from deixis.reasoning.kernel import MAX_GIVEN, MAX_INTERPRETED, Kernel, kernel, load_compiled
from deixis.workflows.infer import inference_of

WORDS = st.sampled_from(["left of", "right of", "above", "below", "on", "under", "top left of", "bottom right of"])
NAMES = st.integers(0, 7).map("n{}".format)
FACTS = st.lists(st.tuples(NAMES, WORDS, NAMES).filter(lambda fact: fact[0] != fact[2]), min_size=1, max_size=12)


@kernel
def doubled(number):  # type: ignore[no-untyped-def]
    return 2 * number


@kernel
def sum_of_doubles(numbers):  # type: ignore[no-untyped-def]
    total = 0
    for number in numbers:
        total += doubled(number)
    return total


@contextmanager
def given_so_far(elements: int) -> Iterator[None]:
    """So many elements were given to interpreted kernels so far; afterwards as many as before."""
    before, Kernel.interpreted = Kernel.interpreted, elements
    try:
        yield
    finally:
        Kernel.interpreted = before


def inferred(text: str) -> tuple[Any, ...]:
    """All that is inferred from a script: the conflict, or what follows, with what it rests on."""
    found = inference_of(parse_script(text))
    if found.conflict is not None:
        return (str(found.conflict),)
    facts = [(str(one.fact), one.rule, one.steps, one.lines) for one in found.inferred()]
    return facts, found.implications.ntriples()


@settings(max_examples=60)
@given(FACTS)
def test_interpreted_and_compiled_inference_agree(facts: list[tuple[str, str, str]]) -> None:
    text = "\n".join(f"{subject} {word} {other}" for subject, word, other in facts)
    with given_so_far(0):
        interpreted = inferred(text)
        assert 0 < Kernel.interpreted <= MAX_INTERPRETED
    with given_so_far(MAX_INTERPRETED + 1):
        assert inferred(text) == interpreted


def test_a_call_with_many_elements_is_compiled_and_so_are_all_after_it() -> None:
    with given_so_far(0):
        assert sum_of_doubles(np.arange(4)) == 12
        assert 4 <= Kernel.interpreted < 20
        assert sum_of_doubles(np.ones(MAX_GIVEN + 1, np.int64)) == 2 * (MAX_GIVEN + 1)
        assert Kernel.interpreted > MAX_INTERPRETED
        assert sum_of_doubles.dispatcher is not None and sum_of_doubles.dispatcher.signatures  # type: ignore[attr-defined]
        assert sum_of_doubles(np.arange(4)) == 12


def test_many_small_calls_are_compiled_in_the_end() -> None:
    with given_so_far(MAX_INTERPRETED - 20):
        assert [sum_of_doubles(np.arange(4)) for _ in range(10)] == [12] * 10
        assert Kernel.interpreted > MAX_INTERPRETED


def test_what_is_loaded_in_advance_is_not_interpreted() -> None:
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
