"""A session shared by threads, and one that a process has open when it is forked."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

import deixis
from deixis.errors import DeixisError
from deixis.memory.errors import MemoryBusyError
from deixis.session import Session

SCRIPT = deixis.read_script(text="layout tea\nfork left of plate; knife right of plate")
SCENE = {
    "unit": "m",
    "objects": [
        {"id": name, "label": name, "min": [x, 0.0, 0.0], "max": [x + 0.03, 0.2, 0.01]}
        for name, x in (("fork", 0.0), ("plate", 0.1), ("knife", 0.2))
    ],
}
THREADS = 12


def test_threads_that_learn_at_once_all_learn(tmp_path: Path) -> None:
    failed: list[Exception] = []
    with Session(tmp_path / "memory") as session:

        def learn() -> None:
            try:
                session.learn(SCRIPT, SCENE)
                session.query("ASK { ?x a dx:Role }")
                session.show("tea")
            except DeixisError as error:
                failed.append(error)

        threads = [threading.Thread(target=learn) for _ in range(THREADS)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert not failed
        assert session.memory().lessons() == tuple(f"tea-{number}" for number in range(1, THREADS + 1))


@pytest.mark.parametrize("lock_held", [False, True])
def test_a_forked_child_gets_an_error_and_its_parent_goes_on(tmp_path: Path, lock_held: bool) -> None:
    said, says = os.pipe()
    with Session(tmp_path / "memory") as session:
        session.learn(SCRIPT, SCENE)
        session.views(create=True)
        if lock_held:
            holding, done = threading.Event(), threading.Event()

            def hold() -> None:
                with session.lock:
                    holding.set()
                    done.wait(30)

            threading.Thread(target=hold, daemon=True).start()
            holding.wait()
        child = os.fork()
        if child == 0:
            for call in (
                lambda: session.learn(SCRIPT, SCENE),
                lambda: session.query("ASK { ?x a dx:Role }"),
                lambda: session.categories(),
                lambda: Session(tmp_path / "memory").memory(),
            ):
                try:
                    call()
                    os.write(says, b"nothing was said\n")
                except MemoryBusyError as error:
                    os.write(says, f"{error}\n".encode())
            session.close()
            os._exit(0)
        if lock_held:
            done.set()
        assert os.waitpid(child, 0) == (child, 0)
        os.close(says)
        with os.fdopen(said) as answers:
            lines = answers.read().splitlines()
        assert len(lines) == 4
        assert all("held by the process from which this one was forked" in line for line in lines[:3])
        assert "cannot be opened by a process that was forked from one which had opened a memory" in lines[3]
        session.learn(SCRIPT, SCENE)
    with Session(tmp_path / "memory") as session:
        assert session.memory().lessons() == ("tea-1", "tea-2")


FORKING = """
import os, sys
import deixis
session = deixis.Session(sys.argv[1])
child = os.fork()
if child == 0:
    boxes = [(0.0, "fork"), (0.1, "plate"), (0.2, "knife")]
    things = [{"id": name, "label": name, "min": [x, 0, 0], "max": [x + 0.03, 0.2, 0.01]} for x, name in boxes]
    script = deixis.read_script(text="layout tea\\nfork left of plate; knife right of plate")
    session.learn(script, {"unit": "m", "objects": things})
    session.close()
    os._exit(0)
assert os.waitpid(child, 0) == (child, 0)
assert session.memory().lessons() == ("tea-1",)
session.close()
"""


def test_a_child_forked_before_the_memory_is_opened_may_use_it(tmp_path: Path) -> None:
    """Run in a separate process, as opening a store on disk starts threads that no child has."""
    command = [sys.executable, "-c", FORKING, str(tmp_path / "memory")]
    assert subprocess.run(command, timeout=120, check=False).returncode == 0


def test_a_child_forked_after_a_memory_was_opened_gets_an_error(tmp_path: Path) -> None:
    with Session(tmp_path / "first") as session:
        session.learn(SCRIPT, SCENE)
    child = os.fork()
    if child == 0:
        try:
            Session(tmp_path / "second").learn(SCRIPT, SCENE)
        except MemoryBusyError:
            os._exit(7)
        os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
