"""A calibration kept beside the views that it was worked out from, which takes seconds where there are many of them.

It can always be worked out again: a file that is damaged, or of views that are no longer these, is as good as none.

>>> import tempfile
>>> from deixis.perception.recognition.calibration import SHIPPED
>>> folder, views = Path(tempfile.mkdtemp()), {("mug", "v1"), ("mug", "v2")}
>>> keep_calibration(folder, SHIPPED, views)
>>> kept_calibration(folder, views) == SHIPPED, kept_calibration(folder, {("mug", "v1")}) is None
(True, True)
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Set
from dataclasses import asdict
from pathlib import Path
from typing import Any

from deixis.memory.perceptual.layout import CALIBRATION
from deixis.perception.recognition.calibration import Calibration

ViewPlace = tuple[str, str]
"""A view's category and id."""

FRESH = 0.1
"""A calibration stays while no larger share of the views has come, gone, or changed its category."""


def keep_calibration(folder: Path, calibration: Calibration, views: Set[ViewPlace]) -> None:
    """Writes it, in one step; where that cannot be, nothing is kept."""
    content = {"calibration": asdict(calibration), "views": sorted(views)}
    new = folder / (CALIBRATION + ".new")
    with contextlib.suppress(OSError):
        new.write_text(json.dumps({**content, "sum": _sum(content)}), encoding="utf-8")
        new.replace(folder / CALIBRATION)


def kept_calibration(folder: Path, views: Set[ViewPlace]) -> Calibration | None:
    """What was kept, if it was worked out from about these views."""
    try:
        content = json.loads((folder / CALIBRATION).read_text(encoding="utf-8"))
        if content.pop("sum") != _sum(content):
            return None
        before = {(category, id) for category, id in content["views"]}
        kept = Calibration(**content["calibration"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    return kept if len(before ^ views) <= FRESH * len(views) else None


def _sum(content: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
