"""Write a layout as SHACL shapes, and a scene as the data that the shapes validate.

A scene conforms to a layout if every role is filled, every object in it fills a role, and every fact holds of the
objects in its roles. A fact about an unfilled role is skipped, since the role itself is reported. The focus node of a
violated fact is its statement, which has its line in the script. Whether a claim holds is in the data (``dx:holds``),
since SHACL cannot measure it. A hedged fact gives a warning, an optional one an
info. The object in a role with a stated colour may have no other colour.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType

import pyoxigraph as ox

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact, dispensable
from deixis.ontology.lessons.types import LayoutConcept
from deixis.ontology.lessons.write import claim_iri, fact_iri, layout_iri, role_iri
from deixis.ontology.rdf.triples import Description, content_key, iri, learned_iri, skolem, text, typed
from deixis.ontology.rdf.vocabulary import DX, W3C
from deixis.ontology.relations.relation import Relation

SH = "http://www.w3.org/ns/shacl#"
_RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"


def layout_shapes(
    layout: LayoutConcept, optional: Collection[str] | None = None, notes: Mapping[str, str] = MappingProxyType({})
) -> Iterator[ox.Triple]:
    """Yield the shapes graph of a layout, with Skolem IRIs for blank nodes.

    Parameters
    ----------
    layout
        The layout.
    optional
        Roles that need not be filled; None for those that no certain fact needs.
    notes
        Descriptions of shapes by their names, such as ``fact-1`` or ``role-fork``.

    Yields
    ------
    ox.Triple
        A triple.
    """
    writer = _Shapes(layout, notes)
    yield from writer.extra()
    spare = dispensable(layout.facts) if optional is None else optional
    for role in layout.roles:
        yield from writer.missing(role.name, "Info" if role.name in spare else "Violation")
        if role.colour is not None:
            yield from writer.miscoloured(role.name, role.colour)
    for position, fact in enumerate(layout.facts, 1):
        yield from writer.fact(position, fact)
        for role in layout.roles:
            if role.is_group and fact.positive and role.name in (fact.subject, fact.object):
                yield from writer.members(position, fact, role.name)
    for position, claim in enumerate(layout.claims, 1):
        yield from writer.claim(position, claim)


class _Shapes:
    def __init__(self, layout: LayoutConcept, notes: Mapping[str, str]) -> None:
        self._lesson, self._notes = layout.lesson, notes
        self._count = 0

    def extra(self) -> Iterator[ox.Triple]:
        shape = self._shape("extra", "Violation", "has no role in the layout: remove it")
        shape.say(SH + "targetSubjectsOf", iri(DX.IN_SCENE))
        shape.say(SH + "path", iri(DX.FILLS))
        shape.say(SH + "minCount", typed(1))
        yield from shape

    def missing(self, role: str, severity: str) -> Iterator[ox.Triple]:
        shape = self._shape(f"role-{role}", severity, f"{role} is missing: add it")
        shape.say(SH + "targetNode", iri(role_iri(self._lesson, role)))
        yield from self._path(shape, [self._inverse(DX.FILLS)])
        shape.say(SH + "minCount", typed(1))
        yield from shape

    def miscoloured(self, role: str, colour: str) -> Iterator[ox.Triple]:
        shape = self._shape(f"colour-{role}", "Violation", f"{role} does not have the colour described")
        shape.say(SH + "targetNode", iri(role_iri(self._lesson, role)))
        yield from self._path(shape, [self._inverse(DX.FILLS), ([], iri(DX.OF_COLOUR))])
        triples, head = self._list([iri(colour)])
        yield from triples
        shape.say(SH + "in", head)
        yield from shape

    def claim(self, position: int, claim: Claim) -> Iterator[ox.Triple]:
        shape = self._statement_shape(f"claim-{position}", claim)
        shape.say(SH + "targetNode", iri(claim_iri(self._lesson, position)))
        shape.say(SH + "path", iri(DX.HOLDS))
        triples, head = self._list([typed(True)])
        yield from triples
        shape.say(SH + "in", head)
        yield from shape

    def _statement_shape(self, name: str, statement: Fact | Claim) -> Description:
        severity = "Info" if statement.optional else "Violation" if statement.weight >= 1 else "Warning"
        line = f"line {statement.source.line}: " if statement.source else ""
        return self._shape(name, severity, f"{line}{statement} does not hold")

    def members(self, position: int, fact: Fact, group: str) -> Iterator[ox.Triple]:
        """Yield the shape that all members of a group satisfy a fact."""
        other, number = (fact.object, 1) if group == fact.subject else (fact.subject, 2)
        shape = self._statement_shape(f"fact-{position}-members-{number}", fact)
        shape.say(SH + "targetNode", iri(role_iri(self._lesson, group)))
        yield from self._path(shape, [self._inverse(DX.FILLS)])
        cases: list[ox.NamedNode] = []
        for relation in fact.relations:
            holds = self._blank()
            way = ([], iri(relation.iri)) if number == 1 else self._inverse(relation.iri)
            yield from self._path(holds, [way, ([], iri(DX.FILLS))])
            holds.say(SH + "hasValue", iri(role_iri(self._lesson, other)))
            yield from holds
            cases.append(holds.subject)
        triples, head = self._list(cases)
        yield from triples
        shape.say(SH + "or", head)
        yield from shape

    def fact(self, position: int, fact: Fact) -> Iterator[ox.Triple]:
        shape = self._statement_shape(f"fact-{position}", fact)
        shape.say(W3C.RDF_TYPE, iri(SH + "NodeShape"))
        shape.say(SH + "targetNode", iri(fact_iri(self._lesson, position)))
        cases: list[ox.NamedNode] = []
        for end in (DX.SUBJECT, DX.OBJECT):
            unfilled = self._blank()
            yield from self._path(unfilled, [([], iri(end)), self._inverse(DX.FILLS)])
            unfilled.say(SH + "maxCount", typed(0))
            yield from unfilled
            cases.append(unfilled.subject)
        holds = self._blank()
        if len(fact.relations) == 1:
            related: tuple[list[ox.Triple], ox.NamedNode] = [], iri(fact.relations[0].iri)
        else:
            listed, head = self._list([iri(relation.iri) for relation in fact.relations])
            alternative = self._blank()
            alternative.say(SH + "alternativePath", head)
            related = [*listed, *alternative], alternative.subject
        yield from self._path(holds, [([], iri(DX.SUBJECT)), self._inverse(DX.FILLS), related, ([], iri(DX.FILLS))])
        holds.say(SH + "hasValue", iri(role_iri(self._lesson, fact.object)))
        yield from holds
        if fact.positive:
            cases.append(holds.subject)
        else:
            denied = self._blank()
            denied.say(SH + "not", holds.subject)
            yield from denied
            cases.append(denied.subject)
        triples, head = self._list(cases)
        yield from triples
        shape.say(SH + "or", head)
        yield from shape

    def _shape(self, name: str, severity: str, message: str) -> Description:
        shape = Description(learned_iri("layout", self._lesson, "shape", name))
        shape.say(SH + "severity", iri(SH + severity))
        shape.say(SH + "message", text(message))
        shape.say(SH + "name", text(name))
        if name in self._notes:
            shape.say(SH + "description", text(self._notes[name]))
        return shape

    def _blank(self) -> Description:
        self._count += 1
        return Description(skolem(f"{content_key(self._lesson)}.s{self._count}").value)

    def _inverse(self, prop: str) -> tuple[list[ox.Triple], ox.NamedNode]:
        node = self._blank()
        node.say(SH + "inversePath", iri(prop))
        return list(node), node.subject

    def _path(self, shape: Description, steps: list[tuple[list[ox.Triple], ox.NamedNode]]) -> Iterator[ox.Triple]:
        for triples, _ in steps:
            yield from triples
        if len(steps) == 1:
            shape.say(SH + "path", steps[0][1])
            return
        triples, head = self._list([node for _, node in steps])
        yield from triples
        shape.say(SH + "path", head)

    def _list(self, items: Sequence[ox.NamedNode | ox.Literal]) -> tuple[list[ox.Triple], ox.NamedNode]:
        """Return the triples of an RDF list, and its head."""
        triples: list[ox.Triple] = []
        rest = iri(_RDF + "nil")
        for item in reversed(items):
            node = self._blank()
            node.say(_RDF + "first", item)
            node.say(_RDF + "rest", rest)
            triples += node
            rest = node.subject
        return triples, rest


def scene_data(
    layout: LayoutConcept,
    things: Iterable[str],
    fills: Mapping[str, str],
    related: Iterable[tuple[str, Relation, str]],
    coloured: Mapping[str, str],
    held: Mapping[int, bool] = MappingProxyType({}),
) -> Iterator[ox.Triple]:
    """Yield the data graph of a check: the objects of a scene, their roles, and the relations that hold between them.

    The statements of the layout are in it too, as the focus nodes of its shapes.

    Parameters
    ----------
    layout
        The layout to check against.
    things
        Names of the objects in the scene.
    fills
        Role of each object that fills one.
    related
        All relations that hold, in the readings in which the layout states them: subject, relation, object.
    coloured
        IRI of the colour of each object whose colour is not the described one.
    held
        Whether each claim holds, by its position from 1; those that cannot be decided are left out.

    Yields
    ------
    ox.Triple
        A triple.
    """
    scene = learned_iri("checked", layout.lesson)
    yield from _triples(scene, (W3C.RDF_TYPE, iri(DX.SCENE)), (W3C.RDF_TYPE, iri(layout_iri(layout.lesson))))
    for thing in things:
        node = learned_iri("checked", layout.lesson, thing)
        yield from _triples(node, (W3C.RDF_TYPE, iri(DX.PERCEIVED_OBJECT)), (DX.IN_SCENE, iri(scene)))
        yield from _triples(node, (DX.IDENTIFIER, text(thing)))
        if thing in fills:
            yield from _triples(node, (DX.FILLS, iri(role_iri(layout.lesson, fills[thing]))))
        if thing in coloured:
            yield from _triples(node, (DX.OF_COLOUR, iri(coloured[thing])))
    for subject, relation, other in related:
        ends = [iri(learned_iri("checked", layout.lesson, thing)) for thing in (subject, other)]
        yield ox.Triple(ends[0], iri(relation.iri), ends[1])
    for position, fact in enumerate(layout.facts, 1):
        node = fact_iri(layout.lesson, position)
        ends = [iri(role_iri(layout.lesson, role)) for role in (fact.subject, fact.object)]
        yield from _triples(node, (DX.SUBJECT, ends[0]), (DX.OBJECT, ends[1]))
    for position, claim in enumerate(layout.claims, 1):
        node = claim_iri(layout.lesson, position)
        yield from _triples(node, (W3C.RDF_TYPE, iri(DX.CLAIM)), (DX.TERM, text(claim.relation)))
        if position in held:
            yield from _triples(node, (DX.HOLDS, typed(held[position])))


def _triples(subject: str, *statements: tuple[str, ox.NamedNode | ox.Literal]) -> Iterator[ox.Triple]:
    about = Description(subject)
    for predicate, value in statements:
        about.say(predicate, value)
    return iter(about)
