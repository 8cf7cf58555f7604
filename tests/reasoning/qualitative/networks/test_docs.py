"""Run the Python of docs/reference/networks.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[4] / "docs" / "reference" / "networks.md"


def test_the_examples_run(capsys: pytest.CaptureFixture[str]) -> None:
    programs = re.findall(r"```python\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    for program in programs:
        exec(compile(program, str(DOCS), "exec"), {})
    assert len(programs) == 2
    assert capsys.readouterr().out.splitlines() == [
        str([f"examples/closed_but_inconsistent.csp:{line}:1" for line in range(2, 8)]),
        "soup ( < ) coffee   composed",
        "    soup ( d ) dinner   stated",
        "    dinner ( < m ) coffee   stated",
    ]
