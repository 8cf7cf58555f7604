"""The errors of constraint networks."""

from __future__ import annotations

from deixis.ontology.errors import DeixisError


class NetworkError(DeixisError, ValueError):
    """A network whose parts do not fit together, or a question about a pair that it does not have."""
