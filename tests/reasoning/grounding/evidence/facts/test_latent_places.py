"""Facts about absent objects: the same evidence at a place as of a thing there, and absences that are recognised."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deixis.experiments.generated_tables import generate
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.evidence.evidence import Evidence, no_unary_evidence
from deixis.reasoning.grounding.evidence.facts import latent_places as module
from deixis.reasoning.grounding.evidence.facts.facts import FactEvidence
from deixis.reasoning.grounding.evidence.facts.latent_places import place_boxes, place_ratios
from deixis.reasoning.grounding.matching.problem import MIN_PLACES, UNMATCHED
from deixis.reasoning.grounding.matching.search.belief_propagation import beliefs_with_places


def evidence_of(objects: int, seed: int, facts: float = 5.0, missing: int = 0) -> tuple[Evidence, np.ndarray]:
    table = generate(objects, facts, missing=missing, extra=missing, seed=seed)
    return no_unary_evidence(table.description(), table.scene()), table.truth


def test_place_has_the_evidence_of_a_thing_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MIN_PLACES", 6)
    monkeypatch.setattr(module, "PLACES_PER_THING", 0.5)
    monkeypatch.setattr(module, "SIDE", 4)  # several blocks
    evidence, _ = evidence_of(9, 1)
    boxes = evidence.scene.boxes
    assert boxes is not None
    places = place_boxes(boxes)
    both = FactEvidence.of(evidence.description, np.concatenate([boxes, places]), everything=boxes)
    expected = np.exp(both.tables(0.1).tables)
    ratios = place_ratios(both.ratios.facts, boxes, 0.1, more_tables=1)
    k, n = len(expected), len(boxes)
    np.testing.assert_allclose(ratios[:k], expected[:, n:, :n], rtol=1e-4)
    np.testing.assert_allclose(ratios[k + 1 : -1], expected[:, :n, n:].swapaxes(1, 2), rtol=1e-4)
    assert (ratios[[k, -1]] == 1).all()


@pytest.mark.parametrize("depth", [2, 3])
def test_places_cover_the_scene_and_are_no_smaller_than_a_point(depth: int) -> None:
    low = np.random.default_rng(depth).uniform(0, 3, (40, 1, depth))
    boxes = np.concatenate([low, low + 0.1], axis=1)
    places = place_boxes(boxes)
    assert places.shape[1:] == (2, depth) and MIN_PLACES <= len(places) <= 2 * MIN_PLACES
    for axis in (0, 1):
        centres = boxes.mean(axis=1)[:, axis]
        assert places[:, 0, axis].min() < centres.min() and places[:, 1, axis].max() > centres.max()
    assert np.isfinite(place_boxes(np.zeros((1, 2, depth)))).all()


def test_absent_objects_are_recognised_by_their_places() -> None:
    absences = np.zeros((2, 2))  # (without and with places), (present and absent objects)
    for seed in (13, 14):
        evidence, truth = evidence_of(40, seed, missing=4)
        problem = evidence.problem
        assert problem.places is not None
        gone = truth[[int(name[1:]) for name in evidence.description.nodes]] == UNMATCHED
        for row, places in enumerate((None, problem.places())):
            absent = beliefs_with_places(problem.compiled, places)[0][:, -1]
            absences[row] += absent[~gone].mean() / 2, absent[gone].mean() / 2
    assert absences[1, 1] > absences[0, 1] + 0.2
    assert absences[1, 0] < 0.1


def test_scenes_without_boxes_have_no_places() -> None:
    evidence, _ = evidence_of(5, 3)
    bare = replace(evidence, scene=replace(evidence.scene, boxes=None))
    assert bare.problem.places is None
    relations = default_ontology().relations
    empty = no_unary_evidence(evidence.description, scene_relations([], np.zeros((0, 2, 2)), relations))
    assert empty.problem.places is None
