"""Search the fluents of a blackboard by what they say, by when they start, hold or finish, and by what came and went.

A :class:`FluentSearch` is evaluated on the blackboard, and written as SPARQL over the graph of fluents; both give the
same fluents.
"""

from __future__ import annotations

import json
import math
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from typing import Protocol

from deixis.memory.episodes.experiences import Holding
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin
from deixis.memory.episodes.rdf.observations import EP, SOSA, predicate_iri, resource_iri, thing_iri
from deixis.memory.semantic.rdf.graphs import FLUENTS
from deixis.reasoning.temporal.fluent import Pattern

MAX_LOOKUPS = 20
"""Number of subjects up to which their fluents are looked up one by one, rather than in one pass over all."""


class Episodes(Holding, Protocol):
    """Fluents of a memory: a blackboard, or the board of a module."""

    @property
    def origin(self) -> datetime:
        """Time from which the memory counts seconds."""
        ...


class Edge(Enum):
    """Role of a fluent in the window of a search: it holds, starts or finishes there."""

    HOLDS = "holds"
    STARTS = "starts"
    FINISHES = "finishes"


class Pick(Enum):
    """Choice among the fluents found: all, or those of which none was certainly earlier or later."""

    ALL = "all"
    FIRST = "first"
    LAST = "last"


class Event(Enum):
    """A change of the presence of a subject that a start or a finish must be."""

    COMES = "comes"
    GOES = "goes"
    MOVES = "moves"


@dataclass(frozen=True)
class FluentSearch:
    """A search of fluents; None matches everything.

    Parameters
    ----------
    subjects, objects
        Names of things.
    predicates
        Names of predicates.
    origins
        Ways in which a fluent became known.
    by
        Names of the modules or persons that state it.
    edge
        What happens in the window.
    start, end
        Ends of the window in seconds since the origin of the memory, which belong to it.
    pick
        The earliest or latest, by the edge: by starts, or by finishes.
    event
        What a start or finish must be: the subject comes (no other fluent of ``places`` held before), goes (none holds
        after), or moves (another one held before).
    places
        Predicates that say where a thing is, for ``event``.
    ids
        Ids of fluents.
    words
        Words of which the object, a text that is not a question, has one, in any case.
    """

    subjects: frozenset[str] | None = None
    predicates: frozenset[str] | None = None
    objects: frozenset[str] | None = None
    origins: frozenset[Origin] | None = None
    by: frozenset[str] | None = None
    edge: Edge = Edge.HOLDS
    start: float = -math.inf
    end: float = math.inf
    pick: Pick = Pick.ALL
    event: Event | None = None
    places: frozenset[str] = frozenset()
    ids: frozenset[str] | None = None
    words: frozenset[str] | None = None

    def run(self, board: Episodes) -> tuple[EpisodicFluent, ...]:
        """Return the fluents that the search finds.

        Parameters
        ----------
        board
            The blackboard.

        Returns
        -------
        tuple of EpisodicFluent
            The fluents in the order of their earliest starts and then ids.
        """
        found = [each for each in self._candidates(board) if self._matches(each)]
        if self.event is not None:
            found = self._events(found, board)
        return tuple(self._picked(found))

    def _candidates(self, board: Episodes) -> Iterable[EpisodicFluent]:
        if self.subjects is None:
            at_any_time = self.edge is not Edge.HOLDS
            return board.holding() if at_any_time else board.holding(start=self.start, end=self.end)
        found = (each for name in sorted(self.subjects) for each in board.holding(Pattern(name)))
        return sorted(found, key=lambda each: (each.start.lower, each.id))

    def _matches(self, found: EpisodicFluent) -> bool:
        statement, source = found.statement, found.source
        return (
            (self.subjects is None or statement.subject in self.subjects)
            and (self.predicates is None or statement.predicate in self.predicates)
            and (self.objects is None or statement.object in self.objects)
            and (self.origins is None or source.origin in self.origins)
            and (self.by is None or source.by in self.by)
            and (self.ids is None or found.id in self.ids)
            and (self.words is None or self._has_word(statement.object or "?"))
            and self._is_in_window(found)
        )

    def _has_word(self, text: str) -> bool:
        return not text.endswith("?") and re.search(self._word_pattern(), text, re.IGNORECASE) is not None

    def _word_pattern(self) -> str:
        """Return a pattern of any of the words, in the notation that Python and SPARQL share."""
        return rf"(^|[^a-z])({'|'.join(map(re.escape, sorted(self.words or ())))})([^a-z]|$)"

    def _is_in_window(self, found: EpisodicFluent) -> bool:
        start, finish = found.start, found.finish
        if self.edge is Edge.HOLDS:
            return start.lower <= self.end and finish.upper > self.start
        if self.edge is Edge.STARTS:
            return start.lower > -math.inf and start.lower <= self.end and start.upper >= self.start
        return finish.upper < math.inf and finish.lower <= self.end and finish.upper >= self.start

    def _events(self, found: Sequence[EpisodicFluent], board: Episodes) -> list[EpisodicFluent]:
        """Return the fluents with which their subjects come, go or move."""
        by_subject: dict[str, list[EpisodicFluent]] = defaultdict(list)
        for each in self._all_of({each.statement.subject for each in found}, board):
            if each.statement.predicate in self.places:
                by_subject[each.statement.subject].append(each)
        return [each for each in found if self._is_event(each, by_subject[each.statement.subject])]

    def _all_of(self, subjects: set[str], board: Episodes) -> Iterator[EpisodicFluent]:
        """Yield all fluents of some subjects: one by one where they are few, else in one pass."""
        if len(subjects) <= MAX_LOOKUPS:
            for name in subjects:
                yield from board.holding(Pattern(name))
        else:
            yield from (each for each in board.holding() if each.statement.subject in subjects)

    def _is_event(self, found: EpisodicFluent, places: Sequence[EpisodicFluent]) -> bool:
        others = (each for each in places if each.id != found.id)
        if self.event is Event.GOES:
            after = found.finish.upper
            return not any(each.start.lower <= after < each.finish.upper for each in others)
        before = found.start.lower
        held = any(each.start.lower < before <= each.finish.upper for each in others)
        return held if self.event is Event.MOVES else not held

    def _picked(self, found: Sequence[EpisodicFluent]) -> Iterator[EpisodicFluent]:
        """Yield the fluents of which no other was certainly earlier (for the first) or later (for the last)."""
        ends = [each.finish if self.edge is Edge.FINISHES else each.start for each in found]
        first = min((end.upper for end in ends), default=0.0)
        last = max((end.lower for end in ends), default=0.0)
        for each, end in zip(found, ends, strict=True):
            if (self.pick is not Pick.FIRST or end.lower <= first) and (
                self.pick is not Pick.LAST or end.upper >= last
            ):
                yield each

    def sparql(self) -> str:
        """Return a query over a memory that finds the same fluents, with their times and sources.

        Returns
        -------
        str
            A SELECT query, of which ``?id`` has the ids of the fluents.
        """
        filters = [f"FILTER({condition})" for condition in self._conditions("")]
        if self.event is not None:
            filters.append(self._event_filter())
        if self.pick is not Pick.ALL:
            end = "Finish" if self.edge is Edge.FINISHES else "Start"
            earlier = (
                f"?latest{end}2 < ?earliest{end}" if self.pick is Pick.FIRST else f"?earliest{end}2 > ?latest{end}"
            )
            rivals = [f"FILTER({condition})" for condition in (*self._conditions("2"), earlier)]
            if self.event is not None:
                rivals.append(self._event_filter("2"))
            filters.append(f"FILTER NOT EXISTS {{ {self._pattern('2')} {' '.join(rivals)} }}")
        lines = "\n  ".join((self._pattern("", "\n  "), *filters))
        chosen = "?id ?subject ?predicate ?object ?earliestStart ?latestStart ?earliestFinish ?latestFinish"
        return (
            f"PREFIX ep: <{EP}>\nPREFIX sosa: <{SOSA}>\nPREFIX prov: <http://www.w3.org/ns/prov#>\n"
            f"PREFIX xsd: <http://www.w3.org/2001/XMLSchema#>\n"
            f"SELECT {chosen} ?certainty ?origin ?by WHERE {{ GRAPH <{FLUENTS.value}> {{\n  {lines}\n}} }}\n"
            "ORDER BY ?earliestStart ?id"
        )

    def _pattern(self, number: str, between: str = " ") -> str:
        """Return the description of a fluent, whose variables end in a number."""
        parts = []
        if self.ids is not None:
            parts.append(f"VALUES ?id{number} {{ {' '.join(map(json.dumps, sorted(self.ids)))} }}")
        if self.subjects is not None:
            parts.append(_values(f"?subject{number}", (thing_iri(name).value for name in sorted(self.subjects))))
        if self.predicates is not None:
            parts.append(
                _values(f"?predicate{number}", (predicate_iri(name).value for name in sorted(self.predicates)))
            )
        if self.objects is not None:
            parts.append(_values(f"?object{number}", (thing_iri(name).value for name in sorted(self.objects))))
        parts.append(
            f"?fluent{number} ep:identifier ?id{number} ; sosa:hasFeatureOfInterest ?subject{number} ; "
            f"sosa:observedProperty ?predicate{number} ; ep:certainty ?certainty{number} ; ep:origin ?origin{number} ; "
            f"prov:wasAttributedTo ?by{number} ."
        )
        result = f"?fluent{number} sosa:hasResult|sosa:hasSimpleResult ?object{number} ."
        parts.append(f"OPTIONAL {{ {result} }}" if self.objects is None else result)
        parts += _times(number)
        return between.join(parts)

    def _conditions(self, number: str) -> Iterator[str]:
        if self.origins is not None:
            names = ", ".join(f'"{origin.value}"' for origin in sorted(self.origins, key=lambda each: each.value))
            yield f"?origin{number} IN ({names})"
        if self.by is not None:
            names = ", ".join(f"<{resource_iri('agent', name).value}>" for name in sorted(self.by))
            yield f"?by{number} IN ({names})"
        if self.words is not None:
            text = f"STR(?object{number})"
            yield f'!STRENDS({text}, "?") && REGEX({text}, {json.dumps(self._word_pattern())}, "i")'
        first, last = _number(self.start), _number(self.end)
        if self.edge is Edge.HOLDS:
            yield f"?earliestStart{number} <= {last} && ?latestFinish{number} > {first}"
        elif self.edge is Edge.STARTS:
            yield f"?earliestStart{number} > {_number(-math.inf)}"
            yield f"?earliestStart{number} <= {last} && ?latestStart{number} >= {first}"
        else:
            yield f"?latestFinish{number} < {_number(math.inf)}"
            yield f"?earliestFinish{number} <= {last} && ?latestFinish{number} >= {first}"

    def _event_filter(self, number: str = "") -> str:
        places = _values("?place", (predicate_iri(name).value for name in sorted(self.places)))
        other = (
            f"{places} ?other ep:identifier ?otherId ; sosa:hasFeatureOfInterest ?subject{number} ; "
            f"sosa:observedProperty ?place . {' '.join(_times('', 'other'))} FILTER(?otherId != ?id{number}"
        )
        if self.event is Event.GOES:
            after = f"?latestFinish{number}"
            return f"FILTER NOT EXISTS {{ {other} && ?otherEarliestStart <= {after} && {after} < ?otherLatestFinish) }}"
        before = f"?earliestStart{number}"
        exists = "EXISTS" if self.event is Event.MOVES else "NOT EXISTS"
        return f"FILTER {exists} {{ {other} && ?otherEarliestStart < {before} && {before} <= ?otherLatestFinish) }}"


def _times(number: str, other: str = "") -> list[str]:
    """Return the parts of a query that read the bounds of a fluent, an unknown one as an infinite number."""
    parts = []
    for name, unknown in (
        ("earliestStart", -math.inf),
        ("latestStart", math.inf),
        ("earliestFinish", -math.inf),
        ("latestFinish", math.inf),
    ):
        node = f"?{other}" if other else f"?fluent{number}"
        variable = f"?{other}{name[0].upper()}{name[1:]}" if other else f"?{name}{number}"
        raw = f"?{other or 'known'}{name[0].upper()}{name[1:]}Known{number}"
        parts.append(f"OPTIONAL {{ {node} ep:{name} {raw} }} BIND(COALESCE({raw}, {_number(unknown)}) AS {variable})")
    return parts


def _values(variable: str, iris: Iterable[str]) -> str:
    return f"VALUES {variable} {{ {' '.join(f'<{iri}>' for iri in iris)} }}"


def _number(value: float) -> str:
    if math.isinf(value):
        return f'"{"-" if value < 0 else ""}INF"^^xsd:double'
    return f'"{value!r}"^^xsd:double'
