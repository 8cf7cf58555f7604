"""Who calls whom: the one place that wires the rooms together. The command line and Python users come in here."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from deixis.grammar.parser import parse_script
from deixis.grammar.parser import read_script as read_script_file
from deixis.grammar.script import Script
from deixis.inference import Inference, inference_of
from deixis.ontology.graph import RelationGraph
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import Scene
from deixis.perception.scene_file import read_scene
from deixis.reasoning.conflict import find_conflict
from deixis.reasoning.engines import Select, engine_named
from deixis.reasoning.errors import InconsistencyError, NothingFoundError, SettingError
from deixis.reasoning.evidence import Evidence
from deixis.reasoning.grounding import DEFAULT_TIME_LIMIT, Grounding
from deixis.reasoning.grounding import ground as ground_evidence
from deixis.reasoning.implications import TIME_LIMIT, Implications
from deixis.reasoning.labels import Label, label_evidence

if TYPE_CHECKING:
    from deixis.memory.results import QueryResult
    from deixis.memory.semantic import SemanticMemory
    from deixis.ontology.concepts import LayoutConcept, Lesson
    from deixis.reasoning.checking import TableCheck


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
    return inference_of(_script(script), time_limit)


def evidence_of(script: Script, scene: Scene) -> Evidence:
    """All that speaks for who is who: the script's facts, the scene's relations, and the scene's labels."""
    description = script.graph()
    allowed, bonus = label_evidence(description, list(scene_labels(scene).values()), script.ontology.kinds)
    return Evidence(description, scene.graph(script.ontology.relations), allowed, bonus)


def ground(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    engine: str = "exact",
    time_limit: float = DEFAULT_TIME_LIMIT,
    select: str = Select.FACTS,
) -> Grounding:
    """Works out which perceived thing each object of a script is.

    ``engine`` is ``exact`` or ``similarity`` (the paper's); ``select`` says what chooses among sub-graphs under the
    latter: ``facts``, or ``similarity`` alone as in the paper. The answer comes within about ``time_limit`` seconds,
    proved or not, and says which. Raises DeixisError for bad input.
    """
    script = _script(script)
    scene = scene if isinstance(scene, Scene) else read_scene(scene)
    notes = _viewpoint_notes(script.viewpoint, scene) + _conflict_notes(script.graph())
    if not time_limit >= 0:
        raise SettingError(f"a time limit is 0 or more seconds, not {time_limit}")
    if select not in list(Select):
        raise SettingError(f"select is one of {', '.join(Select)}, not '{select}'")
    return ground_evidence(evidence_of(script, scene), engine_named(engine, Select(select)), time_limit, notes)


def _script(script: Script | str | Path) -> Script:
    return script if isinstance(script, Script) else read_script(script)


def _viewpoint_notes(viewpoint: str | None, scene: Scene) -> tuple[str, ...]:
    if viewpoint is None or viewpoint == scene.viewpoint:
        return ()
    return (
        f"the script speaks as seen from '{viewpoint}' and the scene is seen from '{scene.viewpoint}': "
        "left and right were compared as they stand",
    )


def _conflict_notes(graph: RelationGraph) -> tuple[str, ...]:
    conflict = find_conflict(Implications(graph))
    if conflict is None:
        return ()
    return (f"the script contradicts itself, so that not all of it can hold: {conflict.reason}",)


def default_memory() -> Path:
    """``$DEIXIS_MEMORY``, else a folder for the user's data."""
    named = os.environ.get("DEIXIS_MEMORY")
    if named:
        return Path(named)
    data = os.environ.get("XDG_DATA_HOME")
    return (Path(data) if data else Path.home() / ".local" / "share") / "deixis" / "memory"


@dataclass(frozen=True)
class Learned:
    """What a lesson left behind."""

    lesson: Lesson
    grounding: Grounding

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


class Session:
    """A memory, and what is done with it. Use it as a context manager, or close it.

    The memory is opened by the first call that needs it, and held by this process until the session is closed.
    """

    def __init__(self, memory: str | Path | None = None, ontology: Ontology | None = None) -> None:
        from deixis.ontology.tbox import default_ontology

        self.path = default_memory() if memory is None else Path(memory)
        self.ontology = default_ontology() if ontology is None else ontology
        self._memory: SemanticMemory | None = None

    def __enter__(self) -> Session:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Lets go of the memory."""
        if self._memory is not None:
            self._memory.close()
            self._memory = None

    def memory(self, create: bool = False) -> SemanticMemory:
        """The open memory; raises DeixisError where there is none and ``create`` is not set."""
        from deixis.memory.semantic import SemanticMemory

        if self._memory is None:
            self._memory = SemanticMemory.open(self.path, create=create)
        return self._memory

    def learn(
        self,
        script: Script | str | Path,
        scene: Scene | str | Path | Mapping[str, Any],
        engine: str = "exact",
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Learned:
        """Grounds a script in a scene, and keeps the layout and what its objects look like, with where it comes from.

        What is doubtful or interchangeable is kept as such and teaches no category. Raises DeixisError, having
        changed nothing, where the script contradicts itself or what was learned before.
        """
        from deixis import __version__
        from deixis.learning import Occasion, layout_name, lesson_of
        from deixis.ontology.concepts import next_lesson_id

        script = self._script(script)
        scene = scene if isinstance(scene, Scene) else read_scene(scene)
        conflict = find_conflict(Implications(script.graph()))
        if conflict is not None:
            lines = ", ".join(str(fact.source) for fact in conflict.facts)
            raise InconsistencyError(f"the script contradicts itself, nothing was learned: {conflict.reason} ({lines})")
        started = datetime.now(UTC)
        found = ground(script, scene, engine, time_limit)
        if not found.matches:
            raise NothingFoundError("nothing that the script names was found in the scene, so nothing was learned")
        memory = self.memory(create=True)
        id = next_lesson_id(layout_name(script), memory.lessons())
        lesson = lesson_of(script, scene, found, id, Occasion(started, datetime.now(UTC), __version__))
        self._keep(memory, lesson)
        return Learned(lesson, found)

    def _keep(self, memory: SemanticMemory, lesson: Lesson) -> None:
        from deixis.memory.graphs import GraphName
        from deixis.ontology.layout_shapes import layout_shapes
        from deixis.ontology.lesson_triples import asserted_triples, episode_triples, learned_triples

        new = {
            GraphName.LEARNED: list(learned_triples(lesson, self.ontology.relations)),
            GraphName.ASSERTED: list(asserted_triples(lesson)),
            GraphName.EPISODES: list(episode_triples(lesson)),
            GraphName.SHAPES: list(layout_shapes(lesson.layout)),
        }
        graphs = {name: [*memory.triples(name), *new.get(name, ())] for name in GraphName}
        memory.learn(lesson.id, new, self._consequences(graphs))

    def _consequences(self, graphs: Mapping[Any, list[Any]]) -> list[Any]:
        from deixis.learning import consequences
        from deixis.memory.graphs import GraphName

        ontology, learned, asserted = (graphs[n] for n in (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED))
        return consequences(ontology, learned, asserted, self.ontology.relations)

    def forget(self, lesson: str) -> None:
        """Takes back one lesson, with everything that follows from it alone."""
        memory = self.memory()
        remaining = memory.remaining(lesson)
        memory.forget(lesson, self._consequences(remaining))

    def import_(self, file: str | Path) -> None:
        """Takes in what another memory exported, or plain triples; what is there stays.

        What follows from both together is worked out first: raises InconsistencyError, having changed nothing, where
        they contradict each other.
        """
        from deixis.memory.exchange import import_dump
        from deixis.memory.graphs import GraphName
        from deixis.memory.semantic import SemanticMemory

        self.close()
        with tempfile.TemporaryDirectory() as scratch:
            aside = Path(scratch) / "memory"
            import_dump(file, aside)
            with SemanticMemory.open(aside) as other:
                graphs = {name: list(other.triples(name)) for name in GraphName}
        if self.path.exists() and any(self.path.iterdir()):
            graphs = {name: list({*triples, *self.memory().triples(name)}) for name, triples in graphs.items()}
        inferred = self._consequences(graphs)
        self.close()
        import_dump(file, self.path)
        self.memory().conclude(inferred)

    def layouts(self) -> tuple[LayoutConcept, ...]:
        """Every learned layout."""
        from deixis.memory.graphs import GraphName
        from deixis.ontology.lesson_reading import layouts

        return layouts(self.memory().triples(GraphName.LEARNED), self.ontology.relations)

    def layout(self, name: str) -> LayoutConcept:
        """The layout of that name, learned last, or of the lesson with that id; raises UnknownTermError for none."""
        from deixis.ontology.lesson_reading import layout_named

        return layout_named(self.layouts(), name, self.memory().lessons())

    def show(self, name: str) -> str:
        """A learned layout as a script again."""
        from deixis.grammar.rebuild import layout_script

        return layout_script(self.layout(name), self.ontology)

    def check(
        self,
        layout: str | Path | Script,
        scene: Scene | str | Path | Mapping[str, Any],
        time_limit: float = DEFAULT_TIME_LIMIT,
    ) -> Checked:
        """What is wrong with a table: ``layout`` is a learned layout's name, or a script or its file."""
        from deixis.learning import layout_concept
        from deixis.reasoning.checking import check_table
        from deixis.shacl_report import shacl_report

        concept = (
            layout_concept(self._script(layout), "script")
            if isinstance(layout, Script) or is_script_file(layout)
            else self.layout(str(layout))
        )
        scene = scene if isinstance(scene, Scene) else read_scene(scene)
        graph, relations = concept.graph(self.ontology.relations), self.ontology.relations
        labels = scene_labels(scene)
        allowed, bonus = label_evidence(graph, list(labels.values()), self.ontology.kinds)
        evidence = Evidence(graph, scene.graph(relations), allowed, bonus)
        notes = _viewpoint_notes(concept.viewpoint, scene) + _conflict_notes(graph)
        found = ground_evidence(evidence, engine_named("exact"), time_limit)
        kept = tuple(note for note in found.notes if "similarity" not in note)  # a check shows no similarity
        found = replace(found, notes=notes + kept)
        table = check_table(evidence, labels, self.ontology.kinds, found)
        return Checked(concept, table, *shacl_report(concept, scene, table, relations))

    def query(self, sparql: str) -> QueryResult:
        """Asks SPARQL of everything remembered: SELECT, ASK, CONSTRUCT or DESCRIBE; nothing else is let in."""
        return self.memory().query(sparql)

    def _script(self, script: Script | str | Path) -> Script:
        return script if isinstance(script, Script) else read_script(script, ontology=self.ontology)


def load_scene(file: str | Path, hide_labels: bool = False, image: str | None = None) -> Scene:
    """A scene from a file, its labels kept or hidden; ``image`` chooses one of several that the file describes."""
    scene = read_scene(file, image=image) if image is not None else read_scene(file)
    return scene.without_labels() if hide_labels else scene


def is_script_file(layout: str | Path) -> bool:
    """Whether a layout is given as a file rather than by its name."""
    return isinstance(layout, Path) or layout.endswith(".layout") or os.sep in layout


def scene_labels(scene: Scene) -> dict[str, Label | None]:
    """What perception calls each thing of a scene."""
    return {thing.id: Label(thing.label, thing.confidence) if thing.label else None for thing in scene.objects}
