"""Compare pictures with the stored ones of ``tests/deixis/plots/stored``.

After a change that is meant, look at the new pictures and store them::

    DEIXIS_STORE_PICTURES=1 python -m pytest tests/deixis/plots tests/deixis/experiments -k stored
"""

from __future__ import annotations

import os
from pathlib import Path

from source_tree import ROOT

STORED = ROOT / "tests" / "deixis" / "plots" / "stored"
CHARTS = ("figure6", "scoreboard", "open_ended")
"""Stored pictures that the tests of the experiments compare."""

TOLERANCE = 4.0
"""Root mean square difference of grey values, 0 to 255, that other versions of fonts and renderers may make."""

MAX_SIDE = 800
"""Length in pixels of the longer side of a stored picture; a larger one is reduced."""


def assert_as_stored(name: str, drawn: Path) -> None:
    """Assert that a picture is the stored one of a name, except for small differences of fonts."""
    from matplotlib.testing.compare import compare_images
    from PIL import Image

    stored, reduced = STORED / f"{name}.png", drawn.with_name(f"{name}-reduced.png")
    with Image.open(drawn) as picture:
        small = picture.convert("RGB")
    small.thumbnail((MAX_SIDE, MAX_SIDE))
    small.save(reduced)
    if os.environ.get("DEIXIS_STORE_PICTURES"):
        STORED.mkdir(exist_ok=True)
        stored.write_bytes(reduced.read_bytes())
    assert compare_images(str(stored), str(reduced), TOLERANCE) is None
