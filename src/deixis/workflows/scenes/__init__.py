"""Workflows on scenes: perceive, recognise, teach, track, point, simulate."""
