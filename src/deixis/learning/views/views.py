"""Views of things in the perceptual memory, and the recogniser that is made from them."""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.learning.views.teachings import GROUNDING, Teaching, Teachings, teachings_of, written
from deixis.memory.errors import DamagedMemoryError, UnknownViewError
from deixis.memory.perceptual.calibrated import read_calibrations, write_calibrations
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory, PerceptualReading, Progress, ViewKey
from deixis.memory.perceptual.records import Batch, CategoryRecord, Json, View
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError
from deixis.perception.features.describer import Describer
from deixis.perception.features.descriptors.colour import ColourDescriber
from deixis.perception.features.descriptors.form import FormDescriber
from deixis.perception.features.descriptors.spin_images import SpinImageDescriber
from deixis.perception.features.descriptors.upright import UprightDescriber
from deixis.perception.recognition.calibration import SHIPPED, SHIPPED_JOINT, Calibration, beside_colour
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.joint import JointRecogniser
from deixis.perception.recognition.learners.view_features import roots
from deixis.perception.recognition.recogniser import Recogniser, Recognition
from deixis.perception.recognition.settings import DEFAULT, RecognitionSettings
from deixis.perception.recognition.spread import PRIOR_SPREADS
from deixis.perception.recognition.views import PackedViews, mapped
from deixis.perception.scene import PerceivedObject, Scene


@dataclass(frozen=True)
class ViewDescriptor:
    """A descriptor of views: its algorithm, the name under which views store it, and the prior of its distances."""

    name: str
    describer: Describer
    root: bool = False

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Describe a cloud.

        Parameters
        ----------
        cloud
            The points of one thing.

        Returns
        -------
        ndarray
            Descriptors of shape (k, d); k is 0 for a cloud with too few points.
        """
        found = self.describer.describe(cloud)
        return roots(found) if self.root else found

    def __str__(self) -> str:
        return f"{self.name} {self.describer} {PRIOR_SPREADS[self.name]}"


UPRIGHT = ViewDescriptor("upright", UprightDescriber())
"""Descriptor of views in the frame of a table, used where all views have it."""

FORM = ViewDescriptor("form", FormDescriber())
"""Descriptor of views in the frame of a table that is compared beside :data:`UPRIGHT`."""

SPIN_IMAGE_ROOTS = ViewDescriptor("spin_image_roots", SpinImageDescriber(support=0.2), root=True)
"""Descriptor of all other views, whatever their frame, and of views stored before there was a choice.

With square roots the distance of equation 1 is the Hellinger distance. A support of 20 cm covers most of a thing on a
table.
"""

COLOUR = ViewDescriptor("colour", ColourDescriber())
"""Descriptor of colour, compared beside the shape where all views and the seen thing have colours."""

TABLE = "table"
"""Name of the frame in which z points up and is 0 on the table."""

DISTANCES, IDS, COMPARED, DESCRIBED = "distances", "views", "compared", "described"
"""Names in the state and metadata of a category: D_V between its views; the ids of the views, in the same order; the
descriptor in which they were compared; all descriptors that each of the views has.
"""

LEAST_CONFIDENCE = 0.01
MOST_CONFIDENCE = 0.99
"""Maximum confidence of a recognised label: a certain label would override the description."""


MAPPED = 10_000
"""Minimum number of views whose descriptors are mapped from a file and not held in memory."""

Pack = Callable[[Iterable[tuple[str, NDArray[np.float32]]]], PackedViews]
"""A function that stores the descriptors of views; it reads all of them before it returns."""


@dataclass(frozen=True, repr=False)
class Taught(Answer):
    """A view that was stored.

    Attributes
    ----------
    view
        Id of the view.
    category
        Its category.
    views
        Number of views of the category, this one included.
    before
        Earlier category of the view, if a teacher corrects an earlier word.
    again
        True if the view was in this category already.

    Examples
    --------
    >>> Taught("a1", "mug", 3, before="cup")
    <Taught a view of 'mug', no longer of 'cup'; 'mug' has 3 views>
    >>> Taught("a1", "mug", 3, before="cup").to_dict()["before"]
    'cup'
    """

    view: str
    category: str
    views: int
    before: str | None
    again: bool = False

    def summary(self) -> str:
        """Return the category of the view, and how many views the category has."""
        corrected = f", no longer of '{self.before}'" if self.before else ""
        return f"a view of '{self.category}'{corrected}; '{self.category}' has {count(self.views, 'view')}"


@dataclass(frozen=True)
class KeptName:
    """A thing that a teacher named otherwise than a grounding; the teacher's name is kept."""

    thing: str
    taught: str
    teacher: str
    grounded: str

    def __str__(self) -> str:
        return (
            f"{self.thing} stays a view of '{self.taught}', as {self.teacher} taught; "
            f"the grounding matched it with '{self.grounded}'"
        )


@dataclass(frozen=True, repr=False)
class Recognised(Answer):
    """A scene with the recognised names, and the recogniser's answer for each thing by its id."""

    scene: Scene
    answers: Mapping[str, Recognition]

    def summary(self) -> str:
        """Return how many objects have a name."""
        named = sum(answer.label is not None for answer in self.answers.values())
        return f"{named} of {count(len(self.answers), 'object')} recognised"


Comparison = tuple[ViewDescriptor, ...]
"""Descriptors that views are compared by together. A category stores distances in the first one."""

COMPARISONS: tuple[Comparison, ...] = (
    (UPRIGHT, FORM, COLOUR),
    (UPRIGHT, FORM),
    (UPRIGHT,),
    (SPIN_IMAGE_ROOTS, COLOUR),
    (SPIN_IMAGE_ROOTS,),
)
"""All comparisons, the best first."""


def comparisons_in(frame: str) -> tuple[Comparison, ...]:
    """Return the comparisons for views in a frame.

    Parameters
    ----------
    frame
        Name of the frame.

    Returns
    -------
    tuple of Comparison
        The comparisons, the best first.
    """
    return COMPARISONS if frame == TABLE else tuple(way for way in COMPARISONS if way[0] is SPIN_IMAGE_ROOTS)


def view_of(cloud: PointCloud, frame: str, category: str, time: datetime, metadata: Mapping[str, Any]) -> View:
    """Return a view of a thing of a category, ready to be stored.

    The view has the data for every descriptor by which it can be compared; without colours it has no colour descriptor.

    Parameters
    ----------
    cloud
        The points of the thing.
    frame
        Name of their frame.
    category
        Name of the category.
    time
        Time of the view.
    metadata
        Scene, object and teacher, as JSON.

    Returns
    -------
    View
        The view.

    Raises
    ------
    CloudError
        If the cloud cannot be described.
    """
    needed = dict.fromkeys(chain.from_iterable(comparisons_in(frame)))
    if cloud.colours is None:
        del needed[COLOUR]
    descriptors = {descriptor.name: descriptor.describe(cloud) for descriptor in needed}
    if not all(map(len, descriptors.values())):
        raise CloudError("the thing has too few points to describe its appearance; perceive it from closer")
    points = np.ascontiguousarray(cloud.points[cloud.finite], dtype=np.float32)
    id = hashlib.sha256(points.tobytes()).hexdigest()[:16]
    return View(id, category, time, descriptors, points, dict(metadata))


def thing_of(view: View) -> str | None:
    """Return a key of the thing that a view shows.

    The same file with other boxes is another scene: the next table, perceived into the same file.

    Parameters
    ----------
    view
        The view.

    Returns
    -------
    str or None
        A key made of the scene and the object's id, or None if these are unknown.
    """
    scene, object = view.metadata.get("scene"), view.metadata.get("object")
    return json.dumps([scene, view.metadata.get("boxes"), object]) if scene and object else None


def batch_of(
    memory: PerceptualMemory,
    views: Sequence[View],
    lessons: Mapping[str, str] | None = None,
    named: Sequence[tuple[View, str | None]] = (),
) -> tuple[Batch, tuple[Taught, ...]]:
    """Return the batch that stores views in turn, and what each view taught.

    Views with the same points under another word correct the earlier word. Write the batch before anything else is
    written, so inside :meth:`PerceptualMemory.exclusive`.

    Parameters
    ----------
    memory
        The memory.
    views
        The views, each with its category.
    lessons
        Id of the lesson by the id of the view; other views are from a teacher and belong to no lesson.
    named
        All new teachings in turn, each a view and its lesson or None: ``views``, and those that change no view, as a
        teacher named it otherwise.

    Returns
    -------
    tuple
        The batch, and what each view taught.
    """
    with memory.exclusive():
        place = {id: view.category for id, view in _kept(memory, views).items()}
        kept = {name: list(memory.views(name)) for name in _involved(memory, views, place)}
        grown = {name: [*kept.get(name, ()), *_of(views, name)] for name in (*kept, *(view.category for view in views))}
        chosen = {name: comparison_of(together)[0] for name, together in grown.items()}
        known = {name: instances_of(memory.category(name), own, (chosen[name],))[0] for name, own in kept.items()}
        taught = []
        for view in views:
            before = place.get(view.id)
            if before is not None:
                known[before] = known[before].without_view(view.id)
            category = known.get(view.category, InstanceCategory(view.category))
            described = view.descriptors[chosen[view.category].name]
            known[view.category] = category.with_view(view.id, described, thing_of(view))
            place[view.id] = view.category
            corrected = before if before != view.category else None
            again = before == view.category
            taught.append(Taught(view.id, view.category, len(known[view.category]), corrected, again))
        records, empty = _records(known, chosen, grown)
        coming = list({view.id: view for view in views}.values())
        turns = _with_turns(memory, named)
    return Batch(coming, records, dropped=empty, lessons=dict(lessons or {}), teachings=turns), tuple(taught)


def _records(
    known: Mapping[str, InstanceCategory],
    chosen: Mapping[str, ViewDescriptor],
    views: Mapping[str, Sequence[View]],
) -> tuple[list[CategoryRecord], list[str]]:
    """Return the records of the categories that have views, and the names of the others."""
    records = [
        record_of(category, chosen[name], described_by_all(views[name]))
        for name, category in known.items()
        if len(category)
    ]
    return records, [name for name, category in known.items() if not len(category)]


def _with_turns(memory: PerceptualReading, named: Sequence[tuple[View, str | None]]) -> dict[str, list[Json]]:
    """Return all teachings of views, with those that are new, as they are stored."""
    stored, lessons = memory.teachings(), memory.lessons_of_views()
    turns: dict[str, Teachings] = {}
    for id, view in _kept(memory, [view for view, _ in named]).items():
        current = Teaching(view.category, view.time, view.metadata, lessons.get(id))
        turns[id] = teachings_of(current, stored.get(id, ()))
    for view, lesson in named:
        turns[view.id] = (*turns.get(view.id, ()), Teaching(view.category, view.time, view.metadata, lesson))
    return {id: written(all_turns) for id, all_turns in turns.items()}


def batch_without(memory: PerceptualReading, gone: Sequence[str], changed: Mapping[str, Teaching]) -> Batch:
    """Return the batch that forgets views, and gives others the category, time and metadata of another teaching.

    Write the batch before anything else is written, so inside :meth:`PerceptualMemory.exclusive`.

    Parameters
    ----------
    memory
        The memory.
    gone
        Ids of the views to forget.
    changed
        Teachings by the ids of the views to change.

    Returns
    -------
    Batch
        The batch, with the records of all categories that lose or gain a view.
    """
    before = {id: memory.view(id) for id in (*gone, *changed)}
    after = {id: _retold(before[id], turn) for id, turn in changed.items()}
    names = dict.fromkeys(view.category for view in (*before.values(), *after.values()))
    there = set(memory.categories())
    own = {name: list(memory.views(name)) if name in there else [] for name in names}
    stay = {
        name: [*(view for view in own[name] if view.id not in before), *_of(after.values(), name)] for name in names
    }
    chosen = {name: comparison_of(views)[0] for name, views in stay.items()}
    known = {}
    for name in names:
        category = InstanceCategory(name)
        if own[name]:
            record = memory.category(name)
            compared = record.metadata.get(COMPARED, SPIN_IMAGE_ROOTS.name) == chosen[name].name
            held = own[name] if compared else [view for view in own[name] if view.id not in before]
            category = instances_of(record, held, (chosen[name],))[0]
            for view in held:
                category = category.without_view(view.id) if view.id in before else category
        for view in _of(after.values(), name):
            category = category.with_view(view.id, view.descriptors[chosen[name].name], thing_of(view))
        known[name] = category
    records, empty = _records(known, chosen, stay)
    return Batch(list(after.values()), records, forgotten=list(gone), dropped=empty)


def _retold(view: View, turn: Teaching) -> View:
    return View(view.id, turn.category, turn.time, view.descriptors, view.points, dict(turn.metadata))


def taught_by_hand(memory: PerceptualReading, views: Sequence[View]) -> dict[str, View]:
    """Return, by id, the stored form of those views that a teacher has named already; ignore damaged ones.

    Parameters
    ----------
    memory
        The memory.
    views
        The views.

    Returns
    -------
    dict
        Stored view by id.
    """
    return {id: view for id, view in _kept(memory, views).items() if view.metadata.get("teacher") != GROUNDING}


def _kept(memory: PerceptualReading, views: Sequence[View]) -> dict[str, View]:
    """Return, by id, the stored form of those views that a memory has already; damaged ones count as missing."""
    kept = {}
    for view in views:
        with contextlib.suppress(UnknownViewError, DamagedMemoryError):
            kept[view.id] = memory.view(view.id)
    return kept


def _involved(memory: PerceptualReading, views: Sequence[View], place: Mapping[str, str]) -> list[str]:
    """Return the stored categories that the views belong to, or belonged to."""
    named = {view.category for view in views} | {place[view.id] for view in views if view.id in place}
    return [name for name in memory.categories() if name in named]


def _of(views: Iterable[View], category: str) -> list[View]:
    return [view for view in views if view.category == category]


def described_by_all(views: Iterable[View]) -> set[str]:
    """Return the names of the descriptors that each of some views has.

    Parameters
    ----------
    views
        The views.

    Returns
    -------
    set of str
        Names of descriptors.
    """
    named = [set(view.descriptors) for view in views]
    return set.intersection(*named) if named else set()


def comparison_of(views: Iterable[View]) -> Comparison:
    """Return the best comparison for which each of some views has the descriptors.

    Parameters
    ----------
    views
        The views.

    Returns
    -------
    Comparison
        The comparison.
    """
    shared = described_by_all(views)
    return next((way for way in COMPARISONS if {each.name for each in way} <= shared), COMPARISONS[-1])


def instances_of(
    record: CategoryRecord, views: Iterable[View], comparison: Comparison, pack: Pack = PackedViews.of
) -> tuple[InstanceCategory, ...]:
    """Return a category for each descriptor of a comparison; distances in its record are not recomputed.

    Parameters
    ----------
    record
        Record of the category.
    views
        Views of the category, of which only the compared descriptors are held.
    comparison
        The comparison.
    pack
        Function that stores the views of the first descriptor.

    Returns
    -------
    tuple of InstanceCategory
        One category for each descriptor.
    """
    descriptor, *others = comparison
    things: dict[str, str] = {}
    empty: list[str] = []
    beside: dict[str, list[tuple[str, NDArray[np.float32]]]] = {other.name: [] for other in others}

    def described() -> Iterator[tuple[str, NDArray[np.float32]]]:
        for view in views:
            if not all(each.name in view.descriptors for each in comparison):
                continue
            if (thing := thing_of(view)) is not None:
                things[view.id] = thing
            if not all(len(view.descriptors[each.name]) for each in comparison):
                empty.append(view.id)
                continue
            for other in others:
                beside[other.name].append((view.id, view.descriptors[other.name]))
            yield view.id, view.descriptors[descriptor.name]

    packed = pack(described())
    if _compared(record, packed.ids, descriptor):
        order = np.argsort(np.argsort(np.array(packed.ids, dtype=str)))
        distances = np.asarray(record.state[DISTANCES])[np.ix_(order, order)]
        first = InstanceCategory(record.name, packed, distances, tuple(empty), things)
    else:
        first = InstanceCategory.among(record.name, packed, tuple(empty), things)
    rest = (PackedViews.of(beside[other.name]) for other in others)
    return first, *(InstanceCategory.among(record.name, each, tuple(empty), things) for each in rest)


def _compared(record: CategoryRecord, ids: Iterable[str], descriptor: ViewDescriptor) -> bool:
    """Return whether a record has the distances between these views in a descriptor."""
    compared = record.metadata.get(COMPARED, SPIN_IMAGE_ROOTS.name)  # before there was a choice
    return compared == descriptor.name and DISTANCES in record.state and record.metadata.get(IDS) == sorted(ids)


def record_of(category: InstanceCategory, descriptor: ViewDescriptor, described: Iterable[str]) -> CategoryRecord:
    """Return the record of a category, its views ordered by id.

    Parameters
    ----------
    category
        The category by one descriptor.
    descriptor
        That descriptor.
    described
        Names of the descriptors of all views.

    Returns
    -------
    CategoryRecord
        The record.
    """
    order = np.argsort(np.array(category.views.ids, dtype=str))
    return CategoryRecord(
        category.name,
        {DISTANCES: category.distances[np.ix_(order, order)]},
        {IDS: sorted(category.views.ids), COMPARED: descriptor.name, DESCRIBED: sorted(described)},
    )


@dataclass(frozen=True)
class Known:
    """A recogniser, and the descriptors by which it compares.

    Where colour is one of them, ``by_shape`` compares by the others; it names things that are seen without colours.
    """

    recogniser: JointRecogniser
    comparison: Comparison
    by_shape: Known | None = None

    def recognise(self, cloud: PointCloud) -> Recognition:
        """Name what a cloud shows, or say that it is unknown, and why.

        Parameters
        ----------
        cloud
            The points of one thing.

        Returns
        -------
        Recognition
            The label or none, with its probability and the candidates.
        """
        if self.by_shape is not None and cloud.colours is None:
            return self.by_shape.recognise(cloud)
        return self.recogniser.recognise([descriptor.describe(cloud) for descriptor in self.comparison])

    def calibrated(self, progress: Progress | None = None) -> Known:
        """Return this recogniser with weights, threshold and probabilities from its own views.

        Parameters
        ----------
        progress
            Called while the views are compared.

        Returns
        -------
        Known
            The calibrated recogniser.
        """
        held = self.recogniser.held_out(progress)
        ways = [way.recogniser.calibrated_by(held[: len(way.comparison)]).calibration for way in self._ways]
        return self.with_calibrations(ways)

    @property
    def calibrations(self) -> tuple[Calibration, ...]:
        """Calibration of the recogniser, and that of ``by_shape`` where there is one."""
        return tuple(way.recogniser.calibration for way in self._ways)

    def with_calibrations(self, calibrations: Sequence[Calibration]) -> Known:
        """Return this recogniser with other calibrations.

        Parameters
        ----------
        calibrations
            Calibrations in the order of :attr:`calibrations`.

        Returns
        -------
        Known
            The recogniser.
        """
        whole, *rest = calibrations
        by_shape = None if self.by_shape is None else self.by_shape.with_calibrations(rest)
        return replace(self, recogniser=replace(self.recogniser, calibration=whole), by_shape=by_shape)

    @property
    def _ways(self) -> tuple[Known, ...]:
        return (self,) if self.by_shape is None else (self, self.by_shape)


def nothing_known(frame: str) -> Known:
    """Return a recogniser without categories.

    Parameters
    ----------
    frame
        Name of the frame.

    Returns
    -------
    Known
        The recogniser.
    """
    return known_by(comparisons_in(frame)[-1], [])


def known_by(
    comparison: Comparison,
    categories: Iterable[tuple[InstanceCategory, ...]],
    settings: RecognitionSettings = DEFAULT,
) -> Known:
    """Return the recogniser of some categories, with the shipped calibrations.

    Parameters
    ----------
    comparison
        The comparison.
    categories
        Categories, each given for each descriptor of the comparison.
    settings
        Settings of the recogniser.

    Returns
    -------
    Known
        The recogniser.
    """
    by_descriptor = list(zip(*categories, strict=True)) or [()] * len(comparison)
    parts = tuple(
        Recogniser.of(own, replace(settings, prior_spread=PRIOR_SPREADS[descriptor.name]))
        for own, descriptor in zip(by_descriptor, comparison, strict=True)
    )
    shapes = tuple(descriptor for descriptor in comparison if descriptor is not COLOUR)
    shipped = SHIPPED_JOINT if len(shapes) > 1 else SHIPPED
    by_shape = Known(JointRecogniser(parts[: len(shapes)], shipped), shapes)
    if shapes == comparison:
        return by_shape
    return Known(JointRecogniser(parts, beside_colour(shipped)), comparison, by_shape)


def recogniser_of(memory: LevelMemory, frame: str, progress: Progress | None = None) -> Known:
    """Return the recogniser of all taught categories in a frame, with its threshold calibrated on its own views.

    The calibration is recomputed when a tenth of the views differ from the last time, and stored in the memory. From
    :data:`MAPPED` views on, their descriptors are mapped from a file.

    Parameters
    ----------
    memory
        The open memory.
    frame
        Name of the frame of the views.
    progress
        Called while views are read and calibrated.

    Returns
    -------
    Known
        The recogniser.
    """
    with memory.exclusive():
        names, listed = memory.categories(), list(memory.listing())
        comparison = _comparison_in(frame, memory, listed)
        views = {(key.category, key.id) for key in listed}
        pack = PackedViews.of if len(views) < MAPPED else mapped
        categories = []
        for name in names:
            categories.append(instances_of(memory.category(name), memory.views(name), comparison, pack))
            if progress is not None:  # what was imported may have no distances yet, and then this takes longest
                progress(len(categories), len(names))
        known, compared = known_by(comparison, categories), " ".join(map(str, (*comparison, DEFAULT)))
        kept = read_calibrations(memory.path, views, compared)
        if kept is not None and [len(each.weights) for each in kept] == [len(e.weights) for e in known.calibrations]:
            return known.with_calibrations(kept)
        known = known.calibrated(progress)
        write_calibrations(memory.path, known.calibrations, views, compared)
    return known


def _comparison_in(frame: str, memory: PerceptualReading, listed: Iterable[ViewKey]) -> Comparison:
    """Return the best comparison in a frame for which all taught views have the descriptors.

    The records of the categories list their descriptors. Where they do not, the views are read until one lacks a
    descriptor.
    """
    ids = defaultdict(list)
    for key in listed:
        ids[key.category].append(key.id)

    def can(name: str, comparison: Comparison) -> bool:
        wanted = {descriptor.name for descriptor in comparison}
        record = memory.category(name)
        if record.metadata.get(IDS) == sorted(ids[name]) and wanted <= set(record.metadata.get(DESCRIBED, ())):
            return True
        return all(wanted <= set(view.descriptors) for view in memory.views(name))

    *better, last = comparisons_in(frame)
    return next((way for way in better if all(can(name, way) for name in ids)), last)


def candidates_of(answer: Recognition) -> tuple[tuple[str, float], ...]:
    """Return the names that a thing can have, with their probabilities.

    Parameters
    ----------
    answer
        Answer of the recogniser.

    Returns
    -------
    tuple of tuple
        Pairs of name and probability, the most probable first.
    """
    return tuple((one.category, round(one.probability, 4)) for one in answer.candidates)


def recognise(
    known: Known, scene: Scene, clouds: Sequence[PointCloud | None], progress: Progress | None = None
) -> Recognised:
    """Name the things of a scene that have a cloud; keep the names that the scene has already.

    Parameters
    ----------
    known
        The recogniser.
    scene
        The scene.
    clouds
        Points of each thing of the scene, or None.
    progress
        Called before each thing with the number of things done, and the number of all things.

    Returns
    -------
    Recognised
        The scene with the names, and the answer for each thing.
    """
    answers: dict[str, Recognition] = {}
    things: list[PerceivedObject] = []
    for thing, cloud in zip(scene.objects, clouds, strict=True):
        if progress is not None:
            progress(len(things), len(clouds))
        if cloud is not None:
            answer = known.recognise(cloud)
            answers[thing.id] = answer
            if thing.label is None:
                thing = replace(thing, candidates=candidates_of(answer))
                if answer.label is not None:
                    sure = float(np.clip(answer.probability, LEAST_CONFIDENCE, MOST_CONFIDENCE))
                    thing = replace(thing, label=answer.label, confidence=round(sure, 4))
        things.append(thing)
    return Recognised(replace(scene, objects=tuple(things)), answers)
