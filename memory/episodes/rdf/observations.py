"""Fluents as RDF: SOSA observations with times, certainty and provenance, and statements as plain triples.

>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> cup = episodic("f1", ("cup", "on", "table"), start=2.0, source=Source(Origin.SEEN, "tracker"))
>>> print(statement_triple(cup.statement))
<https://w3id.org/deixis/episodes/thing/cup> <https://w3id.org/deixis/onto#on> <https://w3id.org/deixis/episodes/thing/table>
>>> len(fluent_triples(cup))
11
"""

from __future__ import annotations

import math
import re
from functools import lru_cache
from urllib.parse import quote

import pyoxigraph as ox

from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin
from deixis.memory.episodes.predicates import ACTS, AT, IS_A, SAID
from deixis.ontology.rdf.triples import category_iri
from deixis.reasoning.temporal.fluent import Statement

EP = "https://w3id.org/deixis/episodes#"
"""Namespace of the terms for fluents; ``ontology/episodes.ttl`` defines them."""

RESOURCES = "https://w3id.org/deixis/episodes/"
"""Namespace of fluents, things, agents and events."""

SOSA = "http://www.w3.org/ns/sosa/"
_PROV = "http://www.w3.org/ns/prov#"

TYPE = ox.NamedNode("http://www.w3.org/1999/02/22-rdf-syntax-ns#type")
_FLUENT, _OBSERVATION = ox.NamedNode(EP + "Fluent"), ox.NamedNode(SOSA + "Observation")
_IDENTIFIER, _CERTAINTY, _ORIGIN = (ox.NamedNode(EP + name) for name in ("identifier", "certainty", "origin"))
_SUBJECT, _PREDICATE = ox.NamedNode(SOSA + "hasFeatureOfInterest"), ox.NamedNode(SOSA + "observedProperty")
_THING, _TEXT = ox.NamedNode(SOSA + "hasResult"), ox.NamedNode(SOSA + "hasSimpleResult")
_BY, _FROM = ox.NamedNode(_PROV + "wasAttributedTo"), ox.NamedNode(_PROV + "wasDerivedFrom")
_ACT, _ACTIVITY = ox.NamedNode(EP + "Act"), ox.NamedNode(_PROV + "Activity")
_ACTOR = ox.NamedNode(_PROV + "wasAssociatedWith")
_ENDS = tuple(ox.NamedNode(EP + name) for name in ("earliestStart", "latestStart", "earliestFinish", "latestFinish"))
_DOUBLE = ox.NamedNode("http://www.w3.org/2001/XMLSchema#double")
_ORIGINS = {origin: ox.Literal(origin.value) for origin in Origin}
_TRUE = ox.Literal(True)
_NAME = re.compile(r"[\w.:-]+")

TEXTS = {AT, SAID}
"""Predicates whose objects are texts, not things."""


def fluent_iri(id: str) -> ox.NamedNode:
    """Return the IRI of a fluent.

    Parameters
    ----------
    id
        Its id.

    Returns
    -------
    NamedNode
        The IRI.
    """
    return resource_iri("fluent", id)


@lru_cache(maxsize=10_000)
def thing_iri(name: str) -> ox.NamedNode:
    """Return the IRI of a thing.

    Parameters
    ----------
    name
        Its name on the blackboard, such as ``t1``.

    Returns
    -------
    NamedNode
        The IRI.
    """
    return resource_iri("thing", name)


@lru_cache(maxsize=10_000)
def predicate_iri(name: str) -> ox.NamedNode:
    """Return the IRI of a predicate: of a relation of the ontology if it has one of this name.

    Parameters
    ----------
    name
        The predicate; ``isA`` stands for ``rdf:type``.

    Returns
    -------
    NamedNode
        The IRI.
    """
    if name == IS_A:
        return TYPE
    return ox.NamedNode(_relations().get(name) or EP + quote(name, safe=""))


@lru_cache(maxsize=1)
def _relations() -> dict[str, str]:
    """Return the IRIs of the relations of the ontology by their names and the last parts of their IRIs."""
    from deixis.ontology.tbox import default_ontology

    relations = default_ontology().relations
    return {name: each.iri for each in relations.values() for name in (each.name, each.iri.rpartition("#")[2])}


@lru_cache(maxsize=10_000)
def _object(predicate: str, name: str) -> ox.NamedNode | ox.Literal:
    if predicate == IS_A:
        return ox.NamedNode(category_iri(name))
    if predicate in TEXTS or not _NAME.fullmatch(name):
        return ox.Literal(name)
    return thing_iri(name)


def statement_triple(statement: Statement) -> ox.Triple:
    """Return a statement as a plain triple; one without an object has the value true.

    Parameters
    ----------
    statement
        Subject, predicate and object.

    Returns
    -------
    Triple
        The triple.
    """
    thing = _TRUE if statement.object is None else _object(statement.predicate, statement.object)
    return ox.Triple(thing_iri(statement.subject), predicate_iri(statement.predicate), thing)


Values = dict[ox.NamedNode, list[ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple]]
"""Objects of the triples about one node, by predicate."""


def fluent_values(fluent: EpisodicFluent) -> Values:
    """Return the description of a fluent by predicate.

    Parameters
    ----------
    fluent
        The fluent.

    Returns
    -------
    dict
        Objects by predicate; an unknown bound of a time has none.
    """
    statement, source = fluent.statement, fluent.source
    found: Values = {
        TYPE: [_FLUENT, _OBSERVATION],
        _IDENTIFIER: [ox.Literal(fluent.id)],
        _SUBJECT: [thing_iri(statement.subject)],
        _PREDICATE: [predicate_iri(statement.predicate)],
        _CERTAINTY: [_double(fluent.certainty)],
        _ORIGIN: [_ORIGINS[source.origin]],
        _BY: [resource_iri("agent", source.by)],
    }
    if statement.object is not None:
        value = _object(statement.predicate, statement.object)
        found[_TEXT if isinstance(value, ox.Literal) else _THING] = [value]
    start, finish = fluent.start, fluent.finish
    for predicate, time in zip(_ENDS, (start.lower, start.upper, finish.lower, finish.upper), strict=True):
        if math.isfinite(time):
            found[predicate] = [_double(time)]
    if statement.predicate in ACTS:
        found[TYPE] = [_FLUENT, _OBSERVATION, _ACT, _ACTIVITY]
        found[_ACTOR] = [resource_iri("agent", statement.subject)]
    if source.event is not None:
        found[_FROM] = [resource_iri("event", source.event)]
    return found


def fluent_triples(fluent: EpisodicFluent) -> list[ox.Triple]:
    """Return the description of a fluent.

    Parameters
    ----------
    fluent
        The fluent.

    Returns
    -------
    list of Triple
        Its triples; an unknown bound of a time has none.
    """
    node = fluent_iri(fluent.id)
    return [
        ox.Triple(node, predicate, value) for predicate, values in fluent_values(fluent).items() for value in values
    ]


def _double(number: float) -> ox.Literal:
    return ox.Literal(repr(float(number)), datatype=_DOUBLE)


@lru_cache(maxsize=10_000)
def resource_iri(kind: str, name: str) -> ox.NamedNode:
    """Return the IRI of something that fluents refer to.

    Parameters
    ----------
    kind
        ``fluent``, ``thing``, ``agent`` or ``event``.
    name
        Its name on the blackboard.

    Returns
    -------
    NamedNode
        The IRI.
    """
    return ox.NamedNode(f"{RESOURCES}{kind}/{quote(name, safe='')}")
