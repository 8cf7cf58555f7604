"""The command deixis point: gestures, and which thing each spoken name is taught to."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import pytest
from commands import deixis as run
from source_tree import ROOT

import deixis
from deixis.grammar.utterances import Utterance
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin
from deixis.perception.scene import Scene
from deixis.perception.simulator.teacher import Recording, Teacher
from deixis.reasoning.temporal.fluent import Pattern
from deixis.workflows.scenes.point import Shown, SpokenName, point, size_weights, spoken_name

EXAMPLE = [ROOT / "examples" / f"showing.{kind}" for kind in ("skeleton.jsonl", "scene.json", "said.jsonl")]
SCENE = Scene.from_boxes(centre=[[0.0, 0.3, 0.05], [0.3, 0.3, 0.05]], size=[[0.08, 0.08, 0.1]] * 2)


@cache
def recording() -> Recording:
    return Teacher(SCENE, 1, person="anna").points_at(["o1", "o2", "o1"], hold=1.0)


def told(*said: tuple[str, int, float]) -> Shown:
    """Return the answer for texts that are said so many seconds after the beginning of numbered gestures."""
    aims = recording().aims
    words = [Utterance(text, aims[number].start + later, speaker="anna") for text, number, later in said]
    return point(recording().skeletons, SCENE, words)


def test_names_of_the_same_moment_are_taught() -> None:
    found = told(("this is a mug", 0, 0.3), ("that one is called a beaker", 1, 0.8))
    assert [(label.name, label.target) for label in found.taught] == [("mug", "o1"), ("beaker", "o2")]


def test_a_name_said_too_late_is_refused_with_the_reason() -> None:
    found = told(("this is a mug", 2, 3.5))
    assert found.taught == () and found.labels[0].refused == "no gesture within 1 s of the words"


def test_words_that_name_nothing_are_refused() -> None:
    found = told(("where is the fork?", 0, 0.3))
    assert found.labels[0].refused == "names nothing that could be pointed at"


def test_words_that_were_hardly_recognised_are_refused() -> None:
    at = recording().aims[0].start
    found = point(recording().skeletons, SCENE, [Utterance("this is a mug", at, confidence=0.3)])
    assert found.labels[0].refused == "recognised with a confidence of 0.30 only"


def test_a_teacher_who_contradicts_herself_is_noticed() -> None:
    found = told(("this is a mug", 0, 0.3), ("this is a candle", 2, 0.3))
    assert [label.name for label in found.taught] == ["mug"]
    assert found.labels[1].question == "Is o1 mug or candle?"
    assert "anna calls o1 'candle'" in found.contradictions[0]


def test_a_correction_takes_the_earlier_name_back() -> None:
    found = told(("this is a mug", 0, 0.3), ("no, that is a candle", 2, 0.3))
    assert [label.name for label in found.taught] == ["candle"]
    assert found.contradictions == () and "taken back" in str(found.labels[0].refused)


def test_a_kind_of_the_earlier_name_does_not_contradict() -> None:
    assert told(("this is a cup", 0, 0.3), ("this is a coffee cup", 2, 0.3)).contradictions == ()


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("This is a soup spoon.", SpokenName("soup spoon")),
        ("fork", SpokenName("fork")),
        ("that's not a fork", SpokenName("fork", positive=False)),
        ("No, that is a ladle.", SpokenName("ladle", corrects=True)),
        ("the red one is a cup", SpokenName("cup")),
        ("the fork is left of the plate", None),
        ("no", None),
        ("layout tea; teacup on saucer", None),
    ],
)
def test_names_are_read_from_sentences(text: str, name: SpokenName | None) -> None:
    assert spoken_name(text) == name


def test_sizes_weigh_against_things_of_another_size() -> None:
    scene = Scene.from_boxes(centre=[[0, 0, 0.01], [1, 0, 0.01]], size=[[0.03, 0.2, 0.02], [0.26, 0.26, 0.02]])
    fork, plate = size_weights("fork", scene), size_weights("plate", scene)
    assert fork["o1"] > 5 * fork["o2"] and plate["o2"] > 5 * plate["o1"]
    assert set(size_weights("qwrtz", scene).values()) == {1.0}


def test_the_command_prints_gestures_and_names() -> None:
    code, out, err = run("point", *EXAMPLE[:2], "--said", EXAMPLE[2])
    assert (code, err) == (3, "")
    assert "o1 is taught as plate" in out and "Which one do you mean" in out


def test_the_api_gives_what_the_command_prints() -> None:
    found = deixis.point(*EXAMPLE)
    _, out, _ = run("point", *EXAMPLE[:2], "--said", EXAMPLE[2], "--json")
    assert json.loads(out) == found.to_dict()
    assert found.to_text().startswith("1.9 to 2.7 s, anna")
    assert found.summary() == "4 gestures, 2 names taught"


def test_bad_input_is_reported_in_one_line(tmp_path: Path) -> None:
    still, wrong, empty = tmp_path / "still.jsonl", tmp_path / "wrong.jsonl", tmp_path / "empty.scene.json"
    still.write_text('{"at": 1, "joints": {"right_elow": [0, 0, 0]}}\n', encoding="utf-8")
    wrong.write_text('{"at": 1, "joints": {"head": "up"}}\n', encoding="utf-8")
    empty.write_text('{"objects": []}', encoding="utf-8")
    for arguments, message in (
        ((still, EXAMPLE[1]), "right_elow"),
        ((wrong, EXAMPLE[1]), "wrong.jsonl:1: joint 'head'"),
        ((EXAMPLE[0], ROOT / "examples" / "place_setting.scene.json"), "heights"),
        ((EXAMPLE[0], EXAMPLE[1], "--sure", "2"), "`sure`"),
    ):
        code, _, err = run("point", *arguments)
        assert code == 2 and message in err and err.count("\n") == 1
    code, out, _ = run("point", EXAMPLE[0], empty)
    assert code == 3 and "the scene has no things" in out


def test_a_memory_keeps_what_was_said_and_shown(tmp_path: Path) -> None:
    code, _, err = run("point", *EXAMPLE[:2], "--said", EXAMPLE[2], "--memory", tmp_path / "memory")
    assert (code, err) == (3, "")
    with Blackboard.open(tmp_path / "memory") as board:
        held = [str(fluent.statement) for fluent in board.holding()]
        assert {"pointedAt(anna, o1)", "isA(o1, plate)", "isA(o2, fork)", "said(anna, this is a glass)"} <= set(held)
        assert not any("glass)" in one and one.startswith("isA") for one in held)
        (name,) = board.holding(Pattern("o1", "isA"))
        assert name.source.origin is Origin.SHOWN and name.certainty == pytest.approx(0.93, abs=0.01)
