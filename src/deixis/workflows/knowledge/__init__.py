"""Workflows on the memory: learn, recall, unlearn, episodes, habits."""
