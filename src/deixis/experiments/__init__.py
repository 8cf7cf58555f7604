"""Experiments of the paper and our own: Figure 6, open-ended learning, and the scoreboard of all engines."""
