"""docs/explanation/open_ended.md: its Python runs, and it names every learner and every measure."""

from __future__ import annotations

import re
from pathlib import Path

from deixis.perception.recognition.learners.committee import Committee
from deixis.perception.recognition.learners.instance_based import InstanceBased
from deixis.perception.recognition.learners.naive_bayes import NaiveBayes
from deixis.perception.recognition.learners.one_class import SupportVectorDescription
from deixis.perception.recognition.learners.teaching import Teaching
from deixis.perception.recognition.learners.vector_quantisation import VectorQuantisation
from deixis.perception.recognition.settings import SHRINKAGE

PAGE = (Path(__file__).parents[4] / "docs" / "explanation" / "open_ended.md").read_text(encoding="utf-8")
TEXT = " ".join(PAGE.split())


def test_the_python_on_the_page_runs() -> None:
    for program in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL):
        exec(compile(program, "docs/explanation/open_ended.md", "exec"), {})


def test_the_page_names_every_learner() -> None:
    for learner in (InstanceBased, SupportVectorDescription, Committee, VectorQuantisation, NaiveBayes):
        assert f"| `{learner.__name__}` |" in PAGE


def test_the_page_states_the_settings_of_the_teacher() -> None:
    usual = Teaching()
    assert (usual.first, usual.window, usual.patience) == (3, 3, 100) and "by three views" in TEXT
    assert f"the last {usual.window}n answers" in TEXT and f"above {usual.threshold:g}" in TEXT
    assert f"after {usual.patience} answers" in TEXT and f"s = {SHRINKAGE:g}" in TEXT
