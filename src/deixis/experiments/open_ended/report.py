"""Report the findings of open-ended learning as JSON and as text of at most 120 columns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from textwrap import wrap
from typing import Any

import numpy as np

from deixis.experiments.open_ended.described_views import DESCRIBERS
from deixis.experiments.open_ended.run import NAMING_METHODS, SPLITS, CourseResult, Findings, OpenEnded, Ways
from deixis.perception.recognition.learners.teaching import End


def to_dict(found: OpenEnded) -> dict[str, Any]:
    """Return the measures of every course, and of every split of single views.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    dict
        Data for JSON with the plan and a list ``sets``, one entry for each set of views.
    """
    plan = found.plan
    return {
        "seeds": list(plan.seeds()),
        "teaching": asdict(plan.teaching),
        "descriptors": [repr(describer) for describer in DESCRIBERS],
        "skipped": list(found.skipped),
        "sets": [
            {
                "name": one.name,
                "categories": list(one.kinds),
                "things": one.things,
                "views": one.views,
                "courses": [_course(taught) for taught in one.taught],
                "single_views": _single_views_json(one.nearest),
                "single_views_kept_back": _single_views_json(one.kept_back),
            }
            for one in found.findings
        ],
    }


def rows(found: OpenEnded) -> list[dict[str, Any]]:
    """Return a row for each course.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    list of dict
        Set of views, learner, how the course ended, and its measures.
    """
    return [
        {"set": one.name, "learner": taught.contestant, "ended": taught.course.end.value}
        | {name: measure(taught) for name, measure in MEASURES.items()}
        for one in found.findings
        for taught in one.taught
    ]


def _single_views_json(found: Ways) -> list[dict[str, Any]]:
    return [
        {"split": title, "by": way, "accuracy": [s.accuracy for s in scores], "auroc": [s.auroc for s in scores]}
        for (title, way), scores in found.items()
    ]


def _course(taught: CourseResult) -> dict[str, Any]:
    course = taught.course
    return {
        "learner": taught.contestant,
        "order": list(course.order),
        "introduced_after": list(course.introduced),
        "ended": course.end.value,
        **{name: measure(taught) for name, measure in MEASURES.items()},
    }


NAME = 21
MEASURES: dict[str, Callable[[CourseResult], float]] = {
    "QCI": lambda one: one.course.iterations,
    "ALC": lambda one: one.course.learned,
    "AIC": lambda one: one.course.instances,
    "GCA": lambda one: one.course.global_accuracy,
    "APA": lambda one: one.course.protocol_accuracy,
    "AUROC": lambda one: one.course.unknown_auroc,
    "new": lambda one: one.afterwards,
}


def lines(found: OpenEnded) -> list[str]:
    """Return the lines of the text report, from the plan to the figures.

    Parameters
    ----------
    found
        Results of the experiment.

    Returns
    -------
    list of str
        Lines without spaces at their ends.
    """
    return [line.rstrip() for line in [*_head(found), *(line for one in found.findings for line in _set(found, one))]]


def _head(found: OpenEnded) -> Iterator[str]:
    plan, teaching = found.plan, found.plan.teaching
    seeds = plan.seeds()
    yield f"Open-ended learning in {plan.orders} random orders, seeds {seeds[0]} to {seeds[-1]}"
    yield (
        f"Teacher: {teaching.first} views introduce a category; the next one follows when the accuracy over the last"
        f" {teaching.window}n answers is above {teaching.threshold:g};"
    )
    yield f"patience {teaching.patience} answers. Half of the things of a category are taught, the others are new."
    for describer in DESCRIBERS:
        yield from wrap(repr(describer), 116, initial_indent="  ", subsequent_indent="    ")
    yield from (f"  skipped: {note}" for note in found.skipped)
    yield ""
    yield "Means and standard deviations over orders. QCI: question and correction iterations; ALC: categories learned;"
    yield "AIC: instances stored per category; GCA: share of right answers; APA: mean accuracy in the teacher's window;"
    yield "AUROC: how well the learner's doubt separates views of the next category from those of known categories;"
    yield "new: final share right on things never taught; least: the least GCA; all: orders that ended with all."


def _set(found: OpenEnded, one: Findings) -> Iterator[str]:
    yield ""
    yield f"{one.name}: {len(one.kinds)} categories, {one.things} things, {one.views} views"
    yield f"{'':<{NAME}}" + "".join(f" {measure:>11}" for measure in MEASURES) + " least  all"
    for name in dict.fromkeys(taught.contestant for taught in one.taught):
        courses = one.of(name)
        cells = "".join(f" {spread([measure(one) for one in courses]):>11}" for measure in MEASURES.values())
        least = min(one.course.global_accuracy for one in courses)
        whole = sum(one.course.end is End.LEARNED for one in courses)
        yield f"{name:<{NAME}}{cells} {least:>5.2f} {whole:>4}/{len(courses)}"
    yield from _single_views(f"Single views of the {one.name}", one.nearest)
    if one.kept_back:
        half = f"Single views of every second category of the {one.name}, on which nothing was chosen"
        yield from _single_views(half, one.kept_back)


def _single_views(title: str, found: Ways) -> Iterator[str]:
    yield ""
    yield f"{title}:"
    yield "accuracy and, with categories left out, AUROC of unknown"
    yield f"{'':<{NAME}}" + "".join(f" {title:>27}" for title in SPLITS)
    yield f"{'':<{NAME}}" + f" {'accuracy':>13} {'AUROC':>13}" * len(SPLITS)
    for way in NAMING_METHODS:
        cells = [found[title, way.name] for title in SPLITS]
        texts = [f"{spread([s.accuracy for s in cell]):>13} {spread([s.auroc for s in cell]):>13}" for cell in cells]
        yield f"{way.name:<{NAME}} " + " ".join(texts)


def spread(values: Sequence[float]) -> str:
    """Format the mean and standard deviation (n - 1); the mean alone for one value.

    Parameters
    ----------
    values
        Results of repetitions, at least one.

    Returns
    -------
    str
        Two decimals below 2; otherwise three significant digits and a deviation with one decimal.

    Examples
    --------
    >>> spread([0.5, 0.7]), spread([12.0]), spread([171.0, 175.0])
    ('0.60 ± 0.14', '12', '173 ± 2.8')
    """
    mean = float(np.mean(values))
    text = f"{mean:.3g}" if abs(mean) >= 2 else f"{mean:.2f}"
    if len(values) < 2:
        return text
    deviation = float(np.std(values, ddof=1))
    return f"{text} ± {deviation:.1f}" if abs(mean) >= 2 else f"{text} ± {deviation:.2f}"
