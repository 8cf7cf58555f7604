"""Run the examples of a page of documentation: commands with what they print, files, and Python."""

from __future__ import annotations

import io
import re
import shlex
from contextlib import redirect_stdout
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import pytest
from commands import deixis
from documentation.page_examples import ROOT as ROOT
from documentation.page_examples import Command, examples

FIGURE = re.compile(r"\d+\.\d+|\b1(?=\s*$)")
"""Text that may differ from the page: a decimal number, or a probability of 1 at the end of a line."""


@dataclass(frozen=True)
class Shown:
    """A command as a page shows it, and the lines shown below it."""

    command: str
    lines: tuple[str, ...] = ()

    def run(self) -> tuple[int, str, str]:
        """Run the command in this process, without a shell: exit code, standard output, standard error."""
        program, *arguments = shlex.split(self.command)
        assert program == "deixis"
        return deixis(*arguments)


def blocks(page: Path) -> list[tuple[str, str]]:
    """Return the language and the text of each fenced block; nothing if there is no page (an installed wheel)."""
    return [(example.language, example.text) for example in examples(page)] if page.exists() else []


def shown(page: Path) -> list[Shown]:
    """Return the commands of the consoles of a page, in order."""
    commands = [command for example in examples(page) for command in example.commands()] if page.exists() else []
    return [Shown(command.line, command.printed) for command in commands]


def run_page(page: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> int:
    """Run all examples of a page in a folder, in order, and compare what commands print with what the page shows.

    A command must exit with 0, unless ``$ echo $?`` below it shows another code. A line ``…`` stands for any lines, and
    what follows ``…`` in a line for any text; figures may differ. A console without output below a command says
    nothing about it. Returns the number of examples that were run.
    """
    monkeypatch.chdir(folder)
    monkeypatch.setenv("DEIXIS_MEMORY", str(folder / "memory"))
    if not Path("examples").exists():
        Path("examples").symlink_to(ROOT / "examples")
    names: dict[str, object] = {}
    ran = 0
    for example in examples(page):
        if example.file:
            Path(example.file).write_text(example.text, encoding="utf-8")
        if example.language == "python" and not example.file:
            with redirect_stdout(io.StringIO()):
                exec(compile(example.text, str(page), "exec"), names)
            ran += 1
        commands = example.commands()
        for command, following in pairwise([*commands, None]):
            assert command is not None
            ran += _run_command(command, following, monkeypatch)
    return ran


def _run_command(command: Command, following: Command | None, monkeypatch: pytest.MonkeyPatch) -> int:
    program, _, rest = command.line.partition(" ")
    if program == "export":
        monkeypatch.setenv(*rest.split("=", 1))
        return 0
    if command.line == "echo $?":
        return 0
    if program == "python":
        code, out, err = 0, _output_of_script(rest), ""
    elif program == "pytest":
        code, out, err = *_run_suite(shlex.split(rest)), ""
    else:
        code, out, err = Shown(command.line).run()
    expected = int(following.printed[0]) if following and following.line == "echo $?" else 0
    assert code == expected, (command.line, out, err)
    if command.printed:
        assert _fits(list(command.printed), (out + err).splitlines()), f"{command.line} prints:\n{out}{err}"
    return 1


def _run_suite(arguments: list[str]) -> tuple[int, str]:
    """Run pytest on files of the page in this process: exit code and standard output."""
    with redirect_stdout(io.StringIO()) as out:
        code = pytest.main([*arguments, "--rootdir=.", "-p", "no:cacheprovider", "-p", "no:dash", "-p", "no:xdist"])
    return int(code), out.getvalue()


def _output_of_script(file: str) -> str:
    with redirect_stdout(io.StringIO()) as out:
        exec(compile(Path(file).read_text(encoding="utf-8"), file, "exec"), {"__name__": "__main__"})
    return out.getvalue()


def _fits(shown: list[str], printed: list[str]) -> bool:
    """Return whether printed lines are those shown, ``…`` standing for any number of lines."""
    if not shown:
        return not printed
    if shown[0].strip() == "…":
        return any(_fits(shown[1:], printed[start:]) for start in range(len(printed) + 1))
    return bool(printed) and _same(shown[0], printed[0]) and _fits(shown[1:], printed[1:])


def _same(line: str, printed: str) -> bool:
    start, cut, _ = line.partition("…")
    wanted, found = (" ".join(FIGURE.sub("#", text).split()) for text in (start, printed))
    return found.startswith(wanted) if cut else found == wanted
