"""Read the examples of a page, and run them.

An example is a fenced block: ``console`` (commands after ``$``, with what they print), ``python``, or any block with a
``:caption:``, which is a file of that name. The tests run all of them; ``make docs`` runs those of the pages that show
pictures which their commands draw.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
FENCE = re.compile(
    r"^(`{3,}|:{3,})(?:\{(?P<directive>[\w-]+)\} ?)?(?P<language>[\w-]*)\n(?P<body>.*?)^\1$", re.M | re.S
)
OPTIONS = re.compile(r"\A(?::(\w+): ?(.*)\n)+\n?")


@dataclass(frozen=True)
class Command:
    """A command of a console block, without ``$``, and the lines that the page shows below it."""

    line: str
    printed: tuple[str, ...] = ()


@dataclass(frozen=True)
class Example:
    """A fenced block of a page.

    Parameters
    ----------
    language
        The language of the block, such as ``console`` or ``python``; empty if none is stated.
    text
        The text of the block, without options.
    file
        The name of the file that the block is; None for all other blocks.
    """

    language: str
    text: str
    file: str | None = None

    def commands(self) -> list[Command]:
        """Return the commands of a console block, in order; a line that ends with a backslash continues."""
        found: list[Command] = []
        for line in self.text.replace("\\\n", "").splitlines() if self.language == "console" else ():
            if line.startswith("$ "):
                found.append(Command(line[2:]))
            elif found:
                found[-1] = Command(found[-1].line, (*found[-1].printed, line))
        return found


def examples(page: Path) -> list[Example]:
    """Return the fenced blocks of a page, in order."""
    return list(_examples(page.read_text(encoding="utf-8")))


def _examples(text: str) -> Iterator[Example]:
    for block in FENCE.finditer(text):
        if block["directive"] not in (None, "code-block"):
            continue
        body, file = block["body"], None
        if options := OPTIONS.match(body):
            caption = re.search(r"^:caption: ?(.*)$", options[0], re.M)
            body, file = body[options.end() :], caption and caption[1].strip("` ")
        yield Example(block["language"], body, file or None)


@dataclass(frozen=True)
class Ran:
    """A command that was run, and its standard output."""

    command: Command
    output: str


def run_commands(page: Path, folder: Path) -> list[Ran]:
    """Write the files and run the ``deixis`` commands of a page in a folder; a memory there is the default one.

    Parameters
    ----------
    page
        A page of the documentation.
    folder
        The folder to run in. What was in it is removed; it gets a link to the shipped examples.

    Returns
    -------
    list of Ran
        The commands of ``deixis``, in order.

    Raises
    ------
    RuntimeError
        If a command ends with an exit code other than 0 (done), 1 (the answer is no) and 3 (undecided).
    """
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "examples").symlink_to(ROOT / "examples")
    environment = {**os.environ, "DEIXIS_MEMORY": "memory"}
    done: list[Ran] = []
    for example in examples(page):
        if example.file:
            (folder / example.file).write_text(example.text, encoding="utf-8")
        for command in example.commands():
            program, _, rest = command.line.partition(" ")
            if program == "export":
                name, value = rest.split("=", 1)
                environment[name] = value
            elif program == "deixis":
                words = [sys.executable, "-m", "deixis", *shlex.split(rest)]
                ran = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
                if ran.returncode not in (0, 1, 3):
                    raise RuntimeError(f"{page.name}: {command.line}: exit code {ran.returncode}: {ran.stderr}")
                done.append(Ran(command, ran.stdout))
    return done
