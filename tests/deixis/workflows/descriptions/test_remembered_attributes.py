"""Adjectives that a memory keeps, and forgets with their sentences."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis as run
from episodic_fluents import SEEN

import deixis
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import episodic
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.errors import DescriptionError
from deixis.workflows.descriptions.remembered_attributes import (
    forget_sentence,
    remember_sentence,
    remembered_attributes,
)
from deixis.workflows.knowledge.unlearn import Selection

DARK, LIGHT = (32, 48, 128), (208, 216, 160)


def table(blick: int) -> Scene:
    return Scene(
        tuple(
            PerceivedObject(f"o{i}", (0.2 * i, 0, 0), (0.2 * i + 0.1, 0.1, 0.1), colour=DARK if i == blick else LIGHT)
            for i in range(3)
        )
    )


def test_a_forgotten_sentence_was_never_said() -> None:
    with Blackboard.transient() as board:
        remember_sentence(board, "the blick one", table(0), "o0")
        before = remembered_attributes(board)["blick"].shares
        second = remember_sentence(board, "the blick one", table(2), "o2")
        assert remembered_attributes(board)["blick"].shares != before
        forget_sentence(board, second)
        assert remembered_attributes(board)["blick"].shares == before


def test_a_sentence_counts_once() -> None:
    with Blackboard.transient() as board:
        first = remember_sentence(board, "the blick one", table(0), "o0")
        assert remember_sentence(board, "the blick one", table(0), "o0") == first
        assert len(remembered_attributes(board)["blick"].examples) == 3


def test_sentences_that_teach_nothing_are_errors() -> None:
    with Blackboard.transient() as board:
        with pytest.raises(DescriptionError, match="no adjective"):
            remember_sentence(board, "the red cup", table(0), "o0")
        with pytest.raises(DescriptionError, match="no sentence 'x'"):
            forget_sentence(board, "x")


def test_the_command_teaches_and_uses_a_memory(tmp_path: Path) -> None:
    for place in range(3):
        things = [
            {"id": f"o{i}", "min": [0.2 * i, 0, 0], "max": [0.2 * i + 0.1, 0.1, 0.1], "colour": colour}
            for i in range(3)
            for colour in ["#203080" if i == place else "#d0d8a0"]
        ]
        (tmp_path / f"t{place}.scene.json").write_text(json.dumps({"objects": things}), encoding="utf-8")
    for place in (0, 1):
        said = "the blick one", tmp_path / f"t{place}.scene.json", "--memory", tmp_path / "m", "--picked", f"o{place}"
        code, out, err = run("refer", *said)
        assert (code, err) == (0, "") and out.startswith("Learned from sentence-")
    code, out, _ = run("refer", "the blick one", tmp_path / "t2.scene.json", "--memory", tmp_path / "m")
    assert out.startswith("o2 ")
    assert run("refer", "the blick one", tmp_path / "t2.scene.json", "--picked", "o2")[0] == 2


def cups(*sides: float) -> Scene:
    centres = [[0.4 * place, 0.0, side / 2] for place, side in enumerate(sides)]
    return Scene.from_boxes(centre=centres, size=[[side] * 3 for side in sides], labels=["cup"] * len(sides))


def test_learned_adjective_counts_in_grounding_until_taken_back(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        for number in range(6):
            remember_sentence(board, "the blick cup", cups(0.06, 0.12, 0.06 + 0.002 * number), "o2", by="ada")
    script, scene = deixis.read_script(text="blick_cup beside other_cup"), cups(0.06, 0.061, 0.12)
    with deixis.Session(tmp_path) as session:
        found = session.ground(script, scene).matches["blick_cup"]
        assert (found.perceived, (found.probability or 0.0) > 0.7) == ("o3", True)
        session.unlearn(Selection(sentence="the blick cup"))
        again, plain = (each.ground(script, scene).matches["blick_cup"] for each in (session, deixis))
        assert again.probability == plain.probability


OTHERS = [
    None, "{bad", "[]", "{}", "NaN", '{"word": "blick"}', '{"word": "blick", "label": 5, "measures": [], "text": "x"}',
    '{"word": "blick", "label": null, "measures": ["a", 1e999], "text": "x"}', "[" * 5000,
]  # fmt: skip


def test_what_others_wrote_teaches_no_adjective(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        remember_sentence(board, "the blick one", table(0), "o0")
        before = remembered_attributes(board)["blick"].examples
        for number, text in enumerate(OTHERS):
            statement = ("t1", "calledAs") if text is None else ("t1", "calledAs", text)
            board.write(Add(episodic(f"x{number}", statement, start=0.0, source=SEEN)), by="test")
        assert len(remembered_attributes(board)["blick"].examples) == len(before)
    with deixis.Session(tmp_path) as session:
        assert len(session.unlearn(Selection(sentence="the blick one")).fluents) == 3
