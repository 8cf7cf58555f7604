"""Files of fluents: a written file is read back unchanged, and each error names its place."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.errors import DeixisError
from deixis.examples_data import example
from deixis.grammar.errors import ScriptFileError
from deixis.grammar.formats.fluents import (
    FluentFile,
    FluentFileError,
    bounds_to_json,
    format_fluents,
    parse_fluents,
    read_fluents,
)
from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.reasoning.constraints.difference import add
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import AllenStatement, EndDifference, Fluent, Statement, TemporalRelation

TEXTS = st.text(st.characters(categories=["L", "N", "P", "S"]), min_size=1, max_size=8)
TIMES = st.integers(-(10**15), 10**15).map(lambda ticks: ticks / 1e6) | st.sampled_from([0.0, 0.1, 4e9])


@st.composite
def some_bounds(draw: st.DrawFn) -> Bounds:
    lower, upper = sorted((draw(TIMES | st.just(-math.inf)), draw(TIMES | st.just(math.inf))))
    lower_open, upper_open = (draw(st.booleans()) and math.isfinite(end) for end in (lower, upper))
    if lower == math.inf or upper == -math.inf:
        return Bounds()
    return Bounds(lower, upper) if lower == upper else Bounds(lower, upper, lower_open, upper_open)


@st.composite
def content(draw: st.DrawFn) -> FluentFile:
    fluents = []
    for id in draw(st.lists(TEXTS, unique=True, max_size=4)):
        statement = Statement(draw(TEXTS), draw(TEXTS), draw(st.none() | TEXTS))
        start, finish = draw(some_bounds()), draw(some_bounds())
        proper = add(start.at_least, finish.at_most) > 1
        fluents.append(Fluent(id, statement, start, finish if proper else Bounds()))
    points = ["origin", *(point for fluent in fluents for point in fluent.points)]
    relations: list[TemporalRelation] = []
    if len(fluents) > 1:
        a, b = draw(st.permutations([fluent.id for fluent in fluents]))[:2]
        relations.append(AllenStatement(a, draw(st.integers(1, ALL_ALLEN)), b))
        tail, head = draw(st.permutations(points))[:2]
        relations.append(EndDifference(tail, head, draw(some_bounds())))
    return FluentFile(draw(TEXTS), tuple(fluents), tuple(relations))


@given(content())
def test_written_files_are_read_back(written: FluentFile) -> None:
    text = format_fluents(written)
    assert parse_fluents(text) == written
    assert format_fluents(parse_fluents(text)) == text


def test_the_example_reads_and_writes() -> None:
    found = read_fluents(example("serving.fluents.json"))
    assert len(found.fluents) == 5
    assert parse_fluents(format_fluents(found)) == found


def test_sources_name_the_place_in_the_file() -> None:
    found = read_fluents(example("serving.fluents.json"))
    assert found.fluents[1].source == f"{example('serving.fluents.json')}: fluents[1]"
    assert found.relations[2].source == f"{example('serving.fluents.json')}: relations[2]"


@pytest.mark.parametrize(("unit", "seconds"), [("s", 90.0), ("ms", 0.09), ("min", 5400.0), ("h", 324000.0)])
def test_units_are_converted(unit: str, seconds: float) -> None:
    text = json.dumps(
        {"origin": "o", "unit": unit, "fluents": [{"id": "f", "statement": ["a", "b"], "start": [90, 90]}]}
    )
    assert parse_fluents(text).fluents[0].start == Bounds(seconds, seconds)


def test_symbols_of_allen_are_accepted() -> None:
    fluents = [{"id": id, "statement": ["a", "b"]} for id in "fg"]
    relations = [{"a": "f", "allen": ["<", "mi", "equals"], "b": "g"}]
    stated = parse_fluents(json.dumps({"origin": "o", "fluents": fluents, "relations": relations})).relations[0]
    assert str(stated) == "before or equals or met_by(f, g)"


def test_bounds_with_open_ends() -> None:
    assert bounds_to_json(Bounds(0, 5, upper_open=True)) == {
        "lower": 0,
        "upper": 5,
        "lower_open": False,
        "upper_open": True,
    }


def with_fluent(**change: Any) -> str:
    return json.dumps({"origin": "o", "fluents": [{"id": "f1", "statement": ["cup", "on", "table"]} | change]})


def with_relation(relation: Any) -> str:
    fluents = [{"id": id, "statement": ["cup", "on", "table"]} for id in ("fetch", "serve")]
    return json.dumps({"origin": "o", "fluents": fluents, "relations": [relation]})


ALLEN = {"a": "fetch", "allen": ["before"], "b": "serve"}
BETWEEN = {"from": "fetch.start", "to": "serve.start", "bounds": [0, 1]}
WRONG = [
    ('{"origin": "o",\n "fluents": [,]}', ":2:14: this is not valid JSON"),
    ("", ":1:1: this is not valid JSON"),
    ("[" * 100_000, "nested too deeply"),
    ("[]", "must be an object {…}, got a list"),
    ("{}", "'origin' is missing"),
    ('{"origin": "o"}', "'fluents' is missing"),
    ('{"origin": "o", "origin": "p", "fluents": []}', "the key 'origin' occurs twice"),
    ('{"origin": "o", "fluent": []}', "unknown key 'fluent'; did you mean 'fluents'?"),
    ('{"origin": "o", "unit": "day", "fluents": []}', "unit must be one of s, ms, min, h, got 'day'"),
    ('{"origin": " ", "fluents": []}', "origin must be one line of printable text"),
    ('{"origin": "o", "fluents": {}}', "fluents must be a list, got an object"),
    ('{"origin": "o", "fluents": [7]}', "fluents[0] must be an object {…}, got a number"),
    (with_fluent(start=[float("nan"), 1]), "NaN is not a time; write null"),
    (with_fluent(start=[float("inf"), 1]), "Infinity is not a time"),
    (with_fluent(id=7), "fluents[0].id must be a string, got a number"),
    (with_fluent(id="a\nb"), "fluents[0].id must be one line"),
    (with_fluent(statement=["cup"]), "fluents[0].statement must be a subject, a predicate"),
    (with_fluent(statement=["cup", "on", None]), "fluents[0].statement[2] must be a string, got null"),
    (with_fluent(start=[True, 1]), "fluents[0].start[0] must be a number or null, got true"),
    (with_fluent(start=["1", 1]), "fluents[0].start[0] must be a number or null, got a string"),
    (with_fluent(start=[1]), "fluents[0].start must be two bounds"),
    (with_fluent(start=5), "fluents[0].start must be a list, got a number"),
    (with_fluent(start=[2, 1]), "fluents[0].start: no time lies in [2, 1]"),
    (with_fluent(start=[0, 10**20]), "fluents[0].start[1] must be at most 4e+09 s"),
    (with_fluent().replace('"f1"', '"f1", "start": [0, 1e999]'), "the number 1e999 is too large"),
    (with_fluent().replace('"f1"', '"f1", "start": [0, 1%s]' % ("0" * 5000)), "a number of 5001 digits is too large"),
    (with_fluent(start={"lower": 0, "uper": 1}), "fluents[0].start: unknown key 'uper'; did you mean 'upper'?"),
    (with_fluent(start={"lower": 0, "upper": 1, "upper_open": 1}), "start.upper_open must be true or false"),
    (with_fluent(start=[5, 6], finish=[1, 5]), "fluents[0]: the fluent 'f1' must start before it finishes"),
    (with_fluent(stop=[1, 5]), "fluents[0]: unknown key 'stop'"),
    (with_relation({"a": "fetch", "b": "serve"}), "relations[0]: 'allen' is missing"),
    (with_relation(ALLEN | {"a": "fetsch"}), "relations[0].a: there is no fluent 'fetsch'; did you mean 'fetch'?"),
    (with_relation(ALLEN | {"allen": ["befor"]}), "allen[0]: there is no relation 'befor'; did you mean 'before'?"),
    (with_relation(ALLEN | {"allen": []}), "relations[0].allen must have at least one relation"),
    (with_relation(ALLEN | {"b": "fetch"}), "relations[0]: the fluent 'fetch' is related to itself"),
    (with_relation(BETWEEN | {"from": "fetch"}), "relations[0].from: there is no point 'fetch'"),
    (with_relation(BETWEEN | {"to": "serve.finsh"}), "there is no point 'serve.finsh'; did you mean 'serve.finish'?"),
    (
        with_relation(BETWEEN | {"to": "serve.end"}),
        "there is no point 'serve.end'; there are serve.start and serve.finish",
    ),
    (with_relation(BETWEEN | {"to": "fetch.start"}), "relations[0]: the time from 'fetch.start' to itself"),
    (with_relation({"from": "fetch.start", "to": "serve.start"}), "relations[0]: 'bounds' is missing"),
]


@pytest.mark.parametrize(("text", "message"), WRONG, ids=[message[:40] for _, message in WRONG])
def test_errors_name_their_place(text: str, message: str) -> None:
    with pytest.raises(DeixisError) as caught:
        parse_fluents(text, "t.json")
    assert str(caught.value).startswith("t.json:")
    assert message in str(caught.value)
    assert len(str(caught.value)) < 300


def test_an_id_is_used_only_once() -> None:
    twice = json.dumps({"origin": "o", "fluents": [{"id": "f", "statement": ["a", "b"]}] * 2})
    with pytest.raises(FluentFileError, match=r"t: fluents\[1\]\.id: 'f' is used twice"):
        parse_fluents(twice, "t")


def error_message(text: str) -> str | None:
    try:
        parse_fluents(text)
    except DeixisError as error:
        return str(error)
    return None


VALUES = st.none() | st.booleans() | st.floats() | st.text()


@given(st.recursive(VALUES, lambda inner: st.lists(inner) | st.dictionaries(TEXTS, inner), max_leaves=10))
def test_any_json_is_read_or_rejected(data: Any) -> None:
    for text in (json.dumps(data), json.dumps({"origin": "o", "fluents": data}), with_fluent(start=data)):
        message = error_message(text)
        assert message is None or message.startswith("<fluents>:")


def test_unreadable_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(ScriptFileError, match="no such file"):
        read_fluents(tmp_path / "missing.json")
    with pytest.raises(FluentFileError, match="this is a folder"):
        read_fluents(tmp_path)
    (tmp_path / "latin").write_bytes(b'{"origin": "caf\xe9"}')
    with pytest.raises(ScriptFileError, match="line 1 is not UTF-8"):
        read_fluents(tmp_path / "latin")
