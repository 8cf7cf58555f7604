"""What is true of a laid table: the scene that perception ought to find."""

from __future__ import annotations

from deixis.perception.scene import PerceivedObject, Scene
from deixis.perception.simulator.laying import LaidTable


def truth_scene(table: LaidTable, viewpoint: str = "chair") -> Scene:
    """Every thing with its name and its box in the table's frame; ``o3`` is the thing whose points bear label 3."""
    things = []
    for number, thing in enumerate(table.things, start=1):
        low, high = thing.box.tolist()
        things.append(PerceivedObject(f"o{number}", tuple(low), tuple(high), label=thing.name))
    return Scene(tuple(things), viewpoint=viewpoint, file="<simulated table>")
