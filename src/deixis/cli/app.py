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
from deixis.cli.completion import keep_completion_fast
from deixis.cli.interrupts import INTERRUPTED, noting_interrupts
from deixis.cli.output import visible_output, what_is_kept
from deixis.cli.values import say_values_in_words

COMMAND_GROUPS = {
    "Layouts": {
        "read": "layouts.read:read",
        "parse": "layouts.parse:parse",
        "fmt": "layouts.fmt:fmt",
        "lint": "layouts.lint:lint",
        "infer": "layouts.infer:infer",
        "imagine": "layouts.imagine:imagine",
        "lsp": "layouts.lsp:lsp",
    },
    "Scenes and perception": {
        "perceive": "scenes.perceive:perceive",
        "recognise": "scenes.recognise:recognise",
        "teach": "scenes.teach:teach",
        "point": "scenes.point:point",
        "relate": "scenes.relate:relate",
        "simulate": "scenes.simulate:simulate",
        "track": "scenes.track:track",
    },
    "Grounding and checking": {
        "ground": "grounding.ground:ground",
        "ask": "grounding.ask:ask",
        "check": "grounding.check:check",
        "retrieve": "grounding.retrieve:retrieve",
    },
    "Descriptions and words": {
        "refer": "descriptions.refer:refer",
        "tell": "descriptions.tell:tell",
        "relation": "descriptions.relation:relation",
        "learn-relation": "descriptions.learn_relation:learn_relation",
    },
    "Memory and queries": {
        "learn": "knowledge.learn:learn",
        "show": "knowledge.show:show",
        "query": "knowledge.query:query",
        "habits": "knowledge.habits:habits",
        "category": "knowledge.category:category_app",
        "recall": "knowledge.recall:recall",
        "unlearn": "knowledge.unlearn:unlearn",
        "episodes": "knowledge.episodes:episodes_app",
        "memory": "knowledge.memory:memory_app",
    },
    "Reasoning": {
        "reason": "reasoning.reason:reason",
        "validate": "reasoning.validate:validate",
        "solve": "reasoning.solve:solve",
        "time": "reasoning.time:time_command",
        "activity": "reasoning.activity:activity_app",
    },
    "Robot and experiments": {
        "robot": "robot.robot:robot_app",
        "demo": "robot.demo:demo",
        "experiment": "robot.experiment:experiment",
    },
}
"""Commands by group, in the order of ``--help``: each as ``module:function``, with its module in ``deixis.cli``."""

COMMANDS = {name: function for group in COMMAND_GROUPS.values() for name, function in group.items()}

MAX_WIDTH = 1000
"""Maximum width of a help text in characters, above that of any terminal, so that the terminal's width is used."""


class FullSummaries(TyperGroup):
    """A group of commands whose help gives the whole summary of each command, wrapped to the terminal's width."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands with their summaries."""
        commands = ((name, self.get_command(ctx, name)) for name in self.list_commands(ctx))
        rows = [(name, command.get_short_help_str(MAX_WIDTH)) for name, command in commands if command is not None]
        with formatter.section("Commands"):
            formatter.write_dl(rows)


COMPLETED_SHELLS = ("bash", "zsh", "fish")
"""Shells with completion."""


COMPLETION_HELP = {
    "install_completion": "Install completion for this shell, or for the one that is named: bash, zsh or fish.",
    "show_completion": "Print the completion script for this shell, or for the one that is named.",
}
"""Help texts of the options that Typer adds."""


class CommandsOnDemand(TyperGroup):
    """The commands of COMMANDS, each imported only when it is called, so that small commands start fast."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands = dict.fromkeys(COMMANDS, self)  # the names, so that a misspelt one gets a suggestion

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the options and arguments; those that Typer adds have help texts of their own."""
        parameters: list[Any] = super().get_params(ctx)
        for parameter in parameters:
            parameter.help = COMPLETION_HELP.get(parameter.name, parameter.help)
        return parameters

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the command line; ``--show-completion`` and ``--install-completion`` may have the name of a shell."""
        if len(args) == 2:
            for parameter in self.get_params(ctx):
                is_completion = parameter.name in ("show_completion", "install_completion")
                if is_completion and args[0] in parameter.opts and parameter.callback is not None:
                    if args[1] not in COMPLETED_SHELLS:
                        allowed = ", ".join(COMPLETED_SHELLS[:-1]) + f" or {COMPLETED_SHELLS[-1]}"
                        raise typer.BadParameter(f"the shell must be {allowed}, got {args[1]}", ctx, parameter)
                    parameter.callback(ctx, parameter, args[1])  # ends the program
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of the commands, in the order of ``--help``."""
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Import a command and return it, or None where there is no command of that name."""
        if cmd_name not in COMMANDS:
            return None
        module, function = COMMANDS[cmd_name].split(":")
        command = getattr(import_module(f"deixis.cli.{module}"), function)
        single = typer.Typer(rich_markup_mode=None)
        if isinstance(command, typer.Typer):
            single.add_typer(command, name=cmd_name, cls=FullSummaries)
        else:
            single.command(cmd_name)(command)
        found = typer.main.get_group(single).commands[cmd_name]
        say_values_in_words(found)
        return found

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands with their summaries, group by group, in columns of one width."""
        width = max(map(len, COMMANDS))
        for title, group in COMMAND_GROUPS.items():
            found = [(name, self.get_command(ctx, name)) for name in group]
            rows = [(f"{name:<{width}}", command.get_short_help_str(MAX_WIDTH)) for name, command in found]
            with formatter.section(title):
                formatter.write_dl(rows)


app = typer.Typer(
    name="deixis",
    cls=CommandsOnDemand,
    help="Ground a description of a laid table in a scene: which object each name refers to, what follows, and what "
    "cannot be known.",
    no_args_is_help=True,
    context_settings={"max_content_width": MAX_WIDTH},
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
    """Run the command line; print an error as one message with exit code 2 or 3, never as a traceback.

    After Ctrl-C, any failure ends the program quietly, with exit code 130.
    """
    with visible_output(), noting_interrupts() as interrupted:
        try:
            app(prog_name="deixis")
        except Exception as error:
            if interrupted.is_set():
                sys.exit(INTERRUPTED)
            _report_error(error)
        except KeyboardInterrupt:
            sys.exit(INTERRUPTED)


def _report_error(error: Exception) -> None:
    """Print the message of an error and end the program."""
    from deixis.errors import DeixisError

    if isinstance(error, DeixisError):
        _fail(error, UNDECIDED if isinstance(error, TimeoutError | MemoryError) else BAD_INPUT)
    if isinstance(error, OSError):
        what = error.strerror or error
        _fail(f"{error.filename}: {what}" if error.filename else f"standard output: {what}{what_is_kept()}")
    if isinstance(error, MemoryError):
        _fail("not enough memory; give a smaller input, or run it with more memory", UNDECIDED)
    if os.environ.get("DEIXIS_DEBUG"):
        raise error
    _fail(f"a defect in Deixis, please report it: {type(error).__name__}: {error} (DEIXIS_DEBUG=1 shows where)")


def _fail(message: str | Exception, code: int = BAD_INPUT) -> None:
    print_note(message)
    sys.exit(code)


def run() -> None:
    """Run the program: set up signals and streams, run the command, and write all of its output.

    A closed pipe ends it quietly; characters that the terminal cannot encode are written as escapes.
    """
    common.started = time.monotonic() - time.process_time()
    if "_DEIXIS_COMPLETE" in os.environ:
        keep_completion_fast()
    gc.set_threshold(100_000)  # imported objects stay; collecting them takes a tenth of the time of a short command
    # idle threads of OpenBLAS sleep after 2^20 cycles instead of 2^26: busy waiting takes 30 ms a thread and command
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
    """Write the buffered output, so that a full disk is reported as an error before the interpreter shuts down."""
    if sys.stdout is None:
        return
    try:
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        _fail(f"standard output: {error.strerror}{what_is_kept()}")


if __name__ == "__main__":
    run()
