"""Measure activities: which of several ways of laying a table happened, and which steps came in the wrong order.

    python benchmarks/bench_activities.py
    python benchmarks/bench_activities.py --examples 1 --noise 0.4

Each way of laying is a random partial order of steps from one small vocabulary, so that ways differ in order more than
in things. A sequence is a random order that fits, with noise: neighbours swapped, steps missing, other steps between.
The peers name the way of the nearest example, by longest common subsequence and by edit distance.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np
from records import command_line, recorded, share

from deixis.reasoning.activities.activity import Activity, Step, StepSequence
from deixis.reasoning.activities.grounding import ground_activity, recognise_activity
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import Fluent, Statement

THINGS = ("plate", "fork", "knife", "spoon", "cup", "saucer", "napkin", "glass")
OTHERS = ("candle", "vase", "phone", "book")

Way = list[list[str]]


def some_way(random: np.random.Generator) -> Way:
    """Return groups of steps, which come one group after the other."""
    things = random.permutation(THINGS)[: random.integers(5, len(THINGS) + 1)].tolist()
    cuts = sorted(random.choice(np.arange(1, len(things)), size=random.integers(2, 4), replace=False).tolist())
    return [things[a:b] for a, b in zip([0, *cuts], [*cuts, len(things)], strict=True)]


def laid(way: Way, noise: float, random: np.random.Generator) -> tuple[list[str], set[tuple[str, str]]]:
    """Return the things in the order in which they are laid, and the pairs that are in the wrong order."""
    words = [word for group in way for word in random.permutation(group).tolist()]
    words = [word for word in words if random.random() >= noise / 2]
    for at in range(len(words) - 1):
        if random.random() < noise / 2:
            words[at], words[at + 1] = words[at + 1], words[at]
    group = {word: number for number, words_of in enumerate(way) for word in words_of}
    wrong = {(b, a) for at, a in enumerate(words) for b in words[at + 1 :] if group[a] > group[b]}
    for other in OTHERS:
        if random.random() < noise:
            words.insert(int(random.integers(0, len(words) + 1)), other)
    return words, wrong


def sequence(words: Sequence[str], random: np.random.Generator) -> StepSequence:
    """Return fluents of things that are laid after one another and stay; their starts are known within bounds."""
    starts = np.cumsum(random.uniform(1.0, 4.0, len(words)))
    return StepSequence.of(
        Fluent(f"f{at}", Statement(word, "laid"), Bounds(start - 0.3, start + 0.3))
        for at, (word, start) in enumerate(zip(words, starts.tolist(), strict=True))
    )


def common(first: Sequence[str], second: Sequence[str]) -> float:
    """Return the length of the longest common subsequence, as a share of the mean length."""
    table = np.zeros((len(first) + 1, len(second) + 1))
    for a, one in enumerate(first):
        for b, other in enumerate(second):
            table[a + 1, b + 1] = table[a, b] + 1 if one == other else max(table[a, b + 1], table[a + 1, b])
    return float(2 * table[-1, -1] / max(len(first) + len(second), 1))


def edits(first: Sequence[str], second: Sequence[str]) -> float:
    """Return the negative edit distance (Levenshtein)."""
    table = np.add.outer(np.arange(len(first) + 1), np.arange(len(second) + 1))
    for a, one in enumerate(first):
        for b, other in enumerate(second):
            table[a + 1, b + 1] = min(table[a, b] + (one != other), table[a, b + 1] + 1, table[a + 1, b] + 1)
    return -float(table[-1, -1])


def nearest(
    words: Sequence[str],
    examples: Sequence[Sequence[Sequence[str]]],
    alike: Callable[[Sequence[str], Sequence[str]], float],
) -> int:
    """Return the way of the example that is most alike."""
    return int(np.argmax([max(alike(words, example) for example in of_way) for of_way in examples]))


def main() -> None:
    """Print the shares of recognised ways beside the peers, and precision and recall of wrong orders."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--worlds", type=int, default=20, help="sets of ways (20)")
    parser.add_argument("--ways", type=int, default=6, help="ways of laying in a set (6)")
    parser.add_argument("--examples", type=int, default=3, help="examples of each way (3)")
    noise = "probability of each of the other steps; half of it of a swap, and of a missing step (0.3)"
    parser.add_argument("--noise", type=float, default=0.3, help=noise)
    parser.add_argument("--seed", type=int, default=0)
    with recorded(parser) as arguments:
        random = np.random.default_rng(arguments.seed)
        right = {"relation graphs": 0, "longest common subsequence": 0, "edit distance": 0}
        asked = found_wrong = told_wrong = true_wrong = 0
        spent = 0.0
        for _ in range(arguments.worlds):
            ways = [some_way(random) for _ in range(arguments.ways)]
            examples = [[laid(way, 0.0, random)[0] for _ in range(arguments.examples)] for way in ways]
            known = [
                Activity.learned(str(number), [sequence(words, random) for words in of_way])
                for number, of_way in enumerate(examples)
            ]
            for number, way in enumerate(ways):
                for _ in range(3):
                    words, wrong = laid(way, arguments.noise, random)
                    seen = sequence(words, random)
                    started = time.process_time()
                    answer = recognise_activity(known, seen)
                    spent += time.process_time() - started
                    asked += 1
                    right["relation graphs"] += answer.name == str(number)
                    right["longest common subsequence"] += nearest(words, examples, common) == number
                    right["edit distance"] += nearest(words, examples, edits) == number
                    activity = Activity.in_order("told", [[Step(word) for word in group] for group in way])
                    swapped = {(a.thing, b.thing) for a, b in ground_activity(activity, seen).swapped}
                    told_wrong += len(swapped)
                    true_wrong += len(wrong)
                    found_wrong += len(swapped & wrong)
        for name, number in right.items():
            share(f"recognised by {name}", number, asked)
            print(f"recognised by {name}: {number} of {asked} = {number / asked:.3f}")
        share("wrong orders found", found_wrong, true_wrong)
        share("reported orders that are wrong", found_wrong, told_wrong)
        print(f"wrong orders found: {found_wrong} of {true_wrong}; {told_wrong} reported")
        print(f"{1000 * spent / asked:.1f} ms of processor time a sequence")


if __name__ == "__main__":
    main()
