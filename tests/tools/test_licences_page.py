"""Check that the page of licences has every installed package of Deixis with its licence."""

from __future__ import annotations

import re

import pytest
from licences_page import GROUPS, PAGE, ROOT, STRICT, needed, require_said, rows
from packaging.utils import canonicalize_name

TEXT = PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize("group", GROUPS)
def test_every_installed_package_is_on_the_page(group: str) -> None:
    """Check installed packages only, since some versions of Python need others (importlib_metadata)."""
    assert [row for row in rows(group).values() if row not in TEXT.splitlines()] == [], "python tools/licences_page.py"


def test_the_page_lists_only_packages_of_the_lock() -> None:
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    locked = {canonicalize_name(name) for name in re.findall(r"^([\w.-]+)==", lock, re.MULTILINE)}
    listed = re.findall(r"^\| ([\w.-]+) \| (?!licence)", TEXT, re.MULTILINE)
    assert len(listed) > 100
    assert {canonicalize_name(name) for name in listed} <= locked


@pytest.mark.parametrize("name", STRICT)
def test_the_packages_own_files_contain_the_stricter_terms(name: str) -> None:
    package = needed("core")[name]
    assert require_said(package) in " ".join(TEXT.split())


def test_every_licence_is_known() -> None:
    assert re.findall(r"^\| .* \| (?:see .*|BSD|UNKNOWN|) \|$", TEXT, re.MULTILINE) == []
