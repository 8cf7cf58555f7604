"""Simulated depth cameras: poses, depth images with noise, and views of tables and of single things."""
