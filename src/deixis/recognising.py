"""What is taught and recognised: views of things in the perceptual memory, and the recogniser that they make."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import numpy as np

from deixis.memory.perceptual.protocol import PerceptualMemory, PerceptualReading
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError
from deixis.perception.features.registry import describer_named
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.recogniser import Recogniser
from deixis.perception.recognition.recognition import Recognition
from deixis.perception.recognition.views import PackedViews
from deixis.perception.scene import Scene

DESCRIBER = "spin_images"
"""What views are compared by."""

DISTANCES, IDS = "distances", "views"
"""The names of a category's state: D_V between its views, and the ids of the views, in the same order."""

LEAST_CONFIDENCE = 0.01
MOST_CONFIDENCE = 0.99
"""A recognised label is never certain, since a certain one would silence the description."""


@dataclass(frozen=True)
class Taught:
    """A view that was kept. ``before`` is the category that it was in, where a teacher corrects an earlier word."""

    view: str
    category: str
    views: int
    before: str | None


@dataclass(frozen=True)
class Recognised:
    """A scene with the names that were recognised, and what speaks for each, by the thing's id."""

    scene: Scene
    answers: Mapping[str, Recognition]


def teach(
    memory: PerceptualMemory, cloud: PointCloud, category: str, time: datetime, metadata: Mapping[str, Any]
) -> Taught:
    """Keeps one view of a thing of a category, all or nothing; the same points taught again correct the word.

    Raises CloudError where nothing on the thing can be described.
    """
    descriptors = describer_named(DESCRIBER).describe(cloud)
    if not len(descriptors):
        raise CloudError("the thing has too few points to say what it looks like; perceive it from nearer")
    points = np.ascontiguousarray(cloud.points[cloud.finite], dtype=np.float32)
    id = hashlib.sha256(points.tobytes()).hexdigest()[:16]
    view = View(id, category, time, {DESCRIBER: descriptors}, points, dict(metadata))
    with memory.exclusive():
        before = next((key.category for key in memory.listing() if key.id == id), None)
        involved = [name for name in memory.categories() if name in (category, before)]
        known = {name: instances_of(memory, name) for name in involved}
        if before is not None:
            known[before] = known[before].without_view(id)
        grown = known.get(category, InstanceCategory(category)).with_view(id, descriptors)
        left = [known[before]] if before is not None and before != category and len(known[before]) else []
        memory.write(Batch([view], [record_of(grown), *map(record_of, left)]))
        if before is not None and before != category and not left:
            memory.forget(before)  # nothing is left of it
    return Taught(id, category, len(grown), before if before != category else None)


def instances_of(memory: PerceptualReading, category: str) -> InstanceCategory:
    """A category with its views' descriptors; distances that a record has are not worked out again."""
    views = [(view.id, view.descriptors[DESCRIBER]) for view in memory.views(category) if DESCRIBER in view.descriptors]
    state = memory.category(category).state
    ids = tuple(view for view, _ in views)
    if DISTANCES not in state or memory.category(category).metadata.get(IDS) != sorted(ids):
        return InstanceCategory.of(category, views)
    order = np.argsort(np.argsort(np.array(ids, dtype=str)))
    return InstanceCategory(category, PackedViews.of(views), np.asarray(state[DISTANCES])[np.ix_(order, order)])


def record_of(category: InstanceCategory) -> CategoryRecord:
    """What a category has learned, its views in the order of their ids."""
    order = np.argsort(np.array(category.views.ids, dtype=str))
    return CategoryRecord(
        category.name, {DISTANCES: category.distances[np.ix_(order, order)]}, {IDS: sorted(category.views.ids)}
    )


def recogniser_of(memory: PerceptualReading) -> Recogniser:
    """The recogniser of everything that was taught, with its threshold from its own views."""
    categories = [instances_of(memory, name) for name in memory.categories()]
    return Recogniser.of(categories).calibrated()


def recognise(recogniser: Recogniser, scene: Scene, clouds: Sequence[PointCloud | None]) -> Recognised:
    """Names the things of a scene that have a cloud; what a scene says already stays."""
    describer = describer_named(DESCRIBER)
    answers, things = {}, []
    for thing, cloud in zip(scene.objects, clouds, strict=True):
        if cloud is not None:
            answer = recogniser.recognise(describer.describe(cloud))
            answers[thing.id] = answer
            if answer.label is not None and thing.label is None:
                sure = float(np.clip(answer.probability, LEAST_CONFIDENCE, MOST_CONFIDENCE))
                thing = replace(thing, label=answer.label, confidence=round(sure, 4))
        things.append(thing)
    return Recognised(replace(scene, objects=tuple(things)), answers)
