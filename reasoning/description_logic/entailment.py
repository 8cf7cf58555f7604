"""Entailment and consistency of ontologies: the engines of description logic behind one call.

``rl`` runs the rules of OWL 2 RL, which handle tens of thousands of facts but do not find everything that OWL 2 DL
entails. ``hermit`` and ``pellet`` are complete for OWL 2 DL, but slow with many facts. ``auto`` gives the facts to the
rules and only the classes to HermiT; figures are in ``docs/reference/description_logic.md``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.reasoning.description_logic.axioms import Axioms, split_axioms
from deixis.reasoning.description_logic.justification import Justification, justify, justify_all
from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
from deixis.reasoning.description_logic.reasoners import Reasoner, classify
from deixis.reasoning.description_logic.terms import (
    CLASS,
    NOTHING,
    PREFIXES,
    SUB_CLASS_OF,
    TYPE,
    Triple,
    is_blank,
    read_ntriples,
    write_ntriples,
)
from deixis.reasoning.errors import InconsistencyError, LimitError, ReasonerError, SettingError

MAX_EXPLAINED = 5
"""Maximum number of unsatisfiable classes that are explained; later ones usually have the same reasons."""

_WORDS_OF_OWL = tuple(f"<{base}" for base in PREFIXES.values())


class LogicEngine(StrEnum):
    """An engine of description logic."""

    AUTO = "auto"
    RL = "rl"
    HERMIT = "hermit"
    PELLET = "pellet"


@dataclass(frozen=True, repr=False)
class Entailment(Answer):
    """The result of an engine.

    ``complete`` is True if all of OWL 2 DL was decided; with the rules alone, ``consistent`` only means that they found
    no contradiction. ``inferred`` is empty for an inconsistent ontology. ``inconsistency`` explains the inconsistency,
    and ``impossible`` each of the first unsatisfiable classes, as far as :func:`explained` found justifications; if it
    did not find all, ``unexplained`` is the reason. ``labels`` are those of the ontology by term, for sentences.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.reason("ontology/deixis.ttl", "rl")
    >>> found.possible, found.unsatisfiable, found.complete
    (True, (), False)
    """

    engine: LogicEngine
    complete: bool
    consistent: bool
    inferred: tuple[Triple, ...] = ()
    unsatisfiable: tuple[str, ...] = ()
    inconsistency: tuple[Justification, ...] = ()
    impossible: tuple[Justification, ...] = ()
    unexplained: str | None = None
    labels: Mapping[str, str] = field(default_factory=dict)

    def summary(self) -> str:
        """Return the verdict, the engine, and the number of inferred triples."""
        if not self.consistent:
            return f"inconsistent ({self.engine})"
        held = "consistent" if self.complete else "no contradiction found"
        return f"{held} ({self.engine}); {count(len(self.inferred), 'triple')} inferred"

    @property
    def possible(self) -> bool:
        """True if the ontology and each of its classes are satisfiable."""
        return self.consistent and not self.unsatisfiable


def entail(ntriples: str, engine: LogicEngine | str = LogicEngine.AUTO, time_limit: float = 60.0) -> Entailment:
    """Return the entailed triples between named resources, and whether the ontology and its classes are satisfiable.

    Parameters
    ----------
    ntriples
        The ontology as N-Triples.
    engine
        The engine, or its name.
    time_limit
        Time limit in seconds.

    Returns
    -------
    The result without justifications; :func:`explained` adds them.

    Raises
    ------
    SettingError
        If there is no engine of that name.
    LimitError
        At the time limit.
    DeixisError
        If the input is invalid; see :func:`deixis.reasoning.description_logic.reasoners.classify`.
    """
    if engine not in list(LogicEngine):
        raise SettingError(f"the engine must be one of {', '.join(LogicEngine)}, got '{engine}'")
    engine = LogicEngine(engine)
    complete = engine in (LogicEngine.HERMIT, LogicEngine.PELLET)
    try:
        if complete:
            inferred, unsatisfiable = _by_reasoner(ntriples, engine, time_limit)
        else:
            inferred, unsatisfiable = _by_rules(ntriples, engine, Deadline.after(time_limit))
    except InconsistencyError:
        return Entailment(engine, complete, consistent=False)
    return Entailment(engine, complete, True, inferred, unsatisfiable)


def explained(ntriples: str, found: Entailment, deadline: Deadline, every: bool = False) -> Entailment:
    """Return a result with a justification of each impossibility, or with all of them.

    The verdict does not change; at the deadline, or if HermiT refuses the ontology, the result has the justifications
    found so far.

    Parameters
    ----------
    ntriples
        The ontology as N-Triples.
    found
        Result of an engine for this ontology.
    deadline
        End of the time limit.
    every
        Whether to find all justifications; by default, one of each impossibility.

    Returns
    -------
    Entailment
        Copy of ``found`` with the justifications.
    """
    why: list[Justification] = []
    unexplained = None
    asked = [Triple(f"<{iri}>", SUB_CLASS_OF, NOTHING) for iri in found.unsatisfiable[:MAX_EXPLAINED]]
    try:
        for statement in asked if found.consistent else [None]:
            if every:
                why.extend(justify_all(ntriples, statement, deadline))
            else:
                why.append(justify(ntriples, statement, deadline))
    except (LimitError, ReasonerError) as error:
        unexplained = str(error)
    if found.consistent:
        return replace(found, impossible=tuple(why), unexplained=unexplained)
    return replace(found, inconsistency=tuple(why), unexplained=unexplained)


Found = tuple[tuple[Triple, ...], tuple[str, ...]]


def _by_reasoner(ntriples: str, engine: LogicEngine, time_limit: float) -> Found:
    found = classify(ntriples, Reasoner(engine.value), time_limit, properties=True)
    return tuple(read_ntriples(found.inferred)), found.unsatisfiable


def _by_rules(ntriples: str, engine: LogicEngine, deadline: Deadline) -> Found:
    triples = read_ntriples(ntriples)
    parts = split_axioms(triples)
    known = Materialisation([*(t for axiom in parts.axioms for t in axiom.triples), *parts.declarations], deadline)
    if known.contradictions:
        raise InconsistencyError("the rules of OWL 2 RL find a contradiction")
    inferred = {triple for triple in known.inferred if _is_telling(triple)}
    if engine is LogicEngine.RL:
        return tuple(sorted(inferred)), unsatisfiable_by_rules(triples, deadline)
    classes = classify(write_ntriples(_schema(parts)), Reasoner.HERMIT, deadline.left, properties=True)
    inferred.update(read_ntriples(classes.inferred))
    return tuple(sorted(inferred.difference(triples))), classes.unsatisfiable


def _is_telling(triple: Triple) -> bool:
    """Return whether a triple relates named resources that are not terms of OWL."""
    subject, _, obj = triple
    blank = is_blank(subject) or is_blank(obj)
    return not blank and not subject.startswith(_WORDS_OF_OWL) and not obj.startswith(_WORDS_OF_OWL)


def _schema(parts: Axioms) -> Iterable[Triple]:
    """Yield the axioms about classes and properties, without the facts about individuals."""
    for axiom in parts.axioms:
        root = axiom.root
        says_of_terms = root.predicate.startswith(_WORDS_OF_OWL) and root.predicate != TYPE
        if says_of_terms or (root.predicate == TYPE and root.object.startswith(_WORDS_OF_OWL)):
            yield from axiom.triples
    yield from parts.declarations


def unsatisfiable_by_rules(triples: Iterable[Triple], deadline: Deadline = Deadline.never()) -> tuple[str, ...]:
    """Return the IRIs of the named classes that the rules find unsatisfiable, sorted.

    Each class is given its own member; a contradiction that depends on a member only affects the class of that member.

    Parameters
    ----------
    triples
        Triples of an ontology in which the rules find no contradiction.
    deadline
        End of the time limit.

    Returns
    -------
    tuple of str
        IRIs of the classes.

    Raises
    ------
    LimitError
        The deadline passed.
    """
    triples = list(triples)
    classes = {t.subject for t in triples if t.predicate == TYPE and t.object == CLASS and not is_blank(t.subject)}
    classes |= {t.subject for t in triples if t.predicate == SUB_CLASS_OF and not is_blank(t.subject)}
    members = {Triple(f"_:member{i}", TYPE, name): name for i, name in enumerate(sorted(classes))}
    known = Materialisation([*triples, *members], deadline)
    unsatisfiable = set()
    for contradiction in known.contradictions:
        needed = {members[s.triple] for s in known.derivation(contradiction.premises) if s.triple in members}
        if len(needed) == 1:
            unsatisfiable |= needed
    return tuple(sorted(name[1:-1] for name in unsatisfiable - {NOTHING}))
