"""Limits of grounding: time from reading on, memory estimated before it is taken, and what is said about either."""

from __future__ import annotations

import json
import time
import tracemalloc
from dataclasses import replace
from pathlib import Path

import pytest
from commands import deixis
from timing import processor_time_below

import deixis as package
from deixis.cli import common
from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate
from deixis.grammar.errors import ScriptTimeError
from deixis.grammar.layout.parser import parse_script
from deixis.kernels import compile_grounding
from deixis.perception.formats.scene_json import read_scene
from deixis.reasoning.errors import OutOfMemoryError, OutOfTimeError, SettingError
from deixis.reasoning.grounding.answers.answer import Standing
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.memory_budget import different_facts, leaves_room_for_chains, required_gigabytes
from deixis.workflows.grounding.ground import GroundingRequest, answer


def written(objects: int, folder: Path) -> tuple[Path, Path]:
    """Write a script and a scene with this number of objects."""
    table = generate(objects, seed=0)
    facts = table.description().facts()
    script, scene = folder / "large.layout", folder / "large.scene.json"
    script.write_text("".join(f"{f.subject} {f.relations[0].phrase} {f.object}\n" for f in facts), encoding="utf-8")
    things = [{"id": f"o{p}", "min": low.tolist(), "max": high.tolist()} for p, (low, high) in enumerate(table.boxes)]
    scene.write_text(json.dumps({"frame": "t", "viewpoint": "v", "unit": "m", "objects": things}), encoding="utf-8")
    return script, scene


@pytest.mark.parametrize("objects", [60, 150])
def test_the_memory_estimate_is_no_less_than_the_peak(objects: int, tmp_path: Path) -> None:
    compile_grounding("exact")
    script, scene = written(objects, tmp_path)
    read, seen = package.read_script(script), read_scene(scene)
    description = read.graph()
    tracemalloc.start()
    answer(GroundingRequest(read, seen, time_limit=2.0))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    estimate = required_gigabytes(objects, objects, len(description), different_facts(description))
    assert peak / 1e9 <= estimate < 0.5


def test_a_request_over_the_memory_limit_is_refused_in_advance(tmp_path: Path) -> None:
    compile_grounding("exact")
    script, scene = written(200, tmp_path)
    read, seen = package.read_script(script), read_scene(scene)
    tracemalloc.start()
    with pytest.raises(OutOfMemoryError, match="memory limit is"):
        answer(GroundingRequest(read, seen, memory_limit=0.01))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1e7
    code, out, err = deixis("ground", script, scene, "--memory-limit", "0.01")
    assert (code, out) == (3, "")
    assert "200 things" in err and "--memory-limit" in err


@pytest.mark.parametrize("method", ["ground", "learn", "check"])
def test_reading_a_long_text_keeps_to_the_time_limit(method: str, tmp_path: Path) -> None:
    text = tmp_path / "long.txt"
    text.write_text("The fork that is left of the plate which lies on the mat is by the cup. " * 5000, encoding="utf-8")
    with package.Session(tmp_path / "memory") as session, pytest.raises(ScriptTimeError, match="time limit reached"):
        getattr(session, method)(text, "examples/place_setting.scene.json", time_limit=0.2)


def test_where_memory_is_short_probabilities_are_beliefs(tmp_path: Path) -> None:
    script, scene = written(100, tmp_path)
    read = package.read_script(script)
    said = read.graph()
    limit = required_gigabytes(100, 100, len(said), different_facts(said), chains=False) + 1e-4
    assert not leaves_room_for_chains(read.graph(), 100, limit)
    found = answer(GroundingRequest(read, read_scene(scene), engine="scalable", memory_limit=limit))
    assert found.probabilities is Standing.PROPAGATED
    assert not any(match.decided for match in found.matches.values())
    assert any("memory" in note for note in found.notes)


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan")])
def test_an_invalid_memory_limit_is_refused(limit: float) -> None:
    with pytest.raises(SettingError, match="memory limit"):
        GroundingRequest(parse_script("a left of b"), read_scene({"objects": []}), memory_limit=limit)


@pytest.mark.parametrize("objects", [40, 120, 240])
def test_the_time_limit_holds_from_reading_on(objects: int, tmp_path: Path) -> None:
    compile_grounding("exact")
    script, scene = written(objects, tmp_path)
    started, worked = time.monotonic(), time.process_time()
    found = package.ground(script, scene, time_limit=1.0)
    shared = max(1.0, (time.monotonic() - started) / max(time.process_time() - worked, 1e-3))  # with other processes
    assert time.monotonic() - started < 1.0 + 0.5 * shared
    assert len(found.matches) > objects / 2


def test_past_the_deadline_reading_ends_with_an_error() -> None:
    text = "".join(f"a{i} left of b{i}\n" for i in range(1000))
    with pytest.raises(ScriptTimeError, match="after 200 statements"):
        parse_script(text, deadline=Deadline.after(-1.0))
    assert len(parse_script("a left of b", deadline=Deadline.after(-1.0)).facts) == 1


def test_past_the_deadline_a_large_scene_has_no_evidence() -> None:
    table = generate(300, seed=0)
    known = no_unary_evidence(table.description(), table.scene())
    with pytest.raises(OutOfTimeError, match="300 things"):
        _ = replace(known, deadline=Deadline.after(-1.0)).problem
    assert issubclass(OutOfTimeError, TimeoutError)


def test_the_time_limit_of_a_command_begins_with_its_process(tmp_path: Path) -> None:
    script, scene = written(40, tmp_path)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(common, "started", time.monotonic() - 100.0)
        assert common.deadline_of(30.0).passed
        code, _, err = deixis("ground", script, scene, "--time-limit", "30")
    assert (code, err) == (3, "")
    assert not common.deadline_of(30.0).passed


def test_pairs_of_a_large_scene_are_given_up_as_foreseen() -> None:
    table = generate(1500, seed=0)
    known = no_unary_evidence(table.description(), table.scene())
    with processor_time_below(5.0), pytest.raises(OutOfTimeError):
        _ = replace(known, deadline=Deadline.after(0.2)).problem
