"""Report the scoreboard as JSON and as text of at most 120 columns."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, fields
from textwrap import wrap
from typing import Any

from deixis.experiments.scoreboard.board import ALPHA, MEASURES, Board, EngineComparison, median_seconds
from deixis.experiments.scoreboard.cases import PHOTOGRAPHS, Group, Setting
from deixis.experiments.scoreboard.contestants import DEFAULT
from deixis.experiments.scoreboard.run import Scoreboard


def to_dict(found: Scoreboard) -> dict[str, Any]:
    """Return the contents of the text, and the means of every single setting.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    dict
        Data for JSON; an unknown figure (nan) is None.
    """
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
        "board": _board_json(found.main),
        "ablations": _board_json(found.ablations),
        "limits": [_flat(asdict(one), "setting") for one in found.limits],
        "calibration": {name: asdict(one) for name, one in found.calibrations().items()},
        "comparisons": [
            _flat(asdict(one), "group") | {"verdict": one.verdict} for some in comparisons.values() for one in some
        ],
        "verdicts": {measure: verdict(some) for measure, some in comparisons.items()},
    }
    return {key: _known(value) for key, value in data.items()}


def rows(found: Scoreboard) -> list[dict[str, Any]]:
    """Return a row for each engine in each group of tables.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    list of dict
        Number of ``objects``, share of facts that are ``off``, ``engine``, number of ``cases``, the mean of each
        measure, and the median ``seconds``.
    """
    entries = _board_json(found.main)["groups"]
    return [{key: value["mean"] if key in MEASURES else value for key, value in entry.items()} for entry in entries]


def _board_json(board: Board) -> dict[str, Any]:
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


def _flat(entry: dict[str, Any], part: str) -> dict[str, Any]:
    """Return the fields of one part of an entry first, then the other fields."""
    inner: dict[str, Any] = entry.pop(part)
    return inner | entry


def _known(value: Any) -> Any:
    """Return a value with every nan replaced by null."""
    if isinstance(value, dict):
        return {key: _known(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_known(inner) for inner in value]
    return None if isinstance(value, float) and math.isnan(value) else value


WIDTH = 120
NAME = 13
ACROSS = 6
"""Number of comparisons side by side."""


def lines(found: Scoreboard) -> list[str]:
    """Return the lines of the text report, from the plan to the conclusions.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    list of str
        Lines of the plan, the boards, the limits, the calibration and the tests of significance.
    """
    return [
        *_head(found),
        "",
        "Shares with 95 % t intervals over cases. right: objects given their own thing, or left out where they are",
        "missing; grouped: the same where interchangeable objects may be exchanged; fact, value: satisfied facts and",
        "log-likelihood over the best found by any engine on the case; time: median from evidence to the full answer;",
        "proof: share of the cases on which the map was proved the likeliest.",
        *_board(found.main),
        "",
        "Ablations: descriptions say what kind of thing each object is, so that sizes count. On photographs, 'learned",
        "words' and 'learned, all' (words and sizes) are cross-validated: no case is grounded by its own data.",
        *_board(found.ablations),
        "",
        *_limits(found),
        "",
        *_calibration(found),
        "",
        *_significance(found),
    ]


def _head(found: Scoreboard) -> Iterator[str]:
    plan = found.plan
    yield f"Scoreboard, seed {plan.seed}, {plan.time_limit:g} s for a case"
    counts = ", ".join(f"{plan.count(size)} of {size}" for size in plan.sizes)
    yield f"Tables of each setting, by objects: {counts}."
    facts_each = ", ".join(f"{value:g}" for value in plan.facts_each)
    off = ", ".join(f"{100 * value:.0f}" for value in plan.off) + " %"
    yield (f"Settings: {facts_each} facts per object; {off} of them wrong; no changes, or a tenth missing and extra.")
    if plan.photographs is not None:
        units = len({score.unit for score in found.main.scores if score.setting.objects == PHOTOGRAPHS})
        yield f"{units} photographs, each in {plan.orders} node order{'s' if plan.orders > 1 else ''}."
    yield ""
    yield from (f"  {one.name:<{NAME}} {one.settings}" for one in found.main.contestants)
    yield from (f"  skipped: {note}" for note in found.skipped)


def _board(board: Board) -> Iterator[str]:
    """Yield a block for every size, a row for every contestant, four columns for every noise."""
    sizes = list(dict.fromkeys(group.objects for group in board.groups))
    for size in sizes:
        columns = [group for group in board.groups if group.objects == size]
        counts = [board.mean(DEFAULT, group, "right").count for group in columns]
        if size == PHOTOGRAPHS:
            head, titles = "photographs", [f"{count} images" for count in counts]
        else:
            head = f"{size} objects"
            titles = [f"{100 * group.off:.0f} % off, {n} tables" for group, n in zip(columns, counts, strict=True)]
        yield ""
        yield (f"{head:<{NAME}}" + "".join(f" {title:<30}" for title in titles)).rstrip()
        yield f"{'':<{NAME}}" + f" {'right':<9} {'grouped':<9} fact value" * len(columns) + "    time proof"
        for one in board.contestants:
            if any(board.of(one.name, group) for group in columns):
                yield _row(board, one.name, columns)


def _row(board: Board, name: str, columns: Sequence[Group]) -> str:
    cells = ""
    for group in columns:
        right, grouped, facts, value = (board.mean(name, group, m) for m in ("right", "grouped", "facts", "value"))
        cells += f" {right!s:<9} {grouped!s:<9} {facts.mean:.2f} {value.mean:5.2f}"
    scores = [score for group in columns for score in board.of(name, group)]
    proved = sum(score.proved for score in scores) / len(scores)
    seconds = median_seconds(scores)
    taken = f"{1e3 * seconds:.1f} ms" if seconds < 0.0999 else f"{seconds:.2f} s"
    return f"{name:<{NAME}}{cells} {taken:>7} {proved:5.2f}"


def _limits(found: Scoreboard) -> Iterator[str]:
    if not found.limits:
        return
    yield "The exact Bayes limit of the share right, nothing missing or extra: given the words of the facts, and given"
    yield "also how the generator draws pairs. Positive 'short': the default engine is below the first limit."
    yield f"  objects  facts each   off  tables  {DEFAULT:<10} limit      short         pairs known  most maps   listed"
    for one in found.limits:
        place, count = one.setting, one.right.count
        listed, short = f"{count - one.incomplete} of {count}", f"{one.short.mean:+.3f}±{one.short.half:.3f}"
        yield (
            f"  {place.objects:7}  {place.facts_each:10g}  {100 * place.off:2.0f} %  {count:6}  {one.right!s:<9}"
            f"  {one.words!s:<9}  {short}  {one.words_and_pairs!s:<11}  {one.maps:9}  {listed:>8}"
        )


def _calibration(found: Scoreboard) -> Iterator[str]:
    yield "Calibration of the default engine's matches: expected calibration error, the share decided and its"
    yield "precision, and the share right (n) by tenths of the stated probability."
    calibrations = found.calibrations()
    yield f"  {'':<18}  matches  error  decided  precision"
    for name, one in calibrations.items():
        yield f"  {name:<18}  {one.count:7}  {one.error:5.3f}  {one.decided:7.2f}  {one.precision:9.3f}"
    yield f"  {'':<18}" + "".join(f"{f'0.{tenth}':>10}" for tenth in range(10))
    for name, one in calibrations.items():
        cells = (f"{b.right:.2f}({_short(b.count)})" if b.count else "-" for b in one.bins)
        yield f"  {name:<18}" + "".join(f"{cell:>10}" for cell in cells)


def _short(count: int) -> str:
    return str(count) if count < 1000 else f"{count / 1000:.0f}k"


def _significance(found: Scoreboard) -> Iterator[str]:
    plan = found.plan
    for measure, title in (("right", "share right"), ("grouped", "share right up to interchangeability")):
        comparisons = found.main.comparisons(measure, plan.seed)
        yield f"{DEFAULT} less each other, {title}: mean difference, p of a paired permutation test"
        yield f"over the cases, and + or - where {DEFAULT} is significantly better or worse (at {ALPHA:g}, by Holm's"
        yield "correction for all of these comparisons)."
        cells = {(one.group, one.other): one for one in comparisons}
        others = [one.name for one in found.main.contestants[1:]]
        for start in range(0, len(others), ACROSS):
            shown = others[start : start + ACROSS]
            yield f"  {'':<22}" + "".join(f"{name:>15}" for name in shown)
            for group in found.main.groups:
                row = "".join(f"{_cell(cells.get((group, name))):>15}" for name in shown)
                yield f"  {group!s:<22}{row}".rstrip()
        yield from wrap(verdict(comparisons), WIDTH)
        yield ""


def _cell(one: EngineComparison | None) -> str:
    if one is None or math.isnan(one.difference.mean):
        return "-"
    mark = {"better": "+", "worse": "-"}.get(one.verdict, " ")
    return (
        f"{one.difference.mean:+.2f} {one.p:.3f}{mark}".replace(" 0.", " .").replace("+0.", "+.").replace("-0.", "-.")
    )


def verdict(comparisons: Sequence[EngineComparison]) -> str:
    """Return a sentence: where the default is significantly worse than another, or that it is nowhere.

    Parameters
    ----------
    comparisons
        Comparisons of the default with the others by one measure.

    Returns
    -------
    str
        The contestants that are better, each with its group and the mean difference; or the number of comparisons and
        the smallest uncorrected p.
    """
    worse = [one for one in comparisons if one.verdict == "worse"]
    if worse:
        where = "; ".join(f"{one.other} ({one.group}, {one.difference.mean:+.2f})" for one in worse)
        return f"{DEFAULT} is significantly worse than: {where}."
    behind = [one for one in comparisons if one.difference.mean < 0]
    least = min((one.p for one in behind), default=1.0)
    return (
        f"{DEFAULT} is not significantly worse than any other at any size or noise ({len(comparisons)} comparisons, "
        f"behind in {len(behind)}, of which the smallest uncorrected p is {least:.3f})."
    )
