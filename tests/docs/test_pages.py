"""The examples of the pages run as they are: commands print what is shown, files are read, Python runs.

``make docs`` runs those of the gallery and of the JSON answers, since it shows what they draw and print.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from consoles import ROOT, run_page
from documentation.page_examples import examples

DOCS = ROOT / "docs"
PAGES = (
    "tutorial/checked_table",
    "tutorial/english",
    "explanation/readings",
    "explanation/posterior",
    "explanation/honest_answers",
    "guides/camera",
    "guides/annotations",
    "guides/words",
    "guides/descriptor_and_engine",
    "guides/check",
    "guides/live",
    "guides/refer",
    "guides/tell",
    "guides/habits",
    "guides/activities",
    "guides/recall",
    "guides/expected",
    "guides/unlearn",
    "guides/pointing",
    "guides/blackboard",
    "guides/attributes",
    "guides/testing",
    "guides/robot",
    "guides/simulator",
    "guides/tracking",
    "explanation/features",
    "explanation/learned_meaning",
    "reference/description_logic",
    "reference/perceptual_memory",
    "reference/english",
    "reference/scenes",
    "reference/lint",
)

pytestmark = pytest.mark.skipif(not DOCS.exists(), reason="there is no docs folder")


@pytest.mark.parametrize("page", PAGES)
def test_the_examples_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run_page(DOCS / f"{page}.md", tmp_path, monkeypatch)


RUN_ELSEWHERE = {
    "gallery": "docs/conf.py",
    "reference/json": "docs/conf.py",
    "tutorial/seeing": "tests/docs/test_seeing.py",
    "explanation/asking": "tests/docs/test_asking.py",
    "explanation/detection": "tests/perception/detection/test_detection_doc.py",
    "explanation/open_ended": "tests/perception/recognition/learners/test_open_ended_doc.py",
    "explanation/recognition": "tests/perception/recognition/test_recognition_doc.py",
    "guides/imagine": "tests/deixis/workflows/layouts/test_imagine.py",
    "guides/more_queries": "tests/docs/test_more_queries.py",
    "guides/queries": "tests/memory/semantic/queries/test_queries_doc.py",
    "reference/calculi": "tests/reasoning/qualitative/calculi/test_calculi_doc.py",
    "reference/clouds": "tests/perception/clouds/test_clouds_doc.py",
    "reference/inference": "tests/docs/test_inference.py",
    "reference/networks": "tests/reasoning/qualitative/networks/test_docs.py",
    "reference/time": "tests/deixis/cli/reasoning/test_time.py",
}
"""Other pages with examples, each with the file that runs them."""

TOO_LONG = {"explanation/scoreboard", "guides/apprentice"}
"""Pages with an experiment that takes minutes; the tests of the experiments run small ones."""

STYLE = {"style"}
"""Pages whose Python is a sample of a docstring."""


def test_the_examples_of_every_page_are_run() -> None:
    shown = {
        str(page.relative_to(DOCS).with_suffix(""))
        for page in DOCS.rglob("*.md")
        if "_build" not in page.parts
        and any(example.commands() or example.language in ("python", "sparql") for example in examples(page))
    }
    assert shown - STYLE == {*PAGES, *RUN_ELSEWHERE, *TOO_LONG}
    for page, runner in RUN_ELSEWHERE.items():
        assert page.rpartition("/")[2] in (ROOT / runner).read_text(encoding="utf-8"), (page, runner)


def test_the_python_of_the_apprentice_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for example in examples(DOCS / "guides/apprentice.md"):
        if example.language == "python":
            exec(compile(example.text, "docs/guides/apprentice.md", "exec"), names)
