"""Measure telling: whether texts are read as the facts they say, and find the objects of their scenes again.

Layouts are random facts about 12 objects (denied, hedged and optional ones, choices, graded words); some contradict
themselves. ``$DEIXIS_DATA/english`` adds its paragraphs, which are read and told again with their claims.
Scenes are the shipped ones and tables drawn from seeds (8 objects of 5 labels, no overlap), with and without labels.

Prints the share of facts that reading the text gives again, words per fact, and the share of objects that grounding the
text decides right and that a description singles out (``refer``).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from common import data_folder
from records import command_line, recorded, share

import deixis

NAMES = (
    "fork",
    "knife",
    "spoon",
    "plate",
    "bowl",
    "cup_1",
    "cup_2",
    "wine_glass",
    "dinner_fork",
    "jug",
    "napkin",
    "pan",
)
WORDS = ("left of", "right of", "above", "below", "on", "top left of", "near", "behind", "inside", "taller than")
FRONTS = ("", "", "", "", "not ", "usually ", "probably ", "optional ")
LABELS = ("plate", "cup", "cup", "cup", "fork", "fork", "jug", "spoon")
EXAMPLES = Path(__file__).parents[1] / "examples"


def layouts(number: int) -> Iterator[deixis.Script]:
    """Yield random layouts of 3 to 12 facts."""
    random = np.random.default_rng(0)
    for _ in range(number):
        lines = []
        for _ in range(random.integers(3, 13)):
            one, other = random.choice(NAMES, 2, replace=False)
            word = " or ".join(random.choice(WORDS, random.choice([1, 1, 1, 2]), replace=False))
            lines.append(f"{random.choice(FRONTS)}{one} {word} {other}")
        yield deixis.read_script(text="\n".join(lines))


def tables(number: int, labelled: bool) -> Iterator[deixis.Scene]:
    """Yield tables of 8 objects on a grid of 4 by 4 places, each moved and sized at random."""
    random = np.random.default_rng(1)
    for _ in range(number):
        cells = random.permutation(16)[: len(LABELS)]
        low = np.stack([cells % 4, cells // 4], axis=1) * 0.25 + random.uniform(0, 0.08, (len(LABELS), 2))
        high = low + random.uniform(0.04, 0.16, (len(LABELS), 2))
        labels = list(LABELS) if labelled else None
        yield deixis.Scene.from_boxes(min=low, max=high, labels=labels)


def main() -> None:
    """Print the shares."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--layouts", type=int, default=100, help="number of random layouts")
    parser.add_argument("--tables", type=int, default=20, help="number of drawn tables, with labels and without")
    with recorded(parser) as options:
        report_facts("random layouts", layouts(options.layouts))
        if (folder := data_folder("english")) is not None:
            report_facts("paragraphs", (deixis.read_script(file) for file in sorted(folder.glob("*/text.txt"))))
        shipped = ("place_setting.labelled", "second_table", "study", "place_setting")
        report_objects("shipped scenes", (deixis.read_scene(EXAMPLES / f"{name}.scene.json") for name in shipped))
        report_objects("tables with labels", tables(options.tables, labelled=True))
        report_objects("tables without labels", tables(options.tables, labelled=False))


def report_facts(name: str, scripts: Iterator[deixis.Script]) -> None:
    """Print the share of facts that are read again, and the words per fact, with all facts and without the implied."""
    facts = read = words = stated = left_out = 0
    for script in scripts:
        every, few = deixis.tell(script, all_facts=True), deixis.tell(script)
        facts, read = facts + len(every.facts), read + len(every.facts) - len(every.misread)
        words, stated, left_out = words + len(few.text.split()), stated + len(few.facts), left_out + len(few.left_out)
    share(f"facts read again, {name}", read, facts)
    print(
        f"{name}: {read / facts:.3f} of {facts} facts read again; "
        f"{words / stated:.1f} words a fact, {left_out} left out"
    )


def report_objects(name: str, scenes: Iterator[deixis.Scene]) -> None:
    """Print the share of objects that the text finds, and that a description of their own singles out."""
    objects = found = described = words = 0
    for scene in scenes:
        telling = deixis.tell(scene)
        objects += len(telling.objects)
        found += sum(thing.found is True for thing in telling.objects)
        described += sum(thing.description is not None for thing in telling.objects)
        words += len(telling.text.split())
    share(f"objects found by the text, {name}", found, objects)
    share(f"objects with a description, {name}", described, objects)
    print(
        f"{name}: {found / objects:.3f} of {objects} objects found by the text, {described / objects:.3f} described; "
        f"{words / objects:.1f} words an object"
    )


if __name__ == "__main__":
    main()
