"""The command that tells which layout a scene is most like, and which scenes a script is most like."""

from __future__ import annotations

import re
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli_common import NO, UNDECIDED, AsJson, HideLabels, MemoryDir, TimeLimit, print_json, print_lines

if TYPE_CHECKING:
    from deixis.ontology.tbox import Ontology
    from deixis.perception.scene import Scene
    from deixis.reasoning.likeness import Described, Likeness, Seen
    from deixis.show_retrieve import Retrieved

SURE = 0.5
"""A label of less confidence does not tell a thing's kind."""

Query = Annotated[
    str, typer.Argument(metavar="SCENE|SCRIPT", help="A scene (.scene.json) or a layout script (.layout).")
]
Among = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="A folder of scripts (for a scene; default: what is remembered) or of scenes."),
]


def retrieve(
    query: Query,
    among: Among = None,
    top: Annotated[int, typer.Option(min=1, metavar="K", help="So many at the most.")] = 5,
    least: Annotated[float, typer.Option(min=0.0, max=1.0, metavar="SIMILARITY", help="None less similar.")] = 0.5,
    memory: MemoryDir = None,
    hide_labels: HideLabels = False,
    time_limit: TimeLimit = 60.0,
    as_json: AsJson = False,
) -> None:
    """Rank the layouts that a scene is like, or the scenes that a script is like (exit 1 where none is similar)."""
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.likeness import Comparison
    from deixis.reasoning.retrieval import rank_layouts, rank_scenes
    from deixis.session import is_script_file, load_scene
    from deixis.show_retrieve import retrieved_lines, retrieved_to_dict

    ontology, deadline = default_ontology(), time.perf_counter() + time_limit
    comparison = Comparison(ontology)
    by_script = is_script_file(query) and not query.endswith(".json")
    if by_script:
        layouts, scenes = {query: _script(query)}, _scenes(among, hide_labels, ontology)
        ranked = rank_scenes(layouts[query], scenes.values(), comparison, top, deadline)
        compared: Mapping[str, object] = scenes
    else:
        scenes = {query: seen_scene(query, load_scene(query, hide_labels), ontology)}
        layouts = _remembered(memory, ontology) if among is None else _scripts(among)
        ranked = rank_layouts(scenes[query], layouts.values(), comparison, top, deadline)
        compared = layouts
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

    from deixis.reasoning.likeness import seen

    kinds: list[str | None] = []
    for thing in scene.objects:
        sure = thing.label is not None and thing.confidence >= SURE
        kind = ontology.kinds.of_word(re.sub(r"_\d+$", "", thing.label or "")) if sure else None
        kinds.append(kind.iri if kind else None)
    return seen(name, replace(scene.graph(ontology.relations), kinds=tuple(kinds)), metric=scene.unit == "m")


def _script(file: str) -> Described:
    from deixis.grammar.parser import read_script
    from deixis.reasoning.likeness import Described

    return Described(file, read_script(file).graph())


def _scripts(folder: Path) -> dict[str, Described]:
    return {path.name: _named(path.name, _script(str(path))) for path in _files(folder, "*.layout", "layout scripts")}


def _named(name: str, layout: Described) -> Described:
    from deixis.reasoning.likeness import Described

    return Described(name, layout.graph)


def _scenes(folder: Path | None, hide_labels: bool, ontology: Ontology) -> dict[str, Seen]:
    from deixis.ontology.errors import DeixisError
    from deixis.session import load_scene

    if folder is None:
        raise DeixisError("retrieve: a script is compared with the scenes of a folder; name it with --among DIR")
    paths = _files(folder, "*.scene.json", "scenes")
    return {path.name: seen_scene(path.name, load_scene(path, hide_labels), ontology) for path in paths}


def _files(folder: Path, pattern: str, what: str) -> list[Path]:
    from deixis.ontology.errors import DeixisError

    if not folder.is_dir():
        raise DeixisError(f"{folder}: this is no folder of {what}")
    found = sorted(path for path in folder.glob(pattern) if path.is_file())
    if not found:
        raise DeixisError(f"{folder}: there are no {what} in it ({pattern})")
    return found


def _remembered(memory: Path | None, ontology: Ontology) -> dict[str, Described]:
    """Every layout in memory; of a name learned more than once every lesson, told by its id."""
    from deixis.ontology.errors import DeixisError
    from deixis.reasoning.likeness import Described
    from deixis.session import Session

    with Session(memory=memory) as session:
        layouts = session.layouts()
    if not layouts:
        raise DeixisError("retrieve: no layout has been learned; learn some, or name a folder with --among DIR")
    names = [layout.name for layout in layouts]
    told = [layout.name if names.count(layout.name) == 1 else layout.lesson for layout in layouts]
    return {name: Described(name, layout.graph(ontology.relations)) for name, layout in zip(told, layouts, strict=True)}
