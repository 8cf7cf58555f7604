"""Pose of a camera that moves, from frame to frame, by registration with earlier frames."""
