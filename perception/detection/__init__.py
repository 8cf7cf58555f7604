"""Detect the table in a point cloud, and the objects on it, as segments with boxes."""
