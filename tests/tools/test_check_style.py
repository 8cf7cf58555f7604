"""Test the check of plain English in docstrings, comments, strings and pages."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_style import description_findings, python_findings, text_findings

HERE = Path("module.py")


def messages(source: str) -> list[str]:
    return [str(found) for found in python_findings(HERE, source)]


@pytest.mark.parametrize("opening", ["What", "How", "Whether", "Which", "The same"])
def test_docstrings_that_open_with_a_question_are_found(opening: str) -> None:
    (found,) = messages(f'class Scene:\n    """{opening} of it."""\n')
    assert found == f"module.py:2: docstring opens with '{opening}': say what it is or does"


@pytest.mark.parametrize("opening", ["Least ratio of two sides", "Ratio of two sides from which a thing is long"])
def test_thresholds_are_minimum_or_maximum_values(opening: str) -> None:
    assert messages(f'RATIO = 2.0\n"""{opening}."""\n') == [
        "module.py:2: docstring of a threshold: start with 'Minimum' or 'Maximum', then 'at which'"
    ]
    assert messages('LIKELY = 0.9\n"""Distribution from which samples are drawn."""\n') == []


@pytest.mark.parametrize("name", ["a_spork_is_no_fork", "few_scenes_are_fitted_anew", "a_loss_is_told_at_once"])
def test_wordings_are_found_in_names_of_tests(name: str) -> None:
    (found,) = messages(f"def test_{name}():\n    pass\n")
    assert found.startswith("module.py:1: ")


def test_function_docstrings_start_with_a_verb() -> None:
    assert messages('def area():\n    """Return the area."""\n') == []
    (found,) = messages('def area():\n    """The area."""\n')
    assert found.startswith("module.py:2: docstring of a function opens with 'The'")


def test_nouns_may_open_docstrings_of_properties_and_classes() -> None:
    assert (
        messages('class Box:\n    """A box."""\n\n    @property\n    def area(self):\n        """The area."""\n') == []
    )


def test_attribute_docstrings_are_checked() -> None:
    assert messages('LIMIT = 3\n"""How many there may be."""\n') == [
        "module.py:2: docstring opens with 'How': say what it is or does"
    ]


@pytest.mark.parametrize(
    "wording",
    [
        "but for", "is none", "anew", "is told", "bears", "nobody", "from which on", "been told", "if need be",
        "ever smaller", "is learnt", "and the like", "returns the same for", "tells nothing of", "says nothing of",
    ],
)  # fmt: skip
def test_wordings_are_found_in_comments_strings_and_pages(wording: str) -> None:
    assert len(messages(f"x = 1  # this {wording} that\n")) == 1
    assert len(messages(f'x = f"{{1}} this {wording} that"\n')) == 1
    (found,) = text_findings(Path("page.md"), f"First line.\nThis {wording} that.\n")
    assert found.line == 2


@pytest.mark.parametrize(
    "text",
    [
        "the value is None", "there is no fact", "it is no longer there", "a teddy bear", "any more facts",
        "and others like it", "the same result", "tells them apart",
    ],
)  # fmt: skip
def test_similar_wordings_are_accepted(text: str) -> None:
    assert messages(f"x = 1  # {text}\n") == []


def test_code_in_pages_is_not_checked() -> None:
    assert list(text_findings(Path("page.md"), "```\nit bears anew\n```\n`bears`\n")) == []


def test_names_of_tests_have_a_longest_length() -> None:
    assert len(messages(f"def test_{'x' * 60}():\n    pass\n")) == 1
    assert messages(f"def test_{'x' * 55}():\n    pass\n") == []


def test_descriptions_in_other_languages_are_checked() -> None:
    turtle = 'dx:Fork a owl:Class ;\n    skos:definition "What people eat with."@en .\n'
    (found,) = description_findings(Path("words.ttl"), turtle)
    assert str(found) == "words.ttl:2: description opens with 'What': say what it is or does"
    (found,) = description_findings(Path("a.json"), '{"description": "A text put in the place of another"}')
    assert "write instead of" in found.message
    assert not list(description_findings(Path("a.json"), '{"description": "True if there is no fault"}'))
