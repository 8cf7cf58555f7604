"""Check a table against a layout: what is missing, misplaced, miscoloured and extra, and which claims fail."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.grammar.script import Script
from deixis.knowledge_store import KnowledgeStore
from deixis.learning.lessons.scene_evidence import (
    conflict_notes,
    graph_evidence,
    scene_labels,
    surface_thing,
    unit_notes,
    viewpoint_notes,
)
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.reasoning.entailment.claim_facts import implications_with_claims
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.errors import SettingError, require_time_limit
from deixis.reasoning.grounding.answers.claims import violated
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED
from deixis.reasoning.grounding.hypotheses.hypotheses import AS_IT_STANDS
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT
from deixis.workflows.layouts.read import as_scene, as_script, is_script_file

if TYPE_CHECKING:
    from deixis.ontology.lessons.types import LayoutConcept
    from deixis.ontology.tbox import Ontology
    from deixis.reasoning.comparison.checking import TableCheck


@dataclass(frozen=True, repr=False)
class Check(Answer):
    """Comparison of a table with a layout: the verdicts, and a SHACL validation report, made on first use.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import example
    >>> found = deixis.check(example("formal_dinner.layout"), example("place_setting.scene.json"))
    >>> found.table.well, found.summary()
    (True, "of 'formal_dinner': nothing wrong, 12 undetermined")
    >>> found.to_text().splitlines()[-2]
    'correct      0 of 12, 12 undetermined'
    >>> found.conforms, found.report.count("sh:ValidationResult")
    (True, 0)
    """

    layout: LayoutConcept
    table: TableCheck
    scene: Scene
    ontology: Ontology

    def summary(self) -> str:
        """Return the layout's name, and how many objects have each verdict."""
        verdicts = Counter(role.verdict.value for role in self.table.roles)
        verdicts["extra"] = len(self.table.extra)
        parts = [f"{number} {verdict}" for verdict, number in verdicts.items() if number]
        broken = {"violated fact": len(self.table.broken), "violated claim": len(list(violated(self.table.claims)))}
        counts = ", ".join([*parts, *(count(number, what) for what, number in broken.items() if number)])
        return f"of {self.layout.name!r}: {'nothing wrong' if self.table.well else 'not as described'}, {counts}"

    @property
    def conforms(self) -> bool:
        """True if the scene conforms to the layout's SHACL shapes."""
        return self._validated[0]

    @property
    def report(self) -> str:
        """The SHACL validation report, in Turtle."""
        return self._validated[1]

    @cached_property
    def _validated(self) -> tuple[bool, str]:
        from deixis.workflows.grounding.shacl_report import shacl_report

        return shacl_report(self.layout, self.scene, self.table, self.ontology.relations)


@checks_arguments
def check(
    layout: str | Path | Script,
    scene: Scene | str | Path | Mapping[str, Any],
    time_limit: float = DEFAULT_TIME_LIMIT,
    knowledge: KnowledgeStore | None = None,
) -> Check:
    """Check a table against a layout.

    Parameters
    ----------
    layout
        A script or its file, or the name of a layout in ``knowledge``.
    scene
        The table, its file, or parsed JSON.
    time_limit
        Seconds for the grounding.
    knowledge
        Memory with layouts, words and sizes; without one, words and sizes are taken as they are shipped.

    Returns
    -------
    Check
        The verdict on each role, extra things, violated facts and a SHACL report.

    Raises
    ------
    DeixisError
        If a file is invalid, or there is no layout of that name.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import example
    >>> found = deixis.check(example("formal_dinner.layout"), example("second_table.scene.json"))
    >>> found
    <Check of 'formal_dinner': not as described, 9 correct, 2 misplaced, 1 missing, 1 extra, 2 violated facts>
    >>> [(one.perceived, one.reason) for one in found.table.extra]
    [('p1', 'one napkin too many')]
    >>> [one.role for one in found.table.roles if one.verdict == "missing"]
    ['water_glass']
    """
    from deixis.learning.lessons.lesson import layout_concept
    from deixis.reasoning.comparison.checking import checked_table

    require_time_limit(time_limit)
    known = default_ontology() if knowledge is None else knowledge.ontology
    if isinstance(layout, Script) or is_script_file(layout):
        concept = layout_concept(as_script(layout, known, Deadline.after(time_limit)), "script")
    elif knowledge is None:
        message = f"layout must be a script or its file (.layout) where there is no memory, got the name '{layout}'"
        raise SettingError(message)
    else:
        concept = knowledge.layout(str(layout))
    scene, graph = as_scene(scene), concept.graph(known.relations)
    meaning = SHIPPED if knowledge is None else knowledge.meaning()
    implied = implications_with_claims(graph, concept.claims)[1][-1]
    # a check takes labels as identities
    evidence = graph_evidence(graph, scene, known, meaning, label_error=0.0, claims=concept.claims)
    evidence = evidence.with_surface(surface_thing(concept.surface, graph, scene, known.kinds))
    groups = tuple(role.name for role in concept.roles if role.is_group)
    evidence = replace(evidence, consistent=implied.consistent, uncounted=groups)
    notes = unit_notes(scene, [role.name for role in concept.roles], known)
    notes += viewpoint_notes(concept.viewpoint, scene) + conflict_notes(find_conflict(implied))
    labels, engine = scene_labels(scene), engine_named("exact", sides=AS_IT_STANDS)
    table = checked_table(evidence, labels, known.kinds, engine, time_limit, scene.colours, known.colours)
    found = table.grounding
    kept = tuple(note for note in found.notes if "similarity" not in note)  # a check shows no similarity
    table = replace(table, grounding=replace(found, notes=notes + kept))
    return Check(concept, table, scene, known)
