"""The version: one number in the package, its metadata, the citation and the changelog."""

from __future__ import annotations

import re
import tomllib

from source_tree import ROOT

import deixis


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_the_version_is_the_same_everywhere() -> None:
    released = re.findall(r"^## (\d+\.\d+\.\d+) \(\d{4}-\d{2}-\d{2}\)$", text("CHANGELOG.md"), re.MULTILINE)
    cited = re.findall(r"^version: (.+)$", text("CITATION.cff"), re.MULTILINE)
    project = tomllib.loads(text("pyproject.toml"))["project"]["version"]
    assert [deixis.__version__, project, *cited] == [released[0]] * 3
