"""Workflows on descriptions: refer to objects, tell layouts and scenes, learn the words for it."""
