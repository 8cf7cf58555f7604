"""Simulator: tableware as meshes, laid on a table, and seen by a depth camera, with the ground truth."""
