"""Track things by the particle filter of the Point Cloud Library, through a small program built against it.

The filter adapts its number of particles (KLD), and has the settings of the library's own example. It follows given
clouds: it neither finds things nor notices that they are gone.
"""

from __future__ import annotations

import shutil
import struct
import subprocess
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

SOURCE = Path(__file__).with_suffix(".cpp")


def build(folder: Path) -> Path | None:
    """Build the program and return its path; None if the compiler, pkg-config or Debian's libpcl-dev is missing."""
    if not (shutil.which("g++") and shutil.which("pkg-config")):
        return None
    libraries = ["pcl_tracking", "pcl_filters", "pcl_octree"]
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", *libraries], capture_output=True, text=True)
    if flags.returncode:
        return None
    program = folder / "tracking_pcl"
    optimised = ["-O3", "-DNDEBUG", "-std=c++17", "-w", "-pthread", "-fopenmp"]
    subprocess.run(["g++", *optimised, str(SOURCE), "-o", str(program), *flags.stdout.split()], check=True)
    return program


class Filters:
    """One particle filter for each thing, in a process of the program that is ended by the ``with`` statement."""

    def __init__(self, program: Path) -> None:
        self._process = subprocess.Popen(
            [str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.kill()
        self._process.wait()

    def begin(self, points: NDArray[np.floating], middle: NDArray[np.floating]) -> None:
        """Begin to follow a thing by its points (n, 3); ``middle`` (3,) is the place that is reported of it."""
        start, thing = np.asarray(middle, np.float32), np.asarray(points - middle, np.float32)
        self._send(b"B", start.tobytes(), struct.pack("i", len(thing)), np.ascontiguousarray(thing).tobytes())

    def follow(self, points: NDArray[np.floating]) -> tuple[NDArray[np.float64], float]:
        """Return the middles (k, 3) of the things after a frame (n, 3), and the seconds of processor time."""
        frame = np.ascontiguousarray(points, np.float32)
        self._send(b"F", struct.pack("i", len(frame)), frame.tobytes())
        (count,) = struct.unpack("i", self._receive(4))
        middles = np.frombuffer(self._receive(12 * count), np.float32).reshape(-1, 3).astype(np.float64)
        (seconds,) = struct.unpack("d", self._receive(8))
        return middles, seconds

    def _send(self, *parts: bytes) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(b"".join(parts))
        self._process.stdin.flush()

    def _receive(self, size: int) -> bytes:
        assert self._process.stdout is not None
        found = self._process.stdout.read(size)
        if len(found) < size:
            raise RuntimeError("the program of the Point Cloud Library ended early")
        return found
