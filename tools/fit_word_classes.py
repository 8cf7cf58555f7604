"""Fit the weights of word classes to marked sentences, and write ``grammar/english/tagging/weights.py``.

The sentences are in ``tests/grammar/english/word_classes.txt``, one a line; ``stand/verb`` marks the class of a word
that could have several. Words without a mark may have any class. The weights maximise the probability of the marks,
with a Gaussian prior about 0; the gradient is the difference of the expected counts of the features with the marks and
without them.
"""

from __future__ import annotations

import argparse
import math
import random
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from deixis.grammar.english.rewording import words_of
from deixis.grammar.english.tagging.tagger import START, Clause, Tagger
from deixis.grammar.english.tagging.word_classes import NOMINAL, VERBAL, WordClass
from deixis.grammar.english.vocabulary.known_nouns import known_nouns
from deixis.ontology.tbox import default_ontology

ROOT = Path(__file__).parent.parent
SENTENCES = ROOT / "tests" / "grammar" / "english" / "word_classes.txt"
WEIGHTS = ROOT / "grammar" / "english" / "tagging" / "weights.py"
MARKS: dict[str, frozenset[WordClass]] = {"noun": NOMINAL, "verb": VERBAL, "base": frozenset({"base"})}
MARK = re.compile(r"/(noun|verb|base)\b")
EPOCHS, BATCH, RATE, PRECISION = 12, 16, 0.3, 0.3
"""Passes over the sentences, sentences of a step, AdaGrad's rate, and the precision of the prior."""


@dataclass(frozen=True, slots=True)
class Marked:
    """Sentence with the classes that some of its words have, by their index."""

    text: str
    tagger: Tagger
    marks: dict[int, frozenset[WordClass]]


def read_marked(file: Path) -> list[Marked]:
    """Return the marked sentences of a file."""
    nouns = known_nouns(default_ontology().kinds)
    found = []
    for line in file.read_text(encoding="utf-8").splitlines():
        text, ends = "", {}
        for i, part in enumerate(MARK.split(line)):
            if i % 2:
                ends[len(text)] = part
            else:
                text += part
        words = words_of(text, (0, len(text)))
        marks = {
            at: MARKS[ends[word.end] if ends[word.end] == "noun" else "verb"]
            for at, word in enumerate(words)
            if word.end in ends
        }
        tagger = Tagger(words, nouns, {})
        kept = {
            at: classes for at, classes in marks.items() if any(p.word_class in classes for p in tagger.possible[at])
        }
        found.append(Marked(text, tagger, kept))
    return found


def add_expected(
    marked: Marked, weights: Mapping[str, float], required: Mapping[int, frozenset[WordClass]], sign: float,
    counts: dict[str, float],
) -> None:  # fmt: skip
    """Add the expected counts of the features, times the sign."""
    tagger, get = marked.tagger, weights.get
    front: dict[Clause, float] = {START: 0.0}
    columns = []
    for at, classes in enumerate(tagger.possible):
        after: dict[Clause, float] = {}
        edges = []
        for possible in classes:
            if at in required and possible.word_class not in required[at]:
                continue
            local = tagger.features(at, possible)
            for clause, total in front.items():
                following, joint = tagger.step(clause, possible.word_class, at)
                score = sum(get(feature, 0.0) for feature in (*local, *joint))
                edges.append((clause, following, score, (*local, *joint)))
                after[following] = _log_sum(after.get(following, -math.inf), total + score)
        columns.append((edges, front))
        front = after
    whole = -math.inf
    for total in front.values():
        whole = _log_sum(whole, total)
    share = {clause: math.exp(total - whole) for clause, total in front.items()}
    for edges, before in reversed(columns):
        earlier: dict[Clause, float] = {}
        for clause, following, score, features in edges:
            part = share.get(following, 0.0) * math.exp(before[clause] + score - front[following])
            if part < 1e-9:
                continue
            earlier[clause] = earlier.get(clause, 0.0) + part
            for feature in features:
                counts[feature] = counts.get(feature, 0.0) + sign * part
        share, front = earlier, before


def _log_sum(first: float, second: float) -> float:
    high, low = max(first, second), min(first, second)
    return high if low == -math.inf else high + math.log1p(math.exp(low - high))


def fit(sentences: list[Marked]) -> dict[str, float]:
    """Return the weights that make the marks most probable; the mean over the last half of the steps."""
    weights: dict[str, float] = {}
    squares: dict[str, float] = {}
    mean: dict[str, float] = {}
    order, shuffler = list(sentences), random.Random(0)
    steps = 0
    for epoch in range(EPOCHS):
        shuffler.shuffle(order)
        for first in range(0, len(order), BATCH):
            counts: dict[str, float] = {}
            for marked in order[first : first + BATCH]:
                add_expected(marked, weights, marked.marks, 1.0, counts)
                add_expected(marked, weights, {}, -1.0, counts)
            for feature, slope in counts.items():
                slope -= PRECISION * weights.get(feature, 0.0) * BATCH / len(order)
                squares[feature] = squares.get(feature, 1e-6) + slope * slope
                weights[feature] = weights.get(feature, 0.0) + RATE * slope / math.sqrt(squares[feature])
            if epoch >= EPOCHS // 2:
                steps += 1
                for feature, weight in weights.items():
                    mean[feature] = mean.get(feature, 0.0) + weight
    return {feature: total / steps for feature, total in mean.items()}


def wrong(sentences: list[Marked], weights: Mapping[str, float]) -> list[tuple[str, str, WordClass]]:
    """Return the marked words of which the best sequence has another class: sentence, word, and that class."""
    found = []
    for marked in sentences:
        words = words_of(marked.text, (0, len(marked.text)))
        classes = Tagger(words, known_nouns(default_ontology().kinds), weights).best().classes
        found += [
            (marked.text, words[at].norm, classes[at])
            for at, allowed in marked.marks.items() if classes[at] not in allowed
        ]  # fmt: skip
    return found


def written(weights: Mapping[str, float]) -> str:
    """Return the module of the weights: a table of classes by the class or the word beside them, and single weights."""
    cells: dict[tuple[str, str], dict[str, float]] = {}
    single = {}
    for feature, weight in weights.items():
        match = CELL.fullmatch(feature)
        if abs(weight) < SMALLEST:
            continue
        if match is None:
            single[feature] = weight
        else:
            cells.setdefault((match[2], match[3]), {})[match[1]] = weight
    lines = [HEAD]
    for side in ("after", "before"):
        lines.append(f'_{side.upper()} = """')
        lines.append(" " * 16 + "".join(f"{column:>11}" for column in COLUMNS).rstrip())
        for (where, row), found in sorted(cells.items()):
            if where == side:
                values = (f"{found[column]:11.2f}" if column in found else f"{'-':>11}" for column in COLUMNS)
                lines.append(f"{row:<16}{''.join(values)}")
        lines += ['"""', EXPLAINED[side], ""]
    lines.append("_SINGLE = {")
    lines += [f'    "{feature}": {weight:.2f},' for feature, weight in sorted(single.items())]
    return "\n".join([*lines, "}", EXPLAINED["single"], TAIL])


COLUMNS = ("noun", "adjective", "finite", "base", "participle", "ing", "modal", "determiner", "pronoun")
CELL = re.compile(f"({'|'.join(COLUMNS)}) (after|before) ([a-z]+|verb or noun)")
SMALLEST = 0.05
"""Smallest absolute weight that is written."""
HEAD = '''"""Weights of the word classes: log odds in nats, written by ``tools/fit_word_classes.py``.

A positive weight is in favour of a reading. Classes and features are explained in ``tagger``.
"""

from __future__ import annotations
'''
EXPLAINED = {
    "after": '"""Class of a word (columns) after the class of the word before it (rows); *of* and *by* are words."""',
    "before": '"""Class of a word (columns) before the kind of the word after it (rows)."""',
    "single": '"""Evidence of a word for one of its classes, and of its clause for or against a verb."""',
}
TAIL = '''

def _cells(table: str, side: str) -> dict[str, float]:
    columns, *rows = table.strip("\\n").splitlines()
    found = {}
    for row in rows:
        name, values = row[:16].strip(), row[16:].split()
        for column, value in zip(columns.split(), values, strict=True):
            if value != "-":
                found[f"{column} {side} {name}"] = float(value)
    return found


WEIGHTS: dict[str, float] = {**_cells(_AFTER, "after"), **_cells(_BEFORE, "before"), **_SINGLE}
"""Weight of each feature by its name."""
'''


def main() -> None:
    """Fit the weights and write them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--held-out", action="store_true", help="fit four fifths, measure the rest, and write nothing")
    options = parser.parse_args()
    sentences = read_marked(SENTENCES)
    kept_back = sentences[::5] if options.held_out else []
    used = [marked for i, marked in enumerate(sentences) if i % 5] if options.held_out else sentences
    weights = fit(used)
    for name, some in (("fitted", used), ("held out", kept_back)):
        marks = sum(len(marked.marks) for marked in some)
        if marks:
            print(f"{name}: {1 - len(wrong(some, weights)) / marks:.4f} of {marks} marked words")
    if not options.held_out:
        WEIGHTS.write_text(written(weights), encoding="utf-8")


if __name__ == "__main__":
    main()
