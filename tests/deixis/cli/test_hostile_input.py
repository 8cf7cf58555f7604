"""Hostile input of every class, to every command that reads it: in bounded time and memory, and shown safely."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyoxigraph as ox
import pytest
from commands import deixis
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import deixis as package
from deixis.cli.output import VisibleStream
from deixis.examples_data import example
from deixis.memory.semantic.queries.results import QueryKind, QueryResult, Row
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory
from deixis.printable import MAX_MESSAGE, shortened, visible, visible_line

SCRIPT, SCENE = example("script1.layout"), example("place_setting.scene.json")
UNSAFE = re.compile(r"\r(?!\n)|[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
ESC, BIDI, LINE = "\x1b[2J\x9b", "\u202e\u2066", "\nforged: yes\t"
HOSTILE = f"a{ESC}b{BIDI}c"

ADDRESS_SPACE = 3 * 2**30
SECONDS = 8.0
MB = 1_000_000


LINE_BY_LINE = ("parse", "fmt", "infer", "solve", "reason")
"""Commands whose files have no names of several lines: a line end ends a statement."""


def safe(*texts: str, lines: bool = True) -> None:
    for text in texts:
        assert not UNSAFE.search(text), ascii(text)
        assert not (lines and any(line.startswith("forged") for line in text.split("\n"))), text


def run_bounded(*args: object, **options: Any) -> subprocess.CompletedProcess[str]:
    """Runs a command as a process with limits of memory and time."""
    code = (
        f"import resource; resource.setrlimit(resource.RLIMIT_AS, ({ADDRESS_SPACE}, {ADDRESS_SPACE}))\n"
        "from deixis.cli.app import run; run()"
    )
    env = {**os.environ, "PYTHONPATH": str(Path(package.__file__).parents[1]), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", code, *map(str, args)]
    options = {"stdout": subprocess.PIPE, "stdin": subprocess.DEVNULL, **options}
    return subprocess.run(command, stderr=subprocess.PIPE, text=True, env=env, timeout=60, check=False, **options)


# ---- names, labels and literals with control characters


def scene_of(name: str, label: str) -> str:
    things = [
        {"id": name, "min": [0, 0], "max": [1, 1], "label": {"text": label, "confidence": 0.9}},
        {"id": "o2", "min": [3, 0], "max": [4, 1]},
    ]
    return json.dumps({"objects": things})


READERS: dict[str, Callable[[Path, str], tuple[str, list[object]]]] = {
    "relate": lambda at, name: (scene_of(name, "fork"), ["relate", at]),
    "relate --matrix": lambda at, name: (scene_of(name, "fork"), ["relate", at, "--matrix"]),
    "ground": lambda at, name: (scene_of(name, name), ["ground", SCRIPT, at]),
    "ground --json": lambda at, name: (scene_of(name, name), ["ground", SCRIPT, at, "--json"]),
    "check": lambda at, name: (scene_of(name, name), ["check", SCRIPT, at]),
    "retrieve": lambda at, name: (scene_of(name, name), ["retrieve", at, SCENE]),
    "ask": lambda at, name: (scene_of(name, name), ["ask", "fork", at]),
    "teach": lambda at, name: (scene_of(name, name), ["teach", at, name.replace("\0", ""), "fork"]),
    "unknown key": lambda at, name: (json.dumps({"objects": [], name: 1}), ["relate", at]),
    "repeated key": lambda at, name: (f'{{{json.dumps(name)}: 1, {json.dumps(name)}: 1}}', ["relate", at]),
    "solve": lambda at, name: (f"2 # {name}\n0 1 ( {name} )\n.\n", ["solve", "--calculus", "allen", at]),
    "time": lambda at, name: (json.dumps({"fluents": [{"statement": name}]}), ["time", at]),
    "parse": lambda at, name: (f'"{name}" left of plate\n# {name}\nlayout {name}', ["parse", at]),
    "fmt": lambda at, name: (f"# {name}\nfork left of plate\n", ["fmt", at]),
    "infer": lambda at, name: (f"fork {name} plate\n", ["infer", at]),
    "reason": lambda at, name: (f'<urn:a> <urn:p> "{name}" . <urn:a{name}> a', ["reason", at]),
    "oracle": lambda at, name: (json.dumps({name: name}), ["ground", SCRIPT, SCENE, "--oracle", at]),
}  # fmt: skip


@pytest.mark.parametrize("reader", READERS.values(), ids=READERS)
@pytest.mark.parametrize("name", [HOSTILE, f"a{LINE}b", "\r\x00\x7f"], ids=["controls", "lines", "others"])
def test_control_characters_never_reach_the_terminal(
    tmp_path: Path, reader: Callable[[Path, str], tuple[str, list[object]]], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "memory"))
    monkeypatch.setattr("sys.stdin", io.StringIO(f"{HOSTILE}\n"))
    text, command = reader(tmp_path / "hostile.scene.json", name)
    if command[0] in LINE_BY_LINE:
        text, command = reader(tmp_path / {"reason": "hostile.ttl"}.get(str(command[0]), "hostile.layout"), name)
    next(part for part in command if isinstance(part, Path) and part.parent == tmp_path).write_text(text, "utf-8")
    code, out, err = deixis(*command)
    assert code in (0, 1, 2, 3)
    assert "defect" not in err
    safe(out, err, lines=command[0] not in LINE_BY_LINE)


@pytest.mark.parametrize("command", ["parse", "fmt", "infer", "relate", "reason", "solve", "time", "recognise"])
def test_file_names_with_control_characters(tmp_path: Path, command: str) -> None:
    for name in (f"{HOSTILE}.layout", f"x{LINE}.json", f"{HOSTILE}{LINE}.ttl"):
        code, out, err = deixis(command, tmp_path / name)
        assert (code, out) == (2, "")
        safe(err)


@pytest.mark.parametrize("option", [f"--{HOSTILE}", f"--x{LINE}", f"x{LINE}", "--" + "x" * 100_000])
def test_command_lines_with_control_characters(option: str) -> None:
    code, out, err = deixis("parse", SCRIPT, option)
    assert (code, out) == (2, "")
    safe(err)
    assert len(err) < 1000


def test_literals_with_control_characters(tmp_path: Path) -> None:
    text = f"{HOSTILE}{LINE}"
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        label = ox.NamedNode("http://www.w3.org/2000/01/rdf-schema#label")
        memory.learn(HOSTILE, {GraphName.ASSERTED: [ox.Triple(ox.NamedNode("urn:a"), label, ox.Literal(text))]}, [])
    at = ("--memory", tmp_path / "memory")
    select = "SELECT ?o { <urn:a> ?p ?o }"
    for command in (
        ("query", select),
        ("query", "DESCRIBE <urn:a>"),
        ("query", "CONSTRUCT WHERE { ?s ?p ?o }", "--format", "turtle"),
        ("query", f"SELECT {HOSTILE}"),
        ("memory", "stats"),
        ("memory", "stats", "--json"),
        ("memory", "forget", HOSTILE + "x"),
        ("show", HOSTILE),
    ):
        _, out, err = deixis(*command, *at)
        safe(out, err)
    _, out, _ = deixis("query", select, "--format", "csv", *at)
    assert not UNSAFE.search(out)
    for format in ("--json", "--format=json"):
        _, out, _ = deixis("query", select, format, *at)
        safe(out)
        assert json.loads(out)["results"]["bindings"] == [{"o": {"type": "literal", "value": text}}]
    _, out, _ = deixis("query", "CONSTRUCT WHERE { ?s ?p ?o }", "--format", "turtle", *at)
    assert text in {quad.object.value for quad in ox.parse(out, format=ox.RdfFormat.TURTLE)}
    for format in ("trig", "turtle"):  # an export says the same, escaped
        _, out, _ = deixis("memory", "export", "--format", format, *at)
        safe(out)
        parsed = ox.parse(out, format=ox.RdfFormat.TRIG)
        assert text in {quad.object.value for quad in parsed if isinstance(quad.object, ox.Literal)}


@given(st.text(max_size=60))
def test_what_is_printed_is_safe_and_json_means_the_same(text: str) -> None:
    for shown in (visible(text), visible_line(text)):
        assert not UNSAFE.search(shown)
        shown.encode("utf-8")
    assert not set(visible_line(text)) & set("\n\r\t")
    assert json.loads(visible(json.dumps(text, ensure_ascii=False))) == text


@given(st.lists(st.text(max_size=20), max_size=4))
def test_plain_text_passes_a_stream_unchanged(texts: list[str]) -> None:
    stream = io.StringIO()
    visible_stream = VisibleStream(stream)
    visible_stream.writelines(texts)
    assert stream.getvalue() == "".join(visible(text) for text in texts)
    plain = [text for text in texts if text.isprintable()]
    assert [visible_line(text) for text in plain] == plain


@given(st.text(max_size=300), st.integers(3, 100))
def test_shortened_texts_keep_their_ends(text: str, limit: int) -> None:
    short = shortened(text, limit)
    assert len(short) == min(limit, len(text))
    assert short[0:1] == text[0:1] and short[-1:] == text[-1:]


# ---- long and repetitive input

LONG_INPUT: dict[str, tuple[str, Callable[[], str], list[str]]] = {
    "word": ("x.layout", lambda: "a" * 10_000_000, ["parse"]),
    "layout name": ("x.layout", lambda: "layout " + "a" * 10_000_000 + "\nfork left of plate", ["parse"]),
    "title": ("x.layout", lambda: 'layout x "' + "a" * 10_000_000 + '"\nfork left of plate', ["infer"]),
    "quoted name": ("x.layout", lambda: '"' + "a " * 1_000_000 + '" left of plate', ["fmt"]),
    "open quotation": ("x.layout", lambda: '"' + "a" * 5_000_000, ["parse"]),
    "wrong lines": ("x.layout", lambda: "fork lft of plate\n" * 20_000, ["parse"]),
    "keys": ("x.scene.json", lambda: "{" + ",".join(f'"k{i}":1' for i in [*range(40_000)] * 2) + "}", ["relate"]),
    "id": ("x.scene.json", lambda: '{"objects":[{"id":"' + "a" * 10_000_000 + '"}]}', ["relate"]),
    "depth": ("x.scene.json", lambda: "[" * 5_000_000, ["relate"]),
    "digits": ("x.scene.json", lambda: '{"objects":' + "9" * 5_000_000 + "}", ["relate"]),
    "key": ("x.scene.json", lambda: '{"' + "k" * 10_000_000 + '":1}', ["relate"]),
    "literal": ("x.ttl", lambda: '<urn:a> <urn:p> "' + "a" * 50_000_000 + '" .', ["memory", "import"]),
    "iri": ("x.ttl", lambda: "<urn:" + "a" * 5_000_000 + '> <urn:p> "a" .', ["memory", "import"]),
    "nested lists": ("x.ttl", lambda: "<urn:a> <urn:p> " + "(" * 200_000, ["memory", "import"]),
    "prefix": ("x.ttl", lambda: "a" * 5_000_000 + ":x a :y .", ["reason"]),
    "query": ("x.rq", lambda: "SELECT * { FILTER(" + "!" * 200_000 + "true) }", ["query", "-f"]),
    "braces": ("x.rq", lambda: "SELECT * " + "{" * 4_000 + "}" * 4_000, ["query", "-f"]),
    "variable": ("x.rq", lambda: "SELECT ?" + "a" * 900_000 + " {} LIMIT x", ["query", "-f"]),
    "network": ("x.txt", lambda: f"1 # {'a' * 5 * MB}\n0 1 ( {'b' * 5 * MB} )\n.\n", ["solve", "--calculus=allen"]),
    "fluent": ("x.json", lambda: '{"fluents":[{"statement":"' + "a" * 5_000_000 + '"}]}', ["time"]),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("name", "make", "command"), LONG_INPUT.values(), ids=LONG_INPUT)
def test_long_input_takes_bounded_time_and_memory(
    tmp_path: Path, name: str, make: Callable[[], str], command: list[str]
) -> None:
    file = tmp_path / name
    file.write_text(make(), encoding="utf-8")
    if command[0] in ("memory", "query"):
        SemanticMemory.open(tmp_path / "memory", create=True).close()
        command = [*command, str(file), "--memory", str(tmp_path / "memory")]
    else:
        command = [*command, str(file)]
    start = time.process_time(), os.times().children_user
    ran = run_bounded(*command)
    assert os.times().children_user - start[1] < SECONDS
    assert ran.returncode == 2, ran.stderr[:500]
    assert "defect" not in ran.stderr and "Traceback" not in ran.stderr
    lines = ran.stderr.splitlines()
    assert all(len(line) <= MAX_MESSAGE + len("deixis: ") for line in lines)
    assert len(lines) <= 3 or (name == "x.layout" and len(lines) < 300)


# ---- what is closed or full


@pytest.mark.parametrize("redirected", ["<&-", "< /", "< /dev/null", "< /bin/sh"])
def test_questions_without_a_person_who_answers(redirected: str) -> None:
    line = f"exec {sys.executable} -m deixis.cli.app ground --ask {SCRIPT} {SCENE} {redirected}"
    env = {**os.environ, "PYTHONPATH": str(Path(package.__file__).parents[1])}
    ran = subprocess.run(["sh", "-c", line], env=env, capture_output=True, text=True, timeout=60, check=False)
    assert ran.returncode in (0, 1, 2, 3), ran.stderr
    assert "defect" not in ran.stderr
    assert (ran.returncode == 2) == ran.stderr.startswith("deixis: standard input: ")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_command_whose_answer_is_lost_says_what_it_changed(tmp_path: Path) -> None:
    memory = tmp_path / "memory"
    with Path("/dev/full").open("w") as full:
        ran = run_bounded("learn", SCRIPT, SCENE, "--memory", memory, stdout=full)
        assert ran.returncode == 2
        assert f"No space left on device; the memory at {memory} was already changed" in ran.stderr
        assert "memory" not in run_bounded("parse", SCRIPT, stdout=full).stderr
    assert deixis("memory", "stats", "--memory", memory)[0] == 0


# ---- spreadsheets

FORMULAS = ["=1+1", "+cmd", "-2+3", "@SUM(A1)", "\t=1", "\r=1", "\n=1", "＝1", "-", "+1 2"]
NUMBERS = ["-5", "+5", "-5.25", "-1e-7", "+.5", "-INF", "5", "1=2", "a-b", "x@y", ""]


@pytest.mark.parametrize("text", FORMULAS)
def test_a_cell_of_csv_begins_no_formula(text: str) -> None:
    result = QueryResult(QueryKind.SELECT, ("x",), (Row([ox.Literal(text)], ("x",)),))
    (cell,) = re.findall(r"\r\n\"?(.*?)\"?\r\n$", result.to_csv(), re.DOTALL)
    assert cell == f"'{text}"


@pytest.mark.parametrize("text", NUMBERS)
def test_numbers_and_plain_texts_stay_in_csv(text: str) -> None:
    result = QueryResult(QueryKind.SELECT, ("x",), (Row([ox.Literal(text)], ("x",)),))
    assert result.to_csv() in (f"x\r\n{text}\r\n", f'x\r\n"{text}"\r\n')


PIECES = st.sampled_from([ESC, BIDI, "\n", "\r", "\t", "\0", '"', "'", "{", "[", "(", "fork", "left of", "=", ":", "é"])


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    pieces=st.lists(PIECES, max_size=12), command=st.sampled_from(["parse", "fmt", "infer", "relate", "time", "solve"])
)
def test_any_mixture_of_control_characters(tmp_path: Path, pieces: list[str], command: str) -> None:
    file = tmp_path / "any.txt"
    file.write_text("".join(pieces), encoding="utf-8", newline="")
    code, out, err = deixis(command, file)
    assert code in (0, 1, 2)
    assert "defect" not in err
    assert not UNSAFE.search(out + err)


ENDLESS: list[list[object]] = [
    ["refer", "--batch", "@"], ["refer", "the fork", SCENE, "--models", "@"], ["relation", "left", "--models", "@"],
    ["query", "-f", "@"], ["learn-relation", "--descriptions", "@", "-o", "weights.json"], ["point", "@", SCENE],
]  # fmt: skip


@pytest.mark.parametrize("command", ENDLESS, ids=lambda command: " ".join(map(str, command[:2])))
def test_an_endless_file_is_refused_at_once(command: list[object], tmp_path: Path) -> None:
    memory = ["--memory", tmp_path / "m"] if command[0] == "query" else []
    code, out, err = deixis(*["/dev/zero" if part == "@" else part for part in command], *memory)
    assert (code, out) == (2, "") and "/dev/zero: this is not a regular file" in err


@pytest.mark.parametrize("ending", [".ttl", ".zip", ".episodes.json"])
def test_import_does_not_wait_for_a_pipe(ending: str, tmp_path: Path) -> None:
    pipe = tmp_path / f"pipe{ending}"
    os.mkfifo(pipe)
    code, _, err = deixis("memory", "import", pipe, "--memory", tmp_path / "m")
    assert code == 2 and "pipe" in err


def test_a_batch_names_lines_that_are_nested_too_deeply(tmp_path: Path) -> None:
    (tmp_path / "b.jsonl").write_text("[" * 50_000 + '\n{"text": "a", "text": "b"}\n', encoding="utf-8")
    code, out, _ = deixis("refer", "--batch", tmp_path / "b.jsonl")
    assert (
        code == 0
        and "line 1: not JSON: the JSON is nested too deeply" in out
        and "line 2: not JSON: the key 'text' occurs twice" in out
    )


def test_a_check_of_episodes_out_of_time_is_undecided(tmp_path: Path) -> None:
    memory = ["--memory", tmp_path]
    assert deixis("episodes", "add", "t1", "left", "t2", "--start", 1, *memory)[0] == 0
    code, out, err = deixis("episodes", "check", "--time-limit", 0, *memory)
    assert code == 3 and out == "1 fluent: undecided\n" and "time limit reached before 1 of 1 fluents" in err
    code, out, _ = deixis("episodes", "check", "--time-limit", 0, "--json", *memory)
    assert code == 3 and json.loads(out)["consistent"] is None
