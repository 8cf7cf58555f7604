"""Semi-naive forward chaining over facts as integers, with incremental transitive closures.

Source: Italiano, *Amortized efficiency of a path retrieval data structure*, Theoretical Computer Science 48 (1986): a
new pair (x, y) joins all that reach x with all that y reaches, and only new pairs are processed.

A rule is specialised by the axioms that it refers to (a domain becomes a rule about one property), so that a fact is
matched only with the rules about its own predicate and class. The cost of adding facts is proportional to their
consequences.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from deixis.deadline import Deadline
from deixis.reasoning.description_logic.owl_rl.datatypes import DATATYPES, DataValue, IllFormedError, is_in, value_of
from deixis.reasoning.description_logic.owl_rl.facts import (
    Atom,
    Binding,
    Fact,
    FactIndex,
    copied,
    copy_of,
    substituted,
    unified,
)
from deixis.reasoning.description_logic.owl_rl.rules import EXPANSIONS, TermAtom, TextRule, list_members, rules
from deixis.reasoning.description_logic.terms import (
    EQUIVALENT_CLASS,
    EQUIVALENT_PROPERTY,
    FIRST,
    NIL,
    REST,
    SAME_AS,
    SOME_VALUES_FROM,
    SUB_CLASS_OF,
    SUB_PROPERTY_OF,
    TYPE,
    Triple,
    is_literal,
)
from deixis.reasoning.errors import LimitError

Pair = tuple[int, int]


class TransitiveClosure:
    """A transitive relation, closed incrementally.

    >>> closure = TransitiveClosure()
    >>> list(closure.add(1, 2)), list(closure.add(2, 3))
    ([], [((1, 3), (1, 2), (2, 3))])
    """

    def __init__(self) -> None:
        self._after: dict[int, set[int]] = {}
        self._before: dict[int, set[int]] = {}

    def add(self, x: int, y: int) -> Iterator[tuple[Pair, Pair, Pair]]:
        """Add a pair; yield each new pair of the closure, and the two pairs that it follows from.

        Parameters
        ----------
        x, y
            Numbers of the two terms of the pair.

        Yields
        ------
        tuple
            The new pair, and the two pairs. The added pair itself is not among the new ones.
        """
        after, before = self._after, self._before
        if y in after.get(x, ()):
            return
        later = {y, *after.get(y, ())}
        for a in (x, *before.get(x, ())):
            reached = after.setdefault(a, set())
            new = later - reached
            reached |= new
            for b in new:
                before.setdefault(b, set()).add(a)
            if y in new and a != x:
                yield (a, y), (a, x), (x, y)
            yield from (((a, b), (a, y), (y, b)) for b in new if b != y)


BATCH = 1000
"""Number of facts between two checks of the deadline."""

IS_TYPE, NOT_TYPE, DIFFERENT = "dt-type2", "dt-not-type", "dt-diff"
"""Names of the rules about literals."""

_REFLEXIVE = (SAME_AS, SUB_CLASS_OF, SUB_PROPERTY_OF, EQUIVALENT_CLASS, EQUIVALENT_PROPERTY)


class Terms:
    """Terms as numbers, from 0 in the order of their first use; literals of equal value have one number (``dt-eq``)."""

    def __init__(self) -> None:
        self._number: dict[str, int] = {}
        self._terms: list[str] = []
        self._by_value: dict[DataValue, int] = {}
        self._as_stated: dict[Fact, Triple] = {}  # literals spelled differently from the first one of their value
        self.literals: dict[int, DataValue | None] = {}  # literals and their values, None if not known
        self.ill_formed: set[int] = set()

    def number(self, term: str) -> int:
        """Return the number of a term, which is new for a new term.

        Parameters
        ----------
        term
            Term in the syntax of N-Triples.

        Returns
        -------
        int
            Number, at least 0; literals with the same value have the same number.
        """
        known = self._number.get(term)
        if known is None:
            known = self._literal(term) if is_literal(term) else self._new(term)
            self._number[term] = known
        return known

    def _new(self, term: str) -> int:
        self._terms.append(term)
        return len(self._terms) - 1

    def _literal(self, term: str) -> int:
        try:
            value = value_of(term)
        except IllFormedError:
            number, value = self._new(term), None
            self.ill_formed.add(number)
        else:
            number = self._new(term) if value not in self._by_value or value is None else self._by_value[value]
        if value is not None:
            self._by_value[value] = number
        self.literals[number] = value
        return number

    def term(self, number: int) -> str:
        """Return the term with a number.

        Parameters
        ----------
        number
            Number of the term.

        Returns
        -------
        str
            Term in the syntax of N-Triples.
        """
        return self._terms[number]

    def fact(self, triple: Triple) -> Fact:
        """Return a triple as a fact of numbers, and remember the spelling of its literal.

        Parameters
        ----------
        triple
            The triple.

        Returns
        -------
        tuple of int
            Numbers of subject, predicate and object.
        """
        fact = self.number(triple.subject), self.number(triple.predicate), self.number(triple.object)
        if self._terms[fact[2]] != triple.object:
            self._as_stated.setdefault(fact, triple)
        return fact

    def known_fact(self, triple: Triple) -> Fact | None:
        """Return the fact of a triple, or None if one of its terms has no number.

        Parameters
        ----------
        triple
            The triple.

        Returns
        -------
        tuple of int or None
            Numbers of subject, predicate and object.
        """
        s, p, o = (self._number.get(term) for term in triple)
        return None if s is None or p is None or o is None else (s, p, o)

    def triple(self, fact: Fact) -> Triple:
        """Return the triple of a fact, in the spelling in which it was stated.

        Parameters
        ----------
        fact
            Numbers of subject, predicate and object.

        Returns
        -------
        Triple
            The triple.
        """
        stated = self._as_stated.get(fact)
        if stated is not None:
            return stated
        s, p, o = fact
        return Triple(self._terms[s], self._terms[p], self._terms[o])


@dataclass(frozen=True, slots=True, eq=False)
class HornClause:
    """A rule, specialised by the facts ``given``: patterns, and their conclusion if all of them are facts.

    The conclusion is a fact, or a contradiction (no head), or, if ``then`` is set, a clause with that body.
    """

    name: str
    given: tuple[Fact, ...]
    body: tuple[Atom, ...]
    head: Atom | None
    then: tuple[Atom, ...] | None = None


class Watcher(NamedTuple):
    """A clause, its pattern that a fact may match, the other patterns, and the short cut, if any."""

    clause: HornClause
    atom: Atom
    rest: tuple[Atom, ...]
    copy: Atom | None


Watchers = list[Watcher]


class ForwardChaining:
    """Facts, clauses about them, and the origin of each fact: the rule and its premises, or None for a stated fact."""

    def __init__(self) -> None:
        self.terms = Terms()
        self.why: dict[Fact, tuple[str, tuple[Fact, ...]] | None] = {}
        self.contradictions: dict[tuple[str, frozenset[Fact]], tuple[Fact, ...]] = {}
        self._index = FactIndex()
        self._queue: deque[Fact] = deque()
        self._found: list[Fact] = []
        self._by_predicate: dict[int, Watchers] = defaultdict(list)
        self._by_object: dict[tuple[int, int], Watchers] = defaultdict(list)
        self._by_node: dict[tuple[str, int], Watchers] = defaultdict(list)  # patterns with a variable predicate
        self._closures: dict[int, tuple[TransitiveClosure, HornClause]] = {}
        self._unread: list[Fact] = []  # axioms whose lists are not complete yet
        number = self.terms.number
        self._list_predicates = {number(predicate): predicate for predicate, _ in EXPANSIONS}
        self._reflexive = {number(name) for name in _REFLEXIVE}
        self._same, self._some_values = number(SAME_AS), number(SOME_VALUES_FROM)
        self._asked: set[int] = set()  # datatypes for which the membership of literals matters
        self._met: set[int] = set()  # literals in facts
        self._type, self._first, self._rest, self._nil = (number(name) for name in (TYPE, FIRST, REST, NIL))
        for rule in rules():
            self._learn(rule)

    def add(self, facts: Iterable[Fact], deadline: Deadline = Deadline.never()) -> list[Fact]:
        """Add stated facts, and return the facts that follow now and did not before.

        After a LimitError, the facts found so far stay, but are incomplete.

        Parameters
        ----------
        facts
            Facts as numbers of subject, predicate and object.
        deadline
            End of the time limit.

        Returns
        -------
        list of tuple
            Derived facts, in the order found.

        Raises
        ------
        LimitError
            The deadline passed.
        """
        self._found = []
        for fact in facts:
            if fact not in self.why:
                self._queue.append(fact)
            self.why[fact] = None
        while self._queue:
            for _ in range(min(len(self._queue), BATCH)):
                self._process(self._queue.popleft())
            if deadline.passed:
                raise LimitError(f"undecided: time limit reached after {len(self.why)} triples; raise it")
            if not self._queue:
                self._read_lists()
        return [fact for fact in self._found if self.why[fact] is not None]

    # ---- facts

    def _process(self, fact: Fact) -> None:
        s, p, o = fact
        self._index.add(s, p, o)
        if o in self.terms.literals and o not in self._met:
            self._meet(o, fact)
        if p == self._some_values and self.terms.term(o) in DATATYPES and o not in self._asked:
            self._asked.add(o)
            self._type_literals(self._met, (o,))
        if p in self._list_predicates:
            self._unread.append(fact)
        if p in self._closures:
            self._extend(p, s, o)
        if p in self._by_predicate:
            self._fire(fact, self._by_predicate[p])
        if (p, o) in self._by_object:
            self._fire(fact, self._by_object[p, o])
        if self._by_node:
            for key in (("subject", s), ("object", o)):
                if key in self._by_node:
                    self._fire(fact, self._by_node[key])

    def _fire(self, fact: Fact, watchers: Watchers) -> None:
        for clause, atom, rest, copy in tuple(watchers):
            if copy is not None:
                head = copied(copy, fact)
                if head not in self.why:
                    self._infer(head, clause.name, (*clause.given, fact))
                continue
            bound = unified(atom, fact, {})
            if bound is None:
                continue
            if not rest:
                self._conclude(clause, bound, (fact,))
                continue
            for binding, facts in self._joined(rest, bound, {atom: fact}):
                self._conclude(clause, binding, facts)

    def _joined(
        self, atoms: Sequence[Atom], bound: Binding, found: dict[Atom, Fact]
    ) -> list[tuple[Binding, tuple[Fact, ...]]]:
        """Return all solutions at once, so that their conclusions do not change the facts during the search."""
        return [(binding, tuple(found.values())) for binding in self._index.solutions(atoms, bound, found)]

    def _conclude(self, clause: HornClause, binding: Binding, facts: tuple[Fact, ...]) -> None:
        head = None if clause.head is None else substituted(clause.head, binding)
        if clause.then is not None:
            body = tuple(substituted(atom, binding) for atom in clause.then)
            self._install(HornClause(clause.name, (*clause.given, *facts), body, head))
        elif head is None:
            premises = tuple(dict.fromkeys((*clause.given, *facts)))
            self.contradictions.setdefault((clause.name, frozenset(premises)), premises)
        elif head not in self.why:
            self._infer(head, clause.name, (*clause.given, *facts))

    def _infer(self, fact: Fact, name: str, premises: tuple[Fact, ...]) -> None:
        s, p, o = fact
        if s in self.terms.literals:
            self._check_value(fact, premises)
            return
        if fact in self.why or (s == o and p in self._reflexive):
            return
        self.why[fact] = name, premises
        self._found.append(fact)
        self._queue.append(fact)

    # ---- literals

    def _meet(self, literal: int, fact: Fact) -> None:
        """Check a literal when its first fact comes: whether it is well formed, and its datatypes."""
        self._met.add(literal)
        if literal in self.terms.ill_formed:
            self.contradictions.setdefault((NOT_TYPE, frozenset((fact,))), (fact,))
        self._type_literals((literal,), self._asked)

    def _type_literals(self, literals: Iterable[int], datatypes: Iterable[int]) -> None:
        """Add the facts that some literals belong to some datatypes."""
        for literal in literals:
            value = self.terms.literals[literal]
            for datatype in datatypes:
                fact = literal, self._type, datatype
                if value is not None and is_in(value, self.terms.term(datatype)) and fact not in self.why:
                    self.why[fact] = IS_TYPE, ()
                    self._queue.append(fact)

    def _check_value(self, fact: Fact, premises: tuple[Fact, ...]) -> None:
        """Compare a conclusion about a literal with the value that it denotes."""
        literal, predicate, other = fact
        value = self.terms.literals[literal]
        if value is None:
            return
        rule = None
        if predicate == self._same and other != literal and self.terms.literals.get(other) is not None:
            rule = DIFFERENT
        elif predicate == self._type and is_in(value, self.terms.term(other)) is False:
            rule = NOT_TYPE
        if rule is not None:
            premises = tuple(dict.fromkeys(premises))
            self.contradictions.setdefault((rule, frozenset(premises)), premises)

    def _extend(self, predicate: int, x: int, y: int) -> None:
        closure, clause = self._closures[predicate]
        for (a, d), (a1, b), (c, d1) in closure.add(x, y):
            self._infer((a, predicate, d), clause.name, (*clause.given, (a1, predicate, b), (c, predicate, d1)))

    # ---- rules

    def _learn(self, rule: TextRule, given: tuple[Fact, ...] = ()) -> None:
        """Add a rule; if it has a schema, the axioms that match it turn it into clauses about facts."""
        variables: dict[str, int] = {}
        schema, body = (tuple(self._atom(atom, variables) for atom in part) for part in (rule.schema, rule.body))
        head = None if rule.head is None else self._atom(rule.head, variables)
        self._install(
            HornClause(rule.name, given, schema, head, body) if schema else HornClause(rule.name, given, body, head)
        )

    def _atom(self, atom: TermAtom, variables: dict[str, int]) -> Atom:
        s, p, o = (
            variables.setdefault(word, -1 - len(variables)) if word.startswith("?") else self.terms.number(word)
            for word in atom
        )
        return s, p, o

    def _install(self, clause: HornClause) -> None:
        """Watch for facts that match a clause's patterns, and apply the clause to the known facts."""
        if _is_transitivity(clause):
            predicate = clause.body[0][1]
            if predicate not in self._closures:
                self._closures[predicate] = TransitiveClosure(), clause
                for x, _, y in self._index.matches((-1, predicate, -2)):
                    self._extend(predicate, x, y)
            return
        for atom in clause.body:
            rest = tuple(other for other in clause.body if other is not atom)
            copy = None if rest or clause.head is None or clause.then is not None else copy_of(clause.head, atom)
            self._watchers(atom).append(Watcher(clause, atom, rest, copy))
        for binding, facts in self._joined(clause.body, {}, {}):
            self._conclude(clause, binding, facts)

    def _watchers(self, atom: Atom) -> Watchers:
        s, p, o = atom
        if p < 0:
            return self._by_node[("subject", s) if s >= 0 else ("object", o)]
        return self._by_object[p, o] if o >= 0 else self._by_predicate[p]

    # ---- lists

    def _read_lists(self) -> None:
        """Learn the rules of the axioms whose lists are complete now."""
        unread, self._unread = self._unread, []
        for axiom in unread:
            expanded = list(self._expanded(axiom))
            if not expanded:
                self._unread.append(axiom)
            for rule, given in expanded:
                self._learn(rule, given)

    def _expanded(self, axiom: Fact) -> Iterator[tuple[TextRule, tuple[Fact, ...]]]:
        node, predicate, head = axiom
        whole = list_members(self._index, head, self._first, self._rest, self._nil)
        if whole is None:
            return
        members, links = whole
        for (name, kind), expand in EXPANSIONS.items():
            given = (axiom,) if kind is None else (axiom, (node, self._type, self.terms.number(kind)))
            if name == self._list_predicates[predicate] and given[-1] in self._index:
                for rule in expand(self.terms.term(node), [self.terms.term(member) for member in members]):
                    yield rule, (*given, *links)


def _is_transitivity(clause: HornClause) -> bool:
    """Return whether a clause states that a predicate is transitive."""
    if clause.then is not None or clause.head is None or len(clause.body) != 2:
        return False
    (x, p, y), (y2, q, z), (a, r, b) = *clause.body, clause.head
    return p >= 0 and p == q == r and (y, a, b) == (y2, x, z) and max(x, y, z) < 0 and len({x, y, z}) == 3
