"""A dialogue as pure steps: which question comes next, and what an answer leaves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from deixis.errors import DeixisError
from deixis.reasoning.grounding.questions.candidates import Candidates
from deixis.reasoning.grounding.questions.selection import DONT_KNOW, Question, QuestionKind, answers_of, best_question
from deixis.reasoning.grounding.questions.situation import Situation

PATIENCE = 6
"""Answers in a row that nobody knows after which no more is asked."""


class ContradictionError(DeixisError, ValueError):
    """An answer that no candidate gives."""


class ExchangeOutcome(StrEnum):
    """What an answer did."""

    RESOLVED = "resolved"
    UNKNOWN = "unknown"  # the person does not know; nothing changes, and no question that takes the same look is asked
    SURPRISING = "surprising"  # no candidate ever agreed: they have to be listed anew with what it says of an object
    CONTRADICTORY = "contradictory"  # no candidate agrees; nothing changes


@dataclass(frozen=True, slots=True)
class Exchange:
    """A question, its answer, and what it did; ``against`` are earlier exchanges that it cannot go together with.

    With a relation that no candidate ever agreed with, ``against`` is empty.
    """

    question: Question
    answer: str
    outcome: ExchangeOutcome
    against: tuple[int, ...] = ()

    @property
    def believed(self) -> bool:
        """Whether the answer counts."""
        return self.outcome in (ExchangeOutcome.RESOLVED, ExchangeOutcome.SURPRISING)


def update(situation: Situation, candidates: Candidates, question: Question, answer: str) -> Candidates:
    """Return the candidates that agree with an answer; all of them where it is ``DONT_KNOW``.

    Raises ContradictionError where none agrees.
    """
    if answer == DONT_KNOW:
        return candidates
    rows = candidates.pinned(question.about)
    agree = np.array([given == answer for given in answers_of(question, situation, rows.assignments)])
    if not (agree & (rows.weights > 0)).any():
        raise ContradictionError(f"'{answer}' to '{question.text}' goes against every grounding that is left")
    return rows.kept(agree)


@dataclass(frozen=True, eq=False)
class Inquiry:
    """What some questions and answers have left of the candidates of the ``start``; :func:`begin` makes one."""

    situation: Situation
    start: Candidates
    candidates: Candidates
    kinds: tuple[QuestionKind, ...]  # the questions that may be asked
    exchanges: tuple[Exchange, ...] = ()

    def next_question(self) -> Question | None:
        """Return the question that is expected to resolve most, or None where there is none.

        None is asked twice, nor one that takes a look at what the person could not tell before. Who has not known as
        many answers in a row as there are objects (``PATIENCE`` at least), or is not understood, is asked no more.
        """
        patience = max(PATIENCE, len(self.situation.objects))
        latest = self.exchanges[-patience:]
        if len(latest) == patience and not any(exchange.believed for exchange in latest):
            return None
        barred = {exchange.question.topic for exchange in self.exchanges}
        unknown = (exchange for exchange in self.exchanges if exchange.outcome is ExchangeOutcome.UNKNOWN)
        return best_question(self.situation, self.candidates, self.kinds, barred | {e.question.look for e in unknown})

    def answered(self, question: Question, answer: str) -> Inquiry:
        """Return the inquiry after an answer; one with which no candidate agrees is recorded and changes nothing
        else."""
        if answer == DONT_KNOW:
            return self._with(Exchange(question, answer, ExchangeOutcome.UNKNOWN), self.candidates)
        try:
            left = update(self.situation, self.candidates, question, answer)
        except ContradictionError:
            against = self._against(question, answer)
            told = question.kind is not QuestionKind.RELATION and not against
            outcome = ExchangeOutcome.SURPRISING if told else ExchangeOutcome.CONTRADICTORY
            return self._with(Exchange(question, answer, outcome, against), self.candidates)
        return self._with(Exchange(question, answer, ExchangeOutcome.RESOLVED), left)

    def _with(self, exchange: Exchange, candidates: Candidates) -> Inquiry:
        return replace(self, exchanges=(*self.exchanges, exchange), candidates=candidates)

    def _against(self, question: Question, answer: str) -> tuple[int, ...]:
        """Return earlier answers without which this one would be possible: a set from which none can be left out."""
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
    """Return an inquiry into candidates of which nothing has been asked."""
    return Inquiry(situation, candidates, candidates, kinds)
