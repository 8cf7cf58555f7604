"""A calibration kept beside the views that it was worked out from, which takes seconds where there are many of them.

It can always be worked out again: a file that is damaged, of views that are no longer these, or of views that were
compared in another way, is as good as none.

>>> import tempfile
>>> from deixis.perception.recognition.calibration import SHIPPED
>>> folder, views = Path(tempfile.mkdtemp()), {("mug", "v1"), ("mug", "v2")}
>>> write_calibration(folder, SHIPPED, views, "spin images")
>>> read_calibration(folder, views, "spin images") == SHIPPED
True
>>> read_calibration(folder, {("mug", "v1")}, "spin images"), read_calibration(folder, views, "colours")
(None, None)
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

MAX_CHANGED_SHARE = 0.1
"""Maximum share of the views that may come, go or change their category while a calibration stays valid."""


def write_calibration(folder: Path, calibration: Calibration, views: Set[ViewPlace], compared: str) -> None:
    """Write it, in one step, with how views were compared; where that cannot be, nothing is kept."""
    content = {"calibration": asdict(calibration), "compared": compared, "views": sorted(views)}
    new = folder / (CALIBRATION + ".new")
    with contextlib.suppress(OSError):
        new.write_text(json.dumps({**content, "sum": _sum(content)}), encoding="utf-8")
        new.replace(folder / CALIBRATION)


def read_calibration(folder: Path, views: Set[ViewPlace], compared: str) -> Calibration | None:
    """Return what was kept, if it was worked out from about these views, compared in this way."""
    try:
        content = json.loads((folder / CALIBRATION).read_text(encoding="utf-8"))
        if content.pop("sum") != _sum(content) or content["compared"] != compared:
            return None
        before = {(category, view_id) for category, view_id in content["views"]}
        kept = Calibration(**content["calibration"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    return kept if len(before ^ views) <= MAX_CHANGED_SHARE * len(views) else None


def _sum(content: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
