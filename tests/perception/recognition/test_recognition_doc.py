"""docs/explanation/recognition.md: its Python runs, and its numbers are those of the code."""

from __future__ import annotations

import re
from pathlib import Path

from deixis.perception.recognition.calibration import MIN_HELD_OUT_ANSWERS, SHIPPED
from deixis.perception.recognition.held_out import MAX_HELD_OUT
from deixis.perception.recognition.settings import DEFAULT
from deixis.perception.recognition.spread import MIN_ICD_SHARE

PAGE = (Path(__file__).parents[3] / "docs" / "explanation" / "recognition.md").read_text(encoding="utf-8")
TEXT = " ".join(PAGE.split())


def test_the_python_on_the_page_runs() -> None:
    programs = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert len(programs) == 1
    for program in programs:
        exec(compile(program, "docs/explanation/recognition.md", "exec"), {})


def test_the_constants_on_the_page_are_those_of_the_code() -> None:
    assert f"shipped threshold, {SHIPPED.threshold}," in TEXT
    assert f"fewer than {MIN_HELD_OUT_ANSWERS} held-out answers about known" in TEXT
    assert f"at most {MAX_HELD_OUT}," in TEXT and f"({DEFAULT.exact_up_to:,})" in TEXT
    assert f"below {100 * MIN_ICD_SHARE:.0f} % of that median" in TEXT
    assert (DEFAULT.effort.lists, DEFAULT.effort.few) == (6, 10)
