"""Check that public functions have the sections of their parameters and results, and that the check finds gaps."""

from __future__ import annotations

import inspect

import pytest
from documentation.sections import findings, lacks, public_functions

import deixis
import deixis.testing

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
    "LayoutConcept": "made by learning; the example of Session shows one",
    "QueryResult": "the answer of Session.query, which the example of Session shows",
    "Prediction": "the answer of `predict`, whose example shows one",
    "Recall": "needs a memory with episodes; docs/guides/recall.md has examples that run",
    "Recognised": "needs a memory with taught views; docs/tutorial/seeing.md has examples that run",
    "RecognisedActivity": "needs learned activities; docs/guides/activities.md has examples that run",
    "Unlearned": "needs a memory with lessons; docs/guides/unlearn.md has examples that run",
}
"""Exported names whose docstring has no example, with the reason."""


def test_exported_names_have_examples() -> None:
    exported = {name: getattr(module, name) for module in (deixis, deixis.testing) for name in module.__all__}
    lacking = {name for name, value in exported.items() if ">>> " not in (inspect.getdoc(value) or "")}
    assert lacking == WITHOUT_EXAMPLE.keys()
