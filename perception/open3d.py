"""Import only the compiled part of Open3D; the whole package takes seconds, for plotting and learning."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

from deixis.extras import require

_NAME = "open3d.cpu.pybind"


@cache
def open3d() -> ModuleType:
    """Return ``open3d`` with ``core``, ``geometry``, ``pipelines``, ``t`` and ``utility``.

    A later ``import open3d`` finds the same compiled module and adds the rest, so the drawing functions accept objects
    that were made with this one. A CUDA build selects its compiled part itself and is imported as a whole.

    Raises
    ------
    MissingExtraError
        If Open3D is not installed.
    """
    if _NAME in sys.modules:
        return sys.modules[_NAME]
    require("open3d", "simulating a camera, FPFH and to_open3d()")
    package = importlib.util.find_spec("open3d")
    folders = list(package.submodule_search_locations or ()) if package is not None else []
    library = next((file for folder in folders for file in (Path(folder) / "cpu").glob("pybind*")), None)
    spec = importlib.util.spec_from_file_location(_NAME, library) if library is not None else None
    if spec is None or spec.loader is None or any((Path(folder) / "cuda").is_dir() for folder in folders):
        return importlib.import_module("open3d")
    try:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError:  # it needs a library that the whole package loads first
        return importlib.import_module("open3d")
    sys.modules[_NAME] = module
    return module
