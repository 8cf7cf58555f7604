"""Small helpers to write and read triples: terms from strings and numbers, and a look-up over a set of triples."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from datetime import datetime
from decimal import Decimal

import pyoxigraph as ox

from deixis.ontology.errors import OntologyError

XSD = "http://www.w3.org/2001/XMLSchema#"


def iri(value: str) -> ox.NamedNode:
    """A named node; ``value`` may be a member of the closed vocabulary."""
    return ox.NamedNode(str(value))


def text(value: str) -> ox.Literal:
    return ox.Literal(value)


def typed(value: bool | int | float | datetime) -> ox.Literal:
    """A boolean, integer or dateTime as such (HermiT reads no finer than milliseconds); a float as xsd:double."""
    if isinstance(value, bool):
        return ox.Literal(str(value).lower(), datatype=iri(XSD + "boolean"))
    if isinstance(value, datetime):
        return ox.Literal(value.isoformat(timespec="milliseconds"), datatype=iri(XSD + "dateTime"))
    name = "integer" if isinstance(value, int) else "double"
    return ox.Literal(repr(value), datatype=iri(XSD + name))


def decimal(value: float) -> ox.Literal:
    """A number as xsd:decimal, which has no exponent."""
    return ox.Literal(format(Decimal(repr(float(value))), "f"), datatype=iri(XSD + "decimal"))


class Description:
    """Triples about one subject, in the order in which they are said.

    >>> about = Description("urn:fork")
    >>> about.say("urn:p", text("x"), text("y"))
    >>> len(list(about))
    2
    """

    def __init__(self, subject: str) -> None:
        self.subject = iri(subject)
        self._triples: list[ox.Triple] = []

    def say(self, predicate: str, *objects: ox.NamedNode | ox.Literal) -> None:
        self._triples += [ox.Triple(self.subject, iri(predicate), value) for value in objects]

    def __iter__(self) -> Iterator[ox.Triple]:
        return iter(self._triples)


class TripleIndex:
    """What is said of each subject under each predicate, as strings."""

    def __init__(self, triples: Iterable[ox.Triple]) -> None:
        self._values: dict[tuple[str, str], list[str]] = defaultdict(list)
        self._subjects: dict[tuple[str, str], list[str]] = defaultdict(list)
        for triple in triples:
            subject, value = _plain(triple.subject), _plain(triple.object)
            self._values[subject, triple.predicate.value].append(value)
            self._subjects[triple.predicate.value, value].append(subject)

    def values(self, subject: str, predicate: str) -> list[str]:
        return sorted(self._values.get((subject, str(predicate)), ()))

    def value(self, subject: str, predicate: str) -> str | None:
        """The first value, or None."""
        return next(iter(self.values(subject, predicate)), None)

    def only(self, subject: str, predicate: str) -> str:
        """The one value; raises OntologyError where there is none, or several."""
        found = self.values(subject, predicate)
        if len(found) != 1:
            raise OntologyError(f"<{subject}> must have exactly one <{predicate}>, and has {len(found)}")
        return found[0]

    def subjects(self, predicate: str, value: str) -> list[str]:
        return sorted(self._subjects.get((str(predicate), str(value)), ()))


def _plain(term: object) -> str:
    return str(getattr(term, "value", term))
