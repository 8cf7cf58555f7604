"""Comparison of a table with layouts: its faults, and the layouts that it is most similar to."""
