"""The examples of the pages run as they are: commands print what is shown, files are read, Python runs.

``make docs`` runs those of the gallery and of the JSON answers, since it shows what they draw and print.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from consoles import ROOT, run_page

DOCS = ROOT / "docs"
PAGES = (  # other pages have tests of their own beside the code that they describe
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
    "reference/english",
    "reference/scenes",
    "reference/lint",
)

pytestmark = pytest.mark.skipif(not DOCS.exists(), reason="there is no docs folder")


@pytest.mark.parametrize("page", PAGES)
def test_the_examples_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run_page(DOCS / f"{page}.md", tmp_path, monkeypatch)
