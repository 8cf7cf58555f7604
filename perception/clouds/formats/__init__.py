"""Formats of clouds: readers of PCD, PLY, XYZ and numpy files, and writers."""
