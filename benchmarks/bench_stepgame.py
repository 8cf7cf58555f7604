"""Measure reading on StepGame: where one agent is from another, after one to ten sentences.

StepGame, corrected (Li, Hogg and Cohn 2024), ``$DEIXIS_DATA/stepgame``. The sentences go through the general grammar.
The convention of StepGame is applied here only: each sentence moves by one unit along each axis that it names, and
the front of a corner is its upper side. Exit code 0 if at least 0.99 of the answers are right.
"""

from __future__ import annotations

import json
import random
import re
import sys
from collections import deque
from pathlib import Path

from common import data_folder
from records import command_line, recorded, share

from deixis.errors import DeixisError
from deixis.grammar.english.reader import read_english
from deixis.ontology.graph.facts import Fact

STEPS = {
    "left": (-1, 0), "right": (1, 0), "top": (0, 1), "bottom": (0, -1), "above": (0, 1), "below": (0, -1),
    "behind": (0, 1), "in_front": (0, -1), "on": (0, 1), "under": (0, -1), "over": (0, 1),
    "top_left": (-1, 1), "top_right": (1, 1), "bottom_left": (-1, -1), "bottom_right": (1, -1), "overlap": (0, 0),
    "far": (0, 1), "back": (0, 1), "upper": (0, 1), "near": (0, -1), "front": (0, 1), "lower": (0, -1),
}  # fmt: skip
ANSWERS = {
    (-1, 0): "left", (1, 0): "right", (0, 1): "above", (0, -1): "below", (-1, 1): "upper-left",
    (1, 1): "upper-right", (-1, -1): "lower-left", (1, -1): "lower-right", (0, 0): "overlap",
}  # fmt: skip
RIGHT_SHARE = 0.99
Step = tuple[str, str, int, int]


def stories(file: Path) -> list[tuple[list[str], str, str, str]]:
    """Return the stories of a file: sentences, the agent asked about, the agent to relate it to, the answer."""
    found, story = [], list[str]()
    for line in file.read_text(encoding="utf-8").splitlines():
        text = line.split(" ", 1)[1]
        if "\t" not in text:
            story.append(text.strip())
            continue
        question, answer, *_ = text.split("\t")
        first, second = re.findall(r"\b([A-Z])\b", question)[-2:]
        found.append((story, first, second, answer.strip()))
        story = []
    return found


def steps(sentence: str) -> list[Step]:
    """Return the unit step of a sentence: what it says about two agents is one step along each axis that it names.

    The place of an agent in a region without a landmark (*Y is on the left and U is on the right*) is taken relative to
    the other agent of the sentence.
    """
    agents = list(dict.fromkeys(re.findall(r"\b([A-Z])\b", sentence)))[:2]
    try:
        stated = read_english(sentence).reading
    except DeixisError:
        return []
    if stated is None or len(agents) < 2:
        return []
    x = y = 0
    for fact in stated.stated:
        content = fact.content
        if isinstance(content, Fact):
            subject, dx, dy = content.subject, *STEPS.get(content.relations[0].name, (0, 0))
        else:
            subject, (dx, dy) = content.subjects[0], STEPS.get(content.relation, (0, 0))
            for word in (content.value or "").split():
                dx, dy = dx + STEPS.get(word, (0, 0))[0], dy + STEPS.get(word, (0, 0))[1]
        sign = 1 if subject.upper() == agents[0] else -1
        x, y = x + sign * dx, y + sign * dy
    return [(*agents, max(-1, min(1, x)), max(-1, min(1, y)))] if x or y else []


def answer(story: list[str], first: str, second: str) -> str | None:
    """Return where the first agent is from the second one; None if no sentences connect them."""
    moves: dict[str, list[tuple[str, int, int]]] = {}
    for sentence in story:
        for a, b, x, y in steps(sentence):
            moves.setdefault(b, []).append((a, x, y))
            moves.setdefault(a, []).append((b, -x, -y))
    places, waiting = {second: (0, 0)}, deque([second])
    while waiting:
        agent = waiting.popleft()
        for other, x, y in moves.get(agent, ()):
            if other not in places:
                places[other] = (places[agent][0] + x, places[agent][1] + y)
                waiting.append(other)
    if first not in places:
        return None
    x, y = places[first]
    return ANSWERS[(x > 0) - (x < 0), (y > 0) - (y < 0)]


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--sample", type=int, default=50, metavar="N", help="stories of each file")
    parser.add_argument("--verbose", action="store_true", help="print the sentences that state no step")
    with recorded(parser) as options:
        folder = data_folder("stepgame")
        if folder is None:
            return
        shares: dict[str, float] = {}
        right = asked = 0
        for file in sorted(folder.glob("*/qa*_valid.txt")):
            every = stories(file)
            drawn = random.Random(0).sample(every, min(options.sample, len(every)))
            hits = [answer(story, first, second) == right_answer for story, first, second, right_answer in drawn]
            if options.verbose:
                for sentence in {s for story, *_ in drawn for s in story if len(steps(s)) != 1}:
                    print("no step:", sentence)
            name = f"{file.parent.name} {file.name}"
            shares[name] = sum(hits) / len(hits)
            share(f"{name}: answers right", sum(hits), len(hits))
            right, asked = right + sum(hits), asked + len(hits)
        right_share = right / asked
        share("answers right", right, asked)
        if options.json:
            print(json.dumps({"right": round(right_share, 4), "asked": asked, "files": shares}))
        else:
            for name, part in shares.items():
                print(f"{name}: {part:.3f}")
            print(f"{right_share:.4f} of {asked} answers right")
    sys.exit(0 if right_share >= RIGHT_SHARE else 1)


if __name__ == "__main__":
    main()
