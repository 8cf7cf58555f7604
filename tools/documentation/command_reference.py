"""Write the reference of the commands from the command line itself.

``docs/reference/commands.md`` holds the text around it; ``make docs`` puts the result of ``command_reference`` in.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import typer

from deixis.cli.app import app


def command_reference() -> str:
    """Return a Markdown section for each command and sub-command, in the order of ``deixis --help``.

    Examples
    --------
    >>> text = command_reference()
    >>> "## deixis ground" in text and "### deixis memory export" in text
    True
    """
    return "\n".join(_sections())


def commands() -> Iterator[tuple[Any, Any]]:
    """Yield each command and group of commands with its context, in the order of ``deixis --help``.

    Examples
    --------
    >>> [context.command_path for _, context in commands()][:2]
    ['deixis read', 'deixis parse']
    """

    def below(group: Any, context: Any) -> Iterator[tuple[Any, Any]]:
        for name in group.list_commands(context):
            command = group.get_command(context, name)
            inner = type(context)(command, info_name=name, parent=context)
            yield command, inner
            if hasattr(command, "list_commands"):
                yield from below(command, inner)

    root = typer.main.get_command(app)
    yield from below(root, root.make_context("deixis", [], resilient_parsing=True))


def options(command: Any, context: Any) -> set[str]:
    """Return the names of the options of a command, such as ``--json``."""
    return {name for parameter in command.get_params(context) for name in parameter.opts if name.startswith("-")}


def _sections() -> Iterator[str]:
    for command, context in commands():
        yield f"{'#' * len(context.command_path.split())} {context.command_path}\n"
        yield plain(command.help or "") + "\n"
        if not hasattr(command, "list_commands"):
            yield f"```text\n{usage(command, context)}\n```\n"
            yield from _parameters(command, context)


def usage(command: Any, context: Any) -> str:
    """Return the usage line of a command, as ``--help`` prints it."""
    pieces = " ".join(command.collect_usage_pieces(context))
    return f"{context.command_path} {pieces}"


def _parameters(command: Any, context: Any) -> Iterator[str]:
    """Yield one entry of a definition list for each argument and option, except ``--help``."""
    for parameter in command.get_params(context):
        if "--help" in parameter.opts or parameter.hidden:
            continue
        if parameter.param_type_name == "argument":
            names, rest = f"`{parameter.make_metavar(context)}`", plain(parameter.help or "")
        else:
            record = parameter.get_help_record(context)
            names, rest = ", ".join(f"`{name}`" for name in record[0].split(", ")), plain(record[1])
        yield f"{names}\n: {rest or '—'}\n"


def plain(text: str) -> str:
    r"""Return a help text as one paragraph of Markdown, with its special characters escaped.

    >>> plain("Exit 1 where\n  [none] is *known*.")
    'Exit 1 where \\[none] is \\*known\\*.'
    """
    paragraphs = (" ".join(part.split()) for part in re.split(r"\n\s*\n", text.replace("\b", "")))
    return "\n\n".join(re.sub(r"([*_\[<`|])", r"\\\1", part) for part in paragraphs)
