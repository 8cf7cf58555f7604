"""Simulated tables: what a layout says is true of them, and what the command writes and says."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
from solid_checks import deepest
from typer.testing import CliRunner, Result

from deixis.cli.scenes.simulate import simulate as simulate_command
from deixis.errors import DeixisError
from deixis.grammar.layout.parser import parse_script, read_layout
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.simulator.laying import truth_scene
from deixis.perception.simulator.meshes.solids import fitted
from deixis.perception.simulator.meshes.tableware import make
from deixis.session import Session
from deixis.workflows.layouts.lay_table import LaidScript, NoTableError, TimeIsUpError, lay_random, lay_script
from deixis.workflows.scenes.simulate import CameraSetup, simulate

EXAMPLES = Path(__file__).parents[4] / "examples"
FORMAL = read_layout(str(EXAMPLES / "formal_dinner.layout"))
CUPS = (
    "teacup on saucer; teaspoon on saucer; mug right of saucer; plate left of saucer; napkin on plate; fork on napkin"
)


def box_mesh(width: float, length: float, height: float) -> Mesh:
    return fitted(make(None, 1, plan=(0.1, 0.1)).mesh, width, length, height)


def require_true(script_text: str | None, laid: LaidScript, file: str | None = None) -> None:
    script = parse_script(script_text) if script_text is not None else read_layout(str(EXAMPLES / f"{file}.layout"))
    checked = Session(memory="not-needed").check(script, truth_scene(laid.table))
    assert checked.table.well, [str(entry.fact) for entry in checked.table.broken]


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("name", ["formal_dinner", "script1", "script2"])
def test_what_a_layout_says_is_true_of_the_table_that_is_laid(name: str, seed: int) -> None:
    laid = lay_script(read_layout(str(EXAMPLES / f"{name}.layout")), seed)
    assert laid.missed == ()
    require_true(None, laid, name)


def test_cups_with_handles_fit_and_stacked_objects_lie_on_top() -> None:
    laid = lay_script(parse_script(CUPS), seed=1)
    require_true(CUPS, laid)
    bottoms = {thing.name: thing.box[0, 2] for thing in laid.table.things}
    assert bottoms["fork"] > bottoms["napkin"] > bottoms["plate"] == 0
    assert bottoms["teacup"] > 0 and bottoms["mug"] == 0
    for a, b in combinations(laid.table.things, 2):
        assert deepest(a.mesh, b.mesh) < 1e-5, f"{a.name} and {b.name}"


@pytest.mark.parametrize("seed", [0, 1])
def test_things_of_a_formal_setting_are_seen_and_do_not_overlap(seed: int) -> None:
    found = simulate(lay_script(FORMAL, seed), seed=seed)
    assert found.camera.eye[2] == pytest.approx(0.7)
    assert len(found.points) == 12
    assert (found.points >= 200).all()
    for a, b in combinations(found.laid.table.things, 2):
        assert deepest(a.mesh, b.mesh) < 1e-5, f"{a.name} and {b.name}"


def test_objects_are_turned_slightly_and_fill_their_boxes() -> None:
    cloud_boxes = {thing.name: np.ptp(thing.box, axis=0) for thing in lay_script(FORMAL, 2).table.things}
    knife = cloud_boxes["dinner_knife"]
    assert 0.2 < knife[1] < 0.27
    assert knife[0] > 0.015


def test_simulations_repeat_for_a_seed_and_differ_between_seeds() -> None:
    one, other = (simulate(lay_script(FORMAL, seed), seed=seed) for seed in (3, 4))
    again = simulate(EXAMPLES / "formal_dinner.layout", seed=3)
    assert np.array_equal(one.cloud.points, again.cloud.points, equal_nan=True)
    assert one.truth == again.truth
    assert one.truth != other.truth


def test_points_are_counted_for_each_thing() -> None:
    found = simulate(lay_script(FORMAL, 0))
    assert found.cloud.labels is not None
    counts = [np.count_nonzero(found.cloud.labels == k) for k in range(1, 13)]
    assert found.points.tolist() == counts


def test_a_table_that_a_script_speaks_of_is_the_tables_top() -> None:
    laid = lay_script(parse_script("plate on table; fork on table; fork left of plate"), seed=1)
    assert [thing.name for thing in laid.table.things] == ["plate", "fork"]
    assert laid.top_name == "table"
    assert lay_script(parse_script("fork left of plate"), seed=1).top_name is None
    low, high = np.array(laid.table.top.low), np.array(laid.table.top.high)
    for thing in laid.table.things:
        assert (low <= thing.box[0, :2]).all() and (thing.box[1, :2] <= high).all()
    with pytest.raises(SimulationError, match="one table"):
        lay_script(parse_script("dining_table left of side_table; dining_table is a table; side_table is a table"), 0)


def test_everything_in_the_script_lies_on_the_table_by_default() -> None:
    script = "laptop left of toaster; banana right of toaster; mug on coffee_table; teapot right of banana"
    laid = lay_script(parse_script(script), seed=5)
    low, high = np.array(laid.table.top.low), np.array(laid.table.top.high)
    for thing in laid.table.things:
        assert (low <= thing.box[0, :2]).all() and (thing.box[1, :2] <= high).all()
    assert laid.beside == ()


@pytest.mark.parametrize(
    ("script", "beside"),
    [
        ("plate on table; fork left of plate; chair left of table", {"chair"}),
        ("plate left of table; fork on plate; fork left of knife", {"plate", "fork"}),
        ("fork left of plate; dog below table", {"dog"}),
    ],
)
def test_only_what_a_script_has_beside_its_table_is_not_on_it(script: str, beside: set[str]) -> None:
    assert set(lay_script(parse_script(script), seed=3).beside) == beside


@pytest.mark.parametrize("seed", [-1, 1.5, None])
def test_an_invalid_seed_is_refused(seed: Any) -> None:
    with pytest.raises(DeixisError, match="`seed` must be a whole number"):
        simulate("formal_dinner.layout", seed=seed)


def test_a_mesh_stands_for_an_object_in_its_own_size() -> None:
    laid = lay_script(
        parse_script("toaster right of plate; fork left of plate"), 1, {"toaster": box_mesh(0.3, 0.17, 0.2)}
    )
    toaster = next(thing for thing in laid.table.things if thing.name == "toaster")
    assert toaster.shape == "mesh from a file"
    width, length, height = np.ptp(toaster.mesh.vertices, axis=0)
    assert height == pytest.approx(0.2)
    assert sorted((width, length)) == pytest.approx([0.17, 0.3], abs=0.03)  # turned a little
    require_true("toaster right of plate; fork left of plate", laid)


def test_random_tables_take_meshes_too() -> None:
    laid = lay_random(3, 1, {"toaster": box_mesh(0.3, 0.17, 0.2)})
    assert len(laid.table.things) == 4
    assert "toaster" in {thing.name for thing in laid.table.things}


def test_a_cloth_makes_the_table_white() -> None:
    assert min(lay_random(1, 1, cloth=True).table.top.colour) > 200


def test_what_cannot_be_laid_is_refused_with_the_reason() -> None:
    with pytest.raises(NoTableError, match="usual sizes"):
        lay_script(parse_script("dinner_plate on teaspoon"), 0)
    with pytest.raises(TimeIsUpError, match="more time"):
        lay_script(FORMAL, 0, time_limit=0.0)
    with pytest.raises(SimulationError, match="a mesh for 'toaster', which is not an object"):
        lay_script(FORMAL, 0, {"toaster": box_mesh(0.1, 0.1, 0.1)})
    with pytest.raises(SimulationError, match="state the unit"):
        lay_random(1, 0, {"toaster": box_mesh(300, 170, 200)})
    with pytest.raises(SimulationError, match="above the table"):
        simulate(lay_random(1, 0), CameraSetup(height=-1.0))


# ---- the command ------------------------------------------------------------------------------------------------


def run(*args: object) -> Result:
    app = typer.Typer()
    app.callback()(lambda: None)
    app.command()(simulate_command)
    return CliRunner().invoke(app, ["simulate", *map(str, args)])


def test_the_command_writes_a_cloud_and_its_matching_truth(tmp_path: Path) -> None:
    cloud_file, truth_file = tmp_path / "out" / "scene.pcd", tmp_path / "truth.scene.json"
    layout = EXAMPLES / "formal_dinner.layout"
    result = run(layout, "-o", cloud_file, "--truth", truth_file, "--seed", 7, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.output)
    cloud, truth = read_cloud(cloud_file), read_scene(truth_file)
    assert cloud.organised == (480, 640)
    assert cloud.labels is not None and cloud.colours is not None
    assert cloud.origin == (0.0, 0.0, 0.0)
    pose = np.array(told["camera"]["pose"])
    points = cloud.points @ pose[:3, :3].T + pose[:3, 3]
    for thing, entry in zip(truth.objects, told["things"], strict=True):
        mine = points[cloud.labels == entry["label"]]
        assert (thing.id, thing.label, len(mine)) == (entry["id"], entry["name"], entry["points"])
        assert (mine > np.array(thing.minimum) - 0.01).all() and (mine < np.array(thing.maximum) + 0.01).all()
    assert np.abs(points[cloud.labels == 0, 2]).max() < 0.04


def test_the_command_lists_what_it_laid_and_says_what_is_generic(tmp_path: Path) -> None:
    layout = tmp_path / "t.layout"
    layout.write_text("vase above plate\n")
    result = run(layout, "-o", tmp_path / "s.ply", "--table-frame", "--cloth", "--noise", 0)
    assert result.exit_code == 0, result.output
    assert "cylinder, as there is no shape for its kind" in result.output
    assert f"Written: {tmp_path / 's.ply'}" in result.output.replace("\n", "\n")
    assert "the table itself" not in result.output
    layout.write_text("plate on coffee_table\n")
    assert "coffee_table is the table itself, not one of the things on it." in run(layout).output
    assert json.loads(run(layout, "--json").output)["table"]["name"] == "coffee_table"
    assert np.nanmin(np.abs(read_cloud(tmp_path / "s.ply").points[:, 2])) < 1e-4


def test_the_command_takes_meshes_in_any_unit(tmp_path: Path) -> None:
    stl = tmp_path / "brick.obj"
    mesh = box_mesh(120, 80, 60)
    rows = [f"v {x:g} {y:g} {z:g}" for x, y, z in mesh.vertices] + [f"f {a} {b} {c}" for a, b, c in mesh.faces + 1]
    stl.write_text("\n".join(rows) + "\n")
    result = run("--random", 2, "--mesh", f"brick={stl}", "--mesh-unit", "mm", "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.output)
    brick = next(entry for entry in told["scene"]["objects"] if entry["label"] == "brick")
    assert brick["max"][2] - brick["min"][2] == pytest.approx(0.06, abs=1e-5)


def test_a_layout_without_a_table_is_an_answer_of_no(tmp_path: Path) -> None:
    layout = tmp_path / "t.layout"
    layout.write_text("dinner_plate on teaspoon\n")
    result = run(layout, "--json")
    assert result.exit_code == 1
    assert json.loads(result.output)["simulated"] is False


@pytest.mark.parametrize(
    ("args", "message"),
    [
        ((), "a layout or --random"),
        (("x.layout", "--random", 3), "a layout or --random"),
        (("--random", 0), "1 to 300 things"),
        (("--random", 301), "1 to 300 things"),
        (("--random", -1), "1 to 300 things"),
        (("--random", 1, "--noise", "nan"), "`noise` must be from 0"),
        (("--random", 1, "--missing", "2"), "`missing` must be from 0 to 1, got 2"),
        (("--random", 1, "--camera-height", "-1"), "above the table"),
        (("--random", 1, "--azimuth", "inf"), "azimuth"),
        (("--random", 1, "-o", "cloud.txt"), "must end in .pcd or .ply"),
        (("--random", 1, "-o", "."), "folder"),
        (("--random", 1, "--mesh", "toaster"), "NAME=FILE"),
        (("--random", 1, "--mesh", "toaster=missing.ply"), "missing.ply"),
        (("--random", 1, "--mesh-unit", "ell"), "got 'ell'"),
        (("--random", 1, "--intrinsics", "missing.json"), "missing.json"),
        (("missing.layout",), "missing.layout"),
    ],
)
def test_bad_input_is_an_error_of_one_line(args: tuple[object, ...], message: str) -> None:
    result = run(*args)
    assert isinstance(result.exception, DeixisError), result.exception
    assert message in str(result.exception)
    assert "\n" not in str(result.exception)
