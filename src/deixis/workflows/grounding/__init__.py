"""Workflows that ground a script in a scene and compare the two."""
