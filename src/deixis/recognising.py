"""What is taught and recognised: views of things in the perceptual memory, and the recogniser that they make."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.memory.perceptual.calibrated import keep_calibration, kept_calibration
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory, PerceptualReading, Progress
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError
from deixis.perception.features.spin_describer import SpinImageDescriber
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.learners.view_features import roots
from deixis.perception.recognition.recogniser import Recogniser
from deixis.perception.recognition.recognition import Recognition
from deixis.perception.recognition.settings import RecognitionSettings
from deixis.perception.recognition.spread import PRIOR_SPREADS
from deixis.perception.recognition.views import PackedViews
from deixis.perception.scene import Scene

DESCRIBER = "spin_image_roots"
"""What views are compared by."""

SETTINGS = RecognitionSettings(prior_spread=PRIOR_SPREADS[DESCRIBER])

DESCRIBED = SpinImageDescriber(support=0.2)
"""A support of 20 cm takes in most of a thing on a table."""

COMPARED = f"{DESCRIBER} {DESCRIBED} {SETTINGS}"
"""How, in full: what was worked out from views that were compared in another way is worked out anew."""

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


def describe(cloud: PointCloud) -> NDArray[np.float32]:
    """What a thing's points are compared by: square roots of spin images, (k, 153); none of too few points.

    With roots the distance of equation 1 is Hellinger's.
    """
    return roots(DESCRIBED.describe(cloud))


def view_of(cloud: PointCloud, category: str, time: datetime, metadata: Mapping[str, Any]) -> View:
    """A view of a thing of a category, ready to be kept; raises CloudError where nothing on it can be described."""
    descriptors = describe(cloud)
    if not len(descriptors):
        raise CloudError("the thing has too few points to say what it looks like; perceive it from nearer")
    points = np.ascontiguousarray(cloud.points[cloud.finite], dtype=np.float32)
    id = hashlib.sha256(points.tobytes()).hexdigest()[:16]
    return View(id, category, time, {DESCRIBER: descriptors}, points, dict(metadata))


def thing_of(view: View) -> str | None:
    """The thing that a view shows: the object of the scene that it was taught from. None where that is not known."""
    scene, object = view.metadata.get("scene"), view.metadata.get("object")
    return json.dumps([scene, object]) if scene and object else None


def keep_views(memory: PerceptualMemory, views: Sequence[View]) -> tuple[Taught, ...]:
    """Keeps views, all or none; the same points kept again under another word correct it."""
    with memory.exclusive():
        place = {key.id: key.category for key in memory.listing()}
        known, taught = {name: instances_of(memory, name) for name in _involved(memory, views, place)}, []
        for view in views:
            before = place.get(view.id)
            if before is not None:
                known[before] = known[before].without_view(view.id)
            grown = known.get(view.category, InstanceCategory(view.category))
            known[view.category] = grown.with_view(view.id, view.descriptors[DESCRIBER], thing_of(view))
            place[view.id] = view.category
            corrected = before if before != view.category else None
            taught.append(Taught(view.id, view.category, len(known[view.category]), corrected))
        memory.write(Batch(views, [record_of(category) for category in known.values() if len(category)]))
        for name, category in known.items():
            if not len(category):
                memory.forget(name)  # nothing is left of it
    return tuple(taught)


def _involved(memory: PerceptualReading, views: Sequence[View], place: Mapping[str, str]) -> list[str]:
    """The categories that there are and that the views are of, or were of."""
    named = {view.category for view in views} | {place[view.id] for view in views if view.id in place}
    return [name for name in memory.categories() if name in named]


def instances_of(memory: PerceptualReading, category: str) -> InstanceCategory:
    """A category with its views' descriptors; distances that a record has are not worked out again."""
    kept = [view for view in memory.views(category) if DESCRIBER in view.descriptors]
    views = [(view.id, view.descriptors[DESCRIBER]) for view in kept]
    things = {view.id: thing for view in kept if (thing := thing_of(view)) is not None}
    record = memory.category(category)
    ids = tuple(view for view, _ in views)
    if DISTANCES not in record.state or record.metadata.get(IDS) != sorted(ids):
        return InstanceCategory.of(category, views, things)
    order = np.argsort(np.argsort(np.array(ids, dtype=str)))
    distances = np.asarray(record.state[DISTANCES])[np.ix_(order, order)]
    return InstanceCategory(category, PackedViews.of(views), distances, things=things)


def record_of(category: InstanceCategory) -> CategoryRecord:
    """What a category has learned, its views in the order of their ids."""
    order = np.argsort(np.array(category.views.ids, dtype=str))
    return CategoryRecord(
        category.name, {DISTANCES: category.distances[np.ix_(order, order)]}, {IDS: sorted(category.views.ids)}
    )


def recogniser_of(memory: LevelMemory, progress: Progress | None = None) -> Recogniser:
    """The recogniser of everything that was taught, with its threshold from its own views.

    That is worked out anew when a tenth of the views are others than the last time, and kept in the memory.
    """
    with memory.exclusive():
        known = Recogniser.of([instances_of(memory, name) for name in memory.categories()], SETTINGS)
        views = {(key.category, key.id) for key in memory.listing()}
        kept = kept_calibration(memory.path, views, COMPARED)
        if kept is not None:
            return replace(known, calibration=kept)
        known = known.calibrated(progress)
        keep_calibration(memory.path, known.calibration, views, COMPARED)
    return known


def recognise(recogniser: Recogniser, scene: Scene, clouds: Sequence[PointCloud | None]) -> Recognised:
    """Names the things of a scene that have a cloud; what a scene says already stays."""
    answers, things = {}, []
    for thing, cloud in zip(scene.objects, clouds, strict=True):
        if cloud is not None:
            answer = recogniser.recognise(describe(cloud))
            answers[thing.id] = answer
            if answer.label is not None and thing.label is None:
                sure = float(np.clip(answer.probability, LEAST_CONFIDENCE, MOST_CONFIDENCE))
                thing = replace(thing, label=answer.label, confidence=round(sure, 4))
        things.append(thing)
    return Recognised(replace(scene, objects=tuple(things)), answers)
