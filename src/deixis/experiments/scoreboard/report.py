"""The scoreboard as plain data for JSON; what is not known is null."""

from __future__ import annotations

import math
from dataclasses import asdict, fields
from typing import Any

from deixis.experiments.scoreboard.board import MEASURES, Board, Comparison, median_seconds
from deixis.experiments.scoreboard.cases import Group, Setting
from deixis.experiments.scoreboard.run import Scoreboard
from deixis.experiments.scoreboard.text import verdict


def to_dict(found: Scoreboard) -> dict[str, Any]:
    """Everything that the text says, and the means of every single setting."""
    plan = found.plan
    comparisons = {measure: found.main.comparisons(measure, plan.seed) for measure in ("right", "grouped")}
    data = {
        "seed": plan.seed,
        "time_limit": plan.time_limit,
        "cases": {str(size): plan.count(size) for size in plan.sizes},
        "orders": plan.orders,
        "photographs": plan.photographs is not None,
        "engines": {one.name: one.settings for one in found.main.contestants},
        "skipped": list(found.skipped),
        "board": _board(found.main),
        "ablations": _board(found.ablations),
        "limits": [_limit(asdict(one)) for one in found.limits],
        "calibration": {name: asdict(one) for name, one in found.calibrations().items()},
        "comparisons": [_comparison(one) for some in comparisons.values() for one in some],
        "verdicts": {measure: verdict(some) for measure, some in comparisons.items()},
    }
    return {key: _known(value) for key, value in data.items()}


def _board(board: Board) -> dict[str, Any]:
    settings = sorted({score.setting for score in board.scores})
    return {
        "groups": [_place(board, name, group) for group in board.groups for name in _names(board, group)],
        "settings": [_place(board, name, setting) for setting in settings for name in _names(board, setting)],
    }


def _names(board: Board, place: Group | Setting) -> list[str]:
    return [one.name for one in board.contestants if board.of(one.name, place)]


def _place(board: Board, name: str, place: Group | Setting) -> dict[str, Any]:
    scores = board.of(name, place)
    entry = {field.name: getattr(place, field.name) for field in fields(place)}
    entry |= {"engine": name, "cases": len(board.by_unit(name, place, "right"))}
    entry |= {measure: asdict(board.mean(name, place, measure)) for measure in MEASURES}
    entry["proved"] = sum(score.proved for score in scores) / len(scores)
    entry["seconds"] = median_seconds(scores)
    return entry


def _limit(entry: dict[str, Any]) -> dict[str, Any]:
    setting: dict[str, Any] = entry.pop("setting")
    return setting | entry


def _comparison(one: Comparison) -> dict[str, Any]:
    entry = asdict(one)
    group: dict[str, Any] = entry.pop("group")
    return group | entry | {"verdict": one.verdict}


def _known(value: Any) -> Any:
    """The same with null for every number that is none."""
    if isinstance(value, dict):
        return {key: _known(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_known(inner) for inner in value]
    return None if isinstance(value, float) and math.isnan(value) else value
