"""Write a lesson as triples, grouped by the named graph that each belongs to."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import pyoxigraph as ox

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.lessons.types import LayoutConcept, Lesson, Match, Role, SeenObject, WordLesson
from deixis.ontology.rdf.triples import (
    Description,
    category_iri,
    content_key,
    decimal,
    iri,
    learned_iri,
    skolem,
    text,
    typed,
)
from deixis.ontology.rdf.vocabulary import DX, PROV, W3C
from deixis.ontology.relations.relation import Relations
from deixis.ontology.things.colours import hex_of_rgb
from deixis.ontology.things.kinds import Kinds

_CORNERS = ((DX.MIN_X, DX.MAX_X), (DX.MIN_Y, DX.MAX_Y), (DX.MIN_Z, DX.MAX_Z))


def learned_triples(lesson: Lesson, relations: Relations) -> Iterator[ox.Triple]:
    """Yield the layout as a class with its roles and statements, the categories, and the matches.

    Parameters
    ----------
    lesson
        The lesson.
    relations
        Relations of the ontology.

    Yields
    ------
    ox.Triple
        A triple of the learned graph.
    """
    layout = lesson.layout
    yield from layout_triples(layout, relations)
    kinds = {role.name: role.kind for role in layout.roles}
    for number, match in enumerate(lesson.matches):
        again = any(other.object == match.object for other in lesson.matches[:number])
        yield from _match(lesson, match, again)
    for match in lesson.categories():
        yield from _category(lesson.category_of(match), kinds.get(match.object), lesson)


def layout_triples(layout: LayoutConcept, relations: Relations, optional: Collection[str] = ()) -> Iterator[ox.Triple]:
    """Yield a layout as a class with its roles and statements.

    Parameters
    ----------
    layout
        The layout.
    relations
        Relations of the ontology.
    optional
        Roles that need not be filled, whose kinds the class does not require.

    Yields
    ------
    ox.Triple
        A triple of the learned graph.
    """
    yield from _layout(layout, relations, optional)
    for position, role in enumerate(layout.roles, 1):
        yield from _role(layout, role, position)
    for position, fact in enumerate(layout.facts, 1):
        yield from _statement(layout, fact, position)
    for position, claim in enumerate(layout.claims, 1):
        yield from _claim(layout, claim, position)


def noun_triples(lesson: Lesson, kinds: Kinds) -> Iterator[ox.Triple]:
    """Yield the classes of the lexicon that the layout's roles have and that the TBox does not, up to the TBox.

    Parameters
    ----------
    lesson
        The lesson.
    kinds
        The known kinds.

    Yields
    ------
    ox.Triple
        A triple of the learned graph.
    """
    known = dict.fromkeys(kinds[role.kind] for role in lesson.layout.roles if role.kind and role.kind in kinds)
    above = dict.fromkeys(kinds[name] for kind in known for name in sorted(kind.broader))
    for kind in known | above:
        if not kinds.in_tbox(kind.iri):
            about = Description(kind.iri)
            about.say(W3C.RDF_TYPE, iri(W3C.OWL_CLASS))
            about.say(W3C.RDFS_LABEL, text(kind.label))
            about.say(W3C.RDFS_SUB_CLASS_OF, iri(kinds.parent(kind).iri))
            yield from about


def asserted_triples(lesson: Lesson | WordLesson) -> Iterator[ox.Triple]:
    """Yield the scene: its objects with boxes, their exact relations, and the categories of decided matches.

    Parameters
    ----------
    lesson
        The lesson.

    Yields
    ------
    ox.Triple
        A triple of the asserted graph.
    """
    record, scene = lesson.scene, scene_iri(lesson)
    about = Description(scene)
    about.say(W3C.RDF_TYPE, iri(DX.SCENE))
    about.say(DX.FRAME, text(record.frame))
    about.say(DX.UNIT, text(record.unit))
    about.say(DX.SEEN_FROM, iri(_viewpoint(record.viewpoint)))
    yield from about
    yield from _viewpoint_triples(record.viewpoint)
    for seen in record.objects:
        yield from _seen(lesson, seen)
    for subject, relation, other in lesson.relations if isinstance(lesson, Lesson) else ():
        yield ox.Triple(iri(thing_iri(lesson, subject)), iri(relation.iri), iri(thing_iri(lesson, other)))
    if isinstance(lesson, Lesson):
        for match in lesson.categories():
            category = category_iri(lesson.category_of(match))
            yield ox.Triple(iri(thing_iri(lesson, match.perceived)), iri(W3C.RDF_TYPE), iri(category))


def episode_triples(lesson: Lesson | WordLesson) -> Iterator[ox.Triple]:
    """Yield the provenance of the lesson: its time, teacher, words, script, scene, engine and software version.

    Parameters
    ----------
    lesson
        The lesson.

    Yields
    ------
    ox.Triple
        A triple of the graph of episodes.
    """
    about = Description(lesson_iri(lesson.id))
    about.say(W3C.RDF_TYPE, iri(DX.LESSON))
    if isinstance(lesson, WordLesson):
        about.say(W3C.RDF_TYPE, iri(DX.WORD_LESSON))
    about.say(W3C.RDFS_LABEL, text(lesson.id))
    about.say(PROV.STARTED_AT_TIME, typed(lesson.started))
    about.say(PROV.ENDED_AT_TIME, typed(lesson.ended))
    script, agent = script_iri(lesson.id), learned_iri("agent", f"deixis {lesson.version}")
    about.say(PROV.USED, iri(scene_iri(lesson)))
    person = learned_iri("person", lesson.teacher)
    about.say(PROV.WAS_ASSOCIATED_WITH, iri(agent))
    yield ox.Triple(iri(script), iri(W3C.RDF_TYPE), iri(PROV.ENTITY))
    yield ox.Triple(iri(script), iri(W3C.RDFS_LABEL), text(lesson.script_file))
    yield ox.Triple(iri(agent), iri(W3C.RDF_TYPE), iri(PROV.SOFTWARE_AGENT))
    yield ox.Triple(iri(agent), iri(W3C.RDFS_LABEL), text(f"Deixis {lesson.version}"))
    yield ox.Triple(iri(person), iri(W3C.RDF_TYPE), iri(PROV.PERSON))
    yield ox.Triple(iri(person), iri(W3C.RDFS_LABEL), text(lesson.teacher))
    about.say(DX.TAUGHT_BY, iri(person))
    about.say(DX.ENGINE, text(lesson.engine))
    about.say(DX.PROVED_BEST, typed(lesson.proved_best))
    about.say(DX.SOFTWARE_VERSION, text(lesson.version))
    about.say(DX.SCRIPT_FILE, text(lesson.script_file))
    about.say(DX.SCRIPT_TEXT, text(lesson.script_text))
    about.say(DX.SCENE_TEXT, text(lesson.scene_text))
    if lesson.scene_file:
        about.say(DX.SCENE_FILE, text(lesson.scene_file))
    if lesson.told_text is not None:
        about.say(DX.TOLD_TEXT, text(lesson.told_text))
    yield from about


def lesson_iri(lesson: str) -> str:
    """Return the IRI of a lesson.

    Parameters
    ----------
    lesson
        Id of the lesson.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("lesson", lesson)


def script_iri(lesson: str) -> str:
    """Return the IRI of a lesson's script, which its statements are derived from.

    Parameters
    ----------
    lesson
        Id of the lesson.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("lesson", lesson, "script")


def layout_iri(lesson: str) -> str:
    """Return the IRI of the layout that a lesson taught.

    Parameters
    ----------
    lesson
        Id of the lesson.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("layout", lesson)


def role_iri(lesson: str, role: str) -> str:
    """Return the IRI of a role of a layout.

    Parameters
    ----------
    lesson
        Id of the lesson.
    role
        Name of the role.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("layout", lesson, "role", role)


def fact_iri(lesson: str, position: int) -> str:
    """Return the IRI of the statement of a layout's fact.

    Parameters
    ----------
    lesson
        Id of the lesson.
    position
        Position of the fact in the layout, from 1.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("layout", lesson, "fact", position)


def claim_iri(lesson: str, position: int) -> str:
    """Return the IRI of the statement of a layout's claim.

    Parameters
    ----------
    lesson
        Identifier of the lesson.
    position
        Position of the claim among the layout's claims, from 1.

    Returns
    -------
    str
        IRI below the namespace of learned things.
    """
    return learned_iri("layout", lesson, "claim", position)


def scene_iri(lesson: Lesson | WordLesson) -> str:
    """Return the IRI of a lesson's scene, made from its content, so that lessons from one scene share its objects.

    Parameters
    ----------
    lesson
        The lesson.

    Returns
    -------
    str
        The IRI.
    """
    return scene_text_iri(lesson.scene_text)


def scene_text_iri(scene_text: str) -> str:
    """Return the IRI of the scene with this text.

    Parameters
    ----------
    scene_text
        JSON of the scene.

    Returns
    -------
    str
        The IRI, which depends on the text only.
    """
    return learned_iri("scene", content_key(scene_text))


def thing_iri(lesson: Lesson | WordLesson, name: str) -> str:
    """Return the IRI of an object of a lesson's scene.

    Parameters
    ----------
    lesson
        The lesson.
    name
        Id of the object in the scene.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("scene", content_key(lesson.scene_text), name)


def _viewpoint(name: str) -> str:
    return learned_iri("viewpoint", name)


def _viewpoint_triples(name: str) -> Iterator[ox.Triple]:
    about = Description(_viewpoint(name))
    about.say(W3C.RDF_TYPE, iri(DX.VIEWPOINT))
    about.say(W3C.RDFS_LABEL, text(name))
    return iter(about)


def _layout(layout: LayoutConcept, relations: Relations, optional: Collection[str]) -> Iterator[ox.Triple]:
    about = Description(layout_iri(layout.lesson))
    about.say(W3C.RDF_TYPE, iri(W3C.OWL_CLASS))
    about.say(W3C.RDFS_LABEL, text(layout.name))
    about.say(W3C.RDFS_SUB_CLASS_OF, iri(DX.LAYOUT))
    about.say(DX.LEARNED_IN, iri(lesson_iri(layout.lesson)))
    if layout.title:
        about.say(W3C.DCTERMS_TITLE, text(layout.title))
    if layout.surface:
        about.say(DX.SURFACE, text(layout.surface))
    if layout.viewpoint:
        about.say(DX.DESCRIBED_FROM, iri(_viewpoint(layout.viewpoint)))
        yield from _viewpoint_triples(layout.viewpoint)
    kinds = dict.fromkeys(role.kind for role in layout.roles if role.kind and role.name not in optional)
    for number, kind in enumerate(kinds, 1):
        restriction = Description(skolem(f"{content_key(layout.lesson)}.r{number}").value)
        restriction.say(W3C.RDF_TYPE, iri(W3C.OWL_RESTRICTION))
        restriction.say(W3C.OWL_ON_PROPERTY, iri(DX.SHOWS))
        restriction.say(W3C.OWL_SOME_VALUES_FROM, iri(kind))
        about.say(W3C.RDFS_SUB_CLASS_OF, restriction.subject)
        yield from restriction
    yield from about


def _role(layout: LayoutConcept, role: Role, position: int) -> Iterator[ox.Triple]:
    about = Description(role_iri(layout.lesson, role.name))
    about.say(W3C.RDF_TYPE, iri(DX.ROLE))
    about.say(W3C.RDFS_LABEL, text(role.name))
    about.say(DX.IN_LAYOUT, iri(layout_iri(layout.lesson)))
    about.say(DX.POSITION, typed(position))
    about.say(DX.KIND_DECLARED, typed(role.declared))
    about.say(PROV.WAS_GENERATED_BY, iri(lesson_iri(layout.lesson)))
    about.say(PROV.WAS_DERIVED_FROM, iri(script_iri(layout.lesson)))
    if role.kind:
        about.say(DX.OF_KIND, iri(role.kind))
    if role.colour:
        about.say(DX.OF_COLOUR, iri(role.colour))
    if role.is_group:
        about.say(DX.IS_GROUP, typed(True))
    for group in layout.interchangeable:
        if role.name in group:
            others = (iri(role_iri(layout.lesson, other)) for other in group if other != role.name)
            about.say(DX.INTERCHANGEABLE_WITH, *others)
    return iter(about)


def _statement(layout: LayoutConcept, fact: Fact, position: int) -> Iterator[ox.Triple]:
    about = Description(fact_iri(layout.lesson, position))
    about.say(W3C.RDF_TYPE, iri(DX.RELATION_STATEMENT))
    about.say(DX.IN_LAYOUT, iri(layout_iri(layout.lesson)))
    about.say(DX.SUBJECT, iri(role_iri(layout.lesson, fact.subject)))
    about.say(DX.OBJECT, iri(role_iri(layout.lesson, fact.object)))
    about.say(DX.RELATION, *(iri(relation.iri) for relation in fact.relations))
    _qualify(about, layout, fact, position)
    return iter(about)


def _claim(layout: LayoutConcept, claim: Claim, position: int) -> Iterator[ox.Triple]:
    about = Description(claim_iri(layout.lesson, position))
    names = (*claim.subjects, *claim.arguments)
    about.say(W3C.RDF_TYPE, iri(DX.CLAIM))
    about.say(DX.IN_LAYOUT, iri(layout_iri(layout.lesson)))
    about.say(DX.TERM, text(claim.relation))
    about.say(DX.ABOUT, *(iri(role_iri(layout.lesson, name)) for name in dict.fromkeys(names)))
    about.say(DX.ROLES_IN_ORDER, text(" ".join(map(_escaped, names))))
    about.say(DX.SUBJECT_COUNT, typed(len(claim.subjects)))
    if claim.value is not None:
        about.say(DX.CLAIMED_VALUE, text(claim.value))
    if claim.metres is not None:
        about.say(DX.METRES, typed(claim.metres))
    _qualify(about, layout, claim, position)
    return iter(about)


def _escaped(name: str) -> str:
    return name.replace("%", "%25").replace(" ", "%20")


def _qualify(about: Description, layout: LayoutConcept, statement: Fact | Claim, position: int) -> None:
    """Say how a statement is qualified, and where it comes from."""
    about.say(DX.POSITIVE, typed(statement.positive))
    about.say(DX.OPTIONAL, typed(statement.optional))
    about.say(DX.WEIGHT, decimal(statement.weight))
    about.say(PROV.WAS_GENERATED_BY, iri(lesson_iri(layout.lesson)))
    about.say(PROV.WAS_DERIVED_FROM, iri(script_iri(layout.lesson)))
    about.say(DX.POSITION, typed(position))
    if statement.source is not None:
        about.say(DX.STATED_AT, text(str(statement.source)))
        about.say(DX.LINE, typed(statement.source.line))


def _match(lesson: Lesson, match: Match, again: bool = False) -> Iterator[ox.Triple]:
    """Yield a match; ``again`` for a further member of a group."""
    further = (match.perceived,) if again else ()
    about = Description(learned_iri("lesson", lesson.id, "match", match.object, *further))
    about.say(W3C.RDF_TYPE, iri(DX.MATCH))
    about.say(DX.OF_ROLE, iri(role_iri(lesson.id, match.object)))
    about.say(DX.DECIDED, typed(match.decided))
    about.say(DX.SCORE, decimal(match.score))
    if match.probability is not None:
        about.say(DX.PROBABILITY, decimal(match.probability))
    about.say(PROV.WAS_GENERATED_BY, iri(lesson_iri(lesson.id)))
    about.say(DX.COULD_BE, *(iri(thing_iri(lesson, other)) for other in match.could_be))
    about.say(DX.PERCEIVED_AS if match.decided else DX.LIKELIEST, iri(thing_iri(lesson, match.perceived)))
    if match.decided:
        about.say(DX.CATEGORY, iri(category_iri(lesson.category_of(match))))
    return iter(about)


def _category(name: str, kind: str | None, lesson: Lesson) -> Iterator[ox.Triple]:
    about = Description(category_iri(name))
    about.say(W3C.RDF_TYPE, iri(W3C.OWL_CLASS))
    about.say(W3C.RDFS_LABEL, text(name.replace("_", " ")))
    about.say(W3C.RDFS_SUB_CLASS_OF, iri(kind or DX.THING))
    about.say(DX.LEARNED_IN, iri(lesson_iri(lesson.id)))
    return iter(about)


def _seen(lesson: Lesson | WordLesson, seen: SeenObject) -> Iterator[ox.Triple]:
    about = Description(thing_iri(lesson, seen.id))
    about.say(W3C.RDF_TYPE, iri(DX.PERCEIVED_OBJECT))
    about.say(DX.IN_SCENE, iri(scene_iri(lesson)))
    about.say(DX.IDENTIFIER, text(seen.id))
    for (least, greatest), low, high in zip(_CORNERS, seen.minimum, seen.maximum, strict=False):
        about.say(least, typed(float(low)))
        about.say(greatest, typed(float(high)))
    if seen.label is not None:
        about.say(DX.PERCEIVED_LABEL, text(seen.label))
        about.say(DX.CONFIDENCE, decimal(seen.confidence))
    if seen.colour is not None:
        about.say(DX.PERCEIVED_COLOUR, text(hex_of_rgb(seen.colour)))
    return iter(about)
