"""Compare a picture of each type with the stored one.

After a change that is meant, look at the new pictures and store them::

    DEIXIS_STORE_PICTURES=1 python -m pytest tests/deixis/plots/test_stored_pictures.py
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from source_tree import ROOT

import deixis

pytest.importorskip("matplotlib")

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STORED = Path(__file__).parent / "stored"
TOLERANCE = 4.0
"""Root mean square difference of grey values, 0 to 255, that other versions of fonts and renderers may make."""

DPI = 60
EXAMPLES = ROOT / "examples"


def scene() -> deixis.Scene:
    return deixis.read_scene(EXAMPLES / "place_setting.scene.json")


def decided_grounding() -> Figure:
    return deixis.ground(EXAMPLES / "formal_dinner.layout", scene()).plot()


def doubtful_grounding() -> Figure:
    return deixis.ground(EXAMPLES / "script1.layout", scene(), sizes=False).plot()


def check() -> Figure:
    return deixis.check(EXAMPLES / "formal_dinner.layout", EXAMPLES / "second_table.scene.json").plot()


def imagined_table() -> Figure:
    return deixis.imagine(deixis.read_script(EXAMPLES / "formal_dinner.layout")).plot()


def relation_field() -> Figure:
    from deixis.ontology.tbox import default_ontology
    from deixis.plots.relation import relation_figure
    from deixis.reasoning.grounding.evidence.meaning import shipped_models

    return relation_figure(default_ontology().relations["left"], shipped_models(), steps=61)


def scene_of_boxes() -> Figure:
    return scene().plot()


@cache
def scene_in_a_cloud(seed: int) -> deixis.Scene:
    pytest.importorskip("open3d")
    return deixis.perceive(deixis.simulate(EXAMPLES / "formal_dinner.layout", seed=seed).cloud)


def perceived_table() -> Figure:
    return scene_in_a_cloud(7).plot()


def recognised_table() -> Figure:
    with tempfile.TemporaryDirectory() as folder, deixis.Session(Path(folder) / "memory") as session:
        session.learn(deixis.read_script(EXAMPLES / "formal_dinner.layout"), scene_in_a_cloud(7))
        return session.recognise(scene_in_a_cloud(8)).plot()


PICTURES: list[Callable[[], Figure]] = [
    decided_grounding,
    doubtful_grounding,
    check,
    imagined_table,
    relation_field,
    scene_of_boxes,
    perceived_table,
    recognised_table,
]


@pytest.mark.parametrize("draw", PICTURES, ids=lambda draw: draw.__name__)
def test_a_picture_is_as_stored(draw: Callable[[], Figure], tmp_path: Path) -> None:
    from matplotlib.testing.compare import compare_images

    stored, drawn = STORED / f"{draw.__name__}.png", tmp_path / f"{draw.__name__}.png"
    figure = draw()
    figure.savefig(drawn, dpi=DPI)
    if os.environ.get("DEIXIS_STORE_PICTURES"):
        STORED.mkdir(exist_ok=True)
        stored.write_bytes(drawn.read_bytes())
    assert compare_images(str(stored), str(drawn), TOLERANCE) is None


def test_every_stored_picture_is_compared() -> None:
    assert {path.stem for path in STORED.glob("*.png")} == {draw.__name__ for draw in PICTURES}
