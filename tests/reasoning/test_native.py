"""Kept machine code gives what numba gives, and whatever cannot be kept runs by numba."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.reasoning.kernel import Kernel, keeping_machine_code, njit
from deixis.reasoning.native import MAGIC, NativeKernel, UnsupportedTypeError, type_of

FACTOR = 3.0
MASK = np.uint64(3)


class Row(NamedTuple):
    """Numbers and weights, as kernels take them."""

    numbers: NDArray[np.float64]
    weights: NDArray[np.float32]


@njit(cache=True)
def weighted(row, power):  # type: ignore[no-untyped-def]
    total, copy = 0.0, np.sort(row.numbers)  # allocates memory
    for i in range(len(copy)):
        total += FACTOR * copy[i] ** power * row.weights[i]
    row.numbers[:] = copy
    return total, len(copy), total > 0


@njit(cache=True)
def divided(first, second):  # type: ignore[no-untyped-def]
    return first // second


@njit(cache=True)
def counted(numbers, limit):  # type: ignore[no-untyped-def]
    numbers[0] += 1
    return 6 // (numbers[0] - limit)


@njit(cache=True)
def doubled(numbers):  # type: ignore[no-untyped-def]
    return 2 * numbers


@njit(cache=True)
def masked(number):  # type: ignore[no-untyped-def]
    return number & MASK


@njit(cache=True)
def shuffled(numbers, seed):  # type: ignore[no-untyped-def]
    np.random.seed(seed)
    np.random.shuffle(numbers)


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Folder with the machine code of the kernels of this module."""
    path = tmp_path_factory.mktemp("native")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NUMBA_CACHE_DIR", str(path))
        with keeping_machine_code():
            weighted(Row(np.ones(2), np.ones(2, np.float32)), 2)
            divided(4, 2)
            counted(np.array([5]), 2)
            doubled(np.ones(2))
            shuffled(np.arange(3), 1)
        yield path


def kept(kernel: Kernel) -> NativeKernel:
    assert kernel.native is not None
    return kernel.native


@settings(max_examples=30)
@given(st.lists(st.floats(-10, 10), max_size=6), st.integers(0, 3))
def test_kept_code_gives_what_numba_gives(numbers: list[float], power: int) -> None:
    ours = Row(np.array(numbers), np.linspace(0, 1, len(numbers), dtype=np.float32))
    theirs = Row(np.array(numbers), ours.weights)
    ran, result = kept(weighted).run((ours, power))
    assert weighted.dispatcher is not None
    assert ran and result == weighted.dispatcher(theirs, power)
    assert [type(one) for one in result] == [float, int, bool]
    np.testing.assert_array_equal(ours.numbers, theirs.numbers)


def test_random_numbers_are_those_of_numba() -> None:
    ours, theirs = np.arange(50), np.arange(50)
    assert kept(shuffled).run((ours, 7)) == (True, None)
    assert shuffled.dispatcher is not None
    shuffled.dispatcher(theirs, 7)
    np.testing.assert_array_equal(ours, theirs)


def test_returned_arrays_and_other_types_are_left_to_numba() -> None:
    assert kept(doubled).run((np.ones(2),)) == (False, None)
    assert kept(weighted).run((Row(np.ones(4)[::2], np.ones(2, np.float32)), 2)) == (False, None)
    assert kept(divided).run((4.0, 2.0)) == (False, None)
    assert doubled(np.ones(2)).tolist() == [2.0, 2.0]


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_error_in_kept_code_is_raised_by_numba() -> None:
    assert kept(divided).run((7, 2)) == (True, 3)
    assert kept(divided).run((7, 0))[0] is False
    with pytest.raises(ZeroDivisionError):
        divided(7, 0)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_error_after_a_change_of_arguments_gives_no_answer() -> None:
    fresh, numbers = Kernel(counted.function, None, **counted.options), np.array([1])
    assert fresh(np.array([2]), 2) == 6 and fresh.dispatcher is None
    with pytest.raises(AssertionError, match="counted raised an error"):
        fresh(numbers, 2)
    assert numbers.tolist() == [3]  # numba ran on what the kept code had changed


@pytest.mark.parametrize("damage", ["flipped", "short", "empty", "gone"])
def test_damaged_code_is_not_loaded(damage: str) -> None:
    path = kept(divided).path("i8,i8")
    content = path.read_bytes()
    assert content.startswith(MAGIC)
    found = NativeKernel(divided.function, [], divided.options)
    assert found.path("i8,i8") == path
    try:
        if damage == "gone":
            path.unlink()
        else:
            middle = len(content) // 2
            flipped = content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]
            path.write_bytes({"flipped": flipped, "short": content[:middle], "empty": b""}[damage])
        assert found.run((7, 2)) == (False, None)
    finally:
        path.write_bytes(content)


def test_code_of_other_constants_or_options_is_another_file() -> None:
    def other(first, second):  # type: ignore[no-untyped-def]
        return first // second + 1

    path = kept(divided).path("i8,i8")
    other.__name__, other.__module__ = "divided", divided.__module__
    assert NativeKernel(other, [], divided.options).path("i8,i8").name != path.name
    assert NativeKernel(divided.function, [], {"cache": True, "fastmath": True}).path("i8,i8") != path
    assert NativeKernel(divided.function, [other], divided.options).path("i8,i8") != path


def test_code_of_other_numpy_constants_is_another_file(monkeypatch: pytest.MonkeyPatch) -> None:
    before = kept(masked).path("u8")
    monkeypatch.setitem(masked.function.__globals__, "MASK", np.uint64(5))
    assert kept(masked).path("u8") != before


def test_types_without_a_c_type_are_refused() -> None:
    for argument in ("text", 2**70, np.array(["a"]), np.ones((2, 2)).T, None):
        with pytest.raises(UnsupportedTypeError):
            type_of(argument)
    assert type_of((True, np.float32(1), Row(np.ones(1), np.ones(1, np.float32)))).startswith("(b1,f4,")
