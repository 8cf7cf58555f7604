"""What describes the shape of a seen object: keypoints, normals, and descriptors behind one protocol."""
