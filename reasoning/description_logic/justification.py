"""Justifications: the axioms of an ontology, none of them superfluous, from which a statement follows; and the denial
of a statement.

>>> from deixis.reasoning.description_logic.terms import Triple
>>> from deixis.reasoning.description_logic.terms import NOTHING, SUB_CLASS_OF
>>> [str(triple) for triple in denial(Triple("<urn:Spork>", SUB_CLASS_OF, NOTHING))]
['<urn:deixis:someone> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <urn:Spork> .']

To find why a statement follows, its denial is added: the axioms that then contradict each other are a justification.
Where the rules of OWL 2 RL find the contradiction, its derivation says which axioms to begin with; else those are taken
that share names with the statement, and names with those, until HermiT finds the contradiction. Then HermiT proves that
no axiom can be spared, several ontologies in one process.

Sources: Kalyanpur, Parsia, Horridge, Sirin, *Finding all justifications of OWL DL entailments*, ISWC 2007 (black box:
expand, then contract).
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import FEW, Minimal, minimal_by
from deixis.reasoning.description_logic.axioms import Axiom, Axioms, split_axioms
from deixis.reasoning.description_logic.materialisation import Contradiction, Materialisation
from deixis.reasoning.description_logic.reasoners import first_inconsistent
from deixis.reasoning.description_logic.terms import (
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
    Triple,
    is_blank,
    is_literal,
    read_ntriples,
    write_ntriples,
)
from deixis.reasoning.errors import LimitError, NotEntailedError, SettingError

_SOMEONE, _OTHER, _NODE = "<urn:deixis:someone>", "<urn:deixis:other>", "_:denial"
_OURS = tuple(f"<{PREFIXES[name]}" for name in ("rdf", "rdfs", "owl"))


def denial(triple: Triple) -> tuple[Triple, ...]:
    """Return the triples that deny a statement about named things; raises SettingError for one that cannot be denied
    so."""
    subject, predicate, obj = triple
    if any(is_blank(part) for part in triple):
        raise SettingError(f"a statement to explain is about named things: {triple}")
    some_pair = Triple(_SOMEONE, subject, _OTHER)
    cases: dict[str, Callable[[], tuple[Triple, ...]]] = {
        SUB_CLASS_OF: lambda: (Triple(_SOMEONE, TYPE, subject), *_not_a(_SOMEONE, obj)),
        DISJOINT_WITH: lambda: (Triple(_SOMEONE, TYPE, subject), Triple(_SOMEONE, TYPE, obj)),
        TYPE: lambda: _not_a(subject, obj),
        SUB_PROPERTY_OF: lambda: (some_pair, *_not_related(_SOMEONE, obj, _OTHER)),
        DOMAIN: lambda: (some_pair, *_not_a(_SOMEONE, obj)),
        RANGE: lambda: (some_pair, *_not_a(_OTHER, obj)),
        SAME_AS: lambda: (Triple(subject, DIFFERENT_FROM, obj),),
        DIFFERENT_FROM: lambda: (Triple(subject, SAME_AS, obj),),
    }
    if predicate in cases and not (predicate == TYPE and obj.startswith(_OURS) and obj != NOTHING):
        return cases[predicate]()
    if predicate.startswith(_OURS):
        raise SettingError(f"a statement of this kind cannot be explained: {triple}")
    return _not_related(subject, predicate, obj)


def _not_a(thing: str, kind: str) -> tuple[Triple, ...]:
    if kind == NOTHING:
        return ()
    return Triple(thing, TYPE, _NODE), Triple(_NODE, TYPE, CLASS), Triple(_NODE, COMPLEMENT_OF, kind)


def _not_related(subject: str, predicate: str, obj: str) -> tuple[Triple, ...]:
    target = TARGET_VALUE if is_literal(obj) else TARGET_INDIVIDUAL
    return (
        Triple(_NODE, TYPE, NEGATIVE_PROPERTY_ASSERTION),
        Triple(_NODE, SOURCE_INDIVIDUAL, subject),
        Triple(_NODE, ASSERTION_PROPERTY, predicate),
        Triple(_NODE, target, obj),
    )


BATCH, MAX_RINGS, MAX_CONTRADICTIONS = 24, 10, 100
"""Ontologies, rings of names, and contradictions that are looked at at once."""

Oracle = Callable[[Sequence[Sequence[Axiom]]], int | None]
"""Which of several sets of axioms is the first that contradicts itself and the denial."""


@dataclass(frozen=True)
class Justification:
    """Axioms from which a statement follows, or that contradict each other where there is no statement.

    Take any one away, and it does not follow any more; unless ``minimal`` is False: then the time was up before that
    was seen of all of them.
    """

    entailed: Triple | None
    axioms: tuple[Axiom, ...]
    minimal: bool = True

    @property
    def ntriples(self) -> str:
        """The axioms, each with its blank nodes, as N-Triples, which are Turtle too."""
        return write_ntriples(dict.fromkeys(triple for axiom in self.axioms for triple in axiom.triples))


def justify(ntriples: str, entailed: Triple | None = None, deadline: Deadline = Deadline.never()) -> Justification:
    """Return why a statement follows from an ontology, or, without one, why the ontology is inconsistent.

    The statement is about named things: ``rdfs:subClassOf`` (of ``owl:Nothing``: why a class is unsatisfiable),
    ``rdfs:subPropertyOf``, ``rdfs:domain``, ``rdfs:range``, ``owl:disjointWith``, ``owl:sameAs``,
    ``owl:differentFrom``, ``rdf:type`` or a property of the ontology's own. Raises NotEntailedError where it does not
    follow, LimitError where the deadline passes before that is known, SettingError for a statement of another kind.
    """
    parts = split_axioms(read_ntriples(ntriples))
    found = _justification(parts, parts.axioms, entailed, deadline)
    if found is None:
        told = "the ontology is consistent" if entailed is None else f"does not follow from the ontology: {entailed}"
        raise NotEntailedError(f"there is nothing to justify: {told}")
    return found


def justify_all(
    ntriples: str, entailed: Triple | None = None, deadline: Deadline = Deadline.never()
) -> Iterator[Justification]:
    """Yield every justification of a statement, or of an inconsistency, as each is found.

    Every set of axioms that takes one away from each justification known so far is left out in turn, the smaller sets
    first, and what still follows is justified anew (a hitting set tree: Reiter, *A theory of diagnosis from first
    principles*, Artificial Intelligence 32, 1987). There may be exponentially many. Raises as :func:`justify` does;
    LimitError also where the deadline passes before it is known that there are no more.
    """
    parts = split_axioms(read_ntriples(ntriples))
    first = justify(ntriples, entailed, deadline)
    known = [frozenset(first.axioms)]
    yield first
    seen, queue = {frozenset[Axiom]()}, deque([frozenset[Axiom]()])
    while queue:
        without = queue.popleft()
        untouched = next((axioms for axioms in known if not axioms & without), None)
        if untouched is None:
            found = _justification(parts, [axiom for axiom in parts.axioms if axiom not in without], entailed, deadline)
            if found is None:
                continue
            if not found.minimal:
                raise LimitError(f"undecided: the time was up after {len(known)} justifications; allow it more")
            untouched = frozenset(found.axioms)
            known.append(untouched)
            yield found
        branches = (without | {axiom} for axiom in _in_order(parts, untouched))
        for branch in branches:
            if branch not in seen:
                seen.add(branch)
                queue.append(branch)


def _justification(
    parts: Axioms, axioms: Sequence[Axiom], entailed: Triple | None, deadline: Deadline
) -> Justification | None:
    """Return a justification among some of an ontology's axioms; None where from these nothing follows."""
    denied = () if entailed is None else denial(entailed)
    oracle = _oracle(parts, denied, deadline)
    # the fewest axioms in the derivation of a contradiction by OWL 2 RL; many of them only if HermiT agrees
    known = Materialisation([*_triples(axioms), *parts.declarations, *denied], deadline)
    owner: dict[Triple, list[Axiom]] = defaultdict(list)
    for each in axioms:
        for part in each.triples:
            owner[part].append(each)
    owning = [_owners(known, owner, seen) for seen in known.contradictions[:MAX_CONTRADICTIONS]]
    fewest = min(owning, key=len, default=None)
    seed = fewest if fewest is None or len(fewest) <= FEW or oracle([fewest]) == 0 else None
    minimal = None if seed is None else _minimal(seed, oracle)
    if minimal is None and (around := _expanded(axioms, entailed, oracle)) is not None:
        minimal = _minimal(around, oracle)
    if minimal is None:
        return None
    return Justification(entailed, tuple(_in_order(parts, minimal.items)), minimal.proved)


def _in_order(parts: Axioms, axioms: Iterable[Axiom]) -> list[Axiom]:
    """Return axioms in the order of the ontology."""
    chosen = set(axioms)
    return [axiom for axiom in parts.axioms if axiom in chosen]


def _oracle(parts: Axioms, denied: Sequence[Triple], deadline: Deadline) -> Oracle:
    background = (*parts.declarations, *denied)

    def first(candidates: Sequence[Sequence[Axiom]]) -> int | None:
        if deadline.passed:
            raise LimitError("undecided: the time was up before a justification was found; allow it more")
        return first_inconsistent([[*background, *_triples(axioms)] for axioms in candidates], deadline.left)

    return first


def _triples(axioms: Iterable[Axiom]) -> dict[Triple, None]:
    return dict.fromkeys(triple for axiom in axioms for triple in axiom.triples)


def _owners(known: Materialisation, owner: dict[Triple, list[Axiom]], seen: Contradiction) -> list[Axiom]:
    stated = [step.triple for step in known.derivation(seen.premises) if step.rule is None]
    return list(dict.fromkeys(axiom for triple in stated for axiom in owner.get(triple, ())[:1]))


def _expanded(axioms: Sequence[Axiom], entailed: Triple | None, oracle: Oracle) -> list[Axiom] | None:
    """Return the axioms around the statement, as far from it as it takes to contradict its denial; near ones first."""
    ordered, ends = _rings(axioms, entailed)
    place = oracle([ordered[:end] for end in ends])
    return None if place is None else ordered[: ends[place]]


def _rings(axioms: Sequence[Axiom], entailed: Triple | None) -> tuple[list[Axiom], list[int]]:
    """Return axioms by how many steps of shared names they are from a statement, and where each of the steps ends."""
    names = {part for part in entailed or () if not is_literal(part)}
    ordered: list[Axiom] = []
    ends: list[int] = []
    left = list(axioms)
    while names and left and len(ends) < MAX_RINGS:
        near = [axiom for axiom in left if axiom.signature & names]
        if not near:
            break
        ordered += near
        ends.append(len(ordered))
        names |= {name for axiom in near for name in axiom.signature}
        taken = set(near)
        left = [axiom for axiom in left if axiom not in taken]
    return [*ordered, *left], [*ends, len(ordered) + len(left)]


def _minimal(axioms: list[Axiom], oracle: Oracle) -> Minimal[Axiom] | None:
    """Return the axioms without those that can be spared; None where a few contradict nothing.

    Of few mostly none can be spared, so that they are asked about themselves in the run that leaves each out in turn.
    """
    if len(axioms) <= FEW:
        place = oracle([*(axioms[:k] + axioms[k + 1 :] for k in reversed(range(len(axioms)))), axioms])
        if place is None:
            return None
        if place == len(axioms):
            return Minimal(tuple(axioms), True)
        axioms = [axiom for k, axiom in enumerate(axioms) if k != len(axioms) - 1 - place]

    def first_of(candidates: Iterable[list[Axiom]]) -> tuple[int, list[Axiom]] | None:
        asked = list(candidates)
        place = oracle(asked)
        return None if place is None else (place, asked[place])

    return minimal_by(axioms, first_of, width=BATCH)
