"""Qualitative calculi as data: their atoms, converses and compositions, and which of their relations are tractable."""
