"""Grounding a graph in a scene by the facts alone, and what came of it."""

from __future__ import annotations

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence, no_unary_evidence
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.options import Select

R = default_ontology().relations


def evidence(description: RelationGraph, scene: Scene) -> Evidence:
    return no_unary_evidence(description, scene.relations(R))


def answer(description: RelationGraph, scene: Scene, engine: str = "exact", select: Select = Select.FACTS) -> Grounding:
    return ground(evidence(description, scene), engine_named(engine, select))


def pairs(found: Grounding) -> dict[str, str]:
    return {name: match.perceived for name, match in found.matches.items()}


def right(found: Grounding) -> int:
    """Count the objects that are matched to the thing with their own name."""
    return sum(name == match.perceived for name, match in found.matches.items())
