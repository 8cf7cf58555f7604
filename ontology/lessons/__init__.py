"""Lessons: the result of a grounding as types, as triples and as SHACL shapes."""
