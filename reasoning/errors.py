"""Errors raised by reasoning."""

from __future__ import annotations

from numbers import Real

from deixis.errors import DeixisError


class LimitError(DeixisError, OverflowError):
    """A question too large to be answered in bounded time and memory; nothing was decided."""


class OutOfTimeError(LimitError, TimeoutError):
    """A search that reached its time limit; nothing was decided."""


class OutOfMemoryError(DeixisError, MemoryError):
    """A question that needs more memory than its limit; nothing was decided, and no memory was allocated."""


class InconsistencyError(DeixisError, ValueError):
    """Axioms that cannot all hold."""


class SettingError(DeixisError, ValueError):
    """An invalid value of a setting."""


def require_time_limit(seconds: float) -> None:
    """Raise SettingError unless a time limit is a number of at least 0.

    Parameters
    ----------
    seconds
        The time limit.

    Raises
    ------
    SettingError
        If it is not.
    """
    if not isinstance(seconds, Real) or not seconds >= 0:
        raise SettingError(f"`time_limit` must be at least 0 seconds, got {seconds}")


class NothingFoundError(DeixisError, LookupError):
    """A script that matches nothing in a scene."""


class UnknownAtomError(DeixisError, LookupError):
    """A symbol that is not an atom of a calculus."""


class CalculusError(DeixisError, ValueError):
    """Invalid tables of a calculus; ``atom`` is the code of the atom that shows the error."""

    def __init__(self, message: str, atom: int) -> None:
        super().__init__(message)
        self.atom = atom


class UnknownCalculusError(DeixisError, LookupError):
    """A name that is not the name of a calculus."""


class TriplesError(DeixisError, ValueError):
    """Text that is not N-Triples, or triples that are not an ontology."""


class ReasonerError(DeixisError, RuntimeError):
    """A reasoner that could not read an ontology, or could not be run."""


class NotEntailedError(DeixisError, ValueError):
    """A statement that does not follow, so that it has no justification."""


class NetworkError(DeixisError, ValueError):
    """A network of inconsistent parts, or a question about a pair that is not in the network."""


class DescriptionError(DeixisError, ValueError):
    """A description of one object that cannot be read, or a wrong option of its reading."""
