"""Who calls whom: the one place that wires the rooms together. The command line and Python users come in here."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.grammar.parser import parse_script
from deixis.grammar.parser import read_script as read_script_file
from deixis.grammar.script import Script
from deixis.kernels import ready_to_ground
from deixis.learning.scene_evidence import conflict_notes, evidence_of, graph_evidence, scene_labels
from deixis.ontology.tbox import Ontology
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.perceptual_session import PerceptualSession, views_of_matches
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.entailment.implications import TIME_LIMIT, Implications
from deixis.reasoning.errors import InconsistencyError, NothingFoundError, SettingError, require_time_limit
from deixis.reasoning.grounding.answer import Grounding
from deixis.reasoning.grounding.engines import Select, engine_named
from deixis.reasoning.grounding.evidence.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.ground import DEFAULT_TIME_LIMIT
from deixis.reasoning.grounding.ground import ground as ground_evidence
from deixis.reasoning.grounding.options import ViewpointName
from deixis.version import VERSION
from deixis.workflows.infer import Inference, inference_of, ready_to_infer

if TYPE_CHECKING:
    from deixis.learning.views import StandingWord, Taught
    from deixis.ontology.lessons.types import LayoutConcept, Lesson
    from deixis.reasoning.comparison.checking import TableCheck


def read_script(path: str | Path | None = None, *, text: str | None = None, ontology: Ontology | None = None) -> Script:
    """Reads a layout script from a file, or from ``text``.

    Raises ScriptError with every mistake in it, each with file, line and column; TypeError unless exactly one of the
    two is given.
    """
    if (path is None) == (text is None):
        raise TypeError("read_script takes a path or text=, and one of them only")
    return parse_script(text, ontology=ontology) if text is not None else read_script_file(str(path), ontology=ontology)


def infer(script: Script | str | Path, time_limit: float = TIME_LIMIT) -> Inference:
    """What follows from a script in the wide reading, and whether it contradicts itself.

    The time limit is for facts that leave a choice; the others need no search.
    """
    script = _script(script)
    if not all(fact.plain for fact in script.facts):
        ready_to_infer()
    return inference_of(script, time_limit)


def ground(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    engine: str = "exact",
    time_limit: float = DEFAULT_TIME_LIMIT,
    select: str = Select.FACTS,
    meaning: Meaning = SHIPPED,
    viewpoint: str = ViewpointName.STATED,
) -> Grounding:
    """Works out which perceived thing each object of a script is.

    ``engine`` is ``exact``, ``scalable``, ``similarity`` (the paper's), ``blondel`` or ``heymans-singh``; ``select``
    says what chooses among sub-graphs under the paper's: ``facts``, or ``similarity`` alone as in the paper.
    ``meaning`` says how words and sizes are taken; ``viewpoint`` is that of the scene as ``stated``, or recovered: by
    ``quarter`` turns, or ``unknown``, from any side (:mod:`deixis.workflows.viewpoint`). The answer comes within about
    ``time_limit`` seconds, proved or not, and says which. Raises DeixisError for bad input.
    """
    script = _script(script)
    scene = scene if isinstance(scene, Scene) else read_scene(scene)
    require_time_limit(time_limit)
    if select not in list(Select):
        raise SettingError(f"select is one of {', '.join(Select)}, not '{select}'")
    if viewpoint not in list(ViewpointName):
        raise SettingError(f"viewpoint is one of {', '.join(ViewpointName)}, not '{viewpoint}'")
    ready_to_ground(engine)
    chosen = engine_named(engine, Select(select))
    if viewpoint != ViewpointName.STATED:
        from deixis.workflows.viewpoint import ground_from_anywhere

        return ground_from_anywhere(script, scene, chosen, meaning, viewpoint == ViewpointName.UNKNOWN, time_limit)
    notes = _viewpoint_notes(script.viewpoint, scene) + conflict_notes(script.graph())
    return ground_evidence(evidence_of(script, scene, meaning), chosen, time_limit, notes)


def _script(script: Script | str | Path) -> Script:
    return script if isinstance(script, Script) else read_script(script)


def _viewpoint_notes(viewpoint: str | None, scene: Scene) -> tuple[str, ...]:
    if viewpoint is None or viewpoint == scene.viewpoint:
        return ()
    return (
        f"the script speaks as seen from '{viewpoint}' and the scene is seen from '{scene.viewpoint}': "
        "left and right were compared as they stand",
    )


@dataclass(frozen=True)
class Learned:
    """What a lesson left behind."""

    lesson: Lesson
    grounding: Grounding
    seen: tuple[Taught, ...] = ()  # the views that it taught, of things with clouds
    standing: tuple[StandingWord, ...] = ()  # what it would call otherwise than a teacher did

    @property
    def categories(self) -> tuple[str, ...]:
        """The objects whose category it taught."""
        return tuple(match.role for match in self.lesson.categories())

    @property
    def doubtful(self) -> tuple[str, ...]:
        """The objects that it recorded as not settled."""
        return tuple(match.role for match in self.lesson.matches if not match.decided)


@dataclass(frozen=True)
class Checked:
    """A table against a layout: the verdicts, and the same as a SHACL validation report."""

    layout: LayoutConcept
    table: TableCheck
    conforms: bool
    report: str  # Turtle


class Session(PerceptualSession):
    """A memory, and what is done with it and a table. Use it as a context manager, or close it.

    The memory is opened by the first call that needs it, and held by this process until the session is closed.
    """

    def ground(
        self,
        script: Script | str | Path,
        scene: Scene | str | Path | Mapping[str, Any],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
        viewpoint: str = ViewpointName.STATED,
    ) -> Grounding:
        """Grounds as :func:`ground` does, with words and sizes as this memory has learned them."""
        return ground(script, scene, engine, time_limit, meaning=self.meaning(), viewpoint=viewpoint)

    def learn(
        self,
        script: Script | str | Path,
        scene: Scene | str | Path | Mapping[str, Any],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Learned:
        """Grounds a script in a scene, and keeps the layout and what its objects look like, with where it comes from.

        What is doubtful or interchangeable is kept as such and teaches no category; how sure each match is is kept too,
        for :meth:`learn_relations`. Sizes are learned at once. What a teacher named stays of that name. Raises
        DeixisError, having changed nothing, where the script contradicts itself or what was learned before.
        """
        from deixis.learning.lesson import Occasion, layout_name, lesson_of
        from deixis.learning.update import keep
        from deixis.ontology.lessons.types import next_lesson_id

        script = self._script(script)
        scene = scene if isinstance(scene, Scene) else read_scene(scene)
        conflict = find_conflict(Implications(script.graph()))
        if conflict is not None:
            lines = ", ".join(str(fact.source) for fact in conflict.facts)
            raise InconsistencyError(f"the script contradicts itself, nothing was learned: {conflict.reason} ({lines})")
        started = datetime.now(UTC)
        found = self.ground(script, scene, engine, time_limit)
        if not found.matches:
            raise NothingFoundError("nothing that the script names was found in the scene, so nothing was learned")
        memory = self.memory(create=True)
        id = next_lesson_id(layout_name(script), memory.lessons())
        lesson = lesson_of(script, scene, found, id, Occasion(started, datetime.now(UTC), VERSION))
        views, standing = self.but_for_taught(views_of_matches(scene, found.matches.values()))
        with self.keeping_views(views) as seen:
            keep(memory, self.ontology, lesson)
        self._meaning = None
        return Learned(lesson, found, seen, standing)

    def check(
        self,
        layout: str | Path | Script,
        scene: Scene | str | Path | Mapping[str, Any],
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Checked:
        """What is wrong with a table: ``layout`` is a learned layout's name, or a script or its file."""
        from deixis.learning.lesson import layout_concept
        from deixis.reasoning.comparison.checking import checked_table
        from deixis.workflows.shacl_report import shacl_report

        concept = (
            layout_concept(self._script(layout), "script")
            if isinstance(layout, Script) or is_script_file(layout)
            else self.layout(str(layout))
        )
        scene = scene if isinstance(scene, Scene) else read_scene(scene)
        graph, relations = concept.graph(self.ontology.relations), self.ontology.relations
        labels = scene_labels(scene)
        evidence = graph_evidence(graph, scene, self.ontology, self.meaning())
        notes = _viewpoint_notes(concept.viewpoint, scene) + conflict_notes(graph)
        ready_to_ground("exact")
        known, engine = self.ontology, engine_named("exact")
        table = checked_table(evidence, labels, known.kinds, engine, time_limit, scene.colours, known.colours)
        found = table.grounding
        kept = tuple(note for note in found.notes if "similarity" not in note)  # a check shows no similarity
        table = replace(table, grounding=replace(found, notes=notes + kept))
        return Checked(concept, table, *shacl_report(concept, scene, table, relations))

    def _script(self, script: Script | str | Path) -> Script:
        return script if isinstance(script, Script) else read_script(script, ontology=self.ontology)


def load_scene(file: str | Path, hide_labels: bool = False, image: str | None = None) -> Scene:
    """A scene from a file, its labels kept or hidden; ``image`` chooses one of several that the file describes."""
    scene = read_scene(file, image=image) if image is not None else read_scene(file)
    return scene.without_labels() if hide_labels else scene


def is_script_file(layout: str | Path) -> bool:
    """Whether a layout is given as a file rather than by its name."""
    return isinstance(layout, Path) or layout.endswith(".layout") or os.sep in layout
