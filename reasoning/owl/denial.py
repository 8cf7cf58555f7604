"""The denial of a statement: triples that contradict an ontology just where the statement follows from it.

>>> from deixis.reasoning.owl.ntriples import Triple
>>> from deixis.reasoning.owl.terms import NOTHING, SUB_CLASS_OF
>>> [str(triple) for triple in denial(Triple("<urn:Spork>", SUB_CLASS_OF, NOTHING))]
['<urn:deixis:someone> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <urn:Spork> .']
"""

from __future__ import annotations

from collections.abc import Callable

from deixis.reasoning.errors import SettingError
from deixis.reasoning.owl.ntriples import Triple, is_blank, is_literal
from deixis.reasoning.owl.terms import (
    ASSERTION_PROPERTY,
    CLASS,
    COMPLEMENT_OF,
    DIFFERENT_FROM,
    DISJOINT_WITH,
    DOMAIN,
    NEGATIVE_PROPERTY_ASSERTION,
    NOTHING,
    PREFIXES,
    RANGE,
    SAME_AS,
    SOURCE_INDIVIDUAL,
    SUB_CLASS_OF,
    SUB_PROPERTY_OF,
    TARGET_INDIVIDUAL,
    TARGET_VALUE,
    TYPE,
)

_SOMEONE, _OTHER, _NODE = "<urn:deixis:someone>", "<urn:deixis:other>", "_:denial"
_OURS = tuple(f"<{PREFIXES[name]}" for name in ("rdf", "rdfs", "owl"))


def denial(triple: Triple) -> tuple[Triple, ...]:
    """The triples that deny a statement about named things; raises SettingError for one that cannot be denied so."""
    subject, predicate, object = triple
    if any(is_blank(part) for part in triple):
        raise SettingError(f"a statement to explain is about named things: {triple}")
    some_pair = Triple(_SOMEONE, subject, _OTHER)
    cases: dict[str, Callable[[], tuple[Triple, ...]]] = {
        SUB_CLASS_OF: lambda: (Triple(_SOMEONE, TYPE, subject), *_not_a(_SOMEONE, object)),
        DISJOINT_WITH: lambda: (Triple(_SOMEONE, TYPE, subject), Triple(_SOMEONE, TYPE, object)),
        TYPE: lambda: _not_a(subject, object),
        SUB_PROPERTY_OF: lambda: (some_pair, *_not_related(_SOMEONE, object, _OTHER)),
        DOMAIN: lambda: (some_pair, *_not_a(_SOMEONE, object)),
        RANGE: lambda: (some_pair, *_not_a(_OTHER, object)),
        SAME_AS: lambda: (Triple(subject, DIFFERENT_FROM, object),),
        DIFFERENT_FROM: lambda: (Triple(subject, SAME_AS, object),),
    }
    if predicate in cases and not (predicate == TYPE and object.startswith(_OURS) and object != NOTHING):
        return cases[predicate]()
    if predicate.startswith(_OURS):
        raise SettingError(f"a statement of this kind cannot be explained: {triple}")
    return _not_related(subject, predicate, object)


def _not_a(thing: str, kind: str) -> tuple[Triple, ...]:
    if kind == NOTHING:
        return ()
    return Triple(thing, TYPE, _NODE), Triple(_NODE, TYPE, CLASS), Triple(_NODE, COMPLEMENT_OF, kind)


def _not_related(subject: str, predicate: str, object: str) -> tuple[Triple, ...]:
    target = TARGET_VALUE if is_literal(object) else TARGET_INDIVIDUAL
    return (
        Triple(_NODE, TYPE, NEGATIVE_PROPERTY_ASSERTION),
        Triple(_NODE, SOURCE_INDIVIDUAL, subject),
        Triple(_NODE, ASSERTION_PROPERTY, predicate),
        Triple(_NODE, target, object),
    )
