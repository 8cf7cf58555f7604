"""New adjectives, learned from sentences and the things that they picked out."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from commands import deixis as run

import deixis
from deixis.learning.attributes import measured
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.attributes.attribute import MEASURES
from deixis.reasoning.errors import DescriptionError
from deixis.workflows.descriptions.attributes import Phrase, new_adjectives
from deixis.workflows.descriptions.learn_attributes import learn_attributes

DARK, LIGHT = ("#203080", "#182a70"), ("#d0d8a0", "#c8e0b0")


def table(folder: Path, name: str, blick: int, seed: int) -> Path:
    """Write a table of four cups, of which the one that is called blick is dark, and return its file."""
    random = np.random.default_rng(seed)
    things = [
        {
            "id": f"o{i}",
            "label": "cup",
            "min": [0.2 * i, 0, 0],
            "max": [0.2 * i + float(random.uniform(0.05, 0.12)), 0.08, float(random.uniform(0.06, 0.12))],
            "colour": (DARK if i == blick else LIGHT)[seed % 2],
        }
        for i in range(4)
    ]
    file = folder / name
    file.write_text(json.dumps({"objects": things}), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("taught")
    lines = []
    for number, blick in enumerate((1, 3, 0, 2)):
        table(folder, f"t{number}.scene.json", blick, number)
        text = ("the blick one", "the blick cup")[number % 2]
        lines.append(json.dumps({"text": text, "scene": f"t{number}.scene.json", "target": f"o{blick}"}))
    (folder / "said.jsonl").write_text("\n".join(lines), encoding="utf-8")
    return folder / "said.jsonl"


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("the blick one", Phrase(("blick",), "")),
        ("The blick, wug cup next to the plate", Phrase(("blick", "wug"), "cup")),
        ("the blick soup spoon", Phrase(("blick",), "soup spoon")),
        ("the cup is blick", Phrase(("blick",), "", stated=True)),
        ("this isn't blick.", Phrase(("blick",), "", stated=True, positive=False)),
        ("this is a blick mug", Phrase(("blick",), "mug", stated=True)),
        ("the large red cup", None),
        ("the butter knife", None),
        ("the blick", None),
        ("", None),
    ],
)
def test_new_adjectives_are_found(text: str, phrase: Phrase | None) -> None:
    assert new_adjectives(text) == phrase


def test_a_learned_adjective_decides_a_reference(taught: Path, tmp_path: Path) -> None:
    scene = table(tmp_path, "new.scene.json", 2, 9)
    words = learn_attributes(taught)
    assert words["blick"].dimension == "colour"
    found = deixis.refer("the blick one", scene, attributes=words)
    assert (found.target, found.decided) == ("o2", True)
    assert deixis.refer("the blick cup", scene, attributes=words).target == "o2"


def test_the_command_takes_the_sentences(taught: Path, tmp_path: Path) -> None:
    scene = table(tmp_path, "new.scene.json", 1, 7)
    code, out, _ = run("refer", "the blick one", scene, "--attributes", taught)
    assert code == 0 and out.startswith("o1 ")
    assert run("refer", "the blick one", scene)[0] == 2


def test_without_a_sentence_it_was_never_said(taught: Path) -> None:
    lines = taught.read_text(encoding="utf-8").splitlines()
    other = json.dumps({"text": "the wug one", "scene": "t0.scene.json", "target": "o0"})
    with_and_without = learn_attributes([*lines, other][:-1], taught.parent)
    assert with_and_without.keys() == {"blick"}
    assert with_and_without["blick"].shares == learn_attributes(taught)["blick"].shares


def test_a_statement_says_nothing_about_other_things(taught: Path) -> None:
    said = json.dumps({"text": "this one is not blick", "scene": "t0.scene.json", "target": "o0"})
    (example,) = learn_attributes([said], taught.parent)["blick"].examples
    assert not example.positive


def test_a_wrong_line_is_named(taught: Path) -> None:
    said = json.dumps({"text": "the blick one", "scene": "t0.scene.json", "target": "o9"})
    with pytest.raises(DescriptionError, match=r"<sentences>:2: .*no object 'o9'"):
        learn_attributes(["", said], taught.parent)


def test_surfaces_are_measured_in_coloured_clouds() -> None:
    colours = np.full((100, 3), 60, dtype=np.uint8)
    colours[:20] = 250
    shiny = PointCloud(np.zeros((100, 3), np.float32), colours=colours)
    matt = PointCloud(np.zeros((100, 3), np.float32), colours=np.full((100, 3), 60, dtype=np.uint8))
    things = [
        PerceivedObject(f"o{i}", (0, 0, 0), (1, 1, 1), cloud=cloud) for i, cloud in enumerate((shiny, matt, None))
    ]
    gloss = measured(Scene(tuple(things)))[:, MEASURES.index("gloss")]
    assert gloss[0] > gloss[1] and np.isnan(gloss[2])
