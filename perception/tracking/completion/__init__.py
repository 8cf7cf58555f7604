"""Completion of things at rest: parts that were missed or hidden, pieces taken for things, and hidden ends."""
