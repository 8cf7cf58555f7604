"""The command line. Each command loads, calls and prints; everything heavy is imported by the command that needs it.

Exit codes: 0 done, 1 the answer is no, 2 bad input, 3 undecided within the limits of time and memory, 130 interrupted.
"""

from __future__ import annotations

import gc
import io
import os
import signal
import sys
import time
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from deixis.cli import common
from deixis.cli.common import BAD_INPUT, UNDECIDED, print_note
from deixis.cli.interrupts import INTERRUPTED, noting_interrupts
from deixis.cli.output import visible_output, what_is_kept

COMMANDS = {
    "parse": "parse",
    "fmt": "fmt",
    "infer": "infer",
    "reason": "reason",
    "relate": "relate",
    "retrieve": "retrieve",
    "solve": "solve",
    "time": "time_command",
    "ground": "ground",
    "demo": "demo",
    "learn": "learn",
    "show": "show",
    "check": "check",
    "query": "query",
    "validate": "validate",
    "imagine": "imagine",
    "relation": "relation",
    "learn-relation": "learn_relation",
    "perceive": "perceive",
    "teach": "teach",
    "recognise": "recognise",
    "ask": "ask",
    "simulate": "simulate",
    "memory": "memory_app",
    "experiment": "experiment",
    "category": "category_app",
}
"""The commands in the order of ``--help``: what each is called in the module of ``deixis.cli`` that bears its name."""


class CommandsOnDemand(TyperGroup):
    """The commands of COMMANDS; each is imported when it is called, so that it does not wait for the others."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands = dict.fromkeys(COMMANDS, self)  # the names, of which the nearest is suggested for an unknown one

    def list_commands(self, ctx: Any) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name not in COMMANDS:
            return None
        command = getattr(import_module(f"deixis.cli.{cmd_name.replace('-', '_')}"), COMMANDS[cmd_name])
        alone = typer.Typer(rich_markup_mode=None)
        if isinstance(command, typer.Typer):
            alone.add_typer(command, name=cmd_name)
        else:
            alone.command(cmd_name)(command)
        return typer.main.get_group(alone).commands[cmd_name]


app = typer.Typer(
    name="deixis",
    cls=CommandsOnDemand,
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


def main() -> None:
    """Runs the command line; errors of Deixis are one message and exit code 2, never a traceback.

    Whatever fails once it was interrupted ends it quietly, with exit code 130.
    """
    with visible_output(), noting_interrupts() as interrupted:
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
        _fail(error, UNDECIDED if isinstance(error, TimeoutError | MemoryError) else BAD_INPUT)
    if isinstance(error, OSError):
        what = error.strerror or error
        _fail(f"{error.filename}: {what}" if error.filename else f"standard output: {what}{what_is_kept()}")
    if isinstance(error, MemoryError):
        _fail("there is not enough memory for this; give it less, or more memory", UNDECIDED)
    if os.environ.get("DEIXIS_DEBUG"):
        raise error
    _fail(f"a defect in Deixis, please report it: {type(error).__name__}: {error} (DEIXIS_DEBUG=1 shows where)")


def _fail(message: str | Exception, code: int = BAD_INPUT) -> None:
    print_note(message)
    sys.exit(code)


def run() -> None:
    """The process's entry: a closed pipe ends it quietly, no character is too odd for a terminal, nothing is lost."""
    common.started = time.monotonic() - time.process_time()
    gc.set_threshold(100_000)  # what is imported stays: looking for garbage in it takes a tenth of a short command
    # threads of OpenBLAS that have nothing to do sleep after 2^20 cycles, not 2^26: waiting, each takes 30 ms a command
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "20")
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
        _fail(f"standard output: {error.strerror}{what_is_kept()}")


if __name__ == "__main__":
    run()
