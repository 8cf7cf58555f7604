"""Exit codes, options and printing that the commands share."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.output import colour_of, terminal
from deixis.deadline import Deadline
from deixis.printable import visible_line

if TYPE_CHECKING:
    from deixis.answers import Answer
    from deixis.perception.scene import Scene

NO, BAD_INPUT, UNDECIDED = 1, 2, 3

started: float | None = None
"""Start of the process in seconds of ``time.monotonic``; None where the command runs inside another program."""

Script = Annotated[str, typer.Argument(metavar="SCRIPT", help="A layout script (.layout), or English (.txt, or -).")]
SceneFile = Annotated[
    str, typer.Argument(metavar="SCENE", help="A scene (.scene.json), or COCO or LabelMe annotations.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
ENGINE_HELP = (
    "exact: proves the best match; scalable: for large scenes; similarity: the paper's; others: from the literature."
)
TimeLimit = Annotated[float, typer.Option(min=0.0, metavar="SECONDS", help="Answer within this time.")]
MemoryLimit = Annotated[
    float, typer.Option(min=0.01, metavar="GB", help="Refuse a problem that needs more memory, in gigabytes.")
]
HideLabels = Annotated[bool, typer.Option("--hide-labels", help="Ignore the labels in the scene.")]
Image = Annotated[str | None, typer.Option(metavar="NAME", help="Image of a COCO file, by file name or id.")]
MemoryDir = Annotated[
    Path | None,
    typer.Option("--memory", metavar="DIR", help="Folder of the memory (default: $DEIXIS_MEMORY, else in your home)."),
]
NoMemory = Annotated[bool, typer.Option("--no-memory", help="Do not use the memory.")]
Picture = Annotated[Path | None, typer.Option("--plot", metavar="FILE", help="Draw the answer (.png, .svg, .pdf).")]

PerceivedScene = Annotated[str, typer.Argument(metavar="SCENE", help="A scene that perceive wrote, with clouds.")]


def print_json(data: Any) -> None:
    """Print plain data as indented JSON."""
    print(json.dumps(data, indent=2, ensure_ascii=False))


def print_line(line: str) -> None:
    """Print one line, with line ends and control characters in it as escapes; a marked line in its colour."""
    colour = colour_of(line)
    if colour is None:
        print(visible_line(line))
    else:
        terminal(sys.stdout).write(f"\x1b[{colour}m{visible_line(line)}\x1b[0m\n")


def print_lines(lines: Iterable[str]) -> None:
    """Print lines, each as :func:`print_line` does."""
    for line in lines:
        print_line(line)


def print_written(*files: Path | None, aside: bool = False) -> None:
    """Print the name of each file that was written, skipping None; on standard error if ``aside``."""
    for file in files:
        if file is not None:
            print(visible_line(f"Written: {file}"), file=sys.stderr if aside else sys.stdout)


def draw_answer(answer: Answer, plot: Path | None, as_json: bool) -> None:
    """Draw an answer to a file, if there is one, and print the name of the file unless the output is JSON."""
    if plot is None:
        return
    from deixis.cli.progress import progress_bar
    from deixis.plots.figure import save

    with progress_bar("drawing"):
        save(answer.plot(), plot)
    if not as_json:
        print_written(plot)


def print_or_write(text: str, out: Path | None) -> None:
    """Print a text as it is, or write it to a file and print the name of the file."""
    from deixis.text_files import replace_text

    if out is None:
        sys.stdout.write(text)
    else:
        replace_text(out, text)
        print_written(out)


def require_writable(written: Iterable[Path | None], read: Iterable[str | Path | None]) -> None:
    """Check, before any work, that files can be written and are neither read nor written twice.

    Raises
    ------
    DeixisError
        Where a file is a folder, is among the files to read, is named twice, or its folder cannot be created.
    """
    from deixis.errors import DeixisError

    sources = [Path(source) for source in read if source is not None]
    files = [file for file in written if file is not None]
    for place, file in enumerate(files):
        if file.is_dir():
            raise DeixisError(f"{file}: this is a folder; name a file")
        if file.exists() and any(source.exists() and file.samefile(source) for source in sources):
            raise DeixisError(f"{file}: this is an input file; name another file to write")
        if file.resolve() in [other.resolve() for other in files[:place]]:
            raise DeixisError(f"{file}: two outputs have this name; name a different file for each")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise DeixisError(f"{file}: its folder cannot be created: {error.strerror}") from error


def require_plot(file: Path | None) -> None:
    """Check, before any work, that a picture can be written; raise DeixisError otherwise."""
    if file is not None:
        from deixis.plots.figure import require_picture

        require_picture(file)


def require_ending(file: Path, endings: tuple[str, ...], what: str) -> None:
    """Check, before any work, that a file's name ends as ``what`` requires; raise DeixisError otherwise."""
    from deixis.errors import DeixisError

    if not file.name.lower().endswith(endings):
        raise DeixisError(f"{file}: the name of {what} must end in {' or '.join(endings)}")


def require_scene_name(file: Path | None) -> None:
    """Check that the name of a scene ends in ``.json``, so that it does not overwrite a picture or a script."""
    if file is not None:
        require_ending(file, (".json",), "a scene")


def require_memory(folder: Path | None) -> None:
    """Check that a folder that the user named has a memory; raise MemoryFormatError otherwise."""
    from deixis.session import Session

    if folder is None:
        return
    with Session(folder) as session:
        if not session.has_views() and not session.remembers():
            session.memory()  # raises MemoryFormatError


def deadline_of(time_limit: float) -> Deadline:
    """Return the deadline of a time limit in seconds, counted from the start of the process."""
    return Deadline.after(time_limit if started is None else time_limit - (time.monotonic() - started))


def tell_of_compiling() -> None:
    """Print a note on a terminal when code has to be compiled, as after an installation."""
    from functools import cache

    from deixis.reasoning.kernel import when_compiling

    if sys.stderr.isatty():
        when_compiling(cache(lambda: print_note("compiling, once; this may take a minute")))


def note_unit(scene: Scene) -> None:
    """Print a note on standard error if the things of a scene are so large or small that its unit must be wrong."""
    from deixis.learning.lessons.scene_evidence import unit_notes
    from deixis.ontology.tbox import default_ontology

    for note in unit_notes(scene, (), default_ontology()):
        print_note(note)


def print_note(note: str | Exception) -> None:
    """Print a note, or the message of an error, on standard error; a note stays on one line."""
    shown = note if isinstance(note, Exception) else visible_line(note)
    print(f"deixis: {shown}", file=sys.stderr)
