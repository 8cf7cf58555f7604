"""The findings as plain data for JSON."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from deixis.experiments.open_ended.run import Findings, OpenEnded, Taught, Ways
from deixis.experiments.open_ended.shown import DESCRIBERS
from deixis.experiments.open_ended.text import MEASURES


def to_dict(found: OpenEnded) -> dict[str, Any]:
    """The measures of every course, and of every split of single views."""
    plan = found.plan
    return {
        "seeds": list(plan.seeds()),
        "teaching": asdict(plan.teaching),
        "descriptors": [repr(describer) for describer in DESCRIBERS],
        "skipped": list(found.skipped),
        "sets": [_set(one) for one in found.findings],
    }


def _set(one: Findings) -> dict[str, Any]:
    return {
        "name": one.name,
        "categories": list(one.kinds),
        "things": one.things,
        "views": one.views,
        "courses": [_course(taught) for taught in one.taught],
        "single_views": _single_views(one.nearest),
        "single_views_kept_back": _single_views(one.kept_back),
    }


def _single_views(found: Ways) -> list[dict[str, Any]]:
    return [
        {"split": title, "by": way, "accuracy": [s.accuracy for s in scores], "auroc": [s.auroc for s in scores]}
        for (title, way), scores in found.items()
    ]


def _course(taught: Taught) -> dict[str, Any]:
    course = taught.course
    return {
        "learner": taught.contestant,
        "order": list(course.order),
        "introduced_after": list(course.introduced),
        "ended": course.end.value,
        **{name: measure(taught) for name, measure in MEASURES.items()},
    }
