"""Read layouts and lessons back from triples."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime

import pyoxigraph as ox

from deixis.errors import UnknownTermError
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact, Source
from deixis.ontology.lessons.types import ANONYMOUS, Alternative, LayoutConcept, Match, Role
from deixis.ontology.rdf.triple_index import TripleIndex
from deixis.ontology.rdf.triples import last_part
from deixis.ontology.rdf.vocabulary import DX, PROV, W3C
from deixis.ontology.relations.relation import Relation, Relations
from deixis.spelling import nearest


def layouts(triples: Iterable[ox.Triple], relations: Relations) -> tuple[LayoutConcept, ...]:
    """Return all layouts in the learned triples.

    Parameters
    ----------
    triples
        Triples of the learned graph.
    relations
        Relations of the ontology.

    Returns
    -------
    tuple of LayoutConcept
        The layouts, by lesson.
    """
    index = TripleIndex(triples)
    return tuple(_layout(layout, index, relations) for layout in index.subjects(W3C.RDFS_SUB_CLASS_OF, DX.LAYOUT))


def unknown_layout(name: str, known: Iterable[str]) -> UnknownTermError:
    """Return the error for a layout name that is not known.

    Parameters
    ----------
    name
        The name.
    known
        The known names, the nearest of which the message suggests.

    Returns
    -------
    UnknownTermError
        The error, which is not raised.
    """
    names = sorted(set(known))
    if not names:
        return UnknownTermError(f"no layout '{name}' has been learned; the memory has no layouts yet")
    hint = nearest(name, names)
    advice = f"did you mean '{hint}'?" if hint else f"the learned layouts are: {', '.join(names)}"
    return UnknownTermError(f"no layout '{name}' has been learned; {advice}")


def _layout(layout: str, index: TripleIndex, relations: Relations) -> LayoutConcept:
    parts = index.subjects(DX.IN_LAYOUT, layout)
    roles = _in_order([part for part in parts if DX.ROLE in index.values(part, W3C.RDF_TYPE)], index)
    facts = _in_order([part for part in parts if DX.RELATION_STATEMENT in index.values(part, W3C.RDF_TYPE)], index)
    claims = _in_order([part for part in parts if DX.CLAIM in index.values(part, W3C.RDF_TYPE)], index)
    by_iri = {relation.iri: relation for relation in relations.values()}
    viewpoint = index.value(layout, DX.DESCRIBED_FROM)
    groups: dict[frozenset[str], None] = {}
    for role in roles:
        others = index.values(role, DX.INTERCHANGEABLE_WITH)
        if others:
            groups[frozenset((role, *others))] = None
    return LayoutConcept(
        lesson=last_part(layout),
        name=index.value(layout, W3C.RDFS_LABEL) or last_part(layout),
        title=index.value(layout, W3C.DCTERMS_TITLE),
        viewpoint=last_part(viewpoint) if viewpoint else None,
        roles=tuple(
            Role(
                name=last_part(role),
                kind=index.value(role, DX.OF_KIND),
                declared=index.value(role, DX.KIND_DECLARED) == "true",
                colour=index.value(role, DX.OF_COLOUR),
                is_group=index.value(role, DX.IS_GROUP) == "true",
            )
            for role in roles
        ),
        facts=tuple(_fact(fact, index, by_iri) for fact in facts),
        interchangeable=tuple(tuple(sorted(last_part(role) for role in group)) for group in groups),
        claims=tuple(_claim(claim, index) for claim in claims),
        surface=index.value(layout, DX.SURFACE),
    )


def _in_order(parts: list[str], index: TripleIndex) -> list[str]:
    return sorted(parts, key=lambda part: int(index.value(part, DX.POSITION) or 0))


def _fact(fact: str, index: TripleIndex, by_iri: dict[str, Relation]) -> Fact:
    ends = [last_part(index.value(fact, end) or "") for end in (DX.SUBJECT, DX.OBJECT)]
    return Fact(
        subject=ends[0],
        relations=tuple(sorted((by_iri[iri] for iri in index.values(fact, DX.RELATION)), key=lambda r: r.index)),
        object=ends[1],
        positive=index.value(fact, DX.POSITIVE) == "true",
        optional=index.value(fact, DX.OPTIONAL) == "true",
        weight=float(index.value(fact, DX.WEIGHT) or 1),
        source=_source(fact, index),
    )


def _claim(claim: str, index: TripleIndex) -> Claim:
    written = (index.value(claim, DX.ROLES_IN_ORDER) or "").split(" ")
    names = tuple(name.replace("%20", " ").replace("%25", "%") for name in written)
    count = int(index.value(claim, DX.SUBJECT_COUNT) or 1)
    metres = index.value(claim, DX.METRES)
    return Claim(
        relation=index.value(claim, DX.TERM) or "",
        subjects=names[:count],
        arguments=names[count:],
        value=index.value(claim, DX.CLAIMED_VALUE),
        metres=None if metres is None else float(metres),
        positive=index.value(claim, DX.POSITIVE) == "true",
        optional=index.value(claim, DX.OPTIONAL) == "true",
        weight=float(index.value(claim, DX.WEIGHT) or 1),
        source=_source(claim, index),
    )


def _source(statement: str, index: TripleIndex) -> Source | None:
    """Return where a statement was written; only the start of the span was kept."""
    stated_at = index.value(statement, DX.STATED_AT)
    if stated_at is None:
        return None
    file, line, column = stated_at.rsplit(":", 2)
    return Source(file, int(line), int(column), int(line), int(column))


@dataclass(frozen=True)
class LessonRecord:
    """A lesson as stored; ``words_only`` lessons have no matches, since the labels of their scene name the objects."""

    id: str
    script_file: str
    script_text: str
    scene_text: str
    matches: tuple[Match, ...]
    words_only: bool = False


def lesson_records(learned: Iterable[ox.Triple], episodes: Iterable[ox.Triple]) -> tuple[LessonRecord, ...]:
    """Return all lessons that store their script and their scene.

    Parameters
    ----------
    learned
        Triples of the learned graph.
    episodes
        Triples of the graph of episodes.

    Returns
    -------
    tuple of LessonRecord
        The lessons, by id.
    """
    episode_index, learned_index = TripleIndex(episodes), TripleIndex(learned)
    records = []
    for lesson in episode_index.subjects(W3C.RDF_TYPE, DX.LESSON):
        script_text, scene_text = (
            episode_index.value(lesson, predicate) for predicate in (DX.SCRIPT_TEXT, DX.SCENE_TEXT)
        )
        if script_text is None or scene_text is None:
            continue
        name = last_part(lesson)
        parts = learned_index.subjects(PROV.WAS_GENERATED_BY, lesson)
        kept = [_match(part, learned_index) for part in parts if DX.MATCH in learned_index.values(part, W3C.RDF_TYPE)]
        matches = tuple(match for match in kept if match is not None)
        words_only = DX.WORD_LESSON in episode_index.values(lesson, W3C.RDF_TYPE)
        script_file = episode_index.value(lesson, DX.SCRIPT_FILE) or name
        records.append(LessonRecord(name, script_file, script_text, scene_text, matches, words_only))
    return tuple(records)


@dataclass(frozen=True)
class Provenance:
    """Origin of a lesson: who taught it, when, in which words, and in which scene.

    ``told_text`` are the words of a person; None for a lesson from a script in the layout language.
    """

    lesson: str
    teacher: str
    started: datetime
    scene_file: str
    scene_text: str
    script_text: str
    told_text: str | None = None
    script_file: str = ""
    ended: datetime | None = None
    engine: str = ""
    version: str = ""


def provenances(episodes: Iterable[ox.Triple]) -> tuple[Provenance, ...]:
    """Return the provenance of all lessons.

    Parameters
    ----------
    episodes
        Triples of the graph of episodes.

    Returns
    -------
    tuple of Provenance
        The provenance of each lesson that has a time, by id. A lesson of an earlier version has the teacher
        :data:`~deixis.ontology.lessons.types.ANONYMOUS` and no scene file.
    """
    episode_index = TripleIndex(episodes)
    found = []
    for lesson in episode_index.subjects(W3C.RDF_TYPE, DX.LESSON):
        started, teacher = episode_index.value(lesson, PROV.STARTED_AT_TIME), episode_index.value(lesson, DX.TAUGHT_BY)
        ended = episode_index.value(lesson, PROV.ENDED_AT_TIME)
        if started is None:
            continue
        found.append(
            Provenance(
                lesson=last_part(lesson),
                teacher=(episode_index.value(teacher, W3C.RDFS_LABEL) if teacher else None) or ANONYMOUS,
                started=datetime.fromisoformat(started),
                scene_file=episode_index.value(lesson, DX.SCENE_FILE) or "",
                scene_text=episode_index.value(lesson, DX.SCENE_TEXT) or "",
                script_text=episode_index.value(lesson, DX.SCRIPT_TEXT) or "",
                told_text=episode_index.value(lesson, DX.TOLD_TEXT),
                script_file=episode_index.value(lesson, DX.SCRIPT_FILE) or "",
                ended=None if ended is None else datetime.fromisoformat(ended),
                engine=episode_index.value(lesson, DX.ENGINE) or "",
                version=episode_index.value(lesson, DX.SOFTWARE_VERSION) or "",
            )
        )
    return tuple(found)


def _match(part: str, index: TripleIndex) -> Match | None:
    """Return a stored match, or None if it names no scene object, as in lessons of the first format."""
    taken = index.value(part, DX.PERCEIVED_AS) or index.value(part, DX.LIKELIEST)
    if taken is None:
        return None
    probability = index.value(part, DX.PROBABILITY)
    could_be = (last_part(thing) for thing in index.values(part, DX.COULD_BE))
    return Match(
        object=last_part(index.value(part, DX.OF_ROLE) or ""),
        perceived=last_part(taken),
        score=float(index.value(part, DX.SCORE) or 0),
        similarity=math.nan,
        decided=index.value(part, DX.DECIDED) == "true",
        alternatives=tuple(Alternative(thing) for thing in could_be if thing != last_part(taken)),
        probability=None if probability is None else float(probability),
    )
