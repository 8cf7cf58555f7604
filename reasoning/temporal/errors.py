"""Errors of reasoning about time."""

from __future__ import annotations

from collections.abc import Iterable

from deixis.errors import DeixisError, UnknownTermError
from deixis.reasoning.constraints.proof import Proof
from deixis.reasoning.errors import InconsistencyError
from deixis.spelling import nearest


class FluentError(DeixisError, ValueError):
    """A fluent, or a relation between fluents, that contradicts itself; the message names it."""


class UnknownFluentError(UnknownTermError):
    """An unknown fluent or time point; the message suggests the nearest known one."""

    def __init__(self, kind: str, name: str, names: Iterable[str]) -> None:
        near = nearest(name, names) or next((known for known in names if name.startswith(f"{known}.")), None)
        super().__init__(f"there is no {kind} '{name}'" + (f"; did you mean '{near}'?" if near else ""))


class TemporalConflictError(InconsistencyError):
    """Statements about time that cannot all hold.

    ``explanation`` is the proof: a negative cycle of the simple temporal network, or one for every alternative of the
    disjunctions. ``statements`` are those that the proof rests on, each with everything stated at its place. If
    ``minimal``, leaving out any one of them makes the rest consistent; otherwise time ran out before that was proved.
    """

    def __init__(self, explanation: Proof[str], minimal: bool, statements: tuple[Proof[str], ...] = ()) -> None:
        super().__init__(explanation)
        self.explanation = explanation
        self.minimal = minimal
        self.statements = statements or explanation.leaves()

    def _message(self) -> str:
        return "these cannot all hold: " + "; ".join(
            f"{stated.claim} [{stated.source}]" if stated.source else stated.claim for stated in self.statements
        )
