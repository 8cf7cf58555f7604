"""Partial one-to-one maps between described objects and perceived things: the problem, and engines that solve it."""
