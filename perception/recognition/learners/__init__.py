"""Learners of words for things: each begins with none, and is taught and corrected a view at a time."""
