"""Segment the points above a table: supervoxels are merged into parts, and parts into objects."""
