"""Algebraic closure (path consistency) of a network: its state in memory, compiled loops, and closure in rounds."""
