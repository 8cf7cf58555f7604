"""The concept of a layout over all its tables: what always holds, what usually holds, what is optional, how far apart.

A stated fact that held on every table stays firm. Any other stated fact gets its share of the tables as its weight. Of
what no lesson stated, the relations that held on every table are added, hedged, and the distances that hardly varied,
as claims. Only counts are used, so the order of the tables does not matter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pyoxigraph as ox

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.grammar.layout.format import layout_script
from deixis.learning.layouts.experience import COMPARED, TOLERANCE, Experience, Tally
from deixis.learning.layouts.tables import TaughtTable
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.lessons.shapes import layout_shapes
from deixis.ontology.lessons.types import LayoutConcept, Role
from deixis.ontology.lessons.write import layout_triples
from deixis.ontology.relations.relation import Reading, Relation, Relations
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import PerceivedObject
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.geometry.rectangle import box_relations

MIN_TABLES = 2
"""Minimum number of tables at which counts outweigh the words."""

DISTANCE_RATIO = 1.3
"""Ratio to the mean up to which a distance counts as the same."""

MIN_DISTANCE = 0.01
"""Minimum distance in metres that is stated; things that nearly touch have none."""


@dataclass(frozen=True, slots=True)
class Counted:
    """A statement of a concept, on how many of the tables it held, and whether a person stated it."""

    statement: Fact | Claim
    tally: Tally
    told: bool

    def __str__(self) -> str:
        counted = f"held on {self.tally.held:g} of {self.tally.of:g} tables" if self.tally.of else "never compared"
        return f"{self.statement}: {counted}{'' if self.told else ', not stated'}"


@dataclass(frozen=True, eq=False, repr=False)
class CountedConcept(Answer):
    """A layout with the counts of what held on its tables.

    Attributes
    ----------
    layout
        The layout, whose weights and optional facts follow from the counts.
    lessons
        Ids of the lessons, one for each table.
    statements
        Facts and claims of the layout, in its order, with their counts.
    filled
        Number of tables on which each role was filled.

    Examples
    --------
    >>> import deixis
    >>> from deixis.learning.lessons.lesson import layout_concept
    >>> script = deixis.read_script(text="layout tea; cup on saucer")
    >>> fact, = script.facts
    >>> on_both = Counted(fact, Tally(2, 2), told=True)
    >>> roles = {"cup": Tally(2, 2), "saucer": Tally(2, 2)}
    >>> concept = CountedConcept(layout_concept(script, "tea-1"), ("tea-1", "tea-2"), (on_both,), roles)
    >>> concept, concept.summary(), concept.optional
    (<CountedConcept 'tea' on 2 tables: 2 roles, 1 statement>, "'tea' on 2 tables: 2 roles, 1 statement", frozenset())
    >>> print(concept.script(script.ontology).strip())
    layout tea
    <BLANKLINE>
    cup on saucer
    <BLANKLINE>
    # 2 tables: tea-1, tea-2
    # on(cup, saucer): held on 2 of 2 tables
    >>> list(concept.lines())[1]
    'on(cup, saucer): held on 2 of 2 tables'
    >>> shapes, axioms = list(concept.shapes()), list(concept.owl(script.ontology.relations))
    >>> len(shapes) > 10, len(axioms) > 10
    (True, True)
    """

    layout: LayoutConcept
    lessons: tuple[str, ...]
    statements: tuple[Counted, ...]
    filled: Mapping[str, Tally]

    def summary(self) -> str:
        """Return the name of the layout, and the numbers of its tables, roles and statements."""
        roles, statements = count(len(self.layout.roles), "role"), count(len(self.statements), "statement")
        return f"'{self.layout.name}' on {count(len(self.lessons), 'table')}: {roles}, {statements}"

    @property
    def optional(self) -> frozenset[str]:
        """Roles that were not on every table."""
        return frozenset(role for role, tally in self.filled.items() if tally.held < tally.of)

    @checks_arguments
    def script(self, ontology: Ontology) -> str:
        """Return the layout as a script; with several tables, comments at its end give the counts.

        Parameters
        ----------
        ontology
            Words of the language.

        Returns
        -------
        str
            The text of the script.
        """
        text = layout_script(self.layout, ontology)
        if len(self.lessons) < MIN_TABLES:
            return text
        return text + "\n" + "".join(f"# {line}\n" for line in self.lines())

    def lines(self) -> Iterator[str]:
        """Yield the counts as lines of text.

        Yields
        ------
        str
            A line for the tables, one for each statement, and one for each optional role.
        """
        yield f"{count(len(self.lessons), 'table')}: {', '.join(self.lessons)}"
        yield from map(str, self.statements)
        for role in sorted(self.optional):
            yield f"{role}: on {self.filled[role].held:g} of {self.filled[role].of:g} tables"

    def shapes(self) -> Iterator[ox.Triple]:
        """Yield the SHACL shapes of the layout, described by the counts.

        Yields
        ------
        ox.Triple
            A triple; severity is that of the weight, and of what is optional.
        """
        facts = [each for each in self.statements if isinstance(each.statement, Fact)]
        claims = [each for each in self.statements if isinstance(each.statement, Claim)]
        notes = {f"fact-{place}": str(each) for place, each in enumerate(facts, 1)}
        notes |= {f"claim-{place}": str(each) for place, each in enumerate(claims, 1)}
        notes |= {f"role-{role}": f"on {t.held:g} of {t.of:g} tables" for role, t in self.filled.items()}
        return layout_shapes(self.layout, self.optional, notes)

    @checks_arguments
    def owl(self, relations: Relations) -> Iterator[ox.Triple]:
        """Yield the OWL class of the layout with its roles and statements; optional things are not required.

        Parameters
        ----------
        relations
            Relations of the ontology.

        Yields
        ------
        ox.Triple
            A triple.
        """
        return layout_triples(self.layout, relations, self.optional)


def concept_of(tables: Sequence[TaughtTable], relations: Relations) -> CountedConcept:
    """Return the concept of the tables of one layout.

    Parameters
    ----------
    tables
        One or more tables of one layout, in any order.
    relations
        Relations of the ontology.

    Returns
    -------
    CountedConcept
        The layout with its counts. From one table it is the layout of the lesson.
    """
    united = _united(tables)
    seen = _Tables(tables, relations)
    filled = {role.name: seen.experience.filled.get(role.name, Tally()) for role in united.roles}
    optional = {role for role, tally in filled.items() if tally.held < tally.of}
    statements = [Counted(fact, seen.held(fact), True) for fact in united.facts]
    if len(tables) >= MIN_TABLES:
        statements = [replace(each, statement=_weighed(each, optional)) for each in statements]
        firm = [each.statement for each in statements if isinstance(each.statement, Fact) and _is_firm(each.statement)]
        statements += seen.unstated([role.name for role in united.roles], firm, list(united.facts), optional)
        statements += seen.distances(united)
    statements += [Counted(claim, Tally(), True) for claim in united.claims]
    facts = tuple(each.statement for each in statements if isinstance(each.statement, Fact))
    claims = tuple(each.statement for each in statements if isinstance(each.statement, Claim))
    several = len(tables) >= MIN_TABLES
    layout = replace(united, lesson=united.name if several else united.lesson, facts=facts, claims=claims)
    return CountedConcept(layout, tuple(sorted(table.lesson for table in tables)), tuple(statements), filled)


def _united(tables: Sequence[TaughtTable]) -> LayoutConcept:
    """Return a layout with everything that any lesson stated, the fullest description first."""
    fullest = sorted(tables, key=lambda each: (-len(each.layout.roles), -len(each.layout.facts), each.script_text))
    roles: dict[str, Role] = {}
    facts: dict[tuple[str, tuple[str, ...], str, bool], Fact] = {}
    claims: dict[str, Claim] = {}
    for table in fullest:
        for role in table.layout.roles:
            roles.setdefault(role.name, role)
        for fact in table.layout.facts:
            key = (fact.subject, tuple(r.name for r in fact.relations), fact.object, fact.positive)
            facts.setdefault(key, fact)
        for claim in table.layout.claims:
            claims.setdefault(str(claim), claim)
    first = fullest[0].layout
    together = [set(map(frozenset, table.layout.interchangeable)) for table in tables]
    alike = sorted(tuple(sorted(group)) for group in set.intersection(*together))
    return replace(
        first,
        roles=tuple(roles.values()),
        facts=tuple(facts.values()),
        claims=tuple(claims.values()),
        interchangeable=tuple(alike),
    )


def _weighed(counted: Counted, optional: set[str]) -> Fact | Claim:
    """Return a statement with the weight that its counts give it."""
    fact, tally = counted.statement, counted.tally
    weight = fact.weight
    if tally.of and (tally.held < tally.of or (weight < 1 and tally.of >= MIN_TABLES)):
        weight = round(tally.probability, 3)
    loose = isinstance(fact, Fact) and bool({fact.subject, fact.object} & optional)
    return replace(fact, weight=weight, optional=fact.optional or loose)


def _is_firm(fact: Fact) -> bool:
    return fact.positive and not fact.optional and fact.weight >= 1


class _Tables:
    """The tables of one layout whose boxes are in metres, and what held on them."""

    def __init__(self, tables: Sequence[TaughtTable], relations: Relations) -> None:
        self._relations = relations
        self._things = [
            {role: table.scene[thing] for role, thing in table.things.items()} for table in tables if table.is_measured
        ]
        self.experience = sum((table.experience(relations) for table in tables), Experience())

    @cached_property
    def _named(self) -> list[dict[tuple[str, str], int]]:
        """Exact relation of each pair of roles, for each table."""
        found = []
        for things in self._things:
            names = sorted(things)
            pairs: dict[tuple[str, str], int] = {}
            if len(names) > 1:
                boxes = np.array([(things[name].minimum, things[name].maximum) for name in names])
                exact = box_relations(boxes, self._relations, TOLERANCE).names
                pairs = {(a, b): int(exact[i, j]) for i, a in enumerate(names) for j, b in enumerate(names) if i != j}
            found.append(pairs)
        return found

    def held(self, fact: Fact) -> Tally:
        """Return on how many tables a fact held; words that only models know are not compared."""
        if any(relation.reading not in (Reading.WIDE, Reading.EXACT) for relation in fact.relations):
            return Tally()
        rows = [self._relations.degrees[relation.index] for relation in fact.relations]
        names = [pairs[fact.subject, fact.object] for pairs in self._named if (fact.subject, fact.object) in pairs]
        held = sum(any(row[name] > 0 for row in rows) == fact.positive for name in names)
        return Tally(float(held), float(len(names)))

    def unstated(
        self, roles: Sequence[str], firm: Sequence[Fact], united: Sequence[Fact], optional: set[str]
    ) -> list[Counted]:
        """Return the relations that held on every table and do not follow from the words or from each other."""
        implied = Implications(RelationGraph.from_facts(self._relations, roles, firm), cases=False)
        known = {(relation.name, a, b) for relation, a, b in implied.triples()}
        known |= {(relation.name, fact.subject, fact.object) for fact in united for relation in fact.relations}
        found = []
        for word in COMPARED:
            relation: Relation = self._relations[word]
            always = {
                (a, b): tally
                for (name, a, b), tally in self.experience.held.items()
                if name == word and tally.held == tally.of >= MIN_TABLES and a in roles and b in roles
            }
            for (a, b), tally in sorted(always.items()):
                between = any((a, c) in always and (c, b) in always for c in roles)
                stated = (word, a, b) in known or (relation.inverse, b, a) in known
                if not between and not stated:
                    weight, loose = round(tally.probability, 3), bool({a, b} & optional)
                    fact = Fact(a, (relation,), b, optional=loose, weight=weight)
                    found.append(Counted(fact, tally, False))
        return found

    def distances(self, united: LayoutConcept) -> list[Counted]:
        """Return the distances of things that a stated fact relates, where they hardly vary."""
        stated = {
            frozenset((*claim.subjects, *claim.arguments))
            for claim in united.claims
            if claim.relation.startswith("distance")
        }
        pairs = {tuple(sorted((f.subject, f.object))) for f in united.facts if f.positive and f.subject != f.object}
        found = []
        for a, b in sorted(pairs):
            gaps = np.array([_gap(things[a], things[b]) for things in self._things if a in things and b in things])
            if len(gaps) < MIN_TABLES or frozenset((a, b)) in stated:
                continue
            mean = round(float(np.exp(np.log(np.maximum(gaps, 1e-4)).mean())), 3)
            same = (gaps <= mean * DISTANCE_RATIO) & (gaps >= mean / DISTANCE_RATIO)
            if mean >= MIN_DISTANCE and same.all():
                tally = Tally(float(same.sum()), float(len(gaps)))
                claim = Claim("distance", (a,), (b,), metres=mean, weight=round(tally.probability, 3))
                found.append(Counted(claim, tally, False))
        return found


def _gap(first: PerceivedObject, second: PerceivedObject) -> float:
    """Return the distance of the outlines of two things on the table, in metres."""
    low, high = (np.array([getattr(one, side)[:2] for one in (first, second)]) for side in ("minimum", "maximum"))
    return float(np.hypot(*np.maximum(np.maximum(low[0] - high[1], low[1] - high[0]), 0.0)))
