"""Questions that distinguish the groundings of an ambiguous description, and the effect of their answers."""
