"""Describe the JSON answers of the commands on a page, by running them.

``docs/reference/json.md`` shows a command for each answer; ``make docs`` runs them, and puts a table of the keys below
each.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from documentation.page_examples import FENCE, Ran, examples, run_commands

LONGEST_VALUE = 60
"""Characters of an example value that are shown."""


def with_key_tables(text: str, page: Path, folder: Path) -> str:
    """Return the text of a page with a table of keys below each console whose last command prints JSON.

    Parameters
    ----------
    text
        The Markdown of the page.
    page
        The file of the page.
    folder
        The folder to run the commands in; see ``run_commands``.
    """
    answers = {ran.command.line: ran for ran in run_commands(page, folder) if "--json" in ran.command.line}
    blocks = list(FENCE.finditer(text))
    assert len(blocks) == len(examples(page)), f"{page}: a block that is not an example"
    for block, example in reversed(list(zip(blocks, examples(page), strict=True))):
        asked = [answers[command.line] for command in example.commands() if command.line in answers]
        if asked:
            text = text[: block.end()] + "\n\n" + key_table(asked[-1]) + text[block.end() :]
    return text


def key_table(ran: Ran) -> str:
    """Return the table of the keys of an answer: their path, the type of the value, and an example."""
    answer = json.loads(ran.output)
    named = frozenset(_texts(answer))
    rows = dict[str, tuple[str, str]]()
    for path, value in _values(answer, named):
        kind = type_name(value)
        known, example = rows.get(path, (kind, ""))
        kinds = known if kind in known.split(" or ") else f"{known} or {kind}"
        rows[path] = (kinds, example or _example(value))
    lines = [f"| `{path}` | {kind} | {example} |" for path, (kind, example) in rows.items()]
    return "\n".join(["| key | type | example |", "|---|---|---|", *lines]) + "\n"


def type_name(value: Any) -> str:
    """Return the JSON type of a value.

    >>> [type_name(value) for value in ({}, [], "a", 1, 0.5, True, None)]
    ['object', 'array', 'string', 'number', 'number', 'boolean', 'null']
    """
    if isinstance(value, bool):
        return "boolean"
    names = {dict: "object", list: "array", str: "string", int: "number", float: "number", type(None): "null"}
    return names[type(value)]


def _texts(value: Any) -> Iterator[str]:
    """Yield all texts of an answer that are values: among them the names and ids by which objects may be keyed."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _texts(inner)


def _values(value: Any, named: frozenset[str], path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the path and the value of each key; elements of an array, and entries by name, have one path."""
    if path:
        yield path, value
    if isinstance(value, dict):
        by_name = set(value) <= named
        for key, inner in value.items():
            step = "NAME" if by_name else key
            yield from _values(inner, named, f"{path}.{step}" if path else step)
    elif isinstance(value, list):
        for inner in value:
            if isinstance(inner, dict | list):
                yield from (found for found in _values(inner, named, f"{path}[]") if found[0] != f"{path}[]")


def _example(value: Any) -> str:
    """Return a short value as code; nothing for objects, null, and arrays that are long or hold objects."""
    if isinstance(value, dict) or value is None or (isinstance(value, list) and not value):
        return ""
    text = json.dumps(value, ensure_ascii=False)
    if "{" in text or "\n" in text:
        return ""
    short = text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 1]}…"
    return "`" + short.replace("|", "\\|").replace("`", "'") + "`"
