"""Justifications: minimal sets of axioms of an ontology that entail a statement.

>>> from deixis.reasoning.description_logic.terms import Triple
>>> from deixis.reasoning.description_logic.terms import NOTHING, SUB_CLASS_OF
>>> [str(triple) for triple in denial(Triple("<urn:Spork>", SUB_CLASS_OF, NOTHING))]
['<urn:deixis:someone> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <urn:Spork> .']

To justify a statement, its denial is added: the axioms that then contradict each other are a justification. If the
rules of OWL 2 RL find the contradiction, the search starts from the axioms of its derivation. Otherwise it starts from
axioms that share names with the statement, and adds axioms that share names with those, until HermiT finds the
contradiction. Then HermiT proves that no axiom can be left out, testing several ontologies in one process.

Source: Kalyanpur, Parsia, Horridge, Sirin, *Finding all justifications of OWL DL entailments*, ISWC 2007 (black box:
expand, then contract).
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import FEW, Minimal, minimal_by
from deixis.reasoning.description_logic.axioms import Axiom, Axioms, split_axioms
from deixis.reasoning.description_logic.owl_rl.materialisation import Contradiction, Materialisation
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
from deixis.reasoning.errors import LimitError, NotEntailedError, ReasonerError, SettingError

_SOMEONE, _OTHER, _NODE = "<urn:deixis:someone>", "<urn:deixis:other>", "_:denial"
_OURS = tuple(f"<{PREFIXES[name]}" for name in ("rdf", "rdfs", "owl"))


def denial(triple: Triple) -> tuple[Triple, ...]:
    """Return the triples that deny a statement about named resources.

    Parameters
    ----------
    triple
        Statement of one of the kinds that :func:`justify` explains.

    Returns
    -------
    tuple of Triple
        Triples that contradict the ontology if and only if it entails the statement.

    Raises
    ------
    SettingError
        The statement is not about named resources, or of another kind.
    """
    subject, predicate, obj = triple
    if any(is_blank(part) for part in triple):
        raise SettingError(f"a statement to explain must be about named resources, got {triple}")
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
"""Limits on the ontologies per run, the rings of names, and the contradictions considered."""

Oracle = Callable[[Sequence[Sequence[Axiom]]], int | None]
"""Function that returns the position of the first set of axioms that contradicts itself and the denial, or None."""


@dataclass(frozen=True)
class Justification:
    """Axioms that entail a statement, or that are inconsistent if there is no statement.

    ``minimal`` is True if all axioms are needed, and False if the time ran out before that was proved.
    """

    entailed: Triple | None
    axioms: tuple[Axiom, ...]
    minimal: bool = True

    @property
    def ntriples(self) -> str:
        """Axioms with their blank nodes as N-Triples, which are also Turtle."""
        return write_ntriples(dict.fromkeys(triple for axiom in self.axioms for triple in axiom.triples))


def justify(ntriples: str, entailed: Triple | None = None, deadline: Deadline = Deadline.never()) -> Justification:
    """Return a justification of an entailed statement, or of the inconsistency of an ontology.

    Parameters
    ----------
    ntriples
        The ontology as N-Triples.
    entailed
        A statement about named resources: ``rdfs:subClassOf`` (of ``owl:Nothing`` for an unsatisfiable class),
        ``rdfs:subPropertyOf``, ``rdfs:domain``, ``rdfs:range``, ``owl:disjointWith``, ``owl:sameAs``,
        ``owl:differentFrom``, ``rdf:type``, or a property of the ontology. None stands for the inconsistency.
    deadline
        Time limit.

    Returns
    -------
    Justification
        A set of axioms from which the statement follows, and from no proper subset of which it follows.

    Raises
    ------
    NotEntailedError
        If the statement does not follow, or the ontology is consistent.
    LimitError
        If the deadline passes before that is known.
    SettingError
        If the statement is of another kind.
    """
    parts = split_axioms(read_ntriples(ntriples))
    found = _justification(parts, parts.axioms, entailed, deadline)
    if found is None:
        reason = "the ontology is consistent" if entailed is None else f"does not follow from the ontology: {entailed}"
        raise NotEntailedError(f"there is nothing to justify: {reason}")
    return found


def justify_all(
    ntriples: str, entailed: Triple | None = None, deadline: Deadline = Deadline.never()
) -> Iterator[Justification]:
    """Yield every justification of a statement, or of an inconsistency, as each is found.

    The search is a hitting set tree (Reiter, *A theory of diagnosis from first principles*, Artificial Intelligence 32,
    1987): it removes one axiom of each known justification in all combinations, smaller sets first, and justifies the
    statement again if it still follows. There may be exponentially many justifications.

    Parameters
    ----------
    ntriples
        The ontology as N-Triples.
    entailed
        A statement as for :func:`justify`; None stands for the inconsistency.
    deadline
        End of the time limit.

    Yields
    ------
    Justification
        A justification; no two are equal, and none contains another one.

    Raises
    ------
    NotEntailedError
        The statement does not follow, or the ontology is consistent.
    LimitError
        The deadline passes before all justifications are known.
    SettingError
        The statement is of a kind that cannot be explained.
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
                raise LimitError(f"undecided: time limit reached after {len(known)} justifications; raise it")
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
    """Return a justification among some of an ontology's axioms, or None if they do not entail the statement."""
    denied = () if entailed is None else denial(entailed)
    oracle = _oracle(parts, denied, deadline)
    # start from the smallest derivation of a contradiction by OWL 2 RL; HermiT confirms it if it has many axioms
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
    """Return the axioms in the order of the ontology."""
    chosen = set(axioms)
    return [axiom for axiom in parts.axioms if axiom in chosen]


def _oracle(parts: Axioms, denied: Sequence[Triple], deadline: Deadline) -> Oracle:
    background = (*parts.declarations, *denied)

    def first(candidates: Sequence[Sequence[Axiom]]) -> int | None:
        if deadline.passed:
            raise LimitError("undecided: time limit reached before a justification was found; raise it")
        ontologies = [[*background, *_triples(axioms)] for axioms in candidates]
        try:
            return first_inconsistent(ontologies, deadline.left)
        except ReasonerError:  # HermiT refuses a literal outside its datatype, which contradicts itself by the rules
            contradictory = (k for k, one in enumerate(ontologies) if Materialisation(one, deadline).contradictions)
            place = next(contradictory, None)
            if place is None:
                raise
            return place

    return first


def _triples(axioms: Iterable[Axiom]) -> dict[Triple, None]:
    return dict.fromkeys(triple for axiom in axioms for triple in axiom.triples)


def _owners(known: Materialisation, owner: dict[Triple, list[Axiom]], seen: Contradiction) -> list[Axiom]:
    stated = [step.triple for step in known.derivation(seen.premises) if step.rule is None]
    return list(dict.fromkeys(axiom for triple in stated for axiom in owner.get(triple, ())[:1]))


def _expanded(axioms: Sequence[Axiom], entailed: Triple | None, oracle: Oracle) -> list[Axiom] | None:
    """Return the axioms nearest to the statement that contradict its denial, in order of distance; None without any."""
    ordered, ends = _rings(axioms, entailed)
    place = oracle([ordered[:end] for end in ends])
    return None if place is None else ordered[: ends[place]]


def _rings(axioms: Sequence[Axiom], entailed: Triple | None) -> tuple[list[Axiom], list[int]]:
    """Return axioms by their distance in shared names from a statement, and the end of each distance."""
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
    """Return a minimal subset of contradictory axioms, or None if a few axioms contradict nothing.

    Few axioms are usually all needed, so the run that leaves each out in turn also tests all of them.
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
