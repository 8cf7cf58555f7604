"""Tracking of streams as a command: events, gone things, and frames that cannot be used."""

import json
from pathlib import Path

import numpy as np
import pytest
from commands import deixis as deixis_command
from schemas import errors_in

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.simulator.films.stage import Rest, TakeAway, film
from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.frames.frame import Frame
from deixis.perception.tracking.frames.stream import recording
from deixis.report.scenes.track import tracking_lines
from deixis.workflows.scenes.track import cloud_source, track

pytest.importorskip("open3d")

PLATE, MUG = Placement("plate", "dinner plate", -0.2, 0.0, seed=1), Placement("mug", "mug", 0.2, 0.1, seed=2)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a recorded film of six frames, two of which cannot be used."""
    place = tmp_path_factory.mktemp("films") / "film"
    frames = list(film([PLATE, MUG], [Rest(0.5)]).frames(10, scale=0.4))
    empty = PointCloud(np.full_like(frames[0].cloud.points, np.nan), organised=frames[0].cloud.organised)
    list(recording([*frames[:4], Frame(empty, 0.4, 4), Frame(frames[4].cloud, 0.2, 5)], place))
    return place


def test_recorded_sequence_is_tracked_and_bad_frames_named(folder: Path) -> None:
    found = track(cloud_source([folder]))
    assert [(event.id, event.change) for event in found.events] == [("t1", "new"), ("t2", "new")]
    assert (found.frames, found.left_out, len(found.notes)) == (4, 2, 2)
    assert "empty" in found.notes[0] and "backwards" in found.notes[1]
    assert len(list(tracking_lines(found))) == 5


def test_command_prints_lines_of_the_schema(folder: Path) -> None:
    code, out, err = deixis_command("track", folder, "--lines")
    assert code == 0, err
    lines = [json.loads(line) for line in out.splitlines()]
    assert [len(line["things"]) for line in lines] == [2] * 6
    assert [errors_in("situation", line) for line in lines] == [[]] * 6


@pytest.mark.parametrize("option", [(), ("--json",), ("--lines",)])
def test_stream_of_unusable_frames_exits_with_2(tmp_path: Path, option: tuple[str, ...]) -> None:
    for name in ("0.pcd", "1.pcd"):
        (tmp_path / name).write_text("no cloud")
    code, _, err = deixis_command("track", tmp_path, *option)
    assert (
        code == 2
        and "none of the 2 frames can be used" in err
        and "0.pcd" in err
        and len(err.strip().splitlines()) == 1
    )


def test_thing_that_was_taken_away_is_gone() -> None:
    story = film([PLATE, MUG], [Rest(0.2), TakeAway("mug"), Rest(1.0)])

    class Small:
        def frames(self):  # type: ignore[no-untyped-def]
            return story.frames(6, scale=0.4)

    found = track(Small())
    assert [thing.id for thing in found.gone] == ["t2"]
    assert found.events[-1].change == "gone" and found.gone[0].seen_at < found.events[-1].at


@pytest.mark.parametrize("source", [["/nowhere"], [".", "."]])
def test_wrong_source_is_named(source: list[str]) -> None:
    code, _, err = deixis_command("track", *source)
    assert code == 2 and source[0] in err and len(err.strip().splitlines()) == 1
