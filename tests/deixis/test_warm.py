"""What is compiled, or loaded compiled, before the time limit of a grounding begins."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import deixis
from deixis.examples_data import example

SOURCE = Path(deixis.__file__).parents[1]

LOADED_LATER = """
import json, sys
from numba.core.dispatcher import Dispatcher
from deixis.session import evidence_of, load_scene, read_script
from deixis.reasoning.engines import engine_named
from deixis.reasoning.grounding import ground
from deixis.warm import ready_to_ground

def kernels():
    modules = [module for name, module in list(sys.modules.items()) if name.startswith("deixis.")]
    found = {value for module in modules for value in vars(module).values() if isinstance(value, Dispatcher)}
    return {(kernel.__module__, kernel.__name__, str(kind)) for kernel in found for kind in kernel.signatures}

script, scene = read_script(sys.argv[1]), load_scene(sys.argv[2])
later = {}
for engine in ("similarity", "scalable", "exact"):
    ready_to_ground(engine)
    before = kernels()
    answer = ground(evidence_of(script, scene), engine_named(engine), 60.0)
    assert answer.matches
    later[engine] = sorted(kernels() - before)
print(json.dumps([later, sorted({name for _, name, _ in before})]))
"""


def test_no_kernel_is_compiled_or_loaded_once_the_clock_runs() -> None:
    files = [str(example("script1.layout")), str(example("place_setting.scene.json"))]
    run = [sys.executable, "-c", LOADED_LATER, *files]
    paths = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run(run, env=environment, capture_output=True, encoding="utf-8", timeout=300, check=True)
    later, ready = json.loads(done.stdout)
    assert later == {"similarity": [], "scalable": [], "exact": []}
    assert {"search", "sample", "_search"} <= set(ready)  # the proof, the chains, and the sum
