"""Hypotheses about a description: the side from which it is spoken, mirror images, and other scenes."""
