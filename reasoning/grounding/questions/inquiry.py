"""Dialogue without input or output: choose the next question, and update the candidates with an answer."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from deixis.errors import DeixisError
from deixis.reasoning.grounding.questions.candidates import Candidates
from deixis.reasoning.grounding.questions.selection import DONT_KNOW, Question, QuestionKind, answers_of, best_question
from deixis.reasoning.grounding.questions.situation import Situation

PATIENCE = 6
"""Number of consecutive questions without a usable answer after which the dialogue ends."""


class ContradictionError(DeixisError, ValueError):
    """Error for an answer that contradicts all candidates."""


class ExchangeOutcome(StrEnum):
    """Effect of an answer."""

    RESOLVED = "resolved"  # the answer narrowed the candidates
    UNKNOWN = "unknown"  # the person does not know; nothing changes, and similar questions are not asked
    SURPRISING = "surprising"  # no initial candidate agrees: candidates must be listed again with the answer
    CONTRADICTORY = "contradictory"  # no candidate agrees; nothing changes


@dataclass(frozen=True, slots=True)
class Exchange:
    """A question, its answer, and the effect of the answer.

    ``against`` are the positions of earlier exchanges that the answer contradicts; it is empty where no initial
    candidate agrees with the answer.
    """

    question: Question
    answer: str
    outcome: ExchangeOutcome
    against: tuple[int, ...] = ()

    @property
    def is_used(self) -> bool:
        """True where the answer is used."""
        return self.outcome in (ExchangeOutcome.RESOLVED, ExchangeOutcome.SURPRISING)


def update(situation: Situation, candidates: Candidates, question: Question, answer: str) -> Candidates:
    """Return the candidates that agree with an answer; all of them for ``DONT_KNOW``.

    Parameters
    ----------
    situation
        The scene and what is known about it.
    candidates
        Groundings that are possible so far.
    question
        The question.
    answer
        One of the answers of the question, or ``DONT_KNOW``.

    Returns
    -------
    Candidates
        At least one candidate.

    Raises
    ------
    ContradictionError
        No candidate agrees with the answer.
    """
    if answer == DONT_KNOW:
        return candidates
    rows = candidates.pinned(question.about)
    agree = np.array([given == answer for given in answers_of(question, situation, rows.assignments)])
    if not (agree & (rows.weights > 0)).any():
        raise ContradictionError(f"the answer '{answer}' to '{question.text}' contradicts every remaining grounding")
    return rows.select(agree)


@dataclass(frozen=True, eq=False)
class Inquiry:
    """State of a dialogue; :func:`begin` creates the first."""

    situation: Situation
    start: Candidates  # before the dialogue
    candidates: Candidates  # that agree with the answers
    kinds: tuple[QuestionKind, ...]  # kinds of questions that may be asked
    exchanges: tuple[Exchange, ...] = ()

    def next_question(self) -> Question | None:
        """Return the question with the largest expected information, or None to end the dialogue.

        No question is asked twice, nor one that needs knowledge that the person did not have before. The dialogue ends
        after as many consecutive unusable answers as there are objects, and at least ``PATIENCE``.

        Returns
        -------
        Question or None
            The question, or None.
        """
        patience = max(PATIENCE, len(self.situation.objects))
        latest = self.exchanges[-patience:]
        if len(latest) == patience and not any(exchange.is_used for exchange in latest):
            return None
        barred = {exchange.question.topic for exchange in self.exchanges}
        unknown = (exchange for exchange in self.exchanges if exchange.outcome is ExchangeOutcome.UNKNOWN)
        return best_question(self.situation, self.candidates, self.kinds, barred | {e.question.look for e in unknown})

    def answered(self, question: Question, answer: str) -> Inquiry:
        """Return the inquiry after an answer; an answer without an agreeing candidate is only recorded.

        Parameters
        ----------
        question
            The question that was asked.
        answer
            Its answer.

        Returns
        -------
        Inquiry
            Inquiry with one exchange more.
        """
        if answer == DONT_KNOW:
            return self._with(Exchange(question, answer, ExchangeOutcome.UNKNOWN), self.candidates)
        try:
            left = update(self.situation, self.candidates, question, answer)
        except ContradictionError:
            against = self._against(question, answer)
            settles_object = question.kind is not QuestionKind.RELATION and not against
            outcome = ExchangeOutcome.SURPRISING if settles_object else ExchangeOutcome.CONTRADICTORY
            return self._with(Exchange(question, answer, outcome, against), self.candidates)
        return self._with(Exchange(question, answer, ExchangeOutcome.RESOLVED), left)

    def _with(self, exchange: Exchange, candidates: Candidates) -> Inquiry:
        return replace(self, exchanges=(*self.exchanges, exchange), candidates=candidates)

    def _against(self, question: Question, answer: str) -> tuple[int, ...]:
        """Return a minimal set of earlier answers that contradict this one, as positions of exchanges."""
        blamed = [k for k, exchange in enumerate(self.exchanges) if exchange.outcome is ExchangeOutcome.RESOLVED]
        if not self._possible(question, answer, []):
            return ()
        for k in list(blamed):
            fewer = [other for other in blamed if other != k]
            if not self._possible(question, answer, fewer):
                blamed = fewer
        return tuple(blamed)

    def _possible(self, question: Question, answer: str, numbers: list[int]) -> bool:
        left = self.start
        try:
            for k in numbers:
                left = update(self.situation, left, self.exchanges[k].question, self.exchanges[k].answer)
            update(self.situation, left, question, answer)
        except ContradictionError:
            return False
        return True


def begin(
    situation: Situation, candidates: Candidates, kinds: tuple[QuestionKind, ...] = tuple(QuestionKind)
) -> Inquiry:
    """Return an inquiry without any questions asked.

    Parameters
    ----------
    situation
        The scene and what is known about it.
    candidates
        Groundings to tell apart.
    kinds
        Kinds of questions that may be asked.

    Returns
    -------
    Inquiry
        The inquiry.
    """
    return Inquiry(situation, candidates, candidates, kinds)
