"""Run every example of docs/reference/calculi.md, and compare its table of calculi with the code."""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example
from deixis.reasoning.qualitative.calculi.registry import CALCULI, calculus
from deixis.reasoning.qualitative.relate import RELATED

PAGE = Path(__file__).parents[4] / "docs" / "reference" / "calculi.md"
TEXT = PAGE.read_text(encoding="utf-8")
CONSOLE = re.findall(r"^\$ deixis (.*)\n((?:[^$`].*\n)*)", TEXT, re.MULTILINE)


def test_python_examples_give_the_results_on_the_page() -> None:
    """Run them together, as later ones build on earlier ones."""
    blocks = "\n".join(re.findall(r"^```python\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL))
    page = doctest.DocTestParser().get_doctest(blocks, {}, PAGE.name, str(PAGE), 0)
    assert len(page.examples) > 30
    report: list[str] = []
    assert doctest.DocTestRunner(verbose=False).run(page, out=report.append).failed == 0, "".join(report)


@pytest.mark.parametrize(("command", "expected"), CONSOLE, ids=[command for command, _ in CONSOLE])
def test_commands_print_the_output_on_the_page(command: str, expected: str) -> None:
    words = [example(Path(word).name) if word.startswith("examples/") else word for word in shlex.split(command)]
    assert deixis(*words) == (0, expected, "")


def test_there_are_commands() -> None:
    assert len(CONSOLE) >= 2


def test_the_table_names_every_calculus_with_its_number_of_atoms() -> None:
    rows = re.findall(r"^\| `([a-z0-9-]+)` \| [^|]+ \| (\d+) \|", TEXT, re.MULTILINE)
    assert [(name, int(number)) for name, number in rows] == [(name, len(calculus(name).atoms)) for name in ORDER]
    assert set(ORDER) == set(CALCULI)


ORDER = ("point", "allen", "ra", "ba", "cd", "rcc5", "rcc8", "ten", "distance", "direction-distance")


def test_every_relatable_calculus_is_described() -> None:
    assert all(f"`{name}`" in TEXT for name in RELATED)
