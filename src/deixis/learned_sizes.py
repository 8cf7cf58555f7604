"""How large things of a kind are, from all that is remembered: of each kind that was seen often enough."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator

import pyoxigraph as ox

from deixis.ontology.kinds import Kinds
from deixis.ontology.lesson_triples import scene_text_iri
from deixis.ontology.size_model import SizeModel
from deixis.ontology.size_model_triples import size_triples
from deixis.reasoning.graded.unary import learn_size
from deixis.remembered import Recollection, Remembered

FEWEST = 3
"""Views from which a size is learned. With fewer, one wrong view moves the median at will: the usual size stays."""

SURE = 0.9
"""Confidence from which a label says what a thing is like; a median bears the tenth that is wrong."""

View = tuple[Remembered, int]  # a lesson, and the place of a thing in its scene


def learned_size_triples(recollection: Recollection, kinds: Kinds) -> list[ox.Triple]:
    """The sizes that the lessons teach, with the scenes that they are derived from."""
    triples: list[ox.Triple] = []
    for kind, views in _views(recollection, kinds).items():
        used = _used(views)
        if used is not None:
            scenes = sorted({scene_text_iri(lesson.texts[1]) for lesson, _ in used[1]})
            triples += size_triples(kind, used[0], scenes)
    return triples


def _used(views: list[View]) -> tuple[SizeModel, list[View]] | None:
    """The model of a kind and what taught it: in metres where enough was measured so, else relative to the scene."""
    metric = [view for view in views if view[0].scene.unit == "m"]
    used, relative = (metric, False) if len(metric) >= FEWEST else (views, True)
    if len(used) < FEWEST:
        return None
    return learn_size([(lesson.scene.boxes, thing) for lesson, thing in used], relative), used


def _views(recollection: Recollection, kinds: Kinds) -> dict[str, list[View]]:
    """Every thing that is known to be of a kind, by class IRI; the same box once, however many lessons show it."""
    found: dict[str, dict[bytes, View]] = defaultdict(dict)
    for lesson in recollection.lessons:
        for kind, thing in [*_matched(lesson), *_labelled(lesson, kinds)]:
            found[kind].setdefault(lesson.scene.boxes[thing].tobytes(), (lesson, thing))
    return {kind: list(views.values()) for kind, views in sorted(found.items())}


def _matched(lesson: Remembered) -> Iterator[tuple[str, int]]:
    kinds = lesson.description.kinds or (None,) * len(lesson.description.nodes)
    for kind, thing, decided, sure in zip(
        kinds, lesson.who.things, lesson.who.decided, lesson.who.sureness, strict=True
    ):
        if kind is not None and thing is not None and decided and sure >= SURE:
            yield kind, thing


def _labelled(lesson: Remembered, kinds: Kinds) -> Iterator[tuple[str, int]]:
    for place, thing in enumerate(lesson.scene.objects):
        kind = kinds.of_word(re.sub(r"_\d+$", "", thing.label)) if thing.label else None
        if kind is not None and thing.confidence >= SURE:
            yield kind.iri, place
