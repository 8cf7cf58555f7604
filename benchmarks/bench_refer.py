"""Measure which object a description refers to: Nr3D and Sr3D in ``$DEIXIS_DATA/refer3d``, as the field reports it.

Prints the share of targets that are right (Nr3D: valid sentences, easy and hard, view-dependent and independent), the
most probable third of the answers, the calibration error in ten bins, the milliseconds for each sentence, and the
share and the number of yes-or-no questions until the answer is decided, and until it has the probability ENOUGH, beside
the entropy of the answers in bits, the least number of questions that leaves no doubt; then the same with class names
hidden, and with those of a random third of the objects hidden.
The weights were fitted to the training sentences that the folder holds, so that figures for these are not held out:
``fit_reference.py`` prints those for held-out rooms.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from common import data_folder
from numpy.typing import NDArray
from records import command_line, figure, recorded, share
from refer3d import Described, nr3d, read_scenes, sr3d

from deixis.perception.scene import Scene
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.grounding.reference.answer import DECIDED
from deixis.reasoning.grounding.reference.model.model import Model
from deixis.reasoning.grounding.reference.questions import answered, best_question
from deixis.workflows.descriptions.refer import MAX_QUESTIONS, read_description, refer, shipped_model

BINS = 10

ENOUGH = 0.9
"""Probability of an answer at which the shorter of the two dialogues asks no more questions."""


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        measure()


def measure() -> None:
    """Print and record the figures of each set of sentences."""
    folder = data_folder("refer3d")
    if folder is None:
        return
    scenes = read_scenes(folder)
    sets = {"Nr3D": list(nr3d(folder, scenes)), "Sr3D": list(sr3d(folder, scenes))}
    hidden = {name: scene.without_labels() for name, scene in scenes.items()}
    bare = {id(scene): hidden[name] for name, scene in scenes.items()}
    partly = {id(scene): without_some_labels(scene, seed) for seed, scene in enumerate(scenes.values())}
    for name, those in sets.items():
        if not those:
            continue
        described = [(one, shipped_model()) for one in those]
        print(f"{name}: {figures(name, described)}")
        blind = [(replace(one, scene=bare[id(one.scene)]), shipped_model()) for one in those]
        chance = np.mean([1 / len(one.scene.objects) for one in those])
        unnamed = f"{name}, class names hidden"
        figure(f"{unnamed}: chance", float(chance), "share")
        print(f"{unnamed} (chance {chance:.3f}): {figures(unnamed, blind)}")
        some = f"{name}, a third of the class names hidden"
        print(
            f"{some}: {figures(some, [(replace(one, scene=partly[id(one.scene)]), shipped_model()) for one in those])}"
        )
    timed = sets["Nr3D"] or sets["Sr3D"]
    started = time.process_time()
    for one in timed:
        _quiet(one)
    sentence_ms = 1000 * (time.process_time() - started) / max(len(timed), 1)
    figure("processor time per sentence", sentence_ms, "ms")
    print(f"{sentence_ms:.1f} ms a sentence, scene read before")


def without_some_labels(scene: Scene, seed: int) -> Scene:
    """Return a scene without the labels of a random third of its objects."""
    hidden = np.random.default_rng(seed).random(len(scene.objects)) < 1 / 3
    things = (replace(one, label=None) if bare else one for one, bare in zip(scene.objects, hidden, strict=True))
    return replace(scene, objects=tuple(things))


def figures(name: str, described: Sequence[tuple[Described, Model]]) -> str:
    """Record the figures of a set of sentences, each answered by its model, and return them as one line."""
    right, certain, bits = np.zeros((3, len(described)))
    asked, settled = np.zeros((2, 2, len(described)))
    for place, (one, model) in enumerate(described):
        room = one.scene.room
        try:
            probabilities = model.probabilities(read_description(one.text), room)
        except DescriptionError:
            probabilities = np.full(len(room), 1 / len(room))
        certain[place] = probabilities.max()
        bits[place] = -(probabilities * np.log2(np.maximum(probabilities, 1e-300))).sum()
        right[place] = room.ids[int(probabilities.argmax())] == one.target
        for row, enough in enumerate((DECIDED, ENOUGH)):
            asked[row, place], settled[row, place] = dialogue(probabilities, one, enough)
    decided = certain >= DECIDED
    hard = np.array([one.hard for one, _ in described])
    viewed = np.array([one.view_dependent for one, _ in described])
    kinds = {"easy": ~hard, "hard": hard, "view-dependent": viewed, "view-independent": ~viewed}
    parts = [f"{kind} {right[mask].mean():.3f}" for kind, mask in kinds.items() if mask.any()]
    third = np.argsort(-certain, kind="stable")[: max(len(described) // 3, 1)]
    bins = np.minimum((certain * BINS).astype(int), BINS - 1)
    error = sum(abs((certain - right)[bins == k].sum()) for k in range(BINS)) / len(described)
    share(f"{name}: right", int(right.sum()), len(described))
    for kind, mask in kinds.items():
        share(f"{name}, {kind}: right", int(right[mask].sum()), int(mask.sum()))
    share(f"{name}: right in the most probable third", int(right[third].sum()), len(third))
    figure(f"{name}: calibration error", error, "share")
    share(f"{name}: decided", int(decided.sum()), len(described))
    share(f"{name}: right if decided", int(right[decided].sum()), int(decided.sum()))
    figure(f"{name}: entropy of the answers", bits.mean(), "bits")
    for row, ending in enumerate(("", f" until {ENOUGH:g}")):
        share(f"{name}: right after questions{ending}", int(settled[row].sum()), len(described))
        figure(f"{name}: questions per sentence{ending}", asked[row].mean(), "questions")
    return (
        f"{len(described)} sentences, right {right.mean():.3f} ({', '.join(parts)}); most probable third"
        f" {right[third].mean():.3f}, calibration error {error:.3f}; decided {decided.mean():.3f}, of these right"
        f" {right[decided].sum() / max(decided.sum(), 1):.3f}; with {asked[0].mean():.2f} questions a"
        f" sentence {settled[0].mean():.3f}, with {asked[1].mean():.2f} (until {ENOUGH:g}) {settled[1].mean():.3f};"
        f" entropy {bits.mean():.2f} bits"
    )


def dialogue(probabilities: NDArray[np.float64], one: Described, enough: float) -> tuple[int, bool]:
    """Return the number of questions until an object has the probability ``enough``, and whether it is the target."""
    room, asked = one.scene.room, 0
    while probabilities.max() < enough and asked < MAX_QUESTIONS:
        question = best_question(probabilities, room, not room.unlabelled.all(), enough)
        if question is None:
            break
        probabilities = answered(probabilities, room, question, one.target in question.yes)
        asked += 1
    return asked, room.ids[int(probabilities.argmax())] == one.target


def _quiet(one: Described) -> None:
    with suppress(DescriptionError):
        refer(one.text, one.scene)


if __name__ == "__main__":
    main()
