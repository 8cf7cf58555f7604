"""A calibration kept beside the views that it was worked out from, which takes seconds where there are many of them.

It can always be worked out again: a file that is damaged, of views that are no longer these, or of views that were
compared in another way, is as good as none.

>>> import tempfile
>>> from deixis.perception.recognition.calibration import SHIPPED
>>> folder, views = Path(tempfile.mkdtemp()), {("mug", "v1"), ("mug", "v2")}
>>> keep_calibration(folder, SHIPPED, views, "spin images")
>>> kept_calibration(folder, views, "spin images") == SHIPPED
True
>>> kept_calibration(folder, {("mug", "v1")}, "spin images"), kept_calibration(folder, views, "colours")
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

FRESH = 0.1
"""A calibration stays while no larger share of the views has come, gone, or changed its category."""


def keep_calibration(folder: Path, calibration: Calibration, views: Set[ViewPlace], compared: str) -> None:
    """Writes it, in one step, with how views were compared; where that cannot be, nothing is kept."""
    content = {"calibration": asdict(calibration), "compared": compared, "views": sorted(views)}
    new = folder / (CALIBRATION + ".new")
    with contextlib.suppress(OSError):
        new.write_text(json.dumps({**content, "sum": _sum(content)}), encoding="utf-8")
        new.replace(folder / CALIBRATION)


def kept_calibration(folder: Path, views: Set[ViewPlace], compared: str) -> Calibration | None:
    """What was kept, if it was worked out from about these views, compared in this way."""
    try:
        content = json.loads((folder / CALIBRATION).read_text(encoding="utf-8"))
        if content.pop("sum") != _sum(content) or content["compared"] != compared:
            return None
        before = {(category, id) for category, id in content["views"]}
        kept = Calibration(**content["calibration"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    return kept if len(before ^ views) <= FRESH * len(views) else None


def _sum(content: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
