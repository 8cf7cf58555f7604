"""The page of licences: every package that is installed for Deixis, with the licence that it has."""

from __future__ import annotations

import re

import pytest
from licences_page import GROUPS, PAGE, ROOT, STRICT, needed, require_said, rows
from packaging.utils import canonicalize_name

TEXT = PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize("group", GROUPS)
def test_every_installed_package_is_on_the_page(group: str) -> None:
    """A package differs between versions of Python (importlib_metadata), so it may stand where none is installed."""
    assert [row for row in rows(group).values() if row not in TEXT.splitlines()] == [], "python tools/licences_page.py"


def test_the_page_names_only_what_the_lock_installs() -> None:
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    locked = {canonicalize_name(name) for name in re.findall(r"^([\w.-]+)==", lock, re.MULTILINE)}
    listed = re.findall(r"^\| ([\w.-]+) \| (?!licence)", TEXT, re.MULTILINE)
    assert len(listed) > 100
    assert {canonicalize_name(name) for name in listed} <= locked


@pytest.mark.parametrize("name", STRICT)
def test_stricter_terms_stand_in_the_packages_own_files(name: str) -> None:
    package = needed("core")[name]
    assert require_said(package) in " ".join(TEXT.split())


def test_no_licence_is_left_unknown() -> None:
    assert re.findall(r"^\| .* \| (?:see .*|BSD|UNKNOWN|) \|$", TEXT, re.MULTILINE) == []
