"""Measure retrieval of layouts: Hits@k and MRR over 50 layouts and 200 scenes, beside a bag of kinds; and its time.

Layouts are drawn at random: a plate, and 5 to 11 other pieces of tableware in places around and on it, described by one
and a half facts per piece. Every two or three of the 50 have the same pieces in other places, so that kinds alone
cannot distinguish them. Four scenes are laid of each: every piece a little out of place and of varying size, some
pieces missing, some extra, a share of the things labelled. The bag of kinds is Dice's coefficient of the labelled kinds
alone. Seeds are printed.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from records import command_line, mean, recorded

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.comparison.likeness import ComparedScene, Comparison, Described, compared_scene
from deixis.reasoning.comparison.retrieval import rank_layouts, rank_scenes
from deixis.reasoning.geometry.rectangle import box_relations, scene_relations

ONTOLOGY = default_ontology()
RELATIONS = ONTOLOGY.relations
TOP = 10
LAYOUTS, BAGS, SCENES_EACH = 50, 20, 4
JITTER, MISSING, EXTRA = 0.015, 0.12, 1.0  # metres; share; mean number

# The pieces, with width and depth in metres when they point away from the viewer.
PIECES = {
    "dinner fork": (0.025, 0.20),
    "salad fork": (0.022, 0.17),
    "dinner knife": (0.022, 0.23),
    "fish knife": (0.022, 0.20),
    "soup spoon": (0.040, 0.18),
    "teaspoon": (0.030, 0.14),
    "dessert fork": (0.022, 0.17),
    "dessert spoon": (0.036, 0.18),
    "napkin": (0.10, 0.16),
    "bread plate": (0.16, 0.16),
    "water glass": (0.08, 0.08),
    "wine glass": (0.075, 0.075),
    "cup": (0.09, 0.08),
    "salt shaker": (0.04, 0.04),
}
# Centres in metres from that of the plate; the last two lie on it.
PLACES = np.array(
    [
        *([-0.17, 0.0], [-0.22, 0.0], [-0.30, 0.0], [0.17, 0.0], [0.22, 0.0], [0.30, 0.0]),
        *([0.0, 0.18], [0.0, 0.24], [-0.26, 0.22], [0.18, 0.22], [0.28, 0.26], [0.28, 0.16]),
        *([-0.10, 0.30], [0.10, 0.32], [-0.05, 0.0], [0.05, 0.0]),
    ]
)


@dataclass(frozen=True)
class Laid:
    """The pieces of a layout, and their boxes (n, 2, 2)."""

    kinds: tuple[str, ...]
    boxes: NDArray[np.float64]


def laid(bag_of_kinds: int, rng: np.random.Generator, seed: int) -> Laid:
    """Return a layout: the pieces of one of the bags, in places of its own."""
    choosing = np.random.default_rng([seed, bag_of_kinds])
    count = int(choosing.integers(5, 12))
    kinds = [str(kind) for kind in choosing.choice(list(PIECES), count)]
    centres = np.concatenate([[[0.0, 0.0]], PLACES[rng.choice(len(PLACES), count, replace=False)]])
    sizes = np.array([(0.27, 0.27), *(PIECES[kind] for kind in kinds)])
    return Laid(("dinner plate", *kinds), boxes_at(centres, sizes))


def boxes_at(centres: NDArray[np.float64], sizes: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.stack([centres - sizes / 2, centres + sizes / 2], axis=1)


def described(name: str, layout: Laid, rng: np.random.Generator) -> Described:
    n = len(layout.kinds)
    names = box_relations(layout.boxes, RELATIONS).names
    pairs = [(i, j) for i in range(n) for j in range(n) if i != j]
    chosen = rng.choice(len(pairs), round(1.5 * n), replace=False)
    exact = list(RELATIONS.values())
    objects = [f"{kind.replace(' ', '_')}_{i}" for i, kind in enumerate(layout.kinds)]
    facts = [Fact(objects[i], (RELATIONS.wide(exact[names[i, j]]),), objects[j]) for i, j in (pairs[k] for k in chosen)]
    return Described(name, RelationGraph.from_facts(RELATIONS, objects, facts, kinds=[iri(k) for k in layout.kinds]))


def scene(name: str, layout: Laid, labelled: float, rng: np.random.Generator) -> ComparedScene:
    kept = rng.random(len(layout.kinds)) >= MISSING
    kinds = [kind for kind, keep in zip(layout.kinds, kept, strict=True) if keep]
    centres, sizes = layout.boxes[kept].mean(axis=1), np.diff(layout.boxes[kept], axis=1)[:, 0]
    more = [str(kind) for kind in rng.choice(list(PIECES), rng.poisson(EXTRA))]
    centres = np.concatenate([centres, rng.uniform([-0.4, -0.1], [0.4, 0.4], (len(more), 2))])
    sizes = np.concatenate([sizes, np.array([PIECES[kind] for kind in more]).reshape(-1, 2)])
    boxes = boxes_at(centres + rng.normal(0, JITTER, centres.shape), sizes * rng.uniform(0.9, 1.1, (len(sizes), 1)))
    seen_kinds = [iri(kind) if rng.random() < labelled else None for kind in (*kinds, *more)]
    order = rng.permutation(len(boxes))
    ids = [f"o{k}" for k in range(len(boxes))]
    return compared_scene(name, scene_relations(ids, boxes[order], RELATIONS, [seen_kinds[k] for k in order]))


def iri(word: str) -> str:
    kind = ONTOLOGY.kinds.of_word(word)
    assert kind is not None, word
    return kind.iri


def bag(layout: Described, one: ComparedScene) -> float:
    """Return Dice's coefficient of kinds, without unlabelled things in the intersection."""
    common = Counter(layout.graph.kinds) & Counter(kind for kind in one.kinds if kind is not None)
    return 2 * sum(common.values()) / (len(layout.graph.nodes) + len(one.kinds))


def by_bag(scenes: list[ComparedScene], layouts: list[Described], backwards: bool) -> list[list[str]]:
    """Rank by the bag of kinds: layouts for each scene or, ``backwards``, scenes for each layout."""
    scores = np.array([[bag(layout, one) for layout in layouts] for one in scenes])
    names = [one.name for one in (scenes if backwards else layouts)]
    return [[names[k] for k in np.argsort(-row, kind="stable")[:TOP]] for row in (scores.T if backwards else scores)]


def figures(what: str, ranked: list[list[str]], wanted: list[str]) -> str:
    """Return Hits at 1, 3 and 10, and the mean reciprocal rank (0 beyond ``TOP``) with its standard error.

    A ranking is right at the first name that begins with the wanted one.
    """
    ranks = [
        next((rank for rank, name in enumerate(names, start=1) if name.startswith(start)), np.inf)
        for names, start in zip(ranked, wanted, strict=True)
    ]
    reciprocal = 1 / np.array(ranks)
    mean(f"{what}: right one first", np.array(ranks) <= 1)
    mean(f"{what}: mean reciprocal rank", reciprocal)
    hits = "  ".join(f"Hits@{k} {np.mean(np.array(ranks) <= k):.3f}" for k in (1, 3, 10))
    error = reciprocal.std(ddof=1) / np.sqrt(len(ranks))
    return f"{hits}  MRR {reciprocal.mean():.3f} (s.e. {error:.3f})"


def measure(labelled: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    tables = [laid(k % BAGS, rng, seed) for k in range(LAYOUTS)]
    layouts = [described(f"L{k:02}", table, rng) for k, table in enumerate(tables)]
    scenes = [
        scene(f"L{k:02}-{copy}", table, labelled, rng) for k, table in enumerate(tables) for copy in range(SCENES_EACH)
    ]
    comparison = Comparison(ONTOLOGY)
    comparison.likeness(layouts[0], scenes[0])
    started = time.perf_counter()
    by_scene = [[found.layout for found in rank_layouts(one, layouts, comparison, TOP)] for one in scenes]
    middle = time.perf_counter()
    by_layout = [[found.scene for found in rank_scenes(one, scenes, comparison, TOP)] for one in layouts]
    ended = time.perf_counter()
    print(f"{labelled:.0%} of the things labelled, seed {seed}: {LAYOUTS} layouts, {len(scenes)} scenes")
    setting = f"{labelled:.0%} labelled"
    wanted, kinds = [one.name[:3] for one in scenes], by_bag(scenes, layouts, backwards=False)
    print(f"  scene to layouts  similarity    {figures(f'{setting}, scene to layouts, similarity', by_scene, wanted)}")
    print(f"                    bag of kinds  {figures(f'{setting}, scene to layouts, bag of kinds', kinds, wanted)}")
    wanted, kinds = [one.name for one in layouts], by_bag(scenes, layouts, backwards=True)
    print(f"  layout to scenes  similarity    {figures(f'{setting}, layout to scenes, similarity', by_layout, wanted)}")
    print(f"                    bag of kinds  {figures(f'{setting}, layout to scenes, bag of kinds', kinds, wanted)}")
    print(f"  {middle - started:.1f} s for {len(scenes)} scenes, {ended - middle:.1f} s for {LAYOUTS} layouts")


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--seed", type=int, default=1)
    with recorded(parser) as options:
        for labelled in (1.0, 0.5, 0.0):
            measure(labelled, options.seed)


if __name__ == "__main__":
    main()
