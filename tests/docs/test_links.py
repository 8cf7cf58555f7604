"""Relative links of all Markdown pages lead to files, and their fragments to headings."""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import unquote

import pytest
from consoles import ROOT

MADE_BY_THE_BUILD = ("_pictures/", "python/deixis", "reference/python/")
PAGES = [ROOT / name for name in ("README.md", "ARCHITECTURE.md", "CHANGELOG.md")]
PAGES += [page for page in sorted((ROOT / "docs").rglob("*.md")) if "_build" not in page.parts]
PAGES = [page for page in PAGES if page.exists()]


def links(page: Path) -> list[str]:
    text = re.sub(r"^(`{3,}).*?^\1", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    return re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text))


def headings(page: Path) -> set[str]:
    titles = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.M)
    plain = [re.sub(r"[^\w\s-]", "", title.lower()).strip() for title in titles]
    return {title.replace(" ", "-") for title in plain}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_leads_somewhere(page: Path) -> None:
    for link in links(page):
        path, _, fragment = unquote(link).partition("#")
        if re.match(r"[a-z]+:", link) or any(part in link for part in MADE_BY_THE_BUILD):
            continue
        target = page.parent / path if path else page
        assert target.exists(), f"{page.name}: {link}"
        if fragment and target.suffix == ".md":
            assert fragment in headings(target), f"{page.name}: {link}"
