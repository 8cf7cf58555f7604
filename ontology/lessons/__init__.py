"""Lessons: what a grounding taught, as types, as triples and as SHACL shapes."""
