"""Types of a grounding: the matches, with their probabilities, alternatives and the outcome of each fact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.ontology.graph.graph import Fact
from deixis.ontology.lessons.types import Alternative, Match
from deixis.ontology.relations.relation import Relation
from deixis.reasoning.grounding.reference.answer import Frame

if TYPE_CHECKING:
    import networkx as nx

    from deixis.reasoning.grounding.answers.claims import ClaimOutcome
    from deixis.reasoning.grounding.hypotheses.hypotheses import Side
    from deixis.reasoning.grounding.hypotheses.viewpoint import Viewpoint
    from deixis.reasoning.grounding.questions.inquiry import Exchange


class Standing(StrEnum):
    """Quality of the probabilities of an answer."""

    NONE = "none"  # the engine computes no probabilities
    EXACT = "exact"  # summed over all maps that matter
    SAMPLED = "sampled"  # approximate, with an error estimated from independent chains
    PROPAGATED = "propagated"  # approximate, from belief propagation, with an unknown error


class Outcome(StrEnum):
    """Outcome of a stated fact."""

    SATISFIED = "satisfied"  # the matched pair fulfils the fact, at least in the wide reading
    VIOLATED = "violated"  # the matched pair does not fulfil the fact
    WAIVED = "waived"  # the matched pair does not fulfil the fact, which was optional
    OPEN = "open"  # an object of the fact is not matched


@dataclass(frozen=True, slots=True)
class FactOutcome:
    """A stated fact, its outcome, and the relation that was perceived between the matched things.

    Attributes
    ----------
    fact
        The fact as stated.
    outcome
        Whether it holds of the matched pair.
    degree
        Degree to which it holds, in [0, 1].
    perceived
        The matched things; None where an object is not matched.
    seen
        The exact relation between the matched things; None where an object is not matched.
    """

    fact: Fact
    outcome: Outcome
    degree: float
    perceived: tuple[str, str] | None
    seen: Relation | None


@dataclass(frozen=True, slots=True)
class FrameOfFact:
    """Frame of reference in which a stated direction was taken, for the things that its objects are matched to.

    ``probability`` is that of the frame among those in which the direction may be meant.
    """

    fact: Fact
    frame: Frame
    probability: float


@dataclass(frozen=True, slots=True)
class LeftOut:
    """An object or a perceived thing without a match, the reason, and (of an object) what it could still be."""

    name: str
    reason: str
    alternatives: tuple[Alternative, ...] = ()


@dataclass(frozen=True, slots=True)
class Member:
    """A perceived thing that belongs to a group of unknown number, with the probability that it does."""

    perceived: str
    probability: float


@dataclass(frozen=True, slots=True)
class Pivotal:
    """A fact without which the answer would be different.

    Attributes
    ----------
    fact
        The fact.
    changes
        Objects that would be matched to another thing without the fact, each with that thing (None: not matched).
    unsettled
        Objects that would no longer be decided without the fact.
    settled
        Objects that would be decided only without the fact.
    """

    fact: Fact
    changes: Mapping[str, str | None]
    unsettled: tuple[str, ...]
    settled: tuple[str, ...]


@dataclass(frozen=True, repr=False)
class Grounding(Answer):
    """Result of grounding a description in a scene: the matches, and how certain they are.

    Attributes
    ----------
    engine
        Name of the engine.
    matches
        Matches by the name of the object.
    unmatched_objects, unmatched_perceived
        Objects and perceived things without a match, with the reasons.
    interchangeable
        Groups of objects that the description cannot tell apart.
    graph_similarity
        Overall similarity of the two graphs by the paper's measure, in [0, 1].
    outcomes
        Outcome of each fact that can be compared, in the order in which the facts were stated.
    claims
        Outcomes of the claims (places, distances, arrangements and others), in the order in which they were stated.
    proved_best
        Whether the engine proved that no map is likelier.
    converged
        Whether the iteration of the paper's similarity converged.
    notes
        Remarks for the user, such as a time limit that was reached.
    seconds
        Time that grounding took.
    pivotal
        Facts without which the answer would be different; None where this was not computed, for example because the
        description is probably of another scene.
    probabilities
        Quality of the probabilities of the matches.
    probability_error
        Largest error of these probabilities.
    fits
        Probability that the description is of this scene, from any side; None for engines without a posterior.
    sides
        Sides from which the description may be spoken, with probabilities that add up to ``fits``.
    finished
        Whether the engine finished within the time limit.
    gap
        Upper bound, in nats, on how much likelier another map may be: 0 where ``proved_best``, infinite where the
        engine has no bound.
    exchanges
        Questions that were asked, with their answers; None where asking was not requested.
    viewpoints
        Viewpoints from which the script may be spoken, most probable first; None where their recovery was not
        requested.
    frames
        Frames of reference of the stated directions, in the order in which they were stated.
    surface
        Name among ``matches`` of the surface that the objects stand on, which is not an object; None where the scene
        does not have it.
    scene
        The scene, for pictures; None where an engine was called directly.
    members
        Members of each group of unknown number (*the chairs*) by its name, the most probable first. The match of the
        group is one of them.

    Examples
    --------
    >>> import deixis
    >>> script = deixis.read_script(text="fork left of plate")
    >>> scene = deixis.read_scene({"objects": [
    ...     {"id": "o1", "min": [0, 0], "max": [0.03, 0.2]}, {"id": "o2", "min": [0.1, 0], "max": [0.35, 0.25]}]})
    >>> found = deixis.ground(script, scene)
    >>> found
    <Grounding 2 of 2 objects matched, 2 decided, 1 of 1 fact satisfied, fits 1.00>
    >>> found.matches["plate"], found.fits > 0.99, found.proved_best
    (<Match plate is o2, probability 0.995>, True, True)
    >>> [str(entry.fact) for entry in found.satisfied], found.violated, found.of(Outcome.OPEN)
    (['left(fork, plate)'], (), ())
    >>> list(found.object_matches), found.noting(("a remark",)).notes[0]
    (['fork', 'plate'], 'a remark')
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
    frames: tuple[FrameOfFact, ...] = ()
    claims: tuple[ClaimOutcome, ...] = ()
    scene: object | None = field(default=None, compare=False)
    surface: str | None = None
    members: Mapping[str, tuple[Member, ...]] = field(default_factory=dict)

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"matches": dict(self.matches)}  # a read-only view cannot be pickled

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state | {"matches": MappingProxyType(state["matches"])})

    @property
    def object_matches(self) -> Mapping[str, Match]:
        """Matches of the objects, without that of the surface."""
        return {name: match for name, match in self.matches.items() if name != self.surface}

    def summary(self) -> str:
        """Return how many objects are matched and decided, and how probably the description fits the scene."""
        matched = self.object_matches
        objects = len(matched) + len(self.unmatched_objects)
        decided = sum(match.decided for match in matched.values())
        parts = [f"{len(matched)} of {count(objects, 'object')} matched", f"{decided} decided"]
        parts.append(f"{len(self.satisfied)} of {count(len(self.outcomes), 'fact')} satisfied")
        if self.fits is not None and self.matches:
            parts.append(f"fits {self.fits:.2f}")
        return ", ".join(parts)

    @checks_arguments
    def of(self, outcome: Outcome) -> tuple[FactOutcome, ...]:
        """Return the facts with one outcome.

        Parameters
        ----------
        outcome
            Satisfied, violated, waived or open.

        Returns
        -------
        tuple of FactOutcome
            The facts in the order of the script, each with the perceived relation of its pair.
        """
        return tuple(entry for entry in self.outcomes if entry.outcome is outcome)

    def to_networkx(self) -> nx.MultiDiGraph[Any]:
        """Return the answer as a ``networkx.MultiDiGraph`` of objects, things, matches and facts.

        Returns
        -------
        networkx.MultiDiGraph
            Nodes are ``("object", name)`` and ``("thing", id)``, with the attribute ``matched``, and ``reason`` where
            they are not matched. Edges have the attribute ``kind``: a ``match`` from an object to its thing, with
            ``probability`` (or None), ``similarity``, ``score`` and ``decided``; an ``alternative`` from an object to
            another thing that it could be, with ``probability`` (or None) and ``cost``; and a ``fact`` from its subject
            to its object, with ``relations`` (names), ``positive``, ``weight``, ``outcome``, ``degree`` and ``source``.

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
        """Facts that hold of the matched pairs."""
        return self.of(Outcome.SATISFIED)

    @checks_arguments
    def noting(self, notes: tuple[str, ...]) -> Grounding:
        """Return a copy of the answer with further notes.

        Parameters
        ----------
        notes
            Notes to put before those of the answer.

        Returns
        -------
        Grounding
            The copy.
        """
        return replace(self, notes=notes + self.notes)

    @property
    def violated(self) -> tuple[FactOutcome, ...]:
        """Facts that are not optional and do not hold of the matched pairs."""
        return self.of(Outcome.VIOLATED)
