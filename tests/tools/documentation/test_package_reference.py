"""Check that the Python reference has a page per package, and a section per module with a public name."""

from __future__ import annotations

import sys
from pathlib import Path

from documentation.package_reference import PACKAGE, has_public, package_page, packages, write_package_pages


def test_every_package_except_the_command_line_has_a_page() -> None:
    found = {name for name, _ in packages()}
    imported = {name.rpartition(".")[0] for name in sys.modules if name.startswith("deixis.")}
    assert {"deixis", "deixis.reasoning.grounding.matching", "deixis.memory.semantic.rdf", "deixis.report"} <= found
    assert {name for name in imported if ".cli" not in name} <= found
    assert not any(".cli" in name or ".examples" in name for name in found)


def test_a_page_has_a_section_for_each_public_module() -> None:
    page = package_page("deixis.workflows.grounding", PACKAGE / "workflows" / "grounding", ())
    assert ".. automodule:: deixis.workflows.grounding.ground\n   :members:" in page
    assert "__init__" not in page


def test_a_module_of_private_names_only_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "private.py").write_text("_a = 1\ndef _f(): ...\n", encoding="utf-8")
    (tmp_path / "public.py").write_text("class Shown: ...\n", encoding="utf-8")
    assert not has_public(tmp_path / "private.py")
    assert has_public(tmp_path / "public.py")


def test_pages_of_removed_packages_are_deleted(tmp_path: Path) -> None:
    (tmp_path / "deixis.gone.rst").write_text("old", encoding="utf-8")
    pages = write_package_pages(tmp_path)
    before = {page: page.stat().st_mtime_ns for page in pages}
    assert not (tmp_path / "deixis.gone.rst").exists()
    assert {page: page.stat().st_mtime_ns for page in write_package_pages(tmp_path)} == before
