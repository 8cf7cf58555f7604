"""How large things of a kind are, from all that is remembered, whether or not the ontology knows the kind."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Set

import numpy as np
import pyoxigraph as ox
from numpy.typing import NDArray

from deixis.learning.recollection import Recollection, Remembered
from deixis.ontology.kinds import Kinds, plain_name
from deixis.ontology.lessons.write import scene_text_iri
from deixis.ontology.models.sizes import SizeModel, size_triples
from deixis.ontology.sizes import Sizes
from deixis.ontology.tbox import Ontology
from deixis.reasoning.grounding.evidence.labels import category_of, classes
from deixis.reasoning.grounding.evidence.sizes import usual_size
from deixis.reasoning.grounding.evidence.unary import log_sizes
from deixis.reasoning.grounding.fitting.sizes import learn_sizes

FEWEST = 3
"""Views that take the place of a usual size. With fewer, one wrong view moves the median at will."""

SURE = 0.9
"""Confidence from which a label says what a thing is like; a median bears the tenth that is wrong."""

View = tuple[Remembered, int]  # a lesson, and the place of a thing in its scene


def learned_size_triples(recollection: Recollection, ontology: Ontology) -> list[ox.Triple]:
    """The sizes that the lessons teach, with the scenes that they are derived from."""
    used = {
        kind: _comparable(views)
        for kind, views in _views(recollection, ontology.kinds).items()
        if len(views) >= FEWEST or usual_size(kind, ontology.sizes) is None
    }
    models = _models(used, ontology.sizes)
    triples: list[ox.Triple] = []
    for kind, views in used.items():
        scenes = sorted({scene_text_iri(lesson.texts[1]) for lesson, _ in views})
        triples += size_triples(kind, models[kind], scenes)
    return triples


def _comparable(views: list[View]) -> list[View]:
    """Those in metres where they are enough; else all, to be compared relative to their scenes."""
    metric = [view for view in views if _metric(view)]
    return metric if len(metric) >= FEWEST else views


def _metric(view: View) -> bool:
    return view[0].scene.unit == "m"


def _models(used: Mapping[str, list[View]], sizes: Sizes) -> dict[str, SizeModel]:
    """The size of each kind, in metres where all its views are, else relative to their scenes."""
    in_metres = {kind for kind, views in used.items() if all(map(_metric, views))}
    usual = {kind: model for kind in in_metres if (model := usual_size(kind, sizes))}
    relative = learn_sizes(_measured(used, used.keys() - in_metres, relative=True), relative=True)
    return learn_sizes(_measured(used, in_metres, relative=False), usual=usual) | relative


def _measured(used: Mapping[str, list[View]], kinds: Set[str], relative: bool) -> dict[str, NDArray[np.float64]]:
    """Log length and log aspect of the views (n, 2) of some kinds; each scene is measured once."""
    lessons = {lesson.lesson: lesson for kind in kinds for lesson, _ in used[kind]}
    sizes = {id: log_sizes(lesson.scene.boxes, relative) for id, lesson in lessons.items()}
    return {
        kind: np.array([sizes[lesson.lesson][thing] for lesson, thing in views])
        for kind, views in used.items()
        if kind in kinds
    }


def _views(recollection: Recollection, kinds: Kinds) -> dict[str, list[View]]:
    """Every thing that is known to be of a kind, by class IRI; the same box once, however many lessons show it."""
    found: dict[str, dict[bytes, View]] = defaultdict(dict)
    for lesson in recollection.lessons:
        for kind, thing in [*_matched(lesson), *_labelled(lesson, kinds)]:
            found[kind].setdefault(lesson.scene.boxes[thing].tobytes(), (lesson, thing))
    return {kind: list(views.values()) for kind, views in sorted(found.items())}


def _matched(lesson: Remembered) -> Iterator[tuple[str, int]]:
    who = lesson.who
    for kind, thing, decided, sure in zip(
        classes(lesson.description), who.things, who.decided, who.sureness, strict=True
    ):
        if thing is not None and decided and sure >= SURE:
            yield kind, thing


def _labelled(lesson: Remembered, kinds: Kinds) -> Iterator[tuple[str, int]]:
    for place, thing in enumerate(lesson.scene.objects):
        if thing.label and thing.confidence >= SURE:
            kind = kinds.of_word(plain_name(thing.label))
            yield kind.iri if kind else category_of(thing.label), place
