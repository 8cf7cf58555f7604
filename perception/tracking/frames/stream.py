"""Streams of clouds: files, a folder that grows, recorded sequences, and any camera that yields frames.

A camera driver is any object with a method ``frames`` that yields :class:`Frame` objects; :class:`LatestFrames` reads
one in a thread of its own, keeps only the newest frames, and counts those that were dropped.
"""

from __future__ import annotations

import csv
import threading
import time
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.errors import CloudError
from deixis.perception.tracking.frames.frame import Frame
from deixis.text_files import read_lines

TIMES = "times.csv"
"""Name of the file of a recorded sequence that holds the names of its clouds and their times."""

MAX_TIMES_LINE = 10_000
"""Maximum number of characters in a line of the file of times."""

CLOUD_SUFFIXES = frozenset({".pcd", ".ply", ".npz", ".png", ".npy"})
"""Suffixes of files that a folder of clouds may contain; PNG and NPY are depth images, which need intrinsics."""

SETTLE_SECONDS = 0.2
"""Minimum age in seconds at which a file in a growing folder counts as completely written."""


@runtime_checkable
class CloudSource(Protocol):
    """Source of frames: a camera driver, a folder, or the simulator."""

    def frames(self) -> Iterator[Frame]:
        """Yield the frames in order, until the stream ends.

        Yields
        ------
        Frame
            Organised cloud with its time in seconds, which increases from frame to frame.
        """
        ...


class FileSource:
    """Clouds in files, in the given order.

    Parameters
    ----------
    files
        Files of clouds, or depth images.
    rate
        Frames per second, from which times are made.
    intrinsics
        Camera of depth images; None for clouds.
    """

    def __init__(
        self, files: Sequence[str | Path], rate: float = 10.0, intrinsics: str | Path | Intrinsics | None = None
    ) -> None:
        if not 0 < rate <= 1000:
            raise CloudError(f"`rate` must be above 0 and at most 1000 frames a second, got {rate:g}")
        self._files, self._rate, self._intrinsics = list(files), rate, intrinsics

    def frames(self) -> Iterator[Frame]:
        """Yield a frame for each file.

        Yields
        ------
        Frame
            Cloud of the file; its time is its number divided by the rate. The frame of a file that cannot be read
            says why.
        """
        for number, file in enumerate(self._files):
            yield _read(file, self._intrinsics, number / self._rate, number)


class FolderSource:
    """Clouds in a folder, in the order of their names, as a recording or while it grows.

    With a file ``times.csv`` (columns ``file`` and ``seconds``) the folder is a recorded sequence, as :func:`recording`
    writes it. Without one, times follow from ``rate``; while the folder grows, they are the times at which the files
    were written.

    Parameters
    ----------
    folder
        The folder.
    rate
        Frames per second if there are no times.
    grows
        True to wait for further files.
    patience
        Time in seconds without a new file after which a growing folder ends.
    intrinsics
        Camera of depth images; None for clouds.
    """

    def __init__(
        self,
        folder: str | Path,
        rate: float = 10.0,
        grows: bool = False,
        patience: float = 10.0,
        intrinsics: str | Path | Intrinsics | None = None,
    ) -> None:
        self._folder, self._grows, self._patience = Path(folder), grows, patience
        self._rate, self._intrinsics = rate, intrinsics
        if not 0 < rate <= 1000:
            raise CloudError(f"`rate` must be above 0 and at most 1000 frames a second, got {rate:g}")
        if not self._folder.is_dir():
            raise CloudError(f"{self._folder}: there is no such folder; give a folder with clouds")
        if not grows and not self._files():
            raise CloudError(f"{self._folder}: no clouds in this folder; it needs .pcd, .ply or .npz files")

    def frames(self) -> Iterator[Frame]:
        """Yield a frame for each file; wait for new ones if the folder grows.

        Yields
        ------
        Frame
            Cloud of the file with its time.

        Raises
        ------
        CloudError
            If ``times.csv`` is invalid.
        """
        if self._grows:
            yield from self._growing()
            return
        times = _times(self._folder / TIMES)
        if times is None:
            yield from FileSource(self._files(), self._rate, self._intrinsics).frames()
            return
        for number, (name, at) in enumerate(times):
            yield _read(self._folder / name, self._intrinsics, at, number)

    def _growing(self) -> Iterator[Frame]:
        """Yield a frame for each file that comes, at the time in ``times.csv`` if there is one."""
        seen: list[Path] = []
        first: float | None = None
        quiet_since = time.monotonic()
        while time.monotonic() - quiet_since < self._patience:
            times = _times(self._folder / TIMES, grows=True)
            if times is not None:
                new, first = [(self._folder / name, at) for name, at in times[len(seen) :]], 0.0
            else:
                new = self._settled(seen)
                first = new[0][1] if new and first is None else first
            for file, at in new:
                seen.append(file)
                yield _read(file, self._intrinsics, at - (first or 0.0), len(seen) - 1)
                quiet_since = time.monotonic()
            if not new:
                time.sleep(0.05)

    def _settled(self, seen: Collection[Path]) -> list[tuple[Path, float]]:
        """Return the files that have not been seen and are no longer being written, with the times of writing."""
        now, known = time.time(), set(seen)
        dates = [(file, _written_at(file)) for file in self._files() if file not in known]
        return [(file, at) for file, at in dates if at is not None and abs(now - at) > SETTLE_SECONDS]

    def _files(self) -> list[Path]:
        return sorted(file for file in self._folder.iterdir() if file.suffix.lower() in CLOUD_SUFFIXES)


def _written_at(file: Path) -> float | None:
    """Return when a file was written, which is later than now if the clock was set back; None if it is gone."""
    try:
        return file.stat().st_mtime
    except OSError:
        return None


def _read(file: str | Path, intrinsics: str | Path | Intrinsics | None, at: float, number: int) -> Frame:
    try:
        return Frame(read_cloud(file, intrinsics), at, number)
    except (CloudError, OSError) as error:
        return Frame(PointCloud(np.zeros((0, 3), np.float32)), at, number, " ".join(str(error).split()))


def recording(frames: Iterable[Frame], folder: str | Path) -> Iterator[Frame]:
    """Write frames as a recorded sequence, a PCD file for each and their times, and yield them.

    Parameters
    ----------
    frames
        Frames in order.
    folder
        New or empty folder.

    Yields
    ------
    Frame
        Each frame, after it was written.

    Raises
    ------
    CloudError
        If the folder is not empty.
    """
    place = Path(folder)
    try:
        place.mkdir(parents=True, exist_ok=True)
        if any(place.iterdir()):
            raise CloudError(f"{place}: the folder is not empty; give a new one")
        (place / TIMES).write_text("file,seconds\n", encoding="utf-8")
    except OSError as error:
        raise CloudError(f"{place}: cannot be written: {error.strerror}") from error
    for number, frame in enumerate(frames):
        name = f"{number:06d}.pcd"
        try:
            write_cloud(place / name, frame.cloud)
            with (place / TIMES).open("a", encoding="utf-8") as times:
                times.write(f"{name},{frame.at:.6f}\n")
        except OSError as error:
            raise CloudError(f"{place / name}: cannot be written: {error.strerror}") from error
        yield frame


def _times(file: Path, grows: bool = False) -> list[tuple[str, float]] | None:
    """Return names and times of a recorded sequence, or None if there is no such file.

    Of a growing one, a last line without an end is left out: it is still being written.
    """
    if not file.is_file():
        return None
    found = []
    lines = (line for line in read_lines(file, CloudError, MAX_TIMES_LINE) if not grows or line.endswith("\n"))
    for number, row in enumerate(csv.reader(lines), start=1):
        if number == 1 and row[:1] == ["file"]:
            continue
        try:
            name, at = row[0], float(row[1])
        except (IndexError, ValueError):
            raise CloudError(f"{file}:{number}: each line must be the name of a file and seconds, got {row}") from None
        if Path(name).name != name:
            raise CloudError(f"{file}:{number}: the name of a file must have no folder, got '{name}'")
        found.append((name, at))
    return found


class LatestFrames:
    """Frames of a live source, read by a thread; frames that come too fast are dropped and counted.

    Parameters
    ----------
    source
        The source.
    waiting
        Largest number of frames that wait; the oldest is dropped for a newer one.

    Examples
    --------
    >>> import numpy as np
    >>> from deixis.perception.clouds.cloud import PointCloud
    >>> class Camera:
    ...     def frames(self):
    ...         yield Frame(PointCloud(np.zeros((1, 3), np.float32)), 0.0, 0)
    >>> latest = LatestFrames(Camera())
    >>> [frame.number for frame in latest.frames()], latest.dropped
    ([0], 0)
    """

    def __init__(self, source: CloudSource, waiting: int = 2) -> None:
        if waiting < 1:
            raise CloudError(f"`waiting` must be at least 1, got {waiting}")
        self.dropped = 0
        """Number of frames that were dropped."""
        self._source, self._waiting = source, waiting
        self._queue: deque[Frame] = deque()
        self._changed = threading.Condition()
        self._ended = False
        self._error: BaseException | None = None

    def frames(self) -> Iterator[Frame]:
        """Yield the newest frames, until the source ends.

        Yields
        ------
        Frame
            Frames in order, without the dropped ones.

        Raises
        ------
        Exception
            What the source raised.
        """
        reader = threading.Thread(target=self._read, name="frames", daemon=True)
        reader.start()
        try:
            while True:
                with self._changed:
                    self._changed.wait_for(lambda: self._queue or self._ended)
                    if not self._queue:
                        break
                    frame = self._queue.popleft()
                yield frame
            if self._error is not None:
                raise self._error
        finally:
            with self._changed:
                self._ended = True

    def _read(self) -> None:
        try:
            for frame in self._source.frames():
                with self._changed:
                    if self._ended:
                        return
                    if len(self._queue) >= self._waiting:
                        self._queue.popleft()
                        self.dropped += 1
                    self._queue.append(frame)
                    self._changed.notify()
        except BaseException as error:  # also SystemExit of a driver; it is raised again where the frames are used
            self._error = error
        finally:
            with self._changed:
                self._ended = True
                self._changed.notify()
