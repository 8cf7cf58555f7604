"""Utterances: what people say or type, with the time, the speaker and the confidence of the recogniser.

Every word that Deixis hears enters as an :class:`Utterance`: typed, from a speech recogniser, or from a file of lines
of JSON (``.said.jsonl``), each ``{"text": "this is a fork", "at": 12.4}`` with optional ``until``, ``speaker`` and
``confidence``. ``docs/schema/utterance.schema.json`` is the schema of a line.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deixis.errors import DeixisError
from deixis.grammar.files import read_text
from deixis.ontology.strict_json import json_type, read_json_lines

MAX_CHARACTERS = 5_000
"""Maximum number of characters of an utterance."""

_KEYS = {"text", "at", "until", "speaker", "confidence"}


class UtteranceError(DeixisError, ValueError):
    """Utterance, or file of utterances, that is invalid."""


@dataclass(frozen=True, slots=True)
class Utterance:
    """Words of one person at one time.

    Parameters
    ----------
    text
        The words.
    at
        Time in seconds at which they begin.
    until
        Time in seconds at which they end; ``at`` if it is not known.
    speaker
        Name of the person.
    confidence
        Probability that the words were recognised right; 1 for typed words.

    Raises
    ------
    UtteranceError
        If the text is blank or too long, the times are not finite or in the wrong order, or the confidence is not in
        [0, 1].

    Examples
    --------
    >>> Utterance("this is a fork", 12.4).end
    12.4
    """

    text: str
    at: float
    until: float | None = None
    speaker: str = "person"
    confidence: float = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.text, str) or not self.text.strip() or len(self.text) > MAX_CHARACTERS:
            raise UtteranceError(
                f"'text' must have 1 to {MAX_CHARACTERS:,} characters that are not all blank, got {self.text!r:.40}"
            )
        if not math.isfinite(self.at) or not math.isfinite(self.end):
            raise UtteranceError(f"'at' and 'until' must be finite numbers of seconds, got {self.at} and {self.until}")
        if self.end < self.at:
            raise UtteranceError(f"'until' must not be before 'at', got {self.until:g} and {self.at:g}")
        if not self.speaker.strip():
            raise UtteranceError(f"'speaker' must be a name that is not blank, got {self.speaker!r}")
        if not 0 <= self.confidence <= 1:
            raise UtteranceError(f"'confidence' must be from 0 to 1, got {self.confidence:g}")

    @property
    def end(self) -> float:
        """Time in seconds at which the words end."""
        return self.at if self.until is None else self.until

    def to_dict(self) -> dict[str, Any]:
        """Return the utterance as the object of a line.

        Returns
        -------
        dict
            Data for JSON; ``until`` is left out if it is not known.
        """
        known = {} if self.until is None else {"until": self.until}
        return {"text": self.text, "at": self.at, **known, "speaker": self.speaker, "confidence": self.confidence}


def read_utterances(path: str | Path, refused: list[str] | None = None) -> tuple[Utterance, ...]:
    """Read a file of utterances.

    Parameters
    ----------
    path
        File with a JSON object on each line.
    refused
        List that gets the message about each line that is not an utterance, which is left out then; None to raise an
        error about the first one.

    Returns
    -------
    tuple of Utterance
        The utterances in order of time.

    Raises
    ------
    UtteranceError
        If a line is not an utterance; with file and line.
    ScriptFileError
        If the file cannot be read.
    """
    text = read_text(Path(path), str(path), undecoded="strict" if refused is None else "surrogateescape")
    return utterances_of_lines(text.split("\n"), str(path), refused)


def utterances_of_lines(
    lines: Iterable[str], file: str = "<utterances>", refused: list[str] | None = None
) -> tuple[Utterance, ...]:
    """Return the utterances of lines of JSON, in order of time.

    Parameters
    ----------
    lines
        Lines; blank ones are skipped.
    file
        Name of their file in messages.
    refused
        As for :func:`read_utterances`.

    Returns
    -------
    tuple of Utterance
        The utterances in order of time.

    Raises
    ------
    UtteranceError
        If a line is not an utterance.

    Examples
    --------
    >>> utterances_of_lines(['{"text": "a fork", "at": 3, "speaker": "anna"}'])[0].speaker
    'anna'
    """
    found = read_json_lines(lines, file, _utterance, UtteranceError, "is not a number", refused)
    return tuple(sorted((one for _, one in found), key=lambda one: one.at))


def _utterance(data: Any, where: str) -> Utterance:
    if not isinstance(data, dict):
        raise UtteranceError(f"{where}: a line must be an object {{…}}, got {json_type(data)}")
    for key in data:
        if key not in _KEYS:
            raise UtteranceError(
                f"{where}: unknown key {json.dumps(key[:60])}; an utterance has {', '.join(sorted(_KEYS))}"
            )
    for key in ("text", "at"):
        if key not in data:
            raise UtteranceError(f"{where}: '{key}' is missing")
    for key in ("at", "until", "confidence"):
        value = data.get(key)
        if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise UtteranceError(f"{where}: '{key}' must be a number, got {json_type(value)}")
    for key in ("text", "speaker"):
        if data.get(key) is not None and not isinstance(data[key], str):
            raise UtteranceError(f"{where}: '{key}' must be a string, got {json_type(data[key])}")
    given = {key: value for key, value in data.items() if value is not None}
    try:
        return Utterance(**given)
    except UtteranceError as error:
        raise UtteranceError(f"{where}: {error}") from error
    except (TypeError, OverflowError) as error:
        raise UtteranceError(f"{where}: 'text' and 'at' must be a string and a number of seconds") from error
