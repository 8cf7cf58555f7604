"""The command ``deixis retrieve``: find the layouts most similar to a scene, or the scenes most similar to a script."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    MemoryDir,
    NoMemory,
    Picture,
    TimeLimit,
    draw_answer,
    print_json,
    print_lines,
    print_note,
    require_plot,
    tell_of_compiling,
)
from deixis.cli.progress import progress_bar

if TYPE_CHECKING:
    from deixis.session import Session

Query = Annotated[
    str, typer.Argument(metavar="SCENE|SCRIPT", help="A scene (.scene.json) or a layout script (.layout).")
]
Among = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="A folder of scripts (for a scene) or of scenes, besides the memory."),
]


def retrieve(
    query: Query,
    among: Among = None,
    top: Annotated[int, typer.Option(min=1, metavar="K", help="Print at most K results.")] = 5,
    least: Annotated[
        float, typer.Option(min=0.0, max=1.0, metavar="SIMILARITY", help="Minimum similarity of a result.")
    ] = 0.5,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    hide_labels: HideLabels = False,
    time_limit: TimeLimit = 60.0,
    plot: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Rank the known layouts by similarity to a scene, or scenes by similarity to a script; exit 1 without a result."""
    from deixis.report.grounding.retrieve import retrieval_lines, retrieval_to_dict
    from deixis.workflows.grounding.retrieve import retrieve as run

    require_plot(plot)
    tell_of_compiling()
    with _remembering(memory, no_memory) as session, progress_bar("comparing") as progress:
        retrieved = run(
            query,
            among,
            session,
            top=top,
            least=least,
            hide_labels=hide_labels,
            time_limit=time_limit,
            left_out=lambda why: print_note(f"left out: {why}"),
            progress=progress,
        )
    if as_json:
        print_json(retrieval_to_dict(retrieved))
    else:
        print_lines(retrieval_lines(retrieved))
    if not retrieved.found:
        raise typer.Exit(NO)
    draw_answer(retrieved, plot, as_json)
    if not all(one.proved for one in retrieved.found):
        raise typer.Exit(UNDECIDED)


@contextmanager
def _remembering(memory: Path | None, no_memory: bool) -> Iterator[Session | None]:
    """Yield a session, or None without a memory; raise MemoryFormatError where a named memory is missing."""
    from deixis.session import Session

    if no_memory:
        yield None
        return
    with Session(memory) as session:
        if memory is not None:
            session.memory()
        yield session if session.remembers() else None
