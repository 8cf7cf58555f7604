"""Kill writes over several stores, and check that each write is afterwards either complete or absent.

Every write (what persons tell and show a robot, consolidate, learn, learn a batch, teach, forget a lesson or a
category, take back a table or a teacher, rename, merge, import concepts and views) is killed by SIGKILL, in ``--kills``
(300) children: half of them at a random step, before or after a call that changes the disk, and half at a random
moment. ``--every-step`` kills each write once at each of its steps instead. After each kill the memory is opened again:
``verify`` must find nothing, also in the inferred triples, and all lessons, views, inferred triples and episodes must
be those before the write or those after it. Then ``--owners`` (100) robots, each the owner of its memory, are killed at
random moments while they see and learn from what persons say and show: nothing that they acknowledged may be missing,
and ``verify`` must find nothing. Exits 1 otherwise.
"""

from __future__ import annotations

import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from records import command_line, count, recorded

from deixis.memory.episodes.blackboard import Blackboard
from deixis.session import Session

# After deixis is imported: the folder of the tests has a package of this name too.
sys.path.append(str(Path(__file__).parent.parent / "tests"))

from all_stores import TEA, Example, example_in, findings, state
from killing import KilledAtSteps, forks_of, killed_at_steps


class Writes:
    """The writes of an example, each with its steps, its time, and the memory before and after it."""

    def __init__(self, example: Example, scratch: Path, kills: KilledAtSteps) -> None:
        self.example, self.memory, self.kills = example, scratch / "m", kills
        self.steps: dict[str, int] = {}
        self.seconds: dict[str, float] = {}
        self.right: dict[str, tuple[object, object]] = {}
        for write, code in example.writes().items():
            self.begin(write)
            before, started = state(self.memory), time.perf_counter()
            steps = kills.run(self.memory, code)
            self.seconds[write] = time.perf_counter() - started
            assert steps is not None and findings(self.memory) == (), write
            self.steps[write], self.right[write] = len(steps), (before, state(self.memory))

    def begin(self, write: str) -> None:
        """Restore the memory that a write begins with."""
        shutil.rmtree(self.memory, ignore_errors=True)
        begin = self.example.begin(write)
        if begin is not None:
            shutil.copytree(begin, self.memory)

    def outcome(self, write: str, step: int = 0, after: float | None = None) -> str:
        """Kill a write, and return the state of the memory: before, after, or the error."""
        self.begin(write)
        self.kills.run(self.memory, self.example.writes()[write], step, after)
        wrong = findings(self.memory)
        if wrong:
            return f"verify: {wrong[0]}"
        found, (before, complete) = state(self.memory), self.right[write]
        return "before" if found == before else "after" if found == complete else "neither before nor after"


OWNER = """
import os, random
import deixis
from deixis.examples_data import example
from deixis.robot.robot import Robot

deixis.ground(example("formal_dinner.layout"), example("second_table.scene.json"))  # everything is compiled once

def work(folder, seed):
    random.seed(int(seed))
    robot, tables = Robot(folder), [deixis.read_scene(file) for file in TABLES]
    for turn in range(1000):
        robot.sees(random.choice(tables))
        if turn % 2:
            event = f"utterance{turn}"
            told = robot.told(TEA, "Ada", event=event)
            os.write(1, f"lesson {told.learned.lesson.id} {event}\\n".encode())
        else:
            event = f"showing{turn}"
            taught = robot.shown("gizmo", "o1", "Ada", event=event)
            os.write(1, f"view {taught.view} {event}\\n".encode())
"""
"""Program of a robot that owns its memory, and prints each lesson and view once it is acknowledged."""


def missing(memory: Path, acknowledged: list[str]) -> list[str]:
    """Return what a robot acknowledged and its memory lacks, and what ``verify`` finds."""
    wrong = list(findings(memory))
    with Session(memory) as session, Blackboard.open(memory) as board:
        known = set(session.memory().lessons()) if session.remembers() else set()
        views = {key.id for key in session.views().listing()} if session.has_views() else set()
        events = {each.source.event for each in board.holding()}
        for line in acknowledged:
            kind, id, event = line.split()
            if id not in (known if kind == "lesson" else views) or event not in events:
                wrong.append(f"missing: {line}")
    return wrong


def kill_owners(example: Example, number: int, rng: random.Random, scratch: Path) -> int:
    """Kill robots at random moments, and return how many lost something or left their memory out of step."""
    program = f"TEA = {TEA!r}\nTABLES = {[example.scene(seed) for seed in (3, 4, 5)]!r}\n{OWNER}"
    wrong = total = 0
    with forks_of(program) as robots:
        for seed in range(number):
            memory = scratch / f"owner {seed}"
            lines = robots.kill_after(memory, seed, rng.randrange(1, 6), rng.uniform(0, 1.5))
            total += len(lines)
            for problem in missing(memory, lines):
                print(f"owner {seed}: {problem}")
                wrong += 1
            shutil.rmtree(memory)
    print(f"{number} owners killed, {total} writes acknowledged, {wrong} of them lost or out of step")
    return wrong


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--owners", type=int, default=100)
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--every-step", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="20 kills, 5 owners")
    with recorded(parser) as options:
        rng = random.Random(options.seed)
        outcomes: dict[str, Counter[str]] = {}
        with tempfile.TemporaryDirectory() as scratch, killed_at_steps() as kills:
            (Path(scratch) / "example").mkdir()
            writes = Writes(example_in(Path(scratch) / "example"), Path(scratch), kills)
            jobs: list[tuple[str, int, float | None]]
            if options.every_step:
                jobs = [(write, step, None) for write, steps in writes.steps.items() for step in range(1, steps + 1)]
            else:
                names = [rng.choice(list(writes.steps)) for _ in range(20 if options.quick else options.kills)]
                jobs = [
                    (name, rng.randint(1, writes.steps[name]), None)
                    if number % 2
                    else (name, 0, rng.uniform(0, writes.seconds[name]))
                    for number, name in enumerate(names)
                ]
            for write, step, after in jobs:
                outcomes.setdefault(write, Counter())[writes.outcome(write, step, after)] += 1
            owners = 5 if options.quick else options.owners
            lost = kill_owners(writes.example, owners, rng, Path(scratch))
        for write, counts in outcomes.items():
            print(
                f"{write} ({writes.steps[write]} steps): "
                + ", ".join(f"{n} {what}" for what, n in counts.most_common())
            )
        wrong = sum(n for counts in outcomes.values() for what, n in counts.items() if what not in ("before", "after"))
        count("kills", len(jobs))
        count("writes left half done", wrong)
        count("owners killed", owners)
        count("owners' writes lost or out of step", lost)
        print(f"{len(jobs)} kills, {wrong} of them wrong")
        if wrong or lost:
            sys.exit(1)


if __name__ == "__main__":
    main()
