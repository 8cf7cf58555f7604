"""Shell completion: commands, options, and values from the program and from the memory."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import threading
from datetime import UTC, datetime
from pathlib import Path

import pytest
from commands import deixis
from timing import BUSY_SECONDS

from deixis.cli import completion
from deixis.examples_data import example
from deixis.memory.perceptual.in_folder import open_in
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.session import Session


@pytest.fixture(scope="module")
def memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A memory with one learned layout."""
    folder = tmp_path_factory.mktemp("memory") / "m"
    with Session(folder) as session:
        session.learn(example("formal_dinner.layout"), example("place_setting.labelled.scene.json"))
    return folder


@pytest.fixture(autouse=True)
def _patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let reading a memory take as long as it does on a busy machine."""
    monkeypatch.setattr(completion, "TIME_LIMIT", BUSY_SECONDS)


def completed(words: str, monkeypatch: pytest.MonkeyPatch, shell: str = "bash") -> list[str]:
    """Return the completions of the last word of a command line."""
    monkeypatch.setenv("_DEIXIS_COMPLETE", f"complete_{shell}")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(f"{words}.".split()) - 1))
    monkeypatch.setenv("_TYPER_COMPLETE_ARGS", words)
    monkeypatch.setenv("_TYPER_COMPLETE_FISH_ACTION", "get-args")
    code, out, err = deixis()
    assert (code, err) == (0, "")
    return out.split("\n")[:-1] if out.strip() else []


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("deixis gr", ["ground"]),
        ("deixis re", ["read", "recognise", "relate", "retrieve", "refer", "relation", "recall", "reason"]),
        ("deixis memory ", ["export", "import", "stats", "verify", "forget"]),
        ("deixis ground --eng", ["--engine"]),
        ("deixis ground --engine s", ["scalable", "similarity"]),
        ("deixis relate scene.json --calculus car", ["cardir"]),
        ("deixis solve n.csp --calculus rc", ["rcc5", "rcc8"]),
        ("deixis solve n.csp --calculus ra+rcc", ["ra+rcc5", "ra+rcc8"]),
    ],
)
def test_commands_options_and_values(words: str, expected: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert completed(words, monkeypatch) == expected


@pytest.mark.parametrize(("shell", "start"), [("zsh", '"ground":"'), ("fish", "ground\t")])
def test_zsh_and_fish_show_the_summaries(shell: str, start: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (line,) = completed("deixis gr", monkeypatch, shell)
    assert f"{start}Work out which" in line


@pytest.mark.parametrize(
    ("words", "expected"),
    [("check for", "formal_dinner"), ("show ", "formal_dinner"), ("memory forget ", "formal_dinner-1")],
)
def test_layouts_and_lessons_of_the_memory(
    words: str, expected: str, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(memory))
    assert completed(f"deixis {words}", monkeypatch) == [expected]


def test_a_named_memory_is_read_instead_of_the_default(
    memory: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "none"))
    assert completed("deixis show ", monkeypatch) == []
    assert completed(f"deixis show --memory {memory} ", monkeypatch) == ["formal_dinner"]


def test_categories_of_a_memory_that_is_open_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path))
    with open_in(tmp_path, create=True) as views:
        here = datetime(2026, 1, 1, tzinfo=UTC)
        seen = [View(f"v{number}", "cup", here, {}) for number in range(3)]
        views.write(Batch(seen, [CategoryRecord("saucer")]))
        for words in ("category forget ", "category merge saucer ", "teach scene o1 ", "ask "):
            assert completed(f"deixis {words}", monkeypatch) == ["cup", "saucer"], words
    assert completed("deixis category rename s", monkeypatch) == ["saucer"]


def test_the_memory_is_not_changed(memory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(memory))
    before = {path: (path.stat().st_mtime_ns, path.stat().st_size) for path in memory.rglob("*")}
    for words in ("show ", "category forget ", "memory forget "):
        completed(f"deixis {words}", monkeypatch)
    assert {path: (path.stat().st_mtime_ns, path.stat().st_size) for path in memory.rglob("*")} == before


@pytest.mark.parametrize("content", [None, "{}", "\x00"])
def test_a_missing_or_damaged_memory_is_silent(
    content: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if content is not None:
        (tmp_path / "memory.json").write_text(content, encoding="utf-8")
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path))
    for words in ("show ", "category forget ", "memory forget "):
        assert completed(f"deixis {words}", monkeypatch) == []


def test_a_slow_memory_gives_no_completions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(completion, "TIME_LIMIT", 0.05)
    released, ended = threading.Event(), threading.Event()

    def slow_layouts(memory: Path) -> set[str]:
        released.wait(BUSY_SECONDS)
        ended.set()
        return {"late"}

    monkeypatch.setattr(completion, "layouts_in", slow_layouts)
    assert completed("deixis show ", monkeypatch) == []
    assert not ended.is_set()
    released.set()


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_for_each_shell(shell: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shellingham.detect_shell", lambda: (shell, f"/bin/{shell}"))
    code, out, _ = deixis("--show-completion")
    assert code == 0 and f"_DEIXIS_COMPLETE=complete_{shell}" in out
    assert deixis("--show-completion", shell) == (0, out, "")
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=out, text=True, check=True, capture_output=True)


def test_the_script_of_another_shell_than_the_running_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shellingham.detect_shell", lambda: ("bash", "/bin/bash"))
    out = deixis("--show-completion", "zsh")[1]
    assert out.startswith("#compdef deixis\n") and out.endswith("compdef _deixis_completion deixis\n")
    assert deixis("--show-completion", "fish")[1].startswith("complete --command deixis ")


def test_the_help_says_that_a_shell_may_be_named() -> None:
    text = " ".join(deixis("--help")[1].split())
    assert "or for the one that is named: bash, zsh or fish" in text and "customize" not in text


@pytest.mark.parametrize("option", ["--show-completion", "--install-completion"])
def test_an_unknown_shell_is_named_in_the_error(option: str) -> None:
    code, out, err = deixis(option, "csh")
    assert (code, out) == (2, "") and f"'{option}': the shell must be bash, zsh or fish, got csh" in err


@pytest.mark.skipif(shutil.which("fish") is None, reason="needs fish")
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("deixis ground --engine s", "scalable\nsimilarity\n"),
        ("deixis solve n.csp --calculus rc", "rcc5\nrcc8\n"),
    ],
)
def test_fish_completes_with_the_printed_script(words: str, expected: str, tmp_path: Path) -> None:
    script = f"{deixis('--show-completion', 'fish')[1]}\ncomplete -C '{words}'"
    env = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    ran = subprocess.run(
        ["fish", "--no-config", "-c", script], capture_output=True, text=True, env=env, cwd=tmp_path, check=False
    )
    assert (ran.stdout, ran.stderr) == (expected, "")


def test_installing_writes_into_the_home_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr("shellingham.detect_shell", lambda: ("bash", "/bin/bash"))
    code, out, _ = deixis("--install-completion")
    assert code == 0 and "bash completion installed" in out
    assert "_DEIXIS_COMPLETE" in (tmp_path / ".bash_completions" / "deixis.sh").read_text(encoding="utf-8")


def test_completion_does_not_import_rich() -> None:
    code = (
        "import os, sys; sys.argv = ['deixis']\n"
        "os.environ.update(_DEIXIS_COMPLETE='complete_zsh', _TYPER_COMPLETE_ARGS='deixis ')\n"
        "from deixis.cli.app import run\n"
        "try:\n    run()\nfinally:\n    assert not any(name.startswith(('rich.', 'numpy')) for name in sys.modules)\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert '"ground":"' in ran.stdout and (ran.returncode, ran.stderr) == (0, "")
