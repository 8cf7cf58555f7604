"""Check docs/explanation/detection.md: its Python runs, and it names every setting."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

from deixis.perception.detection.settings import DetectionSettings

PAGE = (Path(__file__).parents[3] / "docs" / "explanation" / "detection.md").read_text(encoding="utf-8")


def test_the_python_on_the_page_runs() -> None:
    programs = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert len(programs) == 2
    exec(compile("\n".join(programs), "docs/explanation/detection.md", "exec"), {})


def test_the_page_names_every_setting() -> None:
    assert [field.name for field in fields(DetectionSettings) if f"`{field.name}" not in PAGE] == []
