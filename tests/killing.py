"""Processes that are killed at a given moment, forked from one that has imported everything, so that many can be."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

FORK = """
import os, sys
for line in sys.stdin:
    folder, seed = line.rstrip("\\n").rsplit(" ", 1)
    child = os.fork()
    if child == 0:
        os.write(1, b"child %d\\n" % os.getpid())
        work(folder, seed)
        os._exit(0)
    os.waitpid(child, 0)
    os.write(1, b"gone\\n")
"""


class Forks:
    """Runs ``work`` in one child after another, and kills each; made by :func:`forks_of`."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process

    def kill_after(self, folder: Path, seed: int, lines: int, delay: float) -> list[str]:
        """Lets a child write so many lines, kills it so many seconds later, and returns all lines that it wrote."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(f"{folder} {seed}\n")
        self.process.stdin.flush()
        verb, number = self.process.stdout.readline().split()
        assert verb == "child"
        said = [self.process.stdout.readline() for _ in range(lines)]
        time.sleep(delay)
        os.kill(int(number), signal.SIGKILL)
        said += iter(self.process.stdout.readline, "gone\n")
        return [line.rstrip("\n") for line in said]


@contextmanager
def forks_of(work: str) -> Iterator[Forks]:
    """``work`` is a program that defines ``work(folder, seed)``, which writes lines to descriptor 1 at a go each."""
    command = [sys.executable, "-c", work + FORK]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield Forks(process)
        assert process.stdin is not None
        process.stdin.close()
