"""Plot the courses: a row of three panels for each set of things."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.open_ended.run import Findings, OpenEnded
from deixis.perception.recognition.learners.teaching import Course
from deixis.plots.figure import INK, dress_chart, line_look, new_figure, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Curve = Callable[[Course], NDArray[np.float64]]


def plot_open_ended(found: OpenEnded, path: str | Path) -> None:
    """Draw the courses: known categories, accuracy and stored instances, a row for each set of views.

    Parameters
    ----------
    found
        Results of the experiment.
    path
        File of the picture: ``.png``, ``.svg`` or ``.pdf``.

    Raises
    ------
    DeixisError
        If the file cannot be written, or its ending is not that of a picture.
    MissingExtraError
        If matplotlib is not installed.
    """
    save(open_ended_figure(found), path)


def open_ended_figure(found: OpenEnded, into: Axes | None = None) -> Figure:
    """Draw the courses: known categories, accuracy and stored instances, a row for each set of views.

    Parameters
    ----------
    found
        Results of the experiment.
    into
        Axes for the known categories of the first set alone; None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    if into is not None:
        _draw(into, found.findings[0], "categories known", known_categories)
        into.legend(frameon=False, fontsize=8, labelcolor=INK)
        return into.figure.figure
    figure, axes = new_figure(12.0, 3.6 * len(found.findings) + 0.6, nrows=len(found.findings), ncols=3, squeeze=False)
    panels = (
        ("categories known", known_categories),
        ("share of all answers right", accuracy),
        ("instances a category", stored),
    )
    for one, row in zip(found.findings, axes, strict=True):
        for panel, (title, curve) in zip(row, panels, strict=True):
            _draw(panel, one, title, curve)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9, labelcolor=INK)
    return figure


def _draw(axes: Axes, one: Findings, title: str, curve: Curve) -> None:
    """Draw the mean curve of every learner."""
    for number, name in enumerate(dict.fromkeys(taught.contestant for taught in one.taught)):
        mean = mean_curve([curve(taught.course) for taught in one.of(name)])
        across, width = np.arange(1, len(mean) + 1), 2.2 if number == 0 else 1.2
        axes.plot(across, mean, linewidth=width, label=name, **line_look(number))
    dress_chart(axes, f"{one.name}: {title}", "question and correction iterations")


def known_categories(course: Course) -> NDArray[np.float64]:
    """Return the number of known categories at each answer.

    Parameters
    ----------
    course
        Course of one learner.

    Returns
    -------
    array
        Number after each of n answers, shape (n,).
    """
    return np.array([answer.known for answer in course.answers], np.float64)


def accuracy(course: Course) -> NDArray[np.float64]:
    """Return the share of correct answers so far, at each answer.

    Parameters
    ----------
    course
        Course of one learner.

    Returns
    -------
    array
        Share in [0, 1] after each of n answers, shape (n,).
    """
    right = np.array([answer.right for answer in course.answers], np.float64)
    return np.cumsum(right) / np.arange(1, len(right) + 1)


def stored(course: Course) -> NDArray[np.float64]:
    """Return the stored instances per known category, after each answer.

    Parameters
    ----------
    course
        Course of one learner.

    Returns
    -------
    array
        Mean number of instances after each of n answers, shape (n,).
    """
    return np.array([answer.stored / answer.known for answer in course.answers])


def mean_curve(curves: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the mean of the curves up to the longest one; a shorter curve keeps its last value.

    Parameters
    ----------
    curves
        Values by answer, each of shape (n,) with its own n; empty ones are left out.

    Returns
    -------
    array
        Mean values, as many as the longest curve has; empty without curves.
    """
    length = max(map(len, curves), default=0)
    held = [np.concatenate([curve, np.full(length - len(curve), curve[-1])]) for curve in curves if len(curve)]
    result: NDArray[np.float64] = np.mean(held, axis=0) if held else np.empty(0)
    return result
