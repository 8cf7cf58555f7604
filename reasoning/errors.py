"""Errors that reasoning raises."""

from __future__ import annotations

from numbers import Real

from deixis.errors import DeixisError


class LimitError(DeixisError, OverflowError):
    """A question that is larger than what can be answered in bounded time and memory; nothing was decided."""


class OutOfTimeError(LimitError, TimeoutError):
    """The time limit struck before a search was done; nothing was decided."""


class OutOfMemoryError(DeixisError, MemoryError):
    """A question that takes more memory than its limit; nothing was decided, and none of it was taken."""


class InconsistencyError(DeixisError, ValueError):
    """Axioms that cannot all hold."""


class SettingError(DeixisError, ValueError):
    """A setting of a call that it cannot have."""


def require_time_limit(seconds: float) -> None:
    """Raises SettingError for what is no time limit, not a number among them."""
    if not isinstance(seconds, Real) or not seconds >= 0:
        raise SettingError(f"a time limit is 0 or more seconds, not {seconds}")


class NothingFoundError(DeixisError, LookupError):
    """A script of which a scene shows nothing."""


class UnknownAtomError(DeixisError, LookupError):
    """A sign that stands for no atom of a calculus."""


class CalculusError(DeixisError, ValueError):
    """Tables that are no calculus; ``atom`` is the code of the atom where that shows."""

    def __init__(self, message: str, atom: int) -> None:
        super().__init__(message)
        self.atom = atom


class UnknownCalculusError(DeixisError, LookupError):
    """A name that stands for no calculus."""


class TriplesError(DeixisError, ValueError):
    """Text that is no N-Triples, or triples that say no ontology."""


class ReasonerError(DeixisError, RuntimeError):
    """A reasoner that could not read an ontology, or could not be run."""


class NotEntailedError(DeixisError, ValueError):
    """A statement of which a justification was asked, and which does not follow."""


class NetworkError(DeixisError, ValueError):
    """A network whose parts do not fit together, or a question about a pair that it does not have."""
