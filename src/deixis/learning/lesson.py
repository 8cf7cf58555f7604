"""From a grounding to a lesson: what is kept of a script, a scene and who was who; and what follows from it all."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

import pyoxigraph as ox

from deixis.grammar.format import format_script
from deixis.grammar.language import language_of
from deixis.grammar.script import Script
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.ontology.lessons.types import LayoutConcept, Lesson, Role, SeenRelation
from deixis.ontology.relation import Reading, Relations
from deixis.ontology.triples import GENID, iri, learned_iri, text, with_blank_nodes
from deixis.ontology.vocabulary import PROV, W3C
from deixis.perception.formats.scene_json import scene_to_dict
from deixis.perception.scene import Scene
from deixis.reasoning.description_logic.reasoners import Classification, classify
from deixis.reasoning.errors import InconsistencyError
from deixis.reasoning.grounding.answer import Grounding

MAX_PAIRS = 2000
"""Ordered pairs of a scene whose relations are all kept; of a larger scene only those that the script compares."""

ENGINES = {"HermiT": "broader classes", "Deixis": "kinds of things, and wide relations of pairs from exact ones"}
"""What works out the inferred graph."""


@dataclass(frozen=True, slots=True)
class Occasion:
    """When and by what something was learned."""

    started: datetime
    ended: datetime
    version: str


def layout_concept(script: Script, lesson: str, interchangeable: Iterable[tuple[str, ...]] = ()) -> LayoutConcept:
    """The layout that a script describes, as a concept of that lesson."""
    graph = script.graph()
    roles = [
        Role(name, kind, name in script.kinds, script.colours[name].iri if name in script.colours else None)
        for name, kind in zip(graph.nodes, graph.kinds or (None,) * len(graph.nodes), strict=True)
    ]
    return LayoutConcept(
        lesson=lesson,
        name=layout_name(script),
        title=script.title,
        viewpoint=script.viewpoint,
        roles=tuple(roles),
        facts=tuple(graph.facts()),
        interchangeable=tuple(interchangeable),
    )


def layout_name(script: Script) -> str:
    """The name in the header, or one made from the file's that a header can bear."""
    if script.name:
        return script.name
    stem = Path(script.file).name.strip("<>.").split(".")[0]
    name = re.sub(r"\W+", "_", stem).strip("_") or "layout"
    return name if language_of(script.ontology).reads_as_name(name) else f"layout_{name}"


def lesson_of(script: Script, scene: Scene, found: Grounding, id: str, occasion: Occasion) -> Lesson:
    """Everything that one grounding teaches."""
    return Lesson(
        layout=layout_concept(script, id, found.interchangeable),
        scene=scene,
        relations=tuple(_seen_relations(scene, script.ontology.relations, found)),
        matches=tuple(found.matches.values()),
        engine=found.engine,
        proved_best=found.proved_best,
        started=occasion.started,
        ended=occasion.ended,
        version=occasion.version,
        script_file=script.file,
        script_text=format_script(script),
        scene_text=json.dumps(scene_to_dict(scene), ensure_ascii=False, sort_keys=True),
    )


def _seen_relations(scene: Scene, relations: Relations, found: Grounding) -> Iterator[SeenRelation]:
    names, ids = scene.relations(relations).names, scene.ids
    compared = {entry.perceived for entry in found.outcomes if entry.perceived is not None}
    few = len(ids) * (len(ids) - 1) <= MAX_PAIRS
    for i, subject in enumerate(ids):
        for j, object in enumerate(ids):
            if i != j and (few or (subject, object) in compared):
                yield subject, relations.members(1 << int(names[i, j]))[0], object


def consequences(
    ontology: Iterable[ox.Triple], learned: Iterable[ox.Triple], asserted: Iterable[ox.Triple], relations: Relations
) -> list[ox.Triple]:
    """All that follows from what was learned and seen, and was not said: the content of the inferred graph.

    HermiT classifies the ontology with the learned classes; the kinds of things follow from that, and the wide
    relations of pairs from their exact ones. Raises InconsistencyError where a learned class has become impossible.
    """
    learned, asserted = list(learned), list(asserted)
    axioms = ox.serialize(with_blank_nodes([*ontology, *_class_axioms(learned)]), format=ox.RdfFormat.N_TRIPLES)
    classified = _classified("".join(sorted((axioms or b"").decode("utf-8").splitlines(keepends=True))))
    if classified.unsatisfiable:
        listed = ", ".join(iri.rsplit("/", 1)[-1] for iri in classified.unsatisfiable)
        raise InconsistencyError(
            f"nothing can be a '{listed}' any more: what was learned about it before says it is of another kind; "
            "forget that lesson, or declare the same kind in both scripts"
        )
    inferred = list(ox.parse(classified.inferred, format=ox.RdfFormat.N_TRIPLES))
    classes = [ox.Triple(quad.subject, quad.predicate, quad.object) for quad in inferred]
    known = {*learned, *asserted}
    types = _types(asserted, [*learned, *classes])
    wide = _wide(asserted, relations)
    return sorted({*({*classes, *types, *wide} - known), *_origin()}, key=str)


@lru_cache(maxsize=16)  # some 3 MB
def _classified(axioms: str) -> Classification:
    """HermiT's answer, which takes a second: lessons about words alone, or taken back, bring no new axioms."""
    return classify(axioms)


def _origin() -> Iterator[ox.Triple]:
    """Where the inferred graph comes from, said in it: from what, and by which engines.

    It bears no time: the same facts always come to the same graph.
    """
    graph, inference = graph_iri(GraphName.INFERRED), iri(learned_iri("inference"))
    sources = [graph_iri(name) for name in (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED)]
    yield ox.Triple(graph, iri(W3C.RDF_TYPE), iri(PROV.ENTITY))
    yield ox.Triple(graph, iri(PROV.WAS_GENERATED_BY), inference)
    yield ox.Triple(inference, iri(W3C.RDF_TYPE), iri(PROV.ACTIVITY))
    for source in sources:
        yield ox.Triple(graph, iri(PROV.WAS_DERIVED_FROM), source)
        yield ox.Triple(inference, iri(PROV.USED), source)
    for name, does in ENGINES.items():
        agent = iri(learned_iri("agent", name))
        yield ox.Triple(inference, iri(PROV.WAS_ASSOCIATED_WITH), agent)
        yield ox.Triple(agent, iri(W3C.RDF_TYPE), iri(PROV.SOFTWARE_AGENT))
        yield ox.Triple(agent, iri(W3C.RDFS_LABEL), text(f"{name}: {does}"))


def _class_axioms(learned: list[ox.Triple]) -> list[ox.Triple]:
    """What learned triples say of classes; roles, statements and matches are no business of classification."""
    classes = {t.subject for t in learned if t.predicate.value == W3C.RDF_TYPE and _value(t.object) == W3C.OWL_CLASS}
    return [t for t in learned if t.subject in classes or _value(t.subject).startswith(GENID)]


def _types(asserted: list[ox.Triple], classes: list[ox.Triple]) -> Iterator[ox.Triple]:
    """Every broader class of what each thing is said to be."""
    broader: dict[str, set[ox.Triple]] = {}
    for triple in classes:
        if triple.predicate.value == W3C.RDFS_SUB_CLASS_OF and not _value(triple.object).startswith(GENID):
            broader.setdefault(_value(triple.subject), set()).add(triple)
    for triple in asserted:
        if triple.predicate.value == W3C.RDF_TYPE:
            for axiom in broader.get(_value(triple.object), ()):
                yield ox.Triple(triple.subject, triple.predicate, axiom.object)


def _wide(asserted: list[ox.Triple], relations: Relations) -> Iterator[ox.Triple]:
    exact = {relation.iri: relation for relation in relations.of_reading(Reading.EXACT)}
    for triple in asserted:
        relation = exact.get(triple.predicate.value)
        if relation is not None:
            for broader in relation.broader:
                yield ox.Triple(triple.subject, ox.NamedNode(relations[broader].iri), triple.object)


def _value(term: object) -> str:
    return str(getattr(term, "value", ""))
