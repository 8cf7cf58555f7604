"""Processes that are killed at a given moment, forked from one that has imported everything, so that many can be."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
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
        """Lets a child write ``lines`` lines, kills it ``delay`` seconds later, and returns all lines that it wrote."""
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


STEPS = """
import os, shutil, signal, sys
import deixis
from deixis.examples_data import example
from deixis.learning import update as learning
from deixis.memory.episodes.store.disk import DiskKeys
from deixis.memory.perceptual import exchange
from deixis.memory.perceptual.database import handle
from deixis.memory.semantic.rdf import ledger
from deixis.robot.robot import Robot
from deixis.session import Session

steps, last = [], [0]

def step(name):
    steps.append(name)
    if len(steps) == last[0]:
        os.kill(os.getpid(), signal.SIGKILL)

def stepping(owner, name):
    function = getattr(owner, name)
    def call(*told, **more):
        step(name)
        result = function(*told, **more)
        step(name)
        return result
    setattr(owner, name, call)

for place, names in (
    (os, ("replace", "unlink", "fsync", "pwrite", "mkdir", "rmdir")),
    (shutil, ("rmtree",)),
    (ledger, ("update", "update_in_bulk")),
    (handle.Handle, ("write",)),
    (DiskKeys, ("write",)),
):
    for name in names:
        stepping(place, name)
exchange._STEP = 1  # a batch a view
learning.AT_ONCE = 2  # a batch of three lessons is written to a copy
deixis.ground(example("formal_dinner.layout"), example("second_table.scene.json"))  # everything is compiled once

def work(folder, what):
    number, code = what.split(" ", 1)
    steps.clear()
    last[0] = int(number)
    with Session(folder) as session:
        exec(code, {"session": session, "folder": folder})
    os.write(1, ("steps " + " ".join(steps) + "\\n").encode())

for line in sys.stdin:
    folder, what = line.rstrip("\\n").split(" ", 1)
    child = os.fork()
    if child == 0:
        os.write(1, b"child %d\\n" % os.getpid())
        work(folder, what)
        os._exit(0)
    os.write(1, b"ended %d\\n" % os.waitpid(child, 0)[1])
"""
"""Program that changes a memory as requested, in one child process each, and kills the child at a step: before or after
a call that changes what is on the disk."""


class KilledAtSteps:
    """Does something to a memory in one child after another, each killed at a step; made by :func:`killed_at_steps`."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process

    def run(self, folder: Path, code: str, step: int = 0, after: float | None = None) -> list[str] | None:
        """Do what ``code`` says to ``session``, and return the names of the steps; None where it was killed.

        It is killed at a step, counted from 1, or ``after`` so many seconds.
        """
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(f"{folder} {step} {code}\n")
        self.process.stdin.flush()
        said = [self.process.stdout.readline()]
        if after is not None:
            time.sleep(after)
            with suppress(ProcessLookupError):
                os.kill(int(said[0].split()[1]), signal.SIGKILL)
        while not (line := self.process.stdout.readline()).startswith("ended"):
            assert line, "the program that forks has ended"
            said.append(line)
        status = int(line.split()[1])
        assert status in (0, signal.SIGKILL), (code, step, status)
        return said[-1].split()[1:] if status == 0 else None


@contextmanager
def killed_at_steps() -> Iterator[KilledAtSteps]:
    """Give what kills at steps; the program imports and compiles everything once."""
    command = [sys.executable, "-c", STEPS]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield KilledAtSteps(process)
        assert process.stdin is not None
        process.stdin.close()
