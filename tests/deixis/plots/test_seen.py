"""Content of the pictures of perceived and recognised things."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from commands import deixis
from matplotlib.figure import Figure

from deixis.grammar.layout.parser import parse_script
from deixis.learning.views.views import Recognised
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import write_cloud
from deixis.perception.detection.table.viewpoint import in_frame
from deixis.perception.recognition.calibration import SHIPPED, Calibration
from deixis.perception.recognition.recogniser import Recognition
from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots import seen as plot_seen
from deixis.plots.camera import camera_of
from deixis.workflows.layouts.lay_table import lay_script
from deixis.workflows.scenes.perceive import perceive
from deixis.workflows.scenes.simulate import simulate


def table_before_a_wall() -> Scene:
    """Perceive a simulated plate on a table, with the points of a wall behind them."""
    cloud = simulate(lay_script(parse_script("plate on table"), seed=1), seed=1).cloud
    cloud = cloud.take(cloud.finite)
    across, up = (axis.ravel() for axis in np.mgrid[-1:1:0.05, -0.5:0.5:0.05])
    wall = np.stack([across, up, np.full(across.shape, 4.0)], axis=1)
    return perceive(PointCloud(np.concatenate([cloud.points, wall]).astype(np.float32)))


def drawn_window(found: Scene) -> plot_seen.Window:
    """Compute the window that the picture of a perceived scene shows."""
    assert found.detection is not None
    return plot_seen.window_of(in_frame(found.detection.cloud, found.detection.frame).points, found, found.detection)


def test_the_things_are_drawn_with_little_around_them() -> None:
    found = table_before_a_wall()
    low, high = drawn_window(found)
    (box,) = found.boxes[:, :, :2]
    assert (low < box[0]).all() and (high > box[1]).all()
    assert (high - low < 1.3 * (box[1] - box[0]).max()).all()


def test_the_whole_table_is_drawn_where_nothing_is_on_it() -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.01, 0.5:1.5:0.01])
    table = PointCloud(np.stack([x, y, np.full(x.shape, -0.7)], axis=1).astype(np.float32))
    found = perceive(table)
    low, high = drawn_window(found)
    assert found.detection is not None and found.detection.table is not None and not found.objects
    assert (high - low).tolist() == pytest.approx([1.18, 1.18], abs=0.02)


def test_all_points_are_drawn_where_there_is_no_table() -> None:
    found = perceive(PointCloud(np.array([[0.0, 0.0, 1.0], [9.0, 9.0, 9.0]], np.float32)))
    assert found.detection is not None and found.detection.table is None
    low, high = plot_seen.window_of(found.detection.cloud.points, found, found.detection)
    assert (low < 0).all() and (high > 9).all()


def texts(found: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Return the texts in each panel of the picture of a perceived scene."""
    drawn: list[Figure] = []
    monkeypatch.setattr(plot_seen, "save", lambda figure, _: drawn.append(figure))
    plot_seen.plot_perceived(found, tmp_path / "seen.png")
    return [[text.get_text() for text in panel.texts] for panel in drawn[0].axes]


def test_what_was_perceived_is_named_from_above_and_in_the_image(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    laid = lay_script(parse_script("plate on table\nfork left of plate"), seed=1)
    above, image = texts(perceive(simulate(laid, seed=1).cloud), tmp_path, monkeypatch)
    assert sorted(above) == sorted(image) == ["o1", "o2"]


def test_a_picture_of_nothing_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = perceive(PointCloud(np.array([[0.0, 0.0, 1.0], [9.0, 9.0, 9.0]], np.float32)))
    assert texts(found, tmp_path, monkeypatch) == [["no table was found: no large level surface is in view"]]


def test_the_image_is_cropped_to_its_segments_with_pixel_boxes() -> None:
    labels = np.full((100, 200), -1, np.int32)
    labels[40:60, 50:70] = 0
    cloud = PointCloud(np.ones((20_000, 3), np.float32), organised=(100, 200))
    camera = camera_of(cloud, labels.ravel(), Scene((PerceivedObject("o1", (0, 0, 0), (1, 1, 1)),)))
    around = int(0.1 * 19) + 2
    side = 20 + 2 * around
    (thing,) = camera.things
    assert camera.picture.shape == (side, side, 3)
    assert (thing.minimum, thing.maximum) == ((around, around), (around + 20, around + 20))
    assert len(np.unique(camera.picture[0].round(6))) == 1
    inner, rim = camera.picture[side // 2, side // 2], camera.picture[around, side // 2]
    assert rim == pytest.approx(inner / 2)


def test_a_recognised_thing_is_named_with_its_id(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    labels = ("cup", None, "a" * 1000)
    things = tuple(PerceivedObject(f"o{n}", (n, 0, 0), (n + 0.5, 1, 1), label) for n, label in enumerate(labels, 1))
    written: list[str | None] = []
    monkeypatch.setattr(plot_seen, "write_names", lambda _f, _a, named: written.extend(one.label for one in named))
    plot_seen.plot_recognised(Recognised(Scene(things), {}), tmp_path / "seen.png")
    assert written == ["o1 cup", "o2 unknown", f"o3 {'a' * 31}…"]


def test_perceive_prints_the_picture_path_apart_from_the_scene(
    tmp_path: Path,
) -> None:
    cloud, scene, picture = tmp_path / "two.pcd", tmp_path / "two.scene.json", tmp_path / "two.svg"
    write_cloud(cloud, PointCloud(np.array([[0.0, 0.0, 1.0], [9.0, 9.0, 9.0]], np.float32)))
    assert f"Written: {picture}" in deixis("perceive", cloud, "-o", scene, "--plot", picture)[1]
    _, out, err = deixis("perceive", cloud, "--plot", picture)
    assert json.loads(out)["objects"] == [] and f"Written: {picture}" in err
    assert "picture" not in "".join(deixis("perceive", cloud, "--json", "--plot", picture)[1:])


def test_a_picture_of_recognised_things_explains_its_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Figure] = []
    monkeypatch.setattr(plot_seen, "save", lambda figure, _: drawn.append(figure))
    answer = Recognition(None, (), 0.39, Calibration(0.7, 0.7, 0.1, 0.1), True, ())
    things = (PerceivedObject("o1", (0, 0, 0), (1, 1, 1)),)
    plot_seen.plot_recognised(Recognised(Scene(things), {"o1": answer}), tmp_path / "seen.png")
    assert [text.get_text() for text in drawn[0].axes[0].texts] == ["o1 unknown 0.39"]
    assert "For 'unknown', it is the probability that none" in drawn[0].axes[0].get_xlabel()


def test_the_outline_of_a_doubtful_thing_is_faded() -> None:
    things = [PerceivedObject(f"o{k}", (0.3 * k, 0.0), (0.3 * k + 0.2, 0.2)) for k in range(3)]
    unknown = {f"o{k}": Recognition(None, (), share, SHIPPED, True, ()) for k, share in enumerate((1.0, 0.6))}
    (axes,) = plot_seen.recognised_figure(Recognised(Scene(tuple(things)), unknown)).axes
    sure, doubtful, unasked = (patch.get_alpha() for patch in axes.patches)
    assert sure == unasked == 1.0
    assert doubtful is not None and 0.2 < doubtful < 1.0
