"""From a cloud to a category in memory, commands without a memory, and learned content as objects."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import deixis as command
from consoles import ROOT, blocks

import deixis
from deixis.errors import ArgumentError, DeixisError
from deixis.examples_data import example
from deixis.memory.errors import MemoryFormatError
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.errors import CloudError, SceneError
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.comparison.checking import RoleVerdict
from deixis.reasoning.errors import SettingError
from deixis.workflows.layouts.lay_table import lay_script
from deixis.workflows.scenes.simulate import simulate

TEA = "fork left of plate; knife right of plate"
FULL = example("formal_dinner.layout")
SECOND = example("second_table.scene.json")


def look(seed: int) -> PointCloud:
    """Return a table laid for tea, as a simulated camera sees it."""
    return simulate(lay_script(deixis.read_script(text=TEA), seed=seed), seed=seed).cloud


@pytest.fixture(scope="module")
def seen() -> Scene:
    return deixis.perceive(look(3))


def test_what_is_perceived_has_its_points_in_memory(seen: Scene) -> None:
    assert len(seen.objects) == 3 and seen.detection is not None
    for number, thing in enumerate(seen.objects):
        cloud = seen.cloud_of(thing.id)
        assert thing.cloud is cloud and len(cloud) == (seen.detection.labels == number).sum()
        middle = cloud.points.mean(axis=0)
        assert (middle > np.array(thing.minimum)).all() and (middle < np.array(thing.maximum)).all()


def test_taught_learned_and_recognised_without_a_file(seen: Scene, tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        learned = session.learn(deixis.read_script(text=TEA), seen)
        assert {taught.category for taught in learned.seen} == {"fork", "knife", "plate"}
        fork = learned.grounding.matches["fork"].perceived
        assert session.teach(seen, fork, "pitchfork").before == "fork"
        found = session.recognise(deixis.perceive(look(3)))
        assert found.scene[fork].label == "pitchfork"
        assert found.scene[fork].cloud is not None
    assert sorted(path.name for path in tmp_path.iterdir()) == ["memory"]


def test_one_scene_twice_in_a_call_equals_two_calls(seen: Scene, tmp_path: Path) -> None:
    examples = [(deixis.read_script(text=text), seen) for text in (TEA, TEA, TEA.replace("fork", "cake_fork"))]
    kept = []
    for place in ("at once", "in turn"):
        with deixis.Session(tmp_path / place) as session:
            batches = [examples] if place == "at once" else [[example] for example in examples]
            seen_as = [one.seen for batch in batches for one in session.learn_all(batch)]
            kept.append((seen_as, session.categories()))
    assert kept[0] == kept[1]
    assert kept[0][1] == {"cake_fork": 1, "knife": 1, "plate": 1}


def test_one_scene_twice_is_taken_back_where_a_call_fails(
    seen: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*args: object) -> None:
        raise DeixisError("refused")

    script = deixis.read_script(text=TEA)
    with deixis.Session(tmp_path / "memory") as session:
        monkeypatch.setattr("deixis.memory.semantic.store.SemanticMemory.commit", refuse)
        with pytest.raises(DeixisError, match=r"^refused$"):
            session.learn_all([(script, seen), (script, seen)])
        assert session.categories() == {}


def test_lessons_from_memory_and_from_files_are_equal(seen: Scene, tmp_path: Path) -> None:
    written = deixis.write_scene(seen, tmp_path / "tea.scene.json")
    read = deixis.read_scene(tmp_path / "tea.scene.json")
    assert read == written != seen
    kept = []
    for number, scene in enumerate((seen, written, read)):
        with deixis.Session(tmp_path / str(number)) as session:
            session.learn(deixis.read_script(text=TEA), scene)
            kept.append({(view.id, view.category) for view in session.views().views()})
    assert len(kept[0]) == 3 and kept[0] == kept[1] == kept[2]


def test_a_scene_is_written_elsewhere_with_its_clouds(seen: Scene, tmp_path: Path) -> None:
    first = deixis.write_scene(seen, tmp_path / "a" / "tea.scene.json")
    moved = deixis.write_scene(deixis.read_scene(first.file), tmp_path / "b.scene.json")
    assert not (tmp_path / "b.clouds").exists()
    odd = replace(seen, objects=tuple(replace(thing, id=f"../{thing.id}") for thing in seen.objects))
    again = deixis.write_scene(odd, tmp_path / "c.scene.json")
    for scene in (moved, again):
        for thing, original in zip(deixis.read_scene(scene.file).objects, seen.objects, strict=True):
            points = read_cloud(Path(scene.file).parent / str(thing.cloud)).points
            np.testing.assert_array_equal(points, seen.cloud_of(original.id).points)
    assert {path.name for path in tmp_path.iterdir()} == {"a", "b.scene.json", "c.clouds", "c.scene.json"}


def test_a_scene_that_cannot_be_written_leaves_nothing(seen: Scene, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for place in (tmp_path, tmp_path / "file" / "a.scene.json"):
        with pytest.raises(DeixisError, match=str(place)):
            deixis.write_scene(seen, place)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_scene_takes_the_place_of_no_device(seen: Scene, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.scene.json"
    os.mkfifo(pipe)
    with pytest.raises(DeixisError, match="this is a device or a pipe"):
        deixis.write_scene(seen, pipe)
    assert (pipe.is_fifo(), list(tmp_path.iterdir())) == (True, [pipe])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda wrong: deixis.perceive(wrong), "`cloud` must be a PointCloud, a string or a path, got"),
        (lambda wrong: deixis.perceive("x.pcd", settings=wrong), "`settings` must be a DetectionSettings or None, got"),
        (lambda wrong: deixis.perceive("x.pcd", viewpoint=wrong), "`viewpoint` must be a string, got"),
        (lambda wrong: deixis.write_scene(wrong, "x.scene.json"), "`scene` must be a Scene, got"),
        (lambda wrong: deixis.write_scene(Scene(()), wrong), "`file` must be a string or a path, got"),
        (lambda wrong: deixis.check(wrong, {"objects": []}), "`layout` must be a string, a path or a Script, got"),
    ],
)
@pytest.mark.parametrize("wrong", [3, {}, b"x"])
def test_a_wrong_type_is_an_error(call: Callable[[Any], object], message: str, wrong: object) -> None:
    with pytest.raises(DeixisError, match=message):
        call(wrong)


@pytest.mark.parametrize("examples", [["script", "scene"], [("script",)], [{"a": 1, "b": 2}], ("ab", "cd"), [3]])
def test_a_script_without_its_scene_is_an_error(examples: Any, tmp_path: Path) -> None:
    with (
        deixis.Session(tmp_path / "memory") as session,
        pytest.raises(ArgumentError, match="`examples` must be a list of tuples"),
    ):
        session.learn_all(examples)
    assert not list(tmp_path.iterdir())


def test_a_lesson_that_is_refused_makes_no_memory(tmp_path: Path) -> None:
    (tmp_path / "bad.layout").write_text("cup left of jug; jug left of cup")
    memory, scene = tmp_path / "memory", example("place_setting.scene.json")
    code, out, err = command(
        "learn", example("script1.layout"), scene, tmp_path / "bad.layout", scene, "--memory", memory
    )
    assert (code, out, "the script contradicts itself" in err, memory.exists()) == (2, "", True, False)


def test_a_missing_folder_of_lessons_is_an_error(tmp_path: Path) -> None:
    code, _, err = command("learn", tmp_path / "none", "--memory", tmp_path / "memory")
    assert (code, err) == (2, f"deixis: {tmp_path / 'none'}: there is no such file or folder\n")


def test_errors_name_the_cloud_that_was_perceived(tmp_path: Path) -> None:
    file = tmp_path / "nothing.pcd"
    write_cloud(file, PointCloud(np.full((4, 3), np.nan, np.float32)))
    with pytest.raises(CloudError, match=r"nothing\.pcd: a cloud without one finite point"):
        deixis.perceive(file)
    with pytest.raises(CloudError, match=r"^a cloud without one finite point"):
        deixis.perceive(read_cloud(file))


def test_a_thing_without_points_is_an_error(seen: Scene) -> None:
    bare = Scene((PerceivedObject("o1", (0.0, 0.0), (1.0, 1.0)),))
    with pytest.raises(SceneError, match="the object 'o1' has no cloud"):
        bare.cloud_of("o1")
    with pytest.raises(SceneError, match="there is no object 'o9'; there are: o1, o2, o3"):
        seen.cloud_of("o9")


def test_a_table_is_checked_by_a_script_without_a_memory() -> None:
    checked = deixis.check(FULL, SECOND)
    assert [entry.role for entry in checked.table.of(RoleVerdict.MISSING)] == ["water_glass"]
    assert not checked.conforms
    with pytest.raises(SettingError, match="layout must be a script or its file"):
        deixis.check("formal_dinner", SECOND)


def test_check_and_recognise_run_where_no_memory_is(
    seen: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "none"))
    deixis.write_scene(seen, tmp_path / "tea.scene.json")
    code, out, err = command("check", FULL, SECOND, "--json")
    assert (code, err) == (1, "")
    assert json.loads(out)["layout"] == "formal_dinner"
    code, out, err = command("recognise", tmp_path / "tea.scene.json")
    assert (code, err) == (1, "")
    lines = out.splitlines()
    assert len(lines) == 3
    assert all("unknown" in line and "no category has been taught" in line for line in lines)
    assert not (tmp_path / "none").exists()


def test_check_does_not_open_a_memory_in_use(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        session.memory(create=True)
        code, out, err = command("check", FULL, SECOND, "--memory", tmp_path / "memory", "--no-memory")
        assert (code, err) == (1, "") and "water_glass" in out
        assert command("check", FULL, SECOND, "--memory", tmp_path / "memory")[0] == 2
    code, out, err = command("check", "formal_dinner", SECOND, "--no-memory")
    assert (code, out) == (2, "") and "where there is no memory, got the name 'formal_dinner'" in err


def test_recognise_makes_no_memory(seen: Scene, tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "none") as session:
        found = session.recognise(seen)
        assert set(found.answers) == set(seen.ids)
        assert not any(answer.label for answer in found.answers.values())
        assert session.categories() == {}
        assert session.check(FULL, SECOND).table.of(RoleVerdict.MISSING)
    assert not (tmp_path / "none").exists()


def test_the_stores_of_a_session_are_closed_with_it(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        assert not session.knowledge_store.exists() and not session.view_store.exists()
        session.memory(create=True)
        session.views(create=True)
        assert session.knowledge_store.exists() and session.view_store.exists()
    for store in (session.knowledge_store, session.view_store):
        with pytest.raises(MemoryFormatError, match="this session is closed"):
            store.memory()


@pytest.mark.skipif(
    not (PAGE := ROOT / "docs" / "reference" / "description_logic.md").exists(), reason="there is no such page"
)
def test_the_page_on_objects_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "memory"))
    (program,) = [text for language, text in blocks(PAGE) if language == "python" and "session.owl()" in text]
    names: dict[str, object] = {}
    exec(compile(program, str(PAGE), "exec"), names)
    assert names["forks"] == [] and names["everything"]


def test_what_was_learned_is_there_as_objects(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        with session.owl() as shipped:
            assert shipped.ontology.Fork.instances() == []
        assert not (tmp_path / "memory").exists()
        session.learn(FULL, example("place_setting.scene.json"))
        with session.owl() as view:
            forks = view.ontology.Fork.instances()
            assert {one.identifier for one in forks} == {"o7", "o9", "o10"}
            (layout,) = view.search(iri="*/layout/formal_dinner-1")
            assert view.ontology.Layout in layout.is_a
            shown = {part.value for part in layout.is_a if hasattr(part, "property")}
            assert view.ontology.SoupSpoon in shown
            assert set(forks) <= set(view.individuals())
            session.forget("formal_dinner-1")
            assert view.ontology.Fork.instances() == forks
        with session.owl() as later:
            assert later.ontology.Fork.instances() == []
