"""Loops over arrays that numba compiles, loaded when they are first called and not when their modules are.

Loading numba and compiled code takes about half a second of processor time; a script of a dozen objects needs some
milliseconds of such loops in Python. So kernels whose work can be foreseen are interpreted while there is little to do.
Both ways run the same function, so that both give the same answer. While code is compiled, which happens once after an
installation, the clock of all deadlines stands still: no time limit is spent on it. Loading it counts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, cached_property
from types import FunctionType, ModuleType
from typing import Any

from deixis.deadline import CLOCK

MAX_GIVEN = 100_000
"""Steps of one interpreted call, of which each takes half a microsecond or less."""

MAX_INTERPRETED = 1_000_000
"""Steps of all interpreted calls of a process: by then they have cost what loading costs."""

Steps = Callable[..., int]
"""Returns about how many steps a call takes, from its arguments; the elements of its arrays are the default."""


def elements(*arguments: Any) -> int:
    """Return how many elements the arrays among the arguments have."""
    return sum(getattr(argument, "size", 0) for argument in arguments)


class Kernel:
    """A function in the part of Python that numba compiles (nopython mode), over numbers and arrays.

    One with ``steps`` is interpreted until a call takes more than ``MAX_GIVEN`` of them, or all calls together
    ``MAX_INTERPRETED``. From then on, every kernel of the process runs compiled; numba keeps the compiled code on disk.
    Kernels may call kernels. ``options`` are those of ``numba.njit``.
    """

    interpreted = 0
    """Steps of interpreted calls so far; above MAX_INTERPRETED, kernels run compiled."""

    def __init__(self, function: Callable[..., Any], steps: Steps | None, **options: Any) -> None:
        self.function, self.steps, self.options = function, steps, options
        self.dispatcher: Callable[..., Any] | None = None  # numba's, once it is loaded
        self.__name__, self.__doc__, self.__module__ = function.__name__, function.__doc__, function.__module__

    def __call__(self, *arguments: Any) -> Any:
        if self.steps is not None and interprets():
            steps = self.steps(*arguments)
            Kernel.interpreted += steps if steps <= MAX_GIVEN else MAX_INTERPRETED + 1
            if interprets():
                return self.interpretation(*arguments)
        return (self.dispatcher or self.load())(*arguments)

    @cached_property
    def interpretation(self) -> Callable[..., Any]:
        """The function, in which the kernels that it calls are functions too, whose steps are its own."""
        return self._calling(lambda other: other.interpretation)

    def load(self) -> Callable[..., Any]:
        """Return numba's dispatcher of the function, in which the kernels that it calls are dispatchers too."""
        self.dispatcher = self.compiled(self._calling(lambda other: other.dispatcher or other.load()))
        return self.dispatcher

    def _calling(self, chosen: Callable[[Kernel], Callable[..., Any]]) -> Callable[..., Any]:
        """Return the function with what is chosen for each kernel that it calls."""
        scope = self.function.__globals__
        called = {name: scope.get(name) for name in self.function.__code__.co_names}
        others = {name: chosen(other) for name, other in called.items() if isinstance(other, Kernel)}
        return FunctionType(self.function.__code__, {**scope, **others}) if others else self.function

    def compiled(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return what runs compiled in place of the function."""
        dispatcher: Callable[..., Any] = _numba().njit(**self.options)(function)
        return dispatcher


class Instruction(Kernel):
    """An operation for which the processor has an instruction: ``intrinsic`` returns numba's, the function does it."""

    def __init__(self, function: Callable[..., Any], intrinsic: Callable[[], Callable[..., Any]]) -> None:
        super().__init__(function, steps=None)
        self.intrinsic = intrinsic

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*arguments)

    def compiled(self, function: Callable[..., Any]) -> Callable[..., Any]:
        return self.intrinsic()


def kernel(steps: Steps = elements, **options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """Return the decorator of functions that are interpreted while they take few steps.

    >>> import numpy as np
    >>> @kernel()
    ... def total(numbers):
    ...     found = 0
    ...     for number in numbers:
    ...         found += number
    ...     return found
    >>> int(total.function(np.arange(5)))  # as interpreted
    10
    """
    return lambda function: Kernel(function, steps, cache=True, **options)


def njit(**options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """Return what ``numba.njit`` does, but for importing numba, which waits until a kernel is called."""
    return lambda function: Kernel(function, None, **options)


def interprets() -> bool:
    """Return whether kernels are still interpreted where they have little to do."""
    return Kernel.interpreted <= MAX_INTERPRETED


def load_compiled() -> None:
    """Run every kernel compiled from now on."""
    Kernel.interpreted = MAX_INTERPRETED + 1


def when_compiling(tell: Callable[[], object]) -> None:
    """Call ``tell`` whenever a function is compiled that was not kept on disk, which takes seconds."""
    _TOLD.append(tell)


_TOLD: list[Callable[[], object]] = []


@cache
def _numba() -> ModuleType:
    """Import numba, and have it stop the clock while it compiles."""
    import numba
    from numba.core import event
    from numba.np import linalg

    class Stop(event.Listener):
        def on_start(self, event: Any) -> None:
            CLOCK.stop()

        def on_end(self, event: Any) -> None:
            CLOCK.go_on()

    class Tell(event.Listener):
        def on_start(self, event: Any) -> None:
            for tell in _TOLD:
                tell()

        def on_end(self, event: Any) -> None:
            pass

    event.register("numba:compile", Stop())  # type: ignore[no-untyped-call]
    event.register("numba:compile", Tell())  # type: ignore[no-untyped-call]
    imported, linalg.ensure_blas = linalg.ensure_blas, lambda: None
    try:  # this module looks whether scipy has a BLAS: a tenth of a second for what no kernel of ours calls
        import numba.np.arraymath
    finally:
        linalg.ensure_blas = imported
    return numba
