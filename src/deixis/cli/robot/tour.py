"""Chapters of the demo: printed one after another, and written together as one HTML page with pictures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.cli.progress import progress_bar
from deixis.examples_data import EXAMPLES

if TYPE_CHECKING:
    from rich.console import Console

PAGE = "index.html"
"""Name of the page in the folder of the pictures."""

LEAD = (
    "A person describes how a table is laid. A robot finds which perceived object each word means, learns, and checks "
    "the next table. Each step below shows a command (dark), what it prints, and its picture if it has one. Run the "
    "commands in the folder of the repository."
)
"""First paragraph of the page."""

_STYLE = (
    "body{font-family:sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;line-height:1.4}"
    "pre{background:#f4f4f4;padding:.7rem;overflow-x:auto}pre.command{background:#222;color:#fff}img{max-width:100%}"
)


class Tour:
    """Parts of the demo as they are printed, kept for the page.

    Parameters
    ----------
    console
        The console that the parts are printed on.
    out
        The folder of the pictures and the page.
    chapters
        Number of chapters, for the progress bar that a chapter shows while it prints nothing.
    """

    def __init__(self, console: Console, out: Path, chapters: int) -> None:
        self._total = chapters
        self._waiting = ExitStack()
        self._console = console
        self._out = out
        self._chapters = 0
        self._body: list[str] = []

    def chapter(self, title: str, *commands: str) -> None:
        """Begin a chapter; the page also shows the commands that do the same from a checkout."""
        self._chapters += 1
        heading = f"{self._chapters}. {title}"
        with self._printing():
            self._console.print(f"\n[bold]{heading}[/bold]")
        self._body.append(f"<h2>{escape(heading)}</h2>")
        if commands:
            self._body.append(f'<pre class="command">{escape(chr(10).join(commands))}</pre>')

    @contextmanager
    def _printing(self) -> Iterator[None]:
        """Remove the progress bar while something is printed, and show it again if the next lines take long."""
        self._waiting.close()
        yield
        progress = self._waiting.enter_context(progress_bar("chapters"))
        if progress is not None:
            progress(self._chapters - 1, self._total)

    def close(self) -> None:
        """Remove the progress bar."""
        self._waiting.close()

    def say(self, *lines: str) -> None:
        """Print sentences."""
        with self._printing():
            for line in lines:
                self._console.print(f"   {line}", markup=False)
        self._body.append(f"<p>{escape(' '.join(lines))}</p>")

    def listing(self, lines: Iterable[str]) -> None:
        """Print lines of a file or of an answer; the names of shipped examples are relative to the checkout."""
        shown = [line.replace(f"{EXAMPLES}/", "examples/") for line in lines]
        with self._printing():
            for line in shown:
                if "[" in line:
                    self._console.print(f"   │ {line}", markup=False)
                else:
                    self._console.print(f"   [dim]│[/dim] {line}")
        self._body.append(f"<pre>{escape(chr(10).join(shown))}</pre>")

    def picture(self, name: str, what: str) -> None:
        """Print where a picture is; ``what`` describes it for readers who cannot see it."""
        with self._printing():
            self._console.print(f"   Picture: {relative(self._out / name)}", markup=False)
        self._body.append(f'<p><img src="{escape(name)}" alt="{escape(what)}"></p>')

    def write_page(self) -> None:
        """Write the page beside the pictures, which it names relative to itself, and print where it is."""
        head = f'<meta charset="utf-8"><title>Deixis, step by step</title><style>{_STYLE}</style>'
        body = "\n".join(self._body)
        body = f"<body>\n<h1>Deixis, step by step</h1>\n<p>{escape(LEAD)}</p>\n{body}\n</body>"
        page = f'<!DOCTYPE html>\n<html lang="en">\n<head>{head}</head>\n{body}\n</html>\n'
        file = self._out / PAGE
        file.write_text(page, encoding="utf-8")
        self._waiting.close()
        self._console.print(f"\nAll of this on one page: {relative(file)}", markup=False)


def relative(file: Path) -> Path:
    """Return the path of a file relative to the working folder where it is inside, else as it is."""
    here = Path.cwd()
    return file.relative_to(here) if file.is_relative_to(here) else file
