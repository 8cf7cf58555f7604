"""Test the open-ended learning experiment: its data, its splits, its figures and its text."""

from __future__ import annotations

import csv
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import assert_is_answer
from commands import deixis
from schemas import errors_in
from stored_pictures import assert_as_stored

from deixis.experiments.open_ended.comparison import by_things, by_views, split_scores
from deixis.experiments.open_ended.contestants import EQUATIONS, NEAREST, contestants
from deixis.experiments.open_ended.described_views import CacheError, DescribedViews, cached_views, describe_views
from deixis.experiments.open_ended.plot import mean_curve, plot_open_ended
from deixis.experiments.open_ended.report import lines, to_dict
from deixis.experiments.open_ended.run import CourseResult, Findings, OpenEnded, OpenEndedPlan, run
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
from deixis.perception.recognition.learners.teaching import Course, End, TaughtAnswer
from deixis.perception.recognition.learners.view_features import ViewFeatures
from deixis.perception.recognition.settings import DEFAULT, PAPER
from deixis.perception.simulator.meshes.tableware import FORMS, make
from deixis.report.renderers import to_rows

TINY = OpenEndedPlan(orders=2, instances=5, views=2, asked=2, kinds=("Plate", "Fork", "Mug"))


def shown(things: int = 4, views: int = 3) -> DescribedViews:
    """Return two categories of things whose views differ only in their numbers."""
    categories = [name for name in ("cup", "fork") for _ in range(things * views)]
    return DescribedViews(
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
def test_the_largest_unit_that_fits_a_table_is_chosen(extent: float, metres: float) -> None:
    assert np.ptp(in_metres(box(0.01, extent, 0.02)).vertices, axis=0).max() == pytest.approx(metres)


def test_y_up_meshes_are_turned_and_stay_right_handed() -> None:
    turned = upright(Mesh(np.eye(3), np.array([[0, 1, 2]], np.int32)), True).vertices
    assert turned[1].tolist() == [0, 0, 1] and np.linalg.det(turned) == pytest.approx(1.0)


def test_a_split_by_things_teaches_and_asks_every_category() -> None:
    data = shown()
    split = by_things(data, seed=1)
    taught, asked = (set(data.instances[part]) for part in split)
    assert not taught & asked and len(taught) == len(asked) == 4
    assert sorted(np.concatenate(split)) == list(range(len(data.views)))


def test_a_split_by_views_teaches_every_thing() -> None:
    data = shown()
    taught, asked = by_views(data, seed=1)
    assert set(data.instances[taught]) == set(data.instances[asked]) and not set(taught) & set(asked)


def test_only_the_seed_changes_a_split() -> None:
    data = shown()
    assert np.array_equal(by_things(data, 3).taught, by_things(data, 3).taught)
    assert not np.array_equal(by_things(data, 3).taught, by_things(data, 4).taught)


def test_the_nearest_view_names_and_an_excluded_category_is_far() -> None:
    data = shown(things=2, views=2)
    same = np.array(data.categories)[:, None] == np.array(data.categories)[None]
    distances = np.where(same, 1.0, 3.0).astype(np.float32)
    for settings in (None, PAPER, DEFAULT):
        scores = split_scores(data, distances, by_things(data, 1), settings)
        assert (scores.accuracy, scores.auroc) == (1.0, 1.0)


def test_shrinkage_keeps_a_wide_category_from_winning() -> None:
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


def test_simulated_things_differ_from_one_another() -> None:
    things = list(simulated(("Plate", "Fork"), 2, 1, seed=0))
    assert [thing.category for thing in things] == ["Plate", "Plate", "Fork", "Fork"]
    assert len({len(thing.clouds[0]) for thing in things}) == 4


def test_the_default_shows_the_kinds_of_the_published_figures() -> None:
    assert len(OpenEndedPlan().kinds) == 18 and set(OpenEndedPlan().kinds) < set(FORMS)


def test_described_views_are_read_back_as_they_were_kept(tmp_path: Path) -> None:
    def build() -> DescribedViews:
        return describe_views("some", simulated(("Plate", "Fork"), 1, 1, 0))

    one, again = (
        cached_views(tmp_path, "key", build),
        cached_views(tmp_path, "key", lambda: pytest.fail("it was there")),
    )
    assert [view.thing for view in one.views] == [view.thing for view in again.views] == ["0", "1"]
    assert one.categories == again.categories and np.array_equal(one.instances, again.instances)
    for a, b in zip(one.views, again.views, strict=True):
        assert all(np.array_equal(a[name], b[name]) for name in a.descriptors)


def test_a_damaged_file_is_made_again_and_a_bad_folder_reported(tmp_path: Path) -> None:
    def build() -> DescribedViews:
        return describe_views("some", simulated(("Plate",), 1, 1, 0))

    cached_views(tmp_path, "key", build)
    (file,) = tmp_path.iterdir()
    file.write_bytes(file.read_bytes()[:-100])
    assert len(cached_views(tmp_path, "key", build).views) == 1
    with pytest.raises(CacheError, match=r"views-.*npz: views cannot be stored here"):
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


def test_meshes_of_the_real_list_have_tabletop_sizes() -> None:
    folder = meshes_folder()
    if folder is None:
        pytest.skip("DEIXIS_DATA does not lead to tabletop-meshes")
    rows = list(csv.DictReader((folder / "index.csv").read_text(encoding="utf-8").splitlines()))
    sizes = [[float(row[f"ext_{axis}"]) for axis in "xyz"] for row in rows if row["category"] != "place_setting"]
    largest = [float(np.ptp(in_metres(box(*size)).vertices, axis=0).max()) for size in sizes]
    assert len(largest) == len(rows_of(folder)) and 0.04 < min(largest) <= max(largest) <= 0.5


@pytest.mark.parametrize("text", [None, "a,b\n1,2\n"])
def test_a_folder_without_a_mesh_list_is_reported(tmp_path: Path, text: str | None) -> None:
    if text is not None:
        (tmp_path / "index.csv").write_text(text)
    with pytest.raises(MeshListError, match=r"index\.csv"):
        rows_of(tmp_path)


def test_every_contestant_has_its_own_name() -> None:
    book = Codebook("spin_images", np.zeros((2, 3)))
    assert all(make().name == name for name, make in contestants(book).items())


def test_missing_scikit_learn_is_reported_before_any_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sklearn", None)
    code, out, err = deixis("experiment", "open-ended")
    assert (code, out) == (2, "")
    assert "pip install 'deixis[experiments]'" in err
    assert err.count("\n") == 1


def test_every_contestant_runs_every_order_reproducibly(found: OpenEnded) -> None:
    again = run(found.plan, entered=[EQUATIONS, NEAREST])
    (one,), (other,) = found.findings, again.findings
    assert [taught.contestant for taught in one.taught] == [EQUATIONS, EQUATIONS, NEAREST, NEAREST]
    assert one.taught == other.taught and one.nearest == other.nearest
    assert one.taught[0].course.order != one.taught[1].course.order
    assert one.taught[0].course.order == one.taught[2].course.order


def test_the_report_fits_the_page_and_names_seeds_and_skipped(found: OpenEnded) -> None:
    text = lines(found)
    assert max(map(len, text)) <= 120 and "seeds 1 to 2" in text[0]
    assert any("skipped: meshes" in line for line in text)
    data = json.loads(json.dumps(to_dict(found), allow_nan=False))
    assert errors_in("open_ended", data) == []
    assert data["seeds"] == [1, 2] and len(data["sets"][0]["courses"]) == 4
    assert 0.0 <= data["sets"][0]["courses"][0]["GCA"] <= 1.0


def test_the_result_is_an_answer(found: OpenEnded) -> None:
    assert_is_answer(found)
    assert [row["learner"] for row in to_rows(found)] == [one.contestant for one in found.findings[0].taught]


def test_the_picture_is_drawn(found: OpenEnded, tmp_path: Path) -> None:
    plot_open_ended(found, tmp_path / "open.svg")
    assert EQUATIONS in (tmp_path / "open.svg").read_text()


def test_the_chart_is_as_stored(tmp_path: Path) -> None:
    def course(learner: str, right: str) -> CourseResult:
        answers = [
            TaughtAnswer("cup", "cup" if sign == "+" else None, 0.2, 2 + n // 5, 4 + n, 0.5)
            for n, sign in enumerate(right)
        ]
        made = Course(learner, ("cup", "fork"), tuple(answers), (0, 1), (0.4,), 2, 4 + len(right), End.LEARNED)
        return CourseResult(learner, made, 0.5)

    taught = course("equations", "+-++-+++++++"), course("nearest", "--+-+-++-+")
    findings = Findings("made-up things", ("Cup", "Fork"), 4, 8, taught, {}, {})
    plot_open_ended(OpenEnded(TINY, (findings,), ()), tmp_path / "open.png")
    assert_as_stored("open_ended", tmp_path / "open.png")


def test_a_mean_curve_holds_shorter_curves_at_their_end() -> None:
    curves = [np.array([1.0]), np.array([3.0, 5.0]), np.array([2.0, 4.0, 6.0]), np.empty(0)]
    assert mean_curve(curves).tolist() == [2.0, 10 / 3, 4.0]
    assert mean_curve([]).tolist() == mean_curve([np.empty(0)]).tolist() == []
