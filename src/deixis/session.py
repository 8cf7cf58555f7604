"""Who calls whom: the one place that wires the rooms together. The command line and Python users come in here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deixis.grammar.parser import parse_script
from deixis.grammar.parser import read_script as read_script_file
from deixis.grammar.script import Script
from deixis.ontology.graph import Fact
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import Scene
from deixis.perception.scene_file import read_scene
from deixis.reasoning.conflict import Conflict, find_conflict
from deixis.reasoning.engines import Select, engine_named
from deixis.reasoning.evidence import Evidence
from deixis.reasoning.grounding import DEFAULT_TIME_LIMIT, Grounding
from deixis.reasoning.grounding import ground as ground_evidence
from deixis.reasoning.implications import Derivation, Implications
from deixis.reasoning.labels import Label, label_evidence


@dataclass(frozen=True)
class Inference:
    """What a script implies: every fact that follows without being stated, or the conflict that spoils it."""

    stated: tuple[Fact, ...]
    implications: Implications
    conflict: Conflict | None

    @property
    def consistent(self) -> bool:
        return self.conflict is None

    def inferred(self) -> tuple[Derivation, ...]:
        """The facts that follow, each with its shortest derivation; none where the script contradicts itself."""
        return tuple(self.implications.inferred()) if self.consistent else ()


def read_script(
    path: str | Path | None = None, *, text: str | None = None, ontology: Ontology | None = None
) -> Script:
    """Reads a layout script from a file, or from ``text``.

    Raises ScriptError with every mistake in it, each with file, line and column; TypeError unless exactly one of the
    two is given.
    """
    if (path is None) == (text is None):
        raise TypeError("read_script takes a path or text=, and one of them only")
    return parse_script(text, ontology=ontology) if text is not None else read_script_file(str(path), ontology=ontology)


def infer(script: Script | str | Path) -> Inference:
    """What follows from a script in the wide reading, and whether it contradicts itself."""
    script = _script(script)
    implications = Implications(script.graph())
    return Inference(script.facts, implications, find_conflict(implications))


def evidence_of(script: Script, scene: Scene) -> Evidence:
    """All that speaks for who is who: the script's facts, the scene's relations, and the scene's labels."""
    description = script.graph()
    labels = [Label(thing.label, thing.confidence) if thing.label else None for thing in scene.objects]
    allowed, bonus = label_evidence(description, labels, script.ontology.kinds)
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
    notes = _viewpoint_notes(script, scene) + _conflict_notes(script)
    return ground_evidence(evidence_of(script, scene), engine_named(engine, Select(select)), time_limit, notes)


def _script(script: Script | str | Path) -> Script:
    return script if isinstance(script, Script) else read_script(script)


def _viewpoint_notes(script: Script, scene: Scene) -> tuple[str, ...]:
    if script.viewpoint is None or script.viewpoint == scene.viewpoint:
        return ()
    return (
        f"the script speaks as seen from '{script.viewpoint}' and the scene is seen from '{scene.viewpoint}': "
        "left and right were compared as they stand",
    )


def _conflict_notes(script: Script) -> tuple[str, ...]:
    conflict = find_conflict(Implications(script.graph()))
    if conflict is None:
        return ()
    return (f"the script contradicts itself, so that not all of it can hold: {conflict.reason}",)
