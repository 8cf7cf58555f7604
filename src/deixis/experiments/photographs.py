"""Read descriptions of photographs (Visual Relationship Detection, Lu et al. 2016) as descriptions and boxes.

Each image with four or more objects that the ten exact words relate becomes a scene (its boxes, y turned up, without
labels) and a description: the statements of the annotators about these objects, in the words of the layout language.
The objects are called as the annotators called them, and numbered (``person_1``), of the kinds that these names stand
for. The truth is the box that each object refers to. The data is read from ``$DEIXIS_DATA/vrd``.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.models.relations import FAMILIES
from deixis.ontology.tbox import Ontology

FOLDER = "vrd"
MIN_OBJECTS = 4
"""Minimum number of objects that the ten exact words relate in a photograph."""

WORDS = {
    "on": "on",
    "on the top of": "on",
    "above": "top",
    "over": "top",
    "below": "bottom",
    "under": "bottom",
    "beneath": "bottom",
    "on the left of": "left",
    "on the right of": "right",
    "near": "near",
    "by": "near",
    "next to": "next_to",
    "beside": "next_to",
    "adjacent to": "next_to",
    "in the front of": "in_front",
    "behind": "behind",
    "in": "inside",
    "inside": "inside",
    "touch": "touching",
    "contain": "containing",
}
"""Words of the layout language for the predicates of the annotators that have one."""


End = tuple[int, ...]
"""Category and box of an object in the annotations: ymin, ymax, xmin, xmax in pixels."""


class PhotographError(DeixisError, ValueError):
    """Files that are not annotations of photographs."""


class Photograph(NamedTuple):
    """The description of n objects, and the boxes that they refer to, in the order of the description's nodes."""

    description: RelationGraph
    boxes: NDArray[np.float64]  # (n, 2, 2): minimum and maximum corner, pixels, y up


def photographs_folder() -> Path | None:
    """Return the folder of the annotations, or None if DEIXIS_DATA does not lead to them.

    Returns
    -------
    Path or None
        Existing folder ``vrd`` under the folder that DEIXIS_DATA names.
    """
    root = os.environ.get("DEIXIS_DATA")
    folder = Path(root) / FOLDER if root else None
    return folder if folder is not None and folder.is_dir() else None


def photographs(folder: Path, ontology: Ontology) -> Iterator[Photograph]:
    """Yield all images with enough related objects, by name.

    Parameters
    ----------
    folder
        Folder with ``annotations.json``, ``predicates.json`` and ``objects.json``.
    ontology
        Ontology whose relations and kinds the words of the annotators stand for.

    Yields
    ------
    Photograph
        Image with at least :data:`MIN_OBJECTS` objects that the statements relate.

    Raises
    ------
    PhotographError
        If the files cannot be read or are not annotations of Visual Relationship Detection.
    """
    try:
        annotations: dict[str, list[Any]] = json.loads((folder / "annotations.json").read_text(encoding="utf-8"))
        predicates: list[str] = json.loads((folder / "predicates.json").read_text(encoding="utf-8"))
        words: list[str] = json.loads((folder / "objects.json").read_text(encoding="utf-8"))
        for name in sorted(annotations):
            found = _photograph(annotations[name], predicates, words, ontology)
            if len(found.boxes) >= MIN_OBJECTS:
                yield found
    except (OSError, KeyError, IndexError, TypeError, AttributeError, json.JSONDecodeError) as error:
        raise PhotographError(
            f"{folder}: no annotations of Visual Relationship Detection ({type(error).__name__}: {error})"
        ) from error


def _photograph(entries: list[Any], predicates: list[str], words: list[str], ontology: Ontology) -> Photograph:
    stated: dict[tuple[str, End, End], None] = {}
    for entry in entries:
        word = WORDS.get(predicates[entry["predicate"]])
        subject, other = ((entry[end]["category"], *entry[end]["bbox"]) for end in ("subject", "object"))
        if word is not None and subject != other:
            stated[word, subject, other] = None
    boxes: dict[End, str] = {}
    for word, *ends in stated:
        if word in FAMILIES:
            for end in ends:
                boxes.setdefault(end, f"{words[end[0]].replace(' ', '_')}_{len(boxes)}")
    relations, names = ontology.relations, list(boxes.values())
    facts = [
        Fact(boxes[subject], (relations[word],), boxes[other])
        for word, subject, other in stated
        if subject in boxes and other in boxes
    ]
    kinds = [kind.iri if (kind := ontology.of_name(name)[0]) else None for name in names]
    corners = [[[x0, -y1], [x1, -y0]] for _, y0, y1, x0, x1 in boxes]
    return Photograph(RelationGraph.from_facts(relations, names, facts, kinds=kinds), np.array(corners, dtype=float))
