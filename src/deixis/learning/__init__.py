"""Learning: from a grounding to a lesson, and from all lessons to sizes and words."""
