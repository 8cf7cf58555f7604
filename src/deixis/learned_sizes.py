"""How large things of a kind are, from all that is remembered, whether or not the ontology knows the kind."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

import numpy as np
import pyoxigraph as ox
from numpy.typing import NDArray

from deixis.ontology.kinds import Kinds, plain_name
from deixis.ontology.lesson_triples import scene_text_iri
from deixis.ontology.size_model import SizeModel
from deixis.ontology.size_model_triples import size_triples
from deixis.ontology.tbox import Ontology
from deixis.reasoning.graded.size_learning import SizePrior, learn_size, pooled_prior, usual_prior
from deixis.reasoning.graded.unary import log_sizes, usual_size
from deixis.reasoning.labels import category_of, classes
from deixis.remembered import Recollection, Remembered

FEWEST = 3
"""Views that take the place of a usual size. With fewer, one wrong view moves the median at will."""

SURE = 0.9
"""Confidence from which a label says what a thing is like; a median bears the tenth that is wrong."""

View = tuple[Remembered, int]  # a lesson, and the place of a thing in its scene


def learned_size_triples(recollection: Recollection, ontology: Ontology) -> list[ox.Triple]:
    """The sizes that the lessons teach, with the scenes that they are derived from."""
    used = {}
    for kind, views in _views(recollection, ontology.kinds).items():
        usual = usual_size(kind, ontology.sizes)
        if usual is None or len(views) >= FEWEST:
            used[kind] = _comparable(views), usual
    measured = _Measured({kind: views for kind, (views, _) in used.items()})
    triples: list[ox.Triple] = []
    for kind, (views, usual) in used.items():
        scenes = sorted({scene_text_iri(lesson.texts[1]) for lesson, _ in views})
        triples += size_triples(kind, measured.model(kind, usual), scenes)
    return triples


def _comparable(views: list[View]) -> list[View]:
    """Those in metres where they are enough; else all, to be compared relative to their scenes."""
    metric = [view for view in views if _metric(view)]
    return metric if len(metric) >= FEWEST else views


def _metric(view: View) -> bool:
    return view[0].scene.unit == "m"


class _Measured:
    """The sizes of the views of each kind, in metres where all of them are, else relative to the scene."""

    def __init__(self, views: Mapping[str, list[View]]) -> None:
        self._relative = {kind: not all(map(_metric, seen)) for kind, seen in views.items()}
        self._sizes = {
            kind: np.array([log_sizes(lesson.scene.boxes, self._relative[kind])[thing] for lesson, thing in seen])
            for kind, seen in views.items()
        }

    def model(self, kind: str, usual: SizeModel | None) -> SizeModel:
        relative = self._relative[kind]
        prior = usual_prior(usual) if usual is not None and not relative else self._pooled(relative)
        return learn_size(self._sizes[kind], prior, relative)

    def _pooled(self, relative: bool) -> SizePrior:
        alike: list[NDArray[np.float64]] = [
            sizes for kind, sizes in self._sizes.items() if self._relative[kind] == relative
        ]
        return pooled_prior(alike)


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
