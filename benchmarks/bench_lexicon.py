"""Measure the lexicon: the nouns of other people's data that it knows, how nouns fit labels, and the time to read it.

    python benchmarks/bench_lexicon.py
    python benchmarks/bench_lexicon.py --wordnet FOLDER    # also frequent nouns of general English

The labels and target nouns are those of ``refer3d`` (ScanNet, Nr3D), the things those of ``tidybot``; only figures are
printed. General English needs the package ``wordfreq`` and the files of Princeton WordNet (``data.noun`` and
``index.noun``): its nouns are the words of a frequency list whose first sense in WordNet is an artefact, food, a plant,
an animal or a part of a body. Many of them are not everyday things (*embassy*, *cartridge*) or not used as nouns.
"""

from __future__ import annotations

import csv
import gzip
import json
import re
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

import yaml
from common import data_folder
from records import command_line, count, figure, recorded, share

from deixis.ontology.inflection import singulars
from deixis.ontology.lexicon.lexicon import Lexicon
from deixis.ontology.tbox import load_ontology
from deixis.ontology.things.kinds import Kinds

CONCRETE = {"05", "06", "08", "13", "20"}
"""WordNet's files of animals, artefacts, body parts, food and plants."""


def report(name: str, words: Counter[str], lexicon: Lexicon, tbox: Kinds) -> None:
    """Print the share of words, and of their uses, that the TBox, the lexicon and head nouns know."""
    known = {
        "TBox": [word for word in words if any(one in tbox.words for one in (word, *singulars(word)))],
        "lexicon": [word for word in words if lexicon.knows(word)],
        "head noun": [word for word in words if lexicon.kind_of(word) is not None],
    }
    shares = (
        f"{how} {len(found) / len(words):.3f} ({sum(words[word] for word in found) / words.total():.3f})"
        for how, found in known.items()
    )
    share(f"{name}, known", len(known["head noun"]), len(words))
    print(f"{name:<32} {len(words):>5}  share known, of words (of uses): {', '.join(shares)}")


def nouns_of(text: str, lexicon: Lexicon) -> Iterator[str]:
    """Yield the longest known nouns of up to three words, from left to right."""
    words = re.findall(r"[a-z']+", text.lower())
    at = 0
    while at < len(words):
        ends = [end for end in (at + 3, at + 2, at + 1) if end <= len(words)]
        end = next((end for end in ends if lexicon.knows(" ".join(words[at:end]))), None)
        if end is not None:
            yield " ".join(words[at:end])
        at = end or at + 1


def report_fits(sentences: Sequence[dict[str, str]], labels: dict[str, set[str]], lexicon: Lexicon) -> None:
    """Print how often a noun of a sentence fits the label of its target, and how many other labels of the scene fit."""
    same = fitting = others = fitting_others = 0
    for row in sentences:
        nouns, label = set(nouns_of(row["utterance"], lexicon)), row["instance_type"].lower()
        same += any(lexicon.singular(noun) == lexicon.singular(label) for noun in nouns)
        fits = {
            other: max((lexicon.similarity(noun, other) for noun in nouns), default=0.0)
            for other in labels[row["scan_id"]] | {label}
        }
        fitting += fits.pop(label) >= 0.5
        others += len(fits)
        fitting_others += sum(fit >= 0.5 for fit in fits.values())
    total = len(sentences)
    share("sentences with a noun that is the label of the target", same, total)
    share("sentences with a noun that fits the label of the target", fitting, total)
    share("other labels of the scene that fit", fitting_others, others)
    print(
        f"{total} sentences that name their target: a noun is its label in {same / total:.3f} of them, fits it in "
        f"{fitting / total:.3f}; {fitting_others / total:.1f} of {others / total:.1f} other labels of the scene fit"
    )


def frequent_nouns(folder: Path) -> list[str]:
    """Return concrete nouns among the 30,000 most frequent words of English, the most frequent first."""
    from wordfreq import top_n_list

    lines = [line.split() for line in (folder / "data.noun").read_text().splitlines() if not line.startswith("  ")]
    file_of = {line[0]: line[1] for line in lines}
    first = {}
    for line in (folder / "index.noun").read_text().splitlines():
        if not line.startswith("  "):
            fields = line.split()
            first[fields[0]] = fields[-int(fields[2])]
    return [word for word in top_n_list("en", 30_000) if word in first and file_of[first[word]] in CONCRETE]


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--wordnet", type=Path, help="folder of data.noun and index.noun of Princeton WordNet")
    with recorded(parser) as options:
        measure(options.wordnet)


def measure(wordnet: Path | None) -> None:
    """Print and record the figures of each list of words."""
    ontology = load_ontology()
    started = time.process_time()
    every = len(ontology.kinds.every_word)
    print(f"{every} words, {len(ontology.kinds.words)} of them of the TBox; ", end="")
    read_ms = 1000 * (time.process_time() - started)
    print(f"the others are read in {read_ms:.0f} ms")
    count("words", every)
    figure("reading of the words", read_ms, "ms")
    lexicon = ontology.lexicon
    if (folder := data_folder("tidybot")) is not None:
        scenarios = yaml.safe_load((folder / "scenarios.yml").read_text(encoding="utf-8"))
        things = Counter(
            thing for each in scenarios for key in ("seen_objects", "unseen_objects") for thing in each[key]
        )
        report("tidybot things", Counter(re.sub(r" \d+$", "", thing) for thing in things), lexicon, ontology.kinds)
        report(
            "tidybot places",
            Counter(place for each in scenarios for place in each["receptacles"]),
            lexicon,
            ontology.kinds,
        )
    if (folder := data_folder("refer3d")) is not None:
        with gzip.open(folder / "scenes.json.gz") as file:
            scenes = {name: [thing["label"].lower() for thing in things] for name, things in json.load(file).items()}
        report(
            "labels of scenes",
            Counter(label for each in scenes.values() for label in each),
            lexicon,
            ontology.kinds,
        )
        with (folder / "nr3d_train.csv").open(encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["mentions_target_class"] == "True"]
        report("labels of targets", Counter(row["instance_type"].lower() for row in rows), lexicon, ontology.kinds)
        report_fits(rows, {name: set(each) for name, each in scenes.items()}, lexicon)
    if wordnet is not None:
        words = frequent_nouns(wordnet)
        for first in (500, 1000, 2000):
            report(f"{first} most frequent nouns of English", Counter(words[:first]), lexicon, ontology.kinds)


if __name__ == "__main__":
    main()
