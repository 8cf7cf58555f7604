"""Semantic and perceptual memory in a folder that one process owns."""
