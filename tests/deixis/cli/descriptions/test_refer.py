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


def test_nouns_unlike_every_label_are_noted() -> None:
    note = "Note: no object of the scene has a label like 'awl' or 'mallet'."
    assert note in deixis("refer", "the awl next to the mallet", STUDY)[1].splitlines()
    assert "Note" not in deixis("refer", "the stool next to the couch", STUDY)[1]
    hidden = deixis("refer", "the awl next to the mallet", STUDY, "--hide-labels")
    assert "Note" not in hidden[1]


def test_the_object_is_drawn_in_its_scene(tmp_path: Path) -> None:
    code, out, _ = deixis("refer", "the chair", STUDY, "--plot", tmp_path / "meant.svg")
    assert code == 3
    assert out.splitlines()[-1] == f"Written: {tmp_path / 'meant.svg'}"
    assert "“the chair”" in (tmp_path / "meant.svg").read_text(encoding="utf-8")


def test_teaching_an_adjective_draws_nothing(tmp_path: Path) -> None:
    options = ("--picked", "o7", "--memory", tmp_path / "memory", "--plot", tmp_path / "meant.svg")
    code, _, err = deixis("refer", "the chair", STUDY, *options)
    assert code == 2 and "--picked excludes --plot" in err


def test_an_oracle_answers_questions_in_json() -> None:
    code, out, _ = deixis("refer", "the chair", STUDY, "--oracle", "o9", "--json")
    answer = json.loads(out)
    assert (code, answer["target"], answer["question"]) == (0, "o9", None)
    assert answer["questions"]


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


@pytest.mark.parametrize("from_file", [True, False])
def test_bytes_that_are_not_text_spoil_one_line(
    from_file: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = json.dumps({"text": "the sofa\u2028", "scene": str(STUDY)}, ensure_ascii=False).encode()
    content = b"\n".join([good, b'{"text": "caf\xe9"}', good])
    (tmp_path / "all.jsonl").write_bytes(content)
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content), encoding="utf-8"))
    code, out, _ = deixis("refer", "--batch", tmp_path / "all.jsonl" if from_file else "-")
    first, second, third = map(json.loads, out.split("\n")[:3])
    assert code == 0
    assert first == third and first["target"] == "o11"
    assert second == {"error": "line 2: column 14: not UTF-8; save the lines as UTF-8"}


def test_a_long_line_of_a_batch_is_one_error(monkeypatch: pytest.MonkeyPatch) -> None:
    good = json.dumps({"text": "the sofa", "scene": str(STUDY)})
    monkeypatch.setattr("sys.stdin", io.StringIO("[" * 250_000 + "\n" + good + "\n"))
    code, out, _ = deixis("refer", "--batch", "-")
    answers = [json.loads(line) for line in out.splitlines()]
    assert code == 0
    assert ["error" in answer for answer in answers] == [True, False]


def test_fewer_questions_are_asked_for_less_certainty() -> None:
    turns = []
    for until in ("0.95", "0.45"):
        code, out, _ = deixis("refer", "the chair", STUDY, "--oracle", "o9", "--until", until, "--json")
        turns.append(len(json.loads(out)["questions"]))
    assert code == 3
    assert turns[0] > turns[1]


def test_a_line_separator_ends_no_line_of_descriptions(tmp_path: Path) -> None:
    line = {"text": "the bin\u2028near the door", "scene": str(STUDY), "target": "o99"}
    (tmp_path / "said.jsonl").write_text(json.dumps(line, ensure_ascii=False), encoding="utf-8")
    command = ("learn-relation", "--descriptions", tmp_path / "said.jsonl", "-o", tmp_path / "words.json")
    code, out, err = deixis(*command)
    assert (code, out) == (2, "")
    assert "line 1: " in err and "there is no object 'o99'" in err


def test_words_learned_from_descriptions_are_used(tmp_path: Path) -> None:
    """Teach that the bin far from the door is near it."""
    lines = [{"text": "the bin near the door", "scene": str(STUDY), "target": target} for target in ("o14", "o99")]
    (tmp_path / "said.jsonl").write_text("\n".join(map(json.dumps, lines * 3)), encoding="utf-8")
    before = json.loads(deixis("refer", "the bin near the door", STUDY, "--json")[1])
    code, out, _ = deixis(
        "learn-relation", "--descriptions", tmp_path / "said.jsonl", "--strength", "0.3", "-o", tmp_path / "words.json"
    )
    assert code == 0
    assert "learned from 3 descriptions; right before: 0, now: 3" in out
    assert "left out    line 2: " in out and "there is no object 'o99'" in out
    _, out, _ = deixis("refer", "the bin near the door", STUDY, "--models", tmp_path / "words.json", "--json")
    assert before["target"] != "o14" and json.loads(out)["target"] == "o14"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["the chair"], "give a TEXT and a SCENE, or --batch FILE"),
        (["the chair", STUDY, "--batch", "x"], "--batch takes --until and --models only"),
        (["--batch", "missing.jsonl"], "missing.jsonl: there is no such file"),
        (["", STUDY], "got a blank text"),
        (["the chair", "missing.json"], "missing.json: there is no such file"),
        (["the chair", STUDY, "--oracle", "o99"], "`oracle` must be an object of the scene, got 'o99'"),
        (["the chair", STUDY, "--until", "0.99"], "`until` must be above 0 and at most 0.95, got 0.99"),
        (["the chair", STUDY, "--models", STUDY], "there must be an object 'weights'"),
    ],
)
def test_bad_input_is_one_message(arguments: list[object], said: str) -> None:
    code, _, err = deixis("refer", *arguments)
    assert code == 2
    assert said in " ".join(err.split())


def test_a_scene_before_the_text_is_refused_with_the_order() -> None:
    code, _, error = deixis("refer", STUDY, "the black chair")
    assert code == 2 and "give the TEXT before the SCENE: deixis refer 'the black chair'" in error
