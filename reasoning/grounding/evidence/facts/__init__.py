"""Evidence of stated facts about pairs of objects, perceived or absent, and how literally the facts are meant."""
