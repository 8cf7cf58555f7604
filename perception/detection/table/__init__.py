"""Find the tables of a cloud: plane, top, outline and viewpoint of each, and the points above it."""
