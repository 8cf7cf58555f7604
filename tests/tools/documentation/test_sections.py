"""Check that public functions have the sections of their parameters and results, and that the check finds gaps."""

from __future__ import annotations

import inspect

import pytest
from documentation.sections import findings, lacks, public_functions, without_example

import deixis
import deixis.testing
from deixis.answers import Answer
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.semantic.store import SemanticMemory
from deixis.robot.robot import Robot

pytest.importorskip("pygls")
pytest.importorskip("matplotlib")


def test_public_functions_have_their_sections() -> None:
    assert list(findings()) == []


def test_functions_of_all_folders_are_public() -> None:
    folders = {function.__module__.split(".")[1] for _, function in public_functions()}
    assert folders >= {"grammar", "learning", "memory", "ontology", "perception", "reasoning", "workflows"}


class Shape:
    def area(self, scale: float) -> float:
        """Return the area.

        Parameters
        ----------
        scale
            Factor.
        factor
            Another name of it.

        Returns
        -------
        float
            The area in square metres.
        """
        return scale


class Square(Shape):
    def area(self, scale: float) -> float:
        """Return the area of the square."""
        return 2 * scale


def test_a_parameter_that_the_function_lacks_is_found() -> None:
    assert lacks(Shape.area) == ["'Parameters' has factor, which the function does not have"]


def test_functions_without_a_result_need_no_returns() -> None:
    def draw() -> None:
        """Draw it."""

    assert lacks(draw) == []


def test_an_overriding_method_inherits_no_incomplete_sections() -> None:
    assert lacks(Square.area, Square) == ["'Parameters' lacks scale", "'Returns' is missing"]


WITHOUT_EXAMPLE = {
    "Prediction": "the answer of `predict`, whose example shows one",
    "Recognised": "needs a memory with taught views; docs/tutorial/seeing.md has examples that run",
    "Unlearned": "needs a memory with lessons; docs/guides/unlearn.md has examples that run",
}
"""Exported names whose docstring has no example, with the reason."""


def test_exported_names_have_examples() -> None:
    exported = {name: getattr(module, name) for module in (deixis, deixis.testing) for name in module.__all__}
    lacking = {name for name, value in exported.items() if ">>> " not in (inspect.getdoc(value) or "")}
    assert lacking == WITHOUT_EXAMPLE.keys()


STORES = (Blackboard, LevelMemory, Robot, SemanticMemory)
"""Classes whose methods need examples besides those that ``deixis`` and ``deixis.testing`` export."""

NEEDS_OPTIONAL_PACKAGE = {
    "plot": "needs matplotlib; examples/ground.ipynb has an example that runs",
    "to_dataframe": "needs pandas; tests/deixis/test_answers.py has an example that runs",
}
"""Methods of :class:`~deixis.answers.Answer` without an example, with the reason."""


def test_methods_of_exported_classes_have_examples() -> None:
    exported = [getattr(module, name) for module in (deixis, deixis.testing) for name in module.__all__]
    classes = [member for member in (*exported, *STORES) if inspect.isclass(member)]
    lacking = {(kind.__name__, name) for kind in classes for name in without_example(kind)}
    answers = [kind.__name__ for kind in classes if issubclass(kind, Answer)]
    assert lacking == {(answer, name) for answer in answers for name in NEEDS_OPTIONAL_PACKAGE}


class Counter:
    """A counter.

    Examples
    --------
    >>> Counter().count(2)
    """

    def count(self, times: int) -> None:
        """Count."""

    def reset(self) -> None:
        """Begin again."""

    @property
    def total(self) -> int:
        """Number of times."""
        return 0


def test_methods_that_no_example_of_the_class_calls_are_found() -> None:
    assert without_example(Counter) == ["reset", "total"]
