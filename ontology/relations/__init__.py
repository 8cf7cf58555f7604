"""Relation words and their meaning, and Allen's relations of intervals."""
