"""Boxes that satisfy every fact of a script, or the proof that there are no such boxes."""
