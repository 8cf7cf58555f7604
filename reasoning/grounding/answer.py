"""The types of an answer: who is who, and everything that qualifies it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, count
from deixis.ontology.graph import Fact
from deixis.ontology.lessons.types import Alternative, Match
from deixis.ontology.relation import Relation

if TYPE_CHECKING:
    import networkx as nx

    from deixis.reasoning.grounding.hypotheses import Side
    from deixis.reasoning.grounding.questions.inquiry import Exchange
    from deixis.reasoning.grounding.viewpoint import Viewpoint


class Standing(StrEnum):
    """What the probabilities of an answer are worth."""

    NONE = "none"  # the engine gives none
    EXACT = "exact"  # from all maps that count
    SAMPLED = "sampled"  # an approximation, with an error that independent chains tell
    BELIEVED = "believed"  # belief propagation: an approximation of which no error is known


class Outcome(StrEnum):
    """What became of a stated fact."""

    SATISFIED = "satisfied"  # holds of the matched pair, at least widely
    VIOLATED = "violated"  # does not hold of the matched pair
    WAIVED = "waived"  # does not hold, and was optional
    OPEN = "open"  # an object of it is not matched


@dataclass(frozen=True, slots=True)
class FactOutcome:
    """A stated fact, what became of it, and the exact relation perceived instead or accordingly."""

    fact: Fact
    outcome: Outcome
    degree: float
    perceived: tuple[str, str] | None
    seen: Relation | None


@dataclass(frozen=True, slots=True)
class LeftOut:
    """An object or a perceived thing without a counterpart, and why; what an object could be all the same."""

    name: str
    reason: str
    alternatives: tuple[Alternative, ...] = ()


@dataclass(frozen=True, slots=True)
class Pivotal:
    """A fact without which the answer would be another.

    ``changes`` are the objects that would be something else then (None: not there), ``unsettled`` those that would no
    longer be decided, ``settled`` those that only then would be.
    """

    fact: Fact
    changes: Mapping[str, str | None]
    unsettled: tuple[str, ...]
    settled: tuple[str, ...]


@dataclass(frozen=True, repr=False)
class Grounding(Answer):
    """The answer of an engine, with all that qualifies it.

    ``probabilities`` says what those of the matches are worth, and ``probability_error`` by how much they may be off.
    ``fits`` is the probability that the description is of this scene at all, from whichever side; None of engines
    without a posterior. ``sides`` are those from which it may speak, with probabilities that add up to ``fits``.
    ``pivotal`` is None where it was not looked for what would change without a fact, as where the description is taken
    to be of another scene. ``finished`` says whether the engine came to its end within the time limit. By ``gap``
    (nats) another answer may be likelier at most: 0 where this one is proved the best, infinite where the engine has no
    bound. ``exchanges`` are the questions that were asked, with their answers, and ``viewpoints`` those from which the
    script may speak, most probable first, where they were to be recovered; None where that was not wanted. ``scene`` is
    the scene that was grounded in, for pictures; None where an engine was called directly.
    """

    engine: str
    matches: Mapping[str, Match]
    unmatched_objects: tuple[LeftOut, ...]
    unmatched_perceived: tuple[LeftOut, ...]
    interchangeable: tuple[tuple[str, ...], ...]
    graph_similarity: float
    outcomes: tuple[FactOutcome, ...]
    proved_best: bool
    converged: bool
    notes: tuple[str, ...]
    seconds: float
    pivotal: tuple[Pivotal, ...] | None = None
    probabilities: Standing = Standing.NONE
    probability_error: float = 0.0
    fits: float | None = None
    sides: tuple[tuple[Side, float], ...] = ()
    finished: bool = True
    gap: float = math.inf
    exchanges: tuple[Exchange, ...] | None = None
    viewpoints: tuple[Viewpoint, ...] | None = None
    scene: object | None = field(default=None, compare=False)

    def summary(self) -> str:
        """Return how many objects were found and decided, and whether the description fits."""
        objects = len(self.matches) + len(self.unmatched_objects)
        decided = sum(match.decided for match in self.matches.values())
        parts = [f"{len(self.matches)} of {count(objects, 'object')} matched", f"{decided} decided"]
        parts.append(f"{len(self.satisfied)} of {count(len(self.outcomes), 'fact')} satisfied")
        if self.fits is not None:
            parts.append(f"fits {self.fits:.2f}")
        return ", ".join(parts)

    def of(self, outcome: Outcome) -> tuple[FactOutcome, ...]:
        return tuple(entry for entry in self.outcomes if entry.outcome is outcome)

    def to_networkx(self) -> nx.MultiDiGraph[Any]:
        """Return the answer as a ``networkx.MultiDiGraph`` over objects, things and what relates them.

        Returns
        -------
        networkx.MultiDiGraph
            Nodes are ``("object", name)`` and ``("thing", id)``, with ``matched``, and ``reason`` where they are left
            out. Edges have the attribute ``kind``: a ``match`` from an object to its thing, with ``probability`` (or
            None), ``similarity``, ``score`` and ``decided``; an ``alternative`` from an object to another thing that it
            could be, with ``probability`` (or None) and ``cost``; and a ``fact`` from its subject to its object, with
            ``relations`` (names), ``positive``, ``weight``, ``outcome``, ``degree`` and ``source``.

        Examples
        --------
        >>> import deixis
        >>> scene = {"objects": [{"id": id, "min": [x, 0.0], "max": [x + 0.1, 0.1]} for id, x in (("p", 0), ("q", 1))]}
        >>> graph = deixis.ground(deixis.read_script(text="cup left of mug"), scene).to_networkx()
        >>> [(a[1], b[1], edge) for a, b, edge in graph.edges(data="kind") if edge != "alternative"]
        [('cup', 'mug', 'fact'), ('cup', 'p', 'match'), ('mug', 'q', 'match')]
        """
        import networkx as nx

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph(engine=self.engine, graph_similarity=self.graph_similarity)
        for entry in self.outcomes:
            fact = entry.fact
            graph.add_edge(
                ("object", fact.subject),
                ("object", fact.object),
                kind="fact",
                relations=tuple(relation.name for relation in fact.relations),
                positive=fact.positive,
                weight=fact.weight,
                outcome=entry.outcome.value,
                degree=entry.degree,
                source=str(fact.source) if fact.source else None,
            )
        could_be = {name: match.alternatives for name, match in self.matches.items()}
        could_be |= {left.name: left.alternatives for left in self.unmatched_objects}
        for name, match in self.matches.items():
            graph.add_node(("object", name), matched=True)
            graph.add_node(("thing", match.perceived), matched=True)
            graph.add_edge(
                ("object", name),
                ("thing", match.perceived),
                kind="match",
                probability=match.probability,
                similarity=match.similarity,
                score=match.score,
                decided=match.decided,
            )
        for what, left_out in (("object", self.unmatched_objects), ("thing", self.unmatched_perceived)):
            graph.add_nodes_from(((what, left.name), {"matched": False, "reason": left.reason}) for left in left_out)
        for name, others in could_be.items():
            for other in others:
                if other.perceived is not None:
                    given = {"probability": other.probability, "cost": other.cost}
                    graph.add_edge(("object", name), ("thing", other.perceived), kind="alternative", **given)
        return graph

    @property
    def satisfied(self) -> tuple[FactOutcome, ...]:
        return self.of(Outcome.SATISFIED)

    def noting(self, notes: tuple[str, ...]) -> Grounding:
        """Return the same answer with notes before its own."""
        return replace(self, notes=notes + self.notes)

    @property
    def violated(self) -> tuple[FactOutcome, ...]:
        return self.of(Outcome.VIOLATED)
