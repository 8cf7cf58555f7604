"""Descriptors of a seen object: keypoints, normals, and descriptors of shape and colour behind one protocol."""
