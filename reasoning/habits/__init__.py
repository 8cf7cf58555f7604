"""Habits: from examples of where a person puts things, rules in words, and the place of other things."""
