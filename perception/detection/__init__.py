"""Detection: the table of a cloud, and the things on it as segments with boxes."""
