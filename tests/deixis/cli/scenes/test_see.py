"""perceive, teach, recognise, ask, category: from a simulated cloud to words, and back."""

from __future__ import annotations

import contextlib
import io
import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import plyvel
import pytest
from commands import deixis

from deixis.examples_data import example
from deixis.memory.owner import rename
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.session import Session
from deixis.workflows.grounding.ground import ground
from deixis.workflows.scenes.perceive import perceive, write_scene

FULL = example("formal_dinner.layout")


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two laid tables as clouds with their truth, perceived; and a memory that learned the first one."""
    folder = tmp_path_factory.mktemp("tables")
    for seed in (7, 20):
        cloud, truth = folder / f"{seed}.pcd", folder / f"{seed}.truth.scene.json"
        assert deixis("simulate", FULL, "-o", cloud, "--seed", str(seed), "--truth", truth)[0] == 0
        out, labels = folder / f"{seed}.scene.json", folder / f"{seed}.npy"
        assert deixis("perceive", cloud, "-o", out, "--labels", labels)[0] == 0
    assert deixis("learn", FULL, folder / "7.scene.json", "--memory", folder / "memory")[0] == 0
    return folder


def test_every_object_of_a_laid_table_is_found_and_grounded(tables: Path) -> None:
    scene = read_scene(tables / "20.scene.json")
    truth = {thing.label: thing for thing in read_scene(tables / "20.truth.scene.json").objects}
    assert len(scene.objects) == len(truth) == 12
    found = ground(FULL, scene)
    assert not found.violated
    seen = {name: scene[match.perceived] for name, match in found.matches.items()}
    sizes = {n: np.subtract(t.maximum[:2], t.minimum[:2]) for n, t in seen.items()}
    for name, thing in truth.items():
        assert name is not None
        assert sizes[name] == pytest.approx(np.subtract(thing.maximum[:2], thing.minimum[:2]), abs=0.02), name


def test_labels_are_those_of_the_clouds_beside_the_scene(tables: Path) -> None:
    labels, scene = np.load(tables / "7.npy"), read_scene(tables / "7.scene.json")
    assert labels.dtype == np.int32
    assert len(labels) == 640 * 480
    assert set(labels.tolist()) == {-1, *range(len(scene.objects))}
    for number, thing in enumerate(scene.objects):
        cloud = read_cloud(tables / str(thing.cloud))
        assert len(cloud) == (labels == number).sum()
        inside = (cloud.points[:, :2] > np.array(thing.minimum[:2]) - 1e-3).all(axis=1)
        assert inside.mean() > 0.95


def test_what_was_learned_is_recognised_on_another_table(tables: Path, tmp_path: Path) -> None:
    named, picture = tmp_path / "named.scene.json", tmp_path / "named.png"
    code, out, _ = deixis(
        "recognise", tables / "20.scene.json", "--memory", tables / "memory", "--json", "-o", named, "--plot", picture
    )
    assert code == 0
    answers = {entry["id"]: entry for entry in json.loads(out)["objects"]}
    scene = read_scene(tables / "20.scene.json")
    truth = {match.perceived: name for name, match in ground(FULL, scene).matches.items()}
    assert answers.keys() == truth.keys()
    first = {id: entry["candidates"][0]["category"] for id, entry in answers.items()}
    assert sum(first[id] == name for id, name in truth.items()) >= 7  # of twelve, from one view each
    for entry in answers.values():
        assert entry["candidates"][0].keys() == (
            {"category", "D_C", "ICD", "divisor", "divisor_from", "ND", "nearest", "views", "probability"}
        )
        likeliest = entry["candidates"][0]["probability"]
        assert (entry["label"] is None) == (likeliest < entry["min_probability"])
        assert abs(sum(one["probability"] for one in entry["candidates"]) + entry["unknown"] - 1) < 1e-5
    written = read_scene(named)
    assert {thing.id: thing.label for thing in written.objects} == {id: e["label"] for id, e in answers.items()}
    assert all(thing.confidence < 1 for thing in written.objects if thing.label)
    assert all((named.parent / str(thing.cloud)).exists() for thing in written.objects)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_recognise_prints_one_line_a_thing_and_why_on_request(tables: Path) -> None:
    scene, memory = tables / "20.scene.json", tables / "memory"
    short, full = (deixis("recognise", scene, "--memory", memory, *why)[1] for why in ((), ("--why",)))
    ids = read_scene(scene).ids
    assert [line.split()[0] for line in short.splitlines()] == list(ids)
    assert max(map(len, short.splitlines())) < 100 and "ND" not in short
    assert [line for line in full.splitlines() if not line.startswith("      ")] == short.splitlines()
    assert full.count("is nearest: ND") == len(ids) and full.count(", D_C ") >= len(ids)


def test_views_and_categories_can_be_taught_changed_and_removed(tables: Path, tmp_path: Path) -> None:
    scene, memory = tables / "7.scene.json", ("--memory", tmp_path / "memory")
    assert deixis("category", "list", "--json", *memory)[0] == 2  # there is no such memory yet
    assert deixis("teach", scene, "o1", "Bread plate", *memory)[1] == "o1 is a view of 'Bread_plate'; 1 view in all.\n"
    out = deixis("teach", scene, "o1", "saucer", *memory)[1]
    assert out == "o1 is a view of 'saucer', no longer of 'Bread_plate'; 1 view in all.\n"
    assert json.loads(deixis("category", "list", "--json", *memory)[1]) == {"saucer": 1}
    deixis("teach", scene, "o5", "plate", *memory)
    assert deixis("category", "merge", "saucer", "plate", *memory)[0] == 0
    assert deixis("category", "rename", "plate", "dish", *memory)[0] == 0
    assert json.loads(deixis("category", "list", "--json", *memory)[1]) == {"dish": 2}
    entry = json.loads(deixis("recognise", scene, "--json", *memory)[1])["objects"][0]
    assert (entry["id"], entry["candidates"][0]["category"], entry["candidates"][0]["views"]) == ("o1", "dish", 2)
    assert entry["candidates"][0]["D_C"] == 0
    assert deixis("memory", "verify", *memory)[0] == 0
    views = tmp_path / "views.zip"
    assert deixis("memory", "export", "--format", "views", "-o", views, *memory)[0] == 0
    assert deixis("category", "forget", "dish", *memory)[0] == 0
    assert deixis("recognise", scene, *memory)[0] == 1
    assert deixis("memory", "import", views, *memory)[0] == 0
    assert json.loads(deixis("category", "list", "--json", *memory)[1]) == {"dish": 2}


def test_what_a_teacher_named_is_not_overruled_by_a_grounding(tables: Path, tmp_path: Path) -> None:
    scene, memory = read_scene(tables / "7.scene.json"), tmp_path / "memory"
    with Session(memory) as session:
        first = session.learn(FULL, scene)
        plate, napkin = (first.grounding.matches[name].perceived for name in ("dinner_plate", "napkin"))
        assert session.teach(scene, plate, "grandmas_platter", teacher="Ada").before == "dinner_plate"
        session.teach(scene, napkin, "napkin", teacher="Ada")
        again = session.learn(FULL, scene)
        assert {"grandmas_platter", "napkin"} < set(session.categories())
        assert "dinner_plate" not in session.categories()
        kept = {view.category: view.metadata["teacher"] for view in session.views().views()}
    assert [str(word) for word in again.kept_names] == [
        f"{plate} stays a view of 'grandmas_platter', as Ada taught; the grounding matched it with 'dinner_plate'"
    ]
    assert len(again.seen) == len(first.seen) - 2
    assert (kept["napkin"], kept["soup_spoon"]) == ("Ada", "grounding")
    code, out = deixis("learn", FULL, tables / "7.scene.json", "--memory", memory)[:2]
    assert code == 0
    assert f"{again.kept_names[0]}." in out


def test_the_stored_model_of_a_category_matches_its_views(tables: Path, tmp_path: Path) -> None:
    from deixis.learning.views.views import DISTANCES, UPRIGHT, instances_of
    from deixis.perception.recognition.instances import InstanceCategory

    with Session(tmp_path / "memory") as session:
        for object in ("o1", "o5", "o8"):
            session.teach(tables / "7.scene.json", object, "flat thing")
        record, taught = session.views().category("flat_thing"), list(session.views().views("flat_thing"))
        kept = instances_of(record, taught, (UPRIGHT,))[0]
        views = [(view.id, view.descriptors[UPRIGHT.name]) for view in taught]
        assert DISTANCES in record.state
    fresh = InstanceCategory.of("flat_thing", views)
    assert kept.views.ids == fresh.views.ids
    np.testing.assert_allclose(kept.distances, fresh.distances, atol=1e-6)


def test_a_word_is_asked_for_until_something_is_pointed_at(
    tables: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, memory = tables / "7.scene.json", ("--memory", tmp_path / "memory")
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    code, out, _ = deixis("ask", "saucer", scene, *memory)
    assert (code, "I still do not know what 'saucer' is." in out) == (1, True)
    monkeypatch.setattr("sys.stdin", io.StringIO("o99\no1\n"))
    code, out, _ = deixis("ask", "saucer", scene, *memory)
    assert code == 0
    assert "There is no object 'o99' in this scene." in out
    assert "o1 is a view of 'saucer'; 1 view in all." in out
    assert "Here it is: o1" in deixis("ask", "saucer", scene, *memory)[1]
    assert "a view of 'fork'" in deixis("ask", "fork", scene, "--points-at", "o3", *memory)[1]
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    code, out, err = deixis("ask", "cup", scene, "--json", *memory)
    assert (code, json.loads(out)) == (1, {"word": "cup", "category": "cup", "objects": {}, "taught": None})
    assert "I still do not know what 'cup' is." in err


def test_bad_input_has_one_line(tables: Path, tmp_path: Path) -> None:
    scene, memory = tables / "7.scene.json", ("--memory", tmp_path / "memory")
    nothing = tmp_path / "nothing.pcd"
    write_cloud(nothing, PointCloud(np.full((4, 3), np.nan, np.float32)))
    truth = tables / "7.truth.scene.json"
    for arguments in (
        ("perceive", nothing),
        ("perceive", tmp_path / "none.pcd"),
        ("perceive", tables / "7.pcd", "--labels", tmp_path / "labels.txt"),
        ("teach", scene, "o99", "plate", *memory),
        ("teach", scene, "o1", "  ", *memory),
        ("teach", truth, "o1", "plate", *memory),
        ("category", "forget", "plate", *memory),
        ("memory", "export", "--format", "views", "-o", tmp_path / "v.zip", *memory),
    ):
        code, out, err = deixis(*arguments)
        assert (code, out) == (2, ""), arguments
        assert len(err.splitlines()) == 1, arguments


def test_no_answer_comes_where_standard_input_is_closed(
    tables: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", None)
    code, out, err = deixis("ask", "fork", tables / "7.scene.json", "--memory", tmp_path / "memory")
    assert (code, err) == (1, "")
    assert "I still do not know what 'fork' is." in out


def test_the_memory_is_free_while_someone_is_asked(
    tables: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seal = tmp_path / "memory" / "perceptual" / "seal.json"  # exists only while no process has the memory open
    with Session(tmp_path / "memory") as session:
        session.teach(tables / "7.scene.json", "o1", "plate")
    sealed: list[bool] = []

    def answer(size: int) -> str:
        sealed.append(seal.exists())
        return "o3\n"

    monkeypatch.setattr("sys.stdin", SimpleNamespace(readline=answer))
    assert deixis("ask", "fork", tables / "7.scene.json", "--memory", tmp_path / "memory")[0] == 0
    assert sealed == [True]


def test_what_is_read_is_never_written_over(tables: Path, tmp_path: Path) -> None:
    cloud = tmp_path / "table.pcd"
    cloud.write_bytes((tables / "7.pcd").read_bytes())
    before = cloud.read_bytes()
    thing = tables / str(read_scene(tables / "7.scene.json")["o1"].cloud)
    mesh = tmp_path / "cup.ply"
    mesh.write_text("ply\n")
    for arguments, file in (
        (("perceive", cloud, "-o", cloud), cloud),
        (("perceive", cloud, "-o", tmp_path / "a.json", "--plot", tmp_path), tmp_path),
        (("perceive", cloud, "-o", tmp_path / "a.npy", "--labels", tmp_path / "a.npy"), tmp_path / "a.npy"),
        (("perceive", cloud, "-o", cloud / "a.json"), cloud / "a.json"),
        (("recognise", tables / "7.scene.json", "-o", thing), thing),
        (("simulate", FULL, "--mesh", f"water_glass={mesh}", "-o", mesh), mesh),
    ):
        code, out, err = deixis(*arguments)
        assert (code, out) == (2, ""), arguments
        assert str(file) in err
        assert len(err.splitlines()) == 1
    assert cloud.read_bytes() == before


def test_a_cloud_without_a_point_is_named(tmp_path: Path) -> None:
    write_cloud(tmp_path / "nothing.pcd", PointCloud(np.full((4, 3), np.nan, np.float32)))
    assert str(tmp_path / "nothing.pcd") in deixis("perceive", tmp_path / "nothing.pcd")[2]


def test_an_impossible_camera_is_refused_before_a_table_is_laid(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deixis.workflows.layouts.lay_table.lay_script", None)
    for option, value, word in (("--camera-height", "0", "above"), ("--camera-back", "50", "edge"),
                                ("--azimuth", "nan", "azimuth")):  # fmt: skip
        code, _, err = deixis("simulate", FULL, option, value)
        assert code == 2
        assert word in err


def test_a_calibration_is_kept_while_a_tenth_of_the_views_stays(
    tables: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from deixis.learning.views.views import recogniser_of
    from deixis.perception.recognition.held_out import HeldOut
    from deixis.perception.recognition.joint import JointRecogniser

    scene, file = tables / "7.scene.json", tmp_path / "memory" / "perceptual" / "calibration.json"
    calls: list[dict[str, str]] = []  # the thing that each view shows
    work = JointRecogniser.held_out

    def held_out(self: JointRecogniser, progress: None) -> list[HeldOut]:
        calls.append({key: thing for known in self.categories for key, thing in known.things.items()})
        return work(self, progress)

    monkeypatch.setattr(JointRecogniser, "held_out", held_out)
    with Session(tmp_path / "memory") as session:
        for object, word in (("o1", "plate"), ("o5", "plate"), ("o3", "fork"), ("o4", "fork")):
            session.teach(scene, object, word)
        first = recogniser_of(session.views(), "table").recogniser.calibration
        assert recogniser_of(session.views(), "table").recogniser.calibration == first
        assert len(calls) == 1
        assert len(set(calls[0].values())) == 4
        file.write_text(file.read_text().replace(str(first.threshold), str(first.threshold + 1)))
        assert (
            recogniser_of(session.views(), "table").recogniser.calibration == first
        )  # a changed number is not believed
        session.teach(scene, "o7", "spoon")
        recogniser_of(session.views(), "table")
        assert len(calls) == 3
    assert deixis("memory", "verify", "--memory", tmp_path / "memory")[0] == 0


def test_a_table_with_nothing_on_it_is_an_answer(tmp_path: Path) -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.01, 0.5:1.5:0.01])
    points = np.stack([x, y, np.full(x.shape, -0.7)], axis=1).astype(np.float32)
    write_cloud(tmp_path / "bare.pcd", PointCloud(points))
    code, out, err = deixis("perceive", tmp_path / "bare.pcd")
    assert code == 1
    assert json.loads(out)["objects"] == []
    assert json.loads(out)["shows"] == "table"
    assert "nothing is on the table" in err
    (tmp_path / "bare.scene.json").write_text(out)
    assert read_scene(tmp_path / "bare.scene.json").objects == ()


@pytest.fixture(scope="module")
def seen(tables: Path) -> tuple[Scene, Scene]:
    """The two tables again, not yet written."""
    return perceive(tables / "7.pcd"), perceive(tables / "20.pcd")


def test_the_table_and_the_upward_direction_can_be_stated(
    tables: Path, seen: tuple[Scene, Scene], tmp_path: Path
) -> None:
    scene, before = tables / "7.scene.json", (tables / "7.scene.json").read_bytes()
    code, out, _ = deixis("perceive", tables / "7.pcd", "--table", "2", "-o", scene)
    assert code == 1 and out.startswith("Nothing was found.\nNote: there is no table 2")
    assert "Written" not in out and scene.read_bytes() == before
    found = seen[0].detection
    assert found is not None
    turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]], np.float32)  # a quarter turn of the camera
    np.savez(tmp_path / "aside.npz", points=found.cloud.points.reshape(480, 640, 3)[::-1].swapaxes(0, 1) @ turn)
    up = [f"{number:.3f}" for number in found.frame[2, :3] @ turn]
    code, out, _ = deixis("perceive", tmp_path / "aside.npz", "--up", *up)
    assert code == 0 and len(json.loads(out)["objects"]) == len(seen[0].objects) == 12


@pytest.mark.parametrize("step", range(6))
def test_a_scene_is_written_over_in_one_step(seen: tuple[Scene, Scene], tmp_path: Path, step: int) -> None:
    """Ended by force after any step, the old scene is whole with its clouds, or the new one is."""
    (first, other), file = seen, tmp_path / "table.scene.json"
    write_scene(first, file)
    old = [(thing, read_cloud(tmp_path / str(thing.cloud)).points.tobytes()) for thing in read_scene(file).objects]
    left = [3 * step]

    def stopping(old: Path, new: Path) -> None:
        if left[0] == 0:
            raise KeyboardInterrupt
        left[0] -= 1
        rename(old, new)

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("deixis.workflows.scenes.perceive.rename", stopping)
        patched.setattr(
            "deixis.workflows.scenes.perceive._remove_others", lambda *_: None
        )  # as nothing is cleaned up when killed
        with contextlib.suppress(KeyboardInterrupt):
            write_scene(other, file)
    found = read_scene(file).objects
    now = [(thing, read_cloud(tmp_path / str(thing.cloud)).points.tobytes()) for thing in found]
    assert (now == old) == (step < 5)
    write_scene(other, file)
    named = {str(thing.cloud) for thing in read_scene(file).objects}
    assert {f"table.clouds/{cloud.name}" for cloud in (tmp_path / "table.clouds").iterdir()} == named


def test_damaged_views_are_reported_and_repaired_by_teaching(tables: Path, tmp_path: Path) -> None:
    scene, memory = tables / "7.scene.json", ("--memory", tmp_path / "memory")
    for object, word in (("o1", "plate"), ("o3", "fork"), ("o4", "fork")):
        deixis("teach", scene, object, word, *memory)
    store = tmp_path / "memory" / "perceptual" / "store-2"
    with plyvel.DB(str(store)) as db:
        key, value = next(db.iterator(prefix=b"aplate"))
        db.put(key, value[:-1] + bytes([value[-1] ^ 1]))
    (store.parent / "seal.json").unlink()
    code, out, err = deixis("recognise", scene, *memory)
    assert code == 0
    assert "fork" in out
    assert "plate" not in out
    (line,) = err.splitlines()
    assert "left out" in line and "of 'plate'" in line and "deixis memory verify" in line
    assert deixis("memory", "verify", *memory)[0] == 1
    code, _, err = deixis("memory", "export", "--format", "views", "-o", tmp_path / "views.zip", *memory)
    assert code == 2 and "nothing was exported" in err and "again to repair it" in err
    assert not (tmp_path / "views.zip").exists()
    assert deixis("teach", scene, "o2", "plate", *memory)[0] == 0
    assert deixis("teach", scene, "o1", "plate", *memory)[0] == 0
    assert deixis("memory", "verify", *memory)[0] == 0
    assert json.loads(deixis("category", "list", "--json", *memory)[1]) == {"fork": 2, "plate": 2}


def test_an_unreadable_memory_is_not_reported_as_empty(tables: Path, tmp_path: Path) -> None:
    memory = ("--memory", tmp_path / "memory")
    deixis("teach", tables / "7.scene.json", "o1", "plate", *memory)
    store = tmp_path / "memory" / "perceptual" / "store-2"
    with plyvel.DB(str(store)) as db:
        key, value = next(db.iterator(prefix=b"vplate"))
        db.put(key, value[:-1] + bytes([value[-1] ^ 1]))
    (store.parent / "seal.json").unlink()
    code, out, err = deixis("category", "list", *memory)
    assert (code, out) == (2, "")
    assert "left out" in err


def test_a_memory_that_is_not_there_is_not_called_whole(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    for place in ("nowhere", "empty"):
        code, out, err = deixis("memory", "verify", "--memory", tmp_path / place)
        assert (code, out) == (2, "")
        assert "there is no memory" in err
    assert not (tmp_path / "nowhere").exists()


def test_every_command_reports_a_folder_without_a_memory(tables: Path, tmp_path: Path) -> None:
    scene, file, folder = tables / "7.scene.json", tmp_path / "file", tmp_path / "folder"
    file.write_text("dear\n")
    folder.mkdir()
    (folder / "letter").write_text("dear\n")
    for arguments in (
        ("teach", scene, "o1", "plate"),
        ("recognise", scene),
        ("ask", "plate", scene),
        ("category", "list"),
        ("category", "forget", "plate"),
        ("memory", "verify"),
        ("memory", "stats"),
        ("memory", "export", "--format", "views", "-o", tmp_path / "v.zip"),
        ("learn", FULL, scene),
        ("check", FULL, scene),
        ("ground", FULL, scene),
    ):
        for place, message in ((file, "a memory is a folder"), (folder, "is not a memory")):
            code, out, err = deixis(*arguments, "--memory", place)
            assert (code, out) == (2, ""), arguments
            assert message in err, arguments
    assert [entry.name for entry in folder.iterdir()] == ["letter"]


def test_no_views_are_kept_where_the_lesson_is_refused(
    tables: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from deixis.errors import DeixisError
    from deixis.memory.semantic.store import SemanticMemory

    scene = read_scene(tables / "7.scene.json")

    def refused(*_: object) -> None:
        raise DeixisError("the lesson is refused")

    with Session(tmp_path / "memory") as session:
        session.teach(scene, "o1", "thing")
        with monkeypatch.context() as patched:
            patched.setattr(SemanticMemory, "commit", refused)
            with pytest.raises(DeixisError, match="the lesson is refused"):
                session.learn(FULL, scene)
        assert session.categories() == {"thing": 1}
        assert session.views().verify() == ()
        assert session.memory().lessons() == ()
        assert len(session.learn(FULL, scene).seen) > 3


def test_a_lesson_lists_new_views_and_views_already_stored(tables: Path, tmp_path: Path) -> None:
    arguments = ("learn", FULL, tables / "7.scene.json", "--memory", tmp_path / "memory")
    first, again = (deixis(*arguments)[1].splitlines() for _ in range(2))
    (new,) = (line.removeprefix("Categories with a new view: ") for line in first if "new view" in line)
    assert not any("as before" in line for line in first)
    assert f"The same view as before, kept once: {new}" in again
    assert not any("new view" in line for line in again)


def test_a_word_that_differs_only_by_case_is_the_known_category(tables: Path, tmp_path: Path) -> None:
    scene, memory = tables / "7.scene.json", ("--memory", tmp_path / "memory")
    assert "taken for" not in deixis("teach", scene, "o1", "Wine Glass", *memory)[1]
    for arguments in (("teach", scene, "o2", "wine glass"), ("ask", "WINE_GLASS", scene, "--points-at", "o3")):
        out = deixis(*arguments, *memory)[1]
        assert "is read as 'Wine_Glass', which differs only by case." in out
        assert "is a view of 'Wine_Glass'" in out
    assert json.loads(deixis("category", "list", "--json", *memory)[1]) == {"Wine_Glass": 3}


@pytest.mark.parametrize("viewpoint", ["", " ", "\udcff", "a\nb"])
def test_a_viewpoint_that_no_scene_can_have_is_refused(tables: Path, viewpoint: str) -> None:
    code, out, err = deixis("perceive", tables / "7.pcd", "--viewpoint", viewpoint)
    assert (code, out) == (2, "")
    assert "`viewpoint` must be a word" in err


def test_names_that_go_nowhere_are_reported(tables: Path, tmp_path: Path) -> None:
    memory = ("--memory", tmp_path / "memory")
    deixis("teach", tables / "7.scene.json", "o1", "Gäbel 🍴", *memory)
    assert json.loads(deixis("category", "list", "--json", *memory)[1]) == {"Gäbel_🍴": 1}
    for arguments, message in (
        (("rename", "Gäbel_🍴", "Gäbel 🍴"), "the category already has the name"),
        (("merge", "Gäbel_🍴", "Gäbel_🍴"), "cannot be merged into itself"),
        (("rename", "Gäbel_🍴", "x" * 1001), "too long"),
        (("rename", "\udcff", "fork"), "half a character"),
        (("rename", "Gäbel_🍴", "\x1b[31mred"), "control characters"),
    ):
        code, out, err = deixis("category", *arguments, *memory)
        assert (code, out) == (2, ""), arguments
        assert message in err


@pytest.mark.parametrize(
    ("word", "message"), [("\x1b[31mred", "control characters"), ("Unknown", "choose another word")]
)
def test_a_word_that_does_not_fit_a_thing_is_not_taught(tables: Path, tmp_path: Path, word: str, message: str) -> None:
    scene, memory = tables / "7.scene.json", ("--memory", tmp_path / "memory")
    for arguments in (("teach", scene, "o1", word), ("ask", word, scene)):
        code, out, err = deixis(*arguments, *memory)
        assert (code, out) == (2, ""), arguments
        assert message in err
    assert not (tmp_path / "memory").exists()


def test_objects_with_equal_points_are_refused_before_learning(tables: Path, tmp_path: Path) -> None:
    scene, twice = json.loads((tables / "7.scene.json").read_text()), tables / "twice.scene.json"
    scene["objects"][3]["cloud"] = scene["objects"][2]["cloud"]
    twice.write_text(json.dumps(scene))
    code, out, err = deixis("learn", FULL, twice, "--memory", tmp_path / "memory")
    assert (code, out) == (2, "")
    assert "twice.scene.json: the clouds of" in err and "are the same points" in err
    assert not (tmp_path / "memory").exists()


def test_a_scene_file_perceived_again_contains_different_objects(tables: Path, tmp_path: Path) -> None:
    scene, memory = tmp_path / "table.scene.json", ("--memory", tmp_path / "memory")
    for seed in (7, 20):
        clouds = tmp_path / "table.clouds"
        shutil.rmtree(clouds, ignore_errors=True)
        shutil.copytree(tables / f"{seed}.clouds", clouds)
        text = (tables / f"{seed}.scene.json").read_text(encoding="utf-8")
        scene.write_text(text.replace(f"{seed}.clouds", "table.clouds"), encoding="utf-8")
        assert deixis("teach", scene, "o1", "plate", *memory)[0] == 0
    entry = json.loads(deixis("recognise", scene, "--json", *memory)[1])["objects"][0]
    assert "has one thing" not in json.dumps(entry)
