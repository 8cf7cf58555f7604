"""Experiments, the paper's and our own: Figure 6 again, and the scoreboard of all engines."""
