"""A table to look at: tableware as meshes, laid on a table, and seen by a depth camera that knows the truth."""
