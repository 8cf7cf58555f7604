"""Calibrations stored beside the views that they were computed from, as this takes seconds for many views.

A calibration can always be recomputed: so a damaged file, or one for other views or another comparison, is ignored.

>>> import tempfile
>>> from deixis.perception.recognition.calibration import SHIPPED
>>> folder, views = Path(tempfile.mkdtemp()), {("mug", "v1"), ("mug", "v2")}
>>> write_calibrations(folder, [SHIPPED], views, "spin images")
>>> read_calibrations(folder, views, "spin images") == (SHIPPED,)
True
>>> read_calibrations(folder, {("mug", "v1")}, "spin images"), read_calibrations(folder, views, "colours")
(None, None)
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Sequence, Set
from dataclasses import asdict
from pathlib import Path
from typing import Any

from deixis.memory.perceptual.database.layout import CALIBRATION
from deixis.perception.recognition.calibration import Calibration

ViewPlace = tuple[str, str]
"""Category and id of a view."""

MAX_CHANGED_SHARE = 0.1
"""Maximum share of the views that may be added, removed or moved while a calibration stays valid."""


def write_calibrations(folder: Path, calibrations: Sequence[Calibration], views: Set[ViewPlace], compared: str) -> None:
    """Write calibrations in one step, with the name of the comparison; ignore errors of the disk.

    Parameters
    ----------
    folder
        Folder of the perceptual memory.
    calibrations
        Calibrations to keep.
    views
        Category and id of each view that they were computed from.
    compared
        Name of the comparison.
    """
    content = {"calibrations": [asdict(each) for each in calibrations], "compared": compared, "views": sorted(views)}
    new = folder / (CALIBRATION + ".new")
    with contextlib.suppress(OSError):
        new.write_text(json.dumps({**content, "sum": _sum(content)}), encoding="utf-8")
        new.replace(folder / CALIBRATION)


def read_calibrations(folder: Path, views: Set[ViewPlace], compared: str) -> tuple[Calibration, ...] | None:
    """Return the stored calibrations, or None where they are for other views or another comparison.

    Parameters
    ----------
    folder
        Folder of the perceptual memory.
    views
        Category and id of each view of the memory now.
    compared
        Name of the comparison.

    Returns
    -------
    tuple of Calibration or None
        Calibrations as they were written. They are valid as long as at most ``MAX_CHANGED_SHARE`` of the views have
        changed.
    """
    try:
        content = json.loads((folder / CALIBRATION).read_text(encoding="utf-8"))
        if content.pop("sum") != _sum(content) or content["compared"] != compared:
            return None
        before = {(category, view_id) for category, view_id in content["views"]}
        kept = tuple(Calibration(**each) for each in content["calibrations"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    return kept if len(before ^ views) <= MAX_CHANGED_SHARE * len(views) else None


def _sum(content: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
