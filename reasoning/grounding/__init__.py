"""Grounding: which perceived thing each object of a description is, how probable that is, and why."""
