"""Episodic memory: a blackboard of fluents with a log of changes, a time index and subscriptions."""
