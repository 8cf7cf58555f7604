"""Test the examples of a page: commands with their output, files by caption, directives left out."""

from __future__ import annotations

from pathlib import Path

import pytest
from documentation.page_examples import Command, Example, examples, run_commands

PAGE = """\
Text with `code`.

```{code-block} layout
:caption: tea.layout
fork left of plate
```

```console
$ deixis parse tea.layout \\
  --json
…
$ echo $?
0
```

```{toctree}
not/an/example
```
"""


@pytest.fixture
def page(tmp_path: Path) -> Path:
    file = tmp_path / "page.md"
    file.write_text(PAGE, encoding="utf-8")
    return file


def test_files_and_consoles_are_examples_but_not_directives(page: Path) -> None:
    file, console = examples(page)
    assert file == Example("layout", "fork left of plate\n", "tea.layout")
    assert console.commands() == [Command("deixis parse tea.layout   --json", ("…",)), Command("echo $?", ("0",))]


def test_commands_run_in_a_folder_of_their_own(page: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "old.png").touch()
    (ran,) = run_commands(page, folder)
    assert '"subject": "fork"' in ran.output
    assert (folder / "tea.layout").exists()
    assert not (folder / "old.png").exists()


def test_a_command_that_fails_is_an_error_with_its_message(page: Path, tmp_path: Path) -> None:
    page.write_text("```console\n$ deixis parse missing.layout\n```\n", encoding="utf-8")
    with pytest.raises(RuntimeError, match=r"page\.md: deixis parse missing\.layout: exit code 2: .*missing\.layout"):
        run_commands(page, tmp_path / "run")
