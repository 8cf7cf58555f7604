"""Boxes that satisfy networks in several calculi, which prove that the networks are consistent together."""
