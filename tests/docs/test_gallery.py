"""The gallery names every command that draws a picture."""

from __future__ import annotations

import re

import pytest
from consoles import ROOT
from documentation.command_reference import commands, options

PAGE = ROOT / "docs" / "gallery.md"

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="there is no docs/gallery.md")


def test_every_command_that_draws_is_in_the_gallery() -> None:
    drawing = {
        context.command_path.removeprefix("deixis ")
        for command, context in commands()
        if {"--plot", "--story"} & options(command, context)
    }
    text = re.sub(r"\s+", " ", PAGE.read_text(encoding="utf-8"))
    assert len(drawing) > 10
    assert {command for command in drawing if f"deixis {command} " not in text} == set()
