"""Descriptors of the shape and the colour of a seen object, one module each."""
