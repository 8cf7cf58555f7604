"""Check that missing files and places are found in the built site, and that links to other sites are not followed."""

from __future__ import annotations

from pathlib import Path

from documentation.site_links import broken_links


def test_only_broken_links_are_reported(tmp_path: Path) -> None:
    (tmp_path / "guides").mkdir()
    (tmp_path / "index.html").write_text(
        '<a href="guides/a.html#here">a</a> <a href="guides/a.html#gone">b</a> <a href="https://example.org/x">c</a>'
        '<img src="missing.png"> <a href="guides/">d</a> <a href="#top" id="top">e</a>',
        encoding="utf-8",
    )
    (tmp_path / "guides" / "a.html").write_text('<p id="here"><a href="../index.html">up</a></p>', encoding="utf-8")
    assert broken_links(tmp_path) == [
        "index.html: guides/: there is no such file",
        "index.html: guides/a.html#gone: there is no such place on the page",
        "index.html: missing.png: there is no such file",
    ]
