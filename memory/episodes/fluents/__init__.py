"""Fluents with certainty and source, changes of them, and the bytes that both are stored as."""
