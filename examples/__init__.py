"""The shipped examples: layout scripts, scenes, networks and fluents, read by ``deixis.examples_data``."""
