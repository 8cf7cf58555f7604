"""Workflows on layouts: read, lint, infer, lay an example table."""
