"""Records of benchmarks: what is written, what the page shows, and which benchmarks take part."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import records
from records import RUNS, Figure, Recording, Run, command_line, count, figure, ratio, recorded, seconds, share
from source_tree import ROOT

BENCHMARKS = sorted((ROOT / "benchmarks").glob("bench_*.py"))


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """A run whose record is in a temporary folder, at a known commit of an idle machine."""
    run = Run("tables", "Grounding", "tables", "toy", "--size 12")
    monkeypatch.setattr(records, "FOLDER", tmp_path)
    monkeypatch.setattr(records, "RUNS", (run,))
    monkeypatch.setattr(records, "measured_commit", lambda: "abc1234")
    monkeypatch.setattr(records, "is_busy", lambda: False)
    return run


def measure(*arguments: str, right: int = 9) -> None:
    parser = command_line("benchmarks/bench_toy.py", "Measure a toy.")
    parser.add_argument("--size", type=int, default=3)
    with recorded(parser, arguments):
        share("named right", right, 12)
        ratio("inference", 3.0, 1.5, "numpy")
        seconds("inference", 1.5)
        count("tables", 4)
        figure("undefined", float("nan"), "share")


def test_the_page_is_what_the_records_give() -> None:
    assert records.PAGE.read_text(encoding="utf-8") == records.page(), "run `make report`"


@pytest.mark.parametrize("file", BENCHMARKS, ids=lambda path: path.stem)
def test_every_benchmark_registers_and_records(file: Path) -> None:
    assert file in [run.file for run in RUNS], f"add a line for {file.name} to RUNS in benchmarks/records.py"
    text = file.read_text(encoding="utf-8")
    assert "with recorded(parser" in text and "command_line(__file__, __doc__)" in text
    (imported,) = re.findall(r"^from records import (.+)$", text, re.MULTILINE)
    used = set(imported.split(", ")) & {"share", "mean", "ratio", "count", "seconds", "figure"}
    assert any(re.search(rf"(?<![\w.]){name}\(", text) for name in used)


def test_the_names_of_runs_are_distinct() -> None:
    assert len({run.name for run in RUNS}) == len(RUNS)
    assert all(run.file.exists() for run in RUNS)


def test_every_record_belongs_to_a_run() -> None:
    names = {run.name: run.command for run in RUNS}
    for file in (ROOT / "benchmarks" / "recorded").glob("*.json"):
        assert json.loads(file.read_text(encoding="utf-8"))["command"] == names[file.stem]


def test_a_run_is_written_with_its_figures(here: Run) -> None:
    measure("--record", "--size", "12")
    (recording,) = records.read(here)
    named, times, taken, tables = recording.figures
    assert recording.commit == "abc1234" and "cores" in recording.machine
    assert (named.value, named.unit) == (0.75, "share") and named.interval == (0.4677, 0.9111)
    assert times.value == 2 and (times.peer or "").startswith("numpy ")
    assert (taken.unit, tables.value) == ("s", 4)


def test_nothing_is_written_without_the_option(here: Run) -> None:
    measure("--size", "12")
    assert records.read(here) == []


def test_other_options_than_those_of_a_run_are_refused(here: Run, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        measure("--record")
    assert "add a line to RUNS" in capsys.readouterr().err


def test_a_busy_machine_records_no_seconds(here: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(records, "is_busy", lambda: True)
    measure("--record", "--size", "12")
    assert [each.unit for each in records.read(here)[0].figures] == ["share", "times as long", "count"]


@pytest.mark.parametrize(("running", "busy"), [("1/75", False), ("3/77", True)])
def test_busy_means_that_other_programs_run_now(
    running: str, busy: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = tmp_path / "loadavg"
    now.write_text(f"9.00 9.00 9.00 {running} 16904\n")
    monkeypatch.setattr(records, "RUNNING", now)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1})
    monkeypatch.setattr("time.sleep", lambda _: None)
    assert records.is_busy() is busy


def test_the_page_shows_the_change_since_the_last(here: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    measure("--record", "--size", "12")
    assert "| named right | 0.75 (0.468 to 0.911) |" in records.page()
    monkeypatch.setattr(records, "measured_commit", lambda: "def5678")
    measure("--record", "--size", "12", right=12)
    assert "Changes are those since `abc1234`." in records.page()
    assert "| named right | 1 (0.757 to 1), *+0.25* |" in records.page()
    assert "| tables | 4 |" in records.page()


def test_an_error_leaves_the_record_alone(here: Run) -> None:
    parser = command_line("benchmarks/bench_toy.py", "Measure a toy.")
    parser.add_argument("--size", type=int, default=3)
    with pytest.raises(RuntimeError), recorded(parser, ["--record", "--size", "12"]):  # noqa: PT012
        count("tables", 4)
        raise RuntimeError
    assert records.read(here) == []


@pytest.mark.long
@pytest.mark.parametrize("file", BENCHMARKS, ids=lambda path: path.stem)
def test_every_benchmark_starts_in_a_new_process(file: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [sys.executable, str(file), "--help"]
    ran = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=ROOT, check=False)
    assert ran.returncode == 0, ran.stderr
    assert "--record" in ran.stdout


def test_the_page_says_which_records_are_old(here: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(records, "commit_number", lambda commit: 7)
    measure("--record", "--size", "12")
    assert "cores.\n" in records.page()
    (recording,) = records.read(here)
    assert recording.number == 7
    assert records._table([recording], 8)[0].endswith("*Old*, by 1 commit.")
    assert records._table([recording], 7)[0].endswith("cores.")


def test_measures_of_cases_form_a_table() -> None:
    figures = [
        Figure("3 views: named right", 0.96, "share", (0.902, 1.018)),
        Figure("3 views: search", 2, "times as long", peer="numpy 2"),
        Figure("5 views: named right", 0.98, "share"),
    ]
    recording = Recording("abc1234", "2026-01-01", "x86-64, 2 cores", figures)
    assert records._table([recording], 0)[2:] == [
        "| case | named right | search, numpy 2 (times as long) |",
        "| --- | --- | --- |",
        "| 3 views | 0.96 (0.902 to 1) | 2 |",
        "| 5 views | 0.98 |  |",
    ]
