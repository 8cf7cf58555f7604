"""Streams of clouds: folders, recordings, and live sources whose late frames are dropped."""

import os
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from timing import BUSY_SECONDS

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import write_cloud
from deixis.perception.errors import CloudError
from deixis.perception.tracking.frames.frame import Frame
from deixis.perception.tracking.frames.stream import FolderSource, LatestFrames, recording


def cloud(x: float) -> PointCloud:
    return PointCloud(np.full((6, 3), x, np.float32), organised=(2, 3))


def frames(count: int) -> Iterator[Frame]:
    for number in range(count):
        yield Frame(cloud(number + 1), 0.25 * number, number)


def test_recorded_sequence_is_read_again(tmp_path: Path) -> None:
    assert len(list(recording(frames(3), tmp_path / "film"))) == 3
    again = list(FolderSource(tmp_path / "film").frames())
    assert [(frame.at, frame.number, float(frame.cloud.points[0, 0])) for frame in again] == [
        (0.0, 0, 1.0),
        (0.25, 1, 2.0),
        (0.5, 2, 3.0),
    ]
    with pytest.raises(CloudError, match="not empty"):
        next(recording(frames(1), tmp_path / "film"))


def test_folder_without_times_has_the_given_rate(tmp_path: Path) -> None:
    for name in ("b", "a"):
        write_cloud(tmp_path / f"{name}.pcd", cloud(ord(name)))
    found = list(FolderSource(tmp_path, rate=4).frames())
    assert [(frame.at, float(frame.cloud.points[0, 0])) for frame in found] == [(0.0, 97.0), (0.25, 98.0)]


def test_damaged_file_gives_a_frame_with_its_problem(tmp_path: Path) -> None:
    write_cloud(tmp_path / "a.pcd", cloud(1))
    (tmp_path / "b.pcd").write_bytes(b"nothing")
    good, bad = FolderSource(tmp_path).frames()
    assert good.problem is None
    assert bad.problem is not None and "b.pcd" in bad.problem and "\n" not in bad.problem


def test_growing_folder_yields_files_that_come_later(tmp_path: Path) -> None:
    write_cloud(tmp_path / "a.pcd", cloud(1))
    frames = FolderSource(tmp_path, grows=True, patience=0.8).frames()
    first = next(frames)
    write_cloud(tmp_path / "b.pcd", cloud(2))
    assert [float(frame.cloud.points[0, 0]) for frame in (first, *frames)] == [1.0, 2.0]


def test_growing_recording_yields_rows_that_come_later(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_cloud(tmp_path / f"{name}.pcd", cloud(ord(name)))
    times = tmp_path / "times.csv"
    times.write_text("file,seconds\na.pcd,0.5\nb.pcd,0.", encoding="utf-8")  # the last line is still being written
    frames = FolderSource(tmp_path, grows=True, patience=0.8).frames()
    first = next(frames)
    times.write_text("file,seconds\na.pcd,0.5\nb.pcd,0.75\n", encoding="utf-8")
    found = [(frame.at, float(frame.cloud.points[0, 0])) for frame in (first, *frames)]
    assert found == [(0.5, 97.0), (0.75, 98.0)]


def test_growing_folder_may_lose_files_and_be_of_the_future(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_cloud(tmp_path / f"{name}.pcd", cloud(ord(name)))
        os.utime(tmp_path / f"{name}.pcd", (4e9, 4e9))  # the clock was set back after it was written
    (tmp_path / "gone.pcd").symlink_to(tmp_path / "nowhere.pcd")  # as if deleted after the folder was listed
    found = [float(frame.cloud.points[0, 0]) for frame in FolderSource(tmp_path, grows=True, patience=0.3).frames()]
    assert found == [97.0, 98.0]


@pytest.mark.parametrize("text", ["file,seconds\na.pcd,soon\n", "file,seconds\n../a.pcd,1\n"])
def test_wrong_times_name_file_and_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "times.csv").write_text(text, encoding="utf-8")
    write_cloud(tmp_path / "a.pcd", cloud(1))
    with pytest.raises(CloudError, match=r"times\.csv:2"):
        list(FolderSource(tmp_path).frames())


def test_late_frames_are_dropped_and_counted() -> None:
    sent = threading.Event()

    class Camera:
        def frames(self) -> Iterator[Frame]:
            yield from frames(20)
            sent.set()

    latest = LatestFrames(Camera(), waiting=2)
    numbers = []
    for frame in latest.frames():
        numbers.append(frame.number)
        assert sent.wait(BUSY_SECONDS)
    assert numbers == sorted(numbers) and numbers[-1] == 19
    assert len(numbers) + latest.dropped == 20 and latest.dropped > 0


def test_error_of_a_source_reaches_the_reader() -> None:
    class Camera:
        def frames(self) -> Iterator[Frame]:
            yield from frames(1)
            raise CloudError("the camera was unplugged")

    with pytest.raises(CloudError, match="unplugged"):
        list(LatestFrames(Camera()).frames())


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (b"file,seconds\n\xff\xfe.pcd,1\n", "not UTF-8"),
        (b"file,seconds\n" + b"a" * 200_000 + b",1\n", "times.csv:2: a"),
    ],
    ids=["bytes", "long line"],
)
def test_times_that_are_not_text_are_refused(tmp_path: Path, data: bytes, what: str) -> None:
    (tmp_path / "a.pcd").touch()
    (tmp_path / "times.csv").write_bytes(data)
    with pytest.raises(CloudError, match=what):
        list(FolderSource(tmp_path).frames())


def test_times_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    write_cloud(tmp_path / "a.pcd", cloud(1))
    (tmp_path / "times.csv").write_text("\ufefffile,seconds\na.pcd,2\n", encoding="utf-8")
    assert [frame.at for frame in FolderSource(tmp_path).frames()] == [2.0]


def test_driver_that_exits_is_an_error_of_the_source() -> None:
    class Exits:
        def frames(self) -> Iterator[Frame]:
            yield from frames(1)
            raise SystemExit(5)

    with pytest.raises(SystemExit):
        list(LatestFrames(Exits()).frames())
