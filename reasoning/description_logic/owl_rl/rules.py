"""The rules of OWL 2 RL under their W3C names: a table of rules, and expansions of the rules over lists.

Source: OWL 2 Web Ontology Language Profiles (second edition), section 4.3, tables 4 to 9. A rule is written ``name:
schema | facts => conclusion``. The ``schema`` is matched once for each axiom, and leaves a rule about the properties
and classes of the axiom; ``false`` is a contradiction.

Rules over lists are expanded for each list: ``cls-int1``, ``cls-int2``, ``cls-uni``, ``cls-oo``, ``scm-int``,
``scm-uni``, ``prp-spo2``, ``prp-key``, ``prp-adp``, ``cax-adc``, ``eq-diff2``, ``eq-diff3``.

The datatype rules (table 8) are in :mod:`deixis.reasoning.description_logic.owl_rl.chaining`, since they depend on
values. Rules that only state tautologies are left out (``eq-ref``, ``prp-ap``, ``cls-thing``, ``cls-nothing1``,
``scm-cls``, ``scm-op``, ``scm-dp``). If another rule needs such a tautology as a premise, a second line with the same
name gives the conclusion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

from deixis.reasoning.description_logic.owl_rl.facts import Fact, FactIndex
from deixis.reasoning.description_logic.terms import DISTINCT_MEMBERS, MEMBERS, SAME_AS, SUB_CLASS_OF, TYPE, term

RULES = """
eq-sym: | ?x owl:sameAs ?y => ?y owl:sameAs ?x
eq-trans: | ?x owl:sameAs ?y , ?y owl:sameAs ?z => ?x owl:sameAs ?z
eq-rep-s: ?s owl:sameAs ?t | ?s ?p ?o => ?t ?p ?o
eq-rep-p: ?p owl:sameAs ?q | ?s ?p ?o => ?s ?q ?o
eq-rep-o: ?o owl:sameAs ?t | ?s ?p ?o => ?s ?p ?t
eq-diff1: | ?x owl:sameAs ?y , ?x owl:differentFrom ?y => false
eq-diff1: | ?x owl:differentFrom ?x => false

prp-dom: ?p rdfs:domain ?c | ?x ?p ?y => ?x rdf:type ?c
prp-rng: ?p rdfs:range ?c | ?x ?p ?y => ?y rdf:type ?c
prp-fp: ?p rdf:type owl:FunctionalProperty | ?x ?p ?y , ?x ?p ?z => ?y owl:sameAs ?z
prp-ifp: ?p rdf:type owl:InverseFunctionalProperty | ?x ?p ?z , ?y ?p ?z => ?x owl:sameAs ?y
prp-irp: ?p rdf:type owl:IrreflexiveProperty | ?x ?p ?x => false
prp-symp: ?p rdf:type owl:SymmetricProperty | ?x ?p ?y => ?y ?p ?x
prp-asyp: ?p rdf:type owl:AsymmetricProperty | ?x ?p ?y , ?y ?p ?x => false
prp-trp: ?p rdf:type owl:TransitiveProperty | ?x ?p ?y , ?y ?p ?z => ?x ?p ?z
prp-spo1: ?p rdfs:subPropertyOf ?q | ?x ?p ?y => ?x ?q ?y
prp-eqp1: ?p owl:equivalentProperty ?q | ?x ?p ?y => ?x ?q ?y
prp-eqp2: ?p owl:equivalentProperty ?q | ?x ?q ?y => ?x ?p ?y
prp-pdw: ?p owl:propertyDisjointWith ?q | ?x ?p ?y , ?x ?q ?y => false
prp-inv1: ?p owl:inverseOf ?q | ?x ?p ?y => ?y ?q ?x
prp-inv2: ?p owl:inverseOf ?q | ?x ?q ?y => ?y ?p ?x
prp-npa1: ?n owl:sourceIndividual ?x , ?n owl:assertionProperty ?p , ?n owl:targetIndividual ?y | ?x ?p ?y => false
prp-npa2: ?n owl:sourceIndividual ?x , ?n owl:assertionProperty ?p , ?n owl:targetValue ?y | ?x ?p ?y => false

cls-nothing2: | ?x rdf:type owl:Nothing => false
cls-com: ?c owl:complementOf ?d | ?x rdf:type ?c , ?x rdf:type ?d => false
cls-svf1: ?c owl:someValuesFrom ?d , ?c owl:onProperty ?p | ?x ?p ?y , ?y rdf:type ?d => ?x rdf:type ?c
cls-svf2: ?c owl:someValuesFrom owl:Thing , ?c owl:onProperty ?p | ?x ?p ?y => ?x rdf:type ?c
cls-avf: ?c owl:allValuesFrom ?d , ?c owl:onProperty ?p | ?x rdf:type ?c , ?x ?p ?y => ?y rdf:type ?d
cls-hv1: ?c owl:hasValue ?y , ?c owl:onProperty ?p | ?x rdf:type ?c => ?x ?p ?y
cls-hv2: ?c owl:hasValue ?y , ?c owl:onProperty ?p | ?x ?p ?y => ?x rdf:type ?c
cls-maxc1: ?c owl:maxCardinality 0 , ?c owl:onProperty ?p | ?x rdf:type ?c , ?x ?p ?y => false
cls-maxc2: ?c owl:maxCardinality 1 , ?c owl:onProperty ?p | ?x rdf:type ?c , ?x ?p ?y , ?x ?p ?z => ?y owl:sameAs ?z
cls-maxqc1: ?c owl:maxQualifiedCardinality 0 , ?c owl:onProperty ?p , ?c owl:onClass ?d \
| ?x rdf:type ?c , ?x ?p ?y , ?y rdf:type ?d => false
cls-maxqc2: ?c owl:maxQualifiedCardinality 0 , ?c owl:onProperty ?p , ?c owl:onClass owl:Thing \
| ?x rdf:type ?c , ?x ?p ?y => false
cls-maxqc3: ?c owl:maxQualifiedCardinality 1 , ?c owl:onProperty ?p , ?c owl:onClass ?d \
| ?x rdf:type ?c , ?x ?p ?y , ?y rdf:type ?d , ?x ?p ?z , ?z rdf:type ?d => ?y owl:sameAs ?z
cls-maxqc4: ?c owl:maxQualifiedCardinality 1 , ?c owl:onProperty ?p , ?c owl:onClass owl:Thing \
| ?x rdf:type ?c , ?x ?p ?y , ?x ?p ?z => ?y owl:sameAs ?z

cax-sco: ?c rdfs:subClassOf ?d | ?x rdf:type ?c => ?x rdf:type ?d
cax-eqc1: ?c owl:equivalentClass ?d | ?x rdf:type ?c => ?x rdf:type ?d
cax-eqc2: ?c owl:equivalentClass ?d | ?x rdf:type ?d => ?x rdf:type ?c
cax-dw: ?c owl:disjointWith ?d | ?x rdf:type ?c , ?x rdf:type ?d => false

scm-sco: | ?c rdfs:subClassOf ?d , ?d rdfs:subClassOf ?e => ?c rdfs:subClassOf ?e
scm-eqc1: | ?c owl:equivalentClass ?d => ?c rdfs:subClassOf ?d
scm-eqc1: | ?c owl:equivalentClass ?d => ?d rdfs:subClassOf ?c
scm-eqc2: | ?c rdfs:subClassOf ?d , ?d rdfs:subClassOf ?c => ?c owl:equivalentClass ?d
scm-spo: | ?p rdfs:subPropertyOf ?q , ?q rdfs:subPropertyOf ?r => ?p rdfs:subPropertyOf ?r
scm-eqp1: | ?p owl:equivalentProperty ?q => ?p rdfs:subPropertyOf ?q
scm-eqp1: | ?p owl:equivalentProperty ?q => ?q rdfs:subPropertyOf ?p
scm-eqp2: | ?p rdfs:subPropertyOf ?q , ?q rdfs:subPropertyOf ?p => ?p owl:equivalentProperty ?q
scm-dom1: | ?p rdfs:domain ?c , ?c rdfs:subClassOf ?d => ?p rdfs:domain ?d
scm-dom2: | ?q rdfs:domain ?c , ?p rdfs:subPropertyOf ?q => ?p rdfs:domain ?c
scm-rng1: | ?p rdfs:range ?c , ?c rdfs:subClassOf ?d => ?p rdfs:range ?d
scm-rng2: | ?q rdfs:range ?c , ?p rdfs:subPropertyOf ?q => ?p rdfs:range ?c
scm-hv: ?c owl:hasValue ?i , ?c owl:onProperty ?p , ?d owl:hasValue ?i , ?d owl:onProperty ?q \
| ?p rdfs:subPropertyOf ?q => ?c rdfs:subClassOf ?d
scm-hv: ?c owl:hasValue ?i , ?c owl:onProperty ?p , ?d owl:hasValue ?i , ?d owl:onProperty ?p \
| => ?c rdfs:subClassOf ?d
scm-svf1: ?c owl:someValuesFrom ?y , ?c owl:onProperty ?p , ?d owl:someValuesFrom ?z , ?d owl:onProperty ?p \
| ?y rdfs:subClassOf ?z => ?c rdfs:subClassOf ?d
scm-svf1: ?c owl:someValuesFrom ?y , ?c owl:onProperty ?p , ?d owl:someValuesFrom ?y , ?d owl:onProperty ?p \
| => ?c rdfs:subClassOf ?d
scm-svf2: ?c owl:someValuesFrom ?y , ?c owl:onProperty ?p , ?d owl:someValuesFrom ?y , ?d owl:onProperty ?q \
| ?p rdfs:subPropertyOf ?q => ?c rdfs:subClassOf ?d
scm-avf1: ?c owl:allValuesFrom ?y , ?c owl:onProperty ?p , ?d owl:allValuesFrom ?z , ?d owl:onProperty ?p \
| ?y rdfs:subClassOf ?z => ?c rdfs:subClassOf ?d
scm-avf1: ?c owl:allValuesFrom ?y , ?c owl:onProperty ?p , ?d owl:allValuesFrom ?y , ?d owl:onProperty ?p \
| => ?c rdfs:subClassOf ?d
scm-avf2: ?c owl:allValuesFrom ?y , ?c owl:onProperty ?p , ?d owl:allValuesFrom ?y , ?d owl:onProperty ?q \
| ?p rdfs:subPropertyOf ?q => ?d rdfs:subClassOf ?c
"""

TermAtom = tuple[str, str, str]
"""A pattern of three terms, each in N-Triples spelling or a variable such as ``?x``."""


class TextRule(NamedTuple):
    """A rule of the table; its head is None for a contradiction."""

    name: str
    schema: tuple[TermAtom, ...]
    body: tuple[TermAtom, ...]
    head: TermAtom | None


def rules() -> Iterator[TextRule]:
    """Yield the rules of the table, in its order.

    Yields
    ------
    TextRule
        Rule with its name, schema patterns, premises, and conclusion (None for a contradiction).

    Examples
    --------
    >>> next(rules()).name
    'eq-sym'
    """
    for line in RULES.strip().splitlines():
        if line:
            name, text = line.split(":", 1)
            premises, head = text.split("=>")
            schema, body = premises.split("|")
            yield TextRule(name, _atoms(schema), _atoms(body), None if head.strip() == "false" else _atoms(head)[0])


def _atoms(text: str) -> tuple[TermAtom, ...]:
    return tuple(_atom(part) for part in text.split(",") if part.strip())


def _atom(text: str) -> TermAtom:
    subject, predicate, obj = (_term(word) for word in text.split())
    return subject, predicate, obj


def _term(word: str) -> str:
    if word.startswith("?"):
        return word
    return f'"{word}"^^{term("xsd:nonNegativeInteger")}' if word.isdigit() else term(word)


Expansion = Callable[[str, Sequence[str]], Iterator[TextRule]]
"""Function from the node that has a list, and the members of the list, to rules without lists."""


def _rule(name: str, body: Sequence[TermAtom], head: TermAtom | None) -> TextRule:
    return TextRule(name, (), tuple(body), head)


def _intersection(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    yield _rule("cls-int1", [("?x", TYPE, member) for member in members], ("?x", TYPE, node))
    for member in members:
        yield _rule("cls-int2", [("?x", TYPE, node)], ("?x", TYPE, member))
        yield _rule("scm-int", [], (node, SUB_CLASS_OF, member))


def _union(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for member in members:
        yield _rule("cls-uni", [("?x", TYPE, member)], ("?x", TYPE, node))
        yield _rule("scm-uni", [], (member, SUB_CLASS_OF, node))


def _one_of(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for member in members:
        yield _rule("cls-oo", [], (member, TYPE, node))


def _chain(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    steps = [(f"?{i}", member, f"?{i + 1}") for i, member in enumerate(members)]
    yield _rule("prp-spo2", steps, ("?0", node, f"?{len(members)}"))


def _key(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    alike = [(who, member, f"?{i}") for i, member in enumerate(members) for who in ("?x", "?y")]
    yield _rule("prp-key", [("?x", TYPE, node), ("?y", TYPE, node), *alike], ("?x", SAME_AS, "?y"))


def _disjoint_classes(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for one, other in combinations(members, 2):
        yield _rule("cax-adc", [("?x", TYPE, one), ("?x", TYPE, other)], None)


def _disjoint_properties(node: str, members: Sequence[str]) -> Iterator[TextRule]:
    for one, other in combinations(members, 2):
        yield _rule("prp-adp", [("?x", one, "?y"), ("?x", other, "?y")], None)


def _different(name: str) -> Expansion:
    def expand(node: str, members: Sequence[str]) -> Iterator[TextRule]:
        for one, other in combinations(members, 2):
            yield _rule(name, [] if one == other else [(one, SAME_AS, other)], None)

    return expand


EXPANSIONS: dict[tuple[str, str | None], Expansion] = {
    (term("owl:intersectionOf"), None): _intersection,
    (term("owl:unionOf"), None): _union,
    (term("owl:oneOf"), None): _one_of,
    (term("owl:propertyChainAxiom"), None): _chain,
    (term("owl:hasKey"), None): _key,
    (MEMBERS, term("owl:AllDisjointClasses")): _disjoint_classes,
    (MEMBERS, term("owl:AllDisjointProperties")): _disjoint_properties,
    (MEMBERS, term("owl:AllDifferent")): _different("eq-diff2"),
    (DISTINCT_MEMBERS, term("owl:AllDifferent")): _different("eq-diff3"),
}
"""Expansions by the predicate that refers to the list and, if needed, the type of the node that has it."""


def list_members(
    index: FactIndex, head: int, first: int, rest: int, nil: int
) -> tuple[list[int], tuple[Fact, ...]] | None:
    """Return the members of a list and the facts that define it, or None for an incomplete or cyclic list.

    Parameters
    ----------
    index
        Facts.
    head
        Number of the list.
    first, rest, nil
        Numbers of ``rdf:first``, ``rdf:rest`` and ``rdf:nil``.

    Returns
    -------
    tuple or None
        Numbers of the members in order, and the facts.
    """
    members, links, seen = [], [], set()
    while head != nil:
        member = min(index.objects(head, first), default=None)
        tail = min(index.objects(head, rest), default=None)
        if member is None or tail is None or head in seen:
            return None
        seen.add(head)
        members.append(member)
        links += [(head, first, member), (head, rest, tail)]
        head = tail
    return members, tuple(links)
