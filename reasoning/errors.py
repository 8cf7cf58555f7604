"""The errors of this room."""

from __future__ import annotations

from deixis.ontology.errors import DeixisError


class LimitError(DeixisError, OverflowError):
    """A question that is larger than what can be answered in bounded time and memory; nothing was decided."""


class InconsistencyError(DeixisError, ValueError):
    """Axioms that cannot all hold."""


class SettingError(DeixisError, ValueError):
    """A setting of a call that it cannot have."""


class NothingFoundError(DeixisError, LookupError):
    """A script of which a scene shows nothing."""
