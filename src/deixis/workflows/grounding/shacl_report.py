"""A check as a standard SHACL report: the layout's shapes over the scene's data, by pyshacl."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import pyoxigraph as ox

from deixis.memory.semantic.validation.shacl import report_turtle
from deixis.ontology.graph.claims import Claim
from deixis.ontology.lessons.shapes import layout_shapes, scene_data
from deixis.ontology.lessons.types import LayoutConcept
from deixis.ontology.rdf.triples import with_blank_nodes
from deixis.ontology.relations.relation import Relation, Relations
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.checking import TableCheck
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.grounding.answers.claims import ClaimVerdict
from deixis.reasoning.grounding.evidence.evidence import HELD_FROM
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models


def shacl_report(layout: LayoutConcept, scene: Scene, check: TableCheck, relations: Relations) -> tuple[bool, str]:
    """Validate a checked scene against the shapes of its layout with pyshacl.

    Parameters
    ----------
    layout
        The layout.
    scene
        The scene.
    check
        The verdicts on the roles.
    relations
        Relations of the ontology.

    Returns
    -------
    tuple
        True if the scene conforms, and the validation report as Turtle.
    """
    import rdflib
    from pyshacl import validate

    fills = {entry.perceived: entry.role for entry in check.roles if entry.perceived is not None}
    related = satisfied_relations(layout, scene, fills, relations)
    coloured = {entry.perceived: other.seen.iri for entry, other in check.miscoloured if entry.perceived is not None}
    decided: dict[Claim, bool] = {}
    for outcome in check.claims:
        if outcome.verdict not in (ClaimVerdict.UNDECIDABLE, ClaimVerdict.OPEN):
            held_so_far = decided.get(outcome.claim, True)
            decided[outcome.claim] = held_so_far and outcome.verdict is ClaimVerdict.SATISFIED
    held = {position: decided[claim] for position, claim in enumerate(layout.claims, 1) if claim in decided}
    things = tuple(id for id in scene.ids if id != check.surface)
    data = scene_data(layout, things, fills, related, coloured, held)
    graphs = []
    for triples in (data, layout_shapes(layout)):
        graph = rdflib.Graph()
        graph.parse(data=ox.serialize(with_blank_nodes(triples), format=ox.RdfFormat.N_TRIPLES) or b"", format="nt")
        graphs.append(graph)
    conforms, report, _ = validate(
        graphs[0], shacl_graph=graphs[1], allow_warnings=True, allow_infos=True, do_owl_imports=False, inplace=True
    )
    assert isinstance(report, rdflib.Graph)
    return bool(conforms), report_turtle(report)


def satisfied_relations(
    layout: LayoutConcept, scene: Scene, fills: dict[str, str], relations: Relations
) -> Iterator[tuple[str, Relation, str]]:
    """Yield each relation that a fact of the layout names and that holds between the things in its roles.

    A word that only a model decides holds at a degree of at least one half by the shipped models. A direction that the
    scene does not show holds as it is stated, so that it is not reported.

    Parameters
    ----------
    layout
        The layout.
    scene
        The scene.
    fills
        Role by the id of the thing that fills it.
    relations
        Relations of the ontology.

    Yields
    ------
    tuple
        Id of the subject, relation, and id of the object.
    """
    things: dict[str, list[str]] = {}
    for id, role in fills.items():
        things.setdefault(role, []).append(id)
    seen, position = scene.relations(relations), {id: i for i, id in enumerate(scene.ids)}
    degrees = None if seen.boxes is None else WordDegrees(pair_geometry(seen.boxes, scene.poses), shipped_models())
    for fact in layout.facts:
        pairs = product(things.get(fact.subject, ()), things.get(fact.object, ()), fact.relations)
        for subject, object, relation in pairs:
            if subject == object:
                continue
            pair = position[subject], position[object]
            if relation.by_model:
                held = degrees is None or bool(degrees.of(relation)[pair] >= HELD_FROM)
                if degrees is not None and degrees.undecided(relation.word)[pair]:
                    held = fact.positive
            else:
                held = bool(relations.degrees[relation.index, seen.names[pair]] > 0)
                held = held or (degrees is not None and bool(degrees.held_by_front(relation.word)[pair]))
            if held:
                yield subject, relation, object
