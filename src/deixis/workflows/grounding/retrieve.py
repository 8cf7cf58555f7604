"""Rank the layouts in a memory or folder by similarity to a scene, and scenes by similarity to a script."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.grammar.read import read_script_file
from deixis.grammar.script import Script
from deixis.ontology.tbox import default_ontology
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.likeness import ComparedScene, Comparison, Described, Likeness, compared_scene
from deixis.reasoning.comparison.retrieval import Progress, rank_layouts, rank_scenes
from deixis.reasoning.errors import require_time_limit
from deixis.reasoning.grounding.evidence.properties.labels import category_of
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.text_files import is_folder

if TYPE_CHECKING:
    from deixis.learning.lessons.recollection import Recollection
    from deixis.ontology.lessons.types import LayoutConcept

MIN_LABEL_CONFIDENCE = 0.5
"""Minimum confidence of a label that determines the kind of a thing."""

TIME_LIMIT = 60.0

LeftOut = Callable[[str], None]
Known = TypeVar("Known")


class Knowledge(Protocol):
    """Learned knowledge, as a session or its knowledge store offers it."""

    def meaning(self) -> Meaning:
        """Return the present words and sizes.

        Returns
        -------
        Meaning
            Models of words and ranges of sizes.
        """
        ...

    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Return the learned layouts.

        Returns
        -------
        tuple of LayoutConcept
            One layout for each lesson.
        """
        ...

    def recollection(self) -> Recollection:
        """Return the lessons with their texts.

        Returns
        -------
        Recollection
            The lessons with their scenes.
        """
        ...


@dataclass(frozen=True)
class Retrieved:
    """A layout or a scene that is similar to what was asked for, and by which grounding (object: perceived id)."""

    name: str
    similarity: float
    objects: float
    relations: float | None  # None where the layout relates nothing
    matches: dict[str, str]
    proved: bool


@dataclass(frozen=True, repr=False)
class Retrieval(Answer):
    """Layouts or scenes that are similar to a query, the most similar first.

    ``among`` is the number of those that were compared, ``least`` the similarity from which one counts.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import EXAMPLES, example
    >>> found = deixis.retrieve(deixis.read_scene(example("place_setting.scene.json")), EXAMPLES, top=3)
    >>> found.among, [each.name for each in found.found]
    (8, ['formal_dinner.layout', 'script1.layout', 'script2.layout'])
    """

    found: tuple[Retrieved, ...]
    among: int
    query: str
    least: float

    def summary(self) -> str:
        """Return the best result, and how many there are."""
        best = f", best {self.found[0].name} ({self.found[0].similarity:.2f})" if self.found else ""
        return f"{count(len(self.found), 'result')} among {self.among}{best}"


@checks_arguments
def retrieve(
    query: Script | Scene | str | Path | Mapping[str, Any],
    among: str | Path | None = None,
    memory: Knowledge | None = None,
    *,
    top: int = 5,
    least: float = 0.5,
    hide_labels: bool = False,
    time_limit: float = TIME_LIMIT,
    left_out: LeftOut | None = None,
    progress: Progress | None = None,
) -> Retrieval:
    """Rank all known layouts by their similarity to a scene, or all known scenes by their similarity to a script.

    Parameters
    ----------
    query
        A scene or a script, or the file of one. The name of a script's file ends in ``.layout``.
    among
        Folder of ``.layout`` scripts or ``.scene.json`` scenes to compare with.
    memory
        An open session, whose layouts or scenes are compared too.
    top
        Maximum number of results.
    least
        Minimum similarity of a result, in [0, 1].
    hide_labels
        True to ignore the labels of scenes.
    time_limit
        Seconds for all comparisons.
    left_out
        Called with a line for each lesson that cannot be read.
    progress
        Called with the number of layouts or scenes compared, and that of all.

    Returns
    -------
    Retrieval
        The results, best first.

    Raises
    ------
    DeixisError
        If nothing is known, or a file cannot be read.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import EXAMPLES, example
    >>> found = deixis.retrieve(deixis.read_scene(example("place_setting.scene.json")), EXAMPLES, top=3)
    >>> print(found.to_text())
                          similarity  objects  relations
    formal_dinner.layout       1.000    1.000      1.000
    script1.layout             1.000    1.000      1.000
    script2.layout             0.854    0.889      0.786
    """
    require_time_limit(time_limit)
    deadline, folder = Deadline.after(time_limit), None if among is None else Path(among)
    comparison = Comparison(default_ontology(), memory.meaning().sizes if memory else None)
    if isinstance(query, str | Path):
        query = read_script_file(str(query), deadline=deadline) if _is_script_file(str(query)) else read_scene(query)
    if isinstance(query, Script):
        layout, scenes = Described(query.file, query.graph()), _known_scenes(memory, folder, hide_labels, left_out)
        ranked = rank_scenes(layout, scenes.values(), comparison, top, deadline, progress)
        found = [_retrieved(one.scene, one, layout, scenes[one.scene]) for one in ranked if one.similarity >= least]
        return Retrieval(tuple(found), len(scenes), query.file, least)
    scene = query if isinstance(query, Scene) else read_scene(query)
    asked = _seen(scene.file, scene.without_labels() if hide_labels else scene)
    layouts = _known_layouts(memory, folder, deadline)
    ranked = rank_layouts(asked, layouts.values(), comparison, top, deadline, progress)
    found = [_retrieved(one.layout, one, layouts[one.layout], asked) for one in ranked if one.similarity >= least]
    return Retrieval(tuple(found), len(layouts), scene.file, least)


def _is_script_file(name: str) -> bool:
    return name.endswith(".layout") or (os.sep in name and not name.endswith(".json"))


def _retrieved(name: str, likeness: Likeness, layout: Described, scene: ComparedScene) -> Retrieved:
    pairs = zip(layout.graph.nodes, likeness.assignment.tolist(), strict=True)
    return Retrieved(
        name,
        likeness.similarity,
        likeness.objects,
        likeness.relations if layout.total else None,
        {object: scene.ids[p] for object, p in pairs if p >= 0},
        likeness.proved,
    )


def _seen(name: str, scene: Scene) -> ComparedScene:
    """Return a scene ready for comparison; its kinds come from labels of sufficient confidence, or their categories."""
    ontology = default_ontology()
    kinds: list[str | None] = []
    for thing in scene.objects:
        label = thing.label if thing.confidence >= MIN_LABEL_CONFIDENCE else None
        kind = ontology.of_name(label)[0] if label else None
        kinds.append(kind.iri if kind else category_of(label) if label else None)
    return compared_scene(
        name, replace(scene.relations(ontology.relations), kinds=tuple(kinds)), metric=scene.unit == "m"
    )


def _known_layouts(memory: Knowledge | None, among: Path | None, deadline: Deadline) -> dict[str, Described]:
    """Return the scripts of a folder and the layouts in memory; a name learned several times is listed by lesson."""
    paths = _files(among, "*.layout", "layout scripts") if among is not None else []
    known = {path.name: Described(path.name, read_script_file(str(path), deadline=deadline).graph()) for path in paths}
    layouts = memory.layouts() if memory is not None else ()
    names = [layout.name for layout in layouts]
    for layout in layouts:
        name = layout.name if names.count(layout.name) == 1 else layout.lesson
        known[name] = Described(name, layout.graph(default_ontology().relations))
    return _require_known(known, "layout")


def _known_scenes(
    memory: Knowledge | None, among: Path | None, hide_labels: bool, left_out: LeftOut | None
) -> dict[str, ComparedScene]:
    """Return the scenes of a folder and in memory; a scene in memory has the name of the first lesson that has it."""
    paths = _files(among, "*.scene.json", "scenes") if among is not None else []
    known = {path.name: read_scene(path) for path in paths}
    if memory is not None:
        recollection = memory.recollection()
        if left_out is not None:
            for why in recollection.unreadable:
                left_out(why)
        first = {lesson.texts[1]: lesson for lesson in reversed(recollection.lessons)}
        known |= {one.lesson: one.scene for one in first.values()}
    shown = {name: scene.without_labels() if hide_labels else scene for name, scene in sorted(known.items())}
    return {name: _seen(name, scene) for name, scene in _require_known(shown, "scene").items()}


def _files(folder: Path, pattern: str, what: str) -> list[Path]:
    if not is_folder(folder):
        raise DeixisError(f"{folder}: not a folder; name a folder of {what}")
    found = sorted(path for path in folder.glob(pattern) if path.is_file())
    if not found:
        raise DeixisError(f"{folder}: there are no {what} in it ({pattern})")
    return found


def _require_known(known: dict[str, Known], what: str) -> dict[str, Known]:
    if not known:
        raise DeixisError(f"retrieve: no {what} has been learned; learn one first, or name a folder with --among DIR")
    return known
