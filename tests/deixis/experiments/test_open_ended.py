"""The experiment in open-ended learning: its data, its splits, its figures and what it prints."""

from __future__ import annotations

import csv
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import deixis

from deixis.experiments.open_ended.comparison import by_things, by_views, split_scores
from deixis.experiments.open_ended.contestants import EQUATIONS, NEAREST, contestants
from deixis.experiments.open_ended.plot import mean_curve, plot_open_ended
from deixis.experiments.open_ended.report import lines, to_dict
from deixis.experiments.open_ended.run import OpenEnded, OpenEndedPlan, run
from deixis.experiments.open_ended.shown import CacheError, Shown, cached_views, describe_views
from deixis.experiments.open_ended.things import (
    MeshListError,
    from_meshes,
    in_metres,
    meshes_folder,
    rows_of,
    simulated,
    upright,
)
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.recognition.learners.naive_bayes import Codebook
from deixis.perception.recognition.learners.view_features import ViewFeatures
from deixis.perception.recognition.settings import DEFAULT, PAPER
from deixis.perception.simulator.tableware import FORMS, make

TINY = OpenEndedPlan(orders=2, instances=5, views=2, asked=2, kinds=("Plate", "Fork", "Mug"))


def shown(things: int = 4, views: int = 3) -> Shown:
    """Two categories of things whose views nothing tells apart but their numbers."""
    categories = [name for name in ("cup", "fork") for _ in range(things * views)]
    return Shown(
        "made up",
        tuple(categories),
        np.arange(2 * things).repeat(views),
        tuple(ViewFeatures({}) for _ in categories),
    )


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> OpenEnded:
    folder = tmp_path_factory.mktemp("cache")
    return run(replace(TINY, cache=folder), entered=[EQUATIONS, NEAREST])


def box(*size: float) -> Mesh:
    return Mesh(np.array([[0, 0, 0], size]), np.array([[0, 1, 1]], np.int32))


@pytest.mark.parametrize(
    ("extent", "metres"), [(0.12, 0.12), (0.5, 0.5), (0.84, 0.084), (12.0, 0.12), (37.8, 0.378), (230.0, 0.23)]
)
def test_a_unit_is_the_metre_where_a_thing_is_then_small_enough_for_a_table(extent: float, metres: float) -> None:
    assert np.ptp(in_metres(box(0.01, extent, 0.02)).vertices, axis=0).max() == pytest.approx(metres)


def test_what_has_y_up_is_turned_and_stays_right_handed() -> None:
    turned = upright(Mesh(np.eye(3), np.array([[0, 1, 2]], np.int32)), True).vertices
    assert turned[1].tolist() == [0, 0, 1] and np.linalg.det(turned) == pytest.approx(1.0)


def test_no_thing_is_both_taught_and_asked_for_and_every_category_is_both() -> None:
    data = shown()
    split = by_things(data, seed=1)
    taught, asked = (set(data.instances[part]) for part in split)
    assert not taught & asked and len(taught) == len(asked) == 4
    assert sorted(np.concatenate(split)) == list(range(len(data.views)))


def test_every_thing_is_seen_before_where_views_are_split() -> None:
    data = shown()
    taught, asked = by_views(data, seed=1)
    assert set(data.instances[taught]) == set(data.instances[asked]) and not set(taught) & set(asked)


def test_splits_differ_with_the_seed_and_only_with_it() -> None:
    data = shown()
    assert np.array_equal(by_things(data, 3).taught, by_things(data, 3).taught)
    assert not np.array_equal(by_things(data, 3).taught, by_things(data, 4).taught)


def test_the_nearest_taught_view_names_and_a_category_left_out_is_farther() -> None:
    data = shown(things=2, views=2)
    same = np.array(data.categories)[:, None] == np.array(data.categories)[None]
    distances = np.where(same, 1.0, 3.0).astype(np.float32)
    for settings in (None, PAPER, DEFAULT):
        scores = split_scores(data, distances, by_things(data, 1), settings)
        assert (scores.accuracy, scores.auroc) == (1.0, 1.0)


def test_a_category_with_a_large_icd_swallows_others_unless_it_is_shrunk() -> None:
    data = shown(things=2, views=2)
    fork = np.array(data.categories) == "fork"
    distances = np.where(fork[:, None] ^ fork[None], 2.0, 1.0)  # cups are 1 apart, and 2 from forks,
    distances[np.ix_(fork, fork)] = 10.0  # forks 10
    distances[data.instances[:, None] == data.instances[None]] = 0.5  # and views of a thing 0.5
    found = [
        split_scores(data, distances.astype(np.float32), by_views(data, 1), s).accuracy for s in (None, PAPER, DEFAULT)
    ]
    # by ND a cup is 0.5 / 1 from cups and 2 / 10 from forks
    assert found == [1.0, 0.5, 1.0]


def test_things_of_the_simulator_differ_from_one_another() -> None:
    things = list(simulated(("Plate", "Fork"), 2, 1, seed=0))
    assert [thing.category for thing in things] == ["Plate", "Plate", "Fork", "Fork"]
    assert len({len(thing.clouds[0]) for thing in things}) == 4


def test_by_default_every_kind_that_the_simulator_has_a_shape_for_is_shown() -> None:
    assert OpenEndedPlan().kinds == tuple(FORMS)


def test_described_views_are_read_back_as_they_were_kept(tmp_path: Path) -> None:
    def build() -> Shown:
        return describe_views("some", simulated(("Plate", "Fork"), 1, 1, 0))

    one, again = (
        cached_views(tmp_path, "key", build),
        cached_views(tmp_path, "key", lambda: pytest.fail("it was there")),
    )
    assert [view.thing for view in one.views] == [view.thing for view in again.views] == ["0", "1"]
    assert one.categories == again.categories and np.array_equal(one.instances, again.instances)
    for a, b in zip(one.views, again.views, strict=True):
        assert all(np.array_equal(a[name], b[name]) for name in a.descriptors)


def test_a_damaged_file_is_made_again_and_a_folder_that_is_none_is_named(tmp_path: Path) -> None:
    def build() -> Shown:
        return describe_views("some", simulated(("Plate",), 1, 1, 0))

    cached_views(tmp_path, "key", build)
    (file,) = tmp_path.iterdir()
    file.write_bytes(file.read_bytes()[:-100])
    assert len(cached_views(tmp_path, "key", build).views) == 1
    with pytest.raises(CacheError, match=r"views-.*npz: views cannot be kept here"):
        cached_views(file, "key", build)


def test_meshes_of_a_folder_are_shown_upright_and_in_metres(tmp_path: Path) -> None:
    rows = ["category,file,source"]
    for number, (category, scale) in enumerate([("mug", 1.0), ("mug", 100.0), ("pan", 1.0), ("place_setting", 1.0)]):
        mesh = make("mug", seed=number).mesh
        corners = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in mesh.vertices * scale]
        faces = [f"f {a} {b} {c}" for a, b, c in mesh.faces + 1]
        (tmp_path / f"{number}.obj").write_text("\n".join([*corners, *faces]) + "\n")
        rows.append(f"{category},{number}.obj,somewhere")
    (tmp_path / "index.csv").write_text("\n".join(rows) + "\n")
    things = list(from_meshes(tmp_path, views=4, seed=0))
    assert [thing.category for thing in things] == ["mug", "mug"] and all(len(thing.clouds) == 2 for thing in things)
    assert all(0.02 < np.ptp(thing.clouds[0].points, axis=0).max() < 0.3 for thing in things)


def test_everything_in_the_real_list_has_the_size_of_a_thing_on_a_table() -> None:
    folder = meshes_folder()
    if folder is None:
        pytest.skip("DEIXIS_DATA does not lead to tabletop-meshes")
    rows = list(csv.DictReader((folder / "index.csv").read_text(encoding="utf-8").splitlines()))
    sizes = [[float(row[f"ext_{axis}"]) for axis in "xyz"] for row in rows if row["category"] != "place_setting"]
    largest = [float(np.ptp(in_metres(box(*size)).vertices, axis=0).max()) for size in sizes]
    assert len(largest) == len(rows_of(folder)) and 0.04 < min(largest) <= max(largest) <= 0.5


@pytest.mark.parametrize("text", [None, "a,b\n1,2\n"])
def test_a_folder_without_a_list_of_meshes_is_named(tmp_path: Path, text: str | None) -> None:
    if text is not None:
        (tmp_path / "index.csv").write_text(text)
    with pytest.raises(MeshListError, match=r"index\.csv"):
        rows_of(tmp_path)


def test_every_contestant_bears_its_name() -> None:
    book = Codebook("spin_images", np.zeros((2, 3)))
    assert all(make().name == name for name, make in contestants(book).items())


def test_a_missing_scikit_learn_is_named_before_any_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sklearn", None)
    code, out, err = deixis("experiment", "open-ended")
    assert (code, out) == (2, "")
    assert "pip install 'deixis[experiments]'" in err
    assert err.count("\n") == 1


def test_every_order_is_run_for_every_contestant_and_the_same_plan_gives_the_same_figures(found: OpenEnded) -> None:
    again = run(found.plan, entered=[EQUATIONS, NEAREST])
    (one,), (other,) = found.findings, again.findings
    assert [taught.contestant for taught in one.taught] == [EQUATIONS, EQUATIONS, NEAREST, NEAREST]
    assert one.taught == other.taught and one.nearest == other.nearest
    assert one.taught[0].course.order != one.taught[1].course.order
    assert one.taught[0].course.order == one.taught[2].course.order


def test_what_is_told_fits_the_page_and_gives_seeds_and_what_was_left_out(found: OpenEnded) -> None:
    text = lines(found)
    assert max(map(len, text)) <= 120 and "seeds 1 to 2" in text[0]
    assert any("skipped: meshes" in line for line in text)
    data = json.loads(json.dumps(to_dict(found), allow_nan=False))
    assert data["seeds"] == [1, 2] and len(data["sets"][0]["courses"]) == 4
    assert 0.0 <= data["sets"][0]["courses"][0]["GCA"] <= 1.0


def test_the_picture_is_drawn(found: OpenEnded, tmp_path: Path) -> None:
    plot_open_ended(found, tmp_path / "open.svg")
    assert EQUATIONS in (tmp_path / "open.svg").read_text()


def test_a_mean_curve_goes_as_far_as_the_longest_each_staying_where_it_ended() -> None:
    curves = [np.array([1.0]), np.array([3.0, 5.0]), np.array([2.0, 4.0, 6.0]), np.empty(0)]
    assert mean_curve(curves).tolist() == [2.0, 10 / 3, 4.0]
    assert mean_curve([]).tolist() == mean_curve([np.empty(0)]).tolist() == []
