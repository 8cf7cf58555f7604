"""Dialogue of ``deixis ground --ask``: ask questions until everything is resolved or there is no further answer."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TextIO

import numpy as np

from deixis.errors import DeixisError
from deixis.ontology.strict_json import parse_json
from deixis.printable import shortened, visible_line
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.questions.inquiry import ExchangeOutcome, Inquiry
from deixis.reasoning.grounding.questions.selection import (
    ABSENT,
    DONT_KNOW,
    NO,
    YES,
    Question,
    QuestionKind,
    answers_of,
)
from deixis.reasoning.grounding.questions.situation import Situation, spoken
from deixis.spelling import nearest
from deixis.text_files import read_text

_WORDS = {
    YES: ("yes", "y", "true"),
    NO: ("no", "n", "false"),
    DONT_KNOW: ("?", "don't know", "dont know", "do not know", "i don't know", "unknown", "no idea"),
    ABSENT: ("absent", "none", "neither", "not there", "missing"),
}

MAX_ORACLE_CHARACTERS = 2**20


class OracleError(DeixisError, ValueError):
    """Error in a truth file: it is malformed, or does not fit the scene."""


class AnswerSource(Protocol):
    """Source of answers: a person at a terminal, or a file with the truth."""

    def answer(self, question: Question, situation: Situation) -> str | None:
        """Answer a question.

        Parameters
        ----------
        question
            The question.
        situation
            Scene and groundings that it is about.

        Returns
        -------
        str or None
            YES, NO, DONT_KNOW, ABSENT or the id of a thing; None if there is no further answer.
        """
        ...


@dataclass(frozen=True)
class Dialogue:
    """Source of answers, as a function of the situation, and the stream that the dialogue is written to."""

    source: Callable[[Situation], AnswerSource]
    out: TextIO


@dataclass(frozen=True)
class Answers:
    """Answers of a function of the question and the situation; None ends the dialogue."""

    answers: Callable[[Question, Situation], str | None]

    def answer(self, question: Question, situation: Situation) -> str | None:
        """Return the function's answer.

        Parameters
        ----------
        question
            The question.
        situation
            Scene and groundings that it is about.

        Returns
        -------
        str or None
            The answer, or None to end the dialogue.

        Raises
        ------
        OracleError
            If the question does not have this answer.
        """
        text = self.answers(question, situation)
        if text is None:
            return None
        found = parse_answer(text, _allowed(question, situation)) if isinstance(text, str) else None
        if found is None:
            raise OracleError(f"the answer to '{question.text}' must be one of its answers, got '{text}'")
        return found


def dialogue_with(answers: Ask) -> Dialogue:
    """Return a dialogue with a source of answers.

    Parameters
    ----------
    answers
        A dialogue, which is returned as it is, or a function or a mapping, for a dialogue that writes nothing.

    Returns
    -------
    Dialogue
        The dialogue.
    """
    if isinstance(answers, Dialogue):
        return answers
    silence = io.StringIO()
    if isinstance(answers, Mapping):
        truth = dict(answers)
        return Dialogue(lambda situation: Oracle(checked_truth(truth, "ask", situation), silence), silence)
    return Dialogue(lambda _: Answers(answers), silence)


Ask = Dialogue | Mapping[str, str | None] | Callable[[Question, Situation], str | None]
"""Source of answers: a dialogue, the truth from names to ids (None: absent), or a function of each question."""


def run(inquiry: Inquiry, source: AnswerSource, out: TextIO, most: float = math.inf) -> Inquiry:
    """Hold a dialogue, and return the inquiry after it.

    The dialogue ends early at an answer after which the groundings must be listed again.

    Parameters
    ----------
    inquiry
        The inquiry before the dialogue.
    source
        Source of the answers.
    out
        Stream for the questions.
    most
        Maximum number of questions.

    Returns
    -------
    Inquiry
        The inquiry with the answers.
    """
    while len(inquiry.exchanges) < most and (question := inquiry.next_question()) is not None:
        number = len(inquiry.exchanges) + 1
        print(visible_line(f"{number}. {question.text}   [{question.bits:.2f} bits]"), file=out, flush=True)
        answer = source.answer(question, inquiry.situation)
        if answer is None:
            print("No further answers.", file=out)
            break
        inquiry = inquiry.answered(question, answer)
        _remark(inquiry, out)
        if inquiry.exchanges[-1].outcome is ExchangeOutcome.SURPRISING:
            break
    return inquiry


def _remark(inquiry: Inquiry, out: TextIO) -> None:
    exchange = inquiry.exchanges[-1]
    if exchange.outcome is ExchangeOutcome.SURPRISING:
        print("   No considered grounding agrees with this answer; the groundings are computed again.", file=out)
    if exchange.outcome is not ExchangeOutcome.CONTRADICTORY:
        return
    if exchange.against:
        numbers = " and ".join(str(k + 1) for k in exchange.against)
        reason = f"it contradicts the answer to {numbers}"
    else:
        reason = "no considered grounding agrees with it"
    print(f"   This answer is ignored: {reason}.", file=out)


def closing_lines(inquiry: Inquiry) -> list[str]:
    """Return how many groundings are left, and the objects on which they differ.

    Parameters
    ----------
    inquiry
        The inquiry after the dialogue.

    Returns
    -------
    list of str
        Lines of text.
    """
    left, names = inquiry.candidates, inquiry.situation.objects
    count = len(inquiry.exchanges)
    asked = f"{count} question{'' if count == 1 else 's'}"
    if inquiry.start.count == 1 and not left.complete:
        lines = ["Only one grounding was considered, so there was no question to ask."]
    elif left.count == 1:
        lines = [f"One of the considered groundings is left after {asked}."]
    else:
        open_ = ", ".join(spoken(names[i]) for i in left.undecided)
        lines = [f"{left.count} groundings are left after {asked}; undecided: {open_}."]
    if not left.complete:
        lines.append("Not all groundings could be considered; others may fit as well.")
    return lines


class Lines(Protocol):
    """Source of lines to read one by one; an empty text is the end."""

    def readline(self) -> str:
        """Return the next line, or an empty text at the end.

        Returns
        -------
        str
            The line with its end.
        """
        ...


@dataclass(frozen=True)
class Terminal:
    """Person at a terminal: a question is repeated until it has a valid answer; the end of input ends the dialogue."""

    lines: Lines
    out: TextIO

    def answer(self, question: Question, situation: Situation) -> str | None:
        """Ask until the person gives a valid answer.

        Parameters
        ----------
        question
            The question.
        situation
            Scene and groundings that it is about.

        Returns
        -------
        str or None
            The answer, or None at the end of the input.
        """
        allowed = _allowed(question, situation)
        while True:
            print(visible_line(f"   {hint(question, situation)} "), end="", file=self.out, flush=True)
            line = self.lines.readline()
            if not line:
                print(file=self.out)
                return None
            found = parse_answer(line, allowed)
            if found is not None:
                return found
            near = nearest(line.strip(), allowed)
            message = f"   '{shortened(line.strip())}' is not an answer"
            print(visible_line(message + (f"; did you mean '{near}'?" if near else ".")), file=self.out)


def hint(question: Question, situation: Situation) -> str:
    """Return the possible answers to a question as a hint.

    Parameters
    ----------
    question
        The question.
    situation
        Scene and groundings that it is about.

    Returns
    -------
    str
        Text in brackets; it lists the most likely things with their places.
    """
    if question.kind is not QuestionKind.POINTING:
        third = ", none: one of them is not there" if _may_be_absent(question) else ""
        return f"(yes, no{third}, ?)"
    listed = [_listed(answer, situation) for answer, _ in question.answers if answer != ABSENT][:12]
    return f"({', '.join(listed)}; none, ?)"


def _may_be_absent(question: Question) -> bool:
    """Return True if an object of the question is absent in some considered grounding."""
    return ABSENT in dict(question.answers)


def _listed(id: str, situation: Situation) -> str:
    where = situation.places[situation.things.index(id)]
    return f"{id} {where}" if where else id


def _allowed(question: Question, situation: Situation) -> dict[str, str]:
    """Return the meaning of each text that can be typed; the id of a thing takes precedence over an equal word."""
    meanings = [DONT_KNOW] if question.kind is QuestionKind.POINTING else [YES, NO, DONT_KNOW]
    if question.kind is QuestionKind.POINTING or _may_be_absent(question):
        meanings.append(ABSENT)
    allowed = {word: meaning for meaning in meanings for word in _WORDS[meaning]}
    if question.kind is QuestionKind.POINTING:
        allowed |= {id: id for id in situation.things}
    return allowed


def parse_answer(line: str, allowed: Mapping[str, str]) -> str | None:
    """Return the meaning of a typed line.

    Parameters
    ----------
    line
        What was typed.
    allowed
        Answer by the lower-case word for it.

    Returns
    -------
    str or None
        The answer, or None if the line has no meaning.

    Examples
    --------
    >>> parse_answer(" Y ", {"y": "yes"})
    'yes'
    """
    text = line.strip()
    return allowed.get(text, allowed.get(text.casefold()))


@dataclass(frozen=True)
class Oracle:
    """Source of answers from the truth: the perceived thing of each object, None for an absent one."""

    truth: Mapping[str, str | None]
    out: TextIO

    def answer(self, question: Question, situation: Situation) -> str:
        """Return the true answer.

        Parameters
        ----------
        question
            The question.
        situation
            Scene and groundings that it is about.

        Returns
        -------
        str
            The answer; DONT_KNOW, with a line on ``out``, for an object that the truth does not name.
        """
        assignment = np.full(len(situation.objects), UNMATCHED)
        for i in question.about:
            name = situation.objects[i]
            if name not in self.truth:
                print(f"   (the oracle does not know '{name}')", file=self.out)
                return DONT_KNOW
            id = self.truth[name]
            assignment[i] = UNMATCHED if id is None else situation.things.index(id)
        answer = answers_of(question, situation, assignment[None])[0]
        print(visible_line(f"   {answer}"), file=self.out)
        return answer


def read_oracle(file: str | Path, situation: Situation, out: TextIO) -> Oracle:
    """Read a truth file: a JSON object from names of the script to ids of the scene, or null for absent objects.

    Parameters
    ----------
    file
        The file.
    situation
        Scene and script that it is about.
    out
        Stream for objects that the truth does not name.

    Returns
    -------
    Oracle
        The oracle that answers by the truth.

    Raises
    ------
    OracleError
        If the file is malformed, names a thing that is not in the scene, or gives one thing to two objects.
    """
    text = read_text(file, OracleError, MAX_ORACLE_CHARACTERS)
    data = parse_json(text, str(file), OracleError, no_number=None)
    return Oracle(checked_truth(data, str(file), situation), out)


def checked_truth(data: Any, where: str, situation: Situation) -> dict[str, str | None]:
    """Return the truth from names to ids, checked against a scene and a script.

    Parameters
    ----------
    data
        Parsed JSON.
    where
        Name of its place, for messages.
    situation
        Scene and script that it is about.

    Returns
    -------
    dict
        Id by name; None for what is absent.

    Raises
    ------
    OracleError
        If the data is malformed.
    """
    if not isinstance(data, dict) or not all(isinstance(id, str | None) for id in data.values()):
        raise OracleError(f"{where}: a truth file must be a JSON object from names to ids, null for absent objects")
    for name, id in data.items():
        if id is not None and id not in situation.things:
            near = nearest(id, situation.things)
            raise OracleError(
                f"{where}: '{name}' has the id '{id}', which is not in the scene"
                + (f"; did you mean '{near}'?" if near else "")
            )
    ids = [id for id in data.values() if id is not None]
    twice = next((id for id in ids if ids.count(id) > 1), None)
    if twice is not None:
        raise OracleError(f"{where}: two objects have the id '{twice}'")
    return data
