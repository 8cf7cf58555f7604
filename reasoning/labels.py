"""What the labels of perceived things say about who is who.

A certain label fixes its thing: it can only be an object that the label names, and where the script names no such
object it is none of them. A label names the object that bears it as its name (``wine_glass`` names ``wine_glass_1``),
else every object of a kind that the label stands for. A label of confidence c below 1 weighs -ln(1 - c), the
logarithm of how often it is right to how often wrong it is at worst, in units of one satisfied fact; so certainty is
its limit, and what cannot be told from chance weighs nothing.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kind, Kinds


@dataclass(frozen=True, slots=True)
class Label:
    """A name that perception gives a thing, right with probability ``confidence`` (0 to 1; 1 is certain)."""

    text: str
    confidence: float = 1.0


def label_evidence(
    description: RelationGraph, labels: Sequence[Label | None], kinds: Kinds
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """What is allowed and what speaks for it, both (n1, n2), from the labels of n2 perceived things."""
    allowed = np.ones((len(description.nodes), len(labels)), dtype=bool)
    bonus = np.zeros(allowed.shape)
    for column, label in enumerate(labels):
        if label is None or label.confidence <= 0:
            continue
        named = named_objects(description, label.text, kinds)
        if label.confidence >= 1:
            allowed[:, column] = named
        else:
            bonus[named, column] = -math.log1p(-label.confidence)
    return allowed, bonus


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
    return np.array([_plain(re.sub(r"_\d+$", "", node)) == plain for node in description.nodes], dtype=bool)


def _is_a(iri: str | None, kind: Kind, kinds: Kinds) -> bool:
    return iri is not None and kinds.is_a(kinds[iri], kind)


def _plain(name: str) -> str:
    return " ".join(unicodedata.normalize("NFC", name).casefold().replace("_", " ").split())
