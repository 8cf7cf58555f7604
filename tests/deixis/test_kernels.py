"""Compilation in advance, and what time limits do not count."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import deixis
from deixis.examples_data import example
from deixis.kernels import compile_grounding
from deixis.reasoning.kernel import keeping_machine_code

SOURCE = Path(deixis.__file__).parents[1]

LOADED_LATER = """
import json, sys
from numba.core.dispatcher import Dispatcher
from deixis.deadline import Deadline
from deixis.learning.lessons.scene_evidence import evidence_of
from deixis.workflows.layouts.read import load_scene, read_script
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.kernel import Kernel
from deixis.grammar.formats.networks import read_networks
from deixis.grammar.layout.parser import parse_script
from deixis.kernels import compile_grounding, compile_imagining, compile_inference, compile_solving
from deixis.workflows.layouts.imagine import imagine
from deixis.workflows.layouts.infer import inference_of
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.workflows.reasoning.solve import SolveRequest, solve_text
from deixis.workflows.grounding.ground import ground as ask_ground
from deixis.reasoning.native import NativeKernel

NativeKernel.run = lambda kernel, arguments: (False, None)  # what numba has compiled

CHOICES = parse_script("a left of or above b; b left or right of c; c above or below d; e is not left of a")

def kernels():
    modules = [module for name, module in list(sys.modules.items()) if name.startswith("deixis.")]
    values = [value for module in modules for value in vars(module).values()]
    values += [value.dispatcher for value in values if isinstance(value, Kernel)]
    found = {value for value in values if isinstance(value, Dispatcher)}
    return {(kernel.__module__, kernel.__name__, str(kind)) for kernel in found for kind in kernel.signatures}

script, scene = read_script(sys.argv[1]), load_scene(sys.argv[2])
later = {}
for engine in ("similarity", "scalable", "exact"):
    compile_grounding(engine)
    before = kernels()
    answer = ground(evidence_of(script, scene), engine_named(engine), Deadline.after(60.0))
    assert answer.matches
    later[engine] = sorted(kernels() - before)
    of_ground = sorted({name for _, name, _ in before})
truth = {thing.label: thing.id for thing in load_scene(sys.argv[4]).objects}
commands = {
    "ask": (lambda: None, lambda: ask_ground(script, scene, ask=truth, sizes=False)),
    "infer": (compile_inference, lambda: inference_of(CHOICES)),
    "solve": (
        compile_solving,
        lambda: solve_text(read_networks(sys.argv[3], [calculus("ra")])[0], SolveRequest(False, True)),
    ),
    "imagine": (compile_imagining, lambda: imagine(script)),
}
for name, (ready, run) in commands.items():
    ready()
    before = kernels()
    run()
    later[name] = sorted(kernels() - before)
print(json.dumps([later, of_ground]))
"""


def test_every_kernel_that_commands_call_is_compiled_in_advance() -> None:
    names = ("script1.layout", "place_setting.scene.json", "place_setting.csp", "place_setting.labelled.scene.json")
    files = [str(example(name)) for name in names]
    run = [sys.executable, "-c", LOADED_LATER, *files]
    paths = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run(run, env=environment, capture_output=True, encoding="utf-8", timeout=300, check=True)
    later, ready = json.loads(done.stdout)
    assert later == {name: [] for name in ("similarity", "scalable", "exact", "ask", "infer", "solve", "imagine")}
    assert {"search", "sample", "_search"} <= set(ready)  # the proof, the chains, and the sum


RUN = """
import json, sys
from contextlib import redirect_stdout
from io import StringIO
from deixis.cli.app import main
from deixis.reasoning.native import NativeKernel
way, commands = json.loads(sys.argv[1])
if way == "numba":
    NativeKernel.run = lambda kernel, arguments: (False, None)
printed, codes = StringIO(), []
for command in commands:
    sys.argv = ["deixis", *command]
    try:
        with redirect_stdout(printed):
            main()
        codes.append(0)
    except SystemExit as end:
        codes.append(end.code)
print(json.dumps(["numba" in sys.modules, codes, printed.getvalue()]))
"""


def test_small_scenes_are_grounded_without_numba() -> None:
    with keeping_machine_code():
        compile_grounding("exact")
    dinner, seen, second = map(example, ("formal_dinner.layout", "place_setting.scene.json", "second_table.scene.json"))
    commands = [
        ["ground", str(dinner), str(seen), "--time-limit", "60"],
        ["check", str(dinner), str(second), "--time-limit", "60"],
    ]
    paths = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    found = []
    for way in ("kept", "numba"):
        run = [sys.executable, "-c", RUN, json.dumps([way, commands])]
        done = subprocess.run(run, env=environment, capture_output=True, text=True, timeout=300, check=True)
        loaded, codes, printed = json.loads(done.stdout)
        found.append((loaded, codes, re.sub(r"\d+\.\d+ s\b", "", printed)))
    assert [loaded for loaded, *_ in found] == [False, True]
    assert found[0][1:] == found[1][1:]
