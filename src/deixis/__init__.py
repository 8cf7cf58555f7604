"""Ground descriptions of tables in perceived scenes: words that get their meaning from the scene.

Deixis reads how a table is laid, looks at a laid table, and reports which perceived thing each word means, what the
evidence cannot distinguish, and what follows from the description.

>>> import deixis
>>> script = deixis.read_script(text="napkin on plate; fork left of plate; spoon right of plate")
>>> scene = deixis.read_scene({"objects": [
...     {"id": "o1", "min": [0.00, 0.00], "max": [0.27, 0.27]},
...     {"id": "o2", "min": [0.30, 0.03], "max": [0.34, 0.23]},
...     {"id": "o3", "min": [-0.05, 0.03], "max": [-0.02, 0.23]},
...     {"id": "o4", "min": [0.08, 0.05], "max": [0.18, 0.22]}]})
>>> found = deixis.ground(script, scene)
>>> {name: match.perceived for name, match in found.matches.items()}
{'napkin': 'o4', 'plate': 'o1', 'fork': 'o3', 'spoon': 'o2'}
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from deixis.version import VERSION

if TYPE_CHECKING:
    from deixis.errors import DeixisError
    from deixis.grammar.layout.format import format_script
    from deixis.grammar.script import Script
    from deixis.learning.layouts.concept import CountedConcept
    from deixis.learning.models.words import LearnedWords
    from deixis.learning.views.views import Recognised, Taught
    from deixis.memory.semantic.queries.results import QueryResult
    from deixis.memory.semantic.validation.by_shapes import ShapesReport
    from deixis.ontology.graph.facts import Fact
    from deixis.ontology.lessons.types import LayoutConcept, Match
    from deixis.ontology.relations.relation import Relation
    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.formats.scene_json import read_scene
    from deixis.perception.oriented_box import OrientedBox
    from deixis.perception.scene import PerceivedObject, Scene
    from deixis.reasoning.activities.grounding import ActivityGrounding, RecognisedActivity
    from deixis.reasoning.activities.prediction import Prediction
    from deixis.reasoning.description_logic.entailment import Entailment
    from deixis.reasoning.grounding.answers.answer import Grounding
    from deixis.reasoning.grounding.evidence.words.meaning import Meaning
    from deixis.reasoning.grounding.reference.answer import Reference
    from deixis.reasoning.qualitative.relate import Related
    from deixis.reasoning.temporal.chronology import Chronology
    from deixis.robot.looking import Look
    from deixis.robot.robot import Robot, Told
    from deixis.session import Session
    from deixis.workflows.descriptions.learn_reference import LearnedReference, learn_reference
    from deixis.workflows.descriptions.refer import refer
    from deixis.workflows.descriptions.tell import tell
    from deixis.workflows.descriptions.telling import Telling
    from deixis.workflows.grounding.ask import ask
    from deixis.workflows.grounding.check import Check, check
    from deixis.workflows.grounding.ground import ground
    from deixis.workflows.grounding.retrieve import Retrieval, retrieve
    from deixis.workflows.knowledge.episodes import Consolidation
    from deixis.workflows.knowledge.habits import Placements, habits
    from deixis.workflows.knowledge.learn import Learned
    from deixis.workflows.knowledge.recall_answer import Recall
    from deixis.workflows.knowledge.unlearn import Unlearned
    from deixis.workflows.layouts.imagine import Imagination, imagine
    from deixis.workflows.layouts.infer import Inference, infer
    from deixis.workflows.layouts.lint import Lint, lint
    from deixis.workflows.layouts.read import read_script
    from deixis.workflows.layouts.read_english import ReadText, read
    from deixis.workflows.reasoning.reason import reason
    from deixis.workflows.reasoning.solve import Solved, SolvedNetwork, solve
    from deixis.workflows.reasoning.time import chronology
    from deixis.workflows.reasoning.validate import validate
    from deixis.workflows.scenes.perceive import perceive, write_scene
    from deixis.workflows.scenes.point import Shown, point
    from deixis.workflows.scenes.relate import relate
    from deixis.workflows.scenes.simulate import Simulation, simulate
    from deixis.workflows.scenes.track import Tracking

__version__ = VERSION
__all__ = [
    "ActivityGrounding",
    "Check",
    "Chronology",
    "Consolidation",
    "CountedConcept",
    "DeixisError",
    "Entailment",
    "Fact",
    "Grounding",
    "Imagination",
    "Inference",
    "LayoutConcept",
    "Learned",
    "LearnedReference",
    "LearnedWords",
    "Lint",
    "Look",
    "Match",
    "Meaning",
    "OrientedBox",
    "PerceivedObject",
    "Placements",
    "PointCloud",
    "Prediction",
    "QueryResult",
    "ReadText",
    "Recall",
    "Recognised",
    "RecognisedActivity",
    "Reference",
    "Related",
    "Relation",
    "Retrieval",
    "Robot",
    "Scene",
    "Script",
    "Session",
    "ShapesReport",
    "Shown",
    "Simulation",
    "Solved",
    "SolvedNetwork",
    "Taught",
    "Telling",
    "Told",
    "Tracking",
    "Unlearned",
    "ask",
    "check",
    "chronology",
    "format_script",
    "ground",
    "habits",
    "imagine",
    "infer",
    "learn_reference",
    "lint",
    "perceive",
    "point",
    "read",
    "read_scene",
    "read_script",
    "reason",
    "refer",
    "relate",
    "retrieve",
    "simulate",
    "solve",
    "tell",
    "validate",
    "write_scene",
]

_HOMES = {
    "ActivityGrounding": "deixis.reasoning.activities.grounding",
    "Check": "deixis.workflows.grounding.check",
    "Chronology": "deixis.reasoning.temporal.chronology",
    "Consolidation": "deixis.workflows.knowledge.episodes",
    "CountedConcept": "deixis.learning.layouts.concept",
    "DeixisError": "deixis.errors",
    "Entailment": "deixis.reasoning.description_logic.entailment",
    "Fact": "deixis.ontology.graph.facts",
    "Grounding": "deixis.reasoning.grounding.answers.answer",
    "Imagination": "deixis.workflows.layouts.imagine",
    "Inference": "deixis.workflows.layouts.infer",
    "LayoutConcept": "deixis.ontology.lessons.types",
    "Learned": "deixis.workflows.knowledge.learn",
    "LearnedReference": "deixis.workflows.descriptions.learn_reference",
    "LearnedWords": "deixis.learning.models.words",
    "Lint": "deixis.workflows.layouts.lint",
    "Look": "deixis.robot.looking",
    "Match": "deixis.ontology.lessons.types",
    "Meaning": "deixis.reasoning.grounding.evidence.words.meaning",
    "OrientedBox": "deixis.perception.oriented_box",
    "PerceivedObject": "deixis.perception.scene",
    "Placements": "deixis.workflows.knowledge.habits",
    "PointCloud": "deixis.perception.clouds.cloud",
    "Prediction": "deixis.reasoning.activities.prediction",
    "QueryResult": "deixis.memory.semantic.queries.results",
    "ReadText": "deixis.workflows.layouts.read_english",
    "Recall": "deixis.workflows.knowledge.recall_answer",
    "Recognised": "deixis.learning.views.views",
    "RecognisedActivity": "deixis.reasoning.activities.grounding",
    "Reference": "deixis.reasoning.grounding.reference.answer",
    "Related": "deixis.reasoning.qualitative.relate",
    "Relation": "deixis.ontology.relations.relation",
    "Retrieval": "deixis.workflows.grounding.retrieve",
    "Robot": "deixis.robot.robot",
    "Scene": "deixis.perception.scene",
    "Script": "deixis.grammar.script",
    "Session": "deixis.session",
    "ShapesReport": "deixis.memory.semantic.validation.by_shapes",
    "Shown": "deixis.workflows.scenes.point",
    "Simulation": "deixis.workflows.scenes.simulate",
    "Solved": "deixis.workflows.reasoning.solve",
    "SolvedNetwork": "deixis.workflows.reasoning.solve",
    "Taught": "deixis.learning.views.views",
    "Telling": "deixis.workflows.descriptions.telling",
    "Told": "deixis.robot.robot",
    "Tracking": "deixis.workflows.scenes.track",
    "Unlearned": "deixis.workflows.knowledge.unlearn",
    "ask": "deixis.workflows.grounding.ask",
    "check": "deixis.workflows.grounding.check",
    "chronology": "deixis.workflows.reasoning.time",
    "format_script": "deixis.grammar.layout.format",
    "ground": "deixis.workflows.grounding.ground",
    "habits": "deixis.workflows.knowledge.habits",
    "imagine": "deixis.workflows.layouts.imagine",
    "infer": "deixis.workflows.layouts.infer",
    "learn_reference": "deixis.workflows.descriptions.learn_reference",
    "lint": "deixis.workflows.layouts.lint",
    "perceive": "deixis.workflows.scenes.perceive",
    "point": "deixis.workflows.scenes.point",
    "read": "deixis.workflows.layouts.read_english",
    "read_scene": "deixis.perception.formats.scene_json",
    "read_script": "deixis.workflows.layouts.read",
    "reason": "deixis.workflows.reasoning.reason",
    "refer": "deixis.workflows.descriptions.refer",
    "relate": "deixis.workflows.scenes.relate",
    "retrieve": "deixis.workflows.grounding.retrieve",
    "simulate": "deixis.workflows.scenes.simulate",
    "solve": "deixis.workflows.reasoning.solve",
    "tell": "deixis.workflows.descriptions.tell",
    "validate": "deixis.workflows.reasoning.validate",
    "write_scene": "deixis.workflows.scenes.perceive",
}


def __getattr__(name: str) -> Any:
    """Load an exported name on first use, so that importing one folder never loads another."""
    if name not in _HOMES:
        raise AttributeError(f"module 'deixis' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
