"""Qualitative constraint networks over any calculus: closure, search, scenarios, minimal conflicts."""
