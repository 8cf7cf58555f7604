"""Measure the cost of each command on a small job: processor and wall time of whole processes.

    python benchmarks/bench_startup.py            # every command, medians of 7 runs in turn
    python benchmarks/bench_startup.py parse infer --runs 15

Processor time is that of the process and its children (user and system); the last column relates it to that of
``deixis --version``. Before it is measured, each job runs once,
so that compiled code and bytecode are on disk, as they are after an installation and ``python -m deixis.kernels``.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from records import command_line, figure, recorded

from deixis.examples_data import example
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import write_cloud

TARGET = 0.3
"""Maximum processor seconds on a quiet machine, for use in the loop of a linter."""

COMPILED_TARGET = 0.6
"""Maximum processor seconds of commands that ground, whose loops are loaded compiled."""

DINNER, SETTING = example("formal_dinner.layout"), example("place_setting.scene.json")
LABELLED, SECOND = example("place_setting.labelled.scene.json"), example("second_table.scene.json")
BESIDE = {"python -c pass": ["-c", "pass"], "python -c 'import numpy'": ["-c", "import numpy"]}
COMMANDS = {
    "--version": "--version",
    "--help": "--help",
    "parse, 12 objects": f"parse {DINNER}",
    "fmt, 12 objects": f"fmt {DINNER}",
    "infer, 12 objects": f"infer {DINNER}",
    "infer, 12 objects with choices": "infer choices.layout",
    "infer, 50 objects": "infer row.layout",
    "lint, 12 objects": f"lint {DINNER}",
    "read, 4 sentences": "read table.txt",
    "refer": f"refer knife {SECOND}",
    "relation": "relation left",
    "relate, 5 points": "relate five.scene.json --calculus ra",
    "solve, 5 points": "solve five.csp --calculus point",
    "show": "show formal_dinner",
    "query": "query ASK{?s?p?o}",
    "validate": "validate kitchen.ttl",
    "memory stats": "memory stats",
    "category list": "category list",
    "time": f"time {example('serving.fluents.json')}",
    "ground, 12 objects": f"ground {DINNER} {SETTING}",
    "check, 12 objects": f"check formal_dinner {SECOND}",
    "ground, a text": f"ground table.txt {SECOND}",
    "check, a text": f"check table.txt {SECOND}",
    "learn, 12 objects": f"learn {DINNER} {LABELLED} --memory learned-{{run}}",
    "retrieve": f"retrieve {SECOND}",
    "learn-relation, 12 objects": f"learn-relation {DINNER} {LABELLED} -o learned.ttl",
    "imagine, 12 objects": f"imagine {DINNER}",
    "memory verify": "memory verify",
    "perceive, 3600 points": "perceive block.pcd",
    "teach": "teach block.scene.json o1 block --memory taught-{run}",
    "recognise": "recognise block.scene.json",
    "reason, rules": "reason kitchen.ttl --engine rl",
    "reason, HermiT": "reason kitchen.ttl --engine hermit",
    "simulate, 3 things": "simulate --random 3",
}
"""A small typical job of every command except those that ask, tell a story, run experiments or serve an editor."""

TEXT = """The dinner plate is in the middle. The fork is to the left of the plate, and the knife is to its right.
The glass is above the knife. There is a napkin on the plate.
"""

GROUNDING = ("ground", "check", "learn", "retrieve", "learn-relation")


class Cost(NamedTuple):
    """The time of a process, in seconds, and its exit code."""

    processor: float
    wall: float
    code: int


def cost(arguments: Sequence[str], folder: Path) -> Cost:
    """Run Python as a process of its own, and return its cost."""
    started = time.perf_counter()
    environment = {
        **os.environ,
        "DEIXIS_MEMORY": str(folder / "memory"),
        "PYTHONPYCACHEPREFIX": str(folder / "bytecode"),
    }
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    with subprocess.Popen(
        [sys.executable, *arguments],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return Cost(used.ru_utime + used.ru_stime, time.perf_counter() - started, process.returncode)


def deixis(command: str, run: int = 0) -> list[str]:
    return ["-m", "deixis.cli.app", *command.replace("{run}", str(run)).split()]


def prepare(folder: Path) -> None:
    """Write the files that the jobs read, and learn the layout that they look up."""
    row = [f"thing_{i} left of thing_{i + 1}" for i in range(49)]
    (folder / "row.layout").write_text("\n".join(row) + "\n", encoding="utf-8")
    choices = [*row[:11], "thing_0 left of or above thing_5", "thing_3 is not above thing_7"]
    (folder / "choices.layout").write_text("\n".join(choices) + "\n", encoding="utf-8")
    points = ", ".join(f'{{"id": "p{i}", "min": [{i}, {i % 2}], "max": [{i}.1, {i % 2}.1]}}' for i in range(5))
    (folder / "five.scene.json").write_text(f'{{"objects": [{points}]}}', encoding="utf-8")
    between = "\n".join(f"{i} {i + 1} ( < = )" for i in range(4))
    (folder / "five.csp").write_text(f"4 #\n{between}\n.\n", encoding="utf-8")
    (folder / "kitchen.ttl").write_text(
        "@prefix owl: <http://www.w3.org/2002/07/owl#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n"
        "@prefix ex: <urn:ex:> . ex:Cup rdfs:subClassOf ex:Vessel . ex:Vessel a owl:Class . ex:c a ex:Cup .\n",
        encoding="utf-8",
    )
    (folder / "table.txt").write_text(TEXT, encoding="utf-8")
    x, y = (axis.ravel() for axis in np.mgrid[-0.3:0.3:0.01, 0.5:1.1:0.01])
    block = (abs(x) < 0.05) & (abs(y - 0.8) < 0.05)
    seen = np.stack([x, y, np.where(block, -0.64, -0.7)], axis=1).astype(np.float32)
    write_cloud(folder / "block.pcd", PointCloud(seen))
    for command in (
        f"learn {DINNER} {LABELLED}",
        "perceive block.pcd -o block.scene.json",
        "teach block.scene.json o1 block",
    ):
        if cost(deixis(command), folder).code != 0:
            raise SystemExit(f"failed: deixis {command}")


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("names", nargs="*", help="commands; all by default")
    parser.add_argument("--runs", type=int, default=7)
    with recorded(parser) as options:
        chosen = {
            name: command
            for name, command in COMMANDS.items()
            if not options.names or command.split()[0] in (*options.names, "--version")
        }
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            prepare(folder)
            costs: dict[str, list[Cost]] = {name: [] for name in (*BESIDE, *chosen)}
            for run in range(options.runs + 1):
                for name in costs:
                    found = cost(BESIDE[name] if name in BESIDE else deixis(chosen[name], run), folder)
                    if found.code not in (0, 1, 3):
                        raise SystemExit(f"{name}: exit code {found.code}")
                    if run > 0:
                        costs[name].append(found)
        version = statistics.median(each.processor for each in costs["--version"])
        print(f"{'':32} processor      wall  times --version   (medians of {options.runs} runs, s)")
        for name, taken in costs.items():
            processor, wall = (statistics.median(values) for values in list(zip(*taken, strict=True))[:2])
            figure(name, processor / version, "times `deixis --version`")
            target = COMPILED_TARGET if name.split(",")[0] in GROUNDING else TARGET
            above = "" if processor <= target else f"above {target}"
            print(f"{name:32} {processor:9.3f} {wall:9.3f} {processor / version:10.1f}         {above}")


if __name__ == "__main__":
    main()
