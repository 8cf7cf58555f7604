"""The command line. Each command loads, calls and prints; everything heavy is imported by the command that needs it.

Exit codes: 0 done, 1 the answer is no, 2 bad input, 3 undecided within the time limit, 130 interrupted.
"""

from __future__ import annotations

import io
import os
import signal
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.category import register as register_category
from deixis.cli.common import (
    BAD_INPUT,
    NO,
    UNDECIDED,
    AsJson,
    Script,
    print_json,
    print_lines,
)
from deixis.cli.concepts import register as register_concepts
from deixis.cli.experiment import register as register_experiment
from deixis.cli.ground import ground
from deixis.cli.imagine import register as register_imagine
from deixis.cli.infer import infer
from deixis.cli.interrupts import INTERRUPTED, noting_interrupts
from deixis.cli.memory import memory_app
from deixis.cli.reason import reason
from deixis.cli.relate import relate
from deixis.cli.relation import register as register_relation
from deixis.cli.retrieve import retrieve
from deixis.cli.see import register as register_see
from deixis.cli.simulate import register as register_simulate
from deixis.cli.solve import solve
from deixis.cli.time import time_command

app = typer.Typer(
    name="deixis",
    help="Ground a description of a laid table in what is seen: who is who, what follows, what cannot be known.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


class GraphFormat(StrEnum):
    TEXT = "text"
    JSON = "json"
    TURTLE = "turtle"
    DOT = "dot"


def _print_version(wanted: bool) -> None:
    from deixis.version import VERSION

    if wanted:
        print(f"deixis {VERSION}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


@app.command()
def parse(
    script: Script,
    format: Annotated[GraphFormat, typer.Option("--format", help="How to print the facts.")] = GraphFormat.TEXT,
    as_json: AsJson = False,
) -> None:
    """Print the facts of a script with their lines."""
    from deixis.grammar.parser import read_script

    parsed = read_script(script)
    if as_json or format is GraphFormat.JSON:
        from deixis.report.json_answers import script_to_dict

        print_json(script_to_dict(parsed))
    elif format is GraphFormat.TEXT:
        from deixis.report.script import script_lines

        print_lines(script_lines(parsed))
    else:
        from deixis.ontology.export import graph_to_dot, graph_to_turtle

        written = graph_to_turtle if format is GraphFormat.TURTLE else graph_to_dot
        sys.stdout.write(written(parsed.graph()))


@app.command()
def fmt(
    script: Script,
    write: Annotated[bool, typer.Option("--write", "-w", help="Write the file instead of printing it.")] = False,
    check: Annotated[bool, typer.Option("--check", help="Print nothing; exit 1 where the form differs.")] = False,
    as_json: AsJson = False,
) -> None:
    """Print a script in its canonical form, comments kept."""
    from deixis.errors import DeixisError
    from deixis.grammar.format import format_script
    from deixis.grammar.parser import read_script

    if write and check:
        raise DeixisError("fmt: --check and --write exclude each other")
    formatted = format_script(read_script(script))
    same = formatted == Path(script).read_bytes().decode("utf-8-sig")
    if write and not same:
        _replace(Path(script), formatted)
    if as_json:
        print_json({"file": script, "canonical": same, "text": formatted})
    elif not check and not write:
        sys.stdout.write(formatted)
    if check and not same:
        raise typer.Exit(NO)


app.command()(infer)
app.command()(reason)
app.command()(relate)
app.command()(retrieve)
app.command()(solve)
app.command("time")(time_command)


app.command()(ground)


@app.command()
def demo(
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Where the pictures go.")] = Path("out"),
) -> None:
    """Tell the whole story on shipped data."""
    from deixis.cli.demo import tell

    tell(out)


register_concepts(app)
app.add_typer(memory_app, name="memory")
register_experiment(app)
register_imagine(app)
register_relation(app)
register_see(app)
register_category(app)
register_simulate(app)


def _replace(path: Path, text: str) -> None:
    """Writes a file in one step, so that a crash leaves the old one; through a link, and with the file's mode."""
    target = path.resolve()
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        draft.write_text(text, encoding="utf-8", newline="")
        draft.chmod(target.stat().st_mode & 0o7777)
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)


def main() -> None:
    """Runs the command line; errors of Deixis are one message and exit code 2, never a traceback.

    Whatever fails once it was interrupted ends it quietly, with exit code 130.
    """
    with noting_interrupts() as interrupted:
        try:
            app()
        except Exception as error:
            if interrupted.is_set():
                sys.exit(INTERRUPTED)
            _tell(error)
        except KeyboardInterrupt:
            sys.exit(INTERRUPTED)


def _tell(error: Exception) -> None:
    """Ends the program with what an error says."""
    from deixis.errors import DeixisError

    if isinstance(error, DeixisError):
        _fail(str(error), UNDECIDED if isinstance(error, TimeoutError) else BAD_INPUT)
    if isinstance(error, OSError):
        _fail(f"{error.filename or 'standard output'}: {error.strerror or error}")
    if os.environ.get("DEIXIS_DEBUG"):
        raise error
    _fail(f"a defect in Deixis, please report it: {type(error).__name__}: {error} (DEIXIS_DEBUG=1 shows where)")


def _fail(message: str, code: int = BAD_INPUT) -> None:
    print(f"deixis: {message}", file=sys.stderr)
    sys.exit(code)


def run() -> None:
    """The process's entry: a closed pipe ends it quietly, no character is too odd for a terminal, nothing is lost."""
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        main()
    finally:
        _flush()


def _flush() -> None:
    """Writes what is still buffered, so that a full disk is an error and not a remark at the very end."""
    if sys.stdout is None:
        return
    try:
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        _fail(f"standard output: {error.strerror}")


if __name__ == "__main__":
    run()
