"""Engines that align a description with a scene: their protocol, and those that there are, by name."""
