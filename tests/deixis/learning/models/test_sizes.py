"""Sizes learned from lessons: which views count, each box once, and from how many views a size is learned."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pyoxigraph as ox
import pytest

from deixis.learning.lessons.recollection import MatchedThings, Recollection, Remembered
from deixis.learning.models.sizes import FEWEST, Counts, SizeStatistics, size_views
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.sizes import SizeModel, size_triples, sizes_from_triples
from deixis.ontology.tbox import Ontology, default_ontology
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.grounding.evidence.properties.labels import category_of

ONTOLOGY = default_ontology()
PLATE, FORK = (kind.iri for word in ("dinner plate", "fork") if (kind := ONTOLOGY.kinds.of_word(word)))


def seen(
    lesson: str,
    length: float,
    *,
    kind: str | None = PLATE,
    decided: bool = True,
    sure: float = 1.0,
    label: str | None = None,
    confidence: float = 1.0,
    unit: str = "m",
) -> Remembered:
    """Return a lesson of a thing half as wide as long, beside an unknown one of length 1."""
    description = RelationGraph.from_facts(ONTOLOGY.relations, ["x"], [], kinds=[kind])
    place = len(lesson) / 100
    thing = PerceivedObject("o1", (place, 0.0), (place + length, length / 2), label, confidence)
    other = PerceivedObject("o2", (2.0, 0.0), (3.0, 1.0))
    scene, matched = Scene((thing, other), unit=unit), MatchedThings((0,), (sure,), (decided,))
    return Remembered(lesson, description, scene, matched, ("", lesson))


def learned_size_triples(recollection: Recollection, ontology: Ontology) -> list[ox.Triple]:
    """Return the sizes that lessons teach, with the scenes that they are derived from, counted from scratch."""
    statistics = SizeStatistics(Counts(), ontology.sizes)
    for lesson in recollection.lessons:
        for view in size_views(lesson, ontology.kinds):
            statistics.add(view)
    statistics.settle()
    triples: list[ox.Triple] = []
    for kind, (model, _, scenes) in sorted(statistics.models().items(), key=lambda entry: entry[0]):
        if model is not None:
            triples += size_triples(kind, model, sorted(scenes))
    return triples


def sizes(lessons: Sequence[Remembered]) -> dict[str, SizeModel]:
    return sizes_from_triples(learned_size_triples(Recollection(tuple(lessons)), ONTOLOGY))


def test_a_size_lies_between_the_usual_one_and_the_median() -> None:
    usual = math.log(ONTOLOGY.sizes.of(PLATE).length.typical)
    lengths = (0.2, 0.21, 0.22, 0.23, 2.3)
    (found,) = sizes([seen("a" * n, length) for n, length in enumerate(lengths, 1)]).values()
    assert math.log(0.22) < found.length[0] < usual
    (many,) = sizes([seen("a" * n, lengths[n % 4] + n * 1e-6) for n in range(1, 60)]).values()
    assert math.exp(many.length[0]) == pytest.approx(0.22, rel=0.02)
    assert (many.relative, many.views) == (False, 59)


def test_one_view_teaches_the_size_of_an_unknown_kind() -> None:
    thingummies = [seen("a" * n, 0.2, kind=None, label=f"Thingummy_{n}") for n in (1, 2)]
    found = sizes([thingummies[0], seen("bbb", 0.4, kind=None)])
    assert sorted(found) == [category_of("thingummy"), category_of("x")]
    assert found[category_of("thingummy")].views == 1
    assert sizes(thingummies)[category_of("thingummy_7")].views == 2


def test_with_too_few_views_the_usual_size_stays() -> None:
    lessons = [seen("a" * n, 0.2) for n in range(1, FEWEST + 1)]
    assert sizes(lessons[:-1]) == {}
    assert list(sizes(lessons)) == [PLATE]


def test_a_box_counts_once_for_all_lessons_that_show_it() -> None:
    assert sizes([seen("abc", 0.2), seen("xyz", 0.2), seen("123", 0.2)]) == {}


@pytest.mark.parametrize("doubt", [{"decided": False}, {"sure": 0.5}])
def test_what_is_doubtful_teaches_nothing(doubt: dict[str, object]) -> None:
    assert sizes([seen("a" * n, 0.2, **doubt) for n in range(1, 5)]) == {}  # type: ignore[arg-type]


def test_confident_labels_teach_with_or_without_a_number() -> None:
    def labelled(label: str, confidence: float) -> list[Remembered]:
        return [seen("a" * n, 0.2, kind=None, label=label, confidence=confidence, decided=False) for n in range(1, 5)]

    assert list(sizes(labelled("fork_2", 0.95))) == [FORK]
    assert list(sizes(labelled("Gizmo", 0.95))) == [category_of("gizmo")]
    assert sizes(labelled("fork", 0.6)) == {}


def test_scenes_in_pixels_teach_relative_sizes() -> None:
    pixels = [seen("a" * n, 0.5, unit="px") for n in range(1, 4)]
    (found,) = sizes(pixels).values()
    assert found.relative
    assert math.exp(found.length[0]) == pytest.approx(0.5 / 0.75, rel=1e-5)  # the median of 0.5 and 1
    (found,) = sizes([*pixels, *(seen("b" * n, 0.2) for n in range(4, 7))]).values()
    assert (found.relative, found.views) == (False, 3)
    assert math.exp(found.length[0]) == pytest.approx(0.21, rel=0.01)  # between 0.2 and the usual 0.27
