"""Frames of a stream of clouds: where they come from, and their images of depth and colour."""
