"""Report the findings of the apprentice: a table with intervals, and JSON."""

from __future__ import annotations

from typing import Any

from deixis.experiments.apprentice.run import Apprentice, figures, kinds_of
from deixis.experiments.apprentice.scoring import Count, total

TITLES = {
    "new_things_right": "new things that the words single out, learned right",
    "names_right": "things on later tables, named right",
    "mistake_precision": "reported mistakes that are true",
    "mistake_recall": "mistakes that were found",
    "layouts_right": "layouts named right",
}


def to_dict(found: Apprentice) -> dict[str, Any]:
    """Return the findings as JSON types.

    Parameters
    ----------
    found
        The findings.

    Returns
    -------
    dict
        Shares, their counts and intervals, questions, and figures by kind of mistake.
    """
    plan, scores = found.plan, found.tables
    counts = figures(found)
    return {
        **{key: _rounded(count.share) for key, count in counts.items()},
        "questions_per_table": round(found.questions / plan.steps, 4) if plan.steps else 0.0,
        "tables": plan.tables,
        "first_tables": len(found.lessons),
        "seed": plan.seed,
        "noise": plan.noise,
        "counts": {key: _count(count) for key, count in counts.items()},
        "learned": _count(total(one.learned for one in found.lessons)),
        "recognised_by_looks": _count(total(one.recognised for one in scores)),
        "detected": _count(total(one.detected for one in scores)),
        "mistakes": {
            kind: {"precision": _count(precision), "recall": _count(recall)}
            for kind, (precision, recall) in kinds_of(scores).items()
        },
    }


def rows(found: Apprentice) -> list[dict[str, Any]]:
    """Return a row for each share that the run measures.

    Parameters
    ----------
    found
        The findings.

    Returns
    -------
    list of dict
        Name of the figure, ``share``, ends of its interval of 95 %, and the counts ``right`` and ``of``.
    """
    table = []
    for name, number in figures(found).items():
        low, high = number.interval or (None, None)
        share = {"share": number.share, "low": low, "high": high}
        table.append({"figure": name, **share, "right": number.right, "of": number.of})
    return table


def _rounded(share: float | None) -> float | None:
    return None if share is None else round(share, 4)


def _count(count: Count) -> dict[str, Any]:
    interval = count.interval
    return {
        "right": count.right,
        "of": count.of,
        "interval": None if interval is None else [round(end, 4) for end in interval],
    }


def lines(found: Apprentice) -> list[str]:
    """Return the lines of the text report.

    Parameters
    ----------
    found
        The findings.

    Returns
    -------
    list of str
        A table of the figures with intervals of 95 %.
    """
    plan, scores = found.plan, found.tables
    counts = figures(found)
    head = (
        f"apprentice: {len(found.lessons)} first tables of {len(plan.layouts)} layouts, {plan.tables} further tables, "
        f"seed {plan.seed}, depth noise {plan.noise:g}"
    )
    rows = [head, "", f"{'':52} share  interval of 95 %    count"]
    rows += [_row(TITLES[key], count) for key, count in counts.items()]
    rows.append(_row("things on later tables, named right by looks alone", total(one.recognised for one in scores)))
    rows.append(_row("things on later tables, detected", total(one.detected for one in scores)))
    rows.append(f"{'questions per table':52} {found.questions / max(plan.steps, 1):5.2f}")
    rows += ["", "mistakes        precision  recall  reported  made"]
    for kind, (precision, recall) in kinds_of(scores).items():
        rows.append(f"{kind:14}  {_share(precision):>9}  {_share(recall):>6}  {precision.of:8}  {recall.of:4}")
    return rows


def _row(title: str, count: Count) -> str:
    interval = count.interval
    bounds = "" if interval is None else f"{interval[0]:.3f} to {interval[1]:.3f}"
    return f"{title:52} {_share(count):>5}  {bounds:16}  {count.right} of {count.of}"


def _share(count: Count) -> str:
    return "-" if count.share is None else f"{count.share:.3f}"
