"""deixis time: what it prints, its exit codes, and the page that shows it."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from commands import deixis

from deixis.examples_data import example

FILE = "serving.fluents.json"
PAGE = (Path(__file__).parents[4] / "docs" / "reference" / "time.md").read_text(encoding="utf-8")
CONSOLE = re.findall(r"^```console\n\$ deixis (.*?)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
NEVER = ["before", "after"]


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the shipped example."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / FILE).write_bytes(example(FILE).read_bytes())
    return tmp_path


def story(relations: list[dict[str, Any]], **ends: Any) -> str:
    """Writes a file of three fluents of 10 s, a, b and c, between 0 and 35 s."""
    fluents = [
        {"id": id, "statement": ["robot", "lays", id], "start": [0, None], "finish": [None, ends.get("end", 35)]}
        for id in "abc"
    ]
    lasting = [{"from": f"{id}.start", "to": f"{id}.finish", "bounds": [10, None]} for id in "abc"]
    content = {"origin": "noon", "fluents": fluents, "relations": [*lasting, *relations]}
    Path("story.fluents.json").write_text(json.dumps(content), encoding="utf-8")
    return "story.fluents.json"


def one_at_a_time() -> list[dict[str, Any]]:
    return [{"a": a, "allen": NEVER, "b": b} for a, b in ("ab", "bc", "ac")]


def test_the_page_shows_the_shipped_example() -> None:
    shown = re.search(r"^```json\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert shown is not None
    assert shown[1] == example(FILE).read_text(encoding="utf-8")


@pytest.mark.parametrize(("command", "answer"), CONSOLE, ids=[command for command, _ in CONSOLE])
def test_the_commands_of_the_page(command: str, answer: str) -> None:
    assert deixis(*shlex.split(command)) == (0, answer, "")


def test_the_python_of_the_page(capsys: pytest.CaptureFixture[str]) -> None:
    programs = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    names: dict[str, object] = {}
    for program in programs:
        exec(compile(program, "docs/reference/time.md", "exec"), names)
    assert len(programs) == 2
    assert capsys.readouterr().out.startswith("before(pouring, cleared)   by definition\n")


def test_bounds_as_json() -> None:
    code, out, _ = deixis("time", FILE, "--json")
    answer = json.loads(out)
    assert (code, answer["verdict"], answer["exact"]) == (0, "consistent", True)
    assert answer["fluents"][3]["start"] == {"lower": 30, "upper": None, "lower_open": True, "upper_open": False}


def test_answers_as_json() -> None:
    assert json.loads(deixis("time", FILE, "--at", 28, "--json")[1])["possible"] == ["fetch", "carried", "cleared"]
    relation = json.loads(deixis("time", FILE, "--relate", "fetch", "pouring", "--json")[1])
    assert (relation["certain"], relation["order"]) == ("before", "precedes")
    why = json.loads(deixis("time", FILE, "--explain", "fetch", "pouring", "--json")[1])
    assert why["explanations"][0]["conclusion"] == "before(fetch, pouring)"


def test_a_contradiction_is_printed_with_its_places_and_exits_1() -> None:
    file = story([{"a": "a", "allen": ["before"], "b": "b"}, {"a": "b", "allen": ["during", "overlaps"], "b": "a"}])
    code, out, err = deixis("time", file)
    assert (code, err) == (1, "")
    assert out == CONTRADICTION


CONTRADICTION = """\
These cannot all hold:
    story.fluents.json: relations[4]: overlaps or during(b, a)
    story.fluents.json: relations[3]: before(a, b)
Leave out or change any one of these.
The proof:
    no alternative is left   by cases
        overlaps or during(b, a)   stated   [story.fluents.json: relations[4]]
        a.start < a.start   by negative cycle
            b.start < a.start   by definition
                overlaps(b, a)   by case
            a.finish < b.start   by definition
                before(a, b)   stated   [story.fluents.json: relations[3]]
            a.start < a.finish   by proper interval
        a.finish < a.finish   by negative cycle
            b.finish < a.finish   by definition
                during(b, a)   by case
            b.start < b.finish   by proper interval
            a.finish < b.start   by definition, as above
"""


def test_choices_that_cannot_be_made_are_refuted_and_exit_1() -> None:
    code, out, _ = deixis("time", story(one_at_a_time(), end=25), "--json")
    answer = json.loads(out)
    assert (code, answer["verdict"], answer["minimal"]) == (1, "inconsistent", True)
    assert {f"story.fluents.json: relations[{k}]" for k in range(6)} <= {s["source"] for s in answer["statements"]}


def test_choices_that_can_be_made_are_gone_through() -> None:
    code, out, _ = deixis("time", story(one_at_a_time(), end=30.5), "--at", 5)
    assert (code, out.count("possible"), out.count("certain")) == (0, 3, 0)


def test_without_time_it_is_undecided_and_exits_3() -> None:
    code, out, _ = deixis("time", story(one_at_a_time()), "--time-limit", 0)
    assert code == 3
    assert "Undecided: time limit reached" in out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--at", "inf"], "a time must be a finite number of seconds, got inf"),
        (["--window", "0", "inf"], "a window must have finite ends, got 0.0 and inf"),
        (["--relate", "fetch", "served", "--pattern", "cup", "on", "*"], "--pattern excludes"),
        (["--at", "1e99"], "beyond 4e+09 s"),
        (["--window", "3", "2"], "a window must begin before it ends"),
        (["--relate", "fech", "served"], "there is no fluent 'fech'; did you mean 'fetch'?"),
        (["--explain", "fetch", "served.start"], "there is no fluent 'served.start'; did you mean 'served'?"),
        (["--at", "1", "--window", "2", "3"], "exclude one another"),
    ],
    ids=" ".join,
)
def test_bad_questions_exit_2(options: list[str], message: str) -> None:
    code, out, err = deixis("time", FILE, *options)
    assert (code, out) == (2, "")
    assert message in err and err.count("\n") == 1


@pytest.mark.parametrize("text", ["", "[]", "[" * 100_000, '{"origin": "o", "fluents": [{}]}', "\0"], ids=range(5))
def test_bad_files_exit_2(here: Path, text: str) -> None:
    (here / "bad.fluents.json").write_text(text, encoding="utf-8")
    code, out, err = deixis("time", "bad.fluents.json")
    assert (code, out) == (2, "")
    assert err.startswith("deixis: bad.fluents.json:") and err.count("\n") == 1


def test_a_fluent_equals_itself_for_a_reason() -> None:
    assert deixis("time", FILE, "--explain", "fetch", "fetch") == (0, "equals(fetch, fetch)   by definition\n", "")


def test_an_incomplete_answer_exits_3_and_explains_stated_sets() -> None:
    ids = [f"f{k}" for k in range(8)]
    fluents = [{"id": id, "statement": ["robot", "lays", id]} for id in ids]
    relations = [{"a": a, "allen": NEVER, "b": b} for a in ids for b in ids if a < b]
    Path("many.fluents.json").write_text(json.dumps({"origin": "noon", "fluents": fluents, "relations": relations}))
    code, out, _ = deixis("time", "many.fluents.json", "--relate", "f1", "f0")
    assert (code, out.splitlines()[0]) == (3, "possible: before, after (f1, f0)")
    assert "more may be certain" in out
    code, out, _ = deixis("time", "many.fluents.json", "--explain", "f1", "f0")
    assert (code, out.splitlines()[0]) == (3, "before or after(f1, f0)   by intersection")


def test_the_times_are_drawn(here: Path) -> None:
    code, out, _ = deixis("time", FILE, "--plot", "times.svg")
    assert (code, out.splitlines()[-1]) == (0, "Written: times.svg")
    assert "fetches(robot, cup)" in (here / "times.svg").read_text(encoding="utf-8")
