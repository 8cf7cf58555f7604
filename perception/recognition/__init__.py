"""Object recognition: the distances of equations 1 to 4 between views, learners, and the teaching protocol."""
