"""Measure how much of English sentences the parser understands, and its time a sentence.

Sentences of people from ``$DEIXIS_DATA``: paragraphs about tables (``english``), descriptions of objects in rooms
(``refer3d``: Nr3D, Sr3D, ScanRefer), of blocks (``blocks``), and stories of StepGame (``stepgame``). A word can be
understood wrongly; ``bench_refer.py`` and ``bench_stepgame.py`` measure that.
"""

from __future__ import annotations

import csv
import json
import time
from collections.abc import Iterator
from pathlib import Path

from common import data_folder
from records import command_line, figure, recorded, share

from deixis.grammar.english.parse import parse_english
from deixis.grammar.english.tree import Sentence

TEXTS_PER_SOURCE = 2000


def sources(data: Path) -> Iterator[tuple[str, list[str]]]:
    """Yield the name of each source with its texts."""
    yield "paragraphs", [path.read_text(encoding="utf-8") for path in sorted(data.glob("english/*/text.txt"))]
    for name, file in (("Nr3D", "nr3d_train.csv"), ("Sr3D", "sr3d_dev.csv")):
        with (data / "refer3d" / file).open(encoding="utf-8") as rows:
            yield name, [row["utterance"] for row in csv.DictReader(rows)]
    described = json.loads((data / "refer3d" / "scanrefer_train.json").read_text(encoding="utf-8"))
    yield "ScanRefer", [one["description"] for one in described]
    blocks = json.loads((data / "blocks" / "instructions.json").read_text(encoding="utf-8"))
    yield "blocks", [one["instruction"] for one in blocks]
    lines = (line for path in sorted(data.glob("stepgame/*/qa5_valid.txt")) for line in path.open(encoding="utf-8"))
    yield "StepGame", [line.partition(" ")[2].partition("\t")[0] for line in lines]


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        measure()


def measure() -> None:
    """Print and record the figures of each source."""
    folder = data_folder("refer3d")
    if folder is None:
        return
    parse_english("The fork is to the left of the plate.")  # reads the words and compiles the grammar
    print(f"{'source':12} {'sentences':>9} {'words':>7} {'understood':>10} {'whole':>7} {'ms each':>8}")
    for name, texts in sources(folder.parent):
        began = time.process_time()
        found: list[Sentence] = [s for text in texts[:TEXTS_PER_SOURCE] for s in parse_english(text) if not s.heading]
        seconds = time.process_time() - began
        words = sum(sentence.words for sentence in found)
        understood = sum(sentence.words_understood for sentence in found)
        whole = sum(not sentence.misunderstood for sentence in found)
        share(f"{name}: words understood", understood, words)
        share(f"{name}: sentences understood whole", whole, len(found))
        figure(f"{name}: processor time per sentence", 1000 * seconds / len(found), "ms")
        print(
            f"{name:12} {len(found):9} {words:7} {understood / words:10.3f} {whole / len(found):7.3f} "
            f"{1000 * seconds / len(found):8.2f}"
        )


if __name__ == "__main__":
    main()
