"""Workflows on ontologies, constraint networks and activities."""
