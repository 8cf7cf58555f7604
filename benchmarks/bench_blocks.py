"""Measure which of 15 coloured blocks an instruction picks, across a table from the person who gives it.

The instructions of people and their scenes are in ``$DEIXIS_DATA/blocks`` (Li, Scalise et al. 2016). The speaker sits
at the near side of the picture and the addressee at the far side. Each instruction is answered twice: with the
viewpoint unknown, and with the perspective that the annotators found in it (the addressee's or the speaker's; unknown
where they found none). Prints the share right over all instructions, and over those of which every word was
understood, beside the share of people who picked the right block.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from common import data_folder
from records import command_line, figure, recorded, share

from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import UNKNOWN_VIEWPOINT, PerceivedObject, Scene
from deixis.reasoning.errors import DescriptionError
from deixis.workflows.descriptions.refer import refer

SIDES = {"agent": -1.0, "user": 1.0}
"""Perspectives of the annotators with the sign of the axes of the picture: the addressee looks against them."""

AWAY = 200.0
"""Distance of the people from the nearest block, in pixels."""


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        measure()


def measure() -> None:
    """Print and record the shares with the perspective unknown and given."""
    folder = data_folder("blocks")
    if folder is None:
        return
    tables = json.loads((folder / "scenes.json").read_text(encoding="utf-8"))
    instructions = json.loads((folder / "instructions.json").read_text(encoding="utf-8"))
    scenes = {
        (name, side): scene_of(table["blocks"], side) for name, table in tables.items() for side in (*SIDES, "unknown")
    }
    people = np.array([one["human_accuracy"] for one in instructions])
    found = np.array([one["perspective"] for one in instructions])
    figure("people", float(people.mean()), "share")
    print(f"{len(instructions)} instructions; people picked the right block in a share of {people.mean():.3f}")
    for name, given in (("perspective unknown", False), ("perspective given", True)):
        right, understood = np.zeros((2, len(instructions)))
        for place, one in enumerate(instructions):
            side = one["perspective"] if given and one["perspective"] in SIDES else "unknown"
            right[place], understood[place] = answer(one, scenes[one["configuration"], side])
        whole = understood == 1
        share(f"{name}: right", int(right.sum()), len(instructions))
        share(f"{name}, understood: right", int(right[whole].sum()), int(whole.sum()))
        kinds = ", ".join(f"{kind} {right[found == kind].mean():.3f}" for kind in ("neither", "ambiguous", *SIDES))
        print(
            f"{name}: right {right.mean():.3f}; of the {whole.mean():.3f} understood {right[whole].mean():.3f};"
            f" by annotated perspective: {kinds}"
        )


def scene_of(blocks: list[Any], side: str) -> Scene:
    """Return the blocks as one sees them from a side, ``agent`` or ``user``; with an unknown viewpoint for others."""
    sign = SIDES.get(side, 1.0)
    corners = np.array([box for _, box in blocks], dtype=float).reshape(-1, 2, 2) * (sign, -sign)
    low, high = corners.min(axis=1), corners.max(axis=1)
    middle, near, far = low[:, 0].mean(), low[:, 1].min() - AWAY, high[:, 1].max() + AWAY
    colours = default_ontology().colours
    objects = []
    for place, (word, _) in enumerate(blocks):
        colour = colours.of_word(word)
        rgb = None if colour is None else colour.prototype
        objects.append(PerceivedObject(str(place), tuple(low[place]), tuple(high[place]), label="block", colour=rgb))
    return Scene(
        tuple(objects),
        viewpoint=side if side in SIDES else UNKNOWN_VIEWPOINT,
        unit="px",
        speaker=(middle, near if sign > 0 else far),
        addressee=(middle, far if sign > 0 else near),
    )


def answer(one: Mapping[str, Any], scene: Scene) -> tuple[bool, float]:
    """Return whether the right block is found, and the share of the words that were understood."""
    try:
        found = refer(one["instruction"], scene)
    except DescriptionError:
        return False, 0.0
    return found.target == str(one["target"]), found.understood


if __name__ == "__main__":
    main()
