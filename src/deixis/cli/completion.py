"""Shell completion of values: calculi, and the layouts, lessons and categories of the memory.

Commands, options and the choices of an option are completed by typer. The functions here never raise, never change the
memory, and return nothing where the memory does not answer in time.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    import pyoxigraph as ox

TIME_LIMIT = 0.7
"""Seconds that reading the memory may take; with the start of the program, completion stays within a second."""


def complete_related(incomplete: str) -> list[str]:
    """Return the calculi of ``deixis relate`` that begin with a text."""
    from deixis.reasoning.qualitative.relate import RELATED

    return _beginning(incomplete, RELATED)


def complete_calculi(incomplete: str) -> list[str]:
    """Return the calculi that begin with a text; after ``+``, those that can be added to ``ra+``."""
    from deixis.reasoning.qualitative.calculi.registry import CALCULI

    before, plus, _ = incomplete.rpartition("+")
    given = before.split("+")
    return _beginning(incomplete, [before + plus + name for name in CALCULI if name not in given])


def complete_layouts(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the learned layouts that begin with a text."""
    return _beginning(incomplete, _in_time(lambda: layouts_in(_memory(ctx))))


def complete_lessons(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the ids of lessons that begin with a text."""
    return _beginning(incomplete, _in_time(lambda: lessons_in(_memory(ctx))))


def complete_categories(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the taught categories that begin with a text."""
    return _beginning(incomplete, _in_time(lambda: categories_in(_memory(ctx))))


def layouts_in(memory: Path) -> set[str]:
    """Read the names of the learned layouts without locking or changing the memory."""
    import pyoxigraph as ox

    from deixis.ontology.rdf.vocabulary import W3C

    store, layouts = _layouts(memory)
    label = ox.NamedNode(W3C.RDFS_LABEL)
    names = (quad.object for layout in layouts for quad in store.quads_for_pattern(layout, label, None))
    return {name.value for name in names if isinstance(name, ox.Literal)}


def lessons_in(memory: Path) -> set[str]:
    """Read the ids of the lessons that taught a layout, without locking or changing the memory."""
    from deixis.ontology.rdf.triples import last_part

    return {last_part(layout.value) for layout in _layouts(memory)[1]}


def _layouts(memory: Path) -> tuple[ox.Store, list[ox.NamedNode]]:
    import pyoxigraph as ox

    from deixis.memory.semantic.opening import open_for_reading
    from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
    from deixis.ontology.rdf.vocabulary import DX, W3C

    store = open_for_reading(memory)
    is_a, layout = ox.NamedNode(W3C.RDFS_SUB_CLASS_OF), ox.NamedNode(DX.LAYOUT)
    found = (quad.subject for quad in store.quads_for_pattern(None, is_a, layout, graph_iri(GraphName.LEARNED)))
    return store, [subject for subject in found if isinstance(subject, ox.NamedNode)]


def categories_in(memory: Path) -> set[str]:
    """Read the names of the taught categories from a copy of the database, as LevelDB writes where it opens.

    The copy links the tables instead of copying them, and is removed again. One look-up per category is enough, as the
    keys of the views are sorted by category.
    """
    from tempfile import TemporaryDirectory

    import plyvel

    from deixis.memory.perceptual.database import keys, layout

    with TemporaryDirectory(prefix="deixis-") as scratch:
        layout.mirror(memory.resolve() / layout.FOLDER, Path(scratch))
        with plyvel.DB(str(layout.store(Path(scratch)))) as database:
            found = {key[1:].decode() for key in database.iterator(prefix=keys.CATEGORY, include_value=False)}
            views = database.iterator(prefix=keys.VIEW, include_value=False)
            while (key := next(views, None)) is not None:
                category = keys.split_view_key(key)[0]
                found.add(category)
                views.seek(keys.after(keys.category_prefix(category)))
            return found


def _memory(ctx: typer.Context) -> Path:
    from deixis.memory.on_demand import default_memory

    return Path(ctx.params.get("memory") or default_memory())


def _in_time(read: Callable[[], Iterable[str]]) -> list[str]:
    """Return what a function returns within the time limit, sorted; nothing if it is late or raises any error."""
    from threading import Thread

    found: list[str] = []

    def work() -> None:
        try:
            found.extend(sorted(read()))
        except BaseException:  # a panic of the store's library too: nothing may disturb the prompt
            found.clear()

    thread = Thread(target=work, daemon=True)
    thread.start()
    thread.join(TIME_LIMIT)
    return [] if thread.is_alive() else found


def _beginning(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def keep_completion_fast() -> None:
    """Keep typer from importing rich to remove markup from the help texts, which have none."""
    sys.modules["rich"] = None  # type: ignore[assignment]
