"""Compile loops over arrays with numba, on their first call instead of at import.

Loading numba and compiled code takes about half a second of processor time; a script of a dozen objects runs some
milliseconds of such loops in Python. So a kernel whose work can be estimated is interpreted while there is little to
do. Both ways run the same function and give the same answer. Kernels of grounding, which always have much to do, run
machine code that is loaded without numba (``native``). The clock of all deadlines stands still while code is
compiled, which happens once after an installation: compiling uses up no time limit. Loading compiled code does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, cached_property
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

from deixis.deadline import CLOCK

if TYPE_CHECKING:
    from deixis.reasoning.native import NativeKernel

MAX_GIVEN = 100_000
"""Maximum number of steps of one interpreted call; a step takes at most half a microsecond."""

MAX_INTERPRETED = 1_000_000
"""Maximum number of steps of all interpreted calls of a process: as long as loading compiled code takes."""

Steps = Callable[..., int]
"""Function that estimates the steps of a call from its arguments; by default the elements of the arrays."""


def elements(*arguments: Any) -> int:
    """Return the total number of elements of the arrays among the arguments.

    Parameters
    ----------
    arguments
        Arguments of a kernel, arrays or others.

    Returns
    -------
    int
        The total number of elements.
    """
    return sum(getattr(argument, "size", 0) for argument in arguments)


class Kernel:
    """A function over numbers and arrays in the part of Python that numba compiles (nopython mode).

    A kernel with ``steps`` is interpreted until a call takes more than ``MAX_GIVEN`` steps, or all calls together more
    than ``MAX_INTERPRETED``. From then on, every kernel of the process runs compiled; numba keeps the compiled code on
    disk. Kernels may call kernels. ``options`` are those of ``numba.njit``.

    The machine code of some kernels is kept in files of our own too (:func:`keeping_machine_code`), and runs without
    numba until numba has loaded the kernel for another reason.
    """

    interpreted = 0
    """Steps of all interpreted calls so far; above MAX_INTERPRETED, kernels run compiled."""

    keeps_machine_code = False
    """True to keep the machine code of every kernel that is called."""

    def __init__(self, function: Callable[..., Any], steps: Steps | None, **options: Any) -> None:
        self.function, self.steps, self.options = function, steps, options
        self.dispatcher: Callable[..., Any] | None = None  # the dispatcher of numba, after `load`
        self.__name__, self.__doc__, self.__module__ = function.__name__, function.__doc__, function.__module__

    def __call__(self, *arguments: Any) -> Any:
        """Run the function, interpreted while there is little to do."""
        if self.steps is not None and interprets():
            steps = self.steps(*arguments)
            Kernel.interpreted += steps if steps <= MAX_GIVEN else MAX_INTERPRETED + 1
            if interprets():
                return self.interpretation(*arguments)
        raised = False
        if self.dispatcher is None and self.native is not None and not Kernel.keeps_machine_code:
            ran, result = self.native.run(arguments)
            if ran:
                return result
            raised = result is self.native.RAISED
        result = (self.dispatcher or self.load())(*arguments)  # after an error, it is raised again by numba
        if raised:
            raise AssertionError(f"{self.__name__} raised an error, and then none with arguments that it had changed")
        if Kernel.keeps_machine_code and self.native is not None:
            self.native.keep(self.dispatcher, arguments)
        return result

    @cached_property
    def native(self) -> NativeKernel | None:
        """The kept machine code; None for kernels that numba does not keep either."""
        from deixis.reasoning.native import NativeKernel

        if not self.options.get("cache"):
            return None
        return NativeKernel(self.function, [other.function for other in self._all_called()], self.options)

    def _all_called(self) -> list[Kernel]:
        """Return the kernels that this one calls, and that these call, in a fixed order."""
        found: dict[Kernel, None] = {}
        waiting: list[Kernel] = [self]
        for one in waiting:
            for other in one._called().values():
                if other not in found:
                    found[other] = None
                    waiting.append(other)
        return list(found)

    @cached_property
    def interpretation(self) -> Callable[..., Any]:
        """The function with the kernels that it calls replaced by plain functions; only its own steps are counted."""
        return self._calling(lambda other: other.interpretation)

    def load(self) -> Callable[..., Any]:
        """Load numba's dispatcher of the function, in which the kernels that it calls are dispatchers too.

        Returns
        -------
        callable
            The dispatcher.
        """
        self.dispatcher = self.compiled(self._calling(lambda other: other.dispatcher or other.load()))
        return self.dispatcher

    def _calling(self, chosen: Callable[[Kernel], Callable[..., Any]]) -> Callable[..., Any]:
        """Return the function with each kernel that it calls replaced by ``chosen(kernel)``."""
        scope = self.function.__globals__
        others = {name: chosen(other) for name, other in self._called().items()}
        return FunctionType(self.function.__code__, {**scope, **others}) if others else self.function

    def _called(self) -> dict[str, Kernel]:
        """Return the kernels that the function calls, by the names that it has for them."""
        scope = self.function.__globals__
        named = {name: scope.get(name) for name in self.function.__code__.co_names}
        return {name: other for name, other in named.items() if isinstance(other, Kernel)}

    def compiled(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the compiled version of the function.

        Parameters
        ----------
        function
            A Python function.

        Returns
        -------
        callable
            Its compiled version.
        """
        dispatcher: Callable[..., Any] = _numba().njit(**self.options)(function)
        return dispatcher


class Instruction(Kernel):
    """An operation with a processor instruction: ``intrinsic`` returns numba's, ``function`` is interpreted."""

    def __init__(self, function: Callable[..., Any], intrinsic: Callable[[], Callable[..., Any]]) -> None:
        super().__init__(function, steps=None)
        self.intrinsic = intrinsic

    def __call__(self, *arguments: Any) -> Any:
        """Run the function interpreted."""
        return self.function(*arguments)

    def compiled(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return numba's version.

        Parameters
        ----------
        function
            A Python function.

        Returns
        -------
        callable
            Numba's version.
        """
        return self.intrinsic()


def kernel(steps: Steps = elements, **options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """Return a decorator that makes a function a kernel, interpreted while its calls take few steps.

    Parameters
    ----------
    steps
        Function of the arguments of a call that estimates its number of steps.
    options
        Options of ``numba.njit``.

    Returns
    -------
    callable
        The decorator.

    Examples
    --------
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
    """Return the decorator ``numba.njit(**options)``, but import numba only when the kernel is first called.

    Parameters
    ----------
    options
        Options of ``numba.njit``.

    Returns
    -------
    callable
        The decorator.
    """
    return lambda function: Kernel(function, None, **options)


def interprets() -> bool:
    """Return whether kernels with little to do are still interpreted.

    Returns
    -------
    bool
        False once enough steps were interpreted, or kernels were compiled on purpose.
    """
    return Kernel.interpreted <= MAX_INTERPRETED


def load_compiled() -> None:
    """Run every kernel compiled from now on."""
    Kernel.interpreted = MAX_INTERPRETED + 1


@contextmanager
def keeping_machine_code() -> Iterator[None]:
    """Store the machine code of every kernel that is called in this context, so that it runs without numba later.

    Yields
    ------
    None
        Nothing.
    """
    Kernel.keeps_machine_code = True
    try:
        yield
    finally:
        Kernel.keeps_machine_code = False


def when_compiling(tell: Callable[[], object]) -> None:
    """Call a function whenever numba compiles a function that is not kept on disk, which takes seconds.

    Parameters
    ----------
    tell
        The function.
    """
    _COMPILE_LISTENERS.append(tell)


_COMPILE_LISTENERS: list[Callable[[], object]] = []


@cache
def _numba() -> ModuleType:
    """Import numba and make it stop the clock while it compiles."""
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
            for tell in _COMPILE_LISTENERS:
                tell()

        def on_end(self, event: Any) -> None:
            pass

    event.register("numba:compile", Stop())  # type: ignore[no-untyped-call]
    event.register("numba:compile", Tell())  # type: ignore[no-untyped-call]
    imported, linalg.ensure_blas = linalg.ensure_blas, lambda: None
    try:  # this module checks whether scipy has a BLAS, which takes 0.1 s; no kernel of ours calls BLAS
        import numba.np.arraymath
    finally:
        linalg.ensure_blas = imported
    return numba
