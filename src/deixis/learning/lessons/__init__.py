"""Lessons: made from a grounding, and recalled with the evidence that learning from them needs."""
