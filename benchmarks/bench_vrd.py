"""Grounding what people wrote down about photographs (Visual Relationship Detection, Lu et al. 2016).

Each image with four or more related objects becomes a scene (its boxes, y turned up, nothing named) and a script (what
people said of them, in the words that the layout language has). The truth is which box was meant. For each engine: the
share of objects named right, a mean over images, each a mean over random node orders.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from common import data_folder
from numpy.typing import NDArray

from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relations
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.engines import Engine, engine_named
from deixis.reasoning.evidence import Evidence, no_unary_evidence
from deixis.reasoning.rectangle import perceived_graph

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
}


def cases(folder: Path, relations: Relations) -> Iterator[tuple[RelationGraph, NDArray[np.float64]]]:
    """Descriptions with the boxes that their objects mean, in node order."""
    annotations: dict[str, list[Any]] = json.loads((folder / "annotations.json").read_text(encoding="utf-8"))
    predicates: list[str] = json.loads((folder / "predicates.json").read_text(encoding="utf-8"))
    for name in sorted(annotations):
        boxes: dict[tuple[int, ...], str] = {}
        facts: dict[tuple[str, str, str], None] = {}
        for entry in annotations[name]:
            word = WORDS.get(predicates[entry["predicate"]])
            ends = [(entry[end]["category"], *entry[end]["bbox"]) for end in ("subject", "object")]
            if word is not None and ends[0] != ends[1]:
                subject, object = (boxes.setdefault(end, f"thing_{len(boxes)}") for end in ends)
                facts[word, subject, object] = None
        if len(boxes) >= 4:
            stated = [Fact(subject, (relations[word],), object) for word, subject, object in facts]
            corners = [[[x0, -y1], [x1, -y0]] for _, y0, y1, x0, x1 in boxes]
            yield RelationGraph.from_facts(relations, list(boxes.values()), stated), np.array(corners, dtype=float)


def share_right(
    engine: Engine, description: RelationGraph, boxes: NDArray[np.float64], rng: np.random.Generator, limit: float
) -> float:
    """The share named right with both sides listed in a random order."""
    n = len(boxes)
    rows, columns = rng.permutation(n), rng.permutation(n)
    scene = perceived_graph([f"o{i}" for i in columns], boxes[columns], description.vocabulary)
    ordered = description.subgraph([description.nodes[i] for i in rows])
    evidence: Evidence = no_unary_evidence(ordered, scene)
    found = engine.align(evidence, time.perf_counter() + limit).assignment
    return float(np.mean(columns[found] == rows))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orders", type=int, default=10, help="random node orders an image")
    parser.add_argument("--engines", default="similarity,exact")
    parser.add_argument("--time-limit", type=float, default=2.0, help="seconds an alignment")
    options = parser.parse_args()
    folder = data_folder("vrd")
    if folder is None:
        return
    relations = default_ontology().relations
    images = list(cases(folder, relations))
    sizes = [len(boxes) for _, boxes in images]
    print(f"{len(images)} images of 4 to {max(sizes)} objects, {options.orders} node orders, seed 1")
    for name in options.engines.split(","):
        rng, started = np.random.default_rng(1), time.perf_counter()
        engine = engine_named(name)
        shares = [
            np.mean([share_right(engine, *image, rng, options.time_limit) for _ in range(options.orders)])
            for image in images
        ]
        error = np.std(shares) / np.sqrt(len(shares))
        taken = time.perf_counter() - started
        print(f"{name:<12} share right {np.mean(shares):.3f} (standard error {error:.3f}), {taken:.0f} s")


if __name__ == "__main__":
    main()
