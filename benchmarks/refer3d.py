"""Read the descriptions of objects in rooms of ``$DEIXIS_DATA/refer3d``: Nr3D, Sr3D, ScanRefer and their scenes."""

from __future__ import annotations

import csv
import gzip
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from deixis.perception.scene import UNKNOWN_VIEWPOINT, PerceivedObject, Scene

VIEW_WORDS = frozenset(
    ["front", "behind", "back", "right", "left", "facing", "leftmost", "rightmost", "looking", "across"]
)
"""Words of a description that depends on the view, by the convention of ReferIt3D (Achlioptas et al. 2020)."""


@dataclass(frozen=True, eq=False)
class Described:
    """A sentence about one object of a scene; ``hard`` if it has more than one distractor of its class."""

    text: str
    scene: Scene
    target: str
    room: str  # rooms that were scanned several times have one name
    hard: bool
    view_dependent: bool


def read_scenes(folder: Path) -> dict[str, Scene]:
    """Return the scenes by name, with the viewpoint unknown."""
    rooms = json.loads(gzip.decompress((folder / "scenes.json.gz").read_bytes()))
    return {name: Scene(tuple(map(_object, things)), viewpoint=UNKNOWN_VIEWPOINT) for name, things in rooms.items()}


def _object(data: dict[str, object]) -> PerceivedObject:
    box = [float(value) for value in data["extension"]]  # type: ignore[attr-defined]
    front = None
    if "front_point" in data:
        x, y = (data["front_point"][axis] - (box[axis] + box[axis + 3]) / 2 for axis in (0, 1))  # type: ignore[index]
        front = (x, y) if abs(x) + abs(y) > 1e-6 else None
    colour = tuple(data["avg_rgba"][:3])  # type: ignore[index]
    return PerceivedObject(
        str(data["id"]), tuple(box[:3]), tuple(box[3:]), label=str(data["label"]), colour=colour, front=front
    )


def nr3d(folder: Path, scenes: dict[str, Scene]) -> Iterator[Described]:
    """Yield the valid sentences of Nr3D: the listener found the object, and the sentence mentions its class."""
    for row in _rows(folder, "nr3d*.csv"):
        if row["correct_guess"] == row["mentions_target_class"] == "True" and row["scan_id"] in scenes:
            distractors = int(row["stimulus_id"].split("-")[2]) - 1
            yield _described(row, scenes, distractors > 1)


def sr3d(folder: Path, scenes: dict[str, Scene]) -> Iterator[Described]:
    """Yield the sentences of Sr3D."""
    for row in _rows(folder, "sr3d*.csv"):
        if row["scan_id"] in scenes:
            yield _described(row, scenes, row["distractor_ids"].count(",") > 0)


def scanrefer(folder: Path, scenes: dict[str, Scene]) -> Iterator[Described]:
    """Yield the descriptions of ScanRefer (Chen et al. 2020), of one or more sentences; none counts as hard."""
    for file in sorted(folder.glob("scanrefer*.json")):
        for row in json.loads(file.read_text(encoding="utf-8")):
            scene = scenes.get(row["scene_id"])
            if scene is not None and row["object_id"] in scene.ids:
                words = set(re.findall("[a-z]+", row["description"].casefold()))
                room = row["scene_id"].split("_")[0]
                yield Described(row["description"], scene, row["object_id"], room, False, bool(words & VIEW_WORDS))


def _described(row: dict[str, str], scenes: dict[str, Scene], hard: bool) -> Described:
    words = set(re.findall("[a-z]+", row["utterance"].casefold()))
    name = row["scan_id"]
    return Described(
        row["utterance"], scenes[name], row["target_id"], name.split("_")[0], hard, bool(words & VIEW_WORDS)
    )


def _rows(folder: Path, pattern: str) -> Iterator[dict[str, str]]:
    for file in sorted(folder.glob(pattern)):
        with file.open(encoding="utf-8", newline="") as lines:
            yield from csv.DictReader(lines)
