"""The command that tells which layout a scene is most like, and which scenes a script is most like."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from deixis.cli_common import (
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    MemoryDir,
    NoMemory,
    TimeLimit,
    print_json,
    print_lines,
    ready_to_ground,
    working,
)

if TYPE_CHECKING:
    from deixis.ontology.tbox import Ontology
    from deixis.perception.scene import Scene
    from deixis.reasoning.likeness import Described, Likeness, Seen
    from deixis.session import Session
    from deixis.show_retrieve import Retrieved

SURE = 0.5
"""A label of less confidence does not tell a thing's kind."""

Query = Annotated[
    str, typer.Argument(metavar="SCENE|SCRIPT", help="A scene (.scene.json) or a layout script (.layout).")
]
Among = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="A folder of scripts (for a scene) or of scenes, beside what is remembered."),
]


def retrieve(
    query: Query,
    among: Among = None,
    top: Annotated[int, typer.Option(min=1, metavar="K", help="So many at the most.")] = 5,
    least: Annotated[float, typer.Option(min=0.0, max=1.0, metavar="SIMILARITY", help="None less similar.")] = 0.5,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    hide_labels: HideLabels = False,
    time_limit: TimeLimit = 60.0,
    as_json: AsJson = False,
) -> None:
    """Rank all known layouts that a scene is like, or all scenes that a script is like (exit 1 where none is)."""
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.likeness import Comparison
    from deixis.reasoning.retrieval import rank_layouts, rank_scenes
    from deixis.session import is_script_file, load_scene
    from deixis.show_retrieve import retrieved_lines, retrieved_to_dict

    ready_to_ground()
    ontology, deadline = default_ontology(), time.perf_counter() + time_limit
    by_script = is_script_file(query) and not query.endswith(".json")
    compared: Mapping[str, object]
    with _remembering(memory, no_memory) as session:
        comparison = Comparison(ontology, session.meaning().sizes if session else None)
        if by_script:
            compared = scenes = _known_scenes(session, among, hide_labels, ontology)
            layouts = {query: _script(query)}
        else:
            compared = layouts = _known_layouts(session, among, ontology)
            scenes = {query: seen_scene(query, load_scene(query, hide_labels), ontology)}
    with working("comparing"):
        if by_script:
            ranked = rank_scenes(layouts[query], scenes.values(), comparison, top, deadline)
        else:
            ranked = rank_layouts(scenes[query], layouts.values(), comparison, top, deadline)
    similar = [one for one in ranked if one.similarity >= least]
    found = [_retrieved(one, layouts[one.layout], scenes[one.scene], by_script) for one in similar]
    if as_json:
        print_json(retrieved_to_dict(found, query, len(compared)))
    else:
        print_lines(retrieved_lines(found, query, len(compared), least))
    if not found:
        raise typer.Exit(NO)
    if not all(one.proved for one in found):
        raise typer.Exit(UNDECIDED)


def _retrieved(likeness: Likeness, layout: Described, scene: Seen, by_script: bool) -> Retrieved:
    from deixis.show_retrieve import Retrieved

    pairs = zip(layout.graph.nodes, likeness.assignment.tolist(), strict=True)
    return Retrieved(
        likeness.scene if by_script else likeness.layout,
        likeness.similarity,
        likeness.objects,
        likeness.relations if layout.total else None,
        {name: scene.ids[p] for name, p in pairs if p >= 0},
        likeness.proved,
    )


def seen_scene(name: str, scene: Scene, ontology: Ontology) -> Seen:
    """A scene ready to be compared, its kinds those of labels of some confidence."""
    from dataclasses import replace

    from deixis.ontology.kinds import plain_name
    from deixis.reasoning.likeness import seen

    kinds: list[str | None] = []
    for thing in scene.objects:
        sure = thing.label is not None and thing.confidence >= SURE
        kind = ontology.kinds.of_word(plain_name(thing.label or "")) if sure else None
        kinds.append(kind.iri if kind else None)
    return seen(name, replace(scene.graph(ontology.relations), kinds=tuple(kinds)), metric=scene.unit == "m")


def _script(file: str) -> Described:
    from deixis.grammar.parser import read_script
    from deixis.reasoning.likeness import Described

    return Described(file, read_script(file).graph())


def _named(name: str, layout: Described) -> Described:
    from deixis.reasoning.likeness import Described

    return Described(name, layout.graph)


def _files(folder: Path, pattern: str, what: str) -> list[Path]:
    from deixis.ontology.errors import DeixisError

    if not folder.is_dir():
        raise DeixisError(f"{folder}: this is no folder of {what}")
    found = sorted(path for path in folder.glob(pattern) if path.is_file())
    if not found:
        raise DeixisError(f"{folder}: there are no {what} in it ({pattern})")
    return found


@contextmanager
def _remembering(memory: Path | None, no_memory: bool) -> Iterator[Session | None]:
    """The memory; None without one, but a memory that is named must be there."""
    from deixis.session import Session

    if no_memory:
        yield None
        return
    with Session(memory) as session:
        if memory is not None:
            session.memory()
        yield session if session.remembers() else None


def _known_layouts(session: Session | None, among: Path | None, ontology: Ontology) -> dict[str, Described]:
    """The scripts of a folder, and every layout in memory; of a name learned more than once, every lesson by its id."""
    from deixis.reasoning.likeness import Described

    paths = _files(among, "*.layout", "layout scripts") if among is not None else []
    known = {path.name: _named(path.name, _script(str(path))) for path in paths}
    layouts = session.layouts() if session is not None else ()
    names = [layout.name for layout in layouts]
    for layout in layouts:
        name = layout.name if names.count(layout.name) == 1 else layout.lesson
        known[name] = Described(name, layout.graph(ontology.relations))
    return _some(known, "layout")


def _known_scenes(
    session: Session | None, among: Path | None, hide_labels: bool, ontology: Ontology
) -> dict[str, Seen]:
    """The scenes of a folder, and every scene in memory, told by the first lesson, by name, that showed it."""
    from deixis.remembered import Recollection
    from deixis.session import load_scene

    paths = _files(among, "*.scene.json", "scenes") if among is not None else []
    known = {path.name: load_scene(path, hide_labels) for path in paths}
    recollection = session.recollection() if session is not None else Recollection(())
    for why in recollection.unreadable:
        print(f"deixis: left out: {why}", file=sys.stderr)
    first = {lesson.texts[1]: lesson for lesson in reversed(recollection.lessons)}
    for one in first.values():
        known[one.lesson] = one.scene.without_labels() if hide_labels else one.scene
    return {name: seen_scene(name, scene, ontology) for name, scene in sorted(_some(known, "scene").items())}


Known = TypeVar("Known")


def _some(known: dict[str, Known], what: str) -> dict[str, Known]:
    from deixis.ontology.errors import DeixisError

    if not known:
        raise DeixisError(f"retrieve: no {what} is remembered; learn from some, or name a folder with --among DIR")
    return known
