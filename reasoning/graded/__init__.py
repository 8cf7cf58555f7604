"""Graded meaning: how well a relation word describes a pair of boxes, as a degree and as evidence."""
