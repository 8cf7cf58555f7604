"""Reads layouts and lessons back from triples."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import pyoxigraph as ox

from deixis.errors import UnknownTermError
from deixis.ontology.graph import Fact, Source
from deixis.ontology.lessons.types import Alternative, LayoutConcept, Match, Role
from deixis.ontology.lessons.write import lesson_iri
from deixis.ontology.relation import Relation, Relations, nearest
from deixis.ontology.triple_index import TripleIndex
from deixis.ontology.triples import last_part
from deixis.ontology.vocabulary import DX, PROV, W3C


def layouts(triples: Iterable[ox.Triple], relations: Relations) -> tuple[LayoutConcept, ...]:
    """Every layout that learned triples describe, by lesson."""
    index = TripleIndex(triples)
    return tuple(_layout(layout, index, relations) for layout in index.subjects(W3C.RDFS_SUB_CLASS_OF, DX.LAYOUT))


def unknown_layout(name: str, known: Iterable[str]) -> UnknownTermError:
    """The error that says that no layout has a name, with the nearest of those that there are."""
    names = sorted(set(known))
    if not names:
        return UnknownTermError(f"no layout '{name}' has been learned, nor any other")
    hint = nearest(name, names)
    told = f"did you mean '{hint}'?" if hint else f"the learned ones are: {', '.join(names)}"
    return UnknownTermError(f"no layout '{name}' has been learned; {told}")


def _layout(layout: str, index: TripleIndex, relations: Relations) -> LayoutConcept:
    parts = index.subjects(DX.IN_LAYOUT, layout)
    roles = _in_order([part for part in parts if DX.ROLE in index.values(part, W3C.RDF_TYPE)], index)
    facts = _in_order([part for part in parts if DX.RELATION_STATEMENT in index.values(part, W3C.RDF_TYPE)], index)
    by_iri = {relation.iri: relation for relation in relations.values()}
    viewpoint = index.value(layout, DX.DESCRIBED_FROM)
    return LayoutConcept(
        lesson=last_part(layout),
        name=index.value(layout, W3C.RDFS_LABEL) or last_part(layout),
        title=index.value(layout, W3C.DCTERMS_TITLE),
        viewpoint=last_part(viewpoint) if viewpoint else None,
        roles=tuple(_role(role, index) for role in roles),
        facts=tuple(_fact(fact, index, by_iri) for fact in facts),
        interchangeable=_groups(roles, index),
    )


def _in_order(parts: list[str], index: TripleIndex) -> list[str]:
    return sorted(parts, key=lambda part: int(index.value(part, DX.POSITION) or 0))


def _role(role: str, index: TripleIndex) -> Role:
    declared = index.value(role, DX.KIND_DECLARED) == "true"
    return Role(last_part(role), index.value(role, DX.OF_KIND), declared, index.value(role, DX.OF_COLOUR))


def _fact(fact: str, index: TripleIndex, by_iri: dict[str, Relation]) -> Fact:
    ends = [last_part(index.value(fact, end) or "") for end in (DX.SUBJECT, DX.OBJECT)]
    return Fact(
        subject=ends[0],
        relations=tuple(sorted((by_iri[iri] for iri in index.values(fact, DX.RELATION)), key=lambda r: r.index)),
        object=ends[1],
        positive=index.value(fact, DX.POSITIVE) == "true",
        optional=index.value(fact, DX.OPTIONAL) == "true",
        weight=float(index.value(fact, DX.WEIGHT) or 1),
        source=_source(index.value(fact, DX.STATED_AT)),
    )


def _source(stated_at: str | None) -> Source | None:
    """The place that ``file:line:column`` names; of the span only its beginning is kept."""
    if stated_at is None:
        return None
    file, line, column = stated_at.rsplit(":", 2)
    return Source(file, int(line), int(column), int(line), int(column))


def _groups(roles: list[str], index: TripleIndex) -> tuple[tuple[str, ...], ...]:
    groups: dict[frozenset[str], None] = {}
    for role in roles:
        others = index.values(role, DX.INTERCHANGEABLE_WITH)
        if others:
            groups[frozenset((role, *others))] = None
    return tuple(tuple(sorted(last_part(role) for role in group)) for group in groups)


@dataclass(frozen=True)
class LessonRecord:
    """A lesson as it was kept. ``words_only``: the labels of its scene say who is who, and there are no matches."""

    id: str
    script_file: str
    script_text: str
    scene_text: str
    matches: tuple[Match, ...]
    words_only: bool = False


def lesson_records(learned: Iterable[ox.Triple], episodes: Iterable[ox.Triple]) -> tuple[LessonRecord, ...]:
    """Every lesson that keeps its script and its scene, by id."""
    told, said = TripleIndex(episodes), TripleIndex(learned)
    ids = [last_part(lesson) for lesson in told.subjects(W3C.RDF_TYPE, DX.LESSON)]
    found = (_record(id, told, said) for id in ids)
    return tuple(record for record in found if record is not None)


def _record(id: str, told: TripleIndex, said: TripleIndex) -> LessonRecord | None:
    lesson = lesson_iri(id)
    texts = [told.value(lesson, predicate) for predicate in (DX.SCRIPT_TEXT, DX.SCENE_TEXT)]
    if texts[0] is None or texts[1] is None:
        return None
    parts = said.subjects(PROV.WAS_GENERATED_BY, lesson)
    kept = [_match(part, said) for part in parts if DX.MATCH in said.values(part, W3C.RDF_TYPE)]
    matches = tuple(match for match in kept if match is not None)
    words_only = DX.WORD_LESSON in told.values(lesson, W3C.RDF_TYPE)
    return LessonRecord(id, told.value(lesson, DX.SCRIPT_FILE) or id, texts[0], texts[1], matches, words_only)


def _match(part: str, said: TripleIndex) -> Match | None:
    """A match as it was kept; None where that does not say what is likeliest, as the first lessons did not."""
    taken = said.value(part, DX.PERCEIVED_AS) or said.value(part, DX.LIKELIEST)
    if taken is None:
        return None
    probability = said.value(part, DX.PROBABILITY)
    could_be = (last_part(thing) for thing in said.values(part, DX.COULD_BE))
    return Match(
        object=last_part(said.value(part, DX.OF_ROLE) or ""),
        perceived=last_part(taken),
        score=float(said.value(part, DX.SCORE) or 0),
        similarity=math.nan,
        decided=said.value(part, DX.DECIDED) == "true",
        alternatives=tuple(Alternative(thing) for thing in could_be if thing != last_part(taken)),
        probability=None if probability is None else float(probability),
    )
