"""Keypoints and normals, which descriptors are made from, and compiled kernels on neighbourhoods of points."""
