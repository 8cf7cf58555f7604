"""What is it? Views beside remembered ones: the distances of equations 1 to 4, learners, and the teaching protocol."""
