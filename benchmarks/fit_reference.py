"""Fit the weights of ``deixis refer`` to Nr3D, ScanRefer and Sr3D in ``$DEIXIS_DATA/refer3d``, and write them as JSON.

``python benchmarks/fit_reference.py FILE`` writes the weights; without FILE it only prints figures for held-out rooms.
The calibration of the probabilities is fitted to the answers for held-out rooms; for the figures of some rooms, to
those for the others.
"""

from __future__ import annotations

import random
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from bench_refer import figures
from common import data_folder
from numpy.typing import NDArray
from refer3d import Described, nr3d, read_scenes, scanrefer, sr3d

from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.grounding.reference.model.fitting import Example, fit, fit_calibration, initial_weights
from deixis.reasoning.grounding.reference.model.model import Model
from deixis.workflows.descriptions.learn_reference import write_reference
from deixis.workflows.descriptions.refer import model_with, read_description

FOLDS = 4
GENERATED = 1500
"""Number of sentences of Sr3D to fit to; more would outweigh those of people."""

PENALTY = 1.0
ITERATIONS = 40

Array = NDArray[np.float64]


def main() -> None:
    folder = data_folder("refer3d")
    if folder is None:
        return
    scenes = read_scenes(folder)
    people, generated = list(nr3d(folder, scenes)), list(sr3d(folder, scenes))
    longer = list(scanrefer(folder, scenes))
    chosen = people + longer + random.Random(0).sample(generated, min(GENERATED, len(generated)))
    examples = [(one, example) for one in chosen if (example := example_of(one)) is not None]
    rooms = sorted({one.room for one in chosen})
    random.Random(1).shuffle(rooms)
    start = model_with(initial_weights(default_ontology().colours))
    models: dict[str, Model] = {}
    for fold in range(FOLDS):
        held = set(rooms[fold::FOLDS])
        train = [example for one, example in examples if one.room not in held]
        model = replace(start, weights=fit(start, train, PENALTY, ITERATIONS).weights)
        models |= dict.fromkeys(held, model)
    told_by_people = {id(one) for one in people}
    answered = [(one, models[one.room], example) for one, example in examples if id(one) in told_by_people]
    for fold in range(FOLDS):
        held = set(rooms[fold::FOLDS])
        power = fit_calibration([(model, example) for one, model, example in answered if one.room not in held])
        models |= {room: with_calibration(models[room], power) for room in held}
    for name, those in (("Nr3D", people), ("Sr3D", generated[::5])):
        print(f"{name}, held-out rooms: {figures(name, [(one, models[one.room]) for one in those])}", flush=True)
    if len(sys.argv) > 1:
        weights = fit(start, [example for _, example in examples], PENALTY, ITERATIONS).weights
        power = fit_calibration([(model, example) for _, model, example in answered])
        counts = (len(people), len(longer), min(GENERATED, len(generated)))
        write_reference(model_with({**weights, "calibration": power}), Path(sys.argv[1]), source(*counts))


def example_of(one: Described) -> Example | None:
    """Return the example of a sentence, None if nothing of it is understood."""
    try:
        return Example(read_description(one.text), one.scene.room, one.scene.ids.index(one.target))
    except DescriptionError:
        return None


def with_calibration(model: Model, power: Array) -> Model:
    """Return the model with its probabilities calibrated."""
    return replace(model, weights={**model.weights, "calibration": power})


def source(people: int, longer: int, generated: int) -> str:
    """Return what the weights were fitted to."""
    return (
        f"Fitted to {people} sentences of Nr3D and {generated} of Sr3D (Achlioptas et al. 2020) and {longer}"
        " descriptions of ScanRefer (Chen et al. 2020), rooms of ScanNet, by benchmarks/fit_reference.py"
    )


if __name__ == "__main__":
    main()
