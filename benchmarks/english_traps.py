"""Make sentences that mention a place without stating it, and sentences that state one, from templates.

``english_traps.txt`` holds the templates, in groups. A template holds a scene in one of its forms: ``{is}`` (*the cup
is on the tray*), ``{was}``, ``{were}``, ``{goes}`` (*the cup goes on the tray*), ``{put}`` (*put the cup on the
tray*), ``{putting}``; or its pieces ``{thing}`` (*the cup*), ``{a}`` (*a cup*), ``{bare}`` (*cup*), ``{place}`` (*on
the tray*). A capital letter at the beginning of the name makes one at the beginning of the words.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

STATEMENTS = "statement"
"""Group of the templates that assert the place."""
PLACES = {
    "on": "on {0}", "under": "under {0}", "inside": "in {0}", "behind": "behind {0}", "in_front": "in front of {0}",
    "left": "to the left of {0}", "right": "to the right of {0}", "next_to": "next to {0}", "above": "above {0}",
}  # fmt: skip
THINGS = (
    "the cup", "the blue mug", "my knife", "the salad fork", "the lamp", "the old kettle", "the book", "the vase",
    "the ring", "the stapler", "Anna's radio", "the spare key", "the trowel", "the small jar", "the candle",
)  # fmt: skip
GROUNDS = (
    "the saucer", "the red box", "the basket", "the drawer", "the plate", "the toolbox", "the clock", "the bowl",
    "the breadboard", "the laptop", "the mortar", "the tin", "the cushion", "the wooden crate",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Made:
    """A sentence, the template and the group that it is made from, and the relation that it mentions."""

    text: str
    group: str
    template: str
    relation: str


@cache
def templates() -> dict[str, list[str]]:
    """Return the templates by group."""
    text = Path(__file__).with_suffix(".txt").read_text(encoding="utf-8")
    groups = [part.strip().splitlines() for part in text.split("\n# ")[1:]]
    return {name: lines for name, *lines in groups}


def _forms(thing: str, place: str) -> dict[str, str]:
    bare = thing.split(" ", 1)[1]
    forms = {
        "thing": thing, "place": place, "bare": bare, "a": f"{'an' if bare[0] in 'aeiou' else 'a'} {bare}",
        "is": f"{thing} is {place}", "was": f"{thing} was {place}", "were": f"{thing} were {place}",
        "goes": f"{thing} goes {place}", "put": f"put {thing} {place}", "putting": f"putting {thing} {place}",
    }  # fmt: skip
    return forms | {name.capitalize(): form[0].upper() + form[1:] for name, form in forms.items()}


def made(samples: int, seed: int = 0) -> Iterator[Made]:
    """Yield ``samples`` sentences of each template, with other things and places each time."""
    for group, lines in templates().items():
        for template in lines:
            chance = random.Random(f"{seed} {template}")
            for _ in range(samples):
                relation, pattern = chance.choice(list(PLACES.items()))
                thing, ground = chance.choice(THINGS), chance.choice(GROUNDS)
                text = template.format(**_forms(thing, pattern.format(ground)))
                yield Made(text[0].upper() + text[1:], group, template, relation)
