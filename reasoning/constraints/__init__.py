"""Constraints shared by all engines of entailment and time."""
