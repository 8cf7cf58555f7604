"""Which objects of a description the label of a perceived thing names.

A label names the object that bears it as its name (``wine_glass`` names ``wine_glass_1``), else every object of a kind
that the label stands for. What that weighs: :func:`deixis.reasoning.graded.unary.label_ratios`.
"""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.iris import category_iri
from deixis.ontology.kinds import Kind, Kinds, plain_name


@dataclass(frozen=True, slots=True)
class Label:
    """A name that perception gives a thing, right with probability ``confidence`` (0 to 1; 1 is certain)."""

    text: str
    confidence: float = 1.0


def named_objects(description: RelationGraph, label: str, kinds: Kinds) -> NDArray[np.bool_]:
    """Which objects of a description a label names, shape (n1,)."""
    named = objects_called(description, label)
    kind = kinds.of_word(label)
    if named.any() or kind is None:
        return named
    return np.array([_is_a(iri, kind, kinds) for iri in description.kinds or [None] * len(named)], dtype=bool)


def objects_called(description: RelationGraph, name: str) -> NDArray[np.bool_]:
    """Which objects bear a name, or a number of it: ``wine_glass`` calls ``wine_glass_1`` and ``wine_glass_2``."""
    plain = _plain(name)
    same = np.array([_plain(node) == plain for node in description.nodes], dtype=bool)
    if same.any():
        return same
    return np.array([_plain(plain_name(node)) == plain for node in description.nodes], dtype=bool)


def category_of(name: str) -> str:
    """The class of things that bear a name, with whatever number: the category that is learned where it is no kind's.

    >>> category_of("fish_knife_2") == category_of("Fish knife")
    True
    """
    return category_iri(_plain(plain_name(name)).replace(" ", "_"))


def classes(description: RelationGraph) -> tuple[str, ...]:
    """The class of each object of a description, an IRI: its kind, else the category of its name."""
    kinds = description.kinds or (None,) * len(description.nodes)
    return tuple(kind or category_of(node) for kind, node in zip(kinds, description.nodes, strict=True))


def _is_a(iri: str | None, kind: Kind, kinds: Kinds) -> bool:
    return iri is not None and kinds.is_a(kinds[iri], kind)


def _plain(name: str) -> str:
    return " ".join(unicodedata.normalize("NFC", name).casefold().replace("_", " ").split())
