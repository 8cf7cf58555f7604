"""Probabilities over all sides from which a script may speak."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate
from deixis.ontology.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.engine import Alignment
from deixis.reasoning.grounding.engines import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence, no_unary_evidence
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.viewpoint import FromSides, OtherSide, turned

MakeGraph = Callable[..., RelationGraph]
EXACT = engine_named("exact")


def seen(turns: int = 0) -> Evidence:
    """A table of six things from one of four sides."""
    table = generate(6, 1.5, seed=2)
    names = [f"o{i}" for i in range(6)]
    boxes = turned(table.boxes, turns * math.pi / 2)
    return no_unary_evidence(table.description(), scene_relations(names, boxes, default_ontology().relations))


def align(engine: FromSides, evidence: Evidence, seconds: float = 10.0) -> Alignment:
    return engine.align(evidence, Deadline.after(seconds))


def test_a_match_is_as_probable_as_it_is_from_all_sides() -> None:
    alone = [EXACT.align(seen(turns), Deadline.never()) for turns in (0, 1)]
    found = align(FromSides(EXACT, 0.7, (OtherSide(0.3, seen(1)),)), seen())
    assert found.assignment.tolist() == alone[0].assignment.tolist()
    assert all(one.posterior is not None for one in (found, *alone))
    expected = 0.7 * alone[0].posterior.marginals + 0.3 * alone[1].posterior.marginals  # type: ignore[union-attr]
    np.testing.assert_allclose(found.posterior.marginals, expected, atol=2e-3)  # type: ignore[union-attr]


def test_the_order_of_things_in_another_side_does_not_matter() -> None:
    rows, columns = np.array([2, 0, 1, 5, 4, 3]), np.array([5, 3, 1, 0, 2, 4])
    sides = [OtherSide(0.4, other) for other in (seen(1), seen(1).reordered(rows, columns))]
    found = [align(FromSides(EXACT, 0.6, (side,)), seen()).posterior for side in sides]
    np.testing.assert_allclose(found[0].marginals, found[1].marginals, atol=2e-3)  # type: ignore[union-attr]


def test_what_was_not_looked_at_adds_nothing() -> None:
    """With no time for the other side a match is at most as probable as the side from which it was seen."""
    problem, other = seen(), OtherSide(0.5, seen(2))
    other.evidence.problem  # noqa: B018 - so that its tables take no time of the search
    found = FromSides(Patient(), 0.5, (other,)).align(problem, Deadline.after(0.0))
    assert found.posterior is not None
    assert (found.posterior.marginals.sum(axis=1) <= 0.5 + 1e-9).all()
    assert any("looked from: 1, together 0.50 probable" in note for note in found.notes)


class Patient:
    """An engine that takes no notice of a deadline."""

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        return EXACT.align(evidence, Deadline.never())


def test_engines_without_probabilities_stay_without(graph_of: MakeGraph) -> None:
    engine = engine_named("blondel")
    found = align(FromSides(engine, 0.5, (OtherSide(0.5, seen(1)),)), seen())
    assert found.posterior is None
    assert found.assignment.tolist() == engine.align(seen(), Deadline.never()).assignment.tolist()


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_no_match_is_decided_that_is_another_from_a_probable_side(share: float) -> None:
    """Seen from behind, what was left is right: nothing may be called sure, however clear it is from here."""
    found = ground(seen(), FromSides(EXACT, share, (OtherSide(1 - share, seen(2)),)))
    other = EXACT.align(seen(2), Deadline.never())
    nodes, things = seen().description.nodes, seen().scene.nodes
    there = {
        name: None if p == UNMATCHED else things[p] for name, p in zip(nodes, other.assignment.tolist(), strict=True)
    }
    differing = [match for name, match in found.matches.items() if match.perceived != there[name]]
    assert differing
    assert not any(match.decided for match in differing)


def test_past_the_deadline_no_other_side_is_looked_from(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the facts say of the pairs there, which takes long in large scenes, is not even worked out."""

    def unwanted(*_: object) -> Evidence:
        raise AssertionError("looked from another side")

    monkeypatch.setattr(Evidence, "reordered", unwanted)
    others = tuple(OtherSide(0.2, seen(turns)) for turns in (1, 2))
    found = FromSides(Patient(), 0.6, others).align(seen(), Deadline.after(0.0))
    assert found.sides == 1
