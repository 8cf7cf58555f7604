"""Grounding that asks, with the dialogue written to a stream: the Python side of ``deixis ground --ask``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TextIO

from deixis.arguments import checks_arguments
from deixis.grammar.script import Script
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.options import DEFAULT_TIME_LIMIT
from deixis.reasoning.grounding.questions.situation import Situation
from deixis.workflows.grounding.dialogue import AnswerSource, Dialogue
from deixis.workflows.grounding.ground import ground


@checks_arguments
def ask(
    script: Script | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    source: Callable[[Situation], AnswerSource],
    out: TextIO,
    meaning: Meaning = SHIPPED,
    time_limit: float = DEFAULT_TIME_LIMIT,
) -> Grounding:
    """Ground a script with a dialogue that is written to a stream.

    This is :func:`deixis.ground` with ``ask=Dialogue(source, out)``.

    Parameters
    ----------
    script, scene
        The script and the scene, or their files.
    source
        Makes, from the questions' situation, what answers them.
    out
        Stream for the questions.
    meaning
        Words and sizes, as shipped or as a memory has learned them.
    time_limit
        Seconds until the answer, without the time that the answers take.

    Returns
    -------
    Grounding
        The grounding; its ``exchanges`` are the questions with their answers.

    Raises
    ------
    DeixisError
        For bad input, as :func:`deixis.ground`.

    Examples
    --------
    >>> import io
    >>> import deixis
    >>> from deixis.workflows.grounding.dialogue import Oracle
    >>> script = deixis.read_script(text="cup left of plate")
    >>> scene = deixis.read_scene({"objects": [
    ...     {"id": "o1", "min": [0.0, 0], "max": [0.1, 0.1]}, {"id": "o2", "min": [0.2, 0], "max": [0.3, 0.1]},
    ...     {"id": "o3", "min": [0.4, 0], "max": [0.5, 0.1]}]})
    >>> questions = io.StringIO()
    >>> asked = ask(script, scene, lambda situation: Oracle({"cup": "o1", "plate": "o3"}, questions), questions)
    >>> print(questions.getvalue().splitlines()[0])
    1. Which one is the plate?   [1.32 bits]
    >>> [(name, match.perceived) for name, match in asked.matches.items()], len(asked.exchanges)
    ([('cup', 'o1'), ('plate', 'o3')], 2)
    """
    return ground(script, scene, ask=Dialogue(source, out), meaning=meaning, time_limit=time_limit)
