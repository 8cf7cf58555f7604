"""Run the Python of docs/reference/networks.md."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[4] / "docs" / "reference" / "networks.md"


def test_the_examples_run(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    exec(compile(code, str(DOCS), "exec"), {})
    assert capsys.readouterr().out.splitlines() == [
        "soup ( < ) coffee   composed",
        "    soup ( d ) dinner   stated",
        "    dinner ( < m ) coffee   stated",
    ]
