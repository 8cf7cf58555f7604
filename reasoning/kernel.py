"""Loops over arrays that numba compiles, loaded when they are first called and not when their modules are.

Loading numba and compiled code takes about half a second of processor time; a script of a dozen objects needs some
milliseconds of such loops in Python. So those of :func:`kernel` are interpreted while there is little to do. Both ways
run the same function, so that both give the same answer.
"""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

MAX_GIVEN = 20_000
"""Array elements that an interpreted call may be given."""

MAX_INTERPRETED = 1_000_000
"""Array elements that all interpreted calls of a process may be given: by then they have cost what loading costs."""


class Kernel:
    """A function in the part of Python that numba compiles (nopython mode), over numbers and arrays.

    An ``interpretable`` one is interpreted until a call is given more than ``MAX_GIVEN`` elements, or all calls
    together ``MAX_INTERPRETED``. From then on, every kernel of the process runs compiled; numba keeps the compiled
    code on disk. Kernels may call kernels. ``options`` are those of ``numba.njit``.
    """

    interpreted = 0
    """Elements given to interpreted calls so far; above MAX_INTERPRETED, kernels run compiled."""

    def __init__(self, function: Callable[..., Any], interpretable: bool, **options: Any) -> None:
        self.function, self.interpretable, self.options = function, interpretable, options
        self.dispatcher: Callable[..., Any] | None = None  # numba's, once it is loaded
        self.__name__, self.__doc__, self.__module__ = function.__name__, function.__doc__, function.__module__

    def __call__(self, *arguments: Any) -> Any:
        if self.interpretable and Kernel.interpreted <= MAX_INTERPRETED:
            given = sum(getattr(argument, "size", 0) for argument in arguments)
            Kernel.interpreted += given if given <= MAX_GIVEN else MAX_INTERPRETED + 1
            if Kernel.interpreted <= MAX_INTERPRETED:
                return self.function(*arguments)
        return (self.dispatcher or self.load())(*arguments)

    def load(self) -> Callable[..., Any]:
        """Return numba's dispatcher of the function, in which the kernels that it calls are dispatchers too."""
        from numba import njit

        scope = self.function.__globals__
        called = {name: scope[name] for name in self.function.__code__.co_names if isinstance(scope.get(name), Kernel)}
        loaded = {name: other.dispatcher or other.load() for name, other in called.items()}
        function = FunctionType(self.function.__code__, {**scope, **loaded}) if loaded else self.function
        self.dispatcher = njit(**self.options)(function)
        return self.dispatcher


def kernel(function: Callable[..., Any]) -> Kernel:
    """Return a function as a kernel that is interpreted while there is little to do, for work that grows slowly.

    >>> import numpy as np
    >>> @kernel
    ... def total(numbers):
    ...     found = 0
    ...     for number in numbers:
    ...         found += number
    ...     return found
    >>> int(total.function(np.arange(5)))  # as interpreted
    10
    """
    return Kernel(function, interpretable=True, cache=True)


def njit(**options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """Return what ``numba.njit`` does, but for importing numba, which waits until a kernel is called."""
    return lambda function: Kernel(function, interpretable=False, **options)


def load_compiled() -> None:
    """Run every kernel compiled from now on, so that no time limit is spent on loading or interpreting."""
    Kernel.interpreted = MAX_INTERPRETED + 1
