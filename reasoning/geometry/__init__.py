"""Geometry of boxes: Allen relations, the rectangle algebra, and scale-free features of pairs."""
