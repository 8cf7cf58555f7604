"""Deixis: words that get their meaning from the scene in front of you.

Reads how a table is laid, looks at a laid table, and says which perceived thing each word means, what the evidence
cannot tell apart, and what follows from the description.

>>> import deixis
>>> script = deixis.read_script(text="napkin on plate; fork left of plate; spoon right of plate")
>>> scene = deixis.read_scene({"objects": [
...     {"id": "o1", "min": [0.00, 0.00], "max": [0.27, 0.27]},
...     {"id": "o2", "min": [0.30, 0.03], "max": [0.34, 0.23]},
...     {"id": "o3", "min": [-0.05, 0.03], "max": [-0.02, 0.23]},
...     {"id": "o4", "min": [0.08, 0.05], "max": [0.18, 0.22]}]})
>>> found = deixis.ground(script, scene)
>>> {name: match.perceived for name, match in found.matches.items()}
{'napkin': 'o4', 'plate': 'o1', 'fork': 'o3', 'spoon': 'o2'}
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from deixis.version import VERSION

if TYPE_CHECKING:
    from deixis.errors import DeixisError
    from deixis.grammar.format import format_script
    from deixis.perception.formats.scene_json import read_scene
    from deixis.session import Session
    from deixis.workflows.ask import ask
    from deixis.workflows.check import check
    from deixis.workflows.ground import ground
    from deixis.workflows.imagine import imagine
    from deixis.workflows.infer import infer
    from deixis.workflows.perceive import perceive, write_scene
    from deixis.workflows.read import read_script
    from deixis.workflows.retrieve import retrieve
    from deixis.workflows.simulate import simulate

__version__ = VERSION
__all__ = [
    "DeixisError",
    "Session",
    "ask",
    "check",
    "format_script",
    "ground",
    "imagine",
    "infer",
    "perceive",
    "read_scene",
    "read_script",
    "retrieve",
    "simulate",
    "write_scene",
]

_HOMES = {
    "DeixisError": "deixis.errors",
    "Session": "deixis.session",
    "ask": "deixis.workflows.ask",
    "check": "deixis.workflows.check",
    "format_script": "deixis.grammar.format",
    "ground": "deixis.workflows.ground",
    "imagine": "deixis.workflows.imagine",
    "infer": "deixis.workflows.infer",
    "perceive": "deixis.workflows.perceive",
    "read_scene": "deixis.perception.formats.scene_json",
    "read_script": "deixis.workflows.read",
    "retrieve": "deixis.workflows.retrieve",
    "simulate": "deixis.workflows.simulate",
    "write_scene": "deixis.workflows.perceive",
}


def __getattr__(name: str) -> Any:
    """Loads what is asked for only then, so that importing one room never pays for another."""
    if name not in _HOMES:
        raise AttributeError(f"module 'deixis' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
