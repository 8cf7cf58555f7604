"""The commands ``deixis category list``, ``rename``, ``merge`` and ``forget``: manage the taught categories."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    BAD_INPUT,
    AsJson,
    MemoryDir,
    print_json,
    print_line,
    print_lines,
    print_note,
    require_memory,
)
from deixis.cli.completion import complete_categories
from deixis.cli.output import note_change

if TYPE_CHECKING:
    from deixis.session import Session

NOTHING_TAUGHT = "No views were taught: a view needs the points of an object, as 'deixis perceive -o' writes them."

category_app = typer.Typer(help="List, rename, merge or forget taught categories.", no_args_is_help=True)


@category_app.command("list")
def list_categories(memory: MemoryDir = None, as_json: AsJson = False) -> None:
    """List the taught categories with their number of views; exit 2 if damaged ones are left out."""
    from deixis.session import Session

    require_memory(memory)
    left_out: list[str] = []
    with Session(memory) as session:
        known = session.categories(left_out.append)
    if as_json:
        print_json(known)
    elif known or not left_out:
        print_lines([f"{name:<24} {count}" for name, count in known.items()] or [NOTHING_TAUGHT])
    for note in left_out:
        print_note(note)
    if left_out:
        raise typer.Exit(BAD_INPUT)


@category_app.command("rename")
def rename(
    old: Annotated[str, typer.Argument(metavar="OLD", help="The present name.", autocompletion=complete_categories)],
    new: Annotated[str, typer.Argument(metavar="NEW", help="The new name.")],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Give a category another name; its views stay."""
    from deixis.session import Session
    from deixis.view_store import category_name, new_category_name

    name = new_category_name(new)
    with Session(memory) as session:
        session.rename_category(old, name)
        before = category_name(old)
        _print_change(session, before, name, f"'{before}' is now '{name}'.", as_json)


@category_app.command("merge")
def merge(
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="The category to remove.", autocompletion=complete_categories)
    ],
    into: Annotated[
        str,
        typer.Argument(metavar="INTO", help="The category that gets its views.", autocompletion=complete_categories),
    ],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Move the views of one category to another, for two words with one meaning."""
    from deixis.session import Session
    from deixis.view_store import category_name

    with Session(memory) as session:
        session.merge_categories(source, into)
        before, name = category_name(source), category_name(into)
        _print_change(session, before, name, f"The views of '{before}' now belong to '{name}'.", as_json)


@category_app.command("forget")
def forget_category(
    name: Annotated[
        str, typer.Argument(metavar="CATEGORY", help="The category to forget.", autocompletion=complete_categories)
    ],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Forget a category with all its views."""
    from deixis.session import Session
    from deixis.view_store import category_name

    with Session(memory) as session:
        session.forget_category(name)
        before = category_name(name)
        _print_change(session, before, None, f"Forgotten: {before}.", as_json)


def _print_change(session: Session, before: str, category: str | None, text: str, as_json: bool) -> None:
    """Print which category the views of ``before`` have now, None if they are forgotten: as JSON, or this text."""
    note_change(session.path)
    if as_json:
        views = 0 if category is None else session.categories()[category]
        print_json({"before": before, "category": category, "views": views})
    else:
        print_line(text)
