"""The errors of this room."""

from __future__ import annotations

from deixis.ontology.errors import DeixisError


class SceneError(DeixisError, ValueError):
    """A scene that cannot be read, or that contradicts itself; the message names the file and the place in it."""


class CloudError(DeixisError, ValueError):
    """A point cloud that cannot be read, or arrays that make none."""
