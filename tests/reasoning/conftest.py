"""Shared fixtures of the tests of reasoning: relations, graphs from text, boxes, and scripts of a formal dinner."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact, RelationGraph, Source
from deixis.ontology.relations.relation import Relations
from deixis.ontology.tbox import default_ontology

SENTENCE = re.compile(r"(optional )?(?:([\d.]+) )?(not )?([a-z_ ]+)\((\w+), (\w+)\)")

FIGURE_7 = """right(water_glass, dinner_plate)
on(napkin, dinner_plate)
top_left(bread_plate, dinner_plate)
on(butter_knife, bread_plate)
left(salad_fork, dinner_plate)
left(dinner_fork, dinner_plate)
top(dessert_fork, dinner_plate)
top(dessert_spoon, dinner_plate)
right(dinner_knife, dinner_plate)
right(fish_knife, dinner_plate)
right(soup_spoon, fish_knife)"""

FULL = """on(napkin, dinner_plate)
top_left(bread_plate, dinner_plate)
on(butter_knife, bread_plate)
left(salad_fork, dinner_fork)
left(dinner_fork, dinner_plate)
left(dinner_plate, dinner_knife)
left(dinner_knife, fish_knife)
left(fish_knife, soup_spoon)
top(dessert_fork, dinner_plate)
top(dessert_spoon, dessert_fork)
top(water_glass, dinner_knife)"""

ABSENT = """right(white_wine_glass, water_glass)
right(red_wine_glass, white_wine_glass)
top(champagne_glass, white_wine_glass)"""


def read(sentence: str, number: int) -> Fact:
    """Return the fact of a sentence such as ``optional 0.8 not left or top(a, b)``, on the line of its number."""
    found = SENTENCE.fullmatch(sentence)
    assert found is not None, sentence
    optional, weight, denied, words, subject, object = found.groups()
    relations = default_ontology().relations
    return Fact(
        subject,
        tuple(relations[word] for word in words.split(" or ")),
        object,
        positive=not denied,
        optional=bool(optional),
        weight=float(weight or 1),
        source=Source("test.layout", number + 1, 1, number + 1, 1 + len(sentence)),
    )


@pytest.fixture(scope="session")
def relations() -> Relations:
    return default_ontology().relations


@pytest.fixture(scope="session")
def facts_of() -> Callable[..., list[Fact]]:
    """Function that reads sentences as facts, one per line."""
    return lambda *sentences: [read(sentence, number) for number, sentence in enumerate(sentences)]


@pytest.fixture(scope="session")
def graph_of() -> Callable[..., RelationGraph]:
    """Function that reads sentences as a graph; nodes are in the given order, or in the order of their first use."""

    def graph(*sentences: str, nodes: str | Sequence[str] = (), kinds: Sequence[str | None] = ()) -> RelationGraph:
        facts = [read(sentence, number) for number, sentence in enumerate(sentences)]
        listed = nodes.split() if isinstance(nodes, str) else list(nodes)
        names = listed or list(dict.fromkeys(name for fact in facts for name in (fact.subject, fact.object)))
        return RelationGraph.from_facts(default_ontology().relations, names, facts, kinds=kinds)

    return graph


@pytest.fixture(scope="session")
def figure_7() -> list[str]:
    return FIGURE_7.splitlines()


@pytest.fixture(scope="session")
def full_script() -> list[str]:
    return FULL.splitlines()


@pytest.fixture(scope="session")
def absent_glasses() -> list[str]:
    return ABSENT.splitlines()


@pytest.fixture(scope="session")
def boxes_of() -> Callable[..., NDArray[np.float64]]:
    """Function that makes boxes from extents: ``boxes_of([(x0, x1), (y0, y1)], …)`` has shape (n, 2, d)."""

    def boxes(*extents: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
        return np.array([np.array(axes, dtype=np.float64).T for axes in extents])

    return boxes


@pytest.fixture(scope="session")
def random_boxes() -> Callable[..., NDArray[np.float64]]:
    """Function that draws boxes with integer corners from 0 to 6, with many ties; points and lines can be excluded."""

    def boxes(
        data: st.DataObject, least: int = 2, most: int = 5, axes: int = 2, shortest: int = 0
    ) -> NDArray[np.float64]:
        extent = st.tuples(st.integers(0, 6), st.integers(shortest, 4)).map(lambda e: (e[0], e[0] + e[1]))
        box = st.tuples(*[extent] * axes)
        drawn = data.draw(st.lists(box, min_size=least, max_size=most), label="boxes")
        return np.array(drawn, dtype=np.float64).transpose(0, 2, 1)

    return boxes
