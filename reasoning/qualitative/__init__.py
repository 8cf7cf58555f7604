"""Qualitative reasoning: calculi, constraint networks over them, and the relations of boxes in each."""
