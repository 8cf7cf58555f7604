"""The errors of recognising."""

from __future__ import annotations

from deixis.ontology.errors import DeixisError


class RecognitionError(DeixisError, ValueError):
    """Descriptors, categories or settings that do not fit together; the message names which, and what would fit."""
