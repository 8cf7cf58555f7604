"""Perceptual memory: views of objects and what learners know of categories, in a LevelDB that one process owns."""
