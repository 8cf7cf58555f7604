"""The command ``deixis refer``: answers, exit codes and bad input."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from commands import deixis
from source_tree import ROOT

STUDY = ROOT / "examples" / "study.scene.json"


def test_a_decided_object_is_printed() -> None:
    code, out, _ = deixis("refer", "the lamp on the desk", STUDY)
    assert code == 0
    assert out.startswith("o12  probability 0.9")
    assert "Understood as: the lamp on the desk (100 % of the words)." in out


def test_an_undecided_object_comes_with_a_question() -> None:
    code, out, _ = deixis("refer", "the chair", STUDY)
    assert code == 3
    assert "undecided" in out and "To ask: Is it" in out


def test_an_oracle_answers_questions_in_json() -> None:
    code, out, _ = deixis("refer", "the chair", STUDY, "--oracle", "o9", "--json")
    answer = json.loads(out)
    assert (code, answer["target"], answer["question"]) == (0, "o9", None)
    assert answer["turns"]


def test_a_person_answers_questions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("perhaps\nyes\n\n"))
    code, out, _ = deixis("refer", "the bin", STUDY, "--ask")
    assert code == 0
    assert out.count("(yes, no, or an empty line to stop)") == 2


def test_a_batch_prints_a_line_for_each_line(tmp_path: Path) -> None:
    lines = [json.dumps({"text": "the sofa", "scene": str(STUDY)}), "{}", json.dumps({"text": "", "scene": str(STUDY)})]
    (tmp_path / "all.jsonl").write_text("\n".join(lines), encoding="utf-8")
    code, out, _ = deixis("refer", "--batch", tmp_path / "all.jsonl")
    answers = [json.loads(line) for line in out.splitlines()]
    assert code == 0
    assert [answer.get("target") for answer in answers] == ["o11", None, None]
    assert ["error" in answer for answer in answers] == [False, True, True]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["the chair"], "give a TEXT and a SCENE, or --batch FILE"),
        (["the chair", STUDY, "--batch", "x"], "--batch takes no other argument"),
        (["--batch", "missing.jsonl"], "missing.jsonl: cannot be read"),
        (["", STUDY], "got a blank text"),
        (["the chair", "missing.json"], "missing.json: cannot be read"),
        (["the chair", STUDY, "--oracle", "o99"], "there is no object 'o99'"),
    ],
)
def test_bad_input_is_one_message(arguments: list[object], said: str) -> None:
    code, _, err = deixis("refer", *arguments)
    assert code == 2
    assert said in " ".join(err.split())
