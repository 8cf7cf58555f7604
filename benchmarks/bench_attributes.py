"""Measure how words with hidden meanings are learned: colours, sizes, shapes, surfaces, and names of kinds.

    python benchmarks/bench_attributes.py
    python benchmarks/bench_attributes.py --vocabularies 20

Each vocabulary has words whose meanings are drawn at random: a region of colours, a size, a shape, a surface above or
below some value, or a kind of things. On random tables a speaker says *the blick one* wherever the word singles one
thing out. After 1 to 20 such sentences about a word, *the blick one* must be found on new tables. The peers are a
logistic regression for each word over all measures (with the label as further columns), and chance.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from records import command_line, recorded, share

from deixis.learning.attributes import measured
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.attributes.attribute import DIMENSIONS, KIND, MEASURES, Attribute, Example

Array = NDArray[np.float64]
SENTENCES = (1, 2, 3, 5, 10, 20)
TESTS = 20
"""Number of new tables for each word and number of sentences."""

KINDS = {
    "plate": (0.26, 0.26, 0.02),
    "bowl": (0.16, 0.16, 0.07),
    "mug": (0.09, 0.09, 0.1),
    "fork": (0.025, 0.2, 0.02),
    "box": (0.14, 0.08, 0.06),
    "bottle": (0.08, 0.08, 0.28),
    "tray": (0.4, 0.25, 0.03),
    "block": (0.05, 0.05, 0.05),
}
"""Usual extents of things, in metres; each is drawn from a half to twice of them."""


@dataclass(frozen=True)
class Word:
    """A word with its hidden meaning: the mask of things of a scene that it is true of."""

    dimension: str
    true: Callable[[Array, tuple[str | None, ...]], NDArray[np.bool_]]


def random_thing(random: np.random.Generator, name: str) -> PerceivedObject:
    """Return a thing of any kind, colour and size, with a coloured cloud as a camera would see it."""
    kind = str(random.choice(list(KINDS)))
    sides = np.array(KINDS[kind]) * 2 ** random.uniform(-0.8, 0.8, 3)
    colour = random.uniform(30, 225, 3)
    gloss, pattern = random.beta(0.6, 1.2) * 0.4, random.gamma(1.2, 12.0)
    points = np.clip(colour + random.normal(0, pattern, (60, 3)), 0, 255)
    points[random.random(60) < gloss] = 250
    box = OrientedBox((0.0, 0.0, float(sides[2] / 2)), float(random.uniform(0, np.pi)), tuple(sides.tolist()))
    low, high = (-sides[0] / 2, -sides[1] / 2, 0.0), (sides[0] / 2, sides[1] / 2, sides[2])
    cloud = PointCloud(random.uniform(low, high, (60, 3)).astype(np.float32), colours=points.astype(np.uint8))
    r, g, b = (round(float(value)) for value in np.clip(colour + random.normal(0, 8, 3), 0, 255))
    seen = tuple(float(value) for value in low), tuple(float(value) for value in high)
    return PerceivedObject(name, *seen, label=kind, colour=(r, g, b), oriented=box, cloud=cloud)


Things = tuple[Array, tuple[str | None, ...]]
"""Measures (n, m) and labels of things."""

POOL = 400
"""Number of things from which the tables of a vocabulary are drawn."""


def random_things(random: np.random.Generator) -> Things:
    """Return the measures and the labels of a pool of things."""
    scene = Scene(tuple(random_thing(random, f"o{i}") for i in range(POOL)))
    return measured(scene), tuple(thing.label for thing in scene.objects)


def random_table(random: np.random.Generator, pool: Things) -> Things:
    """Return the measures and the labels of a table of 4 to 8 things."""
    chosen = random.choice(POOL, int(random.integers(4, 9)), replace=False)
    return pool[0][chosen], tuple(pool[1][i] for i in chosen)


def random_word(random: np.random.Generator, sample: Array) -> Word:
    """Return a word with a random meaning that is true of an eighth to a third of all things."""
    dimension = str(random.choice([*DIMENSIONS, KIND]))
    if dimension == KIND:
        kinds = set(random.choice(list(KINDS), int(random.integers(1, 3)), replace=False).tolist())
        return Word(KIND, lambda _, labels: np.array([label in kinds for label in labels]))
    part = random.uniform(1 / 8, 1 / 3)
    columns = [MEASURES.index(name) for name in DIMENSIONS[dimension]]
    if dimension == "colour":
        middle = sample[random.integers(len(sample))][columns]
        reach = np.quantile(np.linalg.norm(sample[:, columns] - middle, axis=1), part)
        return Word(dimension, lambda m, _: np.linalg.norm(m[:, columns] - middle, axis=1) < reach)
    column, sign = int(random.choice(columns)), random.choice([-1, 1])
    limit = np.quantile(sign * sample[:, column], 1 - part)
    return Word(dimension, lambda m, _: sign * m[:, column] > limit)


def singled_out(random: np.random.Generator, word: Word, pool: Things) -> tuple[Array, tuple[str | None, ...], int]:
    """Return a table on which a word is true of exactly one thing, and its position."""
    while True:
        measures, labels = random_table(random, pool)
        true = np.flatnonzero(word.true(measures, labels))
        if len(true) == 1:
            return measures, labels, int(true[0])


def logistic(examples: list[Example], with_labels: bool) -> Callable[[Array, tuple[str | None, ...]], Array]:
    """Return the peer: logistic regression over all measures, as scikit-learn ships it."""
    from sklearn.linear_model import LogisticRegression

    names = sorted({one.label or "" for one in examples})

    def columns(measures: Array, labels: tuple[str | None, ...]) -> Array:
        known = np.array([[float(label == name) for name in names] for label in labels])
        return np.concatenate([measures, known], axis=1) if with_labels else measures

    model = LogisticRegression()
    x = columns(np.array([one.measures for one in examples]), tuple(one.label for one in examples))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model.fit(x, [one.positive for one in examples])
    return lambda measures, labels: model.decision_function(columns(measures, labels))


def main() -> None:
    """Print learning curves, the dimensions found, and the names of kinds that are told apart."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--vocabularies", type=int, default=3)
    parser.add_argument("--words", type=int, default=6, help="words of a vocabulary")
    parser.add_argument("--swapped", type=float, default=0.0, help="share of sentences about another thing")
    with recorded(parser) as arguments:
        peers = ("ours", "logistic", "logistic with labels", "chance")
        right = {count: dict.fromkeys(peers, 0.0) for count in SENTENCES}
        found, kinds, tested = dict.fromkeys(SENTENCES, 0), dict.fromkeys(SENTENCES, 0), 0
        for seed in range(arguments.vocabularies):
            random = np.random.default_rng(seed)
            pool = random_things(random)
            for _ in range(arguments.words):
                word = random_word(random, pool[0])
                sentences = [singled_out(random, word, pool) for _ in range(max(SENTENCES))]
                tests = [singled_out(random, word, pool) for _ in range(TESTS)]
                tested += 1
                swapped = random.random(len(sentences)) < arguments.swapped
                sentences = [
                    (m, labels, int(random.integers(len(m)))) if wrong else (m, labels, place)
                    for (m, labels, place), wrong in zip(sentences, swapped, strict=True)
                ]
                for count in SENTENCES:
                    examples = [
                        Example(measures[i], labels[i], i == place)
                        for measures, labels, place in sentences[:count]
                        for i in range(len(measures))
                    ]
                    ours = Attribute("blick", tuple(examples))
                    plain, labelled = logistic(examples, False), logistic(examples, True)
                    found[count] += ours.dimension == word.dimension
                    kinds[count] += ours.names_kinds == (word.dimension == KIND)
                    for measures, labels, place in tests:
                        right[count]["ours"] += int(ours.probabilities(measures, labels).argmax()) == place
                        right[count]["logistic"] += int(plain(measures, labels).argmax()) == place
                        right[count]["logistic with labels"] += int(labelled(measures, labels).argmax()) == place
                        right[count]["chance"] += 1 / len(measures)
        print(f"{tested} words, {TESTS} new tables each; share found right after so many sentences:")
        print(f"{'':24}" + "".join(f"{count:>8}" for count in SENTENCES))
        for peer in peers:
            print(f"{peer:24}" + "".join(f"{right[count][peer] / (tested * TESTS):8.3f}" for count in SENTENCES))
        print(f"{'dimension right':24}" + "".join(f"{found[count] / tested:8.3f}" for count in SENTENCES))
        print(f"{'kind or not right':24}" + "".join(f"{kinds[count] / tested:8.3f}" for count in SENTENCES))
        for count in (3, 10):
            for peer in peers[:3]:
                share(f"{peer}, {count} sentences", round(right[count][peer]), tested * TESTS)
            share(f"kind or not, {count} sentences", kinds[count], tested)


if __name__ == "__main__":
    main()
