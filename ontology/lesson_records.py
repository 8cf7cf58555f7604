"""Lessons back from triples, as the texts and the matches that they keep: what it takes to learn from them again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import pyoxigraph as ox

from deixis.ontology.concepts import MatchRecord
from deixis.ontology.iris import last_part
from deixis.ontology.lesson_triples import lesson_iri
from deixis.ontology.rdf import TripleIndex
from deixis.ontology.vocabulary import DX, PROV, W3C


@dataclass(frozen=True)
class LessonRecord:
    """A lesson as it was kept. ``words_only``: the labels of its scene say who is who, and there are no matches."""

    id: str
    script_file: str
    script_text: str
    scene_text: str
    matches: tuple[MatchRecord, ...]
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
    matches = tuple(_match(part, said) for part in parts if DX.MATCH in said.values(part, W3C.RDF_TYPE))
    words_only = DX.WORD_LESSON in told.values(lesson, W3C.RDF_TYPE)
    return LessonRecord(id, told.value(lesson, DX.SCRIPT_FILE) or id, texts[0], texts[1], matches, words_only)


def _match(part: str, said: TripleIndex) -> MatchRecord:
    perceived, likeliest = (said.value(part, predicate) for predicate in (DX.PERCEIVED_AS, DX.LIKELIEST))
    probability = said.value(part, DX.PROBABILITY)
    return MatchRecord(
        role=last_part(said.value(part, DX.OF_ROLE) or ""),
        perceived=last_part(perceived) if perceived is not None else None,
        decided=said.value(part, DX.DECIDED) == "true",
        score=float(said.value(part, DX.SCORE) or 0),
        could_be=tuple(last_part(thing) for thing in said.values(part, DX.COULD_BE)),
        probability=None if probability is None else float(probability),
        likeliest=last_part(likeliest) if likeliest is not None else None,
    )
