"""Renderers of answers by type: plain data, lines of text, rows of a table, and pictures.

:class:`deixis.answers.Answer` calls the functions of this module. A new type of answer is a line in RENDERERS.
"""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from deixis.answers import Answer, rounded
from deixis.errors import DeixisError
from deixis.extras import require

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Renderer:
    """Functions that render one type of answer, each as ``module:function`` under ``deixis``, imported when called.

    ``figure`` takes the answer and axes or None, and returns a figure.
    """

    data: str
    lines: str
    rows: str | None = None
    figure: str | None = None


RENDERERS = {
    "Script": Renderer(
        "report.json_answers:script_to_dict", "report.layouts.script:script_lines", "report.knowledge.rows:script_rows"
    ),
    "Scene": Renderer(
        "perception.formats.scene_json:scene_to_dict",
        "report.scenes.seen:scene_lines",
        "report.knowledge.rows:scene_rows",
        "plots.seen:seen_figure",
    ),
    "Match": Renderer("report.json_answers:match_to_dict", "report.grounding.ground:match_lines"),
    "Grounding": Renderer(
        "report.json_answers:grounding_to_dict",
        "report.grounding.ground:grounding_lines",
        "report.knowledge.rows:grounding_rows",
        "plots.grounding:answer_figure",
    ),
    "Reference": Renderer(
        "report.descriptions.refer:reference_to_dict",
        "report.descriptions.refer:reference_lines",
        "report.descriptions.refer:reference_rows",
        "plots.grounding:reference_figure",
    ),
    "Check": Renderer(
        "report.json_answers:check_to_dict",
        "report.layouts.script:check_lines",
        "report.knowledge.rows:check_rows",
        "plots.check:check_figure",
    ),
    "Inference": Renderer(
        "report.json_answers:inference_to_dict",
        "report.layouts.script:inference_lines",
        "report.knowledge.rows:inference_rows",
    ),
    "Telling": Renderer(
        "report.descriptions.tell:telling_to_dict",
        "report.descriptions.tell:telling_lines",
        "report.descriptions.tell:telling_rows",
    ),
    "Placements": Renderer(
        "report.knowledge.habits:habits_to_dict",
        "report.knowledge.habits:habits_lines",
        "report.knowledge.habits:habits_rows",
    ),
    "ActivityGrounding": Renderer(
        "report.reasoning.activities:grounded_to_dict",
        "report.reasoning.activities:grounded_lines",
        "report.reasoning.activities:grounded_rows",
    ),
    "Prediction": Renderer(
        "report.reasoning.activities:predicted_to_dict",
        "report.reasoning.activities:predicted_lines",
        "report.reasoning.activities:predicted_rows",
    ),
    "RecognisedActivity": Renderer(
        "report.reasoning.activities:recognised_to_dict",
        "report.reasoning.activities:recognised_lines",
        "report.reasoning.activities:recognised_rows",
    ),
    "Recall": Renderer(
        "report.knowledge.recall:recall_to_dict",
        "report.knowledge.recall:recall_lines",
        "report.knowledge.recall:recall_rows",
    ),
    "Unlearned": Renderer("report.knowledge.unlearn:unlearned_to_dict", "report.knowledge.unlearn:unlearned_lines"),
    "Consolidation": Renderer(
        "report.knowledge.consolidate:consolidated_to_dict",
        "report.knowledge.consolidate:consolidated_lines",
        "report.knowledge.consolidate:consolidated_rows",
    ),
    "Shown": Renderer(
        "report.scenes.point:shown_to_dict", "report.scenes.point:shown_lines", "report.scenes.point:shown_rows"
    ),
    "Lint": Renderer(
        "report.layouts.lint:lint_to_dict", "report.layouts.lint:lint_lines", "report.layouts.lint:lint_rows"
    ),
    "Imagination": Renderer(
        "report.layouts.imagine:imagination_to_dict",
        "report.layouts.imagine:imagination_lines",
        "report.knowledge.rows:imagination_rows",
        "plots.imagine:imagination_figure",
    ),
    "Recognised": Renderer(
        "report.scenes.seen:recognised_to_dict",
        "report.scenes.seen:recognised_lines",
        "report.knowledge.rows:recognised_rows",
        "plots.seen:recognised_figure",
    ),
    "Retrieval": Renderer(
        "report.grounding.retrieve:retrieval_to_dict",
        "report.grounding.retrieve:retrieval_lines",
        "report.knowledge.rows:retrieval_rows",
        "plots.charts:retrieval_figure",
    ),
    "Learned": Renderer(
        "report.json_answers:learned_to_dict",
        "report.layouts.script:learned_lines",
        "report.knowledge.rows:learned_rows",
        "plots.grounding:learned_figure",
    ),
    "LearnedWords": Renderer(
        "report.descriptions.relation:learned_words_to_dict",
        "report.descriptions.relation:learned_words_lines",
        "report.descriptions.relation:learned_words_rows",
    ),
    "Meaning": Renderer(
        "report.descriptions.relation:meaning_to_dict",
        "report.descriptions.relation:meaning_lines",
        "report.descriptions.relation:meaning_rows",
    ),
    "LearnedReference": Renderer(
        "report.descriptions.relation:learned_reference_to_dict",
        "report.descriptions.relation:learned_reference_lines",
        "report.descriptions.relation:learned_reference_rows",
    ),
    "Look": Renderer(
        "report.scenes.robot:look_to_dict",
        "report.scenes.robot:look_lines",
        "report.scenes.robot:look_rows",
        "plots.grounding:look_figure",
    ),
    "Told": Renderer(
        "report.scenes.robot:told_to_dict",
        "report.scenes.robot:told_lines",
        "report.scenes.robot:told_rows",
        "plots.grounding:told_figure",
    ),
    "Simulation": Renderer(
        "report.scenes.simulate:simulation_to_dict",
        "report.scenes.simulate:simulation_lines",
        "report.scenes.simulate:simulation_rows",
        "plots.seen:simulation_figure",
    ),
    "Tracking": Renderer(
        "report.scenes.track:tracking_to_dict",
        "report.scenes.track:tracking_lines",
        "report.scenes.track:tracking_rows",
        "plots.seen:tracking_figure",
    ),
    "Taught": Renderer("report.scenes.seen:taught_to_dict", "report.scenes.seen:taught_lines"),
    "LayoutConcept": Renderer(
        "report.knowledge.concept:layout_to_dict",
        "report.knowledge.concept:layout_lines",
        "report.knowledge.concept:layout_rows",
    ),
    "CountedConcept": Renderer(
        "report.knowledge.concept:concept_to_dict",
        "report.knowledge.concept:concept_lines",
        "report.knowledge.concept:concept_rows",
    ),
    "QueryResult": Renderer(
        "report.knowledge.rows:query_to_dict", "report.knowledge.rows:query_lines", "report.knowledge.rows:query_rows"
    ),
    "ReadText": Renderer(
        "report.layouts.read:read_text_to_dict",
        "report.layouts.read:read_text_lines",
        "report.layouts.read:read_text_rows",
    ),
    "SolvedNetwork": Renderer(
        "report.reasoning.solve:solved_to_dict",
        "report.reasoning.solve:solved_lines",
        "report.reasoning.solve:network_rows",
    ),
    "Solved": Renderer(
        "report.reasoning.solve:file_to_dict", "report.reasoning.solve:file_lines", "report.reasoning.solve:file_rows"
    ),
    "Entailment": Renderer(
        "report.reasoning.reason:entailment_to_dict",
        "report.reasoning.reason:entailment_lines",
        "report.reasoning.reason:entailment_rows",
    ),
    "ShapesReport": Renderer(
        "report.reasoning.validate:shapes_to_dict",
        "report.reasoning.validate:shapes_lines",
        "report.reasoning.validate:shapes_rows",
    ),
    "Chronology": Renderer(
        "report.reasoning.time:chronology_to_dict",
        "report.reasoning.time:chronology_lines",
        "report.reasoning.time:chronology_rows",
        "plots.charts:chronology_figure",
    ),
    "Figure6": Renderer(
        "experiments.figure6:figure6_to_dict",
        "experiments.figure6:figure6_lines",
        "experiments.figure6:figure6_rows",
        "experiments.figure6:figure6_figure",
    ),
    "Scoreboard": Renderer(
        "experiments.scoreboard.report:to_dict",
        "experiments.scoreboard.report:lines",
        "experiments.scoreboard.report:rows",
        "experiments.scoreboard.plot:scoreboard_figure",
    ),
    "OpenEnded": Renderer(
        "experiments.open_ended.report:to_dict",
        "experiments.open_ended.report:lines",
        "experiments.open_ended.report:rows",
        "experiments.open_ended.plot:open_ended_figure",
    ),
    "Apprentice": Renderer(
        "experiments.apprentice.report:to_dict",
        "experiments.apprentice.report:lines",
        "experiments.apprentice.report:rows",
    ),
    "Related": Renderer(
        "report.scenes.relate:related_to_dict", "report.scenes.relate:pair_lines", "report.scenes.relate:related_rows"
    ),
}
"""Renderers by the name of the answer's class."""


def to_dict(answer: Answer) -> dict[str, Any]:
    """Return an answer as plain data.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.

    Returns
    -------
    dict
        Data for JSON, with the keys of the ``--json`` output of the command.
    """
    return _function(_renderer(answer).data)(answer)  # type: ignore[no-any-return]


def to_lines(answer: Answer) -> list[str]:
    """Return the lines of an answer, as its command prints them.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.

    Returns
    -------
    list of str
        Lines without their ends; some carry a mark of :mod:`deixis.report.marks`.
    """
    return list(_function(_renderer(answer).lines)(answer))


def to_rows(answer: Answer) -> list[Row]:
    """Return the table in an answer.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.

    Returns
    -------
    list of dict
        The rows, each with its values by column.

    Raises
    ------
    DeixisError
        If answers of this type are not tables.
    """
    rows = _renderer(answer).rows
    if rows is None:
        raise DeixisError(f"a {type(answer).__name__} is not a table; use to_dict() or to_text()")
    return list(_function(rows)(answer))


def to_dataframe(answer: Answer) -> Any:
    """Return the table in an answer as a pandas data frame.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.

    Returns
    -------
    pandas.DataFrame
        The rows of :func:`to_rows`.

    Raises
    ------
    DeixisError
        If answers of this type are not tables.
    MissingExtraError
        If pandas is not installed.
    """
    rows = to_rows(answer)
    require("pandas", f"{type(answer).__name__}.to_dataframe()")
    import pandas

    return pandas.DataFrame(rows)


def plot(answer: Answer, axes: Axes | None) -> Figure:
    """Draw an answer into axes, or into a new figure.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure of the axes.

    Raises
    ------
    DeixisError
        If answers of this type have no picture.
    MissingExtraError
        If matplotlib is not installed.
    """
    figure = _renderer(answer).figure
    if figure is None:
        raise DeixisError(f"a {type(answer).__name__} has no picture; use to_text(), or draw an answer made from it")
    require("matplotlib", f"{type(answer).__name__}.plot()")
    return _function(figure)(answer, axes)  # type: ignore[no-any-return]


def to_png(answer: Answer) -> bytes | None:
    """Return the picture of an answer as PNG, or None where it has none or matplotlib is not installed.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.

    Returns
    -------
    bytes or None
        The picture at 110 dots per inch; None also if this answer cannot be drawn.
    """
    if _renderer(answer).figure is None or find_spec("matplotlib") is None:
        return None
    try:
        figure = plot(answer, None)
    except DeixisError:
        return None
    return _function("plots.displayed_figure:png_of")(figure)  # type: ignore[no-any-return]


def to_html(answer: Answer) -> str:
    """Return an answer for a notebook: its summary and its table, or its text.

    Parameters
    ----------
    answer
        Answer of a type in :data:`RENDERERS`.

    Returns
    -------
    str
        HTML fragment with escaped text and at most :data:`MAX_HTML_ROWS` rows.
    """
    head = f"<p><b>{type(answer).__name__}</b> {html.escape(answer.summary())}</p>"
    rows = [] if _renderer(answer).rows is None else to_rows(answer)
    if not rows:
        return f"{head}<pre>{html.escape(answer.to_text())}</pre>"
    return head + html_table(rows[:MAX_HTML_ROWS], len(rows))


MAX_HTML_ROWS = 100
"""Maximum number of rows that a notebook shows."""


def html_table(rows: Sequence[Row], total: int) -> str:
    """Return rows as an HTML table.

    Parameters
    ----------
    rows
        Rows to show. The columns are the keys of all rows in the order of their first occurrence.
    total
        Number of rows including those that are not shown; a note gives the difference.

    Returns
    -------
    str
        HTML fragment with escaped text.
    """
    columns = list(dict.fromkeys(key for row in rows for key in row))
    head = "".join(f"<th style='text-align:left'>{html.escape(name)}</th>" for name in columns)
    body = "".join(
        "<tr>" + "".join(f"<td style='text-align:left'>{_cell(name, row.get(name))}</td>" for name in columns) + "</tr>"
        for row in rows
    )
    more = f"<p>… and {total - len(rows)} more rows</p>" if total > len(rows) else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _cell(name: str, value: Any) -> str:
    if value is None:
        return ""
    if name == "probability" and isinstance(value, float):
        return rounded(value)
    return f"{value:.3g}" if isinstance(value, float) else html.escape(str(value))


def _renderer(answer: Answer) -> Renderer:
    for kind in type(answer).__mro__:
        if kind.__name__ in RENDERERS:
            return RENDERERS[kind.__name__]
    raise NotImplementedError(f"{type(answer).__name__} has no line in RENDERERS")


def _function(name: str) -> Any:
    module, _, function = name.partition(":")
    return getattr(import_module(f"deixis.{module}"), function)
