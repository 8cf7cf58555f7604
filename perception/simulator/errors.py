"""The errors of the simulator."""

from __future__ import annotations

from deixis.ontology.errors import DeixisError


class SimulationError(DeixisError, ValueError):
    """A thing, a table or a camera that cannot be simulated; the message says which and why."""
