"""What the commands share: exit codes, the options that several of them have, and how they print."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from deixis.cli.output import terminal
from deixis.deadline import Deadline
from deixis.printable import visible_line

NO, BAD_INPUT, UNDECIDED = 1, 2, 3

started: float | None = None
"""When this process began, by ``time.monotonic``, where it is a command's own; it worked all the time until then."""

PATIENCE = 2.0  # seconds without a progress bar

Script = Annotated[str, typer.Argument(metavar="SCRIPT", help="A layout script (.layout).")]
SceneFile = Annotated[
    str, typer.Argument(metavar="SCENE", help="A scene (.scene.json), or COCO or LabelMe annotations.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
ENGINE_HELP = "exact; scalable; similarity: the paper's; and two others from the literature."
TimeLimit = Annotated[float, typer.Option(min=0.0, metavar="SECONDS", help="Answer by then.")]
MemoryLimit = Annotated[
    float, typer.Option(min=0.01, metavar="GB", help="Refuse what takes more memory than so many gigabytes.")
]
HideLabels = Annotated[bool, typer.Option("--hide-labels", help="Look at the scene as if nothing in it were named.")]
Image = Annotated[str | None, typer.Option(metavar="NAME", help="Which image of a COCO file.")]
MemoryDir = Annotated[
    Path | None,
    typer.Option("--memory", metavar="DIR", help="The memory (default: $DEIXIS_MEMORY, else a folder of yours)."),
]
NoMemory = Annotated[bool, typer.Option("--no-memory", help="As if nothing were remembered.")]
Picture = Annotated[Path | None, typer.Option("--plot", metavar="FILE", help="Draw it (.png, .svg, .pdf).")]

PerceivedScene = Annotated[str, typer.Argument(metavar="SCENE", help="A scene that perceive wrote, with clouds.")]


def print_json(data: Any) -> None:
    print(json.dumps(data, indent=2, ensure_ascii=False))


def print_line(line: str) -> None:
    """Print one line, whatever names are in it."""
    print(visible_line(line))


def print_lines(lines: Iterable[str]) -> None:
    for line in lines:
        print_line(line)


def print_written(*files: Path | None, aside: bool = False) -> None:
    """Says where files are, those that were wanted; ``aside``: on standard error, where output is the answer alone."""
    for file in files:
        if file is not None:
            print(visible_line(f"Written: {file}"), file=sys.stderr if aside else sys.stdout)


def require_writable(written: Iterable[Path | None], read: Iterable[str | Path | None]) -> None:
    """Raises DeixisError, before any work, where a file cannot be written, or is read or written for something else."""
    from deixis.errors import DeixisError

    sources = [Path(source) for source in read if source is not None]
    files = [file for file in written if file is not None]
    for place, file in enumerate(files):
        if file.is_dir():
            raise DeixisError(f"{file}: this is a folder; name a file")
        if file.exists() and any(source.exists() and file.samefile(source) for source in sources):
            raise DeixisError(f"{file}: this is what is read; name another file")
        if file.resolve() in [other.resolve() for other in files[:place]]:
            raise DeixisError(f"{file}: two things are to be written here; give each a file of its own")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise DeixisError(f"{file}: its folder cannot be made: {error.strerror}") from error


def require_plot(file: Path | None) -> None:
    """Raises DeixisError, before any work, where a picture is wanted that cannot be written."""
    if file is not None:
        from deixis.plots.figure import require_picture

        require_picture(file)


def require_ending(file: Path, endings: tuple[str, ...], what: str) -> None:
    """Raises DeixisError, before any work, where a file's name does not say what will be in it."""
    from deixis.errors import DeixisError

    if not file.name.lower().endswith(endings):
        raise DeixisError(f"{file}: {what} is a file that ends in {' or '.join(endings)}")


def require_scene_name(file: Path | None) -> None:
    """The same for a scene, so that none is written over a picture or a script."""
    if file is not None:
        require_ending(file, (".json",), "a scene")


def require_memory(folder: Path | None) -> None:
    """Raises MemoryFormatError where a folder is named in which nothing was learned, nor taught."""
    from deixis.session import Session

    if folder is None:
        return
    with Session(folder) as session:
        if not session.has_views() and not session.remembers():
            session.memory()  # raises: there is none


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None] | None]:
    """A progress bar on standard error, on a terminal only, and only for what takes long."""
    if not sys.stderr.isatty():
        yield None
        return
    import time

    from rich.console import Console
    from rich.progress import Progress as Bar

    started = time.perf_counter()
    with Bar(console=Console(file=terminal(sys.stderr)), transient=True) as bar:
        task = bar.add_task(what, total=None, visible=False)

        def progress(done: int, total: int) -> None:
            bar.update(task, completed=done, total=total, visible=time.perf_counter() - started > PATIENCE)

        yield progress


@contextmanager
def working(what: str, after: float = 0.0) -> Iterator[None]:
    """Says on a terminal's standard error what goes on, while nobody knows how long it takes.

    It says so ``after`` so many seconds, for what takes long only the first time.
    """
    if not sys.stderr.isatty():
        yield
        return
    from threading import Timer

    from rich.console import Console

    status = Console(file=terminal(sys.stderr)).status(what)
    begin = Timer(after, status.start)
    begin.start()
    try:
        yield
    finally:
        begin.cancel()
        begin.join()
        status.stop()


def deadline_of(time_limit: float) -> Deadline:
    """Return when a command has to be done that may take so many seconds from the start of its process."""
    return Deadline.after(time_limit if started is None else time_limit - (time.monotonic() - started))


def tell_of_compiling() -> None:
    """Say so on a terminal, once, where code has to be compiled, as it has after an installation."""
    from functools import cache

    from deixis.reasoning.kernel import when_compiling

    if sys.stderr.isatty():
        when_compiling(cache(lambda: print_note("compiling, once; this may take a minute")))


def print_note(note: str | Exception) -> None:
    """Print to standard error, in one line, what is not part of the answer; of an error what it says."""
    shown = note if isinstance(note, Exception) else visible_line(note)
    print(f"deixis: {shown}", file=sys.stderr)
