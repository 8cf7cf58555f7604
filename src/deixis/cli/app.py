"""The command line. Each command loads, calls and prints; everything heavy is imported by the command that needs it.

Exit codes: 0 done, 1 the answer is no, 2 bad input, 3 undecided within the time limit, 130 interrupted.
"""

from __future__ import annotations

import io
import os
import signal
import sys
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.ask import ask
from deixis.cli.category import category_app
from deixis.cli.check import check
from deixis.cli.common import BAD_INPUT, UNDECIDED
from deixis.cli.experiment import experiment
from deixis.cli.fmt import fmt
from deixis.cli.ground import ground
from deixis.cli.imagine import imagine
from deixis.cli.infer import infer
from deixis.cli.interrupts import INTERRUPTED, noting_interrupts
from deixis.cli.learn import learn
from deixis.cli.learn_relation import learn_relation
from deixis.cli.memory import memory_app
from deixis.cli.parse import parse
from deixis.cli.perceive import perceive
from deixis.cli.query import query
from deixis.cli.reason import reason
from deixis.cli.recognise import recognise
from deixis.cli.relate import relate
from deixis.cli.relation import relation
from deixis.cli.retrieve import retrieve
from deixis.cli.show import show
from deixis.cli.simulate import simulate
from deixis.cli.solve import solve
from deixis.cli.teach import teach
from deixis.cli.time import time_command
from deixis.cli.validate import validate

app = typer.Typer(
    name="deixis",
    help="Ground a description of a laid table in what is seen: who is who, what follows, what cannot be known.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


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


app.command()(parse)
app.command()(fmt)
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


app.command()(learn)
app.command()(show)
app.command()(check)
app.command()(query)
app.command()(validate)
app.add_typer(memory_app, name="memory")
app.add_typer(experiment, name="experiment")
app.command()(imagine)
app.command()(relation)
app.command("learn-relation")(learn_relation)
app.command()(perceive)
app.command()(teach)
app.command()(recognise)
app.command()(ask)
app.add_typer(category_app, name="category")
app.command()(simulate)


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
