"""What a page of documentation shows at a console: commands, and what they print."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from commands import deixis

ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Shown:
    """A command as a page shows it, and the lines shown below it."""

    command: str
    lines: tuple[str, ...] = ()

    def run(self) -> tuple[int, str, str]:
        """Runs it in this process, without a shell: exit code, standard output, standard error."""
        program, *arguments = shlex.split(self.command)
        assert program == "deixis"
        return deixis(*arguments)


def blocks(page: Path) -> list[tuple[str, str]]:
    """The language and the text of each fenced block; none where there is no page, as beside an installed wheel."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    return re.findall(r"^```(\w+|)\n(.*?)^```$", text, re.M | re.S)


def shown(page: Path) -> list[Shown]:
    """The commands of a page's consoles, in order."""
    found: list[Shown] = []
    for language, text in blocks(page):
        for line in text.splitlines() if language == "console" else ():
            if line.startswith("$ "):
                found.append(Shown(line[2:]))
            else:
                found[-1] = Shown(found[-1].command, (*found[-1].lines, line))
    return found
